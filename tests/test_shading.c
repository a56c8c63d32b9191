/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_shading.c: the frame and the map M at a hit, and what happens when a material misbehaves. M from a
 * Jacobian is held to finite differences of the map itself, done on positions.
 */
#include "core/render/shading.h"
#include "tests/path_fixture.h"

#include <string.h>

#define assert_near(a, b, bound) assert_true(fabs((double)(a) - (double)(b)) <= (double)(bound))

static const mu_frame upright = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* The plane patch position(u, v) = base + u dpdu + v dpdv, deformed by T(u, v) = (u, v + amount u^exponent):
 * where does a small step in the tangent plane end up? */
static void deformed_step(const mu_hit *hit, const mu_jacobian *map, const double step[2], double out[2]) {
    const double p[2][2] = {{(double)hit->dpdu.x, (double)hit->dpdv.x},
                            {(double)hit->dpdu.y, (double)hit->dpdv.y}};
    const double det = p[0][0] * p[1][1] - p[0][1] * p[1][0];
    double end[2][2];
    for (int k = 0; k < 2; k++) {
        const double sign = k ? 0.5 : -0.5;
        const double u = (double)hit->uv[0] + sign * (p[1][1] * step[0] - p[0][1] * step[1]) / det;
        const double v = (double)hit->uv[1] + sign * (p[0][0] * step[1] - p[1][0] * step[0]) / det;
        const double moved = v + map->amount * pow(u, map->exponent);
        end[k][0] = p[0][0] * u + p[0][1] * moved;
        end[k][1] = p[1][0] * u + p[1][1] * moved;
    }
    for (int c = 0; c < 2; c++) out[c] = end[1][c] - end[0][c];
}

static void test_jacobian_is_the_derivative_of_the_map(void **state) {
    (void)state;
    const mu_vec3 sides[3][2] = {
        {{1, 0, 0}, {0, 1, 0}}, {{4, 0, 0}, {0, 0.5f, 0}}, {{2, 1, 0}, {-0.5f, 3, 0}}};
    for (int k = 0; k < 3; k++) {
        const mu_hit hit = {.uv = {0.7f, 0.2f}, .dpdu = sides[k][0], .dpdv = sides[k][1]};
        const mu_material material = {.jacobian = {MU_JACOBIAN_POWER_SHEAR, 2, 5},
                                      .transform = {1, 2, -0.5f, 3}};
        float m[4];
        mu_shading_jacobian(&material, &hit, &upright, material.transform, m);
        for (int column = 0; column < 2; column++) {
            const double h = 1e-4;
            const double step[2] = {h * (double)material.transform[column],
                                    h * (double)material.transform[2 + column]};
            double moved[2];
            deformed_step(&hit, &material.jacobian, step, moved);
            /* Central differences: h^2 |step|^2 T''' / 24 ~ 1e-6 here; float rounding of m up to 40. */
            assert_near(m[column], moved[0] / h, 2e-5);
            assert_near(m[2 + column], moved[1] / h, 2e-5);
        }
    }
}

/* On a square plate P is a uniform scale and M = J transform. */
static void test_jacobian_on_a_square_plate(void **state) {
    (void)state;
    const mu_hit hit = {.uv = {0.5f, 0.9f}, .dpdu = {7, 0, 0}, .dpdv = {0, 7, 0}};
    const mu_material material = {.jacobian = {MU_JACOBIAN_POWER_SHEAR, 2, 5}, .transform = {1, 0, 0, 1}};
    float m[4];
    mu_shading_jacobian(&material, &hit, &upright, material.transform, m);
    assert_true(m[0] == 1 && m[1] == 0 && m[3] == 1);
    assert_near(m[2], 10 * 0.0625, 1e-7); /* 10 u^4 */
}

static void test_jacobian_without_usable_coordinates(void **state) {
    (void)state;
    const mu_material shear = {.jacobian = {MU_JACOBIAN_POWER_SHEAR, 2, 5}, .transform = {1, 2, 3, 4}};
    const mu_material root = {.jacobian = {MU_JACOBIAN_POWER_SHEAR, 2, 0.5}, .transform = {1, 2, 3, 4}};
    const mu_hit none = {.uv = {0.5f, 0.5f}},
                 flat = {.uv = {0.5f, 0.5f}, .dpdu = {1, 0, 0}, .dpdv = {2, 0, 0}};
    const mu_hit edge = {.dpdu = {1, 0, 0},
                         .dpdv = {0, 1, 0}}; /* where the slope of the square root is infinite */
    const mu_hit left = {.uv = {-1, 0}, .dpdu = {1, 0, 0}, .dpdv = {0, 1, 0}};
    const mu_material *const materials[4] = {&shear, &shear, &root, &root};
    const mu_hit *const hits[4] = {&none, &flat, &edge, &left};
    for (int k = 0; k < 4; k++) {
        float m[4];
        mu_shading_jacobian(materials[k], hits[k], &upright, materials[k]->transform, m);
        for (int i = 0; i < 4; i++) assert_true(m[i] == (float)(i + 1));
    }
}

/* ----------------------------------------------------------------------------------------------- frames */

static void check_frame(const mu_shading *s) {
    const mu_vec3 b = mu_cross(s->frame.n, s->frame.t);
    assert_near(mu_dot(s->frame.t, s->frame.n), 0, 1e-6);
    assert_near(mu_dot(b, s->frame.b), 1, 1e-6);
    assert_near(mu_length(s->frame.n), 1, 1e-6);
}

