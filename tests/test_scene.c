/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_scene.c: what the reader makes of a scene file; and that its keys are the schema's, one for one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/render/scene_read.h"
#include "tests/scratch.h"

#define LAMBERT "{\"material\":\"template.lambert\"}"

static mu_scene read_scene(void **state, const char *text) {
    mu_error error = {.text = ""};
    mu_scene scene;
    const _Bool ok = mu_scene_read(&scene, test_scratch_text(state, "scene.json", text), &error);
    assert_string_equal(error.text, "");
    assert_true(ok);
    return scene;
}

static void assert_vector(mu_vec3 v, float x, float y, float z) {
    const mu_vec3 off = mu_sub(v, mu_v3(x, y, z));
    if (!(mu_length(off) < 1e-6f))
        fail_msg("(%g, %g, %g) is not (%g, %g, %g)", (double)v.x, (double)v.y, (double)v.z, (double)x,
                 (double)y, (double)z);
}

static void test_keys_are_the_schemas(void **state) {
    json_error_t reason;
    json_t *schema = json_load_file("scenes/scene.schema.json", 0, &reason);
    (void)state;
    assert_non_null(schema);
    for (int set = 0; set < MU_KEYS_COUNT; ++set) {
        const char *name = mu_scene_keys_name((mu_key_set)set);
        const json_t *definition = json_object_get(json_object_get(schema, "$defs"), name);
        const json_t *properties = json_object_get(definition, "properties");
        const char *const *keys = mu_scene_keys((mu_key_set)set);
        size_t count = 0;
        if (!definition) fail_msg("the schema does not define %s", name);
        assert_true(json_is_false(json_object_get(definition, "additionalProperties")));
        for (; keys[count]; ++count)
            if (!json_object_get(properties, keys[count]))
                fail_msg("the schema's %s lacks %s", name, keys[count]);
        if (count != json_object_size(properties))
            fail_msg("the schema's %s has %zu keys, the reader's %zu", name, json_object_size(properties),
                     count);
    }
    json_decref(schema);
}

static void test_defaults(void **state) {
    mu_scene scene = read_scene(state, "{\"objects\":[{\"shape\":\"sphere\",\"material\":" LAMBERT "}]}");
    assert_int_equal(scene.camera.kind, MU_PERSPECTIVE);
    assert_vector(scene.camera.position, 0, -4, 2);
    assert_vector(scene.camera.right, 1, 0, 0);
    assert_int_equal(scene.film.width, 640);
    assert_int_equal(scene.film.filter, MU_FILTER_GAUSSIAN);
    assert_true(scene.film.filter_radius == 1.5f);
    assert_true(scene.film.half);
    assert_int_equal(scene.light_count, 1);
    assert_int_equal(scene.lights[0].kind, MU_STUDIO);
    assert_true(scene.objects[0].radius == 1);
    assert_int_equal(scene.objects[0].light, MU_NO_INDEX);
    assert_vector(mu_affine_point(&scene.objects[0].to_world, mu_v3(1, 2, 3)), 1, 2, 3);
    assert_string_equal(scene.materials[0].name, "$.objects[0].material");
    mu_scene_free(&scene);
}

static void test_steps_apply_in_their_order(void **state) {
    mu_scene scene = read_scene(
        state,
        "{\"objects\":["
        "{\"shape\":\"sphere\",\"material\":" LAMBERT ",\"transform\":[{\"translate\":[1,0,0]},"
        "{\"rotate\":[0,0,2,90]},{\"scale\":[1,3,1]}]},"
        "{\"shape\":\"sphere\",\"material\":" LAMBERT ",\"transform\":[[1,2,0,5],[0,1,0,6],[0,0,-1,7]]},"
        "{\"shape\":\"sphere\",\"material\":" LAMBERT ",\"transform\":[{\"rotate\":[1,1,1,120]}]}]}");
    /* (1,0,0) -> (2,0,0) -> (0,2,0) -> (0,6,0); quarter turns are exact */
    const mu_vec3 p = mu_affine_point(&scene.objects[0].to_world, mu_v3(1, 0, 0));
    assert_true(p.x == 0 && p.y == 6 && p.z == 0);
    assert_vector(mu_affine_point(&scene.objects[1].to_world, mu_v3(1, 1, 1)), 8, 7, 6);
    assert_vector(mu_affine_point(&scene.objects[2].to_world, mu_v3(1, 2, 3)), 3, 1,
                  2); /* x -> y -> z -> x */
    mu_scene_free(&scene);
}

