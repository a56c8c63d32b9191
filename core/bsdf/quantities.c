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
    const real up[3] = {c->side * w[0], c->side * w[1], c->side * w[2]};
    if (!(up[2] >= 0)) return (masking){0, 0};
    if (!c->kernel) return (masking){0, up[2]};
    real sigma, lambda;
    c->kernel->view(c, up, &sigma, &lambda);
    const real scale = c->map.view_z;
    return (masking){up[2] > 0 ? lambda / scale / up[2] : R(INFINITY), sigma / scale};
}

normal_values MU(mu_normal)(const closure *c, const real wm[3]) {
    const real m[3] = {c->side * wm[0], c->side * wm[1], c->side * wm[2]};
    if (!(m[2] > 0)) return (normal_values){0, 0, 0};
    const real cosine = c->wo[0] * m[0] + c->wo[1] * m[1] + c->wo[2] * m[2];
    if (!c->kernel) return (normal_values){0, cosine > 0 && c->wo[2] > 0, 0};
    const real sigma = c->sigma / c->map.view_z, d = c->kernel->density(c, m);
    const real n2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    const real of_flakes = c->has_footprint ? smaller(d * MU(glint_count)(c, m, n2), REAL_MAX) : d;
    if (!(cosine > 0 && sigma > 0)) return (normal_values){of_flakes, 0, 0}; /* chi+ */
    return (normal_values){of_flakes, smaller(c->wo[2] / sigma, 1),
                           smaller(d * (cosine / sigma), REAL_MAX)}; /* Eq. (27) */
}

/* F and G2 at the micronormal that sends wo into wi. */
pair_values MU(mu_pair)(const closure *c, const real wi[3]) {
    pair_values out = {{0}, 0};
    const int transmitted = c->side * wi[2] < 0;
    const real turn = transmitted ? -c->side : c->side;
    const real *o = c->wo, i[3] = {turn * wi[0], turn * wi[1], turn * wi[2]};
    if (!(i[2] > 0 && o[2] > 0) || (transmitted && !c->surface->transmission)) return out;
    real facing, facing_i = 0;
    if (transmitted) { /* wo.H / |H|, see refraction.h */
        const real eta = c->eta, sign = eta < 1 ? R(-1) : R(1);
        real apart2 = 0, along = 0, face_i = 0, up = 0;
        for (int k = 0; k < 3; k++) {
            const real H = sign * ((eta - 1) * i[k] + (i[k] - o[k]));
            apart2 += square(i[k] - o[k]), along += H * o[k], face_i += H * i[k];
            if (k == 2) up = H;
        }
        const real H2 = square(eta - 1) + eta * apart2;
        if (!(along > 0 && face_i > 0 && up > 0 && H2 > 0)) return out;
        facing = along / sqrt(H2), facing_i = face_i / sqrt(H2);
    } else {
        const real h[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
        facing = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) / 2;
    }
    if (transmitted)
        out.F[0] = out.F[1] = out.F[2] =
            MU(fresnel_between)(c->eta, smaller(facing, 1), c->eta * smaller(facing_i, 1));
    else
        MU(fresnel_eval)(&c->surface->fresnel, c->eta, smaller(facing, 1), out.F);
    out.G2 = c->kernel ? c->kernel->shadowing(c, i, transmitted) : 1;
    return out;
}
