/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* vary_name.c: which material a bare key belongs to, and paths such as $.objects[2].material.alpha. */
#include "core/render/vary_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------ whose key it is */

typedef struct mu_owners { /* of materials in the file, named or inside an object */
    const char *key;
    char path[256]; /* of the one met last */
    size_t all, with_key;
    char list[256]; /* for the message */
} mu_owners;

static void meet(mu_owners *owners, const json_t *material, const char *path) {
    if (!json_is_object(material)) return;
    const _Bool has = json_object_get(material, owners->key) != NULL;
    if (has || !owners->with_key) snprintf(owners->path, sizeof owners->path, "%s", path);
    owners->all += 1;
    owners->with_key += has;
    const size_t length = strlen(owners->list);
    snprintf(owners->list + length, sizeof owners->list - length, "%s%s", length ? ", " : "", path + 2);
}

static void meet_all(mu_owners *owners, const json_t *root) {
    char path[128];
    const char *name;
    json_t *material;
    json_t *const materials = json_object_get(root, "materials");
    const json_t *const objects = json_object_get(root, "objects");
    json_object_foreach(materials, name, material) {
        snprintf(path, sizeof path, "$.materials.%.100s", name);
        meet(owners, material, path);
    }
    for (size_t i = 0; i < json_array_size(objects); ++i) {
        snprintf(path, sizeof path, "$.objects[%zu].material", i);
        meet(owners, json_object_get(json_array_get(objects, i), "material"), path);
    }
}

static char *joined(const char *front, const char *key) {
    const size_t room = strlen(front) + strlen(key) + 2;
    char *const out = malloc(room);
    if (out) snprintf(out, room, "%s.%s", front, key);
    return out;
}

char *mu_vary_path(const char *name, const mu_document *scene, mu_error *error) {
    char *path = NULL;
    if (!strncmp(name, "$.", 2)) {
        path = strdup(name);
    } else if (strpbrk(name, ".[")) {
        path = joined("$.materials", name);
    } else {
        mu_owners owners = {.key = name, .list = ""};
        meet_all(&owners, scene->root);
        if (owners.all != 1 && owners.with_key != 1) {
            mu_fail(error, owners.all ? "%s: whose %s? There are %s; MATERIAL.%s or $.PATH says it"
                                      : "%s: has no material whose %s could vary%.0s%.0s",
                    scene->name, name, owners.list, name);
            return NULL;
        }
        path = joined(owners.path, name);
    }
    if (!path) mu_fail(error, "out of memory");
    return path;
}

/* ------------------------------------------------------------------------------------------- along the path */

typedef struct mu_step {
    char key[128]; /* empty: an index */
    size_t index;
} mu_step;

/* The step at *at, which moves behind it. */
static _Bool next_step(const char **at, mu_step *step) {
    *step = (mu_step){.key = ""};
    if (**at == '.') {
        const size_t length = strcspn(*at + 1, ".[");
        if (!length || length >= sizeof step->key) return 0;
        memcpy(step->key, *at + 1, length);
        *at += 1 + length;
        return 1;
    }
    char *end;
    if (**at != '[' || (*at)[1] < '0' || (*at)[1] > '9') return 0;
    step->index = strtoul(*at + 1, &end, 10);
    *at = end + 1;
    return *end == ']';
}

_Bool mu_vary_set(const char *path, json_t *value, mu_document *scene, mu_error *error) {
    json_t *here = scene->root;
    const char *at = path + 1;
    mu_step step;
    while (1) {
        if (!next_step(&at, &step))
            return mu_fail(error, "%s is no path; steps are .KEY and [INDEX], as in $.objects[0].radius", path);
        const _Bool fits = step.key[0] ? json_is_object(here) : step.index < json_array_size(here);
        json_t *const next = step.key[0] ? json_object_get(here, step.key) : json_array_get(here, step.index);
        if (!fits || (*at && !next))
            return mu_fail(error, "%s: has no %.*s%s%s", scene->name, (int)(at - path), path,
                           *at ? ", for " : "", *at ? path : "");
        if (!*at) break;
        here = next;
    }
    json_t *const copy = json_deep_copy(value);
    const int failed = step.key[0] ? json_object_set_new(here, step.key, copy) : json_array_set_new(here, step.index, copy);
    return !failed || mu_fail(error, "out of memory");
}
