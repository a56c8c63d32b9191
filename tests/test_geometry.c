/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_geometry.c: what a ray hits, against closed forms (quadric, plane) and brute force in double
 * precision; frames, derivatives and normals under stretches, shears and mirrors; shared meshes against
 * unshared ones.
 *
 * Distances are floats: one rounding is 6e-8 of them. Embree's own arithmetic for a triangle loses a few
 * more, and more at grazing, so rays that meet a surface at less than 0.02 are compared by position along it
 * only.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/shapes.h"

static mu_dvec3 wide(mu_vec3 v) {
    return mu_d3((double)v.x, (double)v.y, (double)v.z);
}

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.9g is not %.9g within %.2g", a, b, tolerance);
}

static void assert_vectors(mu_dvec3 a, mu_dvec3 b, double tolerance) {
    const double off = mu_dlength(mu_dsub(a, b));
    if (!(off <= tolerance))
        fail_msg("(%g, %g, %g) is not (%g, %g, %g): %.3g > %.3g", a.x, a.y, a.z, b.x, b.y, b.z, off,
                 tolerance);
}

static double norm(const double (*m)[3]) { /* Frobenius: at least the spectral one */
    double sum = 0;
    for (int i = 0; i < 9; ++i) sum += m[i / 3][i % 3] * m[i / 3][i % 3];
    return sqrt(sum);
}

/* Unit, orthogonal, right-handed, each to a few float roundings. */
static void assert_frame(const mu_hit *hit) {
    const mu_dvec3 t = wide(hit->frame.t), b = wide(hit->frame.b), n = wide(hit->frame.n), ng = wide(hit->ng);
    assert_near(mu_dlength(t), 1, 3e-7);
    assert_near(mu_dlength(n), 1, 3e-7);
    assert_near(mu_dlength(ng), 1, 3e-7);
    assert_near(mu_ddot(t, n), 0, 3e-7);
    assert_vectors(mu_dcross(n, t), b, 5e-7);
    assert_true(mu_ddot(n, ng) > 0);
}

static mu_ray toward(uniform *random, const mu_affine *to_world, double distance) {
    const mu_vec3 inner = mu_scale(test_direction(random), (float)uniform_double(random));
    const mu_vec3 target = mu_affine_point(to_world, inner);
    const mu_vec3 direction = test_direction(random);
    return (mu_ray){mu_sub(target, mu_scale(direction, (float)distance)), direction, 0, INFINITY};
}

/* In the sphere's own space, with the textbook quadratic in long double. */
static void test_sphere_is_the_quadric(void **state) {
    uniform random = {1};
    (void)state;
    for (int round = 0; round < 40; ++round) {
        test_scene s = {0};
        const mu_affine a = test_affine(&random, 3);
        mu_map map;
        assert_true(mu_map_make(&map, &a));
        test_add(&s, MU_SPHERE, &a)->radius = 0.8f;
        test_build(&s);
        for (int i = 0; i < 250; ++i) {
            const mu_ray ray = toward(&random, &a, 20);
            const mu_dvec3 from =
                mu_d3((double)ray.origin.x - map.translation[0], (double)ray.origin.y - map.translation[1],
                      (double)ray.origin.z - map.translation[2]);
            const mu_dvec3 o = mu_matrix_times(map.inverse, from),
                           d = mu_matrix_times(map.inverse, wide(ray.direction));
            const long double r = 0.8f, qa = mu_ddot(d, d), qb = mu_ddot(o, d),
                              qc = (long double)mu_ddot(o, o) - r * r;
            const long double inside = qb * qb - qa * qc;
            mu_hit hit;
            const _Bool found = mu_geometry_intersect(s.geometry, &ray, &hit);
            if (fabsl(inside) < 1e-9L * qb * qb) continue; /* too near to tangent for these long doubles */
            assert_int_equal(found, inside > 0);
            assert_int_equal(mu_geometry_occluded(s.geometry, &ray), found);
            if (!found) continue;
            assert_near((double)hit.distance, (double)((-qb - sqrtl(inside)) / qa),
                        1e-7 * (double)hit.distance + 1e-7);
            assert_frame(&hit);
            /* p is on the ellipsoid, n is the gradient, (u, v) is where it is, dp/du and dp/dv lie in the
             * surface */
            const mu_dvec3 p =
                mu_dsub(wide(hit.p), mu_d3(map.translation[0], map.translation[1], map.translation[2]));
            const mu_dvec3 local = mu_matrix_times(map.inverse, p);
            /* p is rounded to float: so much is lost of it in the sphere's space, and of the normal found
             * from it */
            const double lost = 1e-6 + 0x1p-23 * mu_dlength(wide(hit.p)) * norm(map.inverse);
            assert_near(mu_dlength(local), 0.8f, lost);
            assert_vectors(wide(hit.ng), mu_dnormalise(mu_transpose_times(map.inverse, local)),
                           lost / 0.8 * norm(map.inverse) * norm(map.linear));
            const double phi = 6.283185307179586 * (double)hit.uv[0],
                         theta = 3.141592653589793 * ((double)hit.uv[1] - 0.5);
            assert_vectors(local,
                           mu_dscale(mu_d3(cos(theta) * cos(phi), cos(theta) * sin(phi), sin(theta)), 0.8f),
                           lost);
            const mu_dvec3 du = mu_d3(-sin(phi) * cos(theta), cos(phi) * cos(theta), 0);
            const mu_dvec3 dv = mu_d3(-sin(theta) * cos(phi), -sin(theta) * sin(phi), cos(theta));
            assert_vectors(wide(hit.dpdu),
                           mu_dscale(mu_matrix_times(map.linear, du), 0.8f * 6.283185307179586), 1e-3);
            assert_vectors(wide(hit.dpdv),
                           mu_dscale(mu_matrix_times(map.linear, dv), 0.8f * 3.141592653589793), 1e-3);
        }
        test_scene_free(&s);
    }
}

