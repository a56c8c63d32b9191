/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_probe.h: the extension "musurf.probe/1", a material's microfacet quantities in float or double.
 *
 * For validation, tables and plots: it answers with D, G1, sigma, ... of the material's microsurface, which the
 * shading calls never show. The same formulas run in either precision, so the float error can be measured. Only
 * for materials whose parameters are all constant; a footprint in slots is left out (the surface as from afar). Slow compared with the shading calls. All functions are [any].
 */
#ifndef MUSURF_PROBE_H
#define MUSURF_PROBE_H

#include "musurf_plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MUSURF_PROBE_ID "musurf.probe/1"

typedef int32_t musurf_precision;
enum { MUSURF_FLOAT = 24, MUSURF_DOUBLE = 53 }; /* bits of the significand */

typedef int32_t musurf_sampler;
enum {
    MUSURF_SAMPLE_AS_SET = 0,  /* what the material's own "sampler" parameter says */
    MUSURF_SAMPLE_VISIBLE = 1, /* Dv: visible normals, seed equation (28) */
    MUSURF_SAMPLE_NDF = 2      /* D cos: seed equation (26) */
};

/* Quantities at (wo, wm, wi); those whose argument was NULL are 0. Notation of the README. */
typedef struct musurf_probe_values {
    /* of wo */
    double Lambda; /* infinite where wo.z = 0 */
    double sigma;  /* wo.z (1 + Lambda), finite everywhere */
    /* of wo and wm */
    double D;  /* 1/sr */
    double G1; /* with the chi+ of wo.wm */
    double Dv; /* 1/sr */
    /* of wo and wi, at the half-vector */
    double f[3]; /* 1/sr, F included, no cosine */
    double F[3];
    double G2;
    double pdf;     /* of sampling wi given wo, by the material's sampler */
    uint32_t delta; /* 1: a mirror; f and pdf are 0, D and Dv are 0 */
} musurf_probe_values;

typedef struct musurf_probe_sample {
    double wi[3], wm[3];
    double f[3];      /* 1/sr, no cosine */
    double weight[3]; /* f cos / pdf, analytic */
    double pdf;
    uint32_t rejected; /* 1: wi fell below the horizon; f, weight and pdf are 0; wm is the sampled normal */
    uint32_t delta;
} musurf_probe_sample;

typedef struct musurf_probe {
    uint32_t size;
    /* wm and wi may each be NULL. Directions are normalised by the callee in the asked precision. */
    musurf_result (*evaluate)(const musurf_material *material, musurf_precision precision, const double wo[3],
                              const double *wm, const double *wi, musurf_probe_values *out);
    musurf_result (*sample)(const musurf_material *material, musurf_precision precision,
                            musurf_sampler sampler, const double wo[3], const double u[3],
                            musurf_probe_sample *out);
} musurf_probe;

#ifdef __cplusplus
}
#endif
#endif /* MUSURF_PROBE_H */
