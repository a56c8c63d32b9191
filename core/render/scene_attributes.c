/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_attributes.c: the vertex attributes that materials name, numbered over the scene, and read of each mesh that is shaded
 * by them. */
#include <string.h>

#include "core/render/mesh.h"
#include "core/render/scene_read.h"
#include "core/render/material_settings.h"

/* Number of the attribute in the scene's list; MU_ATTRIBUTES: there is no more room. */
static uint32_t number_of(mu_scene *scene, const char *name) {
    uint32_t i = 0;
    while (i < scene->attribute_count && strcmp(scene->attributes[i], name)) i++;
    if (i == scene->attribute_count && i < MU_ATTRIBUTES) scene->attributes[scene->attribute_count++] = name;
    return i;
}

static _Bool number_all(mu_scene *scene, mu_error *error) {
    for (uint32_t i = 0; i < scene->material_count; i++) {
        mu_source *source;
        for (size_t k = 0; (source = mu_material_source(&scene->materials[i].material, k)); k++) {
            for (int c = 0; c < source->count && source->kind == MU_SOURCE_ATTRIBUTE; c++) {
                source->attribute[c] = number_of(scene, source->name[c]);
                if (source->attribute[c] == MU_ATTRIBUTES)
                    return mu_fail(error, "%s: more than %d vertex attributes", scene->file, MU_ATTRIBUTES);
            }
        }
    }
    return 1;
}

/* What a picture's texels are held to (source_picture.c). */
static _Bool check_range(const mu_mesh *mesh, const mu_source *source, int number, const float *values,
                         const mu_place *place, mu_error *error) {
    char range[160];
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float *at = mesh->positions + 3 * i;
        if (mu_param_allows(source->param, (double)values[i])) continue;
        mu_param_range(source->param, range, sizeof range);
        return mu_place_fail(place, error,
                             "%s: the vertex at (%g, %g, %g) has a \"%s\" of %g, from which its material "
                             "takes %s; it must be %s",
                             mesh->file, (double)at[0], (double)at[1], (double)at[2], source->name[number],
                             (double)values[i], source->param->name, range);
    }
    return 1;
}

static _Bool read_of(mu_reader *reader, const mu_place *place, const mu_object *object, uint32_t material) {
    mu_scene *scene = reader->scene;
    const mu_source *source;
    for (size_t k = 0; (source = mu_material_source(&scene->materials[material].material, k)); k++) {
        for (int c = 0; c < source->count && source->kind == MU_SOURCE_ATTRIBUTE; c++) {
            mu_error why = {.text = ""};
            if (object->shape != MU_MESH)
                return mu_place_fail(
                    place, reader->error,
                    "has no vertices with an attribute \"%s\", from which its material takes %s: only a "
                    "mesh has",
                    source->name[c], source->param->name);
            mu_mesh *mesh = &scene->meshes[object->mesh];
            float **at = &mesh->attributes[source->attribute[c]];
            if (!*at) *at = mu_mesh_attribute(mesh, source->name[c], &why);
            if (!*at) return mu_place_fail(place, reader->error, "%s", why.text);
            if (!check_range(mesh, source, c, *at, place, reader->error)) return 0;
        }
    }
    return 1;
}

_Bool mu_read_attributes(mu_reader *reader) {
    mu_scene *scene = reader->scene;
    const mu_place objects = mu_place_member(&reader->root, "objects");
    if (!number_all(scene, reader->error)) return 0;
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const mu_place place = mu_place_element(&objects, i);
        const mu_object *object = &scene->objects[i];
        if (!read_of(reader, &place, object, object->material)) return 0;
        if (object->grid.lines && !read_of(reader, &place, object, object->grid.material)) return 0;
    }
    return 1;
}