static void test_sphere_pole_has_a_frame(void **state) {
    test_scene s = {0};
    const mu_affine a = test_identity();
    const mu_ray ray = {{0, 0, 5}, {0, 0, -1}, 0, INFINITY};
    mu_hit hit;
    (void)state;
    test_add(&s, MU_SPHERE, &a);
    test_build(&s);
    assert_true(mu_geometry_intersect(s.geometry, &ray, &hit));
    assert_frame(&hit);
    assert_vectors(wide(hit.frame.t), mu_d3(0, 1, 0), 1e-6);
    assert_near((double)hit.uv[1], 1, 0);
    test_scene_free(&s);
}

static void test_rectangle_is_the_plane(void **state) {
    uniform random = {2};
    (void)state;
    for (int round = 0; round < 40; ++round) {
        test_scene s = {0};
        const mu_affine a = test_affine(&random, 3);
        mu_map map;
        assert_true(mu_map_make(&map, &a));
        mu_object *object = test_add(&s, MU_RECTANGLE, &a);
        object->size[0] = 1.5f;
        test_build(&s);
        for (int i = 0; i < 250; ++i) {
            const mu_ray ray = toward(&random, &a, 10);
            const mu_dvec3 from =
                mu_d3((double)ray.origin.x - map.translation[0], (double)ray.origin.y - map.translation[1],
                      (double)ray.origin.z - map.translation[2]);
            const mu_dvec3 o = mu_matrix_times(map.inverse, from),
                           d = mu_matrix_times(map.inverse, wide(ray.direction));
            const double t = -o.z / d.z, x = o.x + t * d.x, y = o.y + t * d.y;
            const double edge = fmax(fabs(x) / 0.75, fabs(y));
            mu_hit hit;
            const _Bool found = mu_geometry_intersect(s.geometry, &ray, &hit);
            if (fabs(edge - 1) < 1e-4 || fabs(d.z) < 0.02) continue;
            assert_int_equal(found, edge < 1 && t > 0);
            if (!found) continue;
            assert_near((double)hit.distance, t, 1e-4);
            assert_near((double)hit.uv[0], x / 1.5 + 0.5, 1e-4);
            assert_near((double)hit.uv[1], y / 2 + 0.5, 1e-4);
            assert_frame(&hit);
            assert_vectors(wide(hit.frame.n), mu_dnormalise(mu_transpose_times(map.inverse, mu_d3(0, 0, 1))),
                           1e-6);
            assert_vectors(wide(hit.frame.t), mu_dnormalise(mu_matrix_times(map.linear, mu_d3(1, 0, 0))),
                           1e-6);
            assert_vectors(wide(hit.dpdv), mu_matrix_times(map.linear, mu_d3(0, 2, 0)), 1e-5);
        }
        test_scene_free(&s);
    }
}

