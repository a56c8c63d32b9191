/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_relations.c: what M must do, said without the code under test: by comparing a material with its
 * original, with itself turned, and with the textbook's anisotropic GGX. This alone tells M from its inverse
 * or transpose: each of those makes a valid microsurface that satisfies every integral.
 */
#include <math.h>

#include "core/render/check_tests.h"

static void compare(mu_tally *tally, mu_law law, const mu_subject *subject, double a, double b, double slack,
                    mu_case at) {
    mu_tally_equal(tally, law, a, b, mu_subject_accuracy(subject), slack, at);
}

static _Bool sample(const mu_subject *subject, musurf_sampler sampler, const double view[3],
                    mu_stream *random, musurf_probe_sample *s) {
    double u[3];
    for (int c = 0; c < 3; c++) u[c] = mu_stream_uniform(random);
    return mu_subject_sample(subject, sampler, view, u, s) == MUSURF_OK && s->wm[2] > 0;
}

static void normalise(double w[3]) {
    const double length = hypot(hypot(w[0], w[1]), w[2]);
    for (int c = 0; c < 3; c++) w[c] /= length;
}

/* P22 of the original at M^T p - tilt. M, the tilt and the slope p of m may be moved by a few roundings: `sign` tells
 * each of the eight numbers which way, in units of epsilon. */
static double expected_density(const mu_subject *original, const mu_deformation *how, const double view[3],
                               const double wm[3], double epsilon, const double sign[8]) {
    const double *m = how->m;
    const double px = -wm[0] / wm[2] * (1 + sign[4] * epsilon), py = -wm[1] / wm[2] * (1 + sign[5] * epsilon);
    double t[4];
    for (int i = 0; i < 4; i++) t[i] = m[i] * (1 + sign[i] * epsilon);
    double u[3] = {how->tilt[0] * (1 + sign[6] * epsilon) - (t[0] * px + t[2] * py),
                   how->tilt[1] * (1 + sign[7] * epsilon) - (t[1] * px + t[3] * py), 1};
    normalise(u);
    const mu_answer a = mu_subject_ask(original, view, u, NULL);
    const double ratio = u[2] / wm[2];
    return fabs(how->determinant) * a.value[MU_AT_D] * ratio * ratio * ratio * ratio;
}

static void check_slopes(const mu_subject *subject, const mu_subject *original, const mu_deformation *how,
                         const double view[3], const double wm[3], mu_tally *tally) {
    const double epsilon = mu_subject_epsilon(subject);
    const mu_answer a = mu_subject_ask_rounded(subject, epsilon, view, wm, NULL);
    const double expected = expected_density(original, how, view, wm, 0, (double[8]){0});
    double slack = a.slack[MU_AT_D];
    if (subject->precision == MUSURF_FLOAT && a.value[MU_AT_D] < 0x1p-100 && expected < 0x1p-100)
        return; /* beyond the range of float */
    /* The slope is rounded 4 times on its way, and so is each entry of M: scaled (2), multiplied, added.
     * Where M^T m is short, moving m alone may move M^T m across itself, which D does not feel; the entries
     * move it along. */
    mu_stream random = mu_stream_make(0x656e7472696573u, 0); /* the same signs each time */
    for (int trial = 0; trial < 16; trial++) {
        double sign[8];
        for (int i = 0; i < 8; i++) sign[i] = mu_stream_below(&random, 2) ? 4 : -4;
        const double moved = expected_density(original, how, view, wm, epsilon, sign);
        slack = fmax(slack, fabs(moved - expected));
    }
    /* det M itself is rounded: by epsilon times the condition of M at most. */
    compare(tally, MU_LAW_SLOPES_COVARIANT, subject, a.value[MU_AT_D], expected,
            2 * slack +
                4 * epsilon * expected * (subject->precision == MUSURF_FLOAT ? subject->plane.condition : 1),
            (mu_case){subject, view, wm, NULL});
}

/* M^-1 v, with M^-1 = adj(M) / det, and lowered by the tilt; returns how much of its z may be rounding. */
static double pull_back(const mu_deformation *how, const double v[3], double w[3]) {
    const double *m = how->m, *t = how->tilt;
    w[0] = fma(m[3], v[0], -m[1] * v[1]) / how->determinant;
    w[1] = fma(m[0], v[1], -m[2] * v[0]) / how->determinant;
    w[2] = v[2] - t[0] * w[0] - t[1] * w[1];
    return fabs(v[2]) + fabs(t[0] * w[0]) + fabs(t[1] * w[1]);
}

