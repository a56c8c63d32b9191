/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_map.h: the extension "musurf.map/1", for hosts that filter a varying microsurface before it is shaded.
 *
 * Whatever of a material's roughness, anisotropy and transform varies comes down to one M per point. The mean of what a
 * pixel sees is not that of M: what averages is the covariance of slopes, which is that of (M M^T)^-1. A host that has
 * values in textures asks `compose` for the M of each texel once, averages, and hands the M of the average to `setup`.
 * It may also deform it further: the M of an object's deformation, or of a map's Jacobian, stands before it.
 * All functions are [any], and neither allocates nor calls the host.
 */
#ifndef MUSURF_MAP_H
#define MUSURF_MAP_H

#include "musurf_plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MUSURF_MAP_ID "musurf.map/1"

typedef struct musurf_map {
    uint32_t size;
    /* Rows of the whole M of these slots, for a material of which something but the footprint varies; else 0. */
    uint32_t (*compose)(const musurf_material *material, const float *slots, float m[4]);
    /* The type's own setup, but that M is `m`, and `slots` are read for what is no part of it. */
    uint32_t (*setup)(const musurf_material *material, const float wo[3], const float m[4],
                      const float *slots, uint32_t mode, void *closure);
} musurf_map;

#ifdef __cplusplus
}
#endif
#endif /* MUSURF_MAP_H */
