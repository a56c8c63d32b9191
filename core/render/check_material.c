/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_material.c: see check_material.h. */
#include "core/render/check_material.h"

#include <stdlib.h>
#include <string.h>

#include "core/render/material_settings.h"
#include "core/render/plugin.h"

/* What the parameters of these names say; another type's materials may have none of them. */
static mu_form form_of(const json_t *material) {
    const json_t *masking = json_object_get(material, "masking");
    const char *name = json_is_string(masking) ? json_string_value(masking) : "";
    return !strcmp(name, "separable")              ? MU_FORM_SEPARABLE
           : !strcmp(name, "direction_correlated") ? MU_FORM_DIRECTION
                                                   : MU_FORM_HEIGHT;
}

static mu_bounces bounces_of(const json_t *material) {
    const json_t *multiple = json_object_get(material, "multiple_scattering");
    const char *name = json_is_string(multiple) ? json_string_value(multiple) : "none";
    return !strcmp(name, "none") ? MU_ONCE : !strcmp(name, "random_walk") ? MU_WALKS : MU_SMOOTH_LOBE;
}

/* Is there a table among its parameters, whose cells meet in jumps? */
static _Bool has_grid(const musurf_material_type *type, const json_t *material) {
    for (uint32_t i = 0; i < type->param_count; i++) {
        const musurf_param *p = mu_type_param(type, i);
        if (p->kind == MUSURF_GRID && json_object_get(material, p->name)) return 1;
    }
    return 0;
}

static double eta_of(const mu_material *material, const json_t *json) {
    const uint32_t refracts = MUSURF_GLOSSY_TRANSMISSION | MUSURF_DELTA_TRANSMISSION;
    if (!(material->plan.lobes & refracts)) return 0;
    const musurf_param *p = mu_type_find(material->type, "fresnel.dielectric");
    const json_t *index = json_object_get(json_object_get(json, "fresnel"), "dielectric");
    return json_is_number(index) ? json_number_value(index) : p ? p->initial[0] : 0;
}

static _Bool probe(mu_check_material *out, const mu_place *place, musurf_precision precision,
                   mu_error *error) {
    const musurf_material_type *type = out->material.type;
    const musurf_probe *probe = type->extension ? type->extension(MUSURF_PROBE_ID) : NULL;
    const _Bool slots = out->material.plan.needs & MUSURF_NEEDS_SLOTS && !out->material.footprints;
    if (out->material.one_footprint)
        return mu_place_fail(place, error,
                             "shows the flakes of one footprint: its D is not a density. Leave it out");
    if (out->material.jacobian.map != MU_JACOBIAN_NONE || out->material.varying || out->material.blend || out->material.normal_map || slots)
        return mu_place_fail(place, error, "varies over the surface");
    if (!probe || probe->size < sizeof *probe || !probe->evaluate || !probe->sample)
        return mu_place_fail(place, error, "%s does not offer %s", type->id, MUSURF_PROBE_ID);
    out->subject = (mu_subject){.type = type,
                                .material = out->material.compiled,
                                .probe = probe,
                                .precision = precision,
                                .json = out->json,
                                .form = form_of(place->value),
                                .bounces = bounces_of(place->value),
                                .jumps = has_grid(type, place->value),
                                .eta = eta_of(&out->material, place->value)};
    const double up[3] = {0, 0, 1};
    musurf_probe_values values;
    memset(&values, 0, sizeof values);
    if (probe->evaluate(out->material.compiled, precision, up, up, up, &values) != MUSURF_OK)
        return mu_place_fail(place, error, "the probe of %s does not answer", type->id);
    if (values.delta) return mu_place_fail(place, error, "is a mirror and has no density");
    if (!mu_subject_find_sampler(&out->subject))
        return mu_place_fail(place, error, "the probe of %s does not sample", type->id);
    if (out->subject.bounces != MU_ONCE) out->subject.sampler = MUSURF_SAMPLE_AS_SET;
    if (out->subject.bounces == MU_SMOOTH_LOBE && out->subject.eta > 0)
        out->subject.jumps = 1; /* drawn by the cells of a table, on a side where facets may send nothing */
    return 1;
}

_Bool mu_check_material_read(mu_check_material *out, mu_plugins *plugins, const mu_place *place,
                             musurf_precision precision, mu_error *error) {
    *out = (mu_check_material){.json = NULL};
    if (!mu_material_read(&out->material, plugins, place, error)) return 0;
    out->json = json_dumps(place->value, JSON_REAL_PRECISION(17));
    if (out->json ? probe(out, place, precision, error) : mu_fail(error, "not enough memory")) return 1;
    mu_check_material_free(out);
    return 0;
}

_Bool mu_check_material_parse(mu_check_material *out, mu_plugins *plugins, const char *json,
                              musurf_precision precision, mu_error *error) {
    mu_document document;
    if (!mu_document_parse(&document, "random material", json, strlen(json), 1, error)) return 0;
    const mu_place root = mu_place_root(&document);
    const _Bool good = mu_check_material_read(out, plugins, &root, precision, error);
    mu_document_free(&document);
    return good;
}

void mu_check_material_free(mu_check_material *material) {
    mu_material_free(&material->material);
    free(material->json);
    *material = (mu_check_material){.json = NULL};
}
