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

#include <string.h>

#include "core/ibl/importance.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

#include "core/ibl/row.h"
#include "core/ibl/visible.h"

/* Every fourth read is wider; 2, 6 ... from the middle, so that a row that grows keeps its wide ones. */
enum { WIDE = 4 };
static inline uint32_t wide_from(size_t phase, size_t count) {
    return (uint32_t)(phase % MU_IBL_PHASES + MU_IBL_READS_MOST - (count - 1) / 2);
}

double mu_ibl_tail_share(size_t i) {
    const double t = tanh((double)i / PLACES);
    return t * t;
}

/* Of a lobe that is wide all around half of what is seen is mirrored below the horizon. Its middle is that of the rest: 0 where the mirror's
 * mean is that of the mean micronormal, below an alpha of 0.3; 1 at an alpha of 1, where, of whatever view, it is the normal: half
 * the angle from w, of which sqrt(1 - h) is the sine. */
static inline float blunt(float sigma) {
    const float alpha = 1.41421356237309504880f * sigma;
    return smaller(larger((alpha - 0.3f) / 0.7f, 0), 1);
}

/* What all reads of a view have in common. Floats alone. */
typedef struct spread {
    visible f;
    row laid;
    float turn[2]; /* the row's direction on the disk */
    float along;   /* of the row, what its width leaves */
    float upper;   /* how high the middle of a chord up the disk is, where that is 1 long */
    float radius, seen, wider;
} spread;

/* How many reads there are. `tailed`, `chosen`: constants. */
HOT int spread_of(const mu_ibl_plan *plan, float shift, const mu_ibl_lobe_f *lobe, const float wo[3], int tailed, int chosen, spread *s) {
    stretched e;
    visible_of(lobe, wo, &s->f);
    stretched_middle(&s->f, &e);
    const float b = e.ratio, b2 = b * b, b8 = square(square(b2)), wide = smaller(3 * e.major, 1);
    const float share = 0.73f + 0.27f * (b8 + wide * (b2 - b8));
    const int count = lay(plan, shift, e.major, b, share * b, tailed, chosen, &s->laid);
    const float narrow = s->laid.width / share, half = s->f.half;
    for (int k = 0; k < 2; k++) s->turn[k] = e.turn[k];
    s->along = sqrt(larger(1 - narrow * narrow, 0));
    /* the middle of a chord up the disk is upper sqrt(1 - x²) high; its mean over what the row does not resolve across, by area: */
    const float mean = 8 / (3 * (float)PI), unresolved = square(e.turn[1]) + square(e.turn[0] * narrow);
    const float low = (1 - half) * (1 - (1 - mean) * unresolved);
    s->upper = low + blunt(lobe->sigma[1]) * (sqrt(1 - half) - low);
    s->radius = 0.5f * s->laid.width * e.major * e.normal, s->seen = s->f.length * half;
    s->wider = 12 * square(b2);
    return count;
}

/* One read, at the slope sinh v, of which e^v is given; its weight without those of the others. */
HOT void read_at(const spread *s, float grown, float tail, float part, float wider, int tailed, float r[3], float *rough, float *weight) {
    const visible *f = &s->f;
    const float sine = 0.5f * (grown - 1 / grown), slope = s->along * sine, moved = 1 + square((tailed ? tail : 1) * slope);
    const float place = (tailed ? tail : 1) * slope / sqrt(moved);
    const float p = s->turn[0] * place, free = larger(1 - p * p, 0);
    const float tall = sqrt(free), q = smaller(s->upper * tall + f->half * s->turn[1] * place, tall);
    const float lift = sqrt(larger(free - q * q, 0));
    float m[3], n[3];
    for (int k = 0; k < 3; k++) m[k] = p * f->x[k] + q * f->y[k] + lift * f->w[k];
    visible_normal(f, m, n);
    const float inverse = 1 / dot(n, n), twice = 2 * dot(n, f->wo) * inverse;
    for (int k = 0; k < 3; k++) r[k] = twice * n[k] - f->wo[k];
    /* G2 / G1 = sigma(wo) / (sigma(wo) + wo.z Lambda(wi)), sigma = (|w| + w.z) / 2 */
    const float w[3] = {f->s[0][0] * r[0] + f->s[0][1] * r[1], f->s[1][0] * r[0] + f->s[1][1] * r[1],
                        r[2] - f->mean[0] * r[0] - f->mean[1] * r[1]};
    const float up = larger(r[2], 0), hidden = larger((sqrt(dot(w, w)) + w[2]) / 2 - up, 0);
    *weight = part * s->seen * up / larger((1 + square(sine)) * (s->seen * up + f->wo[2] * hidden), REAL_MIN);
    const float alpha = s->radius * sqrt(inverse * (tailed ? tail * tail * (1 + slope * slope) / moved : 1));
    *rough = smaller(sqrt(alpha + wider * square(alpha) * sqrt(alpha)), 1);
}

