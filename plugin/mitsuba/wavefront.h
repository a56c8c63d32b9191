/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * wavefront.h: shades whole wavefronts of hits through any plugin of musurf_plugin.h, for hosts that keep a column per
 * coordinate where the plugin wants a record per hit. Frame and units are the plugin's. Nothing of any host is used here.
 */
#ifndef MUSURF_WAVEFRONT_H
#define MUSURF_WAVEFRONT_H

#include "plugin/musurf_plugin.h"

/* Element i stands at data[i * step]; step 0: one for all. */
typedef struct musurf_column {
    const float *data;
    size_t step;
} musurf_column;

/* What a hit is, over all hits. */
typedef struct musurf_wavefront {
    const musurf_material_type *type;
    const musurf_material *material;
    size_t count;
    musurf_column wo[3];
    const uint8_t *active; /* a byte each, 0: not asked for, the answer is 0; NULL: all are */
    size_t active_step;
    const musurf_column *slots; /* slot_floats of them, or NULL */
    uint32_t slot_floats;
    uint32_t closure_bytes, closure_alignment; /* of the plan */
    uint32_t mode;                             /* setup's */
    uint32_t lobes;                            /* that are asked for */
    uint32_t threads;                          /* at most; at least 1 */
} musurf_wavefront;

/* Where answers go: `count` floats each. */
typedef struct musurf_wavefront_values {
    float *f[3], *pdf;
} musurf_wavefront_values;

typedef struct musurf_wavefront_samples {
    float *wi[3], *weight[3], *pdf, *eta;
    uint32_t *lobe;
} musurf_wavefront_samples;

/* The largest closure and the most slots there is room for: larger plans are the host's to refuse. */
enum { MUSURF_WAVEFRONT_CLOSURE = 8192, MUSURF_WAVEFRONT_SLOTS = 64 };
uint32_t musurf_wavefront_closure_limit(void);
uint32_t musurf_wavefront_slot_limit(void);

/* f |wi.z| and pdf toward wi. */
void musurf_wavefront_eval(const musurf_wavefront *w, const musurf_column wi[3],
                           const musurf_wavefront_values *out);
/* A direction by the three uniforms u. Where none is drawn, wi is 0 0 1, eta 1, and all else 0. */
void musurf_wavefront_sample(const musurf_wavefront *w, const musurf_column u[3],
                             const musurf_wavefront_samples *out);

#endif
