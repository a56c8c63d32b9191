/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * density.c: the lobe of the material itself, as pictures of the three panels: P22 of slopes; D cos of micronormals; f
 * cos of reflected directions, with G2 and F, green's. In float, for they are pictures.
 */
#include "scripts/page/material.h"
#include "scripts/page/panel.h"

/* At a place of the panel's plane. */
static float at(const mu_closure_f *c, int above, mu_ibl_space space, double x, double y) {
    double w[3];
    if (space == MU_IBL_SLOPES) {
        const double z = 1 / sqrt(1 + x * x + y * y);
        const float m[3] = {(float)(-x * z), (float)(-y * z), (float)z};
        return mu_normal_f(c, m).D * (m[2] * m[2]) * (m[2] * m[2]);
    }
    if (!page_unproject(x, y, w)) return 0;
    const float v[3] = {(float)w[0], (float)w[1], (float)w[2]};
    if (space == MU_IBL_NORMALS) return mu_normal_f(c, v).D * v[2];
    if (!above) return 0;
    mu_value_f value;
    mu_eval_f(c, v, &value);
    return value.f[1] * v[2];
}

double page_density(const page_material *m, const double *query, int space, const double *frame, int size,
                    unsigned ink, float *work, unsigned *rgba) {
    const float wo[3] = {(float)query[0], (float)query[1], (float)query[2]};
    mu_closure_f c;
    float most = 0;
    const int above = mu_bind_f(m->shaded, wo, NULL, &c);
    for (int row = 0; row < size; row++)
        for (int column = 0; column < size; column++) {
            const double x = (2 * column + 1.0) / size - 1, y = 1 - (2 * row + 1.0) / size;
            const float d = at(&c, above, (mu_ibl_space)space, frame[PAGE_X] + frame[PAGE_REACH] * x,
                               frame[PAGE_Y] + frame[PAGE_REACH] * y);
            work[row * size + column] = d;
            if (d > most) most = d;
        }
    const float scale = most > 0 ? 255.0f * 255.0f / most : 0;
    for (int i = 0; i < size * size; i++)
        rgba[i] = (ink & 0xffffffu) | (unsigned)(sqrtf(work[i] * scale) + 0.5f) << 24;
    return (double)most;
}