static void test_frames(void **state) {
    (void)state;
    path_fixture f;
    fixture_start(&f, 1);
    const uint32_t material = fixture_material(&f, "{\"material\": \"template.lambert\"}");
    mu_object *object = fixture_rectangle(&f, 1, 1, fixture_turn(0), material);
    fixture_ready(&f);
    /* An interpolated normal, 30 degrees off the triangle's own. */
    const mu_vec3 n = {0.5f, 0, 0.8660254f}, ng = {0, 0, 1};
    const mu_hit hit = {
        .ng = ng, .frame = {{0.8660254f, 0, -0.5f}, {0, 1, 0}, n}, .object = 0, .material = material};
    mu_shading s;

    mu_shading_begin(&s, &f.scene, &hit, mu_normalise(mu_v3(0.2f, 0.1f, 0.9f)), NULL, f.scratch);
    assert_true(s.lobes != 0 && s.frame.n.x == n.x && s.ng.z == 1);
    check_frame(&s);

    /* Seen from the front, but from behind the interpolated normal. */
    mu_shading_begin(&s, &f.scene, &hit, mu_normalise(mu_v3(-0.9f, 0.1f, 0.2f)), NULL, f.scratch);
    assert_true(s.lobes != 0 && s.frame.n.z == 1 && s.frame.t.x > 0.9f);
    check_frame(&s);

    /* From behind: black, or turned over about the tangent. */
    mu_shading_begin(&s, &f.scene, &hit, mu_normalise(mu_v3(0.1f, 0.1f, -0.9f)), NULL, f.scratch);
    assert_true(s.lobes == 0);
    object->two_sided = 1;
    mu_shading_begin(&s, &f.scene, &hit, mu_normalise(mu_v3(0.1f, 0.1f, -0.9f)), NULL, f.scratch);
    assert_true(s.lobes != 0 && s.ng.z == -1 && s.frame.t.x == hit.frame.t.x && s.frame.b.y == -1);
    check_frame(&s);

    /* What points above the interpolated normal's horizon but below the surface leaks, and is refused. */
    object->two_sided = 0;
    mu_shading_begin(&s, &f.scene, &hit, mu_normalise(mu_v3(0.2f, 0.1f, 0.9f)), NULL, f.scratch);
    const mu_vec3 below = mu_normalise(mu_v3(0.9f, 0, -0.1f)), above = mu_normalise(mu_v3(-0.9f, 0, 0.1f));
    assert_true(mu_dot(below, n) > 0 && !mu_shading_agrees(&s, below, mu_to_local(&s.frame, below).z));
    assert_true(mu_dot(above, n) < 0 && !mu_shading_agrees(&s, above, mu_to_local(&s.frame, above).z));
    fixture_end(&f);
}

/* ---------------------------------------------------------------------------------- broken materials */

static uint32_t broken_setup(const musurf_material *material, const float wo[3], const float *slots,
                             uint32_t mode, void *closure) {
    (void)material, (void)wo, (void)slots, (void)mode, (void)closure;
    return MUSURF_GLOSSY_REFLECTION;
}
static void broken_eval(const void *closure, const float wi[3], uint32_t lobes, musurf_value *out) {
    (void)closure, (void)wi, (void)lobes;
    *out = (musurf_value){{NAN, 1, 1}, 1, 1, MUSURF_GLOSSY_REFLECTION};
}
static void broken_sample(const void *closure, const float u[3], uint32_t lobes, musurf_sample *out) {
    (void)closure, (void)u, (void)lobes;
    memset(out, 0, sizeof *out);
    out->wi[2] = out->pdf = 1;
    out->weight[0] = INFINITY;
    out->lobe = MUSURF_GLOSSY_REFLECTION;
}
static void broken_albedo(const void *closure, float rgb[3]) {
    (void)closure;
    rgb[0] = rgb[1] = rgb[2] = 0;
}

/* NaN from eval and infinity from sample are counted and kept out of the picture. */
static void test_nothing_broken_reaches_the_film(void **state) {
    (void)state;
    const musurf_material_type broken = {
        .setup = broken_setup, .eval = broken_eval, .sample = broken_sample, .albedo = broken_albedo};
    path_fixture f;
    fixture_start(&f, 1);
    const uint32_t material = fixture_material(&f, "{\"material\": \"template.lambert\"}");
    fixture_rectangle(&f, 4, 4, fixture_turn(0), material);
    fixture_light(&f, (mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}});
    fixture_ready(&f);
    const musurf_material_type *kept = f.materials[material].material.type;
    f.materials[material].material.type = &broken;
    uint32_t refused = 0;
    for (uint32_t sample = 0; sample < 16; sample++) {
        mu_radiance out;
        mu_integrator_row(&f.tracer, 9, 0, 0, 1, sample, f.scratch, &out);
        assert_true(out.rgb[0] == 0 && out.rgb[1] == 0 && out.rgb[2] == 0);
        refused += out.refused;
    }
    assert_true(refused >= 16 && refused <= 32);
    f.materials[material].material.type = kept;
    fixture_end(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jacobian_is_the_derivative_of_the_map),
        cmocka_unit_test(test_jacobian_on_a_square_plate),
        cmocka_unit_test(test_jacobian_without_usable_coordinates),
        cmocka_unit_test(test_frames),
        cmocka_unit_test(test_nothing_broken_reaches_the_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