/* Distance to the nearest triangle by Moller and Trumbore's test in double precision, and the smallest margin
 * by which any test was decided: an edge nearer than that cannot be told in float. */
static double brute_force(const mu_mesh *mesh, const mu_map *map, const mu_ray *ray, uint32_t *triangle,
                          double *margin) {
    const mu_dvec3 o = wide(ray->origin), d = wide(ray->direction);
    double nearest = INFINITY;
    *margin = 1;
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        mu_dvec3 p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = mu_map_point(map,
                                mu_dfloat(mesh->positions + 3 * (size_t)mesh->indices[3 * i + (uint32_t)k]));
        const mu_dvec3 e1 = mu_dsub(p[1], p[0]), e2 = mu_dsub(p[2], p[0]), cross = mu_dcross(d, e2);
        const double determinant = mu_ddot(e1, cross);
        const mu_dvec3 s = mu_dsub(o, p[0]), q = mu_dcross(s, e1);
        const double u = mu_ddot(s, cross) / determinant, v = mu_ddot(d, q) / determinant;
        const double t = mu_ddot(e2, q) / determinant, inside = fmin(u, fmin(v, 1 - u - v));
        const double slope = fabs(determinant) / mu_dlength(mu_dcross(e1, e2));
        *margin = fmin(*margin, fmin(fabs(inside), slope));
        if (inside < 0 || t <= 0) continue;
        *margin = fmin(*margin, fabs(t - nearest));
        if (t < nearest) nearest = t, *triangle = i;
    }
    return nearest;
}

/* One use: vertices stand in the world. Two uses: instances, the second far away. Both must agree with brute
 * force. */
static void check_soup(uniform *random, const mu_affine *a, _Bool shared) {
    test_scene s = {0};
    mu_affine away = *a;
    mu_map map;
    uint32_t compared = 0;
    assert_true(mu_map_make(&map, a));
    s.meshes[s.scene.mesh_count++] = test_soup(random, 60);
    test_add(&s, MU_MESH, a);
    away.row[0][3] += 1e4f;
    if (shared) test_add(&s, MU_MESH, &away);
    test_build(&s);
    for (int i = 0; i < 500; ++i) {
        const mu_ray ray = toward(random, a, 12);
        double margin;
        uint32_t triangle = 0;
        const double t = brute_force(&s.meshes[0], &map, &ray, &triangle, &margin);
        mu_hit hit;
        const _Bool found = mu_geometry_intersect(s.geometry, &ray, &hit);
        if (margin < 1e-3) continue;
        ++compared;
        assert_int_equal(found, isfinite(t));
        assert_int_equal(mu_geometry_occluded(s.geometry, &ray), found);
        if (!found) continue;
        assert_near((double)hit.distance, t, 1e-3);
        assert_int_equal(hit.object, 0);
        assert_frame(&hit);
        mu_dvec3 p[3];
        for (uint32_t k = 0; k < 3; ++k)
            p[k] = mu_map_point(&map, mu_dfloat(s.meshes[0].positions + 9 * (size_t)triangle + 3 * k));
        /* outside: counter-clockwise in the mesh's own space, carried over by a mirror */
        const mu_dvec3 n = mu_dnormalise(mu_dcross(mu_dsub(p[1], p[0]), mu_dsub(p[2], p[0])));
        assert_vectors(wide(hit.ng), map.determinant < 0 ? mu_dscale(n, -1) : n, 1e-5);
        assert_near(mu_ddot(n, mu_dsub(wide(hit.p), p[0])), 0, (double)hit.error);
    }
    assert_true(compared > 100);
    test_scene_free(&s);
}

static void test_soup_is_brute_force(void **state) {
    uniform random = {3};
    (void)state;
    for (int round = 0; round < 20; ++round) {
        const mu_affine a = round ? test_affine(&random, 3) : test_identity();
        check_soup(&random, &a, round & 1);
    }
}

