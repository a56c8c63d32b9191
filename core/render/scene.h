/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * scene.h: a scene as plain data, read from JSON; immutable while it renders, shared by all threads.
 *
 * Order of things: scene_read fills this, geometry_build and lights_build prepare what rays and light samples
 * need, the integrator only reads.
 */
#ifndef MU_SCENE_H
#define MU_SCENE_H

#include <stdint.h>

#include "core/ibl/reads.h"
#include "core/render/material.h"
#include "core/render/vector.h"

#define MU_NO_INDEX 0xffffffffu

typedef struct mu_camera {
    enum { MU_PERSPECTIVE, MU_ORTHOGRAPHIC } kind;
    mu_vec3 position;
    mu_vec3 right, up, forward; /* orthonormal; image x to the right, image y downwards is -up */
    float half_height; /* perspective: tan(vertical field of view / 2); orthographic: half the height */
} mu_camera;

/* Both from a scene file and from --size. */
#define MU_LONGEST_SIDE 32768
#define MU_MOST_PIXELS  (1 << 26) /* 4 GiB of sums */

typedef struct mu_film_settings {
    uint32_t width, height;
    enum { MU_FILTER_BOX, MU_FILTER_GAUSSIAN } filter;
    float filter_radius; /* in pixels; box: half its width (0.5); Gaussian: cut-off, sigma = radius / 3 */
    float exposure;      /* stops, for the PNG preview only */
    _Bool half;          /* EXR channels: half or float */
} mu_film_settings;

#define MU_READS_USUAL UINT32_MAX

typedef struct mu_integrator_settings {
    _Bool by_image;             /* lit by `technique` (image_light.h); else by paths */
    mu_ibl_technique technique; /* read if by_image */
    uint32_t reads;             /* of the filtered environment, of techniques that have a choice; 0: as needed;
                                 * MU_READS_USUAL: 16, or of lobes MU_IBL_READS_OF_LOBE */
    float k, beta;              /* of the major axis, as is this: core/ibl/ibl_real.h */
    mu_ibl_shift appendix_c;
    _Bool tails, means; /* of lobes: whether a distribution that is not GGX, and a mean slope, move the reads */
    const char *idle;  /* a setting of theirs that the scene has though it names no technique; NULL: none */
    uint32_t depth;    /* longest path: number of scattering events; 1 = direct light only */
    uint32_t roulette; /* Russian roulette from this many events on */
    uint32_t samples;  /* per pixel, unless the command line says otherwise */
    _Bool
        bsdf_only; /* light is found by following the BSDF alone, but for lights that are points or directions */
    uint32_t light_cells; /* a light sample is chosen among the square of this many candidates; 0 is 1 */
    uint64_t seed;
} mu_integrator_settings;

/* Their names, NULL-terminated, and the one of an index chosen. */
extern const char *const mu_integrators[];
void mu_integrator_choose(mu_integrator_settings *integrator, size_t index);

enum { MU_ATTRIBUTES = 16 };

/* Arrays are NULL where the file has none; tangents are made at load: continuous, xyz and handedness. */
typedef struct mu_mesh {
    char *name, *file;
    uint32_t vertex_count, triangle_count;
    float *positions; /* 3 each */
    float *normals;   /* 3 each, unit */
    float *uvs;       /* 2 each */
    float *tangents;  /* 4 each */
    float *tension;   /* 4 each: M of the deformation from the mesh at rest, in the triangles' frames (tension.h) */
    _Bool posed;
    char *use; /* the pose and the mesh at rest that make it more than its file, as one text; NULL: none */
    float *attributes[MU_ATTRIBUTES]; /* 1 each: of the scene's list; NULL where no material asks for it */
    uint32_t *indices;
} mu_mesh;

typedef struct mu_named_material {
    char *name;
    _Bool deforming; /* made for objects with tension */
    mu_material material;
} mu_named_material;

/* A reference grid drawn over the unit texture square with a second material (Figure 1 of 000). */
typedef struct mu_grid {
    uint32_t lines;    /* cells per unit of u and v; 0: no grid */
    float width;       /* of a line, in texture units */
    uint32_t material; /* index */
} mu_grid;

typedef struct mu_object {
    enum { MU_RECTANGLE, MU_SPHERE, MU_MESH } shape;
    uint32_t mesh; /* MU_MESH: index */
    float size[2]; /* MU_RECTANGLE: in its xy plane, centred, normal +z, uv in [0,1]^2 along +x, +y */
    float radius;  /* MU_SPHERE: centred; u along longitude, v from the south to the north pole */
    mu_affine to_world;
    uint32_t material; /* index; MU_NO_INDEX for the rectangle of a light, which reflects nothing */
    uint32_t light;    /* rectangle that emits: index of its light, else MU_NO_INDEX */
    _Bool two_sided; /* turn the frame over when seen from behind; else the back of opaque things is black */
    mu_grid grid;
} mu_object;

typedef struct mu_light {
    enum { MU_ENVIRONMENT, MU_CONSTANT, MU_STUDIO, MU_DIRECTIONAL, MU_POINT, MU_RECTANGLE_LIGHT } kind;
    char *image;    /* MU_ENVIRONMENT: resolved path of a latitude-longitude image; +z is up */
    char *place;    /* MU_ENVIRONMENT: "scene.json:12:20: $.lights[0].image", for messages about the image */
    float rotation; /* MU_ENVIRONMENT, MU_STUDIO: radians about +z, counter-clockwise */
    float scale[3]; /* multiplies radiance; of MU_CONSTANT it is the radiance; MU_RECTANGLE_LIGHT: radiance */
    mu_vec3 direction;   /* MU_DIRECTIONAL: toward the light, unit; MU_POINT: the middle of where it shines */
    float irradiance[3]; /* on a surface that faces it; MU_POINT: at a distance of 1, which is its intensity */
    mu_vec3 position;    /* MU_POINT */
    float cone[2];       /* MU_POINT: cosine of half its angle, and how much more to where it shines in full */
    mu_affine to_world;  /* MU_RECTANGLE_LIGHT: emits along its +z */
    float size[2];
} mu_light;

typedef struct mu_scene {
    char *file;
    char *text; /* the scene file as read, for the image header */
    mu_camera camera;
    mu_film_settings film;
    mu_integrator_settings integrator;
    mu_plugins *plugins;
    mu_named_material *materials;
    mu_mesh *meshes;
    mu_object *objects; /* rectangle lights appear here too, so that rays can hit them */
    mu_light *lights;   /* at most one of environment, constant and studio */
    uint32_t material_count, mesh_count, object_count, light_count;
    const char *attributes[MU_ATTRIBUTES]; /* names of vertex attributes; of the materials */
    uint32_t attribute_count;
} mu_scene;

/* What a command line chooses of a scene that moves. */
typedef struct mu_moment {
    long long frame;  /* of numbered meshes (sequence.h); MU_NO_FRAME: the first there is */
    double pose_time; /* of animations, in seconds; negative: the scene's own */
} mu_moment;

/* Reads and checks everything, loads meshes, compiles materials. Warnings go to stderr, one line each. */
_Bool mu_scene_read(mu_scene *scene, const char *file, mu_error *error);
/* The same at a moment; fails if the scene has nothing that it chooses. */
_Bool mu_scene_read_at(mu_scene *scene, const char *file, const mu_moment *moment, mu_error *error);
/* The same of a document in memory, whose values may have been changed since it was read; it is not kept. */
struct mu_document;
_Bool mu_scene_from(mu_scene *scene, const struct mu_document *document, mu_error *error);
void mu_scene_free(mu_scene *scene);

#endif
