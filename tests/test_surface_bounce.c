/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_surface_bounce.c: rays among facets against all triangles one by one, mirrors against V-grooves unfolded by hand,
 * reflectances and ratios against numbers.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/surface/bounce.h"
#include "core/surface/noise.h"
#include "core/surface/ratio.h"
#include "core/surface/reflectance.h"

#define CLOSE(a, b, tolerance) assert_true(fabs((a) - (b)) < (tolerance))

static const double pi = 3.14159265358979323846;
static const double maps[][4] = {{1, 0, 0, 1},          {5, 0, 0, 1},          {1, 2, 0, 1},
                                 {0.8, 0.5, 0.3, -1.2}, {0.6, -0.8, 0.8, 0.6}, {0.2, 0, 0, 1}};
enum { MAPS = sizeof maps / sizeof maps[0] };

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Corners of a triangle of any period; corner 1 is where u is 1 in L and 0 in U. */
static void baked(const mu_mirrors *s, int64_t i, int64_t j, int upper, double p[3][3]) {
    static const int corner[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 1}, {0, 1}, {1, 0}}};
    const int64_t n = s->f.nx;
    for (int k = 0; k < 3; k++) {
        const int64_t a = i + corner[upper][k][0], b = j + corner[upper][k][1];
        p[k][0] = s->m[0] * (double)a + s->m[1] * (double)b;
        p[k][1] = s->m[2] * (double)a + s->m[3] * (double)b;
        p[k][2] = s->f.h[((a % n + n) % n) * n + (b % n + n) % n];
    }
}

static void point(const mu_mirrors *s, const mu_spot *at, double o[3]) {
    double p[3][3];
    baked(s, at->i, at->j, at->upper, p);
    const double b = at->upper ? 1 - at->u : at->u, c = at->upper ? 1 - at->v : at->v;
    for (int k = 0; k < 3; k++) o[k] = p[0][k] + b * (p[1][k] - p[0][k]) + c * (p[2][k] - p[0][k]);
}

/* The distance of the nearest triangle, by Moeller and Trumbore's intersection (1997); infinite: none. */
static double nearest(const mu_mirrors *s, const mu_spot *from, const double o[3], const double d[3],
                      int64_t around, mu_spot *hit) {
    const int64_t n = s->f.nx;
    double best = INFINITY;
    for (int64_t i = -around * n; i < (around + 1) * n; i++)
        for (int64_t j = -around * n; j < (around + 1) * n; j++)
            for (int upper = 0; upper < 2; upper++) {
                double p[3][3], a[3], b[3], h[3], q[3], r[3];
                if (i == from->i && j == from->j && upper == from->upper) continue;
                baked(s, i, j, upper, p);
                for (int k = 0; k < 3; k++)
                    a[k] = p[1][k] - p[0][k], b[k] = p[2][k] - p[0][k], r[k] = o[k] - p[0][k];
                cross(d, b, h);
                const double det = dot(a, h);
                if (det == 0) continue;
                cross(r, a, q);
                const double u = dot(r, h) / det, v = dot(d, q) / det, t = dot(b, q) / det;
                if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < best)) continue;
                best = t;
                *hit = (mu_spot){(uint32_t)((i % n + n) % n), (uint32_t)((j % n + n) % n), upper,
                                 upper ? 1 - u : u, upper ? 1 - v : v};
            }
    return best;
}

/*
 * Every ray ends on the same facet at the same place. Rounding of places is some 1e-16 of a few dozen cells over the sine
 * between ray and facet, 1e-4 at least among these: 1e-10; a spot is moved by 2e-12 at most. Rays that go by an edge so
 * closely that rounding decides do not happen among these.
 */
