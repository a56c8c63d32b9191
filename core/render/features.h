/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * features.h: what a scene may need, in one list: bit, name, and the work that is left out where it is not needed.
 *
 * Everything that names features (the bits, `--explain`, its test) is made from this list.
 */
#ifndef MU_FEATURES_H
#define MU_FEATURES_H

#include "core/render/scene.h"

/* clang-format off */
#define MU_FEATURES(X)                                                                                                 \
    X(ORTHOGRAPHIC,          "orthographic",          "parallel camera rays")                                          \
    X(RECTANGLES,            "rectangles",            "Embree quad geometry")                                          \
    X(SPHERES,               "spheres",               "Embree user geometry with the exact quadric")                   \
    X(MESHES,                "meshes",                "reading of mesh files, and Embree triangle geometry")           \
    X(INSTANCES,             "instances",             "a second level of boxes, and rays transformed into it")         \
    X(MESH_TANGENTS,         "mesh_tangents",         "tangents of mesh vertices")                                     \
    X(POSES,                 "poses",                 "morph targets, bones and animations of mesh files")             \
    X(TENSIONS,              "tensions",              "meshes at rest, and a transform per hit from the deformation, in slots")  \
    X(GRIDS,                 "grids",                 "a second material chosen by texture coordinates")               \
    X(TWO_SIDED,             "two_sided",             "frames turned over when seen from behind")                      \
    X(JACOBIANS,             "jacobians",             "a transform per hit from the map's Jacobian, in slots")         \
    X(TEXTURES,              "textures",              "OpenImageIO, and parameters from pictures, averaged over a pixel, in slots")  \
    X(NORMAL_MAPS,           "normal_maps",           "frames turned by pictures of normals, and lobes widened by how these vary in a pixel") \
    X(ATTRIBUTES,            "attributes",            "properties of a mesh file's vertices, and parameters from them, in slots")    \
    X(EXPRESSIONS,           "expressions",           "parameters from formulas of texture coordinates, in slots")     \
    X(BLENDS,                "blends",                "materials compiled at several values of a parameter that the plugin wants constant") \
    X(FOOTPRINTS,            "footprints",            "the part of the texture that a pixel covers, per hit, in slots")  \
    X(ENVIRONMENT,           "environment",           "OpenImageIO, the image and its sampling table")                 \
    X(STUDIO,                "studio",                "the studio and its sampling table")                             \
    X(CONSTANT,              "constant",              "uniform light from everywhere")                                 \
    X(FILTERED_LIGHT,        "filtered_light",        "the light around filtered for every roughness, and tables of albedos")   \
    X(DIRECTIONAL_LIGHTS,    "directional_lights",    "parallel light")                                                \
    X(POINT_LIGHTS,          "point_lights",          "light from a point, to all sides or within a cone")             \
    X(RECTANGLE_LIGHTS,      "rectangle_lights",      "sampling of rectangles by area or solid angle")                 \
    X(GLOSSY_REFLECTION,     "glossy_reflection",     "microfacet reflection")                                         \
    X(DELTA_REFLECTION,      "delta_reflection",      "mirrors")                                                       \
    X(GLOSSY_TRANSMISSION,   "glossy_transmission",   "microfacet refraction")                                         \
    X(DELTA_TRANSMISSION,    "delta_transmission",    "clear refraction")                                              \
    X(DIFFUSE_REFLECTION,    "diffuse_reflection",    "diffuse reflection")                                            \
    X(DIFFUSE_TRANSMISSION,  "diffuse_transmission",  "diffuse transmission")                                          \
    X(MATERIAL_TABLES,       "material_tables",       "tables of materials")                                           \
    X(ROULETTE,              "roulette",              "Russian roulette")
/* clang-format on */

enum {
#define X(bit, name, brings) MU_FEATURE_INDEX_##bit,
    MU_FEATURES(X)
#undef X
        MU_FEATURE_COUNT
};

#define X(bit, name, brings) MU_FEATURE_##bit = 1u << MU_FEATURE_INDEX_##bit,
enum { MU_FEATURES(X) };
#undef X

typedef struct mu_feature {
    const char *name, *brings;
} mu_feature;

/* In the order of the bits. */
const mu_feature *mu_feature_list(void);
/* The union of the bits that the scene needs. */
uint32_t mu_features_of(const mu_scene *scene);

#endif
