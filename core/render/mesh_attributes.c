/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_attributes.c: numbers that a PLY file gives its vertices, brought to the vertices of the mesh that was made of it.
 *
 * Those were joined and split on the way and have other numbers; what they kept is their place in space and in the
 * texture, as floats, and by that they are found.
 */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/render/mesh_internal.h"

/* Position, texture coordinates (0 where there are none) and the attribute. */
typedef struct mu_entry {
    float key[5], value;
} mu_entry;

static int compare(const void *a, const void *b) {
    const mu_entry *x = a, *y = b;
    for (int i = 0; i < 5; ++i)
        if (x->key[i] != y->key[i]) return x->key[i] < y->key[i] ? -1 : 1;
    return 0;
}

static _Bool agree(const mu_mesh *mesh, const mu_entry *entries, size_t count, const char *name,
                   mu_error *error) {
    for (size_t i = 0; i < count; ++i) {
        if (!isfinite(entries[i].value))
            return mu_fail(error, "%s: a vertex has a \"%s\" of %g; must be finite", mesh->file, name,
                           (double)entries[i].value);
        if (i && !compare(entries + i - 1, entries + i) && entries[i - 1].value != entries[i].value)
            return mu_fail(error,
                           "%s: two vertices at (%g, %g, %g), of the same texture coordinates, have a \"%s\" "
                           "of %g and %g: "
                           "they are one vertex",
                           mesh->file, (double)entries[i].key[0], (double)entries[i].key[1],
                           (double)entries[i].key[2], name, (double)entries[i - 1].value,
                           (double)entries[i].value);
    }
    return 1;
}

static _Bool find_all(const mu_mesh *mesh, const mu_entry *entries, size_t count, float *out,
                      mu_error *error) {
    for (size_t i = 0; i < mesh->vertex_count; ++i) {
        mu_entry wanted = {.value = 0};
        memcpy(wanted.key, mesh->positions + 3 * i, 3 * sizeof(float));
        if (mesh->uvs) memcpy(wanted.key + 3, mesh->uvs + 2 * i, 2 * sizeof(float));
        const mu_entry *found = bsearch(&wanted, entries, count, sizeof *entries, compare);
        if (!found)
            return mu_fail(error, "%s: the vertex at (%g, %g, %g) is not among those that have attributes",
                           mesh->file, (double)wanted.key[0], (double)wanted.key[1], (double)wanted.key[2]);
        out[i] = found->value;
    }
    return 1;
}

float *mu_mesh_attribute(const mu_mesh *mesh, const char *name, mu_error *error) {
    static const char *const uvs[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    const char *const dot = strrchr(mesh->file, '.');
    double *columns[6] = {NULL};
    size_t count = 0;
    if (!dot || strcasecmp(dot, ".ply")) {
        mu_fail(error, "%s: attributes such as \"%s\" are read from PLY files only", mesh->file, name);
        return NULL;
    }
    const char *names[6] = {"x", "y", "z", NULL, NULL, name};
    for (size_t k = 0; mesh->uvs && k < sizeof uvs / sizeof *uvs && !names[3]; ++k)
        if (mu_ply_has(mesh->file, uvs[k][0]) && mu_ply_has(mesh->file, uvs[k][1]))
            names[3] = uvs[k][0], names[4] = uvs[k][1];
    _Bool good = mu_ply_vertices(mesh->file, names, 6, columns, &count, error);
    mu_entry *entries = good ? calloc(count + 1, sizeof *entries) : NULL;
    float *out = good ? calloc((size_t)mesh->vertex_count + 1, sizeof *out) : NULL;
    if (good && (!entries || !out)) good = mu_fail(error, "%s: not enough memory", mesh->file);
    for (size_t i = 0; good && i < count; ++i) {
        for (int k = 0; k < 5; ++k) entries[i].key[k] = columns[k] ? (float)columns[k][i] : 0;
        entries[i].value = (float)columns[5][i];
    }
    if (good) qsort(entries, count, sizeof *entries, compare);
    good = good && agree(mesh, entries, count, name, error) && find_all(mesh, entries, count, out, error);
    for (int k = 0; k < 6; ++k) free(columns[k]);
    free(entries);
    if (good) return out;
    free(out);
    return NULL;
}
