/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_parse.c: settings, checked against the parameter table, become a definition for the core. */
#include <math.h>
#include <string.h>

#include "plugin/musurf_given.h"

static musurf_result parse_fresnel(const given *g, mu_definition *d) {
    static const uint32_t model_of[] = {[SCHLICK] = MU_FRESNEL_SCHLICK,
                                        [DIELECTRIC] = MU_FRESNEL_DIELECTRIC,
                                        [CONDUCTOR] = MU_FRESNEL_CONDUCTOR,
                                        [N] = MU_FRESNEL_CONDUCTOR,
                                        [K] = MU_FRESNEL_CONDUCTOR};
    const char *const *models = musurf_parameters[FRESNEL - 1].choices;
    int model = musurf_choice(g, FRESNEL), implied = g->by_id[FRESNEL] != NULL;
    for (uint32_t id = SCHLICK; id <= K; id++) { /* a value names its model where none is named */
        if (!g->by_id[id]) continue;
        if (implied && model != (int)model_of[id])
            return musurf_fail(g->host, MUSURF_INVALID, id,
                               "belongs to fresnel \"%s\", but fresnel is \"%s\"", models[model_of[id]],
                               models[model]);
        model = (int)model_of[id], implied = 1;
    }
    d->fresnel = (mu_fresnel_kind)model;
    musurf_numbers(g, SCHLICK, 3, d->schlick);
    d->dielectric = musurf_number(g, DIELECTRIC);
    if (d->fresnel != MU_FRESNEL_CONDUCTOR) return MUSURF_OK;
    const int custom = g->by_id[N] || g->by_id[K];
    const char *metal = g->by_id[CONDUCTOR] ? g->by_id[CONDUCTOR]->text : custom ? "custom" : "Ag";
    if (strcmp(metal, "custom") == 0) {
        if (!(g->by_id[N] && g->by_id[K]))
            return musurf_fail(g->host, MUSURF_INVALID,
                               g->by_id[N]   ? N
                               : g->by_id[K] ? K
                                             : CONDUCTOR,
                               "a custom conductor needs both n and k");
        musurf_numbers(g, N, 3, d->n);
        musurf_numbers(g, K, 3, d->k);
    } else if (custom) {
        return musurf_fail(g->host, MUSURF_INVALID, CONDUCTOR,
                           "\"%s\" has its own n and k: give the metal, or n and k, not both", metal);
    } else {
        mu_metal(metal, d->n, d->k);
    }
    return MUSURF_OK;
}

static musurf_result parse_flakes(const given *g, parsed *out) {
    mu_definition *d = &out->definition;
    d->flake_density = musurf_number(g, FLAKE_DENSITY);
    d->flake_cone = musurf_number(g, FLAKE_CONE);
    const double seed = musurf_number(g, FLAKE_SEED);
    d->flake_seed = (uint64_t)seed;
    if (seed != floor(seed))
        return musurf_fail(g->host, MUSURF_INVALID, FLAKE_SEED, "%.9g is no whole number", seed);
    for (uint32_t id = FLAKE_DENSITY; id <= FOOTPRINT; id++)
        if (g->by_id[id] && d->ndf != MU_DISCRETE_GGX && d->ndf != MU_DISCRETE_BECKMANN)
            return musurf_fail(g->host, MUSURF_INVALID, id,
                               "belongs to discrete_ggx and discrete_beckmann, but ndf is another");
    const musurf_setting *set = g->by_id[FOOTPRINT];
    if (!set || !mu_is_discrete(d)) return MUSURF_OK;
    out->footprint_from = musurf_varies(g, FOOTPRINT) ? FOOTPRINT_SLOT : FOOTPRINT_CONSTANT;
    if (out->footprint_from == FOOTPRINT_SLOT)
        out->footprint_slot = set->slot;
    else
        musurf_numbers(g, FOOTPRINT, 6, out->footprint);
    return MUSURF_OK;
}

/* What the core says of a definition, in the words of the parameter that caused it. */
static musurf_result judge(const given *g, const mu_definition *d) {
    static const struct {
        const char *field;
        uint32_t id;
    } parameters[] = {{"alpha", ALPHA},
                      {"gamma", GAMMA},
                      {"exponent", EXPONENT},
                      {"transform", TRANSFORM},
                      {"tilt", TILT},
                      {"histogram", HISTOGRAM},
                      {"flake_density", FLAKE_DENSITY},
                      {"flake_cone", FLAKE_CONE},
                      {"smith", SMITH},
                      {"sampler", SAMPLER_CHOICE},
                      {"transmission", TRANSMISSION},
                      {"multiple", MULTIPLE_SCATTERING},
                      {"schlick", SCHLICK},
                      {"dielectric", DIELECTRIC},
                      {"n", N},
                      {"k", K}};
    mu_complaint why;
    if (mu_definition_check(d, &why)) return MUSURF_OK;
    uint32_t id = NDF;
    for (size_t i = 0; i < sizeof parameters / sizeof parameters[0]; i++)
        if (strcmp(parameters[i].field, why.field) == 0) id = parameters[i].id;
    if (id == ALPHA && g->by_id[ROUGHNESS])
        return musurf_fail(g->host, MUSURF_INVALID, ROUGHNESS, "%.9g makes alpha %s",
                           musurf_number(g, ROUGHNESS), why.text);
    if (id == ALPHA && !g->by_id[ALPHA] && g->by_id[ALPHA_X])
        return musurf_fail(g->host, MUSURF_INVALID, ALPHA_X, "with alpha_y makes alpha %s", why.text);
    return musurf_fail(g->host, MUSURF_INVALID, id, "%s", why.text);
}

musurf_result musurf_parse(const musurf_host *host, const musurf_setting *settings, size_t count,
                           parsed *out) {
    given g = {.host = host};
    *out = (parsed){.definition = mu_definition_default()};
    mu_definition *d = &out->definition;
    musurf_result result = musurf_gather(&g, settings, count);
    if (result == MUSURF_OK) result = musurf_parse_shape(&g, out);
    if (result == MUSURF_OK) result = parse_fresnel(&g, d);
    if (result == MUSURF_OK) result = parse_flakes(&g, out);
    if (result != MUSURF_OK) return result;
    const int sampler = musurf_choice(&g, SAMPLER_CHOICE);
    out->sampler_auto = sampler == MU_SAMPLER_COUNT;
    d->sampler = out->sampler_auto ? MU_SAMPLE_VISIBLE : (mu_sampler)sampler;
    d->smith = (mu_smith)musurf_choice(&g, SMITH);
    if (d->smith == MU_SMITH_SPLINE && (out->sampler_auto || !g.by_id[SAMPLER_CHOICE]))
        d->sampler = MU_SAMPLE_MIXED, out->sampler_auto = 0; /* the paper's own, Appendix B */
    d->masking = (mu_masking_form)musurf_choice(&g, MASKING);
    d->transmission = musurf_number(&g, TRANSMISSION) != 0;
    d->multiple = (mu_scattering)musurf_choice(&g, MULTIPLE_SCATTERING);
    d->compensation_varies = d->multiple == MU_COMPENSATED && out->varying;
    d->compensation_blurs = d->multiple == MU_COMPENSATED && musurf_number(&g, BLURS) != 0;
    return judge(&g, d);
}
