/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * varying.h: a material whose parameters have sources (source.h): their values at a hit, and their mean over a pixel.
 *
 * Of a type that says what M its shape amounts to (musurf_map.h), pictures are composed into M texel by texel, by the
 * plugin's own rule, when the scene is read; what is kept and averaged is M and its covariance (covariance.h), so that
 * roughness, anisotropy and direction filter together, whatever pictures they come from. Between texels it is the
 * covariance, too, that is interpolated.
 * The averaged surface has the covariance of its parts, but one lobe for their many: its error goes with the spread of S
 * (covariance.h), about as 0.2 to 0.5 of it, and that of looking at points with the root of the spread over the number N of a
 * pixel's samples. So much is averaged as varies by no more than 1 / N, each sample over the N-th part of the pixel: few
 * samples do not alias, and many converge to what points give.
 * A "transform" of vertices or formulas may stand before what pictures say; else
 * those are evaluated at the point of the hit.
 * Of other types values are averaged as they are.
 */
#ifndef MU_VARYING_H
#define MU_VARYING_H

#include "core/render/material_settings.h"
#include "plugin/musurf_map.h"

typedef struct mu_varying {
    mu_source *sources; /* the pictures of them are in `mipmap` now */
    size_t count;
    const musurf_map *map; /* NULL: values go through slots as they are */
    _Bool pictured;        /* some are pictures */
    _Bool pointwise;       /* some are not */
    mu_placement placement;
    mu_mipmap
        mipmap; /* with `map`: M, S and the spread of S, 8 numbers; without: the pictures' numbers in the order of the sources */
} mu_varying;

/* Takes the settings' sources; `material` is compiled of those settings. NULL on failure. */
mu_varying *mu_varying_make(mu_settings *settings, const musurf_material *material, const mu_place *place,
                            mu_error *error);
void mu_varying_free(mu_varying *varying);

/* [any] Values at texture coordinates `footprint[0..1]`, over the half-axes that follow, as far as S varies by no more than
 * `most` there; `attributes`: of the scene's list. Fills the slots, or, with a map, `m` (rows). */
void mu_varying_at(const mu_varying *varying, const musurf_material *material, const float footprint[6],
                   float most, const float *attributes, float *slots, float m[4]);

#endif
