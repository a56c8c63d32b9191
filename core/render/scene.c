/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene.c: a scene file read from JSON into plain data. The format is described by scenes/scene.schema.json.
 */
#include "core/render/scene.h"

#include <stdlib.h>
#include <string.h>

#include "core/render/mesh.h"
#include "core/render/scene_read.h"
#include "core/render/sequence.h"

static _Bool is_table(const mu_place *place, mu_error *error) {
    if (!place->value || json_is_object(place->value)) return 1;
    return mu_place_fail(place, error, "must be an object: names, each with its definition");
}

static _Bool check_head(const mu_reader *reader) {
    const mu_place version = mu_place_member(&reader->root, "musurf");
    const mu_place schema = mu_place_member(&reader->root, "$schema");
    const mu_place description = mu_place_member(&reader->root, "description");
    const char *text;
    long long number;
    if (!mu_place_only(&reader->root, mu_scene_keys(MU_KEYS_SCENE), reader->error)) return 0;
    if (version.value && !mu_place_integer(&version, 1, 1, &number, reader->error)) return 0;
    if (schema.value && !mu_place_string(&schema, &text, reader->error)) return 0;
    return !description.value || mu_place_string(&description, &text, reader->error);
}

static _Bool read_all(mu_reader *reader) {
    mu_scene *scene = reader->scene;
    const mu_document *document = reader->document;
    scene->file = strdup(document->name);
    scene->text = strndup(document->text, document->length);
    scene->plugins = mu_plugins_new();
    if (!scene->file || !scene->text || !scene->plugins)
        return mu_fail(reader->error, "%s: not enough memory for the scene", document->name);
    return check_head(reader) && is_table(&reader->materials, reader->error) &&
           is_table(&reader->meshes, reader->error) && mu_read_camera(reader) && mu_read_film(reader) &&
           mu_read_integrator(reader) && mu_check_meshes(reader) && mu_read_objects(reader) &&
           mu_check_unused_materials(reader) && mu_make_scene_tangents(reader) &&
           mu_read_attributes(reader) && mu_read_lights(reader);
}

static _Bool check_moment(const mu_reader *reader) {
    if (reader->moment.frame != MU_NO_FRAME && !reader->has_sequence)
        return mu_fail(reader->error, "%s: has no numbered meshes, such as name_####.ply, of which to choose a frame",
                       reader->document->name);
    if (reader->moment.pose_time >= 0 && !reader->has_animation)
        return mu_fail(reader->error, "%s: has no \"pose\" with an animation, of which to choose a time",
                       reader->document->name);
    return 1;
}

static const mu_moment own_moment = {MU_NO_FRAME, -1};

static _Bool read_from(mu_scene *scene, const mu_document *document, const mu_moment *moment, mu_error *error) {
    memset(scene, 0, sizeof *scene);
    mu_reader reader = {
        .scene = scene, .document = document, .root = mu_place_root(document), .moment = *moment, .error = error};
    reader.materials = mu_place_member(&reader.root, "materials");
    reader.meshes = mu_place_member(&reader.root, "meshes");
    const _Bool ok = read_all(&reader) && check_moment(&reader);
    if (!ok) mu_scene_free(scene);
    return ok;
}

_Bool mu_scene_from(mu_scene *scene, const mu_document *document, mu_error *error) {
    return read_from(scene, document, &own_moment, error);
}

_Bool mu_scene_read(mu_scene *scene, const char *file, mu_error *error) {
    return mu_scene_read_at(scene, file, &own_moment, error);
}

_Bool mu_scene_read_at(mu_scene *scene, const char *file, const mu_moment *moment, mu_error *error) {
    mu_document document;
    memset(scene, 0, sizeof *scene);
    if (!mu_document_read(&document, file, error)) return 0;
    const _Bool ok = read_from(scene, &document, moment, error);
    mu_document_free(&document);
    return ok;
}

void mu_scene_free(mu_scene *scene) {
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        mu_material_free(&scene->materials[i].material);
        free(scene->materials[i].name);
    }
    for (uint32_t i = 0; i < scene->mesh_count; ++i) mu_mesh_free(&scene->meshes[i]);
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        free(scene->lights[i].image);
        free(scene->lights[i].place);
    }
    mu_plugins_free(scene->plugins);
    free(scene->materials);
    free(scene->meshes);
    free(scene->objects);
    free(scene->lights);
    free(scene->file);
    free(scene->text);
    memset(scene, 0, sizeof *scene);
}