static void test_cameras(void **state) {
    mu_scene scene =
        read_scene(state, "{\"camera\":{\"position\":[0,0,10],\"target\":[0,0,0],\"up\":[0,1,1],\"fov\":90},"
                          "\"objects\":[{\"shape\":\"sphere\",\"material\":" LAMBERT "}]}");
    assert_vector(scene.camera.forward, 0, 0, -1);
    assert_vector(scene.camera.up, 0, 1, 0);
    assert_vector(scene.camera.right, 1, 0, 0);
    assert_true(fabsf(scene.camera.half_height - 1) < 1e-6f);
    mu_scene_free(&scene);
    scene = read_scene(state, "{\"camera\":{\"type\":\"orthographic\",\"height\":3},"
                              "\"objects\":[{\"shape\":\"sphere\",\"material\":" LAMBERT "}]}");
    assert_int_equal(scene.camera.kind, MU_ORTHOGRAPHIC);
    assert_true(scene.camera.half_height == 1.5f);
    mu_scene_free(&scene);
}

/* One material for two users; unused ones are not kept; the grid has its own. */
static void test_materials_are_shared(void **state) {
    mu_scene scene = read_scene(
        state,
        "{\"materials\":{\"unused\":" LAMBERT ",\"a\":" LAMBERT ",\"b\":" LAMBERT "},"
        "\"objects\":[{\"shape\":\"sphere\",\"material\":\"b\"},{\"shape\":\"sphere\",\"material\":\"b\"},"
        "{\"shape\":\"rectangle\",\"material\":\"b\",\"grid\":{\"lines\":4,\"material\":\"a\"}}]}");
    assert_int_equal(scene.material_count, 2);
    assert_string_equal(scene.materials[0].name, "b");
    assert_int_equal(scene.objects[1].material, 0);
    assert_int_equal(scene.objects[2].grid.material, 1);
    assert_int_equal(scene.objects[2].grid.lines, 4);
    mu_scene_free(&scene);
}

/* A mesh is read once however many objects use it; tangents are made only where a material has a direction.
 */
static void test_meshes_are_shared(void **state) {
    test_scratch_text(state, "tile.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    mu_scene scene =
        read_scene(state, "{\"meshes\":{\"tile\":{\"file\":\"tile.obj\"},\"unused\":{\"file\":\"tile.obj\"}},"
                          "\"objects\":[{\"mesh\":\"tile\",\"material\":" LAMBERT "},"
                          "{\"mesh\":\"tile\",\"material\":" LAMBERT ",\"transform\":[{\"scale\":-1}]}]}");
    assert_int_equal(scene.mesh_count, 1);
    assert_int_equal(scene.meshes[0].triangle_count, 1);
    assert_null(scene.meshes[0].tangents);
    mu_scene_free(&scene);
    scene =
        read_scene(state, "{\"meshes\":{\"tile\":{\"file\":\"tile.obj\"}},\"objects\":[{\"mesh\":\"tile\","
                          "\"material\":{\"material\":\"musurf.microfacet\",\"transform\":[[5,0],[0,1]]}}]}");
    assert_non_null(scene.meshes[0].tangents);
    mu_scene_free(&scene);
}

static void test_lights(void **state) {
    mu_scene scene = read_scene(
        state,
        "{\"objects\":[{\"shape\":\"sphere\",\"material\":" LAMBERT "}],\"lights\":["
        "{\"type\":\"directional\",\"direction\":[0,3,4],\"irradiance\":[1,2,3]},"
        "{\"type\":\"rectangle\",\"size\":[2,1],\"radiance\":7,\"transform\":[{\"translate\":[0,0,3]}]},"
        "{\"type\":\"studio\",\"rotation\":450,\"scale\":[1,2,3]}]}");
    assert_int_equal(scene.light_count, 3);
    assert_vector(scene.lights[0].direction, 0, 0.6f, 0.8f);
    assert_true(scene.lights[0].irradiance[2] == 3);
    assert_true(scene.lights[1].scale[0] == 7 && scene.lights[1].scale[2] == 7);
    assert_true(fabsf(scene.lights[2].rotation - 1.57079633f) < 1e-6f);
    assert_int_equal(scene.object_count, 2); /* the rectangle light can be hit */
    assert_int_equal(scene.objects[1].light, 1);
    assert_int_equal(scene.objects[1].material, MU_NO_INDEX);
    assert_vector(mu_affine_point(&scene.objects[1].to_world, mu_v3(0, 0, 0)), 0, 0, 3);
    mu_scene_free(&scene);
}

static int set_up(void **state) {
    char path[4096];
    const char *build = getenv("BUILD");
    snprintf(path, sizeof path, "%s", build ? build : "build");
    setenv("MUSURF_PLUGIN_PATH", path, 0);
    return test_scratch_make(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys_are_the_schemas),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_steps_apply_in_their_order),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_materials_are_shared),
        cmocka_unit_test(test_meshes_are_shared),
        cmocka_unit_test(test_lights),
    };
    return cmocka_run_group_tests_name("scene", tests, set_up, test_scratch_remove);
}