/* A smooth mesh keeps its outside outside, and its tangents along dp/du, whatever the map. */
static void test_globe_under_maps(void **state) {
    uniform random = {4};
    (void)state;
    for (int round = 0; round < 20; ++round) {
        test_scene s = {0};
        const mu_affine a = test_affine(&random, 3);
        mu_map map;
        assert_true(mu_map_make(&map, &a));
        s.meshes[s.scene.mesh_count++] = test_globe(64, 32);
        test_add(&s, MU_MESH, &a);
        if (round & 1) test_add(&s, MU_MESH, &a);
        test_build(&s);
        for (int i = 0; i < 200; ++i) {
            const mu_ray ray = toward(&random, &a, 20);
            mu_hit hit;
            if (!mu_geometry_intersect(s.geometry, &ray, &hit)) continue;
            assert_frame(&hit);
            const mu_dvec3 p =
                mu_dsub(wide(hit.p), mu_d3(map.translation[0], map.translation[1], map.translation[2]));
            const mu_dvec3 n =
                mu_dnormalise(mu_transpose_times(map.inverse, mu_matrix_times(map.inverse, p)));
            /* 64 x 32 cells: interpolated normals are within a cell's curvature of the sphere's; maps have
             * cond <= 250 */
            assert_true(mu_ddot(wide(hit.frame.n), n) > 0.9);
            assert_true(mu_ddot(wide(hit.ng), wide(ray.direction)) < 0); /* seen from outside */
            const mu_dvec3 along = mu_dnormalise(wide(hit.dpdu));
            assert_near(mu_ddot(mu_dcross(wide(hit.frame.n), wide(hit.frame.t)), along), 0, 1e-5);
        }
        test_scene_free(&s);
    }
}

static void test_grid_lines_have_their_material(void **state) {
    test_scene s = {0};
    const mu_affine a = test_identity();
    (void)state;
    mu_object *object = test_add(&s, MU_RECTANGLE, &a);
    object->material = 3;
    object->grid = (mu_grid){.lines = 10, .width = 0.02f, .material = 7};
    test_build(&s);
    static const struct {
        float u, v;
        uint32_t material;
    } cases[] = {{0.35f, 0.35f, 3},  {0.308f, 0.35f, 7}, {0.312f, 0.35f, 3}, {0.35f, 0.592f, 7},
                 {0.35f, 0.588f, 3}, {0.005f, 0.55f, 7}, {0.995f, 0.55f, 7}, {0.985f, 0.55f, 3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const mu_ray ray = {{2 * cases[i].u - 1, 2 * cases[i].v - 1, 1}, {0, 0, -1}, 0, INFINITY};
        mu_hit hit;
        assert_true(mu_geometry_intersect(s.geometry, &ray, &hit));
        assert_int_equal(hit.material, cases[i].material);
    }
    test_scene_free(&s);
}

static void test_singular_maps_are_refused(void **state) {
    test_scene s = {0};
    mu_affine flat = test_identity();
    mu_error error = {.text = ""};
    (void)state;
    flat.row[2][2] = 0;
    test_add(&s, MU_SPHERE, &flat);
    s.scene.objects = s.objects;
    assert_null(mu_geometry_build(&s.scene, 1, &error));
    assert_non_null(strstr(error.text, "singular"));
}

static void test_bounds_hold_everything(void **state) {
    test_scene s = {0};
    mu_affine a = test_identity(), b = test_identity();
    mu_vec3 min, max;
    (void)state;
    a.row[0][3] = 5;
    b.row[1][1] = 3;
    test_add(&s, MU_SPHERE, &a);
    test_add(&s, MU_RECTANGLE, &b);
    test_build(&s);
    mu_geometry_bounds(s.geometry, &min, &max);
    assert_vectors(wide(min), mu_d3(-1, -3, -1), 1e-5);
    assert_vectors(wide(max), mu_d3(6, 3, 1), 1e-5);
    test_scene_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_is_the_quadric),
        cmocka_unit_test(test_sphere_pole_has_a_frame),
        cmocka_unit_test(test_rectangle_is_the_plane),
        cmocka_unit_test(test_soup_is_brute_force),
        cmocka_unit_test(test_globe_under_maps),
        cmocka_unit_test(test_grid_lines_have_their_material),
        cmocka_unit_test(test_singular_maps_are_refused),
        cmocka_unit_test(test_bounds_hold_everything),
    };
    return cmocka_run_group_tests_name("geometry", tests, NULL, NULL);
}
