/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * path_fixture.h: small scenes made in memory, and means over their pictures. Means are over independent
 * replicas (one seed each), so that the stratification within a picture does not spoil the estimate of
 * variance.
 */
#ifndef MU_PATH_FIXTURE_H
#define MU_PATH_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "core/render/path.h"
#include "tests/moments.h"

enum { FIXTURE_MOST = 8 };

typedef struct path_fixture {
    mu_scene scene;
    mu_named_material materials[FIXTURE_MOST];
    mu_object objects[FIXTURE_MOST];
    mu_light lights[FIXTURE_MOST];
    mu_tracer tracer;
    mu_geometry *geometry;
    mu_lights *made;
    void *scratch;
} path_fixture;

/* An orthographic camera at (0,0,10) looking down, 2 x 2 units on `pixels` x `pixels`, box filter, depth 1.
 */
void fixture_start(path_fixture *f, uint32_t pixels);
/* JSON of a material; its index. Plugins are found in $BUILD. */
uint32_t fixture_material(path_fixture *f, const char *json);
/* The objects' and lights' fields may be changed until fixture_ready. */
mu_object *fixture_rectangle(path_fixture *f, float width, float height, mu_affine to_world,
                             uint32_t material);
mu_object *fixture_sphere(path_fixture *f, float radius, uint32_t material);
mu_light *fixture_light(path_fixture *f, mu_light light);
void fixture_ready(path_fixture *f);
void fixture_end(path_fixture *f);

/* Looking from `direction` (unit) at the origin, with `up` roughly upwards. */
void fixture_look(path_fixture *f, mu_vec3 direction, mu_vec3 up);

/* One sample; fails the test if anything was refused. */
mu_radiance fixture_sample(const path_fixture *f, const mu_path_options *options, uint64_t seed, uint32_t x,
                           uint32_t y, uint32_t sample);
/* Mean luminance (channel 0) of the whole picture, once for each of `replicas` seeds from `seed` on. */
moments fixture_mean(const path_fixture *f, const mu_path_options *options, uint64_t seed, int replicas,
                     uint32_t samples);
/* The same for each pixel, into out[y * width + x]. */
void fixture_pixels(const path_fixture *f, uint64_t seed, int replicas, uint32_t samples, moments *out);

/* Sum of z^2 over the pixels of two pictures of independent replicas; the p-value of their being equal. */
double p_of_pictures(const moments *a, const moments *b, size_t pixels);
/* p-value of two means being equal, beyond a bias of `slack` that float rounding is allowed. */
double p_of_means(const moments *a, const moments *b, double slack);

/* Rotation about +z, counter-clockwise. */
mu_affine fixture_turn(float angle);

#endif
