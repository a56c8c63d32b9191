/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_footprint.c: the footprint at a hit is what a pixel's rays meet, by finite differences of the camera's own rays; a
 * mirror passes it on unchanged; a rough bounce opens it; flakes seen through it average to the smooth picture, the sooner
 * the larger a pixel is. Random comparisons: 3 means, 2 variances.
 */
#include "tests/path_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "core/render/footprint.h"
#include "tests/uniform.h"

static const mu_affine flat = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
static const mu_path_options options = {0};

static const char *const smooth =
    "{\"material\": \"musurf.microfacet\", \"alpha\": 0.3, \"transform\": [[1, 0.5], [0, 1]]}";
static const char *const flakes =
    "{\"material\": \"musurf.microfacet\", \"alpha\": 0.3, \"transform\": [[1, 0.5], [0, 1]], "
    "\"ndf\": \"discrete_ggx\", \"flakes\": {\"density\": 3e7, \"cone\": 0.05}}";

/* Half a pixel to each side in steps of 1/4: central differences, of which the third derivative stays, 1e-3 of the first
 * where a pixel is a hundredth of a radius; float rounding of u and v, 2^-24 in some 0.003, is less. */
static void test_footprints_are_what_pixels_see(void **state) {
    (void)state;
    enum { SIDE = 96 };
    uniform random = {5};
    int met = 0;
    for (int kind = 0; kind < 4; kind++) {
        path_fixture f;
        fixture_start(&f, SIDE);
        const uint32_t material = fixture_material(&f, smooth);
        if (kind / 2)
            fixture_sphere(&f, 0.9f, material);
        else /* sheared: dpdu and dpdv are not orthogonal */
            fixture_rectangle(&f, 3, 2, (mu_affine){{{1, 0.5f, 0, 0}, {0.1f, 1, 0, 0}, {0, 0.2f, 1, 0}}},
                              material);
        fixture_look(&f, mu_normalise(mu_v3(0.5f, -0.3f, 0.9f)), mu_v3(0, 1, 0));
        if (kind % 2) f.scene.camera.kind = MU_PERSPECTIVE, f.scene.camera.half_height = 0.1f;
        fixture_ready(&f);
        for (int n = 0; n < 300; n++) {
            const uint32_t x = (uint32_t)(uniform_bits(&random) % SIDE),
                           y = (uint32_t)(uniform_bits(&random) % SIDE);
            static const float at[5][2] = {
                {0.5f, 0.5f}, {0.25f, 0.5f}, {0.75f, 0.5f}, {0.5f, 0.25f}, {0.5f, 0.75f}};
            mu_hit hit[5];
            mu_ray ray[5];
            _Bool all = 1;
            for (int i = 0; i < 5; i++) {
                ray[i] = mu_camera_ray(&f.scene.camera, &f.scene.film, x, y, at[i]);
                all = all && mu_geometry_intersect(f.geometry, &ray[i], &hit[i]);
            }
            /* not where the sphere turns away, at its poles, or where u begins anew */
            if (!all || mu_dot(hit[0].ng, ray[0].direction) > -0.5f || fabsf(hit[0].uv[1] - 0.5f) > 0.3f ||
                fabsf(hit[0].uv[0] - 0.5f) > 0.45f)
                continue;
            float footprint[6];
            const mu_beam beam = mu_beam_of_pixel(&f.scene.camera, &f.scene.film, hit[0].p);
            mu_footprint_at(&hit[0], ray[0].direction, &beam, footprint);
            assert_memory_equal(footprint, hit[0].uv, sizeof hit[0].uv);
            const double size = hypot(hypot((double)footprint[2], (double)footprint[3]),
                                      hypot((double)footprint[4], (double)footprint[5]));
            for (int k = 0; k < 2; k++) { /* the image's y points downwards */
                assert_true(fabs((double)(hit[2].uv[k] - hit[1].uv[k] - footprint[2 + k])) < 3e-3 * size);
                assert_true(fabs((double)(hit[3].uv[k] - hit[4].uv[k] - footprint[4 + k])) < 3e-3 * size);
            }
            met++;
        }
        fixture_end(&f);
    }
    assert_true(met > 400);
}

static int isfinite_all(const float footprint[6]) {
    int all = 1;
    for (int i = 0; i < 6; i++) all = all && isfinite(footprint[i]);
    return all;
}

static void test_without_texture_coordinates(void **state) {
    (void)state;
    const mu_beam beam = mu_beam_of_cone(0.1f, mu_v3(0, 0, -1));
    mu_hit hit = {.ng = {0, 0, 1}, .uv = {0.3f, 0.4f}, .dpdu = {2, 0, 0}, .dpdv = {0, 4, 0}};
    float footprint[6];
    mu_footprint_at(&hit, mu_v3(0, 0, -1), &beam, footprint);
    /* a square of side 0.1, in a texture of 2 x 4: its half-axes span a quarter of 0.01 / 8 */
    const float area = fabsf(footprint[2] * footprint[5] - footprint[3] * footprint[4]);
    assert_true(fabsf(area * 4 * 8 / 0.01f - 1) < 1e-5f);
    mu_footprint_at(&hit, mu_v3(1, 0, 0), &beam, footprint); /* from the side */
    assert_true(!isfinite_all(footprint));
    hit.dpdu = hit.dpdv = mu_v3(0, 0, 0);
    mu_footprint_at(&hit, mu_v3(0, 0, -1), &beam, footprint);
    assert_true(!isfinite_all(footprint));
}

