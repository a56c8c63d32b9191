/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_walk.c: materials whose f is an estimate, and whose samples have no known density: light that walks on the
 * microsurface. Laws hold on average only:
 * - what walks bring, weight, and weight times the cosine they leave with, is the integral of f |cos| over directions;
 * - f(wo,wi) / n_o^2 = f(wi,wo) / n_i^2.
 *
 * Directions are drawn from wo by q: half by the first micronormals of walks, which are visible normals of density Dv, reflected
 * or refracted; half by the cosine, on both sides of what transmits. f |cos| / q has no bound, so no distribution-free test:
 * means of BATCHES batches are all but normal, and their mean over its estimated error is Student's t.
 */
#include <math.h>

#include "core/render/check_probability.h"
#include "core/render/check_refraction.h"
#include "core/render/check_tests.h"

enum { BATCHES = 64, QUANTITIES = 3 };
enum { WEIGHTS, RAISED, ASYMMETRY };

typedef struct moments {
    double sum[QUANTITIES], square[QUANTITIES]; /* of the batches' means */
} moments;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static _Bool walk(const mu_subject *subject, const double view[3], mu_stream *random,
                  musurf_probe_sample *s) {
    double u[3];
    for (int c = 0; c < 3; c++)
        u[c] =
            subject->precision == MUSURF_FLOAT ? (double)mu_stream_float(random) : mu_stream_uniform(random);
    return mu_subject_sample(subject, MUSURF_SAMPLE_AS_SET, view, u, s) == MUSURF_OK;
}

/* The density of drawing wi as draw() does. */
static double density(const mu_subject *subject, const double view[3], const double wi[3]) {
    const _Bool through = wi[2] < 0;
    double h[3], back[3], spread = 1;
    const double cosine = fabs(wi[2]) / 3.14159265358979323846 / (subject->eta > 0 ? 2 : 1);
    for (int c = 0; c < 3; c++) h[c] = view[c] + wi[c];
    if (through) {
        if (!mu_refraction_normal(subject->eta, view, wi, h) ||
            !mu_refracted(subject->eta, view, h, back, &spread))
            return cosine / 2;
    } else {
        const double length = sqrt(dot(h, h));
        for (int c = 0; c < 3; c++) h[c] /= length;
        spread = 4 * dot(view, h);
    }
    const double visible = mu_subject_ask(subject, view, h, NULL).value[MU_AT_DV];
    return (cosine + visible / spread / (subject->eta > 0 ? 2 : 1)) / 2;
}

/* A direction; false if it is lost: below what is opaque, or totally reflected. */
static _Bool draw(const mu_subject *subject, const double view[3], mu_stream *random, double wi[3]) {
    const _Bool through = subject->eta > 0 && mu_stream_below(random, 2);
    if (mu_stream_below(random, 2)) {
        const double r2 = mu_stream_uniform(random), phi = 6.28318530717958647692 * mu_stream_uniform(random);
        wi[0] = sqrt(r2) * cos(phi), wi[1] = sqrt(r2) * sin(phi), wi[2] = (through ? -1 : 1) * sqrt(1 - r2);
        return wi[2] != 0;
    }
    musurf_probe_sample s;
    double spread;
    if (!walk(subject, view, random, &s)) return 0;
    const double facing = dot(view, s.wm);
    if (through) return facing > 0 && mu_refracted(subject->eta, view, s.wm, wi, &spread);
    for (int c = 0; c < 3; c++) wi[c] = 2 * facing * s.wm[c] - view[c];
    return facing > 0 && wi[2] > 0;
}

static void close_batch(moments *m, const double sum[QUANTITIES], size_t samples) {
    for (int k = 0; k < QUANTITIES; k++) {
        const double mean = sum[k] / (double)samples;
        m->sum[k] += mean, m->square[k] += mean * mean;
    }
}

