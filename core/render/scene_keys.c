/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_keys.c: every key of a scene file, in one table; a test holds scenes/scene.schema.json to it. */
#include "core/render/scene_read.h"

static const struct {
    const char *name;
    const char *keys[16];
} sets[MU_KEYS_COUNT] = {
    [MU_KEYS_SCENE] = {"scene",
                       {"$schema", "musurf", "description", "camera", "film", "integrator", "materials",
                        "meshes", "objects", "lights", NULL}},
    [MU_KEYS_PERSPECTIVE] = {"perspective", {"type", "position", "target", "up", "fov", NULL}},
    [MU_KEYS_ORTHOGRAPHIC] = {"orthographic", {"type", "position", "target", "up", "height", NULL}},
    [MU_KEYS_FILM] = {"film", {"width", "height", "filter", "radius", "exposure", "pixels", NULL}},
    [MU_KEYS_INTEGRATOR] = {"integrator", {"samples", "depth", "roulette", "seed", "light_sampling", "light_candidates", "by", "reads", "k",
                                       "beta", "appendix_c", "tails", "means", NULL}},
    [MU_KEYS_MESH] = {"mesh", {"file", NULL}},
    [MU_KEYS_RECTANGLE] = {"rectangle",
                           {"shape", "size", "material", "transform", "two_sided", "grid", NULL}},
    [MU_KEYS_SPHERE] = {"sphere", {"shape", "radius", "material", "transform", "two_sided", "grid", NULL}},
    [MU_KEYS_MESH_OBJECT] = {"mesh_object", {"mesh", "pose", "tension", "material", "transform", "two_sided", "grid", NULL}},
    [MU_KEYS_POSE] = {"pose", {"morph", "animation", "time", NULL}},
    [MU_KEYS_TENSION] = {"tension", {"rest", NULL}},
    [MU_KEYS_GRID] = {"grid", {"lines", "width", "material", NULL}},
    [MU_KEYS_STEP] = {"step", {"translate", "rotate", "scale", "matrix", NULL}},
    [MU_KEYS_ENVIRONMENT] = {"environment", {"type", "image", "rotation", "scale", "fallback", NULL}},
    [MU_KEYS_CONSTANT] = {"constant", {"type", "radiance", NULL}},
    [MU_KEYS_STUDIO] = {"studio", {"type", "rotation", "scale", NULL}},
    [MU_KEYS_DIRECTIONAL] = {"directional", {"type", "direction", "irradiance", NULL}},
    [MU_KEYS_POINT] = {"point", {"type", "position", "intensity", "direction", "angle", "blend", NULL}},
    [MU_KEYS_RECTANGLE_LIGHT] = {"rectangle_light", {"type", "size", "radiance", "transform", NULL}},
};

const char *const *mu_scene_keys(mu_key_set set) {
    return sets[set].keys;
}

const char *mu_scene_keys_name(mu_key_set set) {
    return sets[set].name;
}
