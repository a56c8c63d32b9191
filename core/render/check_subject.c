/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_subject.c: asking the probe; see check_subject.h. */
#include "core/render/check_subject.h"

#include <math.h>
#include <string.h>

#include "core/render/check_random.h"

double mu_subject_epsilon(const mu_subject *subject) {
    return subject->precision == MUSURF_FLOAT ? 0x1p-24 : 0x1p-53;
}

double mu_subject_accuracy(const mu_subject *subject) {
    return subject->precision == MUSURF_FLOAT ? 4e-4 : 4e-12;
}

static const double *turned(const mu_subject *subject, const double *w, double out[3]) {
    for (int c = 0; w && c < 3; c++) out[c] = subject->below ? -w[c] : w[c];
    return w ? out : NULL;
}

musurf_result mu_subject_evaluate(const mu_subject *subject, const double wo[3], const double *wm,
                                  const double *wi, musurf_probe_values *out) {
    double o[3], m[3], i[3];
    memset(out, 0, sizeof *out);
    return subject->probe->evaluate(subject->material, subject->precision, turned(subject, wo, o),
                                    turned(subject, wm, m), turned(subject, wi, i), out);
}

musurf_result mu_subject_sample(const mu_subject *subject, musurf_sampler sampler, const double wo[3],
                                const double u[3], musurf_probe_sample *out) {
    double o[3];
    memset(out, 0, sizeof *out);
    const musurf_result result = subject->probe->sample(subject->material, subject->precision, sampler,
                                                        turned(subject, wo, o), u, out);
    turned(subject, out->wi, out->wi);
    turned(subject, out->wm, out->wm);
    return result;
}

mu_answer mu_subject_ask(const mu_subject *subject, const double wo[3], const double *wm, const double *wi) {
    musurf_probe_values v;
    mu_answer answer = {.ok = 0};
    if (mu_subject_evaluate(subject, wo, wm, wi, &v) != MUSURF_OK) return answer;
    const double value[MU_AT_COUNT] = {
        [MU_AT_SIGMA] = v.sigma, [MU_AT_D] = v.D,   [MU_AT_G1] = v.G1,  [MU_AT_DV] = v.Dv,
        [MU_AT_F] = v.f[1],      [MU_AT_G2] = v.G2, [MU_AT_PDF] = v.pdf};
    answer.ok = 1;
    for (int i = 0; i < MU_AT_COUNT; i++) {
        answer.value[i] = value[i];
        if (!(isfinite(value[i]) && value[i] >= 0)) answer.ok = 0;
    }
    return answer;
}

double mu_subject_blur(const mu_subject *subject, const double view[3], _Bool refracted) {
    const double shortest = refracted ? fmin(view[2], fabs(subject->eta - 1)) : view[2];
    /* the z of wo + eta wi is a difference, which a steep normal has little of */
    const double steep = refracted ? fmax(1, subject->plane.narrowest * subject->plane.condition) : 1;
    return 16 * mu_subject_epsilon(subject) *
           (subject->plane.condition + steep / (shortest * fmin(1, subject->plane.narrowest)));
}

static double signed_four(mu_stream *random) {
    return mu_stream_below(random, 2) ? 4 : -4;
}

static void normalise(double w[3]) {
    const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int c = 0; c < 3; c++) w[c] /= length;
}

/* Refraction meets eta, rounded, and cosines that are sums: every component moves as if it were 1. */
static void perturb_all(mu_stream *random, double epsilon, const double w[3], double out[3]) {
    for (int c = 0; c < 3; c++) out[c] = w[c] + signed_four(random) * epsilon;
    normalise(out);
}

static void perturb(mu_stream *random, double epsilon, const double w[3], double out[3]) {
    for (int c = 0; c < 3; c++) out[c] = w[c] * (1 + signed_four(random) * epsilon);
    normalise(out);
}

/* The sum of two rounded directions is off by epsilon (|wo| + |wi|) in each component, which weighs the more
 * the shorter the sum is. */
