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
#include "core/render/sequence.h"

/* The file that a place names; of a numbered sequence the one of the moment's frame, or the first. To be freed. */
static char *mesh_path(mu_reader *reader, const mu_place *place) {
    char *path = mu_scene_path(reader, json_string_value(place->value)), *one = NULL;
    mu_error reason = {.text = ""};
    long long *frames = NULL, frame = reader->moment.frame;
    size_t count;
    if (!path) mu_fail(reader->error, "not enough memory for the scene");
    if (!path || !mu_sequence_is(path)) return path;
    reader->has_sequence = 1;
    if (frame == MU_NO_FRAME && mu_sequence_list(path, &frames, &count, &reason)) frame = frames[0];
    free(frames);
    if (frame != MU_NO_FRAME && !(one = mu_sequence_file(path, frame)))
        mu_fail(reader->error, "not enough memory for the scene");
    else if (!one)
        mu_place_fail(place, reader->error, "%s", reason.text);
    free(path);
    return one;
}

/* What an object asks of a mesh besides its name. */
typedef struct mu_mesh_use {
    const mu_place *pose, *tension; /* their values are NULL where it asks nothing */
    mu_place rest;
    _Bool bind;
    char *text, *path; /* all that tells uses apart; the file at rest */
} mu_mesh_use;

static void free_use(mu_mesh_use *use) {
    free(use->text);
    free(use->path);
}

/* "tension": {"rest": file} or "bind". */
static _Bool read_tension(mu_reader *reader, mu_mesh_use *use) {
    static const char *const words[] = {"bind", NULL};
    const char *file;
    size_t choice;
    use->rest = mu_place_member(use->tension, "rest");
    if (!use->tension->value) return 1;
    if (json_is_string(use->tension->value)) {
        use->bind = mu_place_choice(use->tension, words, &choice, reader->error);
        return use->bind && (use->pose->value ||
                             mu_place_fail(use->tension, reader->error,
                                           "is of the shape that a \"pose\" deforms, but there is none"));
    }
    if (!mu_place_only(use->tension, mu_scene_keys(MU_KEYS_TENSION), reader->error) ||
        !mu_place_string(&use->rest, &file, reader->error))
        return 0;
    use->path = mesh_path(reader, &use->rest);
    return use->path != NULL;
}

static _Bool read_use(mu_reader *reader, mu_mesh_use *use) {
    if (!read_tension(reader, use)) return 0;
    if (!use->pose->value && !use->tension->value) return 1;
    json_t *all = json_object();
    if (use->pose->value) json_object_set(all, "pose", use->pose->value);
    if (use->tension->value)
        json_object_set_new(all, "rest", use->bind ? json_true() : json_string(use->path));
    use->text = json_dumps(all, JSON_COMPACT | JSON_SORT_KEYS);
    json_decref(all);
    return use->text || mu_fail(reader->error, "not enough memory for the scene");
}

/* The mesh as it is, in a pose, or deformed. */
static _Bool read_file(mu_reader *reader, const mu_place *place, const char *path, const mu_mesh_use *use,
                       mu_mesh *mesh, mu_mesh_notes *notes) {
    const mu_place *asking = use->rest.value ? &use->rest : use->pose->value ? use->pose : use->tension;
    mu_error reason = {.text = ""};
    char found[768] = "";
    mu_pose pose;
    if (!use->text)
        return mu_mesh_read(mesh, path, notes, &reason) ||
               mu_place_fail(place, reader->error, "%s", reason.text);
    if (use->pose->value && !mu_pose_read(use->pose, &pose, reader->error)) return 0;
    if (use->pose->value && pose.animation) {
        reader->has_animation = 1;
        if (reader->moment.pose_time >= 0) pose.time = reader->moment.pose_time;
    }
    const mu_mesh_source source = {.file = path,
                                   .pose = use->pose->value ? &pose : NULL,
                                   .tension = use->tension->value != NULL,
                                   .rest = use->path};
    const _Bool good = mu_mesh_read_deformed(mesh, &source, notes, found, sizeof found, &reason);
    if (use->pose->value) mu_pose_free(&pose);
    if (*found) mu_scene_warn(reader, asking, found);
    return good || mu_place_fail(asking, reader->error, "%s", reason.text);
}

