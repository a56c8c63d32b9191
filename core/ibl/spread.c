/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * spread.c: a lobe as a sum of few round ones, of which each is a read: where they stand, how wide, with what weight.
 *
 * A lobe of GGX, a long and b wide in reflected space, in units of a: density 1 / (pi b (1 + x² + y²/b²)²). It repeats itself
 * along x: at x it is b sqrt(1 + x²) wide, and the mass between two slopes is that of sech² v dv in x = sinh v. Sums of N round
 * GGX lobes come near to it (least squares of the relative error, found by a search): v evenly spaced, weights sech² v, each width
 * B b sqrt(1 + x²), and x narrowed by sqrt(1 - b²), so that a round lobe is one read. B is 0.73, and 1 of a round lobe; the search
 * has it fall off with b^8 at once. Wide lobes go by b² (measured): the filtered levels' kernels take the cosine to their middle off.
 *
 * The row ends where the lobe meets the horizon, at about a slope of 1, but at v = MOST ln N at most (farther, reads are too far apart) and
 * LEAST ln N at least. Where N is too small for so narrow a lobe, all are wider, OVERLAP of their distance, so that the gaps between them
 * close: less, and a lamp is a row of beads. Samples of a pixel look between each other's reads, and so may be as much narrower as they are many.
 *
 * A filtered level falls off with the cosine to its middle, a wide lobe seen from above does not. So every fourth read (WIDE) is
 * wider, 1 + 12 alpha^1.5 times: of what their sum is off from GGX's f cos, seen from above, that leaves less than half at alphas of 0.16 and
 * 0.36. A row has its own tail along: b^4 of that.
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

#include <stdint.h>
#include <string.h>

#include "core/ibl/importance.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

#include "core/ibl/visible.h"

#define OVERLAP 0.22f
#define MOST    1.4f
#define LEAST   0.7f
#define WIDE    4
/* Of a chosen number: where v ends at least and at most; and how far apart reads are that are `width` wide: twice that where they are narrow,
 * while round ones are few but not too few. */
#define NEAR 1.8f
#define FAR  2.8f
static inline float apart(float width) {
    return smaller(2 * width, 0.35f + 0.5f * width);
}

/* The shape beside GGX's is known from v = 0 to END, at so many places per unit. */
enum { PLACES = 8 };
#define END ((float)(MU_IBL_TAIL - 1) / PLACES)

double mu_ibl_tail_share(size_t i) {
    const double t = tanh((double)i / PLACES);
    return t * t;
}

static inline float tail_at(const float *tail, float v) {
    const float place = smaller(fabs(v), END) * PLACES;
    const int low = (int)smaller(place, (float)(MU_IBL_TAIL - 2));
    return tail[low] + (place - (float)low) * (tail[low + 1] - tail[low]);
}

static inline float arsinh(float x) {
    return log(x + sqrt(1 + x * x));
}

/* The row of one lobe: reads in v, and what is left of each at the ends of a chosen number. Rounded up to fours, the last of weight 0. */
typedef struct row {
    size_t count, padded;
    float step, width; /* of reads, in v; and across, in units of a */
    float v[MU_IBL_READS_MOST], part[MU_IBL_READS_MOST];
} row;

/* As many as needed: those at the ends come and go with weight 0. */
static void choose(float reach, float own, float b, row *r) {
    r->step = larger(apart(own / sqrt(larger(1 - b * b, 1e-6f))), 2 * reach / (MU_IBL_READS_CHOSEN - 1));
    const float end = reach / r->step + 0.5f;
    const int each = (int)ceil(larger(end - 1, 0));
    r->count = (size_t)(2 * each + 1);
    for (int k = -each; k <= each; k++) r->part[k + each] = k ? smaller(larger(end - fabs((float)k), 0), 1) : 1;
}

