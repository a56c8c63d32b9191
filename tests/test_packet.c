/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_packet.c: rays in packets meet what they meet alone, and paths through a row are those of its pixels.
 *
 * A packet's triangle test rounds differently from a single ray's. Both points lie within mu_hit.error of the
 * plane, so they are no further apart along ng than the two bounds together. Whether an edge is met may
 * differ for a ray within some 1e-6 of it: about 1e-5 of random rays toward a few hundred edges, so at most
 * 10 of the 20,000 here.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "tests/path_fixture.h"
#include "tests/shapes.h"

/* Every shape: a mesh of its own, two instances of a shared one, spheres and rectangles. */
static void build(test_scene *s, uniform *random) {
    *s = (test_scene){.objects = {{.shape = 0}}};
    s->meshes[0] = test_soup(random, 60);
    s->meshes[1] = test_globe(24, 12);
    s->scene.mesh_count = 2;
    for (int i = 0; i < 6; i++) {
        const mu_affine map = test_affine(random, 3);
        const int shapes[] = {MU_MESH, MU_MESH, MU_MESH, MU_SPHERE, MU_SPHERE, MU_RECTANGLE};
        mu_object *object = test_add(s, shapes[i], &map);
        if (i < 3) object->mesh = i > 0;
        object->radius = 1;
        object->size[0] = object->size[1] = 2;
    }
    test_build(s);
}

static void test_rays_in_packets_meet_what_they_meet_alone(void **state) {
    (void)state;
    uniform random = {20261101};
    uint32_t differ = 0, met_alone = 0, traced = 0;
    for (int k = 0; k < 20; k++) {
        test_scene s;
        build(&s, &random);
        for (int n = 0; n < 250; n++) {
            mu_ray rays[MU_PACKET];
            const mu_vec3 from = mu_scale(test_direction(&random), 10);
            const mu_vec3 target = mu_scale(test_direction(&random), 2);
            for (int i = 0; i < MU_PACKET; i++) {
                const mu_vec3 to = mu_add(target, mu_scale(test_direction(&random), n % 2 ? 0.05f : 2));
                rays[i] = (mu_ray){from, mu_normalise(mu_sub(to, from)), 0, n % 3 ? INFINITY : 9};
            }
            const uint32_t active = (uint32_t)(uniform_bits(&random) & 0xff);
            mu_hit hits[MU_PACKET];
            const uint32_t met = mu_geometry_intersect_packet(s.geometry, rays, active, hits);
            const uint32_t dark = mu_geometry_occluded_packet(s.geometry, rays, active);
            assert_int_equal((met | dark) & ~active, 0);
            for (int i = 0; i < MU_PACKET; i++) {
                if (!(active >> i & 1)) continue;
                mu_hit alone;
                const _Bool hit = mu_geometry_intersect(s.geometry, &rays[i], &alone);
                traced++;
                met_alone += hit;
                differ += hit != (met >> i & 1);
                differ += mu_geometry_occluded(s.geometry, &rays[i]) != (dark >> i & 1);
                if (!hit || !(met >> i & 1)) continue;
                if (hits[i].object != alone.object) {
                    differ++;
                    continue;
                }
                const mu_vec3 apart = mu_sub(hits[i].p, alone.p);
                assert_true(fabsf(mu_dot(apart, alone.ng)) <= hits[i].error + alone.error);
            }
        }
        test_scene_free(&s);
    }
    print_message("%u rays, %u met something, %u differ\n", traced, met_alone, differ);
    assert_in_range(met_alone, traced / 10, traced);
    assert_in_range(differ, 0, 10);
}

/* Depth 4 with a shadowing sphere, a lamp and a sky: direct light, bounces and escapes. */
static void test_a_row_is_its_pixels(void **state) {
    (void)state;
    enum { PIXELS = 16, SAMPLES = 32 };
    path_fixture f;
    fixture_start(&f, PIXELS);
    f.scene.integrator.depth = 4;
    const uint32_t material = fixture_material(&f, "{\"material\": \"template.lambert\"}");
    fixture_rectangle(&f, 2, 2, fixture_turn(0), material);
    fixture_sphere(&f, 0.4f, material);
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}});
    fixture_light(&f,
                  (mu_light){.kind = MU_DIRECTIONAL, .direction = {0.6f, 0, 0.8f}, .irradiance = {2, 2, 2}});
    fixture_ready(&f);
    uint32_t differ = 0;
    double sum = 0;
    for (uint32_t y = 0; y < PIXELS; y++)
        for (uint32_t x = 0; x < PIXELS; x += MU_PACKET)
            for (uint32_t sample = 0; sample < SAMPLES; sample++) {
                mu_radiance row[MU_PACKET];
                const uint32_t count = x ? 5 : MU_PACKET; /* the last packet is not full */
                mu_integrator_row(&f.tracer, 3, x, y, count, sample, f.scratch, row);
                for (uint32_t i = 0; i < count; i++) {
                    const mu_radiance one = fixture_sample(&f, &(mu_path_options){0}, 3, x + i, y, sample);
                    assert_int_equal(row[i].hit, one.hit);
                    differ += row[i].rays != one.rays ||
                              !(fabsf(row[i].rgb[0] - one.rgb[0]) <= 1e-3f * (1 + one.rgb[0]));
                    sum += (double)one.rgb[0];
                }
            }
    print_message("%u of %d samples differ\n", differ, PIXELS * 13 * SAMPLES);
    assert_true(sum > 0);
    /* a path whose first hit moved by a rounding may pass another object's edge on the other side */
    assert_in_range(differ, 0, PIXELS * 13 * SAMPLES / 500);
    fixture_end(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rays_in_packets_meet_what_they_meet_alone),
        cmocka_unit_test(test_a_row_is_its_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
