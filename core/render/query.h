/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* query.h: what `eval` and `sample` read alike: a material that can be probed, directions, an id to hand
 * back. */
#ifndef MU_QUERY_H
#define MU_QUERY_H

#include "core/render/document_locate.h"
#include "core/render/json_out.h"
#include "core/render/material.h"
#include "plugin/musurf_probe.h"
#include "plugin/musurf_slopes.h"

typedef struct mu_probed {
    const musurf_probe *probe;
    const musurf_material *compiled;
    const char *type; /* its id */
    const musurf_slopes *slopes; /* may be NULL */
    uint32_t lobes;
} mu_probed;

/* Compiled materials by the JSON that described them: the next query mostly asks about one of the last. */
enum { MU_QUERY_CACHE = 16 };
typedef struct mu_query_cache {
    mu_plugins *plugins;
    struct {
        json_t *json; /* NULL: unused */
        mu_material material;
        size_t used; /* when last */
    } entries[MU_QUERY_CACHE];
    size_t clock;
} mu_query_cache;

_Bool mu_query_cache_make(mu_query_cache *cache, mu_error *error);
void mu_query_cache_free(mu_query_cache *cache);
/* The material at `place`, valid until the next call. */
_Bool mu_query_material(mu_query_cache *cache, const mu_place *place, mu_probed *out, mu_error *error);

/* A vector of any length but zero, made a unit vector. */
_Bool mu_query_direction(const mu_place *place, double out[3], mu_error *error);

/* Writes "id" as it stands in the text. Without one: nothing, or null if `always`. */
void mu_query_put_id(mu_json *json, const char *text, size_t length, _Bool always);

/* Why the plugin's probe did not answer. Always false. */
_Bool mu_query_fail(const mu_place *place, const mu_probed *probed, musurf_result result, mu_error *error);

#endif
