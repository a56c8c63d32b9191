/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* query.c: reads the parts of a query; directions in the local frame, +z the macrosurface normal. */
#include "core/render/query.h"

#include <math.h>
#include <string.h>

#include "core/render/material_settings.h"

_Bool mu_query_cache_make(mu_query_cache *cache, mu_error *error) {
    *cache = (mu_query_cache){.plugins = mu_plugins_new()};
    return cache->plugins ? 1 : mu_fail(error, "not enough memory");
}

static void forget(mu_query_cache *cache, size_t i) {
    if (!cache->entries[i].json) return;
    mu_material_free(&cache->entries[i].material);
    json_decref(cache->entries[i].json);
    cache->entries[i].json = NULL;
}

void mu_query_cache_free(mu_query_cache *cache) {
    for (size_t i = 0; i < MU_QUERY_CACHE; i++) forget(cache, i);
    mu_plugins_free(cache->plugins);
    *cache = (mu_query_cache){0};
}

static _Bool find_probe(const mu_material *material, const mu_place *place, mu_probed *out, mu_error *error) {
    const mu_source *source = mu_material_source(material, 0);
    if (source)
        return mu_settings_fail(place, source->param->name, error,
                                "makes the material vary over the surface; here one point is looked at, so write its value");
    if (material->jacobian.map != MU_JACOBIAN_NONE) {
        const mu_place jacobian = mu_place_member(place, "jacobian");
        return mu_place_fail_key(&jacobian, error,
                                 "makes the material vary over the surface; here one point is looked at, so "
                                 "give its M as \"transform\"");
    }
    if (material->normal_map) {
        const mu_place normal_map = mu_place_member(place, "normal_map");
        return mu_place_fail_key(&normal_map, error, "makes the frame vary over the surface; here one point is looked at, in its own frame");
    }
    const musurf_probe *probe = material->type->extension(MUSURF_PROBE_ID);
    if (!probe || probe->size < sizeof *probe || !probe->evaluate || !probe->sample) {
        const mu_place id = mu_place_member(place, "material");
        return mu_place_fail(&id, error, "%s does not offer %s, which is needed to look into it",
                             material->type->id, MUSURF_PROBE_ID);
    }
    *out = (mu_probed){probe, material->compiled, material->type->id, material->type->extension(MUSURF_SLOPES_ID),
                       material->plan.lobes};
    return 1;
}

_Bool mu_query_material(mu_query_cache *cache, const mu_place *place, mu_probed *out, mu_error *error) {
    size_t oldest = 0;
    for (size_t i = 0; i < MU_QUERY_CACHE; i++) {
        if (cache->entries[i].json && place->value && json_equal(cache->entries[i].json, place->value)) {
            cache->entries[i].used = ++cache->clock;
            return find_probe(&cache->entries[i].material, place, out, error);
        }
        if (cache->entries[i].used < cache->entries[oldest].used) oldest = i;
    }
    if (!place->value)
        return mu_place_fail(place, error,
                             "is missing; an object such as {\"material\": \"musurf.microfacet\"} is needed");
    mu_material material;
    if (!mu_material_read(&material, cache->plugins, place, error)) return 0;
    forget(cache, oldest);
    cache->entries[oldest].json = json_incref(place->value);
    cache->entries[oldest].material = material;
    cache->entries[oldest].used = ++cache->clock;
    return find_probe(&cache->entries[oldest].material, place, out, error);
}

_Bool mu_query_direction(const mu_place *place, double out[3], mu_error *error) {
    double v[3];
    if (!mu_place_numbers(place, 3, -INFINITY, INFINITY, v, error)) return 0;
    const double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (largest == 0) return mu_place_fail(place, error, "is the zero vector; a direction is needed");
    /* A power of two brings it near 1 without rounding, so that squares neither overflow nor vanish. */
    int exponent;
    frexp(largest, &exponent);
    for (int i = 0; i < 3; i++) v[i] = ldexp(v[i], -exponent);
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) out[i] = v[i] / length;
    return 1;
}

void mu_query_put_id(mu_json *json, const char *text, size_t length, _Bool always) {
    mu_span id;
    if (mu_locate_member(text, length, "id", &id)) {
        /* The rest of the line may be no JSON; what is handed back must be. */
        json_t *value =
            json_loadb(text + id.begin, id.end - id.begin, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, NULL);
        json_decref(value);
        if (value) {
            const size_t begin = json->length;
            mu_json_raw(json, "id", text + id.begin, id.end - id.begin);
            for (size_t i = begin; i < json->length;
                 i++) /* a line break between tokens is as good as a space */
                if (json->text[i] == '\n' || json->text[i] == '\r') json->text[i] = ' ';
            return;
        }
    }
    if (always) mu_json_raw(json, "id", "null", 4);
}

_Bool mu_query_fail(const mu_place *place, const mu_probed *probed, musurf_result result, mu_error *error) {
    const char *const why = result == MUSURF_NO_MEMORY     ? "ran out of memory"
                            : result == MUSURF_UNSUPPORTED ? "does not support looking into this material"
                            : result == MUSURF_INVALID     ? "refused these directions"
                                                           : "failed";
    return mu_place_fail(place, error, "%s %s", probed->type, why);
}
