/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.c: see albedo.h. Directions along the lobe (even.h). Cubic between nodes (Lagrange).
 *
 * Nodes are where the renderer has them (core/render/albedo_place.c), but along heights, where they are even in the root of
 * h / (h + s), which is quicker than asinh: h = z / (1 + root(1 - z²)), s the mean roughness of the lobe.
 */
#include "scripts/page/albedo.h"

#include <math.h>
#include <string.h>

#include "core/ibl/even.h"

/* The view of the node on the horizon. */
#define LEAST_COSINE 1e-6
/* The least s that heights take notice of. */
#define SMOOTHEST 0.05f

enum { LAST = PAGE_COSINES - 1, QUARTER = PAGE_AZIMUTHS - 1 }; /* steps up, and of a quarter turn */

static void even_light(const page_material *m, const double wo[3], mu_ibl_fibonacci lattice, float rgb[4]) {
    static const double still[2] = {0, 0};
    const float seen[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    double sum[3] = {0, 0, 0};
    mu_closure_f c;
    mu_ibl_even even;
    mu_ibl_even_make(&m->lobe_exact, wo, &even);
    const int bright = mu_bind_f(m->shaded, seen, NULL, &c);
    for (uint32_t i = 0; bright && i < lattice.count; i++) {
        double u[2], wi[3];
        mu_value_f value;
        mu_ibl_fibonacci_at(lattice, still, i, u);
        const double weight = mu_ibl_even_direction(&even, u, wi) * wi[2];
        if (!(weight > 0)) continue;
        mu_eval_f(&c, (const float[3]){(float)wi[0], (float)wi[1], (float)wi[2]}, &value);
        for (int k = 0; k < 3; k++) sum[k] += weight * (double)value.f[k];
    }
    for (int k = 0; k < 3; k++) rgb[k] = (float)(sum[k] / lattice.count);
    rgb[3] = 0;
}

void page_albedo_make(page_albedo *t, const page_material *m, int samples) {
    const mu_ibl_fibonacci lattice = mu_ibl_fibonacci_below((uint64_t)samples);
    const double *sigma = m->lobe_exact.sigma, *turn = m->lobe_exact.turn;
    const _Bool rough = sigma[1] > 0;
    t->scale = fmaxf((float)sqrt(2 * sigma[0] * sigma[1]), SMOOTHEST);
    t->widen[0] = rough ? (float)sqrt(sigma[0]) : 1, t->widen[1] = rough ? (float)sqrt(sigma[1]) : 1;
    for (int a = 0; a <= QUARTER; a++)
        for (int i = 0; i <= LAST; i++) {
            const double root = (double)i / LAST, s = (double)t->scale, h = root * root * s / (1 + s - root * root);
            const double z = fmin(fmax(2 * h / (1 + h * h), LEAST_COSINE), 1), angle = 1.5707963267948966 * a / QUARTER;
            const double u = cos(angle) / (double)t->widen[0], v = sin(angle) / (double)t->widen[1];
            const double flat = sqrt((1 - z) * (1 + z)) / hypot(u, v), x = flat * u, y = flat * v;
            even_light(m, (const double[3]){turn[0] * x - turn[1] * y, turn[1] * x + turn[0] * y, z}, lattice, t->rgb[a + 1][i]);
        }
    memcpy(t->rgb[0], t->rgb[2], sizeof t->rgb[0]); /* mirrored */
    memcpy(t->rgb[QUARTER + 2], t->rgb[QUARTER], sizeof t->rgb[0]);
}

static inline float least_of(float a, float b) {
    return a < b ? a : b;
}
static inline float most_of(float a, float b) {
    return a > b ? a : b;
}

/* The angle of x, y >= 0 over a quarter turn. */
static inline float quarters(float x, float y) {
    const float least = least_of(x, y), most = most_of(x, y), r = least / most_of(most, 1e-30f);
    const float r2 = r * r; /* of atan r, to 1e-5 (Hastings 1955) */
    const float angle = r * (0.9998660f + r2 * (-0.3302995f + r2 * (0.1801410f + r2 * (-0.0851330f + r2 * 0.0208351f)))) * 0.63661977f;
    return y > x ? 1 - angle : angle;
}

/* Where views are among nodes: the first of four by four, and the weights of each; worked out for several at a time. */
typedef struct places {
    int row[MU_IBL_AXES], node[MU_IBL_AXES];
    float of_row[4][MU_IBL_AXES], of_node[4][MU_IBL_AXES];
} places;

/* Weights of nodes at -1, 0, 1, 2. */
static inline void four(float x, size_t i, float (*weight)[MU_IBL_AXES]) {
    const float a = x + 1, b = x - 1, c = x - 2;
    weight[0][i] = -x * b * c / 6, weight[1][i] = a * b * c / 2, weight[2][i] = -a * x * c / 2, weight[3][i] = a * x * b / 6;
}

static inline void find(const page_albedo *t, const mu_ibl_lobe_f *lobe, const float (*restrict wo)[MU_IBL_AXES], places *restrict p) {
    const float cosine = lobe->turn[0], sine = lobe->turn[1], scale = t->scale, wide = t->widen[0], high = t->widen[1];
    for (size_t i = 0; i < MU_IBL_AXES; i++) {
        const float x = fabsf(cosine * wo[0][i] + sine * wo[1][i]), y = fabsf(cosine * wo[1][i] - sine * wo[0][i]);
        const float h = most_of(wo[2][i], 0) / (1 + sqrtf(x * x + y * y));
        const float up = sqrtf(h * (1 + scale) / (h + scale)) * LAST, around = quarters(wide * x, high * y) * QUARTER;
        const int node = (int)least_of(most_of(up - 1, 0), LAST - 3), row = (int)least_of(around, QUARTER - 1);
        p->node[i] = node, p->row[i] = row;
        four(up - (float)(node + 1), i, p->of_node);
        four(around - (float)row, i, p->of_row);
    }
}

void page_albedo_at(const page_albedo *t, const mu_ibl_lobe_f *lobe, const float (*wo)[MU_IBL_AXES], float (*rgb)[4]) {
    places p;
    find(t, lobe, wo, &p);
    for (size_t i = 0; i < MU_IBL_AXES; i++) {
        float sum[4] = {0, 0, 0, 0};
        for (int r = 0; r < 4; r++) {
            const float(*const node)[4] = &t->rgb[p.row[i] + r][p.node[i]];
            float row[4] = {0, 0, 0, 0};
            for (int n = 0; n < 4; n++)
                for (int k = 0; k < 4; k++) row[k] += p.of_node[n][i] * node[n][k];
            for (int k = 0; k < 4; k++) sum[k] += p.of_row[r][i] * row[k];
        }
        memcpy(rgb[i], sum, sizeof sum);
    }
}
