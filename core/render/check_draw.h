/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_draw.h: random materials and views for the numerical validation of seed 000, section 4.3: every
 * distribution under every kind of map, tilted and not, with every form of masking, every sampler, opaque and
 * transmitting, as JSON text, so that a worst case can be pasted into `musurf eval`.
 */
#ifndef MU_CHECK_DRAW_H
#define MU_CHECK_DRAW_H

#include "core/render/check_random.h"
#include "plugin/musurf_plugin.h"

typedef struct mu_draw {
    char json[1024];     /* the material */
    char original[1024]; /* the same microsurface before M, and before it was tilted */
    char turned[1024];   /* the same with M turned by `angle` */
    double m[4];         /* rows: all that the material's parameters make of M */
    double tilt[2];
    double alpha, angle; /* alpha: of all slopes, what they are measured in */
    double spread;       /* of the slopes: log of the ratio of its largest to its smallest scale */
    _Bool found;   /* the slope plane is to be found from samples: m and tilt are not all that shapes it */
    _Bool classic; /* ggx and a diagonal M */
    _Bool beyond_float; /* M scales by so much that values leave the range of float */
} mu_draw;

/* Material number `index` of a run: kinds are gone through in turn, values are random. `type` tells which
 * choices of "sampler" there are. */
mu_draw mu_draw_material(uint64_t seed, uint64_t index, const musurf_material_type *type);

enum { MU_VIEWS = 3 };
/* View number k of material `index`: the normal or up to 60 degrees; 60 to 85 degrees; up to 89.5 degrees. */
void mu_draw_view(uint64_t index, int k, mu_stream *random, double view[3]);

#endif
