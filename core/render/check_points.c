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

#include "core/render/check_refraction.h"
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

/* What one normal says: Dv = D (wo.wm) / sigma, and G1 the same for all that are not turned away. */
static mu_answer check_normal(const point *p, const double wo[3], const double wm[3]) {
    const double epsilon = mu_subject_epsilon(p->subject);
    const mu_answer a = mu_subject_ask_rounded(p->subject, epsilon, wo, wm, NULL);
    const double facing = dot(wo, wm), g1 = a.value[MU_AT_G1], d = a.value[MU_AT_D],
                 sigma = a.value[MU_AT_SIGMA];
    mu_tally_error(p->tally, MU_LAW_RANGE, a.ok ? 0 : NAN, 1, p->at);
    at_most(p, MU_LAW_RANGE, g1, 1);
    if (facing > 0 && sigma > 0) {
        equal(p, MU_LAW_VISIBLE_DENSITY, a.value[MU_AT_DV], d * facing / sigma,
              a.slack[MU_AT_DV] + 4 * epsilon * d / sigma);
        equal(p, MU_LAW_VISIBLE_DENSITY, g1, fmin(1, wo[2] / sigma), a.slack[MU_AT_G1]);
    }
    return a;
}

/* The sample's own numbers against each other and against those of its normal. */
static void check_sample(const point *p, const musurf_probe_sample *s, const double wo[3],
                         const mu_answer *normal) {
    const double epsilon = mu_subject_epsilon(p->subject), facing = dot(wo, s->wm);
    for (int c = 0; c < 3; c++)
        equal(p, MU_LAW_WEIGHT, s->weight[c] * s->pdf, s->f[c] * fabs(s->wi[2]),
              2 * epsilon * s->f[c]);                        /* the cosine is rounded at the size of wi */
    if (p->subject->sampler == MUSURF_SAMPLE_AS_SET) return; /* the normal has no density of its own */
    const _Bool visible = p->subject->sampler == MUSURF_SAMPLE_VISIBLE, transmitted = s->wi[2] < 0;
    const int quantity = visible ? MU_AT_DV : MU_AT_D;
    double share = (visible ? 1 : s->wm[2]) / (4 * facing), wi[3], spread;
    double blur = 8 * epsilon / facing;
    if (p->subject->eta > 0) { /* F, or 1 - F, was the choice */
        musurf_probe_values pair;
        if (mu_subject_evaluate(p->subject, wo, NULL, s->wi, &pair) != MUSURF_OK) return;
        if (transmitted) {
            if (mu_subject_blur(p->subject, wo, 1) > 1e-3)
                return; /* F is that of a normal had back from wi */
            if (!mu_refracted(p->subject->eta, wo, s->wm, wi, &spread))
                return; /* its edge, but for rounding */
            const double cosine = fabs(dot(wi, s->wm));
            share = (1 - pair.F[0]) / spread;
            /* F next to total reflection, and the length of wo + eta wi, feel the rounding of both cosines */
            blur = 16 * epsilon * (1 / (facing * cosine) + 1 / fabs(p->subject->eta - 1));
        } else {
            share *= pair.F[0];
            blur *= 4;
        }
    }
    equal(p, MU_LAW_NORMAL_PDF, s->pdf, normal->value[quantity] * share,
          (normal->slack[quantity] + blur * normal->value[quantity]) * share);
}

/* What the pair of directions says, there and back. */
static void check_pair(const point *p, const musurf_probe_sample *s, const double wo[3], const double wi[3]) {
    const double epsilon = mu_subject_epsilon(p->subject), eta = wi[2] < 0 ? p->subject->eta : 1;
    const mu_answer there = mu_subject_ask_rounded(p->subject, epsilon, wo, NULL, wi);
    const mu_answer back = mu_subject_ask_rounded(p->subject, epsilon, wi, NULL, wo);
    mu_tally_error(p->tally, MU_LAW_RANGE, there.ok && back.ok ? 0 : NAN, 1, p->at);
    equal(p, MU_LAW_SAMPLE_PDF, s->pdf, there.value[MU_AT_PDF], there.slack[MU_AT_PDF]);
    equal(p, MU_LAW_SAMPLE_PDF, s->f[1], there.value[MU_AT_F], there.slack[MU_AT_F]);
    /* what a smooth lobe passes on each side stands in tables of floats: two roundings apart */
    const double tables = p->subject->bounces == MU_SMOOTH_LOBE && wi[2] < 0 ? 0x1p-23 * back.value[MU_AT_F] : 0;
    equal(p, MU_LAW_RECIPROCITY, there.value[MU_AT_F] * eta * eta, back.value[MU_AT_F],
          there.slack[MU_AT_F] * eta * eta + back.slack[MU_AT_F] + tables);
}

