/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_samplers.c: do the samplers draw what the densities say? chi^2 of the micronormals; for the
 * material's own sampler also the share of rejected samples and the mean weight, against quadrature of pdf
 * and f cos; and where a sample chooses between lobes (reflection or refraction, normals or uniform
 * directions), chi^2 of the directions against the pdf of eval, lobe by lobe, at the normals that make them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/check_chi2.h"
#include "core/render/check_probability.h"
#include "core/render/check_refraction.h"
#include "core/render/check_tests.h"

typedef struct density_of {
    mu_subject subject;
    const double *view;
    int quantity;
} density_of;

/* Expected counts need four digits: float gives them at a hundredth of the cost, as long as the rounding of
 * slopes to float does not blur the distribution. That float and double agree is tested at points
 * (check_shading.c). */
static density_of density_make(const mu_subject *subject, const double view[3], int quantity) {
    density_of density = {*subject, view, quantity};
    const _Bool reaches = subject->plane.spread < 30; /* out to e^60, which floats hold */
    if (subject->type && subject->plane.condition * 0x1p-24 < 1e-5 && reaches)
        density.subject.precision = MUSURF_FLOAT;
    return density;
}

static double slope_density(void *context, const double m[3]) {
    const density_of *d = context;
    const mu_answer a = mu_subject_ask(&d->subject, d->view, m, NULL);
    const double dm = m[2] * m[2] * m[2];
    if (!(dm > 0)) return 0; /* beyond e^37: nothing is there */
    return a.value[d->quantity] * dm * (d->quantity == MU_AT_D ? m[2] : 1);
}

/* The pdf of eval at what normal m reflects or refracts the view into. */
static double reflected_density(void *context, const double m[3]) {
    const density_of *d = context;
    const double *v = d->view, facing = v[0] * m[0] + v[1] * m[1] + v[2] * m[2];
    double wi[3];
    for (int c = 0; c < 3; c++) wi[c] = 2 * facing * m[c] - v[c];
    if (!(facing > 0 && wi[2] > 0)) return 0;
    return mu_subject_ask(&d->subject, v, NULL, wi).value[MU_AT_PDF] * 4 * facing * m[2] * m[2] * m[2];
}

static double refracted_density(void *context, const double m[3]) {
    const density_of *d = context;
    double wi[3], spread;
    if (!mu_refracted(d->subject.eta, d->view, m, wi, &spread)) return 0;
    return mu_subject_ask(&d->subject, d->view, NULL, wi).value[MU_AT_PDF] * spread * m[2] * m[2] * m[2];
}

/* The pdf of eval below the surface, at what normal m would reflect the view into were it mirrored in the surface. */
static double through_density(void *context, const double m[3]) {
    const density_of *d = context;
    const double *v = d->view, facing = v[0] * m[0] + v[1] * m[1] + v[2] * m[2];
    const double wi[3] = {2 * facing * m[0] - v[0], 2 * facing * m[1] - v[1], v[2] - 2 * facing * m[2]};
    if (!(facing > 0 && wi[2] < 0)) return 0;
    return mu_subject_ask(&d->subject, v, NULL, wi).value[MU_AT_PDF] * 4 * facing * m[2] * m[2] * m[2];
}

/* The normal that makes wi, or its mirror image in the surface, of the view. */
static void half_way(const double view[3], const double wi[3], double m[3]) {
    const double h[3] = {view[0] + wi[0], view[1] + wi[1], view[2] + fabs(wi[2])};
    const double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int c = 0; c < 3; c++) m[c] = h[c] / length;
}

/* The material's own directions, by lobe; either may be NULL. */
typedef struct lobes {
    mu_cells *reflected, *refracted;
    density_of density;
} lobes;

static mu_cells *lobe_cells(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                            _Bool refracted, density_of *density) {
    const _Bool lobe = subject->bounces == MU_SMOOTH_LOBE, by_normals = refracted && !lobe;
    const mu_region region =
        mu_region_make(&subject->plane, by_normals ? MU_VISIBLE_SLOPES : MU_REFLECTING_SLOPES, view);
    *density = density_make(subject, view, MU_AT_PDF);
    if (mu_subject_blur(&density->subject, view, refracted) > 1e-3)
        density->subject.precision = MUSURF_DOUBLE;
    if (mu_subject_blur(&density->subject, view, refracted) > 1e-3) return NULL;
    return mu_cells_make(&region,
                         by_normals  ? refracted_density
                         : refracted ? through_density
                                     : reflected_density,
                         density,
                         density->subject.precision == MUSURF_FLOAT ? effort->cells / 2 : effort->cells / 4,
                         subject->jumps ? 0
                         : refracted    ? 4
                                        : 1);
}

