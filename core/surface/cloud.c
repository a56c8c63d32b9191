/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* cloud.c: the pass over all facets, and the points that stand for them. */
#include "core/surface/cloud.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647693;

static uint32_t bin_of(const double v[2], double edge, double per_ring) {
    const double r = sqrt(v[0] * v[0] + v[1] * v[1]);
    if (!(r < edge)) return MU_TAIL;
    const uint32_t ring = (uint32_t)(asinh(10 * r) * per_ring);
    const double turn = atan2(v[1], v[0]) / two_pi;
    const uint32_t sector = (uint32_t)((turn < 0 ? turn + 1 : turn) * MU_SECTORS);
    return (ring < MU_RINGS ? ring : MU_RINGS - 1) * MU_SECTORS +
           (sector < MU_SECTORS ? sector : MU_SECTORS - 1);
}

static void count_facets(mu_cloud *cloud, const mu_slopes *s) {
    const uint32_t side = mu_slopes_side(s);
    const double *m = cloud->shape, det = m[0] * m[3] - m[1] * m[2];
    const double inverse[4] = {m[3] / det, -m[1] / det, -m[2] / det, m[0] / det};
    const double per_ring = MU_RINGS / asinh(10 * cloud->edge);
    for (uint32_t i = 0; i < side; i++)
        for (uint32_t j = 0; j < side; j++) {
            const uint32_t row = mu_patch_row(s, i), column = mu_patch_row(s, j);
            uint32_t *counts = cloud->counts + (size_t)(row * MU_PATCHES + column) * (MU_BINS + 1);
            mu_bin_moments *moments = cloud->moments + (size_t)mu_fold_of(row, column) * (MU_BINS + 1);
            for (int upper = 0; upper < 2; upper++) {
                double slope[2];
                mu_slope_at(s, i, j, upper, slope);
                const double x = slope[0] - cloud->centre[0], y = slope[1] - cloud->centre[1];
                const double v[2] = {inverse[0] * x + inverse[1] * y, inverse[2] * x + inverse[3] * y};
                const uint32_t bin = bin_of(v, cloud->edge, per_ring);
                mu_bin_moments *b = moments + bin;
                counts[bin]++;
                b->count++;
                b->mean[0] += v[0], b->mean[1] += v[1];
                b->square[0] += v[0] * v[0], b->square[1] += v[0] * v[1], b->square[2] += v[1] * v[1];
            }
        }
}

/* Mean +- sqrt 2 times the columns of a Cholesky factor of the covariance, a quarter of the weight each. */
static size_t spread(const mu_bin_moments *b, uint32_t bin, mu_point out[4]) {
    const double n = b->count, x = b->mean[0] / n, y = b->mean[1] / n;
    const double xx = fmax(b->square[0] / n - x * x, 0), xy = b->square[1] / n - x * y,
                 yy = fmax(b->square[2] / n - y * y, 0);
    const double first = sqrt(2 * xx), across = first > 0 ? 2 * xy / first : 0,
                 second = sqrt(fmax(2 * yy - across * across, 0));
    const double by[4][2] = {{first, across}, {-first, -across}, {0, second}, {0, -second}};
    if (n == 1) {
        out[0] = (mu_point){{x, y}, n, bin};
        return 1;
    }
    for (int k = 0; k < 4; k++) out[k] = (mu_point){{x + by[k][0], y + by[k][1]}, n / 4, bin};
    return 4;
}

static _Bool make_set(mu_point_set *set, const mu_bin_moments *moments) {
    set->points = malloc((size_t)4 * MU_BINS * sizeof *set->points);
    if (!set->points) return 0;
    set->count = 0;
    set->tail = set->facets = moments[MU_TAIL].count;
    for (uint32_t bin = 0; bin < MU_BINS; bin++)
        if (moments[bin].count > 0) {
            set->facets += moments[bin].count;
            set->count += spread(moments + bin, bin, set->points + set->count);
        }
    return 1;
}

_Bool mu_cloud_fill(mu_cloud *cloud, const mu_slopes *s) {
    cloud->counts = calloc((size_t)MU_PATCHES * MU_PATCHES * (MU_BINS + 1), sizeof *cloud->counts);
    cloud->moments = calloc((size_t)(MU_FOLDS + 1) * (MU_BINS + 1), sizeof *cloud->moments);
    if (!cloud->counts || !cloud->moments) return 0;
    count_facets(cloud, s);
    mu_bin_moments *all = cloud->moments + (size_t)MU_FOLDS * (MU_BINS + 1);
    for (int fold = 0; fold < MU_FOLDS; fold++)
        for (uint32_t bin = 0; bin <= MU_TAIL; bin++) {
            const mu_bin_moments *one = cloud->moments + (size_t)fold * (MU_BINS + 1) + bin;
            all[bin].count += one->count;
            for (int k = 0; k < 2; k++) all[bin].mean[k] += one->mean[k];
            for (int k = 0; k < 3; k++) all[bin].square[k] += one->square[k];
        }
    for (int set = 0; set <= MU_FOLDS; set++)
        if (!make_set(&cloud->sets[set], cloud->moments + (size_t)set * (MU_BINS + 1))) return 0;
    return 1;
}

void mu_cloud_free(mu_cloud *cloud) {
    free(cloud->moments);
    free(cloud->counts);
    for (int set = 0; set <= MU_FOLDS; set++) free(cloud->sets[set].points);
}
