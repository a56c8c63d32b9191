/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_lights.c: rectangles are drawn evenly over their solid angle (chi^2 against its closed form), and
 * E[radiance cos / pdf] is the irradiance that Lambert's polygon formula gives, for one light and for
 * several. Random comparisons: 5 + 5 + 1.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/render/light_parts.h"
#include "tests/moments.h"
#include "tests/significance.h"
#include "tests/uniform.h"

#define PI                       3.14159265358979323846
#define assert_near(a, b, bound) assert_true(fabs((double)(a) - (double)(b)) <= (double)(bound))

static const mu_affine identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/* -------------------------------------------------------------------------------------------- rectangles */

/* Solid angle of [x0,x1] x [y0,y1] at height z > 0: differences of atan(xy / (z r)). */
static double corner_angle(double x, double y, double z) {
    return atan(x * y / (z * sqrt(x * x + y * y + z * z)));
}
static double solid_angle(double x0, double x1, double y0, double y1, double z) {
    return corner_angle(x1, y1, z) - corner_angle(x0, y1, z) - corner_angle(x1, y0, z) +
           corner_angle(x0, y0, z);
}

static const mu_vec3 viewpoints[] = {
    {0, 0, 1}, {0.3f, -0.2f, 0.05f}, {3, 1, 0.5f}, {-2, 4, 0.05f}, {0.9f, 0.7f, 6}};
enum { VIEWPOINTS = sizeof viewpoints / sizeof viewpoints[0] };

static void test_rectangle_samples_are_even_over_its_solid_angle(void **state) {
    (void)state;
    const mu_light light = {
        .kind = MU_RECTANGLE_LIGHT, .to_world = identity, .size = {2, 1.5f}, .scale = {1, 1, 1}};
    mu_rectangle_light rectangle;
    mu_rectangle_light_make(&rectangle, &light);
    uniform random = {9};
    for (int k = 0; k < VIEWPOINTS; k++) {
        enum { DRAWS = 200000, CELLS = 8 };
        const mu_vec3 p = viewpoints[k];
        const double px = (double)p.x, py = (double)p.y, pz = (double)p.z;
        const double whole = solid_angle(-1 - px, 1 - px, -0.75 - py, 0.75 - py, pz);
        double seen[CELLS][CELLS] = {{0}}, chi2 = 0, freedom = -1, rest = 0, rest_expected = 0;
        for (int n = 0; n < DRAWS; n++) {
            const float u[2] = {uniform_float(&random), uniform_float(&random)};
            mu_vec3 w;
            float distance, pdf;
            mu_rectangle_light_sample(&rectangle, p, u, &w, &distance, &pdf);
            assert_near((double)pdf * whole, 1, 1e-5); /* corners rounded to float, seen from 0.05 away */
            assert_true(pdf == mu_rectangle_light_pdf(&rectangle, p, w, distance));
            const double x = px + (double)(w.x * distance), y = py + (double)(w.y * distance);
            assert_near((double)(w.z * distance), -pz, 1e-6 * (1 + pz));
            assert_true(fabs(x) <= 1 + 2e-6 && fabs(y) <= 0.75 + 2e-6);
            const int i = (int)fmin(fmax((x + 1) / 2 * CELLS, 0), CELLS - 1);
            const int j = (int)fmin(fmax((y + 0.75) / 1.5 * CELLS, 0), CELLS - 1);
            seen[i][j]++;
        }
        for (int i = 0; i < CELLS; i++)
            for (int j = 0; j < CELLS; j++) {
                const double x = -1 + 2.0 * i / CELLS - px, y = -0.75 + 1.5 * j / CELLS - py;
                const double expected =
                    DRAWS * solid_angle(x, x + 2.0 / CELLS, y, y + 1.5 / CELLS, pz) / whole;
                if (expected < 5) { /* pooled */
                    rest += seen[i][j];
                    rest_expected += expected;
                    continue;
                }
                chi2 += (seen[i][j] - expected) * (seen[i][j] - expected) / expected;
                freedom++;
            }
        if (rest_expected >= 5) {
            chi2 += (rest - rest_expected) * (rest - rest_expected) / rest_expected;
            freedom++;
        }
        const double p_value = p_of_chi2(chi2, freedom);
        print_message("rectangle from %g %g %g: chi^2 %.1f of %.0f, p = %.3g\n", px, py, pz, chi2, freedom,
                      p_value);
        assert_true(p_value > significance_level());
    }
}

static void test_rectangle_is_one_sided(void **state) {
    (void)state;
    const mu_light light = {
        .kind = MU_RECTANGLE_LIGHT, .to_world = identity, .size = {2, 1}, .scale = {1, 1, 1}};
    mu_rectangle_light rectangle;
    mu_rectangle_light_make(&rectangle, &light);
    const float u[2] = {0.3f, 0.6f};
    const mu_vec3 behind[] = {{0, 0, -1}, {0.2f, 0.1f, 0}, {5, 0, 0}};
    for (int k = 0; k < 3; k++) {
        mu_vec3 w;
        float distance, pdf;
        mu_rectangle_light_sample(&rectangle, behind[k], u, &w, &distance, &pdf);
        assert_true(pdf == 0);
        assert_true(mu_rectangle_light_pdf(&rectangle, behind[k], mu_v3(0, 0, 1), 1) == 0);
    }
}

