/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* quantities.c: the microfacet quantities one by one, for validation and plots; shading needs none of them
 * alone. */
#include "core/bsdf/distribution.h"

typedef MU(mu_masking) masking;
typedef MU(mu_normal_values) normal_values;
typedef MU(mu_pair_values) pair_values;

/* sigma_M(w) and Lambda_M(w) = sigma / cos - 1 without the subtraction; w.z = 0 is allowed. */
masking MU(mu_view)(const closure *c, const real w[3]) {
    if (!(w[2] >= 0)) return (masking){0, 0};
    if (!c->kernel) return (masking){0, w[2]};
    const real scale = c->map.view_z, lambda = c->kernel->lambda(c, w);
    return (masking){w[2] > 0 ? lambda / scale / w[2] : R(INFINITY), w[2] + lambda / scale};
}

normal_values MU(mu_normal)(const closure *c, const real wm[3]) {
    if (!(wm[2] > 0)) return (normal_values){0, 0, 0};
    const real cosine = c->wo[0] * wm[0] + c->wo[1] * wm[1] + c->wo[2] * wm[2];
    if (!c->kernel) return (normal_values){0, cosine > 0 && c->wo[2] > 0, 0};
    const real sigma = c->sigma / c->map.view_z, d = c->kernel->density(c, wm);
    if (!(cosine > 0 && sigma > 0)) return (normal_values){d, 0, 0};                      /* chi+ */
    return (normal_values){d, c->wo[2] / sigma, smaller(d * (cosine / sigma), REAL_MAX)}; /* Eq. (27) */
}

/* F at the half-vector and the height-correlated G2 = 1 / (1 + Lambda_o + Lambda_i). */
pair_values MU(mu_pair)(const closure *c, const real wi[3]) {
    pair_values out = {{0}, 0};
    if (!(wi[2] > 0 && c->wo[2] > 0)) return out;
    const real h[3] = {c->wo[0] + wi[0], c->wo[1] + wi[1], c->wo[2] + wi[2]};
    MU(fresnel_eval)
    (&c->surface->fresnel, smaller(sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) / 2, 1), out.F);
    out.G2 = 1;
    if (c->kernel) {
        const real scale = c->map.view_z; /* quotients apart: products of cosines near 0 would underflow */
        const real Lambda_i = c->kernel->lambda(c, wi) / scale / wi[2];
        const real Lambda_o = c->kernel->lambda(c, c->wo) / scale / c->wo[2];
        out.G2 = 1 / (1 + Lambda_o + Lambda_i);
    }
    return out;
}
