/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* fit_examine.c: surfaces that no smooth distribution can stand for, told from samples of heights and slopes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/surface/fit.h"

enum { FEW = 16, LEAST_SIDE = 32 };
static const double mostly = 0.5; /* of facets in few orientations: no density */
static const double coarsest =
    0.1; /* step of heights over the median slope: slopes are a lattice that bins see */

static int rising(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The step of which all sampled heights are multiples, to a fiftieth (16 bits of range, rounded to floats, leave 0.008);
 * 0 if there is none. Gaps of less than 10^-6 of the range are rounding to floats. */
static double height_step(const mu_heightfield *f, double *room) {
    const uint64_t heights = mu_cells(f);
    const uint32_t count = heights < MU_SAMPLE ? (uint32_t)heights : MU_SAMPLE;
    for (uint32_t k = 0; k < count; k++) room[k] = f->h[(uint64_t)k * heights / count];
    qsort(room, count, sizeof *room, rising);
    const double range = room[count - 1] - room[0];
    double step = range;
    for (uint32_t k = 1; k < count; k++)
        if (room[k] - room[k - 1] > 1e-6 * range) step = fmin(step, room[k] - room[k - 1]);
    step = range / nearbyint(range / step); /* one gap tells less */
    for (uint32_t k = 1; k < count; k++) {
        const double times = (room[k] - room[0]) / step;
        if (fabs(times - nearbyint(times)) > 0.02) return 0;
    }
    return step;
}

/* The share of the sampled slopes in the 16 fullest cells of the given size, and how many of them hold 99 % of it. */
static double in_few_cells(const double *sample, uint32_t count, double cell, double *room, int *cells) {
    double top[FEW] = {0}, sum = 0, part = 0;
    for (uint32_t k = 0; k < count; k++) /* one number per cell: rows of 2^26 cells */
        room[k] = nearbyint(sample[2 * k] / cell) * 0x1p26 + nearbyint(sample[2 * k + 1] / cell);
    qsort(room, count, sizeof *room, rising);
    for (uint32_t k = 0, from = 0; k < count; k++)
        if (k + 1 == count || room[k + 1] != room[k]) {
            double run = k + 1 - from;
            from = k + 1;
            for (int t = 0; t < FEW; t++)
                if (run > top[t]) {
                    const double less = top[t];
                    top[t] = run, run = less;
                }
        }
    for (int t = 0; t < FEW; t++) sum += top[t];
    for (*cells = 0; *cells < FEW && part < 0.99 * sum; ++*cells) part += top[*cells];
    return sum / count;
}

static _Bool refuse(mu_fit *fit, const char *reason) {
    fit->verdict = MU_FIT_REFUSED;
    snprintf(fit->reason, sizeof fit->reason, "%s", reason);
    return 0;
}

_Bool mu_fit_examine(mu_fit *fit, const mu_slopes *s, const double *sample, uint32_t count) {
    double low = s->f.h[0], high = low, extent = 0, middle[2], median = 0;
    for (size_t k = 0; k < mu_cells(&s->f); k++) {
        if (!isfinite(s->f.h[k])) return refuse(fit, "there are heights that are not finite");
        low = fmin(low, s->f.h[k]), high = fmax(high, s->f.h[k]);
    }
    if (low == high) return fit->verdict = MU_FIT_FLAT, 0;
    if (mu_slopes_side(s) < LEAST_SIDE) {
        snprintf(fit->reason, sizeof fit->reason,
                 "too few facets: %.0f; %d x %d cells are the least from which blocks tell an error",
                 fit->facets, LEAST_SIDE, LEAST_SIDE);
        return fit->verdict = MU_FIT_REFUSED, 0;
    }
    double *room = malloc(MU_SAMPLE * sizeof *room);
    if (!room) return fit->verdict = MU_FIT_NO_MEMORY, 0;
    for (int axis = 0; axis < 2; axis++) {
        for (uint32_t k = 0; k < count; k++) room[k] = sample[2 * k + (uint32_t)axis];
        qsort(room, count, sizeof *room, rising);
        middle[axis] = room[count / 2];
    }
    for (uint32_t k = 0; k < count; k++)
        extent += (room[k] = hypot(sample[2 * k] - middle[0], sample[2 * k + 1] - middle[1])) / count;
    qsort(room, count, sizeof *room, rising);
    median = room[count / 2];
    int cells;
    /* Differences of floats as large as the range are rounded to its last place */
    if (room[count - 1] <= 4e-7 * fmax(fabs(low), fabs(high)) * hypot(s->cotransform[0], s->cotransform[3])) {
        free(room);
        return refuse(fit, "all facets have one slope: a plane that is tilted, not rough; flat has no tilt");
    }
    fit->step = height_step(&s->f, room);
    const double few = in_few_cells(sample, count, extent / 1000, room, &cells);
    free(room);
    const double *m = s->cotransform,
                 step = fit->step * sqrt((m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3]) / 2);
    if (step > coarsest * median && few < 0.9) {
        snprintf(
            fit->reason, sizeof fit->reason,
            "heights come in steps of %.3g, and the median slope is %.3g: slopes are a lattice of steps, no "
            "distribution; a finer height scale is needed, at most %.3g",
            fit->step, median, coarsest * median * fit->step / step);
        return fit->verdict = MU_FIT_REFUSED, 0;
    }
    if (few > mostly) {
        snprintf(fit->reason, sizeof fit->reason,
                 "facets have few orientations, as boxes, pyramids, gratings or terraces do: %d slopes hold "
                 "%.0f %% of them",
                 cells, 100 * few);
        return fit->verdict = MU_FIT_REFUSED, 0;
    }
    return 1;
}