static void perturb_half(mu_stream *random, double epsilon, const double wo[3], const double wi[3],
                         double h[3]) {
    for (int c = 0; c < 3; c++)
        h[c] = wo[c] + wi[c] + signed_four(random) * epsilon * (fabs(wo[c]) + fabs(wi[c]));
    normalise(h);
}

static void reflect(const double wo[3], const double h[3], double out[3]) {
    double facing = 0;
    for (int c = 0; c < 3; c++) facing += wo[c] * h[c];
    for (int c = 0; c < 3; c++) out[c] = 2 * facing * h[c] - wo[c];
    normalise(out);
}

static void widen(mu_answer *answer, int quantity, double moved) {
    const double change = fabs(moved - answer->value[quantity]);
    answer->slack[quantity] = fmax(answer->slack[quantity], isnan(change) ? INFINITY : change);
}

mu_answer mu_subject_ask_rounded(const mu_subject *subject, double epsilon, const double wo[3],
                                 const double *wm, const double *wi) {
    mu_answer answer = mu_subject_ask(subject, wo, wm, wi);
    mu_stream random = mu_stream_make(0x736c61636bu, 0); /* the same signs each time */
    double still[3] = {0}, density = 0;
    const _Bool transmitted = wi && wo[2] * wi[2] < 0;
    if (wi && !transmitted) {
        perturb_half(&random, 0, wo, wi, still);
        density = mu_subject_ask(subject, wo, still, NULL).value[MU_AT_D];
    }
    for (int trial = 0; answer.ok && trial < 8; trial++) {
        double o[3], m[3], h[3], i[3];
        (transmitted ? perturb_all : perturb)(&random, epsilon, wo, o);
        if (wm) perturb(&random, epsilon, wm, m);
        if (transmitted) {
            perturb_all(&random, epsilon, wi, i);
        } else if (wi) {
            perturb_half(&random, epsilon, o, wi, h);
            reflect(o, h, i);
        }
        const mu_answer moved = mu_subject_ask(subject, o, wm ? m : NULL, wi ? i : NULL);
        for (int k = 0; k < MU_AT_COUNT; k++) widen(&answer, k, moved.value[k]);
        if (!wi || transmitted) continue;
        /* Reflected about h, wi moves too, and what its cosine does to f may hide what h does to D: D alone.
         */
        const double ratio = mu_subject_ask(subject, wo, h, NULL).value[MU_AT_D] / density;
        widen(&answer, MU_AT_F, answer.value[MU_AT_F] * ratio);
        widen(&answer, MU_AT_PDF, answer.value[MU_AT_PDF] * ratio);
    }
    return answer;
}

_Bool mu_subject_find_sampler(mu_subject *subject) {
    mu_stream random = mu_stream_make(0x73616d706c6572u, 0);
    /* samplers that turn up what falls below the horizon are told apart only where it does: seen from near it, in all
     * azimuths, for the slopes may be few */
    static const double height[] = {.8, .3, .05, .01};
    _Bool visible = 1, ndf = 1;
    for (int n = 0; n < 128; n++) {
        const double z = height[n / 2 % 4], r = sqrt(1 - z * z), turn = n < 64 ? 0 : 2.4 * n;
        const double wo[3] = {r * cos(turn), r * sin(turn), z};
        double u[3];
        for (int c = 0; c < 3; c++) u[c] = mu_stream_uniform(&random);
        if (n & 1) u[2] = 0; /* the rarest of alternatives: what a mixture seldom draws */
        musurf_probe_sample s[3];
        for (int kind = 0; kind < 3; kind++)
            if (mu_subject_sample(subject, (musurf_sampler)kind, wo, u, &s[kind]) != MUSURF_OK) return 0;
        visible = visible && s[MUSURF_SAMPLE_AS_SET].rejected == s[MUSURF_SAMPLE_VISIBLE].rejected;
        ndf = ndf && s[MUSURF_SAMPLE_AS_SET].rejected == s[MUSURF_SAMPLE_NDF].rejected;
        for (int c = 0; c < 3; c++) {
            visible = visible && s[MUSURF_SAMPLE_AS_SET].wm[c] == s[MUSURF_SAMPLE_VISIBLE].wm[c];
            ndf = ndf && s[MUSURF_SAMPLE_AS_SET].wm[c] == s[MUSURF_SAMPLE_NDF].wm[c];
        }
    }
    subject->sampler = visible == ndf ? MUSURF_SAMPLE_AS_SET
                       : visible      ? MUSURF_SAMPLE_VISIBLE
                                      : MUSURF_SAMPLE_NDF;
    return 1;
}

