/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* albedo.c: see albedo.h. By an additive lattice. */
#include "scripts/page/albedo.h"

#include <math.h>

/* The view of the node on the horizon. */
#define LEAST_COSINE 1e-4f
#define QUARTER      1.57079632679f

/* Powers of the root of x⁴ = x + 1 (Roberts 2018). */
static const double step[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

static void mean_weight(const mu_surface_f *surface, const float wo[3], int samples, float rgb[4]) {
    mu_closure_f c;
    float sum[3] = {0, 0, 0};
    if (mu_bind_f(surface, wo, NULL, &c))
        for (int i = 0; i < samples; i++) {
            float u[3];
            for (int k = 0; k < 3; k++) {
                const double place = (i + 0.5) * step[k];
                u[k] = fminf((float)(place - floor(place)), 0x1.fffffep-1f);
            }
            mu_sample_f s;
            mu_sample_wi_f(&c, u, &s);
            for (int k = 0; k < 3 && !s.rejected; k++) sum[k] += s.weight[k];
        }
    for (int k = 0; k < 3; k++) rgb[k] = sum[k] / (float)samples;
    rgb[3] = 0;
}

void page_albedo_make(page_albedo *t, const page_material *m, int samples) {
    for (int a = 0; a < PAGE_AZIMUTHS; a++)
        for (int i = 0; i < PAGE_COSINES; i++) {
            const float root = (float)i / (PAGE_COSINES - 1), z = fmaxf(root * root, LEAST_COSINE),
                        flat = sqrtf((1 - z) * (1 + z)), phi = QUARTER * (float)a / (PAGE_AZIMUTHS - 1);
            const float x = flat * cosf(phi), y = flat * sinf(phi), *turn = m->lobe.turn;
            const float wo[3] = {turn[0] * x - turn[1] * y, turn[1] * x + turn[0] * y, z};
            mean_weight(m->shaded, wo, samples, t->rgb[a][i]);
        }
}

/* The angle of x, y >= 0 over a quarter turn, to 5e-3 of it: a fortieth of the way between nodes. */
static float quarters(float x, float y) {
    const float least = fminf(x, y), most = fmaxf(x, y), r = most > 0 ? least / most : 0;
    const float angle = r * (0.7853982f + 0.273f * (1 - r)) / QUARTER; /* of atan r */
    return y > x ? 1 - angle : angle;
}

void page_albedo_at(const page_albedo *t, const mu_ibl_lobe_f *lobe, const float wo[3], float rgb[4]) {
    const float x = fabsf(lobe->turn[0] * wo[0] + lobe->turn[1] * wo[1]),
                y = fabsf(lobe->turn[0] * wo[1] - lobe->turn[1] * wo[0]);
    const float around = quarters(x, y) * (PAGE_AZIMUTHS - 1),
                up = sqrtf(fmaxf(wo[2], 0)) * (PAGE_COSINES - 1);
    const int a = around < PAGE_AZIMUTHS - 1 ? (int)around : PAGE_AZIMUTHS - 2,
              i = up < PAGE_COSINES - 1 ? (int)up : PAGE_COSINES - 2;
    const float s = around - (float)a, r = up - (float)i;
    const float *here = t->rgb[a][i], *there = t->rgb[a + 1][i];
    for (int k = 0; k < 4; k++)
        rgb[k] =
            (1 - s) * ((1 - r) * here[k] + r * here[4 + k]) + s * ((1 - r) * there[k] + r * there[4 + k]);
}
