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
 * wider, OVERLAP of their distance, so that the gaps between them close: less, and a lamp is a row of beads.
 *
 * Everything moves with b alone, and at b = 1, where the axis has no direction, all reads are one: nothing jumps from pixel to pixel.
 * (A lattice in the whole disk for wide lobes gains a tenth of FLIP there, but turns about where b is 1.)
 *
 * Other distributions are GGX whose slopes are moved away from the mean or towards it, `tail` times (reads.h), until as many
 * are within: so are the reads, and they widen with it.
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

#define OVERLAP 0.22f
#define GOLDEN  0.61803398874989485
/* v of N reads ends at REACH ln N, found by measurement: 2.2 at 16. */
#define REACH 0.8
/* Of a chosen number: where v ends; and how far apart reads are that are `width` wide: twice that where they are narrow, while
 * round ones are few but not too few. */
#define FAR 2.0f
static inline float apart(float width) {
    return smaller(2 * width, 0.35f + 0.5f * width);
}

/* At a slope of which tanh² v are smaller. */
static inline float tail_at(const float *tail, float share) {
    const float place = smaller(share, 1) * (float)(MU_IBL_TAIL - 1);
    const int low = (int)smaller(place, (float)(MU_IBL_TAIL - 2));
    return tail[low] + (place - (float)low) * (tail[low + 1] - tail[low]);
}

void mu_ibl_spread_make(size_t count, size_t phase, const float *tail, mu_ibl_spread *s) {
    const double turned = GOLDEN * (double)phase + 0.5, shift = phase ? turned - floor(turned) - 0.5 : 0;
    const double step = 2 * REACH * log((double)count) / (double)count;
    double all = 0;
    s->count = count, s->step = (float)step;
    for (size_t j = 0; j < count; j++) {
        const double v = ((double)j - ((double)count - 1) / 2 + shift) * step;
        s->along[j] = (float)sinh(v);
        s->tail[j] = tail ? tail_at(tail, (float)(tanh(v) * tanh(v))) : 1;
        all += 1 / (cosh(v) * cosh(v));
    }
    for (size_t j = 0; j < count; j++) s->weight[j] = (float)(1 / all) / (1 + square(s->along[j]));
}

/* As many as needed, from -K to K steps: those at the ends come and go with weight 0. sinh of multiples by sums. */
static void choose(const mu_ibl_plan *plan, float step, mu_ibl_spread *s) {
    const size_t each = (size_t)ceil(larger(FAR / step - 0.5f, 0));
    const float s1 = sinh(step), c1 = cosh(step);
    float sine = 0, cosine = 1;
    s->count = 2 * each + 1, s->step = step;
    for (size_t k = 0; k <= each; k++) {
        const float part = smaller(larger((FAR - (float)(int)k * step) / step + 0.5f, 0), 1) / square(cosine);
        const float tail = plan->tailed ? tail_at(plan->tail, square(sine / cosine)) : 1;
        for (size_t side = 0; side < 2; side++) {
            const size_t j = side ? each - k : each + k;
            s->along[j] = side ? -sine : sine, s->weight[j] = k ? part : 1, s->tail[j] = tail;
        }
        const float next = sine * c1 + cosine * s1;
        cosine = cosine * c1 + sine * s1, sine = next;
    }
}

/* `tailed`: a constant, so that GGX does not pay for it. */
HOT size_t look(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3], int tailed,
                mu_ibl_read *out) {
    const visible f = visible_of(lobe, wo);
    const stretched e = stretched_middle(&f);
    const float b = e.major > 0 ? e.minor / e.major : 1, share = 0.73f + 0.27f * b * b, own = share * b;
    const mu_ibl_spread *spread = &plan->spread[phase % MU_IBL_PHASES];
    mu_ibl_spread chosen;
    float width;
    if (!plan->settings.samples) {
        const float step = apart(own / sqrt(larger(1 - b * b, 1e-6f)));
        choose(plan, larger(step, 2 * FAR / (MU_IBL_READS_CHOSEN - 1)), &chosen);
        spread = &chosen;
        width = larger(own, OVERLAP * spread->step);
    } else {
        width = larger(own, larger(sqrt(b / (float)spread->count), OVERLAP * spread->step));
    }
    const size_t count = spread->count;
    const float narrow = width / share, along = sqrt(larger(1 - narrow * narrow, 0)); /* what the width leaves */
    /* the middle of a chord up the disk is upper sqrt(1 - x²) high; its mean over what the row does not resolve across, by area: */
    const float mean = 8 / (3 * (float)PI), unresolved = square(e.turn[1]) + square(e.turn[0] * narrow);
    const float upper = (1 - f.half) * (1 - (1 - mean) * unresolved);
    const float radius = 0.5f * width * e.major * e.normal, seen = f.length * f.half;
    float x[3][MU_IBL_READS_MOST], rough[MU_IBL_READS_MOST], weight[MU_IBL_READS_MOST], all = 0;
    for (size_t j = 0; j < count; j++) {
        const float slope = along * spread->along[j], tail = tailed ? spread->tail[j] : 1, moved = 1 + square(tail * slope);
        const float place = tail * slope / sqrt(moved);
        const float p = e.turn[0] * place, free = larger(1 - p * p, 0);
        const float q = upper * sqrt(free) + f.half * e.turn[1] * place;
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
        rough[j] = sqrt(radius * sqrt(inverse * (tailed ? tail * tail * (1 + slope * slope) / moved : 1)));
        all += weight[j];
    }
    const float each = all > 0 ? 1 / all : 1 / (float)count; /* none is above: alike, of an albedo of about 0 */
    for (size_t j = 0; j < count; j++)
        out[j] = (mu_ibl_read){{x[0][j], x[1][j], x[2][j]}, smaller(rough[j], 1), all > 0 ? each * weight[j] : each};
    return count;
}

size_t mu_ibl_spread_reads(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                           mu_ibl_read *out) {
    return plan->tailed ? look(plan, phase, lobe, wo, 1, out) : look(plan, phase, lobe, wo, 0, out);
}

static void spread_all(mu_ibl_plan *plan, const float *tail) {
    const size_t count = plan->settings.samples ? plan->settings.samples : MU_IBL_READS_MOST - 1;
    for (size_t phase = 0; phase < MU_IBL_PHASES; phase++) mu_ibl_spread_make(count, phase, tail, &plan->spread[phase]);
}

void mu_ibl_plan_make(mu_ibl_technique technique, const mu_ibl_settings_f *settings, mu_ibl_plan *plan) {
    plan->technique = technique, plan->settings = *settings;
    plan->tailed = 0;
    if (technique == MU_IBL_FILTERED)
        plan->settings.samples = mu_ibl_importance_make(settings->samples, &plan->spread[0]);
    else
        spread_all(plan, NULL);
}

void mu_ibl_plan_tail(mu_ibl_plan *plan, const float *tail) {
    if (plan->technique != MU_IBL_LOBE) return;
    for (size_t i = 0; i < MU_IBL_TAIL; i++) {
        plan->tail[i] = tail[i];
        plan->tailed = plan->tailed || fabs(tail[i] - 1) > (float)1e-3; /* else it is GGX's */
    }
    if (plan->tailed) spread_all(plan, tail);
}

#endif