/* |w| sigma(w / |w|) of the original; from below a surface shows w.z less than it does from above. */
static double homogeneous_sigma(const mu_subject *original, const double w[3]) {
    const double length = hypot(hypot(w[0], w[1]), w[2]), up = w[2] < 0 ? -1 / length : 1 / length;
    const double unit[3] = {up * w[0], up * w[1], up * w[2]};
    return length * mu_subject_ask(original, unit, NULL, NULL).value[MU_AT_SIGMA] + fmin(w[2], 0);
}

static void check_masking(const mu_subject *subject, const mu_subject *original, const mu_deformation *how,
                          const double view[3], mu_tally *tally) {
    const double epsilon = mu_subject_epsilon(subject);
    const mu_answer a = mu_subject_ask_rounded(subject, epsilon, view, NULL, NULL);
    double w[3], expected = 0, slack = a.slack[MU_AT_SIGMA];
    for (int i = 0; i < 5; i++) {
        const double v[3] = {view[0] * (1 + (i == 1   ? 4
                                             : i == 2 ? -4
                                                      : 0) *
                                                epsilon),
                             view[1] * (1 + (i == 3   ? 4
                                             : i == 4 ? -4
                                                      : 0) *
                                                epsilon),
                             view[2]};
        const double cancelled = pull_back(how, v, w);
        const double value = homogeneous_sigma(original, w);
        if (i == 0)
            expected = value, slack = fmax(slack, 4 * epsilon * (w[2] < 0 ? cancelled : cancelled - w[2]));
        else
            slack = fmax(slack, fabs(value - expected));
    }
    /* sigma_M(v) = |M^-1 v| sigma(M^-1 v / |M^-1 v|); with G1 = v.z / sigma this is Eq. (12). */
    compare(tally, MU_LAW_MASKING_INVARIANT, subject, a.value[MU_AT_SIGMA], expected,
            2 * slack +
                4 * epsilon * expected * (subject->precision == MUSURF_FLOAT ? subject->plane.condition : 1),
            (mu_case){subject, view, NULL, NULL});
}

/* G2 by what the two directions are before M: Lambda, which goes with them, and, where their azimuths count, the angle
 * between (M^-1 v)_xy and (M^-1 l)_xy: g = 1 / (1 + 4.41 phi), van Ginneken et al. 1998. */
static double expected_shadowing(const mu_subject *subject, const mu_deformation *how, const double view[3],
                                 const double light[3]) {
    double v[3], l[3];
    pull_back(how, view, v), pull_back(how, light, l);
    const double sigma_v = mu_subject_ask(subject, view, NULL, NULL).value[MU_AT_SIGMA],
                 sigma_l = mu_subject_ask(subject, light, NULL, NULL).value[MU_AT_SIGMA];
    const double a = fmax(0, sigma_v / view[2] - 1), b = fmax(0, sigma_l / light[2] - 1);
    const double phi = fabs(atan2(v[0] * l[1] - v[1] * l[0], v[0] * l[0] + v[1] * l[1]));
    return subject->form == MU_FORM_SEPARABLE ? 1 / (1 + a) / (1 + b)
           : subject->form == MU_FORM_HEIGHT  ? 1 / (1 + a + b)
                                             : 1 / (1 + fmax(a, b) + (1 - 1 / (1 + 4.41 * phi)) * fmin(a, b));
}

static void check_shadowing(const mu_subject *subject, const mu_deformation *how, const double view[3],
                            mu_stream *random, mu_tally *tally) {
    const double epsilon = mu_subject_epsilon(subject), z = mu_stream_between(random, 0.02, 1),
                 azimuth = mu_stream_between(random, 0, 6.28318530717958648), flat = sqrt(1 - z * z);
    const double light[3] = {flat * cos(azimuth), flat * sin(azimuth), z};
    musurf_probe_values pair;
    if (how->more && subject->form == MU_FORM_DIRECTION) return;
    if (mu_subject_evaluate(subject, view, NULL, light, &pair) != MUSURF_OK) return;
    const double expected = expected_shadowing(subject, how, view, light);
    double slack = 0;
    for (int i = 0; i < 8; i++) { /* the directions, 4 roundings each way */
        double v[3], l[3];
        for (int c = 0; c < 3; c++) {
            v[c] = view[c] * (1 + (i >> c & 1 ? 4 : -4) * epsilon);
            l[c] = light[c] * (1 + ((i * 5 + 3) >> c & 1 ? 4 : -4) * epsilon);
        }
        normalise(v), normalise(l);
        slack = fmax(slack, fabs(expected_shadowing(subject, how, v, l) - expected));
    }
    /* Lambda = sigma / cos - 1 loses epsilon of 1 there; the azimuths what the condition of M makes of theirs */
    compare(tally, MU_LAW_SHADOWING_INVARIANT, subject, pair.G2, expected, 2 * slack + 8 * epsilon,
            (mu_case){subject, view, NULL, light});
}