/* Of a lobe whose a is `major` / 2. */
static void lay(const mu_ibl_plan *plan, size_t phase, float major, float b, float own, row *r) {
    const float steep = 2 / larger(major, 1e-6f);
    float end = smaller(arsinh(steep), END);
    if (plan->tailed) end = smaller(arsinh(steep / tail_at(plan->tail, end)), END);
    if (plan->settings.samples) {
        r->count = plan->settings.samples;
        r->step = 2 * smaller(larger(end, smaller(LEAST * plan->logarithm, END)), MOST * plan->logarithm) / (float)(int)r->count;
        for (size_t j = 0; j < r->count; j++) r->part[j] = 1;
    } else {
        choose(smaller(larger(end, NEAR), FAR), own, b, r);
    }
    const float shared = 1 / (float)(int)(r->count > 1 ? plan->phases : 1);
    const float least = plan->settings.samples ? sqrt(b * shared / (float)(int)r->count) : 0;
    r->width = larger(own, larger(least, OVERLAP * shared * r->step));
    r->padded = (r->count + 3) / 4 * 4;
    for (size_t j = r->count; j < r->padded; j++) r->part[j] = 0;
    const float first = plan->shift[phase % plan->phases] - 0.5f * (float)((int)r->count - 1);
    for (size_t j = 0; j < r->padded; j++) r->v[j] = (first + (float)(int)j) * r->step;
}

/* e^v of |v| below 40, several at a time: 2^k e^f, f within half of ln 2, by Taylor's series up to f^6, to 2e-7. */
static inline float exponential(float v) {
    const float t = v * 1.44269504088896341f;
    const int k = (int)(t + 64.5f) - 64;
    const float f = (t - (float)k) * 0.69314718055994531f;
    const float e = 1 + f * (1 + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    const int32_t bits = (k + 127) * 0x800000;
    float power;
    memcpy(&power, &bits, sizeof power);
    return power * e;
}

/* Of a lobe that is wide all around half of what is seen is mirrored below the horizon. Its middle is that of the rest: 0 where the mirror's
 * mean is that of the mean micronormal, below an alpha of 0.3; 1 at an alpha of 1, where, of whatever view, it is the normal: half
 * the angle from w, of which sqrt(1 - h) is the sine. */
static inline float blunt(const mu_ibl_lobe_f *lobe) {
    const float alpha = 1.41421356237309504880f * lobe->sigma[1];
    return smaller(larger((alpha - 0.3f) / 0.7f, 0), 1);
}

/* `tailed`: a constant, so that GGX does not pay for it. */
HOT size_t look(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3], int tailed,
                mu_ibl_read *out) {
    const visible f = visible_of(lobe, wo);
    const stretched e = stretched_middle(&f);
    const float b = e.major > 0 ? e.minor / e.major : 1, b2 = b * b, b8 = square(square(b2)), wide = smaller(3 * e.major, 1);
    const float share = 0.73f + 0.27f * (b8 + wide * (b2 - b8));
    row laid;
    lay(plan, phase, e.major, b, share * b, &laid);
    const float width = laid.width;
    float sine[MU_IBL_READS_MOST], tail[MU_IBL_READS_MOST], wider[MU_IBL_READS_MOST];
    /* 2, 6 ... from the middle, so that a row that grows keeps its wide ones */
    const uint32_t from = (uint32_t)(phase % MU_IBL_PHASES + MU_IBL_READS_MOST - (laid.count - 1) / 2);
    for (uint32_t j = 0; j < laid.padded; j++) wider[j] = (j + from) % WIDE == 2 ? 12 * square(b2) : 0;
    for (size_t j = 0; j < laid.padded; j++) {
        const float grown = exponential(laid.v[j]);
        sine[j] = 0.5f * (grown - 1 / grown);
    }
    for (size_t j = 0; tailed && j < laid.padded; j++) tail[j] = tail_at(plan->tail, laid.v[j]);
    const float narrow = width / share, along = sqrt(larger(1 - narrow * narrow, 0)); /* what the width leaves */
    /* the middle of a chord up the disk is upper sqrt(1 - x²) high; its mean over what the row does not resolve across, by area: */
    const float mean = 8 / (3 * (float)PI), unresolved = square(e.turn[1]) + square(e.turn[0] * narrow);
    const float low = (1 - f.half) * (1 - (1 - mean) * unresolved), upper = low + blunt(lobe) * (sqrt(1 - f.half) - low);
    const float radius = 0.5f * width * e.major * e.normal, seen = f.length * f.half;
    float x[3][MU_IBL_READS_MOST], rough[MU_IBL_READS_MOST], weight[MU_IBL_READS_MOST];
    for (size_t j = 0; j < laid.padded; j++) {
        const float slope = along * sine[j], moved = 1 + square((tailed ? tail[j] : 1) * slope);
        const float place = (tailed ? tail[j] : 1) * slope / sqrt(moved);
        const float p = e.turn[0] * place, free = larger(1 - p * p, 0);
        const float tall = sqrt(free), q = smaller(upper * tall + f.half * e.turn[1] * place, tall);
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
        weight[j] = laid.part[j] * seen * up / larger((1 + square(sine[j])) * (seen * up + wo[2] * hidden), REAL_MIN);
        const float alpha = radius * sqrt(inverse * (tailed ? tail[j] * tail[j] * (1 + slope * slope) / moved : 1));
        rough[j] = smaller(sqrt(alpha + wider[j] * square(alpha) * sqrt(alpha)), 1);
    }
    float sums[4] = {0, 0, 0, 0}; /* one by one would wait for each other */
    for (size_t j = 0; j < laid.padded; j += 4)
        for (size_t k = 0; k < 4; k++) sums[k] += weight[j + k];
    const float all = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    const float each = all > 0 ? 1 / all : 1 / (float)(int)laid.count; /* none is above: alike, of an albedo of about 0 */
    for (size_t j = 0; j < laid.count; j++)
        out[j] = (mu_ibl_read){{x[0][j], x[1][j], x[2][j]}, rough[j], all > 0 ? each * weight[j] : each};
    return laid.count;
}