/* f and G2 from the masking of both directions and the density of the normal between them. */
static void check_brdf(const point *p, const double wo[3], const double wi[3]) {
    const double epsilon = mu_subject_epsilon(p->subject);
    const _Bool transmitted = wi[2] < 0;
    double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
    const double length = sqrt(dot(h, h));
    for (int c = 0; c < 3; c++) h[c] /= length;
    if (transmitted && !mu_refraction_normal(p->subject->eta, wo, wi, h)) return; /* its edge */
    const double back[3] = {transmitted ? -wi[0] : wi[0], transmitted ? -wi[1] : wi[1], fabs(wi[2])};
    musurf_probe_values o, i, pair;
    if (mu_subject_evaluate(p->subject, wo, h, NULL, &o) != MUSURF_OK ||
        mu_subject_evaluate(p->subject, back, h, NULL, &i) != MUSURF_OK ||
        mu_subject_evaluate(p->subject, wo, NULL, wi, &pair) != MUSURF_OK) {
        mu_tally_error(p->tally, MU_LAW_RANGE, NAN, 1, p->at);
        return;
    }
    const mu_answer rounded = mu_subject_ask_rounded(p->subject, epsilon, wo, NULL, wi);
    const double lo = fmax(0, o.Lambda), li = fmax(0, i.Lambda), height = 1 / (1 + lo + li);
    if (p->subject->form == MU_FORM_DIRECTION && !transmitted) /* its azimuth: check_relations.c */
        at_most(p, MU_LAW_SHADOWING_FORM, height, pair.G2);
    else
        equal(p, MU_LAW_SHADOWING_FORM, pair.G2,
              p->subject->form == MU_FORM_SEPARABLE ? 1 / (1 + lo) / (1 + li) : height,
              rounded.slack[MU_AT_G2]);
    at_most(p, MU_LAW_RANGE, pair.G2, fmin(1 / (1 + lo), 1 / (1 + li)));
    for (int c = 0; c < 3; c++) {
        const double slack = pair.f[1] > 0 ? rounded.slack[MU_AT_F] * pair.f[c] / pair.f[1] : 0;
        if (transmitted)
            equal(p, MU_LAW_BTDF,
                  (1 - pair.F[c]) * o.D * pair.G2 * mu_refraction_factor(p->subject->eta, wo, wi, h),
                  pair.f[c], slack);
        else
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
        if (mu_subject_sample(subject, MUSURF_SAMPLE_AS_SET, view, u, &s) != MUSURF_OK)
            continue; /* counted by the chi^2 */
        const point normal = {subject, tally, {subject, view, s.wm, NULL}, mu_subject_accuracy(subject)};
        const point pair = {subject, tally, {subject, view, NULL, s.wi}, mu_subject_accuracy(subject)};
        const mu_answer at_normal = check_normal(&normal, view, s.wm);
        if (s.rejected || s.delta) continue;
        if (s.wi[2] < 0 && subject->bounces == MU_ONCE) /* half a dozen roundings of unit vectors, over the length of wo + eta wi */
            mu_tally_error(tally, MU_LAW_SNELL, mu_refraction_error(subject->eta, view, s.wi, s.wm),
                           8 * mu_subject_epsilon(subject) * (1 + subject->eta) / fabs(subject->eta - 1),
                           (mu_case){subject, view, s.wm, s.wi});
        check_sample(&pair, &s, view, &at_normal);
        check_pair(&pair, &s, view, s.wi);
        if (subject->bounces == MU_ONCE) check_brdf(&pair, view, s.wi);
    }
}
