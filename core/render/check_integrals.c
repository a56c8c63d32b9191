/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_integrals.c: the integrals that make a microsurface valid: Eq. (3), Eq. (2), the projected area
 * sigma, the distribution of visible normals, and what is reflected. The material is a black box; the
 * coordinates are those of check_plane.h. Per area of slopes, dm = cos^3 dp.
 *
 * Tolerances: the quadrature's own estimate; the accuracy promised; and the rounding of the argument: a slope
 * p = A s rounded by epsilon moves s by epsilon times the condition of A, and the distribution changes by its
 * own size when s moves by one (a little more for steep tails: 16 stands for that).
 */
#include <math.h>

#include "core/render/check_quadrature.h"
#include "core/render/check_refraction.h"
#include "core/render/check_tests.h"

typedef struct integral_context {
    const mu_subject *subject;
    const mu_region *region;
    double view[3];
    double sigma;
    double target;  /* error that the integral may have */
    size_t refused; /* not a finite number >= 0, or no answer */
    double refused_at[3];
} integral_context;

static mu_answer ask(integral_context *c, const double *wm, const double *wi) {
    mu_answer a = mu_subject_ask(c->subject, c->view, wm, wi);
    if (!a.ok) {
        if (!c->refused++)
            for (int i = 0; i < 3; i++) c->refused_at[i] = wm ? wm[i] : wi[i];
        a = (mu_answer){.ok = 0};
    }
    return a;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalisation_at(void *context, double x, double y, double value[MU_PARTS]) {
    integral_context *c = context;
    double m[3];
    const double area = mu_region_point(c->region, x, y, m), cosine = m[2];
    if (!(area > 0 && cosine > 0)) return;
    const mu_answer a = ask(c, m, NULL);
    value[0] = a.value[MU_AT_D] * cosine * cosine * cosine * cosine * area; /* Eq. (3), (4) */
}

static void visible_at(void *context, double x, double y, double value[MU_PARTS]) {
    integral_context *c = context;
    double m[3];
    const double area = mu_region_point(c->region, x, y, m), cosine = m[2];
    const double facing = dot(c->view, m);
    if (!(area > 0 && cosine > 0 && facing > 0)) return;
    const mu_answer a = ask(c, m, NULL);
    const double dm = cosine * cosine * cosine * area;
    value[0] = a.value[MU_AT_D] * a.value[MU_AT_G1] * facing * dm / c->view[2]; /* Eq. (2) */
    value[1] = a.value[MU_AT_DV] * dm;
    value[2] = a.value[MU_AT_D] * facing * dm / c->sigma;
}

static void reflected_at(void *context, double x, double y, double value[MU_PARTS]) {
    integral_context *c = context;
    double m[3], wi[3];
    const double area = mu_region_point(c->region, x, y, m), cosine = m[2];
    const double facing = dot(c->view, m);
    for (int i = 0; i < 3; i++) wi[i] = 2 * facing * m[i] - c->view[i];
    if (!(area > 0 && cosine > 0 && facing > 0 && wi[2] > 0)) return;
    const mu_answer a = ask(c, NULL, wi);
    const double dwi = 4 * facing * cosine * cosine * cosine * area;
    const double pdf = a.value[MU_AT_PDF], weighted = a.value[MU_AT_F] * wi[2];
    value[0] = pdf * dwi;
    value[1] = weighted * dwi;
    value[2] = pdf > 0 ? weighted * weighted / pdf * dwi : 0;
}

/* Importance, which is conserved: radiance times eta^2. */
static void refracted_at(void *context, double x, double y, double value[MU_PARTS]) {
    integral_context *c = context;
    double m[3], wi[3], spread;
    const double area = mu_region_point(c->region, x, y, m), cosine = m[2], eta = c->subject->eta;
    if (!(area > 0 && cosine > 0 && mu_refracted(eta, c->view, m, wi, &spread))) return;
    const mu_answer a = ask(c, NULL, wi);
    const double dwi = spread * cosine * cosine * cosine * area;
    const double pdf = a.value[MU_AT_PDF], weighted = -a.value[MU_AT_F] * wi[2] * eta * eta;
    value[0] = pdf * dwi;
    value[1] = weighted * dwi;
    value[2] = pdf > 0 ? weighted * weighted / pdf * dwi : 0;
}

/* What a smooth lobe sends through, by the normals that would reflect its mirror image in the surface: all directions have one. */
static void sent_through_at(void *context, double x, double y, double value[MU_PARTS]) {
    integral_context *c = context;
    double m[3], wi[3];
    const double area = mu_region_point(c->region, x, y, m), cosine = m[2], eta = c->subject->eta;
    const double facing = dot(c->view, m);
    for (int i = 0; i < 3; i++) wi[i] = 2 * facing * m[i] - c->view[i];
    wi[2] = -wi[2];
    if (!(area > 0 && cosine > 0 && facing > 0 && wi[2] < 0)) return;
    const mu_answer a = ask(c, NULL, wi);
    const double dwi = 4 * facing * cosine * cosine * cosine * area;
    const double pdf = a.value[MU_AT_PDF], weighted = -a.value[MU_AT_F] * wi[2] * eta * eta;
    value[0] = pdf * dwi;
    value[1] = weighted * dwi;
    value[2] = pdf > 0 ? weighted * weighted / pdf * dwi : 0;
}

static double noise(const mu_subject *subject) {
    return 16 * mu_subject_epsilon(subject) * subject->plane.condition;
}

/* f cos, unlike the densities, has kinks where a masking form or a tilt switches; it is compared with samples only. */
static mu_integral integrate(integral_context *c, const mu_check_effort *effort, mu_integrand integrand,
                             size_t parts, double rounding) {
    const _Bool parts_alike = integrand == visible_at || integrand == normalisation_at;
    const double target = fmax(c->subject->precision == MUSURF_FLOAT ? 1e-4 : effort->target, rounding);
    /* Error estimates can be fooled: where the visible slopes run off to infinity, sheen has a feature in y that passes
     * between the nodes of a quarter turn. So more is asked than relied on, and of panels that start small: in
     * float, too, where the rounding of a nearly singular M would else let the integral stop at some per cent. */
    const double asked = !parts_alike                             ? target
                         : c->subject->precision == MUSURF_DOUBLE ? target / 1024
                                                                  : fmin(target, 1e-3);
    c->target = target;
    const mu_quadrature q = {.integrand = integrand,
                             .context = c,
                             .parts = parts,
                             .target = {parts_alike ? asked : fmax(target, 1e-6),
                                        parts_alike ? target : fmax(target, 1e-4), parts_alike ? target : 0,
                                        0},
                             .panel_limit = effort->panels,
                             .rule = MU_KRONROD_15};
    /* the bulk of a distribution is a few units of t wide: panels of ten see it */
    const double reach = -log(c->region->far) - c->region->low;
    const size_t columns = reach > 60 ? (size_t)(reach / 10) : 6;
    return mu_integrate(&q, (const double[2]){0, 1}, columns, (const double[2]){0, 2}, parts_alike ? 16 : 4);
}

static void judge(integral_context *c, mu_law law, const mu_integral *integral, size_t part, double expected,
                  double rounding, mu_tally *tally) {
    const double tolerance = integral->error[part] + c->target + mu_subject_accuracy(c->subject) + rounding +
                             c->subject->plane.lost;
    const mu_case at = {c->subject, law == MU_LAW_NORMALISATION ? NULL : c->view, NULL, NULL};
    const double error = integral->value[part] - expected;
    if (integral->panels == 0 || (tolerance > 0.01 && !(fabs(error) > tolerance)))
        mu_tally_unresolved(tally, law, at);
    else
        mu_tally_error(tally, law, error, tolerance, at);
}

static void judge_refusals(integral_context *c, _Bool normals, mu_tally *tally) {
    const double *where = c->refused_at;
    const double *wm = c->refused && normals ? where : NULL, *wi = c->refused && !normals ? where : NULL;
    const mu_case at = {c->subject, c->view, wm, wi};
    mu_tally_error(tally, MU_LAW_RANGE, c->refused ? NAN : 0, 1, at);
}

void mu_check_normalisation(const mu_subject *subject, const mu_check_effort *effort, mu_tally *tally) {
    integral_context c = {.subject = subject, .view = {0, 0, 1}};
    const mu_region region = mu_region_make(&subject->plane, MU_WHOLE_PLANE, c.view);
    c.region = &region;
    const mu_integral integral = integrate(&c, effort, normalisation_at, 1, noise(subject));
    judge(&c, MU_LAW_NORMALISATION, &integral, 0, 1, noise(subject), tally);
    judge_refusals(&c, 1, tally);
}

/* Masked and hidden: G1 and Dv must vanish on the slopes that face away. */
static void check_hidden(const mu_subject *subject, const double view[3], mu_tally *tally) {
    const mu_region whole = mu_region_make(&subject->plane, MU_WHOLE_PLANE, view);
    for (int i = 0; i < 8; i++) {
        double m[3];
        mu_region_point(&whole, (1 - whole.low / 4 + i) / -whole.low, .5, m);
        if (!(dot(view, m) < -1e-6 * fabs(view[2]))) continue;
        const mu_answer a = mu_subject_ask(subject, view, m, NULL);
        mu_tally_error(tally, MU_LAW_HIDDEN_NORMALS, a.value[MU_AT_G1] + a.value[MU_AT_DV], 0x1p-1000,
                       (mu_case){subject, view, m, NULL});
    }
}

void mu_check_visible(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                      mu_tally *tally) {
    integral_context c = {.subject = subject, .view = {view[0], view[1], view[2]}};
    const mu_region region = mu_region_make(&subject->plane, MU_VISIBLE_SLOPES, view);
    c.region = &region;
    c.sigma = mu_subject_ask(subject, view, NULL, NULL).value[MU_AT_SIGMA];
    const mu_integral integral = integrate(&c, effort, visible_at, 3, noise(subject));
    /* Leaning toward the viewer, a tilted microsurface shows less than v.n: then G1 is 1, and sigma is what there is. */
    judge(&c, MU_LAW_MASKING, &integral, 0, fmin(1, c.sigma / view[2]), noise(subject), tally);
    judge(&c, MU_LAW_VISIBLE_NORMALS, &integral, 1, 1, noise(subject), tally);
    judge(&c, MU_LAW_PROJECTED_AREA, &integral, 2, 1, noise(subject), tally);
    judge_refusals(&c, 1, tally);
    check_hidden(subject, view, tally);
}

/* What the region's normals send by `integrand`, if the normals can be had back from wi. */
static mu_reflected scattered(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                              mu_region_kind kind, mu_integrand integrand, mu_tally *tally) {
    integral_context c = {.subject = subject, .view = {view[0], view[1], view[2]}};
    const mu_region region = mu_region_make(&subject->plane, kind, view);
    c.region = &region;
    const double rounding = mu_subject_blur(subject, view, kind == MU_VISIBLE_SLOPES);
    mu_reflected out = {.resolved = 0};
    if (rounding < 1e-3) {
        const mu_integral integral = integrate(&c, effort, integrand, 3, rounding);
        out.pdf = integral.value[0];
        out.albedo = integral.value[1];
        out.square = integral.value[2];
        out.error = fmax(integral.error[0], integral.error[1]) + mu_subject_accuracy(subject) + rounding;
        /* doubt of less than one standard error of the samples' share, 1/2 at most, hides little of what they could show */
        const double visible = .5 / sqrt((double)effort->samples);
        out.resolved = integral.panels && out.error < fmax(kind == MU_VISIBLE_SLOPES ? 1e-2 : 1e-3, visible);
        judge_refusals(&c, 0, tally);
    }
    return out;
}

mu_reflected mu_check_scattered(const mu_subject *subject, const mu_check_effort *effort,
                                const double view[3], mu_tally *tally) {
    const mu_case at = {subject, view, NULL, NULL};
    mu_reflected out = scattered(subject, effort, view, MU_REFLECTING_SLOPES, reflected_at, tally);
    if (subject->eta > 0 && subject->eta != 1 && out.resolved) {
        /* Where light leaves the denser side the integrand has an edge within the region: coarser, and sooner given up */
        mu_check_effort less = *effort;
        less.target = 1e-4, less.panels = effort->panels / 4;
        const _Bool lobe = subject->bounces == MU_SMOOTH_LOBE;
        const mu_reflected through =
            scattered(subject, &less, view, lobe ? MU_REFLECTING_SLOPES : MU_VISIBLE_SLOPES,
                      lobe ? sent_through_at : refracted_at, tally);
        out.pdf += through.pdf, out.albedo += through.albedo, out.square += through.square;
        out.error += through.error;
        out.resolved = through.resolved;
    }
    /* tables of what is lost interpolate: within 1 % of what there is, or 5 % where total reflection makes edges */
    const double tables = subject->bounces == MU_ONCE ? 0 : subject->eta > 0 ? .05 : .01;
    if (out.resolved)
        mu_tally_error(tally, MU_LAW_FURNACE, fmax(0, out.albedo - 1), out.error + tables, at);
    else
        mu_tally_unresolved(tally, MU_LAW_FURNACE, at);
    return out;
}