/* ---------------------------------------------------------------------------------------- irradiance */

/* Irradiance at p, facing n, of a rectangle of radiance 1 wholly above the horizon: Lambert's polygon
 * formula. In double, for it is a small difference of large angles. */
static double polygon_irradiance(const mu_rectangle_light *r, mu_vec3 p, mu_vec3 n) {
    const mu_vec3 d = mu_sub(r->corner, p);
    const double from[3] = {(double)d.x, (double)d.y, (double)d.z},
                 normal[3] = {(double)n.x, (double)n.y, (double)n.z};
    const double x[3] = {(double)r->x.x, (double)r->x.y, (double)r->x.z};
    const double y[3] = {(double)r->y.x, (double)r->y.y, (double)r->y.z};
    double corner[4][3], sum = 0;
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            corner[i][c] = from[c] + (i == 1 || i == 2 ? (double)r->width * x[c] : 0) +
                           (i >= 2 ? (double)r->height * y[c] : 0);
    for (int i = 0; i < 4; i++) {
        const double *a = corner[i], *b = corner[(i + 1) % 4];
        const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
        const double length = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
        const double angle = atan2(length, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
        sum += angle * (cross[0] * normal[0] + cross[1] * normal[1] + cross[2] * normal[2]) / length;
    }
    return fabs(sum) / 2;
}

/* A skewed one is drawn by area, the others by solid angle. */
static void test_rectangle_irradiance(void **state) {
    (void)state;
    const mu_affine places[] = {identity,
                                {{{0.6f, 0, 0.8f, 1}, {0, -1, 0, 2}, {0.8f, 0, -0.6f, 3}}},
                                {{{1, 0.5f, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, -4}}},
                                {{{1, 0, 0, 0}, {0, 0, 1, -2}, {0, -1, 0, 1.1f}}},
                                {{{1e-3f, 0, 0, 0}, {0, 1e-3f, 0, 0}, {0, 0, 1e-3f, -3}}}};
    const mu_vec3 p[] = {
        {0.4f, 0.2f, 1.5f}, {0.5f, 1, -1}, {1, 0.3f, 0.2f}, {0, 0.3f, 0.5f}, {0.2f, 0.1f, 0.4f}};
    const mu_vec3 facing[] = {{0.6f, 0, -0.8f}, {0.3f, 0.2f, 0.93f}, {0, 0, -1}, {0, 0, 1}, {0, 0, -1}};
    uniform random = {10};
    for (int k = 0; k < 5; k++) {
        mu_light light = {
            .kind = MU_RECTANGLE_LIGHT, .to_world = places[k], .size = {2, 1}, .scale = {1, 1, 1}};
        mu_scene scene = {.lights = &light, .light_count = 1};
        mu_error error = {.text = ""};
        mu_lights *lights = mu_lights_build(&scene, &error);
        assert_non_null(lights);
        assert_int_equal(mu_lights_choices(lights), 1);
        mu_rectangle_light rectangle;
        mu_rectangle_light_make(&rectangle, &light);
        const mu_vec3 n = mu_normalise(facing[k]);
        moments m = {0, 0, 0};
        for (int i = 0; i < 200000; i++) {
            const float u[3] = {uniform_float(&random), uniform_float(&random), uniform_float(&random)};
            mu_light_sample sample;
            mu_lights_sample(lights, p[k], u, &sample);
            assert_true(sample.pdf > 0 && !sample.delta);
            float radiance[3], pdf;
            mu_lights_hit(lights, 0, p[k], sample.direction, sample.distance, radiance, &pdf);
            assert_near((double)(pdf / sample.pdf), 1, 1e-5);
            assert_true(radiance[0] == sample.radiance[0]);
            accumulate(&m, (double)(fmaxf(mu_dot(n, sample.direction), 0) / sample.pdf));
        }
        const double truth = polygon_irradiance(&rectangle, p[k], n);
        agrees(&m, truth, 1e-5 * truth, "irradiance of a rectangle");
        mu_lights_free(lights);
    }
}

/* Intensity over squared distance; in the soft edge of a cone 3 t² - 2 t³ of it, nothing outside. */
static void test_point_lights(void **state) {
    (void)state;
    const double degree = 3.14159265358979323846 / 180, edge = cos(30 * degree), soft = 0.5 * (1 - edge);
    const mu_light all[2] = {{.kind = MU_POINT, .position = {1, -2, 3}, .irradiance = {8, 4, 2}, .cone = {-1, 0}},
                             {.kind = MU_POINT,
                              .position = {1, -2, 3},
                              .irradiance = {8, 4, 2},
                              .direction = {0, 0, -1},
                              .cone = {(float)edge, (float)soft}}};
    for (int angle = 0; angle < 180; angle++) {
        const double distance = 0.5 + angle * 0.02, c = cos((angle + 0.5) * degree), s = sin((angle + 0.5) * degree);
        const double t = fmin(fmax((c - edge) / soft, 0), 1), within[2] = {1, t * t * (3 - 2 * t)};
        const mu_vec3 p = mu_v3((float)(1 + distance * s), -2, (float)(3 - distance * c));
        for (int k = 0; k < 2; k++) {
            mu_light_sample sample = {.direction = {0, 0, 1}, .distance = INFINITY};
            mu_point_light_sample(&all[k], p, &sample);
            assert_true((sample.pdf > 0) == (within[k] > 0));
            if (!(within[k] > 0)) continue;
            assert_true(sample.delta && sample.pdf == 1);
            assert_near((double)sample.distance, distance, 1e-5 * distance);
            /* a few roundings of p and of the cosine, which the cubic's slope, 1.5 at most, divides by its width */
            assert_near((double)sample.radiance[1], 4 * within[k] / (distance * distance), (1e-5 + 1e-5 / soft) / (distance * distance));
        }
    }
    mu_light_sample none = {.pdf = 0};
    mu_point_light_sample(&all[0], all[0].position, &none);
    assert_true(none.pdf == 0);
}

/* Several lights at once: whichever is drawn, the mean is the sum of all. */
static void test_choice_of_light_is_accounted_for(void **state) {
    (void)state;
    mu_light all[5] = {{.kind = MU_RECTANGLE_LIGHT,
                        .size = {1, 1},
                        .scale = {3, 3, 3},
                        .to_world = {{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 2}}}},
                       {.kind = MU_DIRECTIONAL, .direction = {0, 0.6f, 0.8f}, .irradiance = {2, 2, 2}},
                       {.kind = MU_CONSTANT, .scale = {0.5f, 0.25f, 1}},
                       {.kind = MU_RECTANGLE_LIGHT,
                        .size = {4, 1},
                        .scale = {0.5f, 0.5f, 0.5f},
                        .to_world = {{{1, 0, 0, 3}, {0, -1, 0, 1}, {0, 0, -1, 5}}}},
                       {.kind = MU_POINT, .position = {0.2f, 0.1f, 2}, .irradiance = {6, 6, 6}, .cone = {-1, 0}}};
    mu_scene scene = {.lights = all, .light_count = 5};
    mu_error error = {.text = ""};
    mu_lights *lights = mu_lights_build(&scene, &error);
    assert_non_null(lights);
    assert_int_equal(mu_lights_choices(lights), 4);
    mu_rectangle_light first, second;
    mu_rectangle_light_make(&first, &all[0]);
    mu_rectangle_light_make(&second, &all[3]);
    const mu_vec3 p = {0.2f, 0.1f, 0}, n = {0, 0, 1};
    const double truth =
        3 * polygon_irradiance(&first, p, n) + 0.5 * polygon_irradiance(&second, p, n) + 2 * 0.8 + 6 / 4.0;
    uniform random = {11};
    moments m = {0, 0, 0};
    for (int i = 0; i < 400000; i++) {
        const float u[3] = {uniform_float(&random), uniform_float(&random), uniform_float(&random)};
        mu_light_sample sample;
        mu_lights_sample(lights, p, u, &sample);
        accumulate(&m, (double)(sample.radiance[0] * sample.direction.z / sample.pdf));
    }
    agrees(&m, truth, 1e-5 * truth, "irradiance of all lights that are drawn");
    /* The constant one is left to BSDF sampling. */
    float radiance[3], pdf;
    mu_lights_escaped(lights, n, radiance, &pdf);
    assert_true(radiance[0] == 0.5f && radiance[1] == 0.25f && radiance[2] == 1 && pdf == 0);
    mu_lights_free(lights);
}