typedef enum view { DIRECT, MIRRORED, ROUGH } by_way;

/* A plate at the origin seen from a distance of 20 along its normal, or that far by way of something tilted by 45 degrees
 * at half the distance. */
static void look_at_plate(path_fixture *f, const char *material, by_way view, uint32_t pixels) {
    fixture_start(f, pixels);
    fixture_rectangle(f, 8, 8, flat, fixture_material(f, material));
    fixture_light(f, (mu_light){.kind = MU_DIRECTIONAL,
                                .direction = mu_normalise(mu_v3(0.1f, 0.3f, 1)),
                                .irradiance = {1, 1, 1}});
    f->scene.integrator.depth = 2;
    mu_camera *camera = &f->scene.camera;
    fixture_look(f, mu_v3(0, 0, 1), mu_v3(0, 1, 0));
    camera->kind = MU_PERSPECTIVE, camera->half_height = 0.02f, camera->position = mu_v3(0, 0, 20);
    if (view != DIRECT) {
        const float s = 0.70710678f;
        const mu_affine tilted = {{{s, 0, s, 0}, {0, 1, 0, 0}, {s, 0, -s, 10}}}; /* normal (s, 0, -s) */
        fixture_rectangle(
            f, 1, 1, tilted,
            fixture_material(f, view == MIRRORED ? "{\"material\": \"musurf.microfacet\", \"ndf\": \"flat\"}"
                                                 : "{\"material\": \"musurf.microfacet\", \"alpha\": 0.05}"));
        fixture_look(f, mu_v3(1, 0, 0), mu_v3(0, 1, 0));
        camera->position = mu_v3(10, 0, 10);
    }
    fixture_ready(f);
}

/* The picture with flakes over the smooth one, ray by ray: K / E[K]. */
static moments ratios(by_way view, uint32_t pixels) {
    path_fixture with, without;
    moments ratio = {0};
    look_at_plate(&with, flakes, view, pixels), look_at_plate(&without, smooth, view, pixels);
    assert_true(with.tracer.footprints && !without.tracer.footprints);
    for (uint32_t i = 0; i < pixels * pixels; i++) {
        const double few = (double)fixture_sample(&with, &options, 9, i % pixels, i / pixels, 0).rgb[0],
                     many = (double)fixture_sample(&without, &options, 9, i % pixels, i / pixels, 0).rgb[0];
        assert_true(few == (double)fixture_sample(&with, &options, 9, i % pixels, i / pixels, 0).rgb[0]);
        if (many > 0) accumulate(&ratio, few / many);
    }
    fixture_end(&with), fixture_end(&without);
    return ratio;
}

static double variance_of(const moments *m) {
    return m->squares / m->n - m->sum / m->n * (m->sum / m->n);
}

/* Neighbouring pixels share a few flakes at most: their footprints meet where the samples in them are moved. A sample
 * variance of n Poisson numbers of mean k over k² is off by its own sqrt((2 + 1 / k) / n). */
static void test_flakes_average_to_the_smooth_picture(void **state) {
    (void)state;
    const moments small = ratios(DIRECT, 192), large = ratios(DIRECT, 48), mirrored = ratios(MIRRORED, 192);
    agrees(&small, 1, 0, "flakes over smooth");
    agrees(&large, 1, 0, "flakes over smooth, pixels of 16 times the area");
    agrees(&mirrored, 1, 0, "flakes over smooth, in a mirror");
    const double v = variance_of(&small), w = variance_of(&large), m = variance_of(&mirrored);
    const double off_v = v * sqrt((2 + v) / small.n), off_w = w * sqrt((2 + w) / large.n),
                 off_m = m * sqrt((2 + m) / mirrored.n);
    print_message("variance %.3g; %.3g +- %.2g in pixels of 16 times the area; %.3g +- %.2g in a mirror\n", v,
                  w, off_w, m, off_m);
    assert_true(v > 1); /* flake by flake */
    /* 1/16, or less where many flakes share the cells of flakes.h */
    if (w > v / 16) assert_true(p_of_z((w - v / 16) / hypot(off_w, off_v / 16)) > significance_level());
    assert_true(w > v / 40);
    assert_true(p_of_z((m - v) / hypot(off_m, off_v)) > significance_level());
}

/* 2 alpha 10 across against a pixel's 0.008: 14000 times the flakes, all of which neighbours share. In a mirror, a tenth
 * of a flake was counted: 1500 have a spread of 0.026, one number for all. */
static void test_a_rough_bounce_opens_the_footprint(void **state) {
    (void)state;
    const moments rough = ratios(ROUGH, 96);
    print_message("mean %.4f, variance %.3g of %.0f\n", rough.sum / rough.n, variance_of(&rough), rough.n);
    assert_true(rough.n > 1000 && variance_of(&rough) < 0.01 && fabs(rough.sum / rough.n - 1) < 0.05);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_footprints_are_what_pixels_see),
        cmocka_unit_test(test_without_texture_coordinates),
        cmocka_unit_test(test_flakes_average_to_the_smooth_picture),
        cmocka_unit_test(test_a_rough_bounce_opens_the_footprint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
