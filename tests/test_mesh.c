/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_mesh.c: what is read from mesh files, the normals and tangents made for them, and files that are
 * refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/render/mesh.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

static mu_mesh read_mesh(const char *path, uint32_t dropped_expected) {
    mu_error error = {.text = ""};
    mu_mesh mesh;
    mu_mesh_notes notes;
    const _Bool ok = mu_mesh_read(&mesh, path, &notes, &error);
    assert_string_equal(error.text, "");
    assert_true(ok);
    assert_int_equal(notes.dropped, dropped_expected);
    return mesh;
}

static void refuse(const char *path, const char *word) {
    mu_error error = {.text = ""};
    mu_mesh mesh;
    mu_mesh_notes notes;
    assert_false(mu_mesh_read(&mesh, path, &notes, &error));
    assert_non_null(strstr(error.text, word));
    assert_null(strchr(error.text, '\n'));
    assert_null(mesh.positions);
}

static void assert_direction(const float *v, double x, double y, double z) {
    const mu_dvec3 off = mu_dsub(mu_dfloat(v), mu_dnormalise(mu_d3(x, y, z)));
    if (!(mu_dlength(off) < 1e-6))
        fail_msg("(%g, %g, %g) is not along (%g, %g, %g)", (double)v[0], (double)v[1], (double)v[2], x, y, z);
}

/* Three right angles meet at each corner, however its squares are cut: the diagonal. */
static void test_cube_normals_are_diagonals(void **state) {
    mu_mesh mesh =
        read_mesh(test_scratch_text(state, "cube.obj",
                                    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                                    "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                                    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"),
                  0);
    assert_int_equal(mesh.triangle_count, 12);
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        const float *p = mesh.positions + 3 * i;
        assert_direction(mesh.normals + 3 * i, (double)p[0], (double)p[1], (double)p[2]);
    }
    mu_mesh_free(&mesh);
}

/* Texture coordinates cut the surface apart; the normal at the cut stays one. */
static void test_normals_are_smooth_across_seams(void **state) {
    mu_mesh mesh = read_mesh(test_scratch_text(state, "roof.obj",
                                               "v -1 0 0\nv -1 1 0\nv 0 0 1\nv 0 1 1\nv 1 0 0\nv 1 1 0\n"
                                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                               "f 1/1 3/2 4/3 2/4\nf 3/1 5/2 6/3 4/4\n"),
                             0);
    uint32_t ridge = 0;
    for (size_t i = 0; i < mesh.vertex_count; ++i)
        if (mesh.positions[3 * i] == 0) {
            assert_direction(mesh.normals + 3 * i, 0, 0, 1);
            ++ridge;
        }
    assert_int_equal(ridge, 4);
    mu_mesh_free(&mesh);
}

static void test_degenerate_triangles_are_counted(void **state) {
    mu_mesh mesh = read_mesh(test_scratch_text(state, "thin.obj",
                                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\n"
                                               "f 1 2 3\nf 1 2 4\nf 1 1 2\n"),
                             2);
    assert_int_equal(mesh.triangle_count, 1);
    mu_mesh_free(&mesh);
}

/* u along +y, v along -x of a square in the plane z = 0. */
static void test_tangent_is_along_u(void **state) {
    mu_mesh mesh = read_mesh(test_scratch_text(state, "turned.obj",
                                               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                               "vt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3 4/4\n"),
                             0);
    mu_error error = {.text = ""};
    assert_true(mu_mesh_make_tangents(&mesh, &error));
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        assert_direction(mesh.tangents + 4 * i, 0, 1, 0);
        assert_true(mesh.tangents[4 * i + 3] == 1);
    }
    mu_mesh_free(&mesh);
}

/* On the globe the tangent points east, also on the meridian where u jumps from 1 to 0: there, both copies
 * agree. */
static void test_tangents_are_continuous(void **state) {
    mu_mesh mesh = test_globe(24, 12);
    mu_error error = {.text = ""};
    (void)state;
    assert_true(mu_mesh_make_tangents(&mesh, &error));
    assert_int_equal(mesh.vertex_count, 25 * 13);
    for (uint32_t j = 1; j < 12; ++j)
        for (uint32_t i = 0; i < 25; ++i) {
            const size_t at = (size_t)j * 25 + i;
            const float *p = mesh.positions + 3 * at;
            assert_direction(mesh.tangents + 4 * at, -(double)p[1], (double)p[0], 0);
        }
    mu_mesh_free(&mesh);
}

/* Two squares, the right one's u mirrored at x = 1: there each side keeps its own tangent and handedness. */
static void test_mirrored_uvs_split(void **state) {
    mu_mesh mesh = read_mesh(test_scratch_text(state, "mirror.obj",
                                               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                               "f 1/1 2/2 3/3 4/4\nf 2/2 5/1 6/4 3/3\n"),
                             0);
    mu_error error = {.text = ""};
    assert_int_equal(mesh.vertex_count, 6);
    assert_true(mu_mesh_make_tangents(&mesh, &error));
    assert_int_equal(mesh.vertex_count, 8);
    for (size_t i = 0; i < 3 * (size_t)mesh.triangle_count; ++i) {
        const size_t t = i / 3, at = mesh.indices[i];
        double middle = 0;
        for (size_t k = 0; k < 3; ++k) middle += (double)mesh.positions[3 * mesh.indices[3 * t + k]] / 3;
        const double side = middle < 1 ? 1 : -1;
        assert_direction(mesh.tangents + 4 * at, side, 0, 0);
        assert_true((double)mesh.tangents[4 * at + 3] == side); /* dp/dv = +y = w (n x t) */
    }
    mu_mesh_free(&mesh);
}