static void test_dark_and_empty_scenes_have_nothing_to_draw(void **state) {
    (void)state;
    mu_light dark[2] = {
        {.kind = MU_DIRECTIONAL, .direction = {0, 0, 1}},
        {.kind = MU_RECTANGLE_LIGHT, .to_world = identity, .size = {0, 1}, .scale = {1, 1, 1}}};
    for (uint32_t count = 0; count <= 2; count++) {
        mu_scene scene = {.lights = dark, .light_count = count};
        mu_error error = {.text = ""};
        mu_lights *lights = mu_lights_build(&scene, &error);
        assert_non_null(lights);
        assert_int_equal(mu_lights_choices(lights), 0);
        const float u[3] = {0.5f, 0.5f, 0.5f};
        mu_light_sample sample;
        mu_lights_sample(lights, mu_v3(0, 0, 0), u, &sample);
        assert_true(sample.pdf == 0);
        float radiance[3], pdf;
        mu_lights_escaped(lights, mu_v3(0, 0, 1), radiance, &pdf);
        assert_true(radiance[0] == 0 && pdf == 0);
        mu_lights_free(lights);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangle_samples_are_even_over_its_solid_angle),
        cmocka_unit_test(test_rectangle_is_one_sided),
        cmocka_unit_test(test_rectangle_irradiance),
        cmocka_unit_test(test_point_lights),
        cmocka_unit_test(test_choice_of_light_is_accounted_for),
        cmocka_unit_test(test_dark_and_empty_scenes_have_nothing_to_draw),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
