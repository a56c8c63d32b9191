/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * spread.c: a lobe as a sum of few round ones, of which each is a read: where they stand, how wide, with what weight.
 *
 * A lobe of GGX, a long and b wide in reflected space, in units of a: density 1 / (pi b (1 + x² + y²/b²)²). It repeats itself
 * along x: at x it is b sqrt(1 + x²) wide, and the mass between two slopes is that of sech² v dv in x = sinh v. Sums of N round
 * GGX lobes that come nearest to it (least squares of the relative error, N = 4, 8, 16, b = 1/40 to 1, found by a search) are
 * so to a few per cent: v evenly spaced, weights sech² v, each width B b sqrt(1 + x²) with B = 0.73 + 0.27 b², and x
 * narrowed by sqrt(1 - b²), so that a round lobe is one read. Where N is too small for so narrow a lobe, all are
 * wider, OVERLAP of their distance, so that the gaps between them close.
 *
 * Wider than WIDEST a lobe is no longer that plane picture: shadowing and the sphere bend it. There the reads are kept narrower,
 * and stand across the axis too, by the golden ratio: a lattice that is even however it is stretched (its shortest
 * vectors stay as long as may be), so that nothing jumps between a row and a disk.
 *
 * Where they stand is mapped as visible micronormals are (visible.h): distances, the mean slope, and the parts that face away are
 * theirs. Weights are those times G2 / G1, as of samples of visible normals; below the horizon they are 0. Micronormals
 * of the angle phi are 1 / |n| as wide in angle, cos phi being what the disk leaves of it: |n| is the whole change of width.
 */
#include "core/ibl/spread.h"

#include "core/ibl/importance.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

#include "core/ibl/visible.h"

#define OVERLAP 0.25f
#define WIDEST  0.5f
#define GOLDEN  0.61803398874989485

/* The t below which a share of Student's distribution of (1 + t²)^-2 is. */
static double quantile(double share) {
    double low = -1e3, high = 1e3;
    for (int i = 0; i < 60; i++) {
        const double t = (low + high) / 2;
        *(0.5 + (t / (1 + t * t) + atan(t)) / PI < share ? &low : &high) = t;
    }
    return (low + high) / 2;
}

void mu_ibl_spread_make(size_t count, mu_ibl_spread *s) {
    double all = 0;
    const double reach = log((double)count) * 0.7, step = 2 * reach / (double)count;
    s->step = (float)step;
    for (size_t j = 0; j < count; j++) {
        const double i = (double)j - ((double)count - 1) / 2, v = i * step, place = GOLDEN * i + 0.5;
        s->along[j] = (float)sinh(v), s->across[j] = (float)quantile(place - floor(place));
        all += 1 / (cosh(v) * cosh(v));
    }
    for (size_t j = 0; j < count; j++) s->weight[j] = (float)(1 / ((1 + square(s->along[j])) * all));
}

size_t mu_ibl_spread_reads(const mu_ibl_spread *spread, size_t count, const mu_ibl_lobe_f *lobe, const float wo[3],
                           mu_ibl_read *out) {
    const visible f = visible_of(lobe, wo);
    const stretched e = stretched_middle(&f);
    const float b = e.major > 0 ? e.minor / e.major : 1, own = (0.73f + 0.27f * b * b) * b;
    const float least = larger(sqrt(b / (float)count), OVERLAP * spread->step);
    const float width = e.major > 0 ? larger(smaller(own, WIDEST / e.major), least) : own;
    const float narrow = b * width / own; /* what the width leaves of the spread, along and across */
    const float along = sqrt(larger(1 - narrow * narrow, 0)), across = sqrt(larger(1 - width * width / (own * own), 0));
    const float radius = 0.5f * width * e.major * e.normal, upper = 1 - f.half, seen = f.length * f.half;
    float x[3][MU_IBL_READS_MOST], rough[MU_IBL_READS_MOST], weight[MU_IBL_READS_MOST], all = 0;
    for (size_t j = 0; j < count; j++) {
        const float sx = along * spread->along[j], sy = across * spread->across[j] * sqrt(1 + sx * sx);
        const float flat = 1 / sqrt(1 + sx * sx + sy * sy), dx = sx * flat, dy = sy * flat;
        const float p = e.turn[0] * dx - e.turn[1] * dy, free = larger(1 - p * p, 0);
        const float q = upper * sqrt(free) + f.half * (e.turn[1] * dx + e.turn[0] * dy);
        const float lift = sqrt(larger(free - q * q, 0));
        float m[3], n[3], r[3];
        for (int k = 0; k < 3; k++) m[k] = p * f.x[k] + q * f.y[k] + lift * f.w[k];
        visible_normal(&f, m, n);
        const float inverse = 1 / dot(n, n), twice = 2 * dot(n, f.wo) * inverse;
        for (int k = 0; k < 3; k++) x[k][j] = r[k] = twice * n[k] - f.wo[k];
        /* G2 / G1 = sigma(wo) / (sigma(wo) + wo.z Lambda(wi)), sigma = (|w| + w.z) / 2 */
        const float w[3] = {f.s[0][0] * r[0] + f.s[0][1] * r[1], f.s[1][0] * r[0] + f.s[1][1] * r[1],
                            r[2] - f.mean[0] * r[0] - f.mean[1] * r[1]};
        const float up = larger(r[2], 0), hidden = larger((sqrt(dot(w, w)) + w[2]) / 2 - up, 0);
        weight[j] = spread->weight[j] * seen * up / larger(seen * up + wo[2] * hidden, REAL_MIN);
        rough[j] = sqrt(radius * sqrt(inverse));
        all += weight[j];
    }
    for (size_t j = 0; j < count; j++)
        out[j] = (mu_ibl_read){{x[0][j], x[1][j], x[2][j]},
                               smaller(rough[j], 1),
                               all > 0 ? weight[j] / all : spread->weight[j]};
    return count;
}

void mu_ibl_plan_make(mu_ibl_technique technique, const mu_ibl_settings_f *settings, mu_ibl_plan *plan) {
    plan->technique = technique, plan->settings = *settings;
    if (technique == MU_IBL_FILTERED)
        plan->settings.samples = mu_ibl_importance_make(settings->samples, &plan->spread);
    else
        mu_ibl_spread_make(settings->samples, &plan->spread);
}

#endif
