/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_chi2.c: histogram and statistic; see check_chi2.h. */
#include "core/render/check_chi2.h"

#include <math.h>
#include <stdlib.h>

#include "core/render/check_jumps.h"
#include "core/render/check_probability.h"
#include "core/render/check_quadrature.h"

enum { ROWS = 32, ROW_CELLS = 64, STEPS = 512 };

struct mu_cells {
    mu_region region;
    double edge[ROWS][ROW_CELLS + 1]; /* in x */
    size_t count[ROWS];
    double probability[ROWS][ROW_CELLS];
    double doubt[ROWS][ROW_CELLS]; /* estimated error of the probability */
    double seen[ROWS][ROW_CELLS];
    double outside, samples, total, error;
};

typedef struct density_context {
    const mu_region *region;
    mu_slope_density density;
    void *context;
} density_context;

static void density_at(void *context, double x, double y, double value[MU_PARTS]) {
    const density_context *d = context;
    double m[3];
    const double area = mu_region_point(d->region, x, y, m);
    value[0] = area > 0 ? area * d->density(d->context, m) : 0;
}

/* Probability of the row up to each of STEPS + 1 values of x, by the midpoint rule: only to place the cells.
 */
static double accumulate(density_context *d, size_t row, double sum[STEPS + 1]) {
    sum[0] = 0;
    for (size_t i = 0; i < STEPS; i++) {
        double value[MU_PARTS];
        density_at(d, ((double)i + .5) / STEPS, ((double)row + .5) * 2 / ROWS, value);
        sum[i + 1] = sum[i] + value[0] * (2. / ROWS) / STEPS;
    }
    return sum[STEPS];
}

static void cut(double edge[], size_t count, const double sum[STEPS + 1]) {
    edge[0] = 0;
    for (size_t c = 1, i = 0; c < count; c++) {
        const double wanted = sum[STEPS] * (double)c / (double)count;
        while (i < STEPS - 1 && sum[i + 1] < wanted) i++;
        const double step = sum[i + 1] - sum[i];
        edge[c] = ((double)i + (step > 0 ? fmax(0, fmin(1, (wanted - sum[i]) / step)) : .5)) / STEPS;
    }
    edge[count] = 1;
}

/* Placed so that a mutually wrong density and quantile cannot agree: the probability is integrated over the
 * cell. */
static double narrowest_of(const mu_cells *cells, size_t row) {
    double width = 1;
    for (size_t c = 0; c < cells->count[row]; c++)
        width = fmin(width, cells->edge[row][c + 1] - cells->edge[row][c]);
    return fmax(width, 1. / STEPS);
}

static void integrate_jumpy_cells(mu_cells *cells, density_context *d) {
    double squares = 0;
    for (size_t row = 0; row < ROWS; row++)
        for (size_t c = 0; c < cells->count[row]; c++) {
            const double y[2] = {2. * (double)row / ROWS, 2. * (double)(row + 1) / ROWS};
            double *p = &cells->probability[row][c], *doubt = &cells->doubt[row][c];
            mu_integrate_jumps(density_at, d, &cells->edge[row][c], y, narrowest_of(cells, row), p, doubt);
            cells->total += *p;
            if (*doubt > 0) squares += *doubt * *doubt / (*p + *doubt);
        }
    cells->error = sqrt(squares);
}

static void integrate_cells(mu_cells *cells, density_context *d, double mean, size_t pieces) {
    const mu_quadrature q = {.integrand = density_at,
                             .context = d,
                             .parts = 1,
                             .target = {mean * 1e-4},
                             .panel_limit = 256,
                             .rule = MU_KRONROD_7};
    for (size_t row = 0; row < ROWS; row++)
        for (size_t c = 0; c < cells->count[row]; c++) {
            /* A wide cell starts from panels of 4 in t, so that no peak hides between the nodes. */
            const double *x = &cells->edge[row][c], reach = -log(cells->region.far) - cells->region.low;
            const size_t columns = pieces + (size_t)((x[1] - x[0]) * reach / 4);
            const double y[2] = {2. * (double)row / ROWS, 2. * (double)(row + 1) / ROWS};
            const mu_integral cell = mu_integrate(&q, x, columns, y, pieces);
            cells->probability[row][c] = cell.value[0];
            cells->total += cell.value[0];
            cells->doubt[row][c] = cell.panels ? cell.error[0] : INFINITY;
            cells->error = fmax(cells->error, cells->doubt[row][c] / mean);
        }
}