static void rays_equal_brute_force(void **state) {
    (void)state;
    enum { N = 9, AROUND = 4 };
    double h[N * N];
    for (uint64_t k = 0; k < N * N; k++) h[k] = 0.8 * mu_noise_normal(21, k);
    const mu_heightfield f = {h, N, N};
    int hits = 0, escapes = 0, down = 0;
    for (uint64_t k = 0; k < 3000; k++) {
        const double *m = maps[k % MAPS];
        const mu_mirrors s = mu_mirrors_make(&f, m);
        double u[6], slope[2], normal[3], o[3];
        for (uint64_t c = 0; c < 6; c++) u[c] = mu_noise_uniform(22, 6 * k + c);
        mu_spot spot = {(uint32_t)(N * u[0]), (uint32_t)(N * u[1]), (int)(k / MAPS % 2), u[2],
                        (1 - u[2]) * u[3]};
        if (spot.upper) spot.u = 1 - spot.u, spot.v = 1 - spot.v;
        /* In original space the ray climbs or falls by 0.15 a cell at least: heights of +-3 reach over 40 cells. */
        const double turn = 2 * pi * u[4], climb = 4 * u[5] - 2;
        const double d[3] = {m[0] * cos(turn) + m[1] * sin(turn), m[2] * cos(turn) + m[3] * sin(turn), climb};
        mu_facet_slope(&f, spot.i, spot.j, spot.upper, slope);
        mu_facet_normal(m, slope, normal);
        if (fabs(climb) < 0.15 || dot(d, normal) < 1e-2) continue;
        mu_spot truth = {0}, found = spot;
        point(&s, &spot, o);
        const double t = nearest(&s, &spot, o, d, AROUND, &truth);
        const mu_ray_end end = mu_mirrors_cast(&s, &found, d);
        assert_int_equal(end, isfinite(t) ? MU_RAY_HITS : MU_RAY_ESCAPES);
        down += climb < 0, escapes += !isfinite(t), hits += isfinite(t);
        if (!isfinite(t)) continue;
        assert_int_equal(found.i, truth.i);
        assert_int_equal(found.j, truth.j);
        assert_int_equal(found.upper, truth.upper);
        CLOSE(found.u, truth.u, 1e-9);
        CLOSE(found.v, truth.v, 1e-9);
    }
    assert_true(hits > 200 && escapes > 100 && down > 100);
}

/*
 * V-grooves of half-width a and depth s, unfolded: in the plane across them, with the bottom as the origin and angles
 * from the vertical, the walls are the rays at -b and b, tan b = a/s, of length R. Mirrors continue a path as the straight
 * line through images of the groove: walls at b, 3b, 5b, ... (or their negatives). The line meets the wall at angle phi
 * at p/cos(phi - foot), where p is its distance from the bottom and `foot` the angle of its nearest point; it is a
 * reflection if that is below R, else the ray has left through the mouth. After k reflections the image is the groove
 * turned by 2kb and, for odd k, mirrored: so the line's own direction psi is psi - 2kb, or its negative. What a direction
 * has along the groove stays. M may widen, turn and mirror.
 */
typedef struct groove {
    double a, s, b, length;
} groove;

static uint32_t unfold(const groove *g, const double p[2], const double d[2], double *out) {
    const double psi = atan2(d[0], d[1]); /* from the vertical */
    const double moment =
        p[0] * d[1] - p[1] * d[0]; /* > 0: the line passes the bottom on its right, turning back */
    const double distance = fabs(moment) / hypot(d[0], d[1]);
    const double sense = moment > 0 ? -1 : 1; /* of the angle as the line is followed */
    const double foot = psi - sense * pi / 2; /* where it came from is a quarter turn before */
    uint32_t count = 0;
    /* From the first wall's angle to the foot's, followed on from there: at a quarter turn the line is at infinity. */
    double away = sense * remainder(sense * g->b - foot, 2 * pi);
    for (; (count == 0 || away < pi / 2) && distance / cos(away) <= g->length; away += 2 * g->b) count++;
    const double turned = psi - 2 * sense * count * g->b;
    *out = count % 2 ? -turned : turned;
    return count;
}

