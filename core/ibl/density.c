/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * density.c: the lobe itself, that the axis stands for: GGX of a Sigma, in the three spaces. M of Sigma = (M M^T)^-1 / 2, the
 * matrix that makes GGX of alpha 1 a lobe of Sigma, is R diag(1 / sqrt(2) sigma_U, 1 / sqrt(2) sigma_V).
 */
#include "core/ibl/ibl.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 53

#define ROOT_2 1.41421356237309504880

int mu_ibl_density(const mu_ibl_lobe_d *l, const double wo[3], mu_ibl_space space, size_t count,
                   const double *points, double *out) {
    _Alignas(64) unsigned char memory[2048];
    mu_definition d = mu_definition_default();
    mu_complaint why;
    mu_closure_d c;
    const double u = 1 / (ROOT_2 * l->sigma[0]), v = 1 / (ROOT_2 * l->sigma[1]);
    d.alpha = 1;
    d.transform[0] = l->turn[0] * u, d.transform[1] = -l->turn[1] * v;
    d.transform[2] = l->turn[1] * u, d.transform[3] = l->turn[0] * v;
    if (!(l->sigma[0] > 0 && l->sigma[1] > 0) || !mu_definition_check(&d, &why) ||
        mu_surface_bytes_d(&d) > sizeof memory || !mu_bind_d(mu_surface_make_d(&d, memory), wo, NULL, &c))
        return 0;
    for (size_t i = 0; i < count; i++) {
        if (space == MU_IBL_SLOPES) {
            const double *s = points + 2 * i, z = 1 / sqrt(1 + s[0] * s[0] + s[1] * s[1]);
            const double m[3] = {-s[0] * z, -s[1] * z, z};
            out[i] = mu_normal_d(&c, m).D * (z * z) * (z * z);
        } else if (space == MU_IBL_NORMALS) {
            const double *m = points + 3 * i;
            out[i] = m[2] > 0 ? mu_normal_d(&c, m).D * m[2] : 0;
        } else {
            mu_value_d f = {{0, 0, 0}, 0, 0};
            const double *w = points + 3 * i;
            if (w[2] > 0) mu_eval_d(&c, w, &f);
            out[i] = w[2] > 0 ? f.f[0] * w[2] : 0;
        }
    }
    return 1;
}

#endif
