/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_leave.c: a ray that leaves a surface must not meet that surface, at any scale and place, nor may it
 * start noticeably far from it.
 *
 * All shapes here are flat or convex, so a ray on the outer side of a point of one never meets it again: any
 * hit is rounding. Directions go down to 1e-4 of the horizon, spread evenly in the logarithm.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/shapes.h"

enum { RAYS = 4000 };

/* A direction at `cosine` to n, on n's side if that is positive. */
static mu_vec3 leaving(uniform *random, mu_vec3 n, double cosine) {
    const mu_dvec3 z = mu_dnormalise(mu_d3((double)n.x, (double)n.y, (double)n.z)), x = mu_orthogonal(z);
    const mu_dvec3 y = mu_dcross(z, x);
    const double phi = test_between(random, 0, 6.283185307179586), sine = sqrt(1 - cosine * cosine);
    return mu_single(
        mu_dadd(mu_dscale(z, cosine), mu_dadd(mu_dscale(x, sine * cos(phi)), mu_dscale(y, sine * sin(phi)))));
}

/* A ray from outside to somewhere inside the object's unit ball or square. */
static mu_ray arriving(uniform *random, const mu_affine *a, double size, _Bool flat) {
    mu_vec3 inner = mu_scale(test_direction(random), (float)uniform_double(random));
    if (flat) inner.z = 0;
    const mu_vec3 direction = test_direction(random);
    return (mu_ray){mu_sub(mu_affine_point(a, inner), mu_scale(direction, (float)(20 * size))), direction, 0,
                    INFINITY};
}

typedef struct mu_tally {
    uint32_t left, met;
    double worst; /* offset over (distance from the origin + size), where the map is only a scale */
} mu_tally;

static void leave_object(test_scene *s, uniform *random, double size, _Bool mapped, mu_tally *tally) {
    const _Bool flat = s->objects[0].shape == MU_RECTANGLE;
    for (int i = 0; i < RAYS; ++i) {
        const mu_ray ray = arriving(random, &s->objects[0].to_world, size, flat);
        mu_hit hit, again;
        if (!mu_geometry_intersect(s->geometry, &ray, &hit) || hit.object != 0) continue;
        double cosine = exp(test_between(random, log(1e-4), 0));
        if (flat && i & 1) cosine = -cosine; /* both sides of a sheet */
        const mu_ray away = mu_geometry_leave(&hit, leaving(random, hit.ng, cosine), INFINITY);
        ++tally->left;
        if (mu_geometry_intersect(s->geometry, &away, &again) && again.object == 0) ++tally->met;
        const double reach = (double)mu_length(hit.p) + size;
        if (!mapped) tally->worst = fmax(tally->worst, (double)mu_length(mu_sub(away.origin, hit.p)) / reach);
    }
}

/* Linear part: an even scale, or also a random map; translation: none, or ten sizes away. */
static mu_affine place(uniform *random, double scale, _Bool mapped, _Bool moved) {
    mu_affine a = mapped ? test_affine(random, 0) : test_identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) a.row[i][j] *= (float)scale;
        a.row[i][3] = moved ? (float)(scale * test_between(random, -10, 10)) : 0;
    }
    return a;
}

static void check(int shape, _Bool shared, uint64_t seed, double limit) {
    uniform random = {seed};
    mu_tally tally = {0, 0, 0};
    for (double scale = 1e-3; scale < 2e4; scale *= 10)
        for (int kind = 0; kind < 4; ++kind) {
            test_scene s = {0};
            const mu_affine a = place(&random, scale, kind & 1, kind & 2);
            mu_affine away = a;
            if (shape == MU_MESH) s.meshes[s.scene.mesh_count++] = test_globe(40, 20);
            test_add(&s, shape, &a);
            away.row[0][3] += (float)(100 * scale);
            if (shared) test_add(&s, shape, &away);
            test_build(&s);
            leave_object(&s, &random, scale, kind & 1, &tally);
            test_scene_free(&s);
        }
    print_message("left %u times, met itself %u times, offset at most %.2g of distance and size\n",
                  (unsigned)tally.left, (unsigned)tally.met, tally.worst);
    assert_true(tally.left > 40000);
    assert_int_equal(tally.met, 0);
    assert_true(tally.worst < limit);
}

/*
 * Limits, in units of 2^-24 of distance and size, where the map is only a scale: of p's rounding at most 2
 * sqrt(3), of the world-space corners' sqrt(3) times at most 11. A square of side 2 adds 13 E^3 / A = 74, a
 * triangle of the globe (longest edge 0.16, shortest 0.025) 14; an instance 8 |L| |1/L| = 24 for p and again
 * for the translation.
 */
static void test_leaving_rectangles(void **state) {
    (void)state;
    check(MU_RECTANGLE, 0, 11, 100 * 0x1p-24);
}

static void test_leaving_spheres(void **state) {
    (void)state;
    check(MU_SPHERE, 0, 12, 4 * 0x1p-24);
}

static void test_leaving_meshes(void **state) {
    (void)state;
    check(MU_MESH, 0, 13, 40 * 0x1p-24);
}

static void test_leaving_instances(void **state) {
    (void)state;
    check(MU_MESH, 1, 14, 100 * 0x1p-24);
}

/* A ray into a sphere must meet its far side, not the near one again: the chord is 2 r cos. */
static void test_entering_spheres(void **state) {
    uniform random = {15};
    (void)state;
    for (double scale = 1e-3; scale < 2e4; scale *= 10) {
        test_scene s = {0};
        const mu_affine a = place(&random, scale, 0, 0);
        test_add(&s, MU_SPHERE, &a);
        test_build(&s);
        for (int i = 0; i < RAYS; ++i) {
            const mu_ray ray = arriving(&random, &a, scale, 0);
            mu_hit hit, far;
            if (!mu_geometry_intersect(s.geometry, &ray, &hit)) continue;
            const double cosine = exp(test_between(&random, log(1e-2), 0));
            const mu_ray inside = mu_geometry_leave(&hit, leaving(&random, hit.ng, -cosine), INFINITY);
            assert_true(mu_geometry_intersect(s.geometry, &inside, &far));
            const double chord =
                2 * scale * cosine; /* the offset, 2e-7 of the size, takes up to 1 / cosine as much */
            assert_true(fabs((double)far.distance / chord - 1) < 1e-2);
        }
        test_scene_free(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_leaving_rectangles), cmocka_unit_test(test_leaving_spheres),
        cmocka_unit_test(test_leaving_meshes),     cmocka_unit_test(test_leaving_instances),
        cmocka_unit_test(test_entering_spheres),
    };
    return cmocka_run_group_tests_name("leave", tests, NULL, NULL);
}
