/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * normal_turn.h: what a normal map does to a hit that is otherwise ready for its material (shading.h).
 *
 * Near, the frame turns to the map's normal, its tangent as near to the former as can be: what a mesh with such vertex normals
 * does. Light still passes only where frame and geometry agree on its side. A normal that would mirror the viewer into the
 * surface leans back until it does not, so that what is seen at a flat angle has no black rims: energy that a surface of real
 * facets would hand on from one to the next is kept.
 *
 * From afar, the mean of the slopes that are seen at once turns the frame, and their covariance C widens the lobe: M' has
 * M'^-T S0 M'^-1 = M^-T S0 M^-1 + c C, S0 what stands for the material's own slopes before M (musurf_slopes.h). That one is
 * matched by the slope within which a third are (core/ibl/slopes.c), and so is the map's, taken as Gaussian: c =
 * -2 ln(2/3). Of Beckmann's distribution the sum is exact then: alpha^2 + 2 C.
 *
 * Facets that lean toward the viewer fill more of what is seen than those that lean away, as the masking of a microsurface
 * has it. Normals of a map are no facets: each fills what its texel does. What the lobe is widened by would lean toward
 * the viewer by C w/w_z on average, w the direction to it, and the mean is moved by as much the other way; by one
 * deviation at most, as that of the visible ones is.
 *
 * One lobe stands for many: that is wrong by its own, few samples are noisy. Of N samples each looks at the N-th part of a
 * pixel, and that is made smaller, by halves, until r (1 - r) is below MU_NORMAL_TRUST / N, r the part of the lobe's variance that
 * is from the map: where that is clear, a lobe is better than points, and many samples converge to what points give.
 *
 * A mirror (alpha 0) has no lobe that M could widen, and other types may not say how: these are looked at point by point.
 */
#ifndef MU_NORMAL_TURN_H
#define MU_NORMAL_TURN_H

#include "core/render/normal_map.h"
#include "core/render/shading.h"

#define MU_NORMAL_TRUST 5.5

/* Once the material is compiled: whether, and how, its lobe can be widened. */
void mu_normal_map_bind(mu_normal_map *map, const mu_material *material);

/* [any] shading: all of it but closure and lobes; `m` of slots holds M, or what is composed into it, where `map->map` is not NULL.
 * turned: seen from behind, b is -b and n is -n. */
void mu_normal_turn(mu_shading *shading, const mu_material *material, const mu_beam *beam, mu_vec3 wo, _Bool turned);

#endif
