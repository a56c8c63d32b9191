/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_integrator.c: path tracing against closed forms, with the template plugin's ideal diffuse material:
 * direct light from every kind of light, the series of an integrating sphere, both strategies alone and
 * together, roulette. Random comparisons: 3 + 6 + 4 + 1.
 */
#include "tests/path_fixture.h"

#include <string.h>

#include "core/render/light_parts.h"

#define PI                       3.14159265358979323846
#define assert_near(a, b, bound) assert_true(fabs((double)(a) - (double)(b)) <= (double)(bound))

static const char *const grey = "{\"material\": \"template.lambert\", \"reflectance\": [0.6, 0.5, 0.25]}";
static const mu_affine flat = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
static const mu_path_options both = {0}, bsdf_only = {MU_BSDF_ONLY, 0}, light_only = {MU_LIGHT_ONLY, 0},
                             independent = {MU_BOTH, 1};

/* A plate facing a directional light: reflectance / pi E cos, the same in every sample, whatever the depth.
 */
static void test_plate_under_a_directional_light(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 4);
    fixture_rectangle(&f, 4, 4, flat, fixture_material(&f, grey));
    fixture_light(
        &f, (mu_light){.kind = MU_DIRECTIONAL, .direction = {0.48f, 0.36f, 0.8f}, .irradiance = {3, 2, 1}});
    f.scene.integrator.depth = 5;
    fixture_look(&f, mu_v3(0.6f, 0, 0.8f), mu_v3(0, 1, 0));
    fixture_ready(&f);
    for (uint32_t i = 0; i < 64; i++) {
        const mu_radiance out = fixture_sample(&f, &both, 1, i % 4, i / 4 % 4, i / 16);
        const double expected[3] = {0.6 / PI * 3 * 0.8, 0.5 / PI * 2 * 0.8, 0.25 / PI * 1 * 0.8};
        for (int c = 0; c < 3; c++)
            assert_near(out.rgb[c], expected[c], 1e-6 * expected[c]); /* some ten roundings */
        assert_true(out.hit && out.normal[2] == 1);
        assert_near(out.albedo[0], 0.6, 1e-6);
        assert_int_equal(out.rays, 3); /* camera, shadow, and one that escapes */
    }
    fixture_end(&f);
}

/* In a constant environment a diffuse plate has its reflectance, without noise: BSDF sampling is exact there.
 */
static void test_plate_in_a_constant_environment(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 4);
    fixture_rectangle(&f, 1, 1, flat, fixture_material(&f, grey));
    fixture_light(&f, (mu_light){.kind = MU_CONSTANT, .scale = {2, 1, 4}});
    f.scene.camera.half_height = 0.25f;
    fixture_ready(&f);
    const mu_path_options *const all[] = {&both, &bsdf_only, &light_only, &independent};
    for (uint32_t i = 0; i < 64; i++) {
        const mu_radiance out = fixture_sample(&f, all[i % 4], 2, i % 4, i / 4 % 4, i);
        assert_near(out.rgb[0], 1.2, 2e-6);
        assert_near(out.rgb[1], 0.5, 1e-6);
        assert_near(out.rgb[2], 1.0, 2e-6);
        assert_int_equal(out.rays, 2);
    }
    fixture_end(&f);
}

/* Irradiance under the centre of a square of side 2a, parallel at height h, both axes centred: the form
 * factor of a differential area to a rectangle (Howell, C-3), four times that of a quarter. */
static double centred_irradiance(double a, double h) {
    const double x = a / h, r = sqrt(1 + x * x);
    return 4 * (x / r * atan(x / r)); /* of radiance 1: pi times the form factor */
}

static void test_plate_under_a_rectangle_light(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 2);
    fixture_rectangle(&f, 1, 1, flat, fixture_material(&f, grey));
    const mu_affine down = {{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 1.5f}}};
    fixture_light(
        &f, (mu_light){.kind = MU_RECTANGLE_LIGHT, .to_world = down, .size = {2, 2}, .scale = {5, 5, 5}});
    f.scene.camera.half_height = 1e-3f;
    fixture_look(&f, mu_v3(0.8f, 0, 0.6f), mu_v3(0, 1, 0)); /* beside the light, which is opaque */
    f.scene.camera.position = mu_v3(1.6f, 0, 1.2f);
    fixture_ready(&f);
    /* Curvature over the picture: irradiance falls by less than (1e-3 / 1.5)^2 of itself. */
    const double truth = 0.6 / PI * 5 * centred_irradiance(1, 1.5);
    const moments m[3] = {fixture_mean(&f, &both, 31, 4000, 4), fixture_mean(&f, &bsdf_only, 4031, 4000, 4),
                          fixture_mean(&f, &light_only, 8031, 4000, 4)};
    agrees(&m[0], truth, 2e-6 * truth, "rectangle light, both strategies");
    agrees(&m[1], truth, 2e-6 * truth, "rectangle light, BSDF only");
    agrees(&m[2], truth, 2e-6 * truth, "rectangle light, light only");
    fixture_end(&f);
}

