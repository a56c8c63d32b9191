/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_parse.c: settings, checked against the parameter table, become a definition for the core. */
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "plugin/musurf_parameters.h"

enum {
    NDF = 1,
    ALPHA,
    ROUGHNESS,
    GAMMA,
    TRANSFORM,
    STRETCH,
    FRESNEL,
    SCHLICK,
    DIELECTRIC,
    CONDUCTOR,
    N,
    K,
    SAMPLER
};

/* The settings by parameter id; NULL where the default holds. */
typedef struct given {
    const musurf_host *host;
    const musurf_setting *by_id[PARAMETER_COUNT + 1];
} given;

__attribute__((format(printf, 4, 5))) static musurf_result fail(const musurf_host *host, musurf_result result,
                                                                uint32_t param, const char *format, ...) {
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (host && COVERS(host, message) && host->message)
        host->message(host->context, MUSURF_ERROR, param, text);
    return result;
}

static size_t floats_of(musurf_kind kind) {
    return kind == MUSURF_COLOR ? 3 : kind == MUSURF_MATRIX ? 4 : kind == MUSURF_CHOICE ? 0 : 1;
}

static musurf_result check_choice(const given *g, const musurf_param *p, const musurf_setting *s) {
    char known[128] = "";
    if (!COVERS(s, text) || !s->text)
        return fail(g->host, MUSURF_INVALID, p->id, "takes a word, not numbers");
    for (const char *const *choice = p->choices; *choice; choice++) {
        if (strcmp(*choice, s->text) == 0) return MUSURF_OK;
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", *known ? ", " : "", *choice);
    }
    return fail(g->host, MUSURF_INVALID, p->id, "\"%.40s\" is not known; it may be one of: %s", s->text,
                known);
}

static musurf_result check_numbers(const given *g, const musurf_param *p, const musurf_setting *s) {
    if (!COVERS(s, values) || !s->values)
        return fail(g->host, MUSURF_INVALID, p->id, "takes numbers, not a word");
    for (size_t i = 0; i < floats_of(p->kind); i++) {
        const double x = s->values[i];
        const int low = p->flags & MUSURF_MIN_EXCLUDED ? x > p->min : x >= p->min;
        const int high = p->flags & MUSURF_MAX_EXCLUDED ? x < p->max : x <= p->max;
        if (!(fabs(x) <= DBL_MAX))
            return fail(g->host, MUSURF_INVALID, p->id, "%g is not a finite number", x);
        if (low && high) continue;
        const char open = p->flags & MUSURF_MIN_EXCLUDED ? '(' : '[',
                   close = p->flags & MUSURF_MAX_EXCLUDED ? ')' : ']';
        if (isinf(p->max))
            return fail(g->host, MUSURF_INVALID, p->id, "%.9g is out of range: at least %g", x, p->min);
        return fail(g->host, MUSURF_INVALID, p->id, "%.9g is out of range: %c%g, %g%c", x, open, p->min,
                    p->max, close);
    }
    return MUSURF_OK;
}

static musurf_result gather(given *g, const musurf_setting *settings, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const musurf_setting *s = (const void *)((const char *)settings + i * settings[0].size);
        if (!COVERS(s, param) || s->param < 1 || s->param > PARAMETER_COUNT)
            return fail(g->host, MUSURF_INVALID, COVERS(s, param) ? s->param : MUSURF_NO_PARAM,
                        "setting %zu is of no known parameter", i);
        const musurf_param *p = &musurf_parameters[s->param - 1];
        if (g->by_id[p->id]) return fail(g->host, MUSURF_INVALID, p->id, "is set twice");
        g->by_id[p->id] = s;
        musurf_result result = MUSURF_OK;
        if (COVERS(s, source) && s->source == MUSURF_SLOT) {
            if (!(p->flags & MUSURF_MAY_VARY))
                return fail(g->host, MUSURF_UNSUPPORTED, p->id,
                            "cannot vary over the surface: a constant is needed");
            if (!COVERS(s, slot) || s->slot > 0xffff)
                return fail(g->host, MUSURF_INVALID, p->id, "the slot must lie in [0, 65535]");
        } else {
            result = p->kind == MUSURF_CHOICE ? check_choice(g, p, s) : check_numbers(g, p, s);
        }
        if (result != MUSURF_OK) return result;
    }
    return MUSURF_OK;
}

static double number(const given *g, uint32_t id) {
    return g->by_id[id] ? g->by_id[id]->values[0] : musurf_parameters[id - 1].initial[0];
}

static void numbers(const given *g, uint32_t id, size_t count, double *out) {
    memcpy(out, g->by_id[id] ? g->by_id[id]->values : musurf_parameters[id - 1].initial, count * sizeof *out);
}

/* Index of the choice; the table's order is that of the core's enumerations. */
static int choice(const given *g, uint32_t id) {
    const musurf_param *p = &musurf_parameters[id - 1];
    const char *text = g->by_id[id] ? g->by_id[id]->text : p->initial_choice;
    int i = 0;
    while (p->choices[i] && strcmp(p->choices[i], text) != 0) i++;
    return i;
}