static void grooves_unfold(void **state) {
    (void)state;
    enum { N = 8 };
    static const double depths[] = {0.4, 1, 2.3, 6}, tangents[] = {0.05, 0.4, -0.9, 2.7, -6};
    double h[N * N];
    uint32_t most = 0, paths = 0;
    for (int depth = 0; depth < 4; depth++)
        for (int view = 0; view < 5; view++)
            for (uint64_t k = 0; k < 120; k++) {
                const double wide = 0.5 + mu_noise_uniform(31, 3 * k),
                             turn = 2 * pi * mu_noise_uniform(31, 3 * k + 1);
                const double c = cos(turn), s = sin(turn), y = k % 2 ? -1.3 : 0.7; /* k odd: a mirror */
                const double m[4] = {wide * c, -y * s, wide * s, y * c};
                for (size_t at = 0; at < N * N; at++) h[at] = at / N % 2 ? depths[depth] : 0;
                const mu_heightfield f = {h, N, N};
                const mu_mirrors mirrors = mu_mirrors_make(&f, m);
                const groove g = {wide, depths[depth], atan2(wide, depths[depth]),
                                  hypot(wide, depths[depth])};
                /* A point of any triangle; x across the groove from its bottom, at the even columns. */
                const double u = mu_noise_uniform(32, 2 * k), v = (1 - u) * mu_noise_uniform(32, 2 * k + 1);
                const uint32_t column = (uint32_t)(k % N);
                mu_spot spot = {column, (uint32_t)(k / 3 % N), (int)(k / 7 % 2), u, v};
                if (spot.upper) spot.u = 1 - u, spot.v = 1 - v;
                const double x = column % 2 ? spot.u - 1 : spot.u, p[2] = {wide * x, g.s * fabs(x)};
                /* Toward the viewer: across, along, up; seen if it passes the mouth and faces. */
                const double across = tangents[view], along = 0.3 * (double)(k % 5),
                             r = sqrt(across * across + along * along + 1);
                const double exit = p[0] + (g.s - p[1]) * across;
                if (fabs(exit) > wide || (x > 0 ? -g.s * across : g.s * across) + wide <= 0) continue;
                const double w[3] = {(across * c - along * s) / r, (across * s + along * c) / r, 1 / r};
                const double d[2] = {-across / r, -1 / r};
                double angle;
                const uint32_t count = unfold(&g, p, d, &angle);
                mu_mirror_path path;
                mu_mirror_follow(&mirrors, &spot, w, MU_BOUNCES_MOST, &path);
                assert_int_equal(path.end, MU_PATH_ESCAPED);
                assert_int_equal(path.count, count);
                /* Each reflection turns by an angle whose rounding is some 1e-16; 64 of them stay below 1e-13. */
                const double flat = hypot(d[0], d[1]);
                CLOSE(path.out[0] * c + path.out[1] * s, flat * sin(angle), 1e-13);
                CLOSE(-path.out[0] * s + path.out[1] * c, -along / r, 1e-13);
                CLOSE(path.out[2], flat * cos(angle), 1e-13);
                most = count > most ? count : most, paths++;
                if (count < 2) continue;
                mu_mirror_follow(&mirrors, &spot, w, count - 1, &path); /* one fewer is not enough */
                assert_int_equal(path.end, MU_PATH_OVER_LIMIT);
                assert_int_equal(path.count, count - 1);
            }
    assert_true(most > 10 && paths > 500);
}

static void plains_and_zeniths(void **state) {
    (void)state;
    double h[16] = {0};
    const mu_heightfield f = {h, 4, 4};
    const mu_mirrors mirrors = mu_mirrors_make(&f, maps[3]);
    const mu_spot spot = {1, 2, 0, 0.25, 0.5};
    const double views[3][3] = {{0, 0, 1}, {0.6, 0, 0.8}, {1e-20, 0, 1}};
    for (int k = 0; k < 3; k++) {
        mu_mirror_path path;
        mu_mirror_follow(&mirrors, &spot, views[k], 3, &path);
        assert_int_equal(path.end, MU_PATH_ESCAPED);
        assert_int_equal(path.count, 1);
        for (int c = 0; c < 3; c++) CLOSE(path.out[c], (c == 2 ? 1 : -1) * views[k][c], 1e-15);
        CLOSE(path.cosine[0], views[k][2], 1e-15);
    }
}