/* e^v of reads: four, and from there on e^(4 step) times that. */
enum { LANES = 4 };

/* Of one view, four reads at a time. `tailed`, `chosen`: constants, so that what is usual does not pay for what is not. */
HOT void look(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3], int tailed, int chosen,
              mu_ibl_view *out) {
    spread s;
    const int found = spread_of(plan, plan->shift[phase % plan->phases], lobe, wo, tailed, chosen, &s);
    const size_t count = (size_t)found;
    const uint32_t from = wide_from(phase, count);
    float x[3][MU_IBL_READS_MOST], rough[MU_IBL_READS_MOST], weight[MU_IBL_READS_MOST];
    float grown[MU_IBL_READS_MOST], tail[MU_IBL_READS_MOST], part[MU_IBL_READS_MOST], wider[MU_IBL_READS_MOST];
    float sums[LANES] = {0, 0, 0, 0}; /* one by one would wait for each other */
    const size_t padded = (count + LANES - 1) / LANES * LANES;
    const float more = exponential(LANES * s.laid.step), middle = 0.5f * (float)(found - 1);
    for (int j = 0; j < LANES; j++) grown[j] = exponential((s.laid.first + (float)j) * s.laid.step);
    for (size_t j = LANES; j < padded; j += LANES)
        for (size_t k = j; k < j + LANES; k++) grown[k] = grown[k - LANES] * more;
    for (size_t j = 0; j < padded; j++) {
        const float away = fabs((float)(int)j - middle), left = chosen && away > 0 ? smaller(larger(s.laid.ends - away, 0), 1) : 1;
        part[j] = j < count ? left : 0;
    }
    for (uint32_t j = 0; j < padded; j++) wider[j] = (j + from) % WIDE == 2 ? s.wider : 0;
    for (size_t j = 0; tailed && j < padded; j++) tail[j] = tail_at(plan->tail, (s.laid.first + (float)(int)j) * s.laid.step);
    for (size_t j = 0; j < padded; j++) {
        float r[3];
        read_at(&s, grown[j], tailed ? tail[j] : 1, part[j], wider[j], tailed, r, &rough[j], &weight[j]);
        for (int k = 0; k < 3; k++) x[k][j] = r[k];
    }
    for (size_t j = 0; j < padded; j += LANES)
        for (size_t k = 0; k < LANES; k++) sums[k] += weight[j + k];
    const float all = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    const float each = all > 0 ? 1 / all : 1 / (float)found; /* none is above: alike, of an albedo of about 0 */
    for (size_t j = 0; j < count; j++) {
        out->x[j] = x[0][j], out->y[j] = x[1][j], out->z[j] = x[2][j];
        out->roughness[j] = rough[j], out->weight[j] = all > 0 ? each * weight[j] : each;
    }
    out->count = count;
}

static void look_one(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3], mu_ibl_view *out) {
    if (plan->settings.samples)
        plan->tailed ? look(plan, phase, lobe, wo, 1, 0, out) : look(plan, phase, lobe, wo, 0, 0, out);
    else
        plan->tailed ? look(plan, phase, lobe, wo, 1, 1, out) : look(plan, phase, lobe, wo, 0, 1, out);
}

size_t mu_ibl_spread_reads(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                           mu_ibl_read *out) {
    mu_ibl_view view;
    look_one(plan, phase, lobe, wo, &view);
    for (size_t j = 0; j < view.count; j++)
        out[j] = (mu_ibl_read){{view.x[j], view.y[j], view.z[j]}, view.roughness[j], view.weight[j]};
    return view.count;
}

