/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_points.c: identities between the probe's quantities, at directions that the material itself sampled.
 *
 * Identities among the numbers of one answer hold to the accuracy promised. Where two answers are compared
 * that reach the same normal by different roundings, the tolerance adds what such roundings change
 * (mu_subject_ask_rounded).
 */
#include <math.h>
#include <string.h>

#include "core/render/check_tests.h"

typedef struct point {
    const mu_subject *subject;
    mu_tally *tally;
    mu_case at;
    double accuracy;
} point;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void equal(const point *p, mu_law law, double a, double b, double slack) {
    mu_tally_equal(p->tally, law, a, b, p->accuracy, slack, p->at);
}

static void at_most(const point *p, mu_law law, double value, double bound) {
    mu_tally_error(p->tally, law, isnan(value) ? NAN : fmax(0, value - bound), p->accuracy, p->at);
}

/* What one normal says: Dv = D G1 (wo.wm) / wo.z. */
static mu_answer check_normal(const point *p, const double wo[3], const double wm[3]) {
    const double epsilon = mu_subject_epsilon(p->subject);
    const mu_answer a = mu_subject_ask_rounded(p->subject, epsilon, wo, wm, NULL);
    const double facing = dot(wo, wm), g1 = a.value[MU_AT_G1], d = a.value[MU_AT_D];
    mu_tally_error(p->tally, MU_LAW_RANGE, a.ok ? 0 : NAN, 1, p->at);
    at_most(p, MU_LAW_RANGE, g1, 1);
    if (facing > 0)
        equal(p, MU_LAW_VISIBLE_DENSITY, a.value[MU_AT_DV], g1 * d * facing / wo[2],
              a.slack[MU_AT_DV] + 4 * epsilon * d * g1 / wo[2]);
    return a;
}

/* The sample's own numbers against each other and against those of its normal. */
static void check_sample(const point *p, const musurf_probe_sample *s, const double wo[3],
                         const mu_answer *normal) {
    const double facing = dot(wo, s->wm), epsilon = mu_subject_epsilon(p->subject);
    for (int c = 0; c < 3; c++)
        equal(p, MU_LAW_WEIGHT, s->weight[c] * s->pdf, s->f[c] * s->wi[2],
              2 * epsilon * s->f[c]); /* the cosine is rounded at the size of wi */
    const _Bool visible = p->subject->sampler == MUSURF_SAMPLE_VISIBLE;
    const int quantity = visible ? MU_AT_DV : MU_AT_D;
    const double density = normal->value[quantity] * (visible ? 1 : s->wm[2]);
    const double slack = normal->slack[quantity] * (visible ? 1 : s->wm[2]);
    equal(p, MU_LAW_NORMAL_PDF, s->pdf, density / (4 * facing),
          slack / (4 * facing) + 8 * epsilon / facing * density / (4 * facing));
}

/* What the pair of directions says, there and back. */
static void check_pair(const point *p, const musurf_probe_sample *s, const double wo[3], const double wi[3]) {
    const double epsilon = mu_subject_epsilon(p->subject);
    const mu_answer there = mu_subject_ask_rounded(p->subject, epsilon, wo, NULL, wi);
    const mu_answer back = mu_subject_ask_rounded(p->subject, epsilon, wi, NULL, wo);
    mu_tally_error(p->tally, MU_LAW_RANGE, there.ok && back.ok ? 0 : NAN, 1, p->at);
    equal(p, MU_LAW_SAMPLE_PDF, s->pdf, there.value[MU_AT_PDF], there.slack[MU_AT_PDF]);
    equal(p, MU_LAW_SAMPLE_PDF, s->f[1], there.value[MU_AT_F], there.slack[MU_AT_F]);
    equal(p, MU_LAW_RECIPROCITY, there.value[MU_AT_F], back.value[MU_AT_F],
          there.slack[MU_AT_F] + back.slack[MU_AT_F]);
}

/* f and G2 from the masking of both directions and the density of the half-vector. */
static void check_brdf(const point *p, const double wo[3], const double wi[3]) {
    const double epsilon = mu_subject_epsilon(p->subject);
    double h[3], square = 0;
    for (int c = 0; c < 3; c++) {
        h[c] = wo[c] + wi[c];
        square += h[c] * h[c];
    }
    for (int c = 0; c < 3; c++) h[c] /= sqrt(square);
    musurf_probe_values o, i, pair;
    const musurf_probe *probe = p->subject->probe;
    const musurf_material *material = p->subject->material;
    const musurf_precision precision = p->subject->precision;
    if (probe->evaluate(material, precision, wo, h, NULL, &o) != MUSURF_OK ||
        probe->evaluate(material, precision, wi, h, NULL, &i) != MUSURF_OK ||
        probe->evaluate(material, precision, wo, NULL, wi, &pair) != MUSURF_OK) {
        mu_tally_error(p->tally, MU_LAW_RANGE, NAN, 1, p->at);
        return;
    }
    const mu_answer rounded = mu_subject_ask_rounded(p->subject, epsilon, wo, NULL, wi);
    equal(p, MU_LAW_HEIGHT_CORRELATION, pair.G2, 1 / (1 + o.Lambda + i.Lambda), rounded.slack[MU_AT_G2]);
    at_most(p, MU_LAW_RANGE, pair.G2, fmin(o.G1, i.G1));
    for (int c = 0; c < 3; c++) {
        const double slack = pair.f[1] > 0 ? rounded.slack[MU_AT_F] * pair.f[c] / pair.f[1] : 0;
        equal(p, MU_LAW_BRDF, pair.F[c] * o.D * pair.G2 / (4 * wo[2] * wi[2]), pair.f[c], slack);
        at_most(p, MU_LAW_RANGE, pair.F[c], 1);
    }
}

void mu_check_points(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                     mu_stream *random, mu_tally *tally) {
    for (size_t n = 0; n < effort->points; n++) {
        double u[3];
        for (int c = 0; c < 3; c++) u[c] = mu_stream_uniform(random);
        musurf_probe_sample s;
        memset(&s, 0, sizeof s);
        if (subject->probe->sample(subject->material, subject->precision, MUSURF_SAMPLE_AS_SET, view, u,
                                   &s) != MUSURF_OK)
            continue; /* counted by the chi^2 */
        const point normal = {subject, tally, {subject, view, s.wm, NULL}, mu_subject_accuracy(subject)};
        const point pair = {subject, tally, {subject, view, NULL, s.wi}, mu_subject_accuracy(subject)};
        const mu_answer at_normal = check_normal(&normal, view, s.wm);
        if (s.rejected) continue;
        check_sample(&pair, &s, view, &at_normal);
        check_pair(&pair, &s, view, s.wi);
        check_brdf(&pair, view, s.wi);
    }
}
