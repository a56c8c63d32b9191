/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * row.h: the row in which the reads of one lobe stand (spread.c): how far apart in v, asinh of the slope, and how wide. In float.
 * Without branches and calls, as long as their number is given and the shape is GGX's: several rows are laid at a time.
 */
#ifndef MU_IBL_ROW_H
#define MU_IBL_ROW_H

#include <stdint.h>
#include <string.h>

#include "core/ibl/reads.h"

#include "core/bsdf/real.h"

#define OVERLAP 0.22f
#define MOST    1.4f
#define LEAST   0.7f
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

static inline float tail_at(const float *tail, float v) {
    const float place = smaller(fabs(v), END) * PLACES;
    const int low = (int)smaller(place, (float)(MU_IBL_TAIL - 2));
    return tail[low] + (place - (float)low) * (tail[low + 1] - tail[low]);
}

/* e^v of |v| below 40: 2^k e^f, f within half of ln 2, by Taylor's series up to f^6, to 2e-7. */
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

/* ln y of a y of 1 or more: k ln 2 + ln m, m from 2/3 to 4/3, of s = (m - 1) / (m + 1), at most 0.2, 2 (s + s³/3 ... s^9/9), to 4e-9. */
static inline float logarithm(float y) {
    int32_t bits;
    float m;
    memcpy(&bits, &y, sizeof bits);
    const int32_t k = (bits - 0x3f2aaaab) >> 23; /* 2/3 */
    bits -= k * 0x800000;
    memcpy(&m, &bits, sizeof m);
    const float s = (m - 1) / (m + 1), s2 = s * s;
    return (float)k * 0.69314718055994531f + 2 * s * (1 + s2 * (1.0f / 3 + s2 * (0.2f + s2 * (1.0f / 7 + s2 * (1.0f / 9)))));
}

static inline float arsinh(float x) {
    return logarithm(x + sqrt(1 + x * x));
}

/* Reads stand at v = (first + j) step; those of a chosen number are of weight 0 where they come and go, `ends` of their distance from the
 * middle one. `width`: across, in units of a. */
typedef struct row {
    float first, step, width, ends;
} row;

/* As many as needed, -each to each. Beyond a step of 2 reach there is one, whatever the step: of a round lobe it would be without end. */
static inline int choose(float reach, float own, float ratio, row *r) {
    const float wanted = apart(own / sqrt(larger(1 - ratio * ratio, 1e-6f)));
    r->step = smaller(larger(wanted, 2 * reach / (MU_IBL_READS_CHOSEN - 1)), 2 * reach);
    r->ends = reach / r->step + 0.5f;
    return (int)ceil(larger(r->ends - 1, 0));
}

/* Of a lobe whose a is `major` / 2. `tailed` and `chosen` are constants: what they say of the plan. How many reads there are. */
HOT int lay(const mu_ibl_plan *plan, float shift, float major, float ratio, float own, int tailed, int chosen, row *r) {
    const float steep = 2 / larger(major, 1e-6f);
    float end = smaller(arsinh(steep), END);
    if (tailed) end = smaller(arsinh(steep / tail_at(plan->tail, end)), END);
    int count = (int)plan->settings.samples;
    float least = 0, beside = 1; /* how much of the neighbours of the middle one there is: gaps to close, and places between */
    if (chosen) {
        count = 2 * choose(smaller(larger(end, NEAR), FAR), own, ratio, r) + 1;
        beside = smaller(r->ends - 1, 1);
    } else {
        r->step = 2 * smaller(larger(end, smaller(LEAST * plan->logarithm, END)), MOST * plan->logarithm) / (float)count;
        r->ends = 0;
        least = sqrt(ratio * plan->shared / (float)count);
    }
    r->width = larger(own, larger(least, OVERLAP * beside * plan->shared * r->step));
    r->first = beside * shift - 0.5f * (float)(count - 1);
    return count;
}

#endif
