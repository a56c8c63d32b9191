/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
#include "tests/shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/render/mesh.h"

double test_between(uniform *random, double low, double high) {
    return low + (high - low) * uniform_double(random);
}

mu_vec3 test_direction(uniform *random) {
    const double z = test_between(random, -1, 1), phi = test_between(random, 0, 6.283185307179586);
    const double r = sqrt(1 - z * z);
    return mu_v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

mu_affine test_identity(void) {
    return (mu_affine){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

mu_affine test_affine(uniform *random, double translation) {
    mu_affine a;
    mu_map map;
    double volume;
    do {
        volume = 1;
        for (int j = 0; j < 3; ++j) {
            const float length = (float)exp(test_between(random, log(0.2), log(5)));
            const mu_vec3 column = mu_scale(test_direction(random), length);
            a.row[0][j] = column.x;
            a.row[1][j] = column.y;
            a.row[2][j] = column.z;
            volume *= (double)length;
        }
        for (int i = 0; i < 3; ++i) a.row[i][3] = (float)test_between(random, -translation, translation);
    } while (!mu_map_make(&map, &a) || fabs(map.determinant) < 0.1 * volume);
    return a;
}

static mu_mesh room(uint32_t vertices, uint32_t triangles) {
    mu_mesh mesh = {.vertex_count = vertices, .triangle_count = triangles};
    mesh.positions = calloc(3 * (size_t)vertices + 4, sizeof(float));
    mesh.indices = calloc(3 * (size_t)triangles, sizeof(uint32_t));
    assert_true(mesh.positions && mesh.indices);
    return mesh;
}

mu_mesh test_globe(uint32_t around, uint32_t up) {
    const double pi = 3.14159265358979323846;
    mu_mesh mesh = room((around + 1) * (up + 1), 2 * around * (up - 1));
    mesh.normals = calloc(3 * (size_t)mesh.vertex_count, sizeof(float));
    mesh.uvs = calloc(2 * (size_t)mesh.vertex_count, sizeof(float));
    assert_true(mesh.normals && mesh.uvs);
    for (uint32_t j = 0; j <= up; ++j)
        for (uint32_t i = 0; i <= around; ++i) {
            const size_t at = (size_t)j * (around + 1) + i;
            const double phi = i == around ? 0 : 2 * pi * i / around, theta = pi * j / up - pi / 2;
            const double rho = j == 0 || j == up ? 0 : cos(theta); /* the poles are exact */
            const float p[3] = {(float)(rho * cos(phi)), (float)(rho * sin(phi)), (float)sin(theta)};
            memcpy(mesh.positions + 3 * at, p, sizeof p);
            memcpy(mesh.normals + 3 * at, p, sizeof p);
            mesh.uvs[2 * at] = (float)i / (float)around;
            mesh.uvs[2 * at + 1] = (float)j / (float)up;
        }
    uint32_t *out = mesh.indices;
    for (uint32_t j = 0; j < up; ++j)
        for (uint32_t i = 0; i < around; ++i) {
            const uint32_t a = j * (around + 1) + i, b = a + 1, c = a + around + 1, d = c + 1;
            const uint32_t quad[6] = {a, b, d, a, d, c};
            if (j > 0) memcpy(out, quad, 3 * sizeof *out), out += 3;
            if (j < up - 1) memcpy(out, quad + 3, 3 * sizeof *out), out += 3;
        }
    return mesh;
}

mu_mesh test_soup(uniform *random, uint32_t triangles) {
    mu_mesh mesh = room(3 * triangles, triangles);
    for (uint32_t i = 0; i < 9 * triangles; ++i) mesh.positions[i] = (float)test_between(random, -1, 1);
    for (uint32_t i = 0; i < 3 * triangles; ++i) mesh.indices[i] = i;
    return mesh;
}

mu_object *test_add(test_scene *s, int shape, const mu_affine *to_world) {
    mu_object *object = &s->objects[s->scene.object_count++];
    *object = (mu_object){.size = {2, 2}, .radius = 1, .to_world = *to_world, .light = MU_NO_INDEX};
    object->shape = (__typeof__(object->shape))shape;
    return object;
}

void test_build(test_scene *s) {
    mu_error error = {.text = ""};
    s->scene.objects = s->objects;
    s->scene.meshes = s->meshes;
    s->geometry = mu_geometry_build(&s->scene, 1, &error);
    assert_string_equal(error.text, "");
    assert_non_null(s->geometry);
}

void test_scene_free(test_scene *s) {
    mu_geometry_free(s->geometry);
    for (uint32_t i = 0; i < s->scene.mesh_count; ++i) mu_mesh_free(&s->meshes[i]);
    memset(s, 0, sizeof *s);
}
