/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_lobe.c: the smooth lobe of albedo.h, lost(w) cos w: how much of it lies in which cell, and directions drawn from it,
 * uniform in u and S within a cell.
 */
#include "core/bsdf/albedo.h"
#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

/* Gauss-Legendre on [0, 1], 4 nodes. */
static const double node[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                               0.93056815579702629};
static const double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872693};

void mu_albedo_direction(const mu_albedo *t, const mu_albedo_side *side, const mu_albedo_frame *f,
                         int quadrant, float u, float s, float w[3]) {
    float rest = fmaxf(1 - s, 0);
    for (int k = 0; k < side->roots; k++) rest *= rest;
    const float root = side->roots ? sqrtf(1 - rest) : sqrtf(fminf(s, 1)),
                r = root * (1 + root) / fmaxf(rest, 1e-7f);
    const int round = t->columns == 1;
    const float x = round ? cosf(u * (float)(PI / 2)) : -expm1f((u - 1) * f->log) / f->k,
                y = round ? sinf(u * (float)(PI / 2)) : expm1f(u * f->log), scale = r / hypotf(x, y);
    const float q[2] = {quadrant & 1 ? -scale * x : scale * x, quadrant & 2 ? -scale * y : scale * y};
    w[0] = f->from[0] * q[0] + f->from[1] * q[1];
    w[1] = f->from[2] * q[0] + f->from[3] * q[1];
    const float length = hypotf(hypotf(w[0], w[1]), 1);
    w[0] /= length, w[1] /= length, w[2] = 1 / length;
}

static void integrate_panel(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side,
                            int quadrant, double u0, double u1, double s0, double s1, double sums[2]) {
    for (int i = 0; i < 16; i++) {
        float w[3];
        mu_albedo_direction(t, side, f, quadrant, (float)(u0 + (u1 - u0) * node[i / 4]),
                            (float)(s0 + (s1 - s0) * node[i % 4]), w);
        const albedo_place at = albedo_locate(t, side, f, w);
        const double cosines =
            weight[i / 4] * weight[i % 4] * (u1 - u0) * (s1 - s0) * (double)w[2] / (double)at.stretch;
        sums[0] += cosines * (double)albedo_lost(side, at), sums[1] += cosines;
    }
}

/* The integral of lost cos over u0 ... u1 of a cell of S, and of cos, by Gauss's rule. A cell at S = 0 is halved toward it: of
 * a smooth surface that is where most directions are. */
static void integrate(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, int quadrant,
                      double u0, double u1, double s0, double s1, double sums[2]) {
    double high = s1;
    for (; s0 == 0 && high > 0.25 * (double)f->det; high /= 2)
        integrate_panel(t, f, side, quadrant, u0, u1, high / 2, high, sums);
    integrate_panel(t, f, side, quadrant, u0, u1, s0, high, sums);
}

/* Along u a cell at 0 is halved toward it: where u is a logarithm, that is where most azimuths are. */
static double share(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, int quadrant,
                    double u0, double u1, double s0, double s1, double *cosines) {
    double sums[2] = {0, 0};
    if (u0 > 0 || t->columns == 1) {
        integrate(t, f, side, quadrant, u0, u1, s0, s1, sums);
    } else {
        double high = u1;
        for (; high * (double)f->log > 0.5; high /= 2)
            integrate(t, f, side, quadrant, high / 2, high, s0, s1, sums);
        integrate(t, f, side, quadrant, 0, high, s0, s1, sums);
    }
    *cosines += sums[1];
    return sums[0];
}

/* The cells' integrals, unless they are NULL; returns the average. */
static double integrate_cells(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side,
                              float *cells, double *total) {
    double cosines = 0;
    *total = 0;
    for (int k = 0; k < t->quadrants * t->columns * ALBEDO_ROWS; k++) {
        const albedo_patch *p = &side->patch[k];
        const int column = k / ALBEDO_ROWS % t->columns, across = 1 << p->log_u, up = 1 << p->log_s;
        for (int i = 0; i < across * up; i++) {
            const double u = (column + (double)(i / up) / across) / t->columns,
                         row = (k % ALBEDO_ROWS + (double)(i % up) / up) / ALBEDO_ROWS;
            const double sum =
                share(t, f, side, k / ALBEDO_ROWS / t->columns, u, u + 1.0 / across / t->columns,
                      albedo_s(side, row), albedo_s(side, row + 1.0 / up / ALBEDO_ROWS), &cosines);
            if (cells) cells[p->cell + (uint32_t)i] = (float)sum;
            *total += sum;
        }
    }
    return *total / cosines;
}

double mu_albedo_average(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side) {
    double total;
    return integrate_cells(t, f, side, NULL, &total);
}

void mu_albedo_fill_lobe(const mu_albedo *t, mu_albedo_side *side, float *cumulative) {
    double total, so_far = 0;
    side->average = (float)integrate_cells(t, &t->frame, side, cumulative, &total);
    side->cumulative = cumulative;
    for (uint32_t cell = 0; cell < side->cells; cell++) {
        so_far += (double)cumulative[cell] / total;
        cumulative[cell] = (float)so_far;
    }
    cumulative[side->cells - 1] = 1;
}

void mu_albedo_draw(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, float u0,
                    float u1, float w[3]) {
    uint32_t low = 0, high = side->cells - 1;
    while (low < high) { /* the first cell whose sum is above u0 */
        const uint32_t middle = (low + high) / 2;
        if (side->cumulative[middle] > u0) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    const float before = low ? side->cumulative[low - 1] : 0;
    float within = fminf((u0 - before) / (side->cumulative[low] - before), 0x0.ffffffp0f);
    int patch = 0;
    while (patch + 1 < t->quadrants * t->columns * ALBEDO_ROWS && side->patch[patch + 1].cell <= low) patch++;
    const albedo_patch *p = &side->patch[patch];
    const int i = (int)(low - p->cell), up = 1 << p->log_s;
    int quadrant = patch / ALBEDO_ROWS / t->columns;
    if (t->quadrants == 1) { /* which of the four */
        quadrant = (int)(4 * within);
        within = 4 * within - (float)quadrant;
    }
    const float u = ((float)(i / up) + within) / (float)(1 << p->log_u);
    const double row = patch % ALBEDO_ROWS + (double)(i % up) / up, from = albedo_s(side, row / ALBEDO_ROWS),
                 to = albedo_s(side, (row + 1.0 / up) / ALBEDO_ROWS);
    mu_albedo_direction(t, side, f, quadrant,
                        ((float)(patch / ALBEDO_ROWS % t->columns) + u) / (float)t->columns,
                        (float)(from + (to - from) * (double)u1), w);
}

#endif
