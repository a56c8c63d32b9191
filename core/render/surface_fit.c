/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_fit.c: the report of a fit. */
#include "core/render/surface_fit.h"

#include <math.h>
#include <string.h>

#include "core/render/output.h"

static _Bool has_gamma(mu_ndf ndf) {
    return ndf == MU_GTR || ndf == MU_STD;
}

/* Roughness along axes where alpha means one; otherwise M. */
static _Bool has_axes(mu_ndf ndf) {
    return ndf != MU_PHONG && ndf != MU_SHEEN;
}

static const char *name_of(const mu_candidate *c) {
    return c->ndf == MU_GTR ? "gtr" : c->name;
}

static void put_object(mu_json *json, const char *key, mu_json *object) {
    mu_json line = {0};
    /* as a list's only member would be, without the list */
    mu_json_begin(&line);
    mu_json_list_begin(&line, "x");
    mu_json_list_add(&line, object);
    const size_t head = strlen("{\"x\": [");
    if (object->no_memory || line.no_memory)
        json->no_memory = 1;
    else
        mu_json_raw(json, key, line.text + head, line.length - head);
    mu_json_free(&line);
}

static void put_material(const mu_fitted *f, mu_json *json) {
    const mu_told *t = &f->told;
    const mu_ndf ndf = f->candidate->ndf;
    const double m[3] = {t->transform[0], t->transform[1], t->transform[2]};
    char rows[200];
    mu_json_begin(json);
    mu_json_string(json, "material", "musurf.microfacet");
    mu_json_string(json, "ndf", name_of(f->candidate));
    if (ndf == MU_PHONG) mu_json_number(json, "exponent", t->exponent);
    if (ndf == MU_SHEEN || ndf == MU_GTR) mu_json_number(json, "alpha", t->alpha);
    if (has_gamma(ndf)) mu_json_number(json, "gamma", t->gamma);
    if (has_axes(ndf)) {
        mu_json_number(json, "alpha_x", t->alpha_x);
        mu_json_number(json, "alpha_y", t->alpha_y);
        mu_json_number(json, "rotation", t->rotation);
    } else {
        const int length =
            snprintf(rows, sizeof rows, "[[%.17g, %.17g], [%.17g, %.17g]]", m[0], m[1], m[1], m[2]);
        mu_json_raw(json, "transform", rows, (size_t)length);
    }
    mu_json_numbers(json, "tilt", t->tilt, 2);
}

void mu_surface_fit_material(const mu_fit *fit, mu_json *json) {
    if (fit->verdict != MU_FIT_FLAT) {
        put_material(&fit->fitted[0], json);
        return;
    }
    mu_json_begin(json);
    mu_json_string(json, "material", "musurf.microfacet");
    mu_json_string(json, "ndf", "flat");
}

static void put_told(const mu_told *t, mu_ndf ndf, mu_json *json) {
    mu_json_begin(json);
    if (ndf != MU_PHONG) mu_json_number(json, "alpha", t->alpha);
    if (has_gamma(ndf)) mu_json_number(json, "gamma", t->gamma);
    if (ndf == MU_PHONG) mu_json_number(json, "exponent", t->exponent);
    if (has_axes(ndf)) {
        mu_json_number(json, "alpha_x", t->alpha_x);
        mu_json_number(json, "alpha_y", t->alpha_y);
    }
    mu_json_number(json, "rotation", t->rotation);
    mu_json_numbers(json, "mean_slope", t->mean, 2);
    mu_json_numbers(json, "tilt", t->tilt, 2);
    mu_json_numbers(json, "M", t->transform, 3);
}

static void put_partition(const char *key, const mu_partition *p, mu_json *json, mu_json *inner) {
    mu_json_begin(inner);
    mu_json_number(inner, "bins", p->bins);
    mu_json_number(inner, "rms", p->rms);
    mu_json_number(inner, "variation", p->variation);
    mu_json_number(inner, "scatter", p->noise);
    mu_json_numbers(inner, "shares", p->share, p->bins);
    mu_json_numbers(inner, "errors", p->error, p->bins);
    put_object(json, key, inner);
}

static void put_residual(const mu_residual *r, mu_json *json, mu_json *inner) {
    mu_json_begin(json);
    mu_json_number(json, "kolmogorov", r->kolmogorov);
    put_partition("steepness", &r->steepness, json, inner);
    put_partition("azimuth", &r->azimuth, json, inner);
    put_partition("joint", &r->joint, json, inner);
}

static void put_truth(mu_json *json, const char *key, _Bool is) {
    mu_json_raw(json, key, is ? "true" : "false", is ? 4 : 5);
}

static void put_candidate(const mu_fit *fit, const mu_fitted *f, mu_json *json) {
    mu_json one = {0}, inner = {0};
    mu_json_begin(json);
    mu_json_string(json, "candidate", f->candidate->name);
    put_truth(json, "explains", f->explains);
    mu_json_number(json, "parameters", mu_candidate_parameters(f->candidate));
    mu_json_number(json, "log_likelihood", f->likelihood);
    mu_json_number(json, "held_out", f->held_out);
    mu_json_number(json, "behind", f->criterion - fit->fitted[0].criterion);
    mu_json_number(json, "alike", f->alike);
    put_truth(json, "converged", f->converged);
    put_truth(json, "at_end", f->at_end);
    put_told(&f->told, f->candidate->ndf, &one);
    put_object(json, "values", &one);
    put_told(&f->error, f->candidate->ndf, &one);
    put_object(json, "errors", &one);
    mu_json_number(json, "isotropic", f->isotropic);
    mu_json_number(json, "level", f->level);
    put_material(f, &one);
    put_object(json, "material", &one);
    put_residual(&f->residual, &one, &inner);
    put_object(json, "residual", &one);
    mu_json_free(&one);
    mu_json_free(&inner);
}

_Bool mu_surface_fit_report(const mu_fit *fit, const char *file, const char *tabulated, double outside,
                            FILE *out) {
    static const char *const verdicts[] = {"explained", "flat", "refused", "refused"};
    mu_json all = {0}, one = {0};
    mu_json_begin(&all);
    mu_json_string(&all, "file", file);
    mu_json_string(&all, "verdict", verdicts[fit->verdict]);
    if (fit->reason[0]) mu_json_string(&all, "reason", fit->reason);
    if (fit->verdict == MU_FIT_EXPLAINED || fit->verdict == MU_FIT_FLAT) {
        mu_surface_fit_material(fit, &one);
        put_object(&all, "material", &one);
    }
    mu_json_number(&all, "facets", fit->facets);
    mu_json_number(&all, "effective_facets", fit->effective);
    mu_json_number(&all, "correlation", fit->correlation);
    mu_json_number(&all, "blocks", fit->blocks);
    mu_json_number(&all, "height_step", fit->step);
    mu_json_number(&all, "keep", fit->keep);
    mu_json_number(&all, "tolerance", fit->tolerance);
    if (tabulated) {
        mu_json_string(&all, "tabulated", tabulated);
        mu_json_number(&all, "outside", outside);
    }
    mu_json_list_begin(&all, "candidates");
    for (int k = 0; k < fit->count; k++) {
        put_candidate(fit, &fit->fitted[k], &one);
        mu_json_list_add(&all, &one);
    }
    mu_json_list_end(&all);
    const _Bool good = mu_json_write(&all, out);
    mu_json_free(&all);
    mu_json_free(&one);
    return good;
}