static void of_walks(const mu_subject *subject, size_t samples, const double view[3], mu_stream *random,
                     moments *out, mu_tally *tally) {
    double largest = 0;
    for (int b = 0; b < BATCHES; b++) {
        double sum[QUANTITIES] = {0};
        for (size_t n = 0; n < samples; n++) {
            musurf_probe_sample s;
            if (!walk(subject, view, random, &s) || s.rejected) continue;
            const double weight = s.weight[1] * (s.wi[2] < 0 ? subject->eta * subject->eta : 1);
            largest = fmax(largest, weight);
            sum[WEIGHTS] += weight, sum[RAISED] += weight * fabs(s.wi[2]);
        }
        close_batch(out, sum, samples);
    }
    mu_tally_error(tally, MU_LAW_WEIGHT_BOUND, fmax(0, largest - 1), mu_subject_accuracy(subject),
                   (mu_case){subject, view, NULL, NULL}); /* products of F and 1 - F */
}

static void of_values(const mu_subject *subject, size_t samples, const double view[3], mu_stream *random,
                      moments *out) {
    for (int b = 0; b < BATCHES; b++) {
        double sum[QUANTITIES] = {0}, wi[3];
        for (size_t n = 0; n < samples; n++) {
            if (!draw(subject, view, random, wi)) continue;
            const double scale = wi[2] < 0 ? subject->eta * subject->eta : 1,
                         each = fabs(wi[2]) / density(subject, view, wi);
            const double there = mu_subject_ask(subject, view, NULL, wi).value[MU_AT_F] * scale * each,
                         back = mu_subject_ask(subject, wi, NULL, view).value[MU_AT_F] * each;
            sum[WEIGHTS] += there, sum[RAISED] += there * fabs(wi[2]), sum[ASYMMETRY] += there - back;
        }
        close_batch(out, sum, samples);
    }
}

/* Two-sided, of t with the given degrees of freedom: Wallace's normal approximation (1959), right to 0.02 in z beyond 10. */
static double student_p(double t, double freedom) {
    const double z2 = freedom * log1p(t * t / freedom) * pow((8 * freedom + 1) / (8 * freedom + 3), 2);
    return mu_chi2_p(z2, 1);
}

static double variance(const moments *m, int k) {
    const double mean = m->sum[k] / BATCHES;
    return fmax(0, m->square[k] / BATCHES - mean * mean) / (BATCHES - 1);
}

void mu_check_walk(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                   mu_stream *random, mu_tally *tally) {
    const mu_case at = {subject, view, NULL, NULL};
    const size_t samples = effort->samples / BATCHES + 1;
    if (subject->eta == 1 || mu_subject_blur(subject, view, subject->eta > 0) > 1e-3) {
        mu_tally_unresolved(tally, MU_LAW_WALK_ENERGY,
                            at); /* straight through, or density() is rounding alone */
        mu_tally_unresolved(tally, MU_LAW_WALK_RECIPROCITY, at);
        return;
    }
    moments walks = {{0}, {0}}, values = {{0}, {0}};
    of_walks(subject, samples, view, random, &walks, tally);
    of_values(subject, samples, view, random, &values);
    for (int k = WEIGHTS; k <= RAISED; k++) { /* no fewer degrees than those of one side alone (Welch) */
        const double error = sqrt(variance(&walks, k) + variance(&values, k));
        const double gap = fabs(walks.sum[k] - values.sum[k]) / BATCHES;
        mu_tally_p(tally, MU_LAW_WALK_ENERGY,
                   student_p(error > 0 ? gap / error
                             : gap > 0 ? INFINITY
                                       : 0,
                             BATCHES - 1),
                   at);
    }
    const double error = sqrt(variance(&values, ASYMMETRY)), gap = fabs(values.sum[ASYMMETRY]) / BATCHES;
    mu_tally_p(tally, MU_LAW_WALK_RECIPROCITY,
               student_p(error > 0 ? gap / error
                         : gap > 0 ? INFINITY
                                   : 0,
                         BATCHES - 1),
               at);
}
