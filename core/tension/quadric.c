/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * quadric.c: see quadric.h. The normal equations are scaled to a unit diagonal, which takes the size of the triangles out, and
 * factored by Cholesky; a pivot is 1 - R^2 of its term against those before it.
 */
#include "core/tension/quadric.h"

#include <math.h>
#include <string.h>

#include "core/tension/shape.h"

static void add(mu_quadric *fit, const mu_ground *g, const mu_plane *plane, const double *p, const double *q,
                size_t vertex, double v) {
    double dp[3], term[MU_QUADRIC_TERMS], value[MU_QUADRIC_VALUES];
    for (size_t k = 0; k < 3; k++) {
        dp[k] = g->in->rest[3 * vertex + k] - p[k];
        value[MU_QUADRIC_Q + k] = g->in->deformed[3 * vertex + k] - q[k];
    }
    const double square = mu_shape_dot(dp, dp), weight = 1 / square;
    if (!(square > 0)) return; /* torn: one place at rest, two deformed */
    const double x = mu_shape_dot(dp, plane->s1), y = mu_shape_dot(dp, plane->s2);
    term[0] = x, term[1] = y, term[2] = x * x, term[3] = x * y, term[4] = y * y;
    value[MU_QUADRIC_H] = mu_shape_dot(dp, plane->n), value[MU_QUADRIC_V] = v;
    for (int i = 0; i < MU_QUADRIC_TERMS; i++) {
        const double w = weight * term[i];
        for (int j = 0; j <= i; j++) fit->a[i][j] += w * term[j];
        for (int k = 0; k < MU_QUADRIC_VALUES; k++) fit->b[k][i] += w * value[k];
    }
}

void mu_quadric_fit(mu_ground *g, const mu_plane *plane, uint32_t centre, const double *uvs,
                    mu_quadric *fit) {
    const size_t vertex = g->in->corner[centre];
    const double *p = g->in->rest + 3 * vertex, *q = g->in->deformed + 3 * vertex;
    memset(fit, 0, sizeof *fit);
    g->place_seen[g->place[vertex]] = g->now;
    for (uint32_t i = 0; i < g->count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const size_t corner = 3 * (size_t)g->face[i] + k;
            const uint32_t place = mu_ground_place(g, (uint32_t)corner);
            if (g->place_seen[place] == g->now) continue;
            g->place_seen[place] = g->now;
            add(fit, g, plane, p, q, g->in->corner[corner],
                uvs ? uvs[2 * corner + 1] - uvs[2 * (size_t)centre + 1] : 0);
        }
}

_Bool mu_quadric_slopes(const mu_quadric *fit, int degree, double least, double slope[MU_QUADRIC_VALUES][2]) {
    const int terms = degree > 1 ? MU_QUADRIC_TERMS : 2;
    double l[MU_QUADRIC_TERMS][MU_QUADRIC_TERMS], unit[MU_QUADRIC_TERMS], inverse[MU_QUADRIC_TERMS];
    for (int i = 0; i < terms; i++) {
        if (!(fit->a[i][i] > 0)) return 0;
        unit[i] = 1 / sqrt(fit->a[i][i]);
        for (int j = 0; j <= i; j++) {
            double sum = fit->a[i][j] * (unit[i] * unit[j]);
            for (int k = 0; k < j; k++) sum -= l[i][k] * l[j][k];
            if (j < i) {
                l[i][j] = sum * inverse[j];
                continue;
            }
            if (!(sum > least)) return 0;
            inverse[i] = 1 / sqrt(sum);
        }
    }
    for (int c = 0; c < 2; c++) { /* a row of the inverse */
        double z[MU_QUADRIC_TERMS];
        for (int i = 0; i < terms; i++) {
            double sum = i == c ? unit[c] : 0;
            for (int k = 0; k < i; k++) sum -= l[i][k] * z[k];
            z[i] = sum * inverse[i];
        }
        for (int i = terms; i-- > 0;) {
            double sum = z[i];
            for (int k = i + 1; k < terms; k++) sum -= l[k][i] * z[k];
            z[i] = sum * inverse[i];
        }
        for (int i = 0; i < terms; i++) z[i] *= unit[i];
        for (int k = 0; k < MU_QUADRIC_VALUES; k++) {
            slope[k][c] = 0;
            for (int i = 0; i < terms; i++) slope[k][c] += z[i] * fit->b[k][i];
        }
    }
    return 1;
}
