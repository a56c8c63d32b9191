/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * multiple.h: multiple scattering on the microsurface, in the two forms that wrap a distribution's full plan; and what a
 * surface keeps for them, right behind its head in memory. A surface that scatters singly keeps nothing.
 */
#ifndef MU_MULTIPLE_H
#define MU_MULTIPLE_H

#include <stdint.h>

#include "core/bsdf/albedo_set.h"
#include "core/bsdf/distribution.h"
#include "core/bsdf/padded.h"

typedef struct MU(mu_multiple) {
    const mu_albedo_set *tables; /* of the compensated form */
    real average
        [3]; /* F averaged over the hemisphere, 2 F(mu) mu dmu; of a surface that transmits: [0] from above,
                                [1] from below */
    uint32_t salt;
} multiple;

static inline size_t surface_head_bytes(void) {
    return padded(sizeof(surface));
}
static inline const multiple *multiple_of(const surface *s) {
    return (const void *)((const char *)s + surface_head_bytes());
}

/* multiple.average. */
void MU(multiple_average)(const surface *s, real average[3]);
/* Memory behind the head; 0 if the definition scatters singly. */
size_t MU(multiple_bytes)(const mu_definition *d);
void MU(multiple_make)(surface *s, const mu_definition *d);

/* Chooses the closure's tables, once its map is settled; blur as of mu_blur. `moved`: its map may be none of the definition's. */
void MU(compensated_bind)(closure *c, real blur, int moved);
void MU(compensated_eval)(const kernel *full, const closure *c, const real wi[3], value *out);
void MU(compensated_sample)(const kernel *full, const closure *c, mu_sampler sampler, const real u[3],
                            sample *out);

/* The most facets that a walk meets. */
enum { WALK_BOUNCES = 128 };
/* Where a walk ends. */
typedef struct MU(mu_walk_end) {
    real i[3]; /* seen from the side it left to: i.z > 0; 0 if it never left */
    real m[3]; /* the first micronormal, as seen from wo */
    real weight[3];
    int transmitted, bounces;
} walk_end;
void MU(walk_trace)(const kernel *full, const closure *c, const multiple *with, const real u[3],
                    walk_end *out);
/* f toward wi of the light that meets `first` to `last` facets: an unbiased estimate from one walk. */
void MU(walk_estimate)(const kernel *full, const closure *c, const multiple *with, const real wi[3],
                       int first, int last, real f[3]);
void MU(walk_eval)(const kernel *full, const closure *c, const real wi[3], value *out);
void MU(walk_sample)(const kernel *full, const closure *c, mu_sampler sampler, const real u[3], sample *out);

#endif
