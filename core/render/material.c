/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* material.c: one material from its JSON object: names its type, reads its settings, compiles it. */
#include "core/render/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/render/material_file.h"
#include "core/render/blend.h"
#include "core/render/formula_check.h"
#include "core/render/normal_turn.h"
#include "core/render/varying.h"

/* What the plugin says while compiling goes to the place of the parameter it speaks of. */
typedef struct listener {
    const musurf_material_type *type;
    const mu_place *place;
    mu_error *error;
    uint32_t param; /* that the last error was about */
} listener;

static void on_message(void *context, musurf_severity severity, uint32_t param, const char *text) {
    listener *l = context;
    const musurf_param *p = mu_type_find_id(l->type, param);
    if (severity == MUSURF_ERROR) l->param = param;
    mu_error warning = {.text = ""};
    mu_error *out = severity == MUSURF_ERROR ? l->error : &warning;
    mu_settings_fail(l->place, p ? p->name : "", out, text ? text : "");
    if (severity == MUSURF_WARNING) mu_warn(l->error, "%s", warning.text);
}

/* refused, or NULL: the parameter that may not vary. */
static _Bool compile(mu_material *material, const mu_settings *settings, const mu_place *place, uint32_t *refused,
                     mu_error *error) {
    listener l = {material->type, place, error, MUSURF_NO_PARAM};
    const musurf_host host = {
        .size = sizeof host, .abi_minor = MUSURF_ABI_MINOR, .context = &l, .message = on_message};
    const musurf_result result =
        material->type->compile(&host, settings->items, settings->count, &material->compiled);
    if (result == MUSURF_OK && material->compiled) return 1;
    material->compiled = NULL;
    if (result == MUSURF_UNSUPPORTED && refused) *refused = l.param;
    if (result == MUSURF_NO_MEMORY) return mu_place_fail(place, error, "not enough memory for this material");
    return mu_place_fail(place, error, "%s refused this material (result %d) without saying why",
                         material->type->id, (int)result);
}

/* The renderer aligns a thread's scratch to 64 bytes and sizes it by these numbers. */
static _Bool describe(mu_material *material, const mu_place *place, mu_error *error) {
    material->plan = (musurf_plan){.size = sizeof material->plan};
    material->type->describe(material->compiled, &material->plan);
    const uint32_t alignment = material->plan.closure_alignment;
    if (alignment > 64 || (alignment & (alignment - 1)) != 0)
        return mu_place_fail(place, error,
                             "%s asks for closures aligned to %u bytes; a power of two up to 64 is possible",
                             material->type->id, alignment);
    if (material->plan.closure_bytes > 1u << 20)
        return mu_place_fail(place, error, "%s asks for closures of %u bytes; at most 1 MiB is possible",
                             material->type->id, material->plan.closure_bytes);
    return 1;
}

static const musurf_param *find_varying_transform(const musurf_material_type *type) {
    const musurf_param *p = mu_type_find(type, "transform");
    return p && p->kind == MUSURF_MATRIX && (p->flags & MUSURF_MAY_VARY) ? p : NULL;
}

/* A Jacobian or a tension makes "transform" vary: the renderer keeps the constant part and pushes its product through
 * slots 0 to 3. */
static _Bool vary_transform(mu_material *material, mu_settings *settings, const mu_place *place,
                            mu_error *error) {
    const musurf_param *p = find_varying_transform(material->type);
    if (!p) {
        const mu_place member = mu_place_member(place, "jacobian");
        return mu_place_fail_key(&member, error, "%s has no transform that may vary", material->type->id);
    }
    musurf_setting *setting = mu_settings_find(settings, p);
    if (setting) {
        /* Once as it stands: the plugin judges the constant part (is it singular?), which it will not see
         * again. */
        if (!compile(material, settings, place, NULL, error)) return 0;
        material->type->release(material->compiled);
        material->compiled = NULL;
        for (int i = 0; i < 4; i++)
            if (fabs(setting->values[i]) > 1e18) /* squares of what shading multiplies must be floats */
                return mu_settings_fail(place, "transform", error,
                                        "with a jacobian or a tension, entries must be within 1e18");
    } else {
        setting = mu_settings_add(settings, p);
    }
    setting->source = MUSURF_SLOT;
    setting->slot = MU_SLOT_TRANSFORM;
    setting->values = NULL;
    return 1;
}

/* Whether a normal map could widen its lobe by an M that varies. */
static _Bool can_widen(const musurf_material_type *type) {
    return find_varying_transform(type) && type->extension && type->extension(MUSURF_MAP_ID) && type->extension(MUSURF_SLOPES_ID);
}

static void read_transform(mu_material *material, const mu_settings *settings) {
    const musurf_param *p = mu_type_find(material->type, "transform");
    if (!p || p->kind != MUSURF_MATRIX) return;
    const musurf_setting *setting = mu_settings_find(settings, p);
    for (int i = 0; i < 4; i++) material->transform[i] = (float)(setting && setting->values ? setting->values : p->initial)[i];
}

