/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_compiled.h: a compiled material of "musurf.microfacet", and its closures.
 *
 * Shading is in float. Where alpha or the scale of M leaves what float arithmetic holds, a material shades in
 * double instead and only rounds its answers: slower, but never clamped.
 */
#ifndef MUSURF_COMPILED_H
#define MUSURF_COMPILED_H

#include "core/ibl/ibl.h"
#include "plugin/musurf_map.h"
#include "plugin/musurf_parameters.h"
#include "plugin/musurf_probe.h"
#include "plugin/musurf_slopes.h"

struct musurf_material {
    parsed parsed;
    void (*release)(void *context, void *memory); /* NULL: free() */
    void *context;
    const mu_surface_f *in_float; /* NULL where shading is in double */
    const mu_surface_d *in_double;
    float inner[4];        /* of parsed.inner */
    mu_ibl_slopes moments; /* before M */
    int has_moments;
    uint32_t lobes; /* that setup answers */
    uint32_t transmits;
    uint32_t needs;
    uint32_t bytes, table_bytes, closure_bytes;
    float unsure, open, reach; /* mu_surface_tables_unsure, mu_surface_tables_open, mu_surface_tables_reach */
    char name
        [160]; /* the longest: "beckmann (std is beckmann here), general transform, double precision, albedo within 0.012,
                     * integrated for 12 % of directions" */
    char left_out[160];
    char sampler[128];
};

typedef struct bound {
    const musurf_material *material;
    union {
        mu_closure_f f;
        mu_closure_d d;
    } closure;
} bound;

/* What sampler "auto" comes down to; `memory` holds its surface, in the precision it is shaded in. *noise: variance of its weights
 * over that of visible normals'; NAN if there was nothing to choose from. */
mu_sampler musurf_choose_sampler(const mu_definition *definition, int in_float, void *memory, double *noise);

extern const musurf_probe musurf_probe_table;
extern const musurf_map musurf_map_table;
extern const musurf_slopes musurf_slopes_table;

/* While the histogram is still there. */
void musurf_find_moments(musurf_material *material);

uint32_t musurf_setup(const musurf_material *material, const float wo[3], const float *slots, uint32_t mode,
                      void *closure);
void musurf_eval(const void *closure, const float wi[3], uint32_t lobes, musurf_value *out);
void musurf_sample_one(const void *closure, const float u[3], uint32_t lobes, musurf_sample *out);
float musurf_pdf(const void *closure, const float wi[3], uint32_t lobes);
void musurf_albedo(const void *closure, float rgb[3]);
void musurf_blur(void *closure, float alpha);
void musurf_eval_batch(const void *closure, size_t closure_stride, const float *wi, size_t wi_stride,
                       uint32_t lobes, musurf_value *out, size_t out_stride, size_t count);
void musurf_sample_batch(const void *closure, size_t closure_stride, const float *u, size_t u_stride,
                         uint32_t lobes, musurf_sample *out, size_t out_stride, size_t count);

#endif
