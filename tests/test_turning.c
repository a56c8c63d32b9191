/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_turning.c: pictures of a microfacet plate under M. Turning plate, M, lights and camera together
 * changes nothing but noise, in whichever of its ways M is turned; turning less than all does. A Jacobian
 * gives the picture of the transform it amounts to; a mirror shows the environment; both strategies agree.
 * Random comparisons: 9 + 2 + 3.
 */
#include "tests/path_fixture.h"

#include <stdio.h>
#include <string.h>

#include "core/render/light_parts.h"

enum { SIDE = 8, PIXELS = SIDE * SIDE, REPLICAS = 200, SAMPLES = 4 };

static const float angle = 0.7f;

static const char *const bases[3] = {"\"ndf\": \"ggx\", \"alpha\": 0.2",
                                     "\"ndf\": \"beckmann\", \"alpha\": 0.3",
                                     "\"ndf\": \"gtr\", \"alpha\": 0.1, \"gamma\": 1.7"};

/* What is turned about +z. */
typedef struct turns {
    float plate, surroundings;
    double m[4];
} turns;

static mu_vec3 turned(mu_vec3 v, float by) {
    const mu_affine turn = fixture_turn(by);
    return mu_affine_vector(&turn, v);
}

/* R(by) m R(-by) */
static void turned_map(const double m[4], double by, double out[4]) {
    const double c = cos(by), s = sin(by);
    const double r[4] = {c * m[0] - s * m[2], c * m[1] - s * m[3], s * m[0] + c * m[2], s * m[1] + c * m[3]};
    out[0] = r[0] * c - r[1] * s;
    out[1] = r[0] * s + r[1] * c;
    out[2] = r[2] * c - r[3] * s;
    out[3] = r[2] * s + r[3] * c;
}

static void picture(const char *json, mu_affine plate, float width, float height, float surroundings,
                    uint64_t seed, moments *out) {
    path_fixture f;
    fixture_start(&f, SIDE);
    fixture_rectangle(&f, width, height, plate, fixture_material(&f, json));
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}, .rotation = surroundings});
    /* A light that shines down from beside the camera's view: half a turn about x, then turned with the rest.
     */
    mu_affine down = fixture_turn(surroundings);
    const mu_vec3 centre = mu_affine_vector(&down, mu_v3(-2, 1, 0));
    for (int i = 0; i < 3; i++) {
        down.row[i][1] *= -1;
        down.row[i][2] *= -1;
    }
    down.row[0][3] = centre.x;
    down.row[1][3] = centre.y;
    down.row[2][3] = 2.5f;
    fixture_light(
        &f,
        (mu_light){.kind = MU_RECTANGLE_LIGHT, .to_world = down, .size = {1.5f, 0.5f}, .scale = {9, 9, 9}});
    fixture_look(&f, turned(mu_normalise(mu_v3(0.5f, -0.4f, 0.5f)), surroundings), mu_v3(0, 0, 1));
    fixture_ready(&f);
    fixture_pixels(&f, seed, REPLICAS, SAMPLES, out);
    fixture_end(&f);
}

static void plate(const char *base, turns how, uint64_t seed, moments *out) {
    char json[512];
    snprintf(json, sizeof json,
             "{\"material\": \"musurf.microfacet\", %s, \"fresnel\": \"none\", \"transform\": [[%.17g, "
             "%.17g], [%.17g, "
             "%.17g]]}",
             base, how.m[0], how.m[1], how.m[2], how.m[3]);
    picture(json, fixture_turn(how.plate), 9, 9, how.surroundings, seed, out);
}

static void test_turning_everything_changes_nothing(void **state) {
    (void)state;
    const double m[4] = {1, 2, 0, 1};
    for (uint64_t i = 0; i < 3; i++) {
        static moments still[PIXELS], moved[PIXELS];
        turns whole = {angle, angle, {m[0], m[1], m[2], m[3]}}; /* M turns with the plate that carries it */
        turns map = {0, angle, {0}}, frame = {angle, 0, {0}};
        turned_map(m, (double)angle, map.m); /* the plate's frame stays, so M is turned in it */
        turned_map(m, -(double)angle,
                   frame.m); /* only the frame turns, and M back in it: nothing has moved */
        plate(bases[i], (turns){0, 0, {m[0], m[1], m[2], m[3]}}, 1000 * i + 200000, still);
        const turns all[3] = {whole, map, frame};
        for (uint64_t k = 0; k < 3; k++) {
            plate(bases[i], all[k], 1000 * i + 300000 + 100000 * k, moved);
            const double p = p_of_pictures(still, moved, PIXELS);
            print_message("%s, way %d: p = %.3g\n", bases[i], (int)k, p);
            assert_true(p > significance_level());
        }
        /* The comparison can fail: the lights and camera turned, the plate and its M not. */
        plate(bases[i], (turns){0, angle, {m[0], m[1], m[2], m[3]}}, 1000 * i + 600000, moved);
        assert_true(p_of_pictures(still, moved, PIXELS) < significance_level());
    }
}