static lobes lobes_make(const mu_subject *subject, const mu_check_effort *effort, const double view[3]) {
    lobes out = {0};
    if (subject->eta == 0 && subject->sampler != MUSURF_SAMPLE_AS_SET) return out; /* there is no choice */
    if (subject->eta != 1) out.reflected = lobe_cells(subject, effort, view, 0, &out.density);
    if (subject->eta > 0 && subject->eta != 1)
        out.refracted = lobe_cells(subject, effort, view, 1, &out.density);
    return out;
}

static void judge_lobe(const mu_subject *subject, mu_law law, const mu_cells *cells, _Bool expected, _Bool ok,
                       const double view[3], mu_tally *tally) {
    const mu_case at = {subject, view, NULL, NULL};
    if (cells && mu_cells_error(cells) < 0.05)
        mu_tally_p(tally, law, ok ? mu_cells_p(cells) : 0, at);
    else if (expected)
        mu_tally_unresolved(tally, law, at);
}

typedef struct outcome {
    double rejected, delta, weights; /* sums */
    double largest;                  /* weight */
    double worst_wi[3];
    _Bool ok;
} outcome;

static void add_to(mu_cells *cells, const double m[3], _Bool is_of_it) {
    const double elsewhere[3] = {0, 0, -1};
    if (cells) mu_cells_add(cells, is_of_it ? m : elsewhere);
}

/* Weights as importance. */
static outcome draw(const mu_subject *subject, size_t samples, musurf_sampler sampler, const double view[3],
                    mu_stream *random, mu_cells *cells, const lobes *own) {
    outcome out = {.ok = 1};
    for (size_t n = 0; n < samples && out.ok; n++) {
        double u[3];
        for (int c = 0; c < 3; c++)
            u[c] = subject->precision == MUSURF_FLOAT ? (double)mu_stream_float(random)
                                                      : mu_stream_uniform(random);
        musurf_probe_sample s;
        out.ok = mu_subject_sample(subject, sampler, view, u, &s) == MUSURF_OK;
        if (cells) mu_cells_add(cells, s.wm);
        double m[3] = {s.wm[0], s.wm[1], s.wm[2]};
        if (subject->bounces == MU_SMOOTH_LOBE && !s.rejected) half_way(view, s.wi, m);
        add_to(own->reflected, m, !s.rejected && s.wi[2] > 0);
        add_to(own->refracted, m, !s.rejected && s.wi[2] < 0);
        out.delta += s.delta;
        if (s.rejected) {
            out.rejected++;
            continue;
        }
        const double scale = s.wi[2] < 0 ? subject->eta * subject->eta : 1;
        out.weights += s.weight[1] * scale;
        for (int c = 0; c < 3; c++)
            if (!(s.weight[c] * scale <= out.largest)) {
                out.largest = s.weight[c] * scale;
                memcpy(out.worst_wi, s.wi, sizeof s.wi);
            }
    }
    return out;
}

/* A shading call samples the same density through another door. What it rejects has no normal, so the cells
 * cover the slopes that reflect upwards, and all else is one outcome. */
static void draw_shading(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                         density_of *density, mu_stream *random, mu_tally *tally) {
    const mu_case at = {subject, view, NULL, NULL};
    const mu_region region = mu_region_make(&subject->plane, MU_REFLECTING_SLOPES, view);
    musurf_plan plan = {.size = sizeof plan};
    subject->type->describe(subject->material, &plan);
    const _Bool chosen = subject->eta > 0 || subject->sampler == MUSURF_SAMPLE_AS_SET;
    mu_cells *cells =
        subject->eta == 1 ? NULL
        : chosen          ? lobe_cells(subject, effort, view, 0, density)
                 : mu_cells_make(&region, slope_density, density, effort->cells, subject->jumps ? 0 : 1);
    void *closure = aligned_alloc(64, ((size_t)plan.closure_bytes + 64) / 64 * 64);
    if (!cells || !closure || mu_cells_error(cells) > 0.05) {
        mu_tally_unresolved(tally, MU_LAW_SHADING_SAMPLER, at);
    } else {
        const float side = subject->below ? -1 : 1;
        const float wo[3] = {side * (float)view[0], side * (float)view[1], side * (float)view[2]};
        const _Bool lit = subject->type->setup(subject->material, wo, NULL, 0, closure) != 0;
        for (size_t n = 0; lit && n < effort->shading_samples; n++) {
            const float u[3] = {mu_stream_float(random), mu_stream_float(random), mu_stream_float(random)};
            musurf_sample s;
            subject->type->sample(closure, u, MUSURF_ALL_LOBES, &s);
            double m[3] = {(double)(side * s.wm[0]), (double)(side * s.wm[1]), (double)(side * s.wm[2])};
            const double wi[3] = {(double)(side * s.wi[0]), (double)(side * s.wi[1]),
                                  (double)(side * s.wi[2])};
            if (subject->bounces == MU_SMOOTH_LOBE && s.lobe) half_way(view, wi, m);
            add_to(cells, m, s.lobe & MUSURF_GLOSSY_REFLECTION);
        }
        mu_tally_p(tally, MU_LAW_SHADING_SAMPLER, lit ? mu_cells_p(cells) : 0, at);
    }
    free(closure);
    mu_cells_free(cells);
}