static musurf_result parse_fresnel(const given *g, mu_definition *d) {
    static const uint32_t model_of[] = {[SCHLICK] = MU_FRESNEL_SCHLICK,
                                        [DIELECTRIC] = MU_FRESNEL_DIELECTRIC,
                                        [CONDUCTOR] = MU_FRESNEL_CONDUCTOR,
                                        [N] = MU_FRESNEL_CONDUCTOR,
                                        [K] = MU_FRESNEL_CONDUCTOR};
    const char *const *models = musurf_parameters[FRESNEL - 1].choices;
    int model = choice(g, FRESNEL), implied = g->by_id[FRESNEL] != NULL;
    for (uint32_t id = SCHLICK; id <= K; id++) { /* a value names its model where none is named */
        if (!g->by_id[id]) continue;
        if (implied && model != (int)model_of[id])
            return fail(g->host, MUSURF_INVALID, id, "belongs to fresnel \"%s\", but fresnel is \"%s\"",
                        models[model_of[id]], models[model]);
        model = (int)model_of[id], implied = 1;
    }
    d->fresnel = (mu_fresnel_kind)model;
    numbers(g, SCHLICK, 3, d->schlick);
    d->dielectric = number(g, DIELECTRIC);
    if (d->fresnel != MU_FRESNEL_CONDUCTOR) return MUSURF_OK;
    const int custom = g->by_id[N] || g->by_id[K];
    const char *metal = g->by_id[CONDUCTOR] ? g->by_id[CONDUCTOR]->text : custom ? "custom" : "Ag";
    if (strcmp(metal, "custom") == 0) {
        if (!(g->by_id[N] && g->by_id[K]))
            return fail(g->host, MUSURF_INVALID,
                        g->by_id[N]   ? N
                        : g->by_id[K] ? K
                                      : CONDUCTOR,
                        "a custom conductor needs both n and k");
        numbers(g, N, 3, d->n);
        numbers(g, K, 3, d->k);
    } else if (custom) {
        return fail(g->host, MUSURF_INVALID, CONDUCTOR,
                    "\"%s\" has its own n and k: give the metal, or n and k, not both", metal);
    } else {
        mu_metal(metal, d->n, d->k);
    }
    return MUSURF_OK;
}

static void parse_transform(const given *g, parsed *out) {
    const double s = number(g, STRETCH);
    double m[4] = {1, 0, 0, 1};
    const musurf_setting *set = g->by_id[TRANSFORM];
    out->varying = set && COVERS(set, source) && set->source == MUSURF_SLOT;
    if (out->varying) {
        out->slot = set->slot;
    } else {
        numbers(g, TRANSFORM, 4, m);
    }
    out->stretch[0] = s < 0 ? 1 + s : 1 / (1 - s); /* Eq. (31) */
    out->stretch[1] = s < 0 ? 1 / (1 + s) : 1 - s;
    for (int i = 0; i < 4; i++)
        out->definition.transform[i] = m[i] * out->stretch[i % 2]; /* M = transform M_s */
}

musurf_result musurf_parse(const musurf_host *host, const musurf_setting *settings, size_t count,
                           parsed *out) {
    given g = {.host = host};
    *out = (parsed){.definition = mu_definition_default()};
    mu_definition *d = &out->definition;
    musurf_result result = gather(&g, settings, count);
    if (result != MUSURF_OK) return result;
    if (g.by_id[ALPHA] && g.by_id[ROUGHNESS])
        return fail(host, MUSURF_INVALID, ROUGHNESS,
                    "set alpha or roughness (alpha is roughness squared), not both");
    d->ndf = (mu_ndf)choice(&g, NDF);
    d->alpha = g.by_id[ROUGHNESS] ? pow(number(&g, ROUGHNESS), 2) : number(&g, ALPHA);
    if (g.by_id[ROUGHNESS] && number(&g, ROUGHNESS) > 0 && d->alpha == 0) d->alpha = DBL_TRUE_MIN;
    d->gamma = number(&g, GAMMA);
    d->sampler = (mu_sampler)choice(&g, SAMPLER);
    parse_transform(&g, out);
    if ((result = parse_fresnel(&g, d)) != MUSURF_OK) return result;

    mu_complaint why;
    if (mu_definition_check(d, &why)) return MUSURF_OK;
    static const char *const fields[PARAMETER_COUNT + 1] = {[ALPHA] = "alpha",
                                                            [GAMMA] = "gamma",
                                                            [TRANSFORM] = "transform",
                                                            [SCHLICK] = "schlick",
                                                            [DIELECTRIC] = "dielectric",
                                                            [N] = "n",
                                                            [K] = "k"};
    uint32_t id = 1;
    while (id < PARAMETER_COUNT && !(fields[id] && strcmp(fields[id], why.field) == 0)) id++;
    if (id == ALPHA && g.by_id[ROUGHNESS])
        return fail(host, MUSURF_INVALID, ROUGHNESS, "%.9g makes alpha %s", number(&g, ROUGHNESS), why.text);
    return fail(host, MUSURF_INVALID, id, "%s", why.text);
}