/* T(u, v) = (u, v + a u) has the constant Jacobian [1 0], [a 1] of the texture square; on a plate twice as
 * wide as high that is [1 0], [a/2 1] of positions, and on one half as wide, turned, still in the plate's own
 * frame, 2 a. */
static void test_jacobian_amounts_to_a_transform(void **state) {
    (void)state;
    const float widths[2] = {12, 8}, heights[2] = {6, 16};
    for (uint64_t i = 0; i < 2; i++) {
        static moments mapped[PIXELS], constant[PIXELS];
        char json[512];
        const double slope = 2 * (double)(heights[i] / widths[i]);
        snprintf(
            json, sizeof json,
            "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"alpha\": 0.2, \"fresnel\": \"none\", "
            "\"transform\": [[%.17g, 0.5], [%.17g, %.17g]]}",
            2.0, 2 * slope, 0.5 * slope + 1);
        const mu_affine turn = fixture_turn(0.3f * (float)i);
        picture(json, turn, widths[i], heights[i], 0, 700000 + 1000 * i, constant);
        picture(
            "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"alpha\": 0.2, \"fresnel\": \"none\", "
            "\"transform\": [[2, 0.5], [0, 1]], \"jacobian\": {\"map\": \"power_shear\", \"amount\": 2, "
            "\"exponent\": 1}}",
            turn, widths[i], heights[i], 0, 800000 + 1000 * i, mapped);
        const double p = p_of_pictures(mapped, constant, PIXELS);
        print_message("jacobian on a plate of %g x %g: p = %.3g\n", (double)widths[i], (double)heights[i], p);
        assert_true(p > significance_level());
    }
}

/* alpha = 0: each sample is the environment in the mirrored direction, whatever M is, and no light is
 * sampled. */
static void test_mirror_shows_the_environment(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, SIDE);
    fixture_rectangle(
        &f, 9, 9, fixture_turn(0.4f),
        fixture_material(&f, "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"alpha\": 0, "
                             "\"fresnel\": \"none\", \"transform\": [[1, 2], [0, 1]]}"));
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}});
    f.scene.camera.kind = MU_PERSPECTIVE;
    f.scene.camera.half_height = 0.3f;
    const mu_vec3 views[3] = {{0.6f, 0, 0.8f}, {-0.6f, 0.48f, 0.64f}, {0, -0.28f, 0.96f}};
    for (int k = 0; k < 3; k++) {
        fixture_look(&f, views[k], mu_v3(0, 1, 0.1f));
        f.scene.camera.position = mu_scale(views[k], 2);
        if (k == 0) fixture_ready(&f);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const mu_radiance out =
                fixture_sample(&f, &(mu_path_options){0}, 13, i % SIDE, i / SIDE, k == 2 ? i : 0);
            mu_random random = mu_random_start(13, i % SIDE, i / SIDE, k == 2 ? i : 0);
            float u[2], expected[3];
            mu_random_pair(&random, u);
            const mu_ray ray = mu_camera_ray(&f.scene.camera, &f.scene.film, i % SIDE, i / SIDE, u);
            mu_studio_radiance(mu_v3(ray.direction.x, ray.direction.y, -ray.direction.z), expected);
            /* Directions off by 5e-7; the sharpest edge climbs 14 * 1.5 / 0.04 per radian. */
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(out.rgb[c] - expected[c]) <= 3e-4f + 1e-5f * expected[c]);
            assert_int_equal(out.rays, 2);
        }
    }
    fixture_end(&f);
}

static void test_strategies_agree(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 4);
    fixture_rectangle(
        &f, 9, 9, fixture_turn(0),
        fixture_material(&f, "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"alpha\": 0.2, "
                             "\"fresnel\": \"none\", \"transform\": [[1, 2], [0, 1]]}"));
    const mu_affine down = {{{1, 0, 0, 1}, {0, -1, 0, 2}, {0, 0, -1, 2}}};
    fixture_light(
        &f, (mu_light){.kind = MU_RECTANGLE_LIGHT, .to_world = down, .size = {2, 2}, .scale = {1, 1, 1}});
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}});
    fixture_look(&f, mu_normalise(mu_v3(-0.2f, -0.6f, 0.5f)), mu_v3(0, 0, 1));
    fixture_ready(&f);
    const mu_path_options options[3] = {{0}, {MU_BSDF_ONLY, 0}, {MU_LIGHT_ONLY, 0}};
    const char *const names[3] = {"both", "BSDF only", "light only"};
    moments m[3];
    for (uint64_t k = 0; k < 3; k++) {
        m[k] = fixture_mean(&f, &options[k], 900000 + 10000 * k, 2000, 4);
        const double mean = m[k].sum / m[k].n;
        print_message("%s: %.6f, relative deviation %.4f\n", names[k], mean,
                      sqrt(m[k].squares / m[k].n - mean * mean) / mean);
    }
    for (int k = 0; k < 3; k++) assert_true(p_of_means(&m[k], &m[(k + 1) % 3], 0) > significance_level());
    fixture_end(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turning_everything_changes_nothing),
        cmocka_unit_test(test_jacobian_amounts_to_a_transform),
        cmocka_unit_test(test_mirror_shows_the_environment),
        cmocka_unit_test(test_strategies_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
