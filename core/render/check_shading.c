/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_shading.c: the float calls that renderers make, against the probe in double: f |cos|, pdf and reverse
 * pdf at sampled and at arbitrary directions, and the sample's weight against its own f and pdf.
 *
 * A float direction is an exact double, but its length is not quite one and each side normalises anew: the
 * tolerance is the accuracy promised for float (1e-4, beyond what the rounding of the inputs to float costs),
 * and that cost is measured in double by moving the directions by 4 float epsilons.
 */
#include <math.h>
#include <stdlib.h>

#include "core/render/check_tests.h"

typedef struct shading {
    mu_subject exact; /* the subject, asked in double */
    mu_tally *tally;
    void *closure, *reversed;
    const double *view;
    float side; /* -1: the shading calls are asked from below, as the subject is */
} shading;

static void turned(const shading *s, const float w[3], float out[3]) {
    for (int c = 0; c < 3; c++) out[c] = s->side * w[c];
}

static void close_to(const shading *s, mu_law law, double got, double expected, double slack,
                     const double wi[3]) {
    const mu_case at = {&s->exact, s->view, NULL, wi};
    const double smallest =
        0x1p-120; /* near the end of float's range nothing is promised but that it is small */
    if (!(isfinite(got) && got >= 0))
        mu_tally_error(s->tally, law, NAN, 1, at);
    else if (got < smallest && expected < smallest)
        mu_tally_error(s->tally, law, 0, 1e-4, at);
    else
        mu_tally_equal(s->tally, law, got, expected, 1e-4, slack, at);
}

/* f and both pdfs at one pair of directions, as the subject sees them. */
static void check_eval(const shading *s, const float wo[3], const float wi[3]) {
    const double o[3] = {(double)wo[0], (double)wo[1], (double)wo[2]};
    double i[3] = {(double)wi[0], (double)wi[1], (double)wi[2]};
    const mu_answer a = mu_subject_ask_rounded(&s->exact, 0x1p-24, o, NULL, i);
    const mu_answer r = mu_subject_ask_rounded(&s->exact, 0x1p-24, i, NULL, o);
    musurf_value value;
    const musurf_material_type *type = s->exact.type;
    float to[3], from[3];
    turned(s, wi, to), turned(s, wo, from);
    type->eval(s->closure, to, MUSURF_ALL_LOBES, &value);
    const double f = a.value[MU_AT_F] * fabs(i[2]), f_slack = a.slack[MU_AT_F] * fabs(i[2]);
    /* Beyond the range of float there is no right answer to compare with. */
    if (a.value[MU_AT_PDF] < 1e38 && r.value[MU_AT_PDF] < 1e38 && f < 1e38) {
        close_to(s, MU_LAW_SHADING_EVAL, (double)value.f[1], f, f_slack, i);
        close_to(s, MU_LAW_SHADING_EVAL, (double)value.pdf, a.value[MU_AT_PDF], a.slack[MU_AT_PDF], i);
        close_to(s, MU_LAW_SHADING_EVAL, (double)type->pdf(s->closure, to, MUSURF_ALL_LOBES),
                 a.value[MU_AT_PDF], a.slack[MU_AT_PDF], i);
        close_to(s, MU_LAW_SHADING_REVERSE, (double)value.pdf_reverse, r.value[MU_AT_PDF], r.slack[MU_AT_PDF],
                 i);
    }
    /* The same with roles swapped, by the shading calls alone. */
    if (type->setup(s->exact.material, to, NULL, 0, s->reversed)) {
        const double pdf = (double)type->pdf(s->reversed, from, MUSURF_ALL_LOBES);
        if (pdf < 1e38)
            close_to(s, MU_LAW_SHADING_REVERSE, (double)value.pdf_reverse, pdf, 2 * r.slack[MU_AT_PDF], i);
    }
}

static void check_sample(const shading *s, const float wo[3], const float u[3]) {
    musurf_sample sample;
    s->exact.type->sample(s->closure, u, MUSURF_ALL_LOBES, &sample);
    if (!sample.lobe) {
        const double sum = (double)(sample.weight[0] + sample.weight[1] + sample.weight[2] + sample.pdf);
        mu_tally_error(s->tally, MU_LAW_SHADING_WEIGHT, sum, 0x1p-1000,
                       (mu_case){&s->exact, s->view, NULL, NULL});
        return;
    }
    if (sample.lobe & MUSURF_DELTA_LOBES) return; /* f and pdf are not of the same kind */
    turned(s, sample.wi, sample.wi);
    const double i[3] = {(double)sample.wi[0], (double)sample.wi[1], (double)sample.wi[2]};
    const double o[3] = {(double)wo[0], (double)wo[1], (double)wo[2]};
    const mu_answer a = mu_subject_ask_rounded(&s->exact, 0x1p-24, o, NULL, i);
    if (!(a.value[MU_AT_PDF] < 1e38 && a.value[MU_AT_F] < 1e38)) return;
    close_to(s, MU_LAW_SHADING_WEIGHT, (double)sample.weight[1] * (double)sample.pdf,
             a.value[MU_AT_F] * fabs(i[2]), a.slack[MU_AT_F] * fabs(i[2]) + a.value[MU_AT_F] * 0x1p-22, i);
    close_to(s, MU_LAW_SHADING_WEIGHT, (double)sample.pdf, a.value[MU_AT_PDF], a.slack[MU_AT_PDF], i);
    check_eval(s, wo, sample.wi);
}

void mu_check_shading(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                      mu_stream *random, mu_tally *tally) {
    const musurf_material_type *type = subject->type;
    if (!type) return;
    musurf_plan plan = {.size = sizeof plan};
    type->describe(subject->material, &plan);
    const size_t bytes = ((size_t)plan.closure_bytes + 64) / 64 * 64;
    shading s = {
        *subject, tally, aligned_alloc(64, bytes), aligned_alloc(64, bytes), view, subject->below ? -1 : 1};
    s.exact.precision = MUSURF_DOUBLE;
    const float wo[3] = {(float)view[0], (float)view[1], (float)view[2]};
    float from[3];
    turned(&s, wo, from);
    if (s.closure && s.reversed && type->setup(subject->material, from, NULL, 0, s.closure))
        for (size_t n = 0; n < effort->points; n++) {
            const float u[3] = {mu_stream_float(random), mu_stream_float(random), mu_stream_float(random)};
            check_sample(&s, wo, u);
            const double z = mu_stream_between(random, 0.01, 1) * (subject->eta > 0 && n % 2 ? -1 : 1),
                         phi = mu_stream_between(random, 0, 6.28318530717958648);
            const double rho = sqrt(1 - z * z);
            check_eval(&s, wo, (const float[3]){(float)(rho * cos(phi)), (float)(rho * sin(phi)), (float)z});
        }
    free(s.closure);
    free(s.reversed);
}
