/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* quantities.c: the microfacet quantities one by one, for validation and plots; shading needs none of them
 * alone. Equations: Atanasov et al. 2022. */
#include "core/bsdf/snell.h"

typedef MU(mu_masking) masking;
typedef MU(mu_normal_values) normal_values;
typedef MU(mu_pair_values) pair_values;

/* sigma_M(w), Eq. (12), and Lambda_M(w) = sigma / cos - 1 without the subtraction; w.z = 0 is allowed. */
masking MU(mu_view)(const closure *c, const real w[3]) {
    const real up[3] = {c->side * w[0], c->side * w[1], c->side * w[2]};
    if (!(up[2] >= 0)) return (masking){0, 0};
    real sigma, lambda;
    c->kernel->view(c, up, &sigma, &lambda);
    const real scale = c->map.view_z;
    return (masking){up[2] > 0 ? lambda / scale / up[2] : R(INFINITY), sigma / scale};
}

normal_values MU(mu_normal)(const closure *c, const real wm[3]) {
    const real m[3] = {c->side * wm[0], c->side * wm[1], c->side * wm[2]};
    if (!(m[2] > 0)) return (normal_values){0, 0, 0};
    const real cosine = dot(c->wo, m);
    const real sigma = c->sigma / c->map.view_z, d = c->kernel->density(c, m);
    const real n2 = dot(m, m);
    const real of_flakes = c->has_footprint ? smaller(d * MU(glint_count)(c, m, n2), REAL_MAX) : d;
    if (!(cosine > 0 && sigma > 0)) return (normal_values){of_flakes, 0, 0}; /* chi+ */
    return (normal_values){of_flakes, smaller(c->wo[2] / sigma, 1),
                           smaller(d * (cosine / sigma), REAL_MAX)}; /* Eq. (27) */
}

/* F and G2 at the micronormal that sends wo into wi. */
pair_values MU(mu_pair)(const closure *c, const real wi[3]) {
    pair_values out = {{0}, 0};
    real i[3];
    const int transmitted = closure_turn(c, wi, i);
    const real *o = c->wo;
    if (!(i[2] > 0 && o[2] > 0) || (transmitted && !c->surface->transmission)) return out;
    if (transmitted) {
        const refraction r = refraction_between(c->eta, o, i);
        if (!(r.H2 > 0)) return out;
        out.F[0] = out.F[1] = out.F[2] = refraction_fresnel(c->eta, &r);
    } else { /* wo.wm = |h| / 2 */
        const real h[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
        MU(fresnel_eval)(&c->surface->fresnel, c->eta, smaller(sqrt(dot(h, h)) / 2, 1), out.F);
    }
    out.G2 = c->kernel->shadowing(c, i, transmitted);
    return out;
}