static void judge_own(const mu_subject *subject, double samples, const double view[3],
                      const mu_reflected *scattered, const outcome *out, mu_tally *tally) {
    const mu_case at = {subject, view, NULL, NULL}, worst = {subject, view, NULL, out->worst_wi};
    const _Bool visible = subject->sampler == MUSURF_SAMPLE_VISIBLE;
    if (visible) /* F G2/G1 <= 1 */
        mu_tally_error(tally, MU_LAW_WEIGHT_BOUND, fmax(0, out->largest - 1), mu_subject_accuracy(subject),
                       worst);
    if (!scattered->resolved) {
        mu_tally_unresolved(tally, MU_LAW_REJECTION, at);
        if (visible) mu_tally_unresolved(tally, MU_LAW_ALBEDO, at);
        return;
    }
    const double miss = fabs(scattered->pdf + (out->rejected + out->delta) / samples - 1) - scattered->error;
    const double share = fmin(1, fmax(0, scattered->pdf));
    mu_tally_p(tally, MU_LAW_REJECTION, mu_bernstein_p(miss, share * (1 - share), 1, samples), at);
    if (!visible || out->delta > 0) return; /* weights without a bound: no distribution-free test */
    const double gap = fabs(scattered->albedo - out->weights / samples) - scattered->error;
    const double variance =
        fmax(0, scattered->square - scattered->albedo * scattered->albedo) + scattered->error;
    mu_tally_p(tally, MU_LAW_ALBEDO, mu_bernstein_p(gap, variance, 1, samples), at);
}

void mu_check_sampler(const mu_subject *subject, const mu_check_effort *effort, musurf_sampler sampler,
                      const double view[3], const mu_reflected *scattered, mu_stream *random,
                      mu_tally *tally) {
    static const double up[3] = {0, 0, 1};
    const _Bool visible = sampler == MUSURF_SAMPLE_VISIBLE, own = sampler == subject->sampler,
                mixed = sampler == MUSURF_SAMPLE_AS_SET;
    const mu_law law = visible ? MU_LAW_VISIBLE_SAMPLER : MU_LAW_NDF_SAMPLER;
    const mu_case at = {subject, view, NULL, NULL};
    const mu_region region =
        mu_region_make(&subject->plane, visible ? MU_VISIBLE_SLOPES : MU_WHOLE_PLANE, view);
    /* D does not depend on the view: at the normal, masking costs nothing. */
    density_of density = visible ? density_make(subject, view, MU_AT_DV) : density_make(subject, up, MU_AT_D);
    mu_cells *cells =
        mixed ? NULL : mu_cells_make(&region, slope_density, &density, effort->cells, subject->jumps ? 0 : 1);
    /* Rounding must not carry samples across cells: these are some 1/20 wide. */
    const _Bool sharp = subject->plane.condition * mu_subject_epsilon(subject) < 1e-3;
    const _Bool resolved = cells && sharp && mu_cells_error(cells) < 0.05;
    const lobes directions = own && sharp ? lobes_make(subject, effort, view) : (lobes){0};
    const outcome out =
        draw(subject, effort->samples, sampler, view, random, resolved ? cells : NULL, &directions);
    if (resolved)
        mu_tally_p(tally, law, out.ok ? mu_cells_p(cells) : 0, at);
    else if (!mixed)
        mu_tally_unresolved(tally, law, at);
    if (own) {
        const _Bool refracts = subject->eta > 0 && subject->eta != 1;
        judge_lobe(subject, MU_LAW_OWN_SAMPLER, directions.reflected, mixed || refracts, out.ok, view, tally);
        judge_lobe(subject, MU_LAW_REFRACTED_SAMPLER, directions.refracted, refracts, out.ok, view, tally);
        judge_own(subject, (double)effort->samples, view, scattered, &out, tally);
    }
    if (own && subject->type) {
        if (subject->plane.condition * 0x1p-24 < 1e-3)
            draw_shading(subject, effort, view, &density, random, tally);
        else
            mu_tally_unresolved(tally, MU_LAW_SHADING_SAMPLER, at);
    }
    mu_cells_free(directions.reflected);
    mu_cells_free(directions.refracted);
    mu_cells_free(cells);
}