static uint64_t digest_picture(uint64_t digest, const mu_mipmap *picture) {
    const size_t count =
        picture->levels ? (size_t)picture->level[0].width * (size_t)picture->level[0].height * (size_t)picture->channels : 0;
    for (size_t k = 0; k < count; k++) {
        uint32_t word;
        memcpy(&word, picture->texels + k, sizeof word);
        digest = (digest ^ word) * 0x100000001b3u;
    }
    return digest;
}

/* FNV-1a, eight bytes at a time. */
static uint64_t digest_of(const mu_settings *settings) {
    uint64_t digest = 0xcbf29ce484222325u;
    for (size_t i = 0; i < settings->count; i++)
        for (size_t k = 0; k < settings->items[i].count; k++) {
            uint64_t word;
            memcpy(&word, settings->items[i].values + k, sizeof word);
            digest = (digest ^ word) * 0x100000001b3u;
        }
    for (size_t i = 0; i < settings->source_count; i++)
        digest = digest_picture(digest, &settings->sources[i].picture);
    for (int i = 0; i < settings->blended_count; i++) digest = digest_picture(digest, &settings->blended[i].picture);
    return digest;
}

/* The plugin's footprint: the parameter of that kind that may vary. */
static const musurf_param *find_footprint(const musurf_material_type *type) {
    for (uint32_t i = 0; i < type->param_count; i++) {
        const musurf_param *p = mu_type_param(type, i);
        if (p->kind == MUSURF_FOOTPRINT && (p->flags & MUSURF_MAY_VARY)) return p;
    }
    return NULL;
}

/* Compiled once as it stands; what asks for footprints then is compiled again, with slots for them. */
static _Bool compile_once(mu_material *material, mu_settings *settings, const mu_place *place, uint32_t *refused,
                          mu_error *error) {
    const musurf_param *p = find_footprint(material->type);
    material->one_footprint = p && mu_settings_find(settings, p);
    if (!compile(material, settings, place, refused, error) || !describe(material, place, error)) return 0;
    if (!p || material->one_footprint || !(material->plan.needs & MUSURF_NEEDS_FOOTPRINT)) return 1;
    musurf_setting *setting = mu_settings_add(settings, p);
    setting->source = MUSURF_SLOT;
    setting->slot = MU_SLOT_FOOTPRINT;
    setting->values = NULL;
    material->type->release(material->compiled);
    material->compiled = NULL;
    material->footprints = 1;
    return compile(material, settings, place, NULL, error) && describe(material, place, error);
}

/* All that its materials ask for together. */
static void join_plans(musurf_plan *plan, const musurf_plan *other) {
    if (other->closure_bytes > plan->closure_bytes) plan->closure_bytes = other->closure_bytes;
    if (other->closure_alignment > plan->closure_alignment) plan->closure_alignment = other->closure_alignment;
    plan->lobes |= other->lobes, plan->needs |= other->needs;
    plan->table_bytes += other->table_bytes, plan->material_bytes += other->material_bytes;
}

static void set_values(mu_settings *settings, const mu_blend *blend, int number) {
    for (int i = 0; i < blend->axes; i++)
        settings->values[mu_settings_find(settings, blend->axis[i].source.param) - settings->items][0] =
            mu_blend_value(blend, i, number);
}

/* At each of the values between which it is blended. */
static _Bool compile_blend(mu_material *material, mu_settings *settings, const mu_place *place, uint32_t *refused,
                           mu_error *error) {
    mu_blend *blend = material->blend;
    set_values(settings, blend, 0);
    if (!compile_once(material, settings, place, refused, error)) return 0;
    blend->compiled[0] = material->compiled;
    const musurf_plan first = material->plan;
    musurf_plan all = first;
    for (int i = 1; i < blend->count; i++) {
        set_values(settings, blend, i);
        const _Bool good = compile(material, settings, place, NULL, error) && describe(material, place, error);
        blend->compiled[i] = material->compiled;
        join_plans(&all, &material->plan);
        material->compiled = blend->compiled[0];
        if (!good) return 0;
    }
    material->plan = all;
    return 1;
}

static _Bool compile_all(mu_material *material, mu_settings *settings, const mu_place *place, uint32_t *refused,
                         mu_error *error) {
    if (settings->blended_count && !(material->blend = mu_blend_make(settings, place, error))) return 0;
    return material->blend ? compile_blend(material, settings, place, refused, error)
                           : compile_once(material, settings, place, refused, error);
}

/* What the plugin does not take in a slot is blended instead. */
static _Bool compile_somehow(mu_material *material, mu_settings *settings, const mu_place *place, mu_error *error) {
    for (;;) {
        uint32_t refused = MUSURF_NO_PARAM;
        mu_error first = *error;
        if (compile_all(material, settings, place, &refused, &first)) return 1;
        if (refused != MUSURF_NO_PARAM && material->blend) {
            mu_blend_undo(material->blend, settings);
            material->blend = NULL;
        }
        if (refused == MUSURF_NO_PARAM || !mu_settings_blend(settings, refused)) {
            *error = first;
            return 0;
        }
    }
}

