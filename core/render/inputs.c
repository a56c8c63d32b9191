/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* inputs.c: a walk over all texts of a scene. */
#include "core/render/inputs.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/render/output.h"

typedef struct mu_walk {
    const char *const *outputs;
    size_t count;
    mu_error *error;
} mu_walk;

_Bool mu_is_same_file(const char *output, const char *input) {
    struct stat a, b;
    return output && input && !stat(output, &a) && !stat(input, &b) && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

_Bool mu_input_keep(const char *output, const char *input, mu_error *error) {
    return !mu_is_same_file(output, input) || mu_fail(error, "%s: would replace %s, which is read", output, input);
}

static _Bool keep(const mu_walk *walk, const char *file) {
    for (size_t i = 0; i < walk->count; ++i)
        if (mu_is_same_file(walk->outputs[i], file))
            return mu_fail(walk->error, "%s: would replace %s, of which the scene is made", walk->outputs[i],
                           file);
    return 1;
}

static _Bool keep_all(const mu_walk *walk, const mu_document *document, json_t *value, _Bool nested);

/* A material in a file of its own names files relative to that. What cannot be read here is refused where it is read. */
static _Bool keep_named(const mu_walk *walk, const mu_document *document, const char *name, _Bool nested) {
    char *const file = mu_document_beside(document, name);
    if (!file) return mu_fail(walk->error, "%s: not enough memory", document->name);
    struct stat status;
    const _Bool there = !stat(file, &status) && S_ISREG(status.st_mode);
    _Bool good = !there || keep(walk, file);
    mu_document material;
    mu_error ignored = {.text = ""};
    if (good && there && !nested && mu_output_ends_in(file, ".json") &&
        mu_document_read(&material, file, &ignored)) {
        good = keep_all(walk, &material, material.root, 1);
        mu_document_free(&material);
    }
    free(file);
    return good;
}

static _Bool keep_all(const mu_walk *walk, const mu_document *document, json_t *value, _Bool nested) {
    const char *key;
    json_t *member;
    if (json_is_string(value)) return keep_named(walk, document, json_string_value(value), nested);
    for (size_t i = 0; i < json_array_size(value); ++i)
        if (!keep_all(walk, document, json_array_get(value, i), nested)) return 0;
    json_object_foreach(value, key, member) {
        const _Bool of_editors = !strcmp(key, "$schema") || !strcmp(key, "description");
        if (!of_editors && !keep_all(walk, document, member, nested)) return 0;
    }
    return 1;
}

_Bool mu_inputs_keep(const mu_document *scene, const char *const *outputs, size_t count, mu_error *error) {
    const mu_walk walk = {outputs, count, error};
    return keep(&walk, scene->name) && keep_all(&walk, scene, scene->root, 0);
}