static _Bool load(mu_reader *reader, const mu_place *definition, const char *name, mu_mesh_use *use,
                  uint32_t *out) {
    const mu_place place = mu_place_member(definition, "file");
    mu_scene *scene = reader->scene;
    mu_mesh mesh;
    mu_mesh_notes notes;
    char *path = mesh_path(reader, &place);
    if (!path) return 0;
    const _Bool ok = read_file(reader, &place, path, use, &mesh, &notes);
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
    mesh.posed = use->pose->value != NULL;
    mesh.use = use->text;
    use->text = NULL;
    if (!mesh.name ||
        !mu_append((void **)&scene->meshes, &scene->mesh_count, sizeof *scene->meshes, reader->error)) {
        mu_mesh_free(&mesh);
        return mu_fail(reader->error, "not enough memory for the scene");
    }
    *out = scene->mesh_count - 1;
    scene->meshes[*out] = mesh;
    return 1;
}

/* Whether a mesh read before is this one. */
static _Bool is_same(const mu_mesh *mesh, const char *name, const mu_mesh_use *use) {
    return !strcmp(mesh->name, name) && !mesh->use == !use->text &&
           (!mesh->use || !strcmp(mesh->use, use->text));
}

static _Bool find_or_load(mu_reader *reader, const mu_place *place, const char *name, mu_mesh_use *use,
                          uint32_t *out) {
    for (uint32_t i = 0; i < reader->scene->mesh_count; ++i)
        if (is_same(&reader->scene->meshes[i], name, use)) return *out = i, 1;
    const mu_place definition = mu_place_member(&reader->meshes, name);
    if (!definition.value) return mu_fail_unknown(place, reader->meshes.value, "mesh", reader->error);
    return load(reader, &definition, name, use, out);
}

_Bool mu_read_mesh(mu_reader *reader, const mu_place *place, const mu_place *pose, const mu_place *tension,
                   uint32_t *out) {
    const char *name;
    mu_mesh_use use = {.pose = pose, .tension = tension};
    if (!mu_place_string(place, &name, reader->error)) return 0;
    const _Bool good = read_use(reader, &use) && find_or_load(reader, place, name, &use, out);
    free_use(&use);
    return good;
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
        char *path = mesh_path(reader, &place);
        if (!path) return 0;
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
    const mu_material *of = &scene->materials[material].material;
    return of->plan.needs & MUSURF_NEEDS_TANGENT || of->normal_map;
}

/* Once for a mesh: mesh_tangents.c has to choose. */
static void warn_of_choice(const mu_reader *reader, uint32_t index, const mu_mesh *mesh) {
    const mu_place objects = mu_place_member(&reader->root, "objects"), place = mu_place_element(&objects, index);
    char text[192];
    if (mesh->uvs || mesh->tangents) return;
    snprintf(text, sizeof text,
             "its material has a direction, and the mesh \"%.60s\" no texture coordinates to take it from; it is as if "
             "brushed along the mesh's x axis",
             mesh->name);
    mu_scene_warn(reader, &place, text);
}

_Bool mu_make_scene_tangents(mu_reader *reader) {
    mu_scene *scene = reader->scene;
    for (uint32_t i = 0; i < scene->object_count; ++i) {
        const mu_object *object = &scene->objects[i];
        if (object->shape != MU_MESH) continue;
        if (!has_direction(scene, object->material) &&
            !(object->grid.lines && has_direction(scene, object->grid.material)))
            continue;
        warn_of_choice(reader, i, &scene->meshes[object->mesh]);
        if (!mu_mesh_make_tangents(&scene->meshes[object->mesh], reader->error)) return 0;
    }
    return 1;
}