size_t mu_ibl_spread_reads(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                           mu_ibl_read *out) {
    return plan->tailed ? look(plan, phase, lobe, wo, 1, out) : look(plan, phase, lobe, wo, 0, out);
}

void mu_ibl_plan_make(mu_ibl_technique technique, const mu_ibl_settings_f *settings, mu_ibl_plan *plan) {
    plan->technique = technique, plan->settings = *settings;
    plan->tailed = 0;
    plan->logarithm = (float)log((double)(settings->samples + !settings->samples));
    mu_ibl_plan_phases(plan, 1);
    if (technique == MU_IBL_FILTERED) plan->settings.samples = mu_ibl_importance_make(settings->samples, &plan->grid);
}

/* Halves, quarters between them, and so on, around 0. */
void mu_ibl_plan_phases(mu_ibl_plan *plan, size_t samples) {
    plan->phases = 1;
    while (2 * plan->phases <= samples && plan->phases < MU_IBL_PHASES) plan->phases *= 2;
    for (size_t i = 0; i < plan->phases; i++) {
        float place = 0.5f / (float)plan->phases - 0.5f, digit = 0.5f;
        for (size_t left = i; left; left /= 2, digit /= 2) place += (float)(left % 2) * digit;
        plan->shift[i] = place;
    }
}

void mu_ibl_plan_tail(mu_ibl_plan *plan, const float *tail) {
    if (plan->technique != MU_IBL_LOBE) return;
    for (size_t i = 0; i < MU_IBL_TAIL; i++) {
        plan->tail[i] = tail[i];
        plan->tailed = plan->tailed || fabs(tail[i] - 1) > (float)1e-3; /* else it is GGX's */
    }
}

#endif