mu_cells *mu_cells_make(const mu_region *region, mu_slope_density density, void *context, size_t wanted,
                        size_t pieces) {
    mu_cells *cells = calloc(1, sizeof *cells);
    double(*sums)[STEPS + 1] = malloc(ROWS * sizeof *sums);
    double total = 0;
    if (cells && sums) {
        cells->region = *region;
        density_context d = {&cells->region, density, context};
        for (size_t row = 0; row < ROWS; row++) total += accumulate(&d, row, sums[row]);
        if (isfinite(total) && total > 0) {
            for (size_t row = 0; row < ROWS; row++) {
                const double share = sums[row][STEPS] / total * (double)wanted;
                cells->count[row] = share < 1 ? 1 : share > ROW_CELLS ? ROW_CELLS : (size_t)(share + .5);
                cut(cells->edge[row], cells->count[row], sums[row]);
            }
            if (pieces)
                integrate_cells(cells, &d, total / (double)wanted, pieces);
            else
                integrate_jumpy_cells(cells, &d);
        }
    }
    free(sums);
    if (cells && !(isfinite(cells->total) && cells->total > 0)) {
        free(cells);
        cells = NULL;
    }
    return cells;
}

void mu_cells_free(mu_cells *cells) {
    free(cells);
}

double mu_cells_error(const mu_cells *cells) {
    return cells->error;
}

void mu_cells_add(mu_cells *cells, const double m[3]) {
    double x, y;
    cells->samples++;
    if (!mu_region_locate(&cells->region, m, &x, &y)) {
        cells->outside++;
        return;
    }
    const size_t row = y >= 2 ? ROWS - 1 : (size_t)(y * ROWS / 2);
    size_t low = 0, high = cells->count[row];
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (x < cells->edge[row][middle])
            high = middle;
        else
            low = middle;
    }
    cells->seen[row][low]++;
}

typedef struct bin {
    double expected, seen, doubt;
} bin;

static int by_expected(const void *a, const void *b) {
    const double x = ((const bin *)a)->expected, y = ((const bin *)b)->expected;
    return (x > y) - (x < y);
}

double mu_cells_p(const mu_cells *cells) {
    bin bins[ROWS * ROW_CELLS + 1];
    size_t count = 0;
    bins[count++] = (bin){fmax(0, 1 - cells->total) * cells->samples, cells->outside, 0};
    for (size_t row = 0; row < ROWS; row++)
        for (size_t c = 0; c < cells->count[row]; c++)
            bins[count++] = (bin){cells->probability[row][c] * cells->samples, cells->seen[row][c],
                                  cells->doubt[row][c] * cells->samples};
    qsort(bins, count, sizeof *bins, by_expected);
    double statistic = 0, doubt = 0, freedom = -1;
    bin pool = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        pool.expected += bins[i].expected;
        pool.seen += bins[i].seen;
        pool.doubt += bins[i].doubt;
        const _Bool last = i + 1 == count;
        if (pool.expected < 5 && !last) continue;
        if (!(pool.expected > 0)) return pool.seen > 0 ? 0 : 1;
        statistic += (pool.seen - pool.expected) * (pool.seen - pool.expected) / pool.expected;
        doubt += pool.doubt * pool.doubt / pool.expected;
        freedom++;
        pool = (bin){0, 0, 0};
    }
    /* The statistic is a squared distance from the expected counts; if these are off by the doubt, it is off by no more than
     * that distance (triangle inequality). */
    const double distance = fmax(0, sqrt(statistic) - sqrt(doubt));
    return freedom > 0 ? mu_chi2_p(distance * distance, freedom) : 1;
}
