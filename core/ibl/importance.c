/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * importance.c: filtered importance sampling (Krivanek and Colbert 2008), as Dupuy et al. 2013 use it in real time: n x n even
 * samples of the slopes, each read as blurred as its share of the lobe is large. The technique that Figure 21 compares with.
 *
 * Slopes of GGX: rings i of equal mass, r² = u / (1 - u) at u = (i + 1/2) / n, n azimuths in each, turned from ring to ring by the golden
 * ratio. A sample stands for the solid angle 1 / (N pdf), pdf = P22 |n|³ / 4 (wo.m), n = m / m.z. A disk of the radius R has half its mass
 * within R / sqrt(2), GGX's lobe of alpha about its mirrored view within 2 alpha: alpha = R / sqrt(8), and twice that, so that
 * neighbours overlap (their factor 4 of the area). Weights are f cos / pdf, G2 (wo.m) / m.z but for what all share, below the horizon 0,
 * made 1 in all. The mean slope is left out.
 */
#include "core/ibl/importance.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

#define GOLDEN 0.61803398874989485
#define MOST   1e6f /* of alpha: squares of squares stay finite */

size_t mu_ibl_importance_make(size_t count, mu_ibl_grid *grid) {
    size_t n = 1;
    while ((n + 1) * (n + 1) <= count) n++;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double u = ((double)i + 0.5) / (double)n, r = sqrt(u / (1 - u));
            const double phi = 2 * PI * ((double)j / (double)n + GOLDEN * (double)i);
            grid->along[i * n + j] = (float)(r * cos(phi)), grid->across[i * n + j] = (float)(r * sin(phi));
            grid->weight[i * n + j] = (float)(1 / (double)(n * n));
        }
    return n * n;
}

/* Smith's, of GGX */
static float lambda(const float axes[2][2], const float w[3]) {
    const float u = axes[0][0] * w[0] + axes[0][1] * w[1], v = axes[1][0] * w[0] + axes[1][1] * w[1];
    return (sqrt(1 + (u * u + v * v) / larger(w[2] * w[2], REAL_MIN)) - 1) / 2;
}

size_t mu_ibl_importance_reads(const mu_ibl_grid *grid, size_t count, const mu_ibl_lobe_f *lobe, const float wo[3],
                               mu_ibl_read *out) {
    const float root2 = 1.41421356237309504880f;
    const float a = smaller(root2 * lobe->sigma[0], MOST), b = smaller(root2 * lobe->sigma[1], MOST);
    const float axes[2][2] = {{a * lobe->turn[0], a * lobe->turn[1]}, {-b * lobe->turn[1], b * lobe->turn[0]}};
    const float hidden = 1 + lambda(axes, wo), area = sqrt(a * b / (float)count);
    float all = 0;
    for (size_t j = 0; j < count; j++) {
        const float x = grid->along[j], y = grid->across[j];
        const float n[3] = {-x * axes[0][0] - y * axes[1][0], -x * axes[0][1] - y * axes[1][1], 1};
        const float squared = dot(n, n), along = dot(n, wo), twice = 2 * along / squared;
        for (int k = 0; k < 3; k++) out[j].direction[k] = twice * n[k] - wo[k];
        const _Bool seen = along > 0 && out[j].direction[2] > 0;
        /* R = 2 sqrt(a b (wo.m) / (N |n|³)) (1 + r²), wo.m = along / |n| */
        const float radius = 2 * area * (1 + x * x + y * y) * sqrt(larger(along, 0)) / squared;
        out[j].roughness = smaller(sqrt(radius / root2), 1);
        out[j].weight = seen ? along / (hidden + lambda(axes, out[j].direction)) : 0; /* wo.m / m.z is along */
        all += out[j].weight;
    }
    for (size_t j = 0; j < count; j++) out[j].weight = all > 0 ? out[j].weight / all : grid->weight[j];
    return count;
}

#endif