/* Normal incidence, Brewster's angle (tan = n: no p, s is (n^2-1)/(n^2+1)), total reflection, grazing; Schlick at 60. */
static void reflectances(void **state) {
    (void)state;
    const mu_reflectance glass = {MU_REFLECTS_INDEX, 1, {1.5}, {0}},
                         out = {MU_REFLECTS_INDEX, 1, {1 / 1.5}, {0}};
    const mu_reflectance metal = {MU_REFLECTS_INDEX, 3, {0.2, 1, 2}, {3, 2, 0.5}},
                         none = {MU_REFLECTS_ALL, 1, {0}, {0}};
    const mu_reflectance schlick = {MU_REFLECTS_SCHLICK, 1, {0.04}, {0}};
    CLOSE(mu_reflectance_at(&glass, 0, 1), 0.04, 1e-15);
    CLOSE(mu_reflectance_at(&out, 0, 1), 0.04, 1e-15);
    CLOSE(mu_reflectance_at(&glass, 0, 1 / sqrt(1 + 2.25)), pow(1.25 / 3.25, 2) / 2, 1e-15);
    CLOSE(mu_reflectance_at(&glass, 0, 0), 1, 1e-15);
    CLOSE(mu_reflectance_at(&out, 0, 0.5), 1, 1e-15); /* beyond sin = 1/1.5 */
    for (int c = 0; c < 3; c++) {
        const double n = metal.a[c], k = metal.b[c];
        CLOSE(mu_reflectance_at(&metal, c, 1), ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k),
              1e-15);
    }
    CLOSE(mu_reflectance_at(&schlick, 0, 0.5), 0.04 + 0.96 / 32, 1e-15);
    CLOSE(mu_reflectance_at(&none, 0, 0.3), 1, 1e-15);
}

/* Units with sums 1 of 2, 4 of 4, 1 of 3: 6/9; deviations 1 - 4/3, 4 - 8/3, 1 - 2: squares sum to 26/9;
 * error^2 = 3/2 26/9 / 81. With equal bottoms of 2 for the tops 1, 4, 1: the error of the mean of 1/2, 2, 1/2. */
static void ratios(void **state) {
    (void)state;
    static const double top[] = {1, 4, 1}, bottom[] = {2, 4, 3};
    double same[] = {2, 2, 2};
    mu_ratios own, shared, lone;
    assert_true(mu_ratios_make(&own, 3, 2, NULL) && mu_ratios_make(&shared, 3, 2, same) &&
                mu_ratios_make(&lone, 1, 1, NULL));
    for (size_t k = 0; k < 3; k++) {
        mu_ratios_add_both(&own, k, 1, top[k], bottom[k]);
        mu_ratios_add(&shared, k, 1, top[k]);
    }
    mu_ratios_add_both(&lone, 0, 0, 1, 2);
    CLOSE(mu_ratios_get(&own, 1).value, 2 / 3.0, 1e-15);
    CLOSE(mu_ratios_get(&own, 1).error, sqrt(1.5 * 26 / 9 / 81), 1e-15);
    CLOSE(mu_ratios_get(&shared, 1).value, 1, 1e-15);
    CLOSE(mu_ratios_get(&shared, 1).error, 0.5, 1e-15); /* deviations 1/2, 1, 1/2: 1.5/2/3 */
    assert_true(mu_ratios_get(&shared, 0).value == 0 && mu_ratios_get(&shared, 0).error == 0);
    assert_true(isnan(mu_ratios_get(&own, 0).value) && mu_ratios_get(&lone, 0).value == 0.5 &&
                isnan(mu_ratios_get(&lone, 0).error));
    mu_ratios_free(&own), mu_ratios_free(&shared), mu_ratios_free(&lone);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_equal_brute_force),
        cmocka_unit_test(grooves_unfold),
        cmocka_unit_test(plains_and_zeniths),
        cmocka_unit_test(reflectances),
        cmocka_unit_test(ratios),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
