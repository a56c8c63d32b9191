/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* shapes.h: random directions and maps, meshes and scenes made in memory, for the tests of geometry and
 * meshes. */
#ifndef MU_TEST_SHAPES_H
#define MU_TEST_SHAPES_H

#include "core/render/affine.h"
#include "core/render/geometry.h"
#include "tests/uniform.h"

double test_between(uniform *random, double low, double high);
mu_vec3 test_direction(uniform *random); /* unit, evenly over the sphere */

/* A linear part with columns of lengths 0.2 to 5, not too near singular, a mirror half the time. */
mu_affine test_affine(uniform *random, double translation);
mu_affine test_identity(void);

/* The unit sphere as longitude and latitude strips: normals, UVs; u = 1 and u = 0 are different vertices. */
mu_mesh test_globe(uint32_t around, uint32_t up);
/* Triangles with corners in [-1, 1]^3, without normals and UVs. */
mu_mesh test_soup(uniform *random, uint32_t triangles);

typedef struct test_scene { /* a scene that owns its arrays; free it with test_scene_free */
    mu_scene scene;
    mu_object objects[64];
    mu_mesh meshes[4];
    mu_geometry *geometry;
} test_scene;

mu_object *test_add(test_scene *s, int shape, const mu_affine *to_world);
void test_build(test_scene *s); /* fails the test on an error */
void test_scene_free(test_scene *s);

#endif
