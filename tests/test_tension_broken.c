/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_tension_broken.c: meshes as bad as they come. Whatever their triangles, all M are finite with a positive
 * determinant, the same again when computed again, and points' M are within the range of those of the triangles.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/tension/stretch.h"
#include "core/tension/tension.h"
#include "tests/shapes.h"
#include "tests/uniform.h"

enum { VERTICES = 24, TRIANGLES = 40 };

typedef struct broken {
    uint32_t corner[3 * TRIANGLES];
    double rest[3 * VERTICES], deformed[3 * VERTICES], rest_uv[6 * TRIANGLES], deformed_uv[6 * TRIANGLES];
} broken;

static double pick(uniform *random, double size) {
    const double kind = test_between(random, 0, 10);
    if (kind < 2) return 0;
    if (kind < 4) return size * floor(test_between(random, -2, 3));
    if (kind < 4.5) return size * 1e-7 * test_between(random, -1, 1);
    return size * test_between(random, -1, 1);
}

/* Triangles of any vertices, some twice the same, on a few places, in all sizes, with textures that lack numbers. */
static void make_broken(broken *b, uniform *random) {
    const double size = exp(test_between(random, -40, 20)), other = size * exp(test_between(random, -8, 8));
    const _Bool flat = test_between(random, 0, 1) < 0.3, same = test_between(random, 0, 1) < 0.3;
    for (size_t i = 0; i < 3 * VERTICES; i++) {
        b->rest[i] = flat && i % 3 == 2 ? 0 : pick(random, size);
        b->deformed[i] = pick(random, other);
    }
    for (size_t i = 0; i < 3 * TRIANGLES; i++)
        b->corner[i] = (uint32_t)test_between(random, 0, VERTICES - 1e-6);
    for (size_t i = 0; i < 6 * TRIANGLES; i++) {
        b->rest_uv[i] = test_between(random, 0, 60) < 1 ? (double)NAN : pick(random, 1);
        b->deformed_uv[i] = same ? b->rest_uv[i] : pick(random, 1);
    }
}

static mu_tension *tension_of(const broken *b, int textures) {
    const mu_tension_input input = {.vertices = VERTICES,
                                    .triangles = TRIANGLES,
                                    .corner = b->corner,
                                    .rest = b->rest,
                                    .deformed = b->deformed,
                                    .rest_uv = textures & 1 ? b->rest_uv : NULL,
                                    .deformed_uv = textures & 2 ? b->deformed_uv : NULL};
    mu_tension *tension = mu_tension_make(&input);
    assert_non_null(tension);
    return tension;
}

/* Range of singular values, which must be positive and finite. */
static void widen(const double *m, double range[2]) {
    for (int k = 0; k < 4; k++) assert_true(isfinite(m[k]));
    const mu_stretch_axes axes = mu_stretch_axes_of(m);
    assert_true(axes.least > 0 && isfinite(axes.most));
    range[0] = fmin(range[0], axes.least), range[1] = fmax(range[1], axes.most);
}

static void test_anything(void **state) {
    uniform random = {2026};
    broken *b = malloc(sizeof *b);
    (void)state;
    assert_non_null(b);
    for (int trial = 0; trial < 4000; trial++) {
        double faces[2] = {1, 1}, points[2] = {1, 1};
        make_broken(b, &random);
        mu_tension *tension = tension_of(b, trial % 4), *again = tension_of(b, trial % 4);
        for (size_t t = 0; t < TRIANGLES; t++) widen(tension->face + 4 * t, faces);
        for (uint32_t p = 0; p < tension->points; p++) {
            widen(tension->point[p].m, points);
            assert_memory_equal(tension->point[p].m, again->point[p].m, sizeof again->point[p].m);
        }
        /* log U is within the farthest triangle's of the mean of the triangles: its eigenvalues are within their width */
        const double width = log(faces[1] / faces[0]);
        assert_true(log(points[1] / faces[1]) <= 2 * width + 1e-6 &&
                    log(faces[0] / points[0]) <= 2 * width + 1e-6);
        assert_memory_equal(&tension->counts, &again->counts, sizeof again->counts);
        mu_tension_free(tension);
        mu_tension_free(again);
    }
    free(b);
}

/* A cone of very many triangles, each with its own texture coordinates at the tip: all pairs of them would take hours.
 * Twice as large, it has M = 2 everywhere, to what rounding needles of 6e-5 leaves of it. */
static void test_crowded_tips(void **state) {
    enum { AROUND = 100000 };
    const double turn = 2 * acos(-1.0) / AROUND;
    uint32_t *corner = malloc(3 * AROUND * sizeof *corner);
    double *rest = malloc(3 * (AROUND + 1) * sizeof *rest),
           *deformed = malloc(3 * (AROUND + 1) * sizeof *deformed), *uv = malloc(6 * AROUND * sizeof *uv);
    (void)state;
    assert_true(corner && rest && deformed && uv);
    for (int sharp = 0; sharp < 2; sharp++) {
        for (size_t i = 0; i <= AROUND; i++) {
            const double angle = turn * (double)i, p[3] = {cos(angle), sin(angle), 0},
                         tip[3] = {0, 0, sharp ? 9 : 0.5};
            memcpy(rest + 3 * i, i < AROUND ? p : tip, sizeof p);
        }
        for (size_t i = 0; i < 3 * (AROUND + 1); i++) deformed[i] = 2 * rest[i];
        for (uint32_t i = 0; i < AROUND; i++) {
            const double uvs[6] = {i, 0, i + 1, 0, i + 0.5, 1};
            const uint32_t corners[3] = {i, (i + 1) % AROUND, AROUND};
            memcpy(corner + 3 * (size_t)i, corners, sizeof corners);
            memcpy(uv + 6 * (size_t)i, uvs, sizeof uvs);
        }
        mu_tension *tension =
            mu_tension_make(&(mu_tension_input){AROUND + 1, AROUND, corner, rest, deformed, uv, uv});
        assert_non_null(tension);
        for (uint32_t p = 0; p < tension->points; p++)
            for (int k = 0; k < 4; k++) assert_true(fabs(tension->point[p].m[k] - (k % 3 ? 0 : 2)) < 1e-9);
        mu_tension_free(tension);
    }
    free(corner);
    free(rest);
    free(deformed);
    free(uv);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_anything), cmocka_unit_test(test_crowded_tips)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
