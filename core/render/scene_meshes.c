/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_meshes.c: "meshes", a table of files. A file is read when an object first names it, and then only
 * once. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/render/mesh.h"
#include "core/render/scene_read.h"

/* The mesh as it is, or deformed from the one at rest in the file at `rest`. */
static _Bool read_file(const mu_reader *reader, const mu_place *place, const char *path, const mu_place *rest,
                       mu_mesh *mesh, mu_mesh_notes *notes) {
    mu_error reason = {.text = ""};
    char found[768] = "";
    if (!rest->value)
        return mu_mesh_read(mesh, path, notes, &reason) ||
               mu_place_fail(place, reader->error, "%s", reason.text);
    char *rest_path = mu_scene_path(reader, json_string_value(rest->value));
    if (!rest_path) return mu_fail(reader->error, "not enough memory for the scene");
    const _Bool good = mu_mesh_read_deformed(mesh, rest_path, path, notes, found, sizeof found, &reason);
    free(rest_path);
    if (*found) mu_scene_warn(reader, rest, found);
    return good || mu_place_fail(rest, reader->error, "%s", reason.text);
}

static _Bool load(mu_reader *reader, const mu_place *definition, const char *name, const mu_place *rest,
                  uint32_t *out) {
    const mu_place place = mu_place_member(definition, "file");
    mu_scene *scene = reader->scene;
    mu_mesh mesh;
    mu_mesh_notes notes;
    char *path = mu_scene_path(reader, json_string_value(place.value));
    if (!path) return mu_fail(reader->error, "not enough memory for the scene");
    const _Bool ok = read_file(reader, &place, path, rest, &mesh, &notes);
    free(path);
    if (!ok) return 0;
    if (notes.dropped) {
        char text[96];
        snprintf(text, sizeof text, "%u triangles without area were left out", (unsigned)notes.dropped);
        mu_scene_warn(reader, &place, text);
    }
    if (notes.uvs_lost)
        mu_scene_warn(reader, &place, "only some of its parts have texture coordinates; they are left out");
    mesh.name = strdup(name);
    if (!mesh.name ||
        !mu_append((void **)&scene->meshes, &scene->mesh_count, sizeof *scene->meshes, reader->error)) {
        mu_mesh_free(&mesh);
        return mu_fail(reader->error, "not enough memory for the scene");
    }
    *out = scene->mesh_count - 1;
    scene->meshes[*out] = mesh;
    return 1;
}

/* Whether a mesh read before is this one, from the same mesh at rest. */
static _Bool is_same(const mu_reader *reader, const mu_mesh *mesh, const char *name, const mu_place *rest) {
    if (strcmp(mesh->name, name) || !mesh->rest != !rest->value) return 0;
    if (!mesh->rest) return 1;
    char *path = mu_scene_path(reader, json_string_value(rest->value));
    const _Bool same = path && !strcmp(path, mesh->rest);
    free(path);
    return same;
}

_Bool mu_read_mesh(mu_reader *reader, const mu_place *place, const mu_place *tension, uint32_t *out) {
    const char *name, *file;
    const mu_place rest = mu_place_member(tension, "rest");
    if (!mu_place_string(place, &name, reader->error)) return 0;
    if (tension->value && (!mu_place_only(tension, mu_scene_keys(MU_KEYS_TENSION), reader->error) ||
                           !mu_place_string(&rest, &file, reader->error)))
        return 0;
    for (uint32_t i = 0; i < reader->scene->mesh_count; ++i)
        if (is_same(reader, &reader->scene->meshes[i], name, &rest)) {
            *out = i;
            return 1;
        }
    const mu_place definition = mu_place_member(&reader->meshes, name);
    if (!definition.value) return mu_fail_unknown(place, reader->meshes.value, "mesh", reader->error);
    return load(reader, &definition, name, &rest, out);
}

_Bool mu_check_meshes(mu_reader *reader) {
    const char *name;
    json_t *value;
    json_object_foreach(reader->meshes.value, name, value) {
        const mu_place definition = mu_place_member(&reader->meshes, name);
        const char *file;
        if (!mu_place_only(&definition, mu_scene_keys(MU_KEYS_MESH), reader->error)) return 0;
        const mu_place place = mu_place_member(&definition, "file");
        if (!mu_place_string(&place, &file, reader->error)) return 0;
        char *path = mu_scene_path(reader, file);
        if (!path) return mu_fail(reader->error, "not enough memory for the scene");
        struct stat status;
        const _Bool there = !access(path, R_OK) && !stat(path, &status);
        const _Bool good = there && S_ISREG(status.st_mode);
        if (!good)
            mu_place_fail(&place, reader->error, "%.500s: %s", path,
                          there ? "is not a regular file" : strerror(errno));
        free(path);
        if (!good) return 0;
    }
    return 1;
}

static _Bool has_direction(const mu_scene *scene, uint32_t material) {
    return (scene->materials[material].material.plan.needs & MUSURF_NEEDS_TANGENT) != 0;
}

_Bool mu_make_scene_tangents(mu_reader *reader) {
    mu_scene *scene = reader->scene;
    for (uint32_t i = 0; i < scene->object_count; ++i) {
        const mu_object *object = &scene->objects[i];
        if (object->shape != MU_MESH) continue;
        if (!has_direction(scene, object->material) &&
            !(object->grid.lines && has_direction(scene, object->grid.material)))
            continue;
        if (!mu_mesh_make_tangents(&scene->meshes[object->mesh], reader->error)) return 0;
    }
    return 1;
}
