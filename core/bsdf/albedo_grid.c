/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_grid.c: tables for an M of the point, of a microsurface that is level, and isotropic before M: what it loses depends on
 * the two slope roughnesses that M makes of it, the singular values A >= B of s M^-1 (s the slope unit), and on the axes.
 *
 * A table for each pair of a grid of both, in even steps of an octave from 1/128 to 2; between its nodes the mean of three, by
 * triangles with an edge along A = B, linear in log2 A and log2 B, turned to the axes of M. Beyond the grid it is the nearest
 * of its surfaces. What triangles leave is measured where they are largest, at the middle of the long edge (measure_gap).
 */
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/multiple.h"

#if MU_REAL_BITS == 24

enum { GRID_HALVINGS = 4, PROBES = 4, ROOTS_HOLD = 4 };

static double roughness_of(double at, int steps) {
    return (double)ALBEDO_GRID_LEAST * exp2(at / steps);
}

void mu_albedo_grid_choose(const albedo_grid *grid, float a, float b, mu_lobe *out) {
    const float steps = (float)grid->steps, last = ALBEDO_OCTAVES * steps;
    const float x = fminf(fmaxf(steps * log2f(a / ALBEDO_GRID_LEAST), 0), last),
                y = fminf(fmaxf(steps * log2f(b / ALBEDO_GRID_LEAST), 0), x);
    const int i = (int)fminf(x, last - 1), j = (int)fminf(y, (float)i);
    const float fx = x - (float)i, fy = fminf(y - (float)j, 1), low = fminf(fx, fy), high = fmaxf(fx, fy);
    const struct {
        int node;
        float share;
    } corners[3] = {{albedo_grid_node(i, j), 1 - high},
                    {fx >= fy ? albedo_grid_node(i + 1, j) : albedo_grid_node(i, j + 1), high - low},
                    {albedo_grid_node(i + 1, j + 1), low}};
    out->count = 0;
    for (int k = 0; k < 3; k++) {
        if (!(corners[k].share > 0)) continue;
        out->level[out->count] = &grid->table[corners[k].node];
        out->share[out->count++] = corners[k].share;
    }
}

/* 1 - E of single scattering at singular values a and b, toward w. */
static float lost_of(const albedo_source *source, double a, double b, const float w[3]) {
    const float m[4] = {(float)(source->surface->unit / a), 0, 0, (float)(source->surface->unit / b)};
    closure c;
    if (!MU(mu_bind)(source->surface, w, m, &c)) return 1;
    return 1 - MU(albedo_integral)(&c, mu_albedo_core(source, &c), fmin(source->error / 8, 1e-3));
}

/* The most that tables are off between nodes: views at heights from an eighth to eight times the roughness of their azimuth. */
static float measure_gap(const albedo_source *source, const albedo_grid *grid) {
    float most = 0;
    for (int i = 0; i < ALBEDO_OCTAVES * grid->steps; i++)
        for (int j = 0; j <= i; j++) {
            const double a = roughness_of(i + 0.5, grid->steps), b = roughness_of(j + 0.5, grid->steps);
            mu_lobe lobe;
            mu_albedo_grid_choose(grid, (float)a, (float)b, &lobe);
            for (int k = 0; k < PROBES * PROBES; k++) {
                const double psi = PI / 2 * (k % PROBES + 0.5) / PROBES, x = cos(psi),
                             y = sin(psi) * sqrt(a / b);
                const double z = hypot(a * x, b * y) * exp2(2 * (k / PROBES) - 3),
                             length = sqrt(x * x + y * y + z * z);
                const float w[3] = {(float)(x / length), (float)(y / length), (float)(z / length)};
                float told = 0;
                for (int l = 0; l < lobe.count; l++)
                    told +=
                        lobe.share[l] * albedo_lost(&lobe.level[l]->side[0], albedo_locate(lobe.level[l], w));
                most = fmaxf(most, fabsf(told - lost_of(source, a, b, w)));
            }
        }
    return most;
}

size_t mu_albedo_grid_make(const albedo_source *like, int steps, mu_albedo *table, float *values, size_t most,
                           float *unsure) {
    const albedo_grid grid = {table, steps};
    albedo_source source = *like;
    source.halvings = GRID_HALVINGS, source.error /= 2; /* the other half is for what lies between */
    size_t used = 0;
    float worst = 0;
    for (int i = 0; i <= ALBEDO_OCTAVES * steps; i++)
        for (int j = 0; j <= i; j++) {
            mu_albedo *t = &table[albedo_grid_node(i, j)];
            const float m[4] = {(float)(source.surface->unit / roughness_of(i, steps)), 0, 0,
                                (float)(source.surface->unit / roughness_of(j, steps))};
            source.transform = m;
            source.roots = j == i || j % ROOTS_HOLD == 0 ? 0 : 1 + t[-1].roots; /* it changes slowly */
            used += mu_albedo_make(&source, t, values + used,
                                   most - used < ALBEDO_GRID_MOST ? most - used : ALBEDO_GRID_MOST);
            worst = fmaxf(worst, t->side[0].unsure);
        }
    source.transform = NULL;
    worst = fmaxf(worst, measure_gap(&source, &grid));
    *unsure = worst > (float)like->error ? worst : 0;
    return used;
}

#endif
