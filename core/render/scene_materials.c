/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * scene_materials.c: "materials", a table of named ones, and those written in place.
 *
 * A material is compiled when an object first names it. What nothing names is compiled only to find its
 * errors, and dropped at once: the picture does not carry its tables.
 */
#include <stdlib.h>
#include <string.h>

#include "core/render/scene_read.h"

static _Bool add(mu_reader *reader, const mu_place *definition, const char *name, _Bool deforming,
                 uint32_t *out) {
    mu_scene *scene = reader->scene;
    mu_material material = {0};
    char *copy = strdup(name);
    if (!copy) return mu_fail(reader->error, "not enough memory for the scene");
    if (!mu_material_read_to_render(&material, scene->plugins, definition, deforming, reader->error)) {
        free(copy);
        return 0;
    }
    if (!mu_append((void **)&scene->materials, &scene->material_count, sizeof *scene->materials,
                   reader->error)) {
        mu_material_free(&material);
        free(copy);
        return 0;
    }
    *out = scene->material_count - 1;
    scene->materials[*out] = (mu_named_material){copy, deforming, material};
    return 1;
}

static _Bool is_known(const mu_scene *scene, const char *name, _Bool deforming, uint32_t *out) {
    for (uint32_t i = 0; i < scene->material_count; ++i)
        if (!strcmp(scene->materials[i].name, name) && scene->materials[i].deforming == deforming) {
            *out = i;
            return 1;
        }
    return 0;
}

_Bool mu_read_material(mu_reader *reader, const mu_place *place, const char *owner, _Bool deforming,
                       uint32_t *out) {
    if (json_is_object(place->value)) return add(reader, place, owner, deforming, out);
    if (!json_is_string(place->value))
        return mu_place_fail(place, reader->error,
                             "%s the name of a material, or a material itself: "
                             "{\"material\": \"musurf.microfacet\", ...}",
                             place->value ? "must be" : "is missing; it must be");
    const char *name = json_string_value(place->value);
    if (is_known(reader->scene, name, deforming, out)) return 1;
    const mu_place definition = mu_place_member(&reader->materials, name);
    if (!definition.value) return mu_fail_unknown(place, reader->materials.value, "material", reader->error);
    return add(reader, &definition, name, deforming, out);
}

_Bool mu_check_unused_materials(mu_reader *reader) {
    const char *name;
    json_t *value;
    json_object_foreach(reader->materials.value, name, value) {
        const mu_place definition = mu_place_member(&reader->materials, name);
        mu_material material = {0};
        uint32_t index;
        if (name[0] == '$')
            return mu_place_fail(&definition, reader->error, "a name must not begin with '$': paths do");
        if (is_known(reader->scene, name, 0, &index) || is_known(reader->scene, name, 1, &index)) continue;
        if (!mu_material_read_to_render(&material, reader->scene->plugins, &definition, 0, reader->error)) return 0;
        mu_material_free(&material);
    }
    return 1;
}
