/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bounce.h: light among the facets of a baked surface, each a mirror: where a ray from one facet next meets another, and
 * the path that leads from a view, facet by facet, out to the sky (Eq. 12a of On Microsurface Transformations, Golubev,
 * at each of them). The recursion of its Eq. (11c) has one branch for mirrors, so a path is exact for its first point.
 *
 * Rays walk over the baked triangles (walk.h) in double precision. Between two edges surface and ray are straight, so
 * the ray meets a triangle if and only if it is above the surface over the edge where it comes in and below over the
 * edge where it goes out; where in between, follows from both gaps. A ray leaves a facet on its upper side and therefore
 * cannot meet this facet: no offset is needed. Frame: x and y of the transformed plane, z up, unit vectors.
 */
#ifndef MU_BOUNCE_H
#define MU_BOUNCE_H

#include "core/surface/heightfield.h"

/* The surface under M. The heights are borrowed. */
typedef struct mu_mirrors {
    mu_heightfield f;
    double m[4];
    double high; /* the highest height */
} mu_mirrors;
mu_mirrors mu_mirrors_make(const mu_heightfield *f, const double m[4]);

/* The point (i + u, j + v) of one triangle, inside it, 0 <= i < nx, 0 <= j < ny. */
typedef struct mu_spot {
    uint32_t i, j;
    int upper;
    double u, v;
} mu_spot;

/* Lost: more than MU_WALK_MOST edges without an answer, which takes a ray that all but stays level. */
typedef enum mu_ray_end { MU_RAY_ESCAPES, MU_RAY_HITS, MU_RAY_LOST } mu_ray_end;

/* From the spot along d, which points out of its facet; a hit moves the spot there. */
mu_ray_end mu_mirrors_cast(const mu_mirrors *mirrors, mu_spot *spot, const double d[3]);

enum { MU_BOUNCES_MOST = 64 };

typedef enum mu_path_end { MU_PATH_ESCAPED, MU_PATH_OVER_LIMIT, MU_PATH_LOST } mu_path_end;

typedef struct mu_mirror_path {
    mu_path_end end;
    uint32_t count;                 /* of reflections that happened */
    double cosine[MU_BOUNCES_MOST]; /* at each, between the ray and the facet's normal */
    double out[3];                  /* the direction after the last one */
} mu_mirror_path;

/* The path of the light that leaves the spot toward v, backward: v, the first mirror, and on, for at most `most`
 * reflections (1 to MU_BOUNCES_MOST). The spot's facet must face v; whether v sees it is the caller's to know. */
void mu_mirror_follow(const mu_mirrors *mirrors, const mu_spot *spot, const double v[3], uint32_t most,
                      mu_mirror_path *path);

#endif