/* Irradiance, facing +z, of what comes from infinity: by quadrature of what rays that escape are told. */
static double sky_irradiance(const mu_lights *lights) {
    enum { ROWS = 1024, COLUMNS = 2048 };
    double sum = 0;
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            /* Even in z^2, so each cell has the same cosine-weighted solid angle pi / (rows columns). */
            const double z = sqrt((i + 0.5) / ROWS), r = sqrt(1 - z * z), phi = 2 * PI * (j + 0.5) / COLUMNS;
            float radiance[3], pdf;
            mu_lights_escaped(lights, mu_v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z), radiance,
                              &pdf);
            sum += (double)radiance[0];
        }
    return sum * PI / ((double)ROWS * COLUMNS);
}

static void test_strategies_agree_under_several_lights(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 2);
    fixture_rectangle(&f, 1, 1, flat, fixture_material(&f, grey));
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}, .rotation = 0.5f});
    fixture_light(&f,
                  (mu_light){.kind = MU_DIRECTIONAL, .direction = {0.6f, 0, 0.8f}, .irradiance = {1, 1, 1}});
    f.scene.camera.half_height = 0.1f;
    fixture_ready(&f);
    const double truth = 0.6 / PI * (sky_irradiance(f.made) + 0.8);
    const moments m[3] = {fixture_mean(&f, &both, 41, 3000, 8), fixture_mean(&f, &bsdf_only, 3041, 3000, 8),
                          fixture_mean(&f, &light_only, 6041, 3000, 8)};
    /* Quadrature: soft edges of 0.04 in steps of 0.003; the midpoint rule leaves below 1e-5. */
    agrees(&m[0], truth, 1e-5, "studio and sun, both strategies");
    agrees(&m[1], truth, 1e-5, "studio and sun, BSDF only");
    agrees(&m[2], truth, 1e-5, "studio and sun, light only");
    assert_true(p_of_means(&m[0], &m[1], 0) > significance_level());
    assert_true(p_of_means(&m[0], &m[2], 0) > significance_level());
    assert_true(p_of_means(&m[1], &m[2], 0) > significance_level());
    fixture_end(&f);
}

/* Stratified numbers earn their cost: measured, their variance is 4 times smaller here at 16 samples. */
static void test_stratified_numbers_are_quieter(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 1);
    fixture_rectangle(&f, 9, 9, flat, fixture_material(&f, grey));
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}});
    f.scene.camera.half_height = 0.01f;
    fixture_ready(&f);
    const moments m[2] = {fixture_mean(&f, &both, 61, 2000, 16),
                          fixture_mean(&f, &independent, 61, 2000, 16)};
    double variance[2];
    for (int k = 0; k < 2; k++) variance[k] = m[k].squares / m[k].n - pow(m[k].sum / m[k].n, 2);
    print_message("variance of independent / stratified numbers: %.2f\n", variance[1] / variance[0]);
    assert_true(variance[1] > 2 * variance[0]);
    fixture_end(&f);
}

/* A diffuse sphere of reflectance q and radius R, seen from within, holding a small light of flux P: where no
 * direct light falls, scattering order k gives q^k P / (4 pi^2 R^2), for a sphere sees itself evenly. The
 * light hides less than its area / (4 pi R^2) = 8e-6 of each order. */
static void integrating_sphere(uint32_t depth, uint32_t roulette, uint64_t seed,
                               const mu_path_options *options, const char *what) {
    path_fixture f;
    fixture_start(&f, 2);
    fixture_sphere(&f, 1, fixture_material(&f, grey))->two_sided = 1;
    fixture_light(
        &f, (mu_light){
                .kind = MU_RECTANGLE_LIGHT, .to_world = flat, .size = {0.01f, 0.01f}, .scale = {1e4f, 0, 0}});
    f.scene.integrator.depth = depth;
    f.scene.integrator.roulette = roulette;
    f.scene.camera.position = mu_v3(0, 0, -0.2f); /* below the light, which shines upwards */
    f.scene.camera.half_height = 0.3f;
    fixture_ready(&f);
    double truth = 0;
    for (uint32_t k = 2; k <= depth; k++) truth += pow(0.6, k) * PI * 1e4 * 1e-4 / (4 * PI * PI);
    const moments m = fixture_mean(&f, options, seed, 4000, 4);
    agrees(&m, truth, 8e-6 * depth * truth, what);
    fixture_end(&f);
}

static void test_integrating_sphere(void **state) {
    (void)state;
    integrating_sphere(1, 1000, 51, &both, "sphere, depth 1 (dark)");
    integrating_sphere(2, 1000, 4051, &both, "sphere, depth 2");
    integrating_sphere(4, 1000, 8051, &both, "sphere, depth 4");
    integrating_sphere(8, 1, 12051, &both, "sphere, depth 8, roulette at once");
    integrating_sphere(8, 1, 16051, &independent, "sphere, depth 8, independent numbers");
}

