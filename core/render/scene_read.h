/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_read.h: what the files scene*.c share while a scene is read. */
#ifndef MU_SCENE_READ_H
#define MU_SCENE_READ_H

#include "core/render/scene.h"

/* Coordinates and sizes are within this, so that no product of them leaves float's range. */
#define MU_LARGEST 1e9

/* The objects of a scene file, each with its own set of keys. */
typedef enum mu_key_set {
    MU_KEYS_SCENE,
    MU_KEYS_PERSPECTIVE,
    MU_KEYS_ORTHOGRAPHIC,
    MU_KEYS_FILM,
    MU_KEYS_INTEGRATOR,
    MU_KEYS_MESH,
    MU_KEYS_RECTANGLE,
    MU_KEYS_SPHERE,
    MU_KEYS_MESH_OBJECT,
    MU_KEYS_POSE,
    MU_KEYS_TENSION,
    MU_KEYS_GRID,
    MU_KEYS_STEP,
    MU_KEYS_ENVIRONMENT,
    MU_KEYS_CONSTANT,
    MU_KEYS_STUDIO,
    MU_KEYS_DIRECTIONAL,
    MU_KEYS_POINT,
    MU_KEYS_RECTANGLE_LIGHT,
    MU_KEYS_COUNT
} mu_key_set;

/* The accepted keys, NULL-terminated, and the name of the set's definition in scenes/scene.schema.json. */
const char *const *mu_scene_keys(mu_key_set set);
const char *mu_scene_keys_name(mu_key_set set);

typedef struct mu_reader {
    mu_scene *scene;
    const mu_document *document;
    mu_place root, materials, meshes; /* `value` is NULL where the scene has no such table */
    mu_moment moment;
    _Bool has_sequence, has_animation; /* among the meshes that objects use */
    mu_error *error;
} mu_reader;

/* Optional members: *out keeps its value where there is none. */
_Bool mu_read_float(const mu_place *parent, const char *key, double min, double max, float *out,
                    mu_error *error);
_Bool mu_read_floats(const mu_place *parent, const char *key, size_t count, double min, double max,
                     float *out, mu_error *error);
_Bool mu_read_count(const mu_place *parent, const char *key, long long min, long long max, uint32_t *out,
                    mu_error *error);
_Bool mu_read_vector(const mu_place *parent, const char *key, mu_vec3 *out, mu_error *error);
/* One number for all three channels, or [r, g, b]; not negative. */
_Bool mu_read_color(const mu_place *parent, const char *key, float out[3], mu_error *error);
/* "type" and the like: which of `choices`; *out keeps its value where there is none. */
_Bool mu_read_choice(const mu_place *parent, const char *key, const char *const *choices, size_t *out,
                     mu_error *error);
/* "transform": rows of a matrix or a list of steps; the identity where there is none. */
_Bool mu_read_transform(const mu_place *parent, mu_affine *out, mu_error *error);

_Bool mu_read_camera(mu_reader *reader);
_Bool mu_read_film(mu_reader *reader);
_Bool mu_read_integrator(mu_reader *reader);
_Bool mu_read_objects(mu_reader *reader);
_Bool mu_read_lights(mu_reader *reader); /* after the objects: adds those of rectangle lights */

/* Index of the material at `place`, a name or an object; made when it is first met. `owner` names an inline
 * one. `deforming`: for an object with tension, for which it is made apart. */
_Bool mu_read_material(mu_reader *reader, const mu_place *place, const char *owner, _Bool deforming, uint32_t *out);
/* Named materials that nothing uses are checked all the same, then dropped. */
_Bool mu_check_unused_materials(mu_reader *reader);
/* `pose`: as pose.h has it; `tension`: {"rest": file} or "bind"; or without value. */
_Bool mu_read_mesh(mu_reader *reader, const mu_place *place, const mu_place *pose, const mu_place *tension,
                   uint32_t *out);
_Bool mu_check_meshes(mu_reader *reader);
/* Tangents for those meshes that a material with a direction stands on. */
_Bool mu_make_scene_tangents(mu_reader *reader);

/* Vertex attributes that materials ask for, of the meshes they stand on; after the tangents, which may split vertices. */
_Bool mu_read_attributes(mu_reader *reader);

/* A file named in the scene, relative to the scene file; to be freed. NULL without memory. */
char *mu_scene_path(const mu_reader *reader, const char *name);
/* "is not known; did you mean ..." for a name that should be a member of the object `table`. */
_Bool mu_fail_unknown(const mu_place *place, json_t *table, const char *what, mu_error *error);
/* "scene.json:12:20: $.lights[0].image"; to be freed. NULL without memory. */
char *mu_place_text(const mu_place *place);
/* A warning with the place. */
void mu_scene_warn(const mu_reader *reader, const mu_place *place, const char *text);
/* Appends room for one element, zeroed; false without memory. */
_Bool mu_append(void **array, uint32_t *count, size_t size, mu_error *error);

#endif
