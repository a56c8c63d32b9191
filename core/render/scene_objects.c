/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_objects.c: "objects": rectangles, spheres and meshes, placed in the world, each with its material. */
#include <stdio.h>

#include "core/render/scene_read.h"
#include "core/render/source.h"

/* Which shape the object is, from "shape" or "mesh"; checks its keys. */
static _Bool read_shape(mu_reader *reader, const mu_place *place, mu_object *object) {
    static const char *const shapes[] = {"rectangle", "sphere", NULL};
    mu_error *error = reader->error;
    const mu_place shape = mu_place_member(place, "shape"), mesh = mu_place_member(place, "mesh"),
                   pose = mu_place_member(place, "pose"), tension = mu_place_member(place, "tension");
    size_t choice;
    if (!json_is_object(place->value)) return mu_place_only(place, mu_scene_keys(MU_KEYS_RECTANGLE), error);
    if (shape.value && mesh.value)
        return mu_place_fail(place, error, "has both \"shape\" and \"mesh\"; an object is one of them");
    if (mesh.value) {
        object->shape = MU_MESH;
        return mu_place_only(place, mu_scene_keys(MU_KEYS_MESH_OBJECT), error) &&
               mu_read_mesh(reader, &mesh, &pose, &tension, &object->mesh);
    }
    if (!shape.value) { /* a misspelt key is the likelier mistake */
        static const char *const any[] = {"shape",    "mesh",      "pose",      "tension",   "size", "radius",
                                          "material", "transform", "two_sided", "grid", NULL};
        if (!mu_place_only(place, any, error)) return 0;
        return mu_place_fail(place, error, "needs a \"shape\" (\"rectangle\" or \"sphere\") or a \"mesh\"");
    }
    if (!mu_place_choice(&shape, shapes, &choice, error)) return 0;
    object->shape = choice ? MU_SPHERE : MU_RECTANGLE;
    return mu_place_only(place, mu_scene_keys(choice ? MU_KEYS_SPHERE : MU_KEYS_RECTANGLE), error) &&
           mu_read_floats(place, "size", 2, 1e-9, MU_LARGEST, object->size, error) &&
           mu_read_float(place, "radius", 1e-9, MU_LARGEST, &object->radius, error);
}

/* Maps and grids live in texture space. */
static _Bool check_uvs(mu_reader *reader, const mu_place *place, const mu_object *object, uint32_t material,
                       const char *what) {
    const mu_scene *scene = reader->scene;
    const mu_material *const of = &scene->materials[material].material;
    const mu_source *source;
    if (of->jacobian.map != MU_JACOBIAN_NONE && !what) what = "its \"jacobian\"";
    if (of->normal_map && !what) what = "its \"normal_map\"";
    for (size_t i = 0; !what && (source = mu_material_source(of, i)); i++)
        if (source->kind != MU_SOURCE_ATTRIBUTE) what = source->param->name;
    if (object->shape != MU_MESH || scene->meshes[object->mesh].uvs || !what) return 1;
    return mu_place_fail(place, reader->error,
                         "%s needs texture coordinates, which the mesh \"%.60s\" has not",
                         what, scene->meshes[object->mesh].name);
}

static _Bool is_deformed(const mu_scene *scene, const mu_object *object) {
    return object->shape == MU_MESH && scene->meshes[object->mesh].tension != NULL;
}

static _Bool check_tension(mu_reader *reader, const mu_place *place, const mu_object *object) {
    const mu_material *material = &reader->scene->materials[object->material].material;
    if (!is_deformed(reader->scene, object) || material->tension) return 1;
    const mu_place tension = mu_place_member(place, "tension");
    return mu_place_fail_key(&tension, reader->error, "%s has no transform that may vary",
                             material->type->id);
}

static _Bool read_grid(mu_reader *reader, const mu_place *parent, mu_object *object, const char *owner) {
    const mu_place place = mu_place_member(parent, "grid");
    char name[96];
    if (!place.value) return 1;
    object->grid = (mu_grid){.lines = 10, .width = 0.01f};
    if (!mu_place_only(&place, mu_scene_keys(MU_KEYS_GRID), reader->error) ||
        !mu_read_count(&place, "lines", 1, 1000000, &object->grid.lines, reader->error) ||
        !mu_read_float(&place, "width", 0, 1, &object->grid.width, reader->error))
        return 0;
    const mu_place material = mu_place_member(&place, "material");
    snprintf(name, sizeof name, "%.60s.grid.material", owner);
    return mu_read_material(reader, &material, name, is_deformed(reader->scene, object),
                            &object->grid.material) &&
           check_uvs(reader, &place, object, object->grid.material, "a grid");
}

static _Bool read_object(mu_reader *reader, const mu_place *place, mu_object *object, size_t index) {
    char owner[64], inlined[80];
    const mu_place material = mu_place_member(place, "material"),
                   two_sided = mu_place_member(place, "two_sided");
    *object = (mu_object){.size = {2, 2}, .radius = 1, .light = MU_NO_INDEX};
    snprintf(owner, sizeof owner, "$.objects[%zu]", index);
    snprintf(inlined, sizeof inlined, "%s.material", owner);
    return read_shape(reader, place, object) && mu_read_transform(place, &object->to_world, reader->error) &&
           (!two_sided.value || mu_place_flag(&two_sided, &object->two_sided, reader->error)) &&
           mu_read_material(reader, &material, inlined, is_deformed(reader->scene, object),
                            &object->material) &&
           check_tension(reader, place, object) &&
           check_uvs(reader, &material, object, object->material, NULL) &&
           read_grid(reader, place, object, owner);
}

_Bool mu_read_objects(mu_reader *reader) {
    mu_scene *scene = reader->scene;
    const mu_place place = mu_place_member(&reader->root, "objects");
    if (!json_is_array(place.value) || !json_array_size(place.value))
        return mu_place_fail(&place, reader->error,
                             "%s a list of at least one object, such as "
                             "{\"shape\": \"sphere\", \"material\": ...}",
                             place.value ? "must be" : "is missing; it must be");
    for (size_t i = 0; i < json_array_size(place.value); ++i) {
        const mu_place element = mu_place_element(&place, i);
        mu_object object;
        if (!read_object(reader, &element, &object, i) ||
            !mu_append((void **)&scene->objects, &scene->object_count, sizeof object, reader->error))
            return 0;
        scene->objects[scene->object_count - 1] = object;
    }
    return 1;
}