/* P22(s) |s|³ at radius e^t: what a grazing view sees per dt and turn of the slope plane. */
static double seen_at(const mu_subject *subject, double t, double psi) {
    const mu_plane *plane = &subject->plane;
    const double *a = plane->to_slope, r = exp(t), s[2] = {r * cos(psi), r * sin(psi)};
    const double p[2] = {plane->centre[0] + a[0] * s[0] + a[1] * s[1],
                         plane->centre[1] + a[2] * s[0] + a[3] * s[1]};
    const double z = 1 / sqrt(1 + p[0] * p[0] + p[1] * p[1]), up[3] = {0, 0, 1},
                 m[3] = {-p[0] * z, -p[1] * z, z};
    const double d = mu_subject_ask(subject, up, m, NULL).value[MU_AT_D];
    return d * z * r * (z * r) * (z * r) * z; /* P22 = D z^4 */
}

/*
 * How far out regions have to reach, from the tail itself: samples do not tell, where s^(3 - 2 gamma) of the projected area
 * lies beyond slope s, as for std. Beyond t the rest is about w(t) / -(log w)'; e^-32 of what lies before is as good as
 * nothing. Slopes end where normals, or D, leave the numbers of the arithmetic: 2^-100 or 2^-330 (whose cube is one).
 */
static void find_spread(mu_subject *subject) {
    mu_plane *plane = &subject->plane;
    const double widest = log(fmax(1, plane->narrowest * plane->condition)),
                 end = (subject->precision == MUSURF_FLOAT ? 69 : 229) - widest;
    double before = 0, last = 0, far = 0;
    plane->lost = 0;
    for (double t = -16; t < end; t += 0.5) {
        double w = 0;
        for (int i = 0; i < 16; i++) w = fmax(w, seen_at(subject, t, 0.39269908169872414 * (i + .5)));
        before += w / 2;
        if (w > 0) far = t;
        plane->lost = w > 0 && w < last && before > 0 ? w / (2 * log(last / w)) / before : w > 0 ? 1 : 0;
        last = w;
        if (t > 0 && plane->lost > 0 && plane->lost < 0x1p-46) break;
    }
    plane->spread = fmax(0, far - 30);
}

_Bool mu_subject_find_plane(mu_subject *subject) {
    enum { COUNT = 2048 };
    mu_stream random = mu_stream_make(0x706c616e65u, 0);
    const double wo[3] = {0, 0, 1};
    double slopes[2 * COUNT], scratch[2 * COUNT];
    int count = 0;
    for (int n = 0; n < COUNT; n++) {
        double u[3];
        for (int c = 0; c < 3; c++) u[c] = mu_stream_uniform(&random);
        musurf_probe_sample s;
        if (mu_subject_sample(subject, MUSURF_SAMPLE_NDF, wo, u, &s) != MUSURF_OK) return 0;
        if (!(s.wm[2] > 0)) continue;
        slopes[2 * count] = -s.wm[0] / s.wm[2];
        slopes[2 * count++ + 1] = -s.wm[1] / s.wm[2];
    }
    if (!(count > COUNT / 2 && mu_plane_from_slopes(&subject->plane, slopes, count, scratch))) return 0;
    find_spread(subject);
    return 1;
}