void mu_check_transform(const mu_subject *subject, const mu_subject *original, const mu_deformation *how,
                        const mu_check_effort *effort, const double view[3], mu_stream *random,
                        mu_tally *tally) {
    const double up[3] = {0, 0, 1};
    check_masking(subject, original, how, view, tally);
    check_shadowing(subject, how, view, random, tally);
    for (size_t n = 0; n < effort->points; n++) {
        /* Normals of either material: a wrong M shows where only one of them has normals. */
        musurf_probe_sample s;
        if (!sample(n & 1 ? subject : original, MUSURF_SAMPLE_NDF, up, random, &s)) continue;
        check_slopes(subject, original, how, view, s.wm, tally);
    }
}

static void turn(double angle, const double in[3], double out[3]) {
    const double x = in[0], y = in[1];
    out[0] = cos(angle) * x - sin(angle) * y;
    out[1] = sin(angle) * x + cos(angle) * y;
    out[2] = in[2];
}

void mu_check_rotation(const mu_subject *subject, const mu_subject *turned, double angle,
                       const mu_check_effort *effort, const double view[3], mu_stream *random,
                       mu_tally *tally) {
    const double epsilon = mu_subject_epsilon(subject);
    static const int compared[] = {MU_AT_F, MU_AT_PDF, MU_AT_G2};
    for (size_t n = 0; n < effort->points; n++) {
        musurf_probe_sample s;
        if (!sample(subject, MUSURF_SAMPLE_AS_SET, view, random, &s) || s.rejected || s.delta) continue;
        double o[3], i[3];
        turn(angle, view, o);
        turn(angle, s.wi, i);
        /* The turn rounds at the size of the whole direction: epsilon of its horizontal part, in each
         * component. */
        const double scale = 1 / fmax(1e-3, fmin(fabs(cos(angle)), fabs(sin(angle))));
        const mu_answer a = mu_subject_ask_rounded(subject, scale * epsilon, view, NULL, s.wi);
        const mu_answer b = mu_subject_ask_rounded(turned, scale * epsilon, o, NULL, i);
        for (size_t k = 0; k < sizeof compared / sizeof *compared; k++)
            compare(tally, MU_LAW_ROTATION, subject, a.value[compared[k]], b.value[compared[k]],
                    2 * (a.slack[compared[k]] + b.slack[compared[k]]), (mu_case){subject, view, NULL, s.wi});
    }
}

void mu_check_classic(const mu_subject *subject, double ax, double ay, const mu_check_effort *effort,
                      const double view[3], mu_stream *random, mu_tally *tally) {
    const double epsilon = mu_subject_epsilon(subject), pi = 3.14159265358979323846;
    /* Heitz 2014, "Understanding the masking-shadowing function", Eq. (85) and (86), as slopes over
     * roughness. */
    const double lean = hypot(ax * view[0], ay * view[1]), root = hypot(view[2], lean);
    const mu_answer v = mu_subject_ask(subject, view, NULL, NULL);
    compare(tally, MU_LAW_CLASSIC, subject, v.value[MU_AT_SIGMA], (view[2] + root) / 2, 0,
            (mu_case){subject, view, NULL, NULL});
    for (size_t n = 0; n < effort->points; n++) {
        const double r = exp(mu_stream_between(random, -8, 4)), phi = mu_stream_between(random, 0, 2 * pi);
        double m[3] = {ax * r * cos(phi), ay * r * sin(phi), 1};
        normalise(m);
        const double sx = m[0] / (ax * m[2]), sy = m[1] / (ay * m[2]), t = 1 + sx * sx + sy * sy;
        const double c2 = m[2] * m[2];
        const mu_answer a = mu_subject_ask_rounded(subject, epsilon, view, m, NULL);
        compare(tally, MU_LAW_CLASSIC, subject, a.value[MU_AT_D], 1 / (pi * ax * ay * c2 * c2 * t * t),
                2 * a.slack[MU_AT_D], (mu_case){subject, view, m, NULL});
    }
}