static void test_without_uvs_tangents_follow_x(void **state) {
    mu_mesh mesh = test_globe(24, 12);
    mu_error error = {.text = ""};
    (void)state;
    free(mesh.uvs);
    mesh.uvs = NULL;
    assert_true(mu_mesh_make_tangents(&mesh, &error));
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        const mu_dvec3 n = mu_dfloat(mesh.normals + 3 * i);
        const float *t = mesh.tangents + 4 * i;
        if (fabs(n.x) > 0.999)
            assert_direction(t, 0, 1, 0);
        else
            assert_direction(t, 1 - n.x * n.x, -n.x * n.y, -n.x * n.z);
    }
    mu_mesh_free(&mesh);
}

/* A GLB with one square in the plane z = 0 whose node has the given scale. */
static size_t make_glb(unsigned char *out, const char *scale) {
    static const float positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    char json[1024];
    int length = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,"
        "\"scale\":%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,"
        "0],"
        "\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5125,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
        "\"byteLength\":24}],\"buffers\":[{\"byteLength\":72}]}",
        scale);
    while (length % 4) json[length++] = ' ';
    const uint32_t words[5] = {0x46546c67u, 2, 12 + 8 + (uint32_t)length + 8 + 72, (uint32_t)length,
                               0x4e4f534au};
    const uint32_t chunk[2] = {72, 0x004e4942u};
    memcpy(out, words, sizeof words);
    memcpy(out + 20, json, (size_t)length);
    memcpy(out + 20 + length, chunk, sizeof chunk);
    memcpy(out + 28 + length, positions, sizeof positions);
    memcpy(out + 76 + length, indices, sizeof indices);
    return 100 + (size_t)length;
}

static void test_gltf_nodes_are_applied(void **state) {
    unsigned char bytes[2048];
    const size_t size = make_glb(bytes, "[-2,1,1]");
    mu_mesh mesh = read_mesh(test_scratch_write(state, "node.glb", bytes, size), 0);
    float lowest = 0;
    assert_int_equal(mesh.triangle_count, 2);
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        lowest = fminf(lowest, mesh.positions[3 * i]);
        assert_direction(mesh.normals + 3 * i, 0, 0, 1); /* a mirror keeps the outside outside */
    }
    assert_true(lowest == -2);
    mu_mesh_free(&mesh);
}

static void test_bad_files_are_refused(void **state) {
    unsigned char bytes[2048];
    refuse("no/such.obj", "No such file");
    refuse(test_scratch_text(state, "mesh.txt", "v 0 0 0\n"), ".glb");
    refuse(test_scratch_text(state, "empty.obj", ""), "empty.obj");
    refuse(test_scratch_text(state, "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "points.obj");
    refuse(test_scratch_text(state, "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "empty");
    refuse(test_scratch_text(state, "nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"), "vertex 1");
    /* one beside others, which joining vertices would take for another's twin */
    refuse(test_scratch_text(state, "nan.ply",
                             "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                             "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 nan 0.5\n1 1 1\n3 0 1 2\n3 3 4 5\n"),
           "vertex 4 has a position");
    refuse(test_scratch_text(state, "huge.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n"), "vertex 1");
    refuse(test_scratch_text(state, "index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "index.obj");
    const size_t size = make_glb(bytes, "[1,0,1]");
    refuse(test_scratch_write(state, "singular.glb", bytes, size), "singular");
    for (size_t cut = 1; cut < size; cut += 7)
        refuse(test_scratch_write(state, "cut.glb", bytes, size - cut), "cut.glb");
}

static const char head[] =
    "ply\nformat %s 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";

/* However a PLY file is cut short, it is refused; whole, it is read. */
static void test_truncated_ply_is_refused(void **state) {
    static const float p[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int32_t faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
    char bytes[1024];
    size_t size = (size_t)snprintf(bytes, sizeof bytes, head, "binary_little_endian");
    memcpy(bytes + size, p, sizeof p);
    size += sizeof p;
    for (int f = 0; f < 2; ++f, size += 13) {
        bytes[size] = 3;
        memcpy(bytes + size + 1, faces[f], 12);
    }
    mu_mesh mesh = read_mesh(test_scratch_write(state, "whole.ply", bytes, size), 0);
    assert_int_equal(mesh.triangle_count, 2);
    mu_mesh_free(&mesh);
    for (size_t cut = 1; cut <= size; ++cut)
        refuse(test_scratch_write(state, "cut.ply", bytes, size - cut), "cut.ply");

    size = (size_t)snprintf(bytes, sizeof bytes, head, "ascii");
    size +=
        (size_t)snprintf(bytes + size, sizeof bytes - size, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    mesh = read_mesh(test_scratch_write(state, "ascii.ply", bytes, size), 0);
    assert_int_equal(mesh.triangle_count, 2);
    mu_mesh_free(&mesh);
    for (size_t cut = 2; cut <= size; ++cut) /* the last newline is not missed */
        refuse(test_scratch_write(state, "cut.ply", bytes, size - cut), "cut.ply");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube_normals_are_diagonals),
        cmocka_unit_test(test_normals_are_smooth_across_seams),
        cmocka_unit_test(test_degenerate_triangles_are_counted),
        cmocka_unit_test(test_tangent_is_along_u),
        cmocka_unit_test(test_tangents_are_continuous),
        cmocka_unit_test(test_mirrored_uvs_split),
        cmocka_unit_test(test_without_uvs_tangents_follow_x),
        cmocka_unit_test(test_gltf_nodes_are_applied),
        cmocka_unit_test(test_bad_files_are_refused),
        cmocka_unit_test(test_truncated_ply_is_refused),
    };
    return cmocka_run_group_tests_name("mesh", tests, test_scratch_make, test_scratch_remove);
}