/* What draws directions is the renderer's to choose where the material does not say: it asks the plugin to measure. */
static void measure_sampler(const musurf_material_type *type, mu_settings *settings) {
    const musurf_param *p = mu_type_find(type, "sampler");
    if (!p || p->kind != MUSURF_CHOICE || mu_settings_find(settings, p)) return;
    for (const char *const *choice = p->choices; choice && *choice; choice++)
        if (strcmp(*choice, "auto") == 0) mu_settings_add(settings, p)->text = *choice;
}

static _Bool read_object(mu_material *material, mu_plugins *plugins, const mu_place *place, _Bool deforming,
                         _Bool to_render, mu_error *error) {
    static const char *const here[] = {"material", "jacobian", "normal_map", NULL},
                      *const in_file[] = {"material", "jacobian", "normal_map", "$schema", "description", NULL};
    const char *const *reserved = place->parent ? here : in_file;
    *material = (mu_material){.transform = {1, 0, 0, 1}};
    if (!json_is_object(place->value)) return mu_place_only(place, reserved, error);

    const mu_place id = mu_place_member(place, "material"), jacobian = mu_place_member(place, "jacobian"),
                   normal_map = mu_place_member(place, "normal_map");
    const char *name;
    if (!mu_place_string(&id, &name, error)) return 0;
    mu_error why = {.text = ""};
    material->type = mu_plugins_type(plugins, name, &why);
    if (!material->type) return mu_place_fail(&id, error, "%s", why.text);

    mu_settings settings;
    if (!mu_settings_read(&settings, material->type, place, reserved, error)) return 0;
    if (to_render) measure_sampler(material->type, &settings);
    read_transform(material, &settings);
    material->digest = digest_of(&settings);
    _Bool good = 1;
    material->tension = deforming && find_varying_transform(material->type);
    if (jacobian.value)
        good = mu_jacobian_read(&material->jacobian, &jacobian, error) &&
               mu_jacobian_check(&material->jacobian, &jacobian, error);
    material->digest = digest_picture(material->digest, &material->jacobian.displacement.picture);
    if (normal_map.value) good = good && mu_normal_map_read(&material->normal_map, &normal_map, error);
    if (material->normal_map) material->digest = digest_picture(material->digest, &material->normal_map->moments);
    const _Bool widens = material->normal_map && material->normal_map->placement.filtered && can_widen(material->type);
    /* what composes M of sources puts the rest before it, too */
    const _Bool composes =
        settings.source_count && material->type->extension && material->type->extension(MUSURF_MAP_ID);
    if ((jacobian.value || material->tension || widens) && !composes)
        good = good && vary_transform(material, &settings, place, error);
    good = good && compile_somehow(material, &settings, place, error);
    if (good && settings.source_count)
        good = (material->varying = mu_varying_make(&settings, material->compiled, place, error)) != NULL;
    if (good && material->normal_map) mu_normal_map_bind(material->normal_map, material);
    mu_settings_free(&settings);
    if (!good) mu_material_free(material);
    return good;
}

static _Bool read_material(mu_material *material, mu_plugins *plugins, const mu_place *place, _Bool deforming,
                           _Bool to_render, mu_error *error) {
    if (!mu_names_material_file(place))
        return read_object(material, plugins, place, deforming, to_render, error);
    mu_document document;
    if (!mu_material_file_read(&document, place, error)) return 0;
    const mu_place root = mu_place_root(&document);
    const _Bool good = read_object(material, plugins, &root, deforming, to_render, error);
    material->digest ^= mu_material_file_digest(&document);
    mu_document_free(&document);
    return good;
}

_Bool mu_material_read(mu_material *material, mu_plugins *plugins, const mu_place *place, mu_error *error) {
    return read_material(material, plugins, place, 0, 0, error);
}

_Bool mu_material_read_to_render(mu_material *material, mu_plugins *plugins, const mu_place *place,
                                 _Bool deforming, mu_error *error) {
    return read_material(material, plugins, place, deforming, 1, error);
}

mu_source *mu_material_source(const mu_material *material, size_t index) {
    const size_t varying = material->varying ? material->varying->count : 0,
                 blended = material->blend ? (size_t)material->blend->axes : 0;
    if (index < varying) return material->varying->sources + index;
    return index < varying + blended ? &material->blend->axis[index - varying].source : NULL;
}

void mu_material_free(mu_material *material) {
    if (material->compiled) material->type->release(material->compiled);
    if (material->blend) material->blend->compiled[0] = NULL;
    mu_blend_free(material->blend, material->type);
    mu_varying_free(material->varying);
    mu_normal_map_free(material->normal_map);
    mu_jacobian_free(&material->jacobian);
    *material = (mu_material){0};
}
