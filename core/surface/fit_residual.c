/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* fit_residual.c: how the facets of one half are distributed in the frame fitted to the other. */
#include <math.h>
#include <stdlib.h>

#include "core/surface/fit.h"

enum { FINE = 1000, AT_AZIMUTH = MU_SHARES, AT_JOINT = 2 * MU_SHARES, ALL = 2 * MU_SHARES + MU_JOINT };
enum { MOST_FACETS = 4000000 }; /* of more, rows are left out evenly: shares to 1e-4 are enough */

/* What takes a slope to u's frame, turned so that alpha_x lies along x; and the law of |u|. */
typedef struct mu_frame {
    double mean[2], to[4];
    mu_radial law;
} mu_frame;

static _Bool make_frame(mu_frame *frame, const mu_candidate *c, const mu_cloud *cloud,
                        const double *parameters, mu_likelihood *l) {
    const mu_definition d = mu_candidate_definition(c, parameters);
    mu_told told;
    mu_candidate_tell(c, cloud, parameters, &told);
    if (mu_radial_bytes(&d) > l->bytes || !mu_radial_make(&frame->law, &d, l->memory)) return 0;
    const double unit = told.alpha / d.alpha, *m = told.transform;
    const double x = cos(told.rotation) / unit, y = sin(told.rotation) / unit;
    frame->to[0] = x * m[0] + y * m[1], frame->to[1] = x * m[1] + y * m[2];
    frame->to[2] = x * m[1] - y * m[0], frame->to[3] = x * m[2] - y * m[1];
    frame->mean[0] = told.mean[0], frame->mean[1] = told.mean[1];
    return isfinite(frame->to[0]);
}

static uint32_t within(double part, uint32_t bins) {
    const double place = part * bins;
    return place < bins - 1 ? (place > 0 ? (uint32_t)place : 0) : bins - 1;
}

static void count_facet(const mu_frame *frame, const double s[2], uint32_t *counts, double *fine) {
    const double x = s[0] - frame->mean[0], y = s[1] - frame->mean[1];
    const double u = frame->to[0] * x + frame->to[1] * y, w = frame->to[2] * x + frame->to[3] * y;
    const double below = 1 - mu_radial_above(&frame->law, log(fmax(u * u + w * w, 1e-40)) / 2);
    const double turn = atan2(w, u) / 6.28318530717958647693, azimuth = turn < 0 ? turn + 1 : turn;
    counts[within(below, MU_SHARES)]++;
    counts[AT_AZIMUTH + within(azimuth, MU_SHARES)]++;
    counts[AT_JOINT + within(below, MU_JOINT_RINGS) * MU_JOINT_SECTORS + within(azimuth, MU_JOINT_SECTORS)]++;
    fine[within(below, FINE)]++;
}

static void partition(mu_partition *out, const uint32_t *counts, uint32_t from, uint32_t bins,
                      uint32_t blocks) {
    const uint32_t wide = MU_PATCHES / blocks;
    double all = 0, inside[MU_PATCHES * MU_PATCHES] = {0}, squares = 0;
    *out = (mu_partition){.bins = bins};
    for (uint32_t patch = 0; patch < MU_PATCHES * MU_PATCHES; patch++)
        for (uint32_t k = 0; k < bins; k++) {
            const double n = counts[(size_t)patch * ALL + from + k];
            inside[patch / MU_PATCHES / wide * blocks + patch % MU_PATCHES / wide] += n;
            out->share[k] += n;
            all += n;
        }
    const double m = (double)blocks * blocks;
    for (uint32_t k = 0; k < bins; k++) {
        double block[MU_PATCHES * MU_PATCHES] = {0}, sum = 0;
        out->share[k] /= all;
        for (uint32_t patch = 0; patch < MU_PATCHES * MU_PATCHES; patch++)
            block[patch / MU_PATCHES / wide * blocks + patch % MU_PATCHES / wide] +=
                counts[(size_t)patch * ALL + from + k];
        for (uint32_t b = 0; b < blocks * blocks; b++) {
            const double off = block[b] - out->share[k] * inside[b];
            sum += off * off;
        }
        out->error[k] = sqrt(sum * m / (m - 1)) / all;
        const double off = out->share[k] - 1.0 / bins;
        squares += off * off;
        out->variation += fabs(off) / 2;
        out->noise += sqrt(2 / 3.14159265358979323846) * out->error[k] / 2;
    }
    out->rms = sqrt(squares * bins);
}

_Bool mu_fit_residual(mu_fitted *f, const double (*halves)[MU_MOST_PARAMETERS], const mu_cloud *cloud,
                      const mu_slopes *s, uint32_t blocks, mu_likelihood *l) {
    const uint32_t side = mu_slopes_side(s);
    const uint64_t facets = 2 * (uint64_t)side * side;
    const uint32_t every = 1 + (uint32_t)((facets - 1) / MOST_FACETS);
    uint32_t *counts = calloc((size_t)MU_PATCHES * MU_PATCHES * ALL, sizeof *counts);
    mu_frame *frames = malloc(MU_FOLDS * sizeof *frames); /* frames[k] judges the facets of fold k */
    double fine[FINE] = {0}, below = 0;
    _Bool good = counts && frames;
    for (int fold = 0; good && fold < MU_FOLDS; fold++)
        good = make_frame(&frames[fold], f->candidate, cloud, halves[1 - fold], l);
    for (uint32_t i = 0; good && i < side; i += every)
        for (uint32_t j = 0; j < side; j++) {
            const uint32_t row = mu_patch_row(s, i), column = mu_patch_row(s, j);
            for (int upper = 0; upper < 2; upper++) {
                double slope[2];
                mu_slope_at(s, i, j, upper, slope);
                count_facet(&frames[mu_fold_of(row, column)], slope,
                            counts + (size_t)(row * MU_PATCHES + column) * ALL, fine);
                f->residual.facets++;
            }
        }
    if (good) {
        partition(&f->residual.steepness, counts, 0, MU_SHARES, blocks);
        partition(&f->residual.azimuth, counts, AT_AZIMUTH, MU_SHARES, blocks);
        partition(&f->residual.joint, counts, AT_JOINT, MU_JOINT, blocks);
        for (int k = 0; k < FINE; k++) {
            below += fine[k] / f->residual.facets;
            f->residual.kolmogorov = fmax(f->residual.kolmogorov, fabs(below - (k + 1.0) / FINE));
        }
    }
    free(counts);
    free(frames);
    return good;
}