/* Several views, number by number, as those of axis.c: of GGX, and of a given number of reads. */
enum { VIEWS = 8, NUMBERS = sizeof(spread) / sizeof(float) };
/* Else gcc leaves a loop, and works out one view after the other. */
#define ALL_NUMBERS _Pragma("GCC unroll 64")
_Static_assert((int)NUMBERS <= 64, "all of them");
HOT void put(const spread *s, size_t i, float (*out)[VIEWS]) {
    float each[NUMBERS];
    memcpy(each, s, sizeof *s);
    ALL_NUMBERS
    for (size_t k = 0; k < NUMBERS; k++) out[k][i] = each[k];
}
HOT void take(const float (*from)[VIEWS], size_t i, spread *s) {
    float each[NUMBERS];
    ALL_NUMBERS
    for (size_t k = 0; k < NUMBERS; k++) each[k] = from[k][i];
    memcpy(s, each, sizeof *s);
}

static void look_several(const mu_ibl_plan *plan, size_t phase, size_t views, const float (*lobes)[VIEWS],
                         const float (*wo)[VIEWS], mu_ibl_view *out) {
    const mu_ibl_plan own = {.settings = plan->settings, .logarithm = plan->logarithm, .shared = plan->shared};
    const float shift = plan->shift[phase % plan->phases];
    const size_t count = plan->settings.samples, from = wide_from(phase, count);
    float several[NUMBERS][VIEWS], grown[MU_IBL_READS_MOST][VIEWS], more[VIEWS], weight[MU_IBL_READS_MOST][VIEWS];
    float sums[LANES][VIEWS] = {{0}};
    for (size_t i = 0; i < VIEWS; i++) {
        const mu_ibl_lobe_f lobe = {{lobes[0][i], lobes[1][i]}, {lobes[2][i], lobes[3][i]}, {lobes[4][i], lobes[5][i]}};
        const float o[3] = {wo[0][i], wo[1][i], wo[2][i]};
        spread s;
        spread_of(&own, shift, &lobe, o, 0, 0, &s);
        put(&s, i, several);
        more[i] = exponential(LANES * s.laid.step);
        for (int j = 0; j < LANES; j++) grown[j][i] = exponential((s.laid.first + (float)j) * s.laid.step);
    }
    for (size_t j = 0; j < count; j++) {
        const float wider = (j + from) % WIDE == 2;
        float x[3][VIEWS], rough[VIEWS];
        for (size_t i = 0; i < VIEWS && j >= LANES; i++) grown[j][i] = grown[j - LANES][i] * more[i];
        for (size_t i = 0; i < VIEWS; i++) {
            spread s;
            float r[3];
            take(several, i, &s);
            read_at(&s, grown[j][i], 1, 1, wider * s.wider, 0, r, &rough[i], &weight[j][i]);
            for (int k = 0; k < 3; k++) x[k][i] = r[k];
            sums[j % LANES][i] += weight[j][i];
        }
        for (size_t i = 0; i < views; i++)
            out[i].x[j] = x[0][i], out[i].y[j] = x[1][i], out[i].z[j] = x[2][i], out[i].roughness[j] = rough[i];
    }
    for (size_t i = 0; i < views; i++) {
        const float all = (sums[0][i] + sums[1][i]) + (sums[2][i] + sums[3][i]), each = all > 0 ? 1 / all : 1 / (float)(int)count;
        for (size_t j = 0; j < count; j++) out[i].weight[j] = all > 0 ? each * weight[j][i] : each;
        out[i].count = count;
    }
}

void mu_ibl_spread_views(const mu_ibl_plan *plan, size_t phase, size_t views, const mu_ibl_lobe_f *lobes, size_t stride,
                         const float (*wo)[MU_IBL_AXES], mu_ibl_view *out) {
    if (plan->tailed || !plan->settings.samples) {
        for (size_t i = 0; i < views; i++)
            look_one(plan, phase, lobes + i * stride, (const float[3]){wo[0][i], wo[1][i], wo[2][i]}, &out[i]);
        return;
    }
    for (size_t first = 0; first < views; first += VIEWS) {
        const size_t left = views - first < VIEWS ? views - first : VIEWS;
        float each[6][VIEWS], w[3][VIEWS];
        for (size_t i = 0; i < VIEWS; i++) { /* more than there are: the first again */
            const size_t at = first + (i < left ? i : 0);
            const mu_ibl_lobe_f *l = lobes + at * stride;
            for (size_t k = 0; k < 2; k++) each[k][i] = l->sigma[k], each[2 + k][i] = l->turn[k], each[4 + k][i] = l->mean[k];
            for (size_t k = 0; k < 3; k++) w[k][i] = wo[k][at];
        }
        look_several(plan, phase, left, each, w, out + first);
    }
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
    plan->shared = 1 / (float)(int)(plan->settings.samples == 1 ? 1 : plan->phases);
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
