/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* slope_histogram.c: the slopes (dz/dx, dz/dy) of a heightfield's triangles. */
#include "core/render/slope_histogram.h"

#include <math.h>
#include <string.h>

/* Of L = (i,j), (i+1,j), (i,j+1), then of U = (i+1,j+1), (i,j+1), (i+1,j). */
static void slopes_of(const float *heights, size_t nx, size_t ny, size_t i, size_t j, double slope[2][2]) {
    const size_t next_i = (i + 1) % nx, next_j = (j + 1) % ny;
    const double here = (double)heights[i * ny + j], x = (double)heights[next_i * ny + j],
                 y = (double)heights[i * ny + next_j], both = (double)heights[next_i * ny + next_j];
    slope[0][0] = x - here, slope[0][1] = y - here;
    slope[1][0] = both - y, slope[1][1] = both - x;
}

void mu_slope_bounds(const float *heights, size_t nx, size_t ny, double bounds[4]) {
    for (int k = 0; k < 2; k++) bounds[2 * k] = INFINITY, bounds[2 * k + 1] = -INFINITY;
    for (size_t i = 0; i < nx; i++)
        for (size_t j = 0; j < ny; j++) {
            double slope[2][2];
            slopes_of(heights, nx, ny, i, j, slope);
            for (int t = 0; t < 4; t++) {
                const double s = slope[t / 2][t % 2];
                bounds[2 * (t % 2)] = fmin(bounds[2 * (t % 2)], s);
                bounds[2 * (t % 2) + 1] = fmax(bounds[2 * (t % 2) + 1], s);
            }
        }
    for (int k = 0; k < 2; k++) {
        double *b = bounds + 2 * k;
        const double size = fmax(fabs(b[0]), fabs(b[1])), wider = 1e-6 * fmax(b[1] - b[0], fmax(size, 1e-6));
        b[0] -= wider, b[1] += wider;
    }
}

size_t mu_slope_histogram(const float *heights, size_t nx, size_t ny, const double bounds[4], size_t bins,
                          double *weights) {
    size_t outside = 0;
    memset(weights, 0, bins * bins * sizeof *weights);
    const double per_x = (double)bins / (bounds[1] - bounds[0]),
                 per_y = (double)bins / (bounds[3] - bounds[2]);
    for (size_t i = 0; i < nx; i++)
        for (size_t j = 0; j < ny; j++) {
            double slope[2][2];
            slopes_of(heights, nx, ny, i, j, slope);
            for (int t = 0; t < 2; t++) {
                const double x = (slope[t][0] - bounds[0]) * per_x, y = (slope[t][1] - bounds[2]) * per_y;
                if (x >= 0 && x < (double)bins && y >= 0 && y < (double)bins)
                    weights[(size_t)y * bins + (size_t)x]++;
                else
                    outside++;
            }
        }
    return outside;
}