/* From behind, an opaque plate is black, and it keeps the light from what lies below. */
static void test_back_is_black_and_blocks(void **state) {
    (void)state;
    for (int sided = 0; sided < 2; sided++) {
        path_fixture f;
        fixture_start(&f, 2);
        const uint32_t material = fixture_material(&f, grey);
        const mu_affine overturned = {{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 1}}};
        fixture_rectangle(&f, 1, 1, overturned, material)->two_sided = sided;
        fixture_rectangle(&f, 8, 8, flat, material);
        fixture_light(&f, (mu_light){.kind = MU_DIRECTIONAL,
                                     .direction = {0.6f, 0, 0.8f},
                                     .irradiance = {(float)PI, (float)PI, (float)PI}});
        f.scene.camera.half_height = 0.1f;
        fixture_ready(&f);
        const mu_radiance above = fixture_sample(&f, &both, 6, 0, 0, 0);
        assert_near(above.rgb[0], sided ? 0.6 * 0.8 : 0, 1e-6);
        assert_true(above.hit);
        f.scene.camera.position = mu_v3(-0.75f, 0, 0.5f); /* in the shadow, and below the plate's height */
        assert_true(fixture_sample(&f, &both, 6, 0, 0, 0).rgb[0] == 0);
        f.scene.camera.position = mu_v3(-2, 0, 0.5f);
        assert_near(fixture_sample(&f, &both, 6, 0, 0, 0).rgb[0], 0.6 * 0.8, 1e-6);
        fixture_end(&f);
    }
}

/* The light itself: its radiance in front, black behind, and no shadow of itself. */
static void test_rectangle_light_is_seen(void **state) {
    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        path_fixture f;
        fixture_start(&f, 2);
        const mu_affine facing = {{{1, 0, 0, 0}, {0, (float)side, 0, 0}, {0, 0, (float)side, 1}}};
        fixture_light(
            &f,
            (mu_light){.kind = MU_RECTANGLE_LIGHT, .to_world = facing, .size = {2, 2}, .scale = {5, 6, 7}});
        f.scene.camera.half_height = 0.5f;
        fixture_ready(&f);
        const mu_radiance out = fixture_sample(&f, &both, 7, 1, 1, 0);
        assert_true(out.rgb[0] == (side > 0 ? 5 : 0) && out.rgb[2] == (side > 0 ? 7 : 0) && out.hit);
        fixture_end(&f);
    }
}

/* Filters: offsets from the pixel's centre follow the box, or the Gaussian of sigma = radius / 3 cut at the
 * radius. */
static void test_filters(void **state) {
    (void)state;
    const mu_camera camera = {.kind = MU_ORTHOGRAPHIC,
                              .right = {1, 0, 0},
                              .up = {0, 1, 0},
                              .forward = {0, 0, -1},
                              .half_height = 4};
    mu_film_settings film = {.width = 8, .height = 8, .filter = MU_FILTER_GAUSSIAN, .filter_radius = 1.5f};
    enum { DRAWS = 200000, RINGS = 20 };
    double seen[RINGS] = {0}, chi2 = 0;
    moments x = {0, 0, 0};
    for (uint32_t i = 0; i < DRAWS; i++) {
        mu_random random = mu_random_start(8, i, 0, 0);
        float u[2];
        mu_random_pair(&random, u);
        const mu_ray ray = mu_camera_ray(&camera, &film, 3, 5, u);
        /* Pixels are 1 wide; the centre of (3, 5) is at (-0.5, -1.5). */
        const double dx = (double)ray.origin.x + 0.5, dy = (double)ray.origin.y + 1.5, r = hypot(dx, dy);
        assert_true(r <= 1.5 + 1e-6);
        const double cdf = -expm1(-r * r / (2 * 0.25)) / -expm1(-4.5);
        seen[(int)fmin(cdf * RINGS, RINGS - 1)]++;
        accumulate(&x, dx);
    }
    for (int k = 0; k < RINGS; k++) chi2 += pow(seen[k] - (double)DRAWS / RINGS, 2) / ((double)DRAWS / RINGS);
    print_message("Gaussian filter: chi^2 %.1f of %d\n", chi2, RINGS - 1);
    assert_true(p_of_chi2(chi2, RINGS - 1) > significance_level());
    film.filter = MU_FILTER_BOX;
    film.filter_radius = 0.5f;
    const float corner[2] = {0, 0.75f};
    const mu_ray ray = mu_camera_ray(&camera, &film, 0, 0, corner);
    assert_near(ray.origin.x, -4, 1e-6);
    assert_near(ray.origin.y, 3.25, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plate_under_a_directional_light),
        cmocka_unit_test(test_plate_in_a_constant_environment),
        cmocka_unit_test(test_plate_under_a_rectangle_light),
        cmocka_unit_test(test_strategies_agree_under_several_lights),
        cmocka_unit_test(test_stratified_numbers_are_quieter),
        cmocka_unit_test(test_integrating_sphere),
        cmocka_unit_test(test_back_is_black_and_blocks),
        cmocka_unit_test(test_rectangle_light_is_seen),
        cmocka_unit_test(test_filters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
