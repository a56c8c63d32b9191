/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* features.c: the feature bits of a scene, from what it contains and what its materials say of themselves. */
#include "core/render/features.h"
#include "core/render/source.h"

static const mu_feature list[MU_FEATURE_COUNT] = {
#define X(bit, name, brings) {name, brings},
    MU_FEATURES(X)
#undef X
};

const mu_feature *mu_feature_list(void) {
    return list;
}

static uint32_t of_light(const mu_light *light) {
    switch (light->kind) {
    case MU_ENVIRONMENT:
        return MU_FEATURE_ENVIRONMENT;
    case MU_CONSTANT:
        return MU_FEATURE_CONSTANT;
    case MU_STUDIO:
        return MU_FEATURE_STUDIO;
    case MU_DIRECTIONAL:
        return MU_FEATURE_DIRECTIONAL_LIGHTS;
    case MU_POINT:
        return MU_FEATURE_POINT_LIGHTS;
    case MU_RECTANGLE_LIGHT:
        return MU_FEATURE_RECTANGLE_LIGHTS;
    }
    return 0;
}

static uint32_t of_material(const mu_material *material) {
    static const uint32_t lobes[][2] = {{MUSURF_GLOSSY_REFLECTION, MU_FEATURE_GLOSSY_REFLECTION},
                                        {MUSURF_DELTA_REFLECTION, MU_FEATURE_DELTA_REFLECTION},
                                        {MUSURF_GLOSSY_TRANSMISSION, MU_FEATURE_GLOSSY_TRANSMISSION},
                                        {MUSURF_DELTA_TRANSMISSION, MU_FEATURE_DELTA_TRANSMISSION},
                                        {MUSURF_DIFFUSE_REFLECTION, MU_FEATURE_DIFFUSE_REFLECTION},
                                        {MUSURF_DIFFUSE_TRANSMISSION, MU_FEATURE_DIFFUSE_TRANSMISSION}};
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof lobes / sizeof *lobes; ++i)
        if (material->plan.lobes & lobes[i][0]) bits |= lobes[i][1];
    if (material->plan.table_bytes) bits |= MU_FEATURE_MATERIAL_TABLES;
    if (material->jacobian.map != MU_JACOBIAN_NONE) bits |= MU_FEATURE_JACOBIANS;
    if (material->jacobian.map == MU_JACOBIAN_DISPLACEMENT) bits |= MU_FEATURE_TEXTURES;
    if (material->normal_map) bits |= MU_FEATURE_TEXTURES | MU_FEATURE_NORMAL_MAPS;
    if (material->footprints) bits |= MU_FEATURE_FOOTPRINTS;
    if (material->blend) bits |= MU_FEATURE_BLENDS;
    const mu_source *source;
    for (size_t i = 0; (source = mu_material_source(material, i)); ++i)
        bits |= mu_source_is_picture(source)            ? MU_FEATURE_TEXTURES
                : source->kind == MU_SOURCE_ATTRIBUTE ? MU_FEATURE_ATTRIBUTES
                                                        : MU_FEATURE_EXPRESSIONS;
    return bits;
}

static uint32_t of_object(const mu_scene *scene, uint32_t index) {
    const mu_object *object = &scene->objects[index];
    uint32_t bits = object->grid.lines ? MU_FEATURE_GRIDS : 0;
    if (object->two_sided) bits |= MU_FEATURE_TWO_SIDED;
    if (object->shape == MU_RECTANGLE) return bits | MU_FEATURE_RECTANGLES;
    if (object->shape == MU_SPHERE) return bits | MU_FEATURE_SPHERES;
    for (uint32_t i = 0; i < index; ++i)
        if (scene->objects[i].shape == MU_MESH && scene->objects[i].mesh == object->mesh) {
            bits |= MU_FEATURE_INSTANCES;
            break;
        }
    if (scene->meshes[object->mesh].posed) bits |= MU_FEATURE_POSES;
    if (scene->meshes[object->mesh].tension) bits |= MU_FEATURE_TENSIONS;
    if (scene->meshes[object->mesh].tangents) bits |= MU_FEATURE_MESH_TANGENTS;
    return bits | MU_FEATURE_MESHES;
}

uint32_t mu_features_of(const mu_scene *scene) {
    uint32_t bits = scene->camera.kind == MU_ORTHOGRAPHIC ? MU_FEATURE_ORTHOGRAPHIC : 0;
    if (scene->integrator.roulette < scene->integrator.depth) bits |= MU_FEATURE_ROULETTE;
    if (scene->integrator.by_image) bits |= MU_FEATURE_FILTERED_LIGHT;
    for (uint32_t i = 0; i < scene->light_count; ++i) bits |= of_light(&scene->lights[i]);
    for (uint32_t i = 0; i < scene->material_count; ++i) bits |= of_material(&scene->materials[i].material);
    for (uint32_t i = 0; i < scene->object_count; ++i) bits |= of_object(scene, i);
    return bits;
}
