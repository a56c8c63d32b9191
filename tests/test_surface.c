/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_surface.c: the kernels of core/surface against brute force: ranks, quantiles, pyramid, caster. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/surface/caster.h"
#include "core/surface/noise.h"
#include "core/surface/quantile.h"
#include "core/surface/rank.h"

static const double pi = 3.14159265358979323846;

/* The densities as DESIGN and the papers state them: D(theta), 1/sr. */
static double density(const mu_slope_law *law, double r) {
    const double a2 = law->alpha * law->alpha, c2 = 1 / (1 + r * r), g = law->gamma;
    switch (law->kind) {
    case MU_SLOPE_BECKMANN:
        return exp(-r * r / a2) / (pi * a2 * c2 * c2);
    case MU_SLOPE_GGX:
        return a2 / (pi * pow(c2 * (a2 - 1) + 1, 2));
    case MU_SLOPE_GTR: {
        const double k = g == 1 ? (a2 - 1) / log(a2) : (g - 1) * (a2 - 1) / (1 - pow(a2, 1 - g));
        return k / (pi * pow(1 + (a2 - 1) * c2, g));
    }
    case MU_SLOPE_STD:
        return pow(g - 1, g) * pow(law->alpha, 2 * g - 2) / (pi * c2 * c2 * pow((g - 1) * a2 + r * r, g));
    case MU_SLOPE_PHONG:
        return (law->exponent + 2) / (2 * pi) * pow(c2, law->exponent / 2);
    case MU_SLOPE_SHEEN:
        return (2 + 1 / law->alpha) * pow(1 - c2, 0.5 / law->alpha) / (2 * pi);
    }
    return 0;
}

static const mu_slope_law laws[] = {
    {MU_SLOPE_BECKMANN, 0.3, 0, 0}, {MU_SLOPE_GGX, 0.3, 0, 0},   {MU_SLOPE_GTR, 0.3, 1, 0},
    {MU_SLOPE_GTR, 0.3, 1.5, 0},    {MU_SLOPE_GTR, 0.3, 3, 0},   {MU_SLOPE_GTR, 0.8, 0.5, 0},
    {MU_SLOPE_GTR, 0.05, 12, 0},    {MU_SLOPE_STD, 0.3, 1.6, 0}, {MU_SLOPE_STD, 0.5, 3, 0},
    {MU_SLOPE_PHONG, 0, 0, 20},     {MU_SLOPE_PHONG, 0, 0, 0.5}, {MU_SLOPE_SHEEN, 0.3, 0, 0},
};
enum { LAWS = sizeof laws / sizeof laws[0] };

/* The share's derivative is 2 pi r D cos^4; central differences of relative step 1e-4 err by 1e-8 times the third
 * derivative's scale, some 10 here, and by 1e-12 of rounding. */
static void shares_integrate_the_density(void **state) {
    (void)state;
    for (int k = 0; k < LAWS; k++) {
        assert_null(mu_slope_trouble(&laws[k]));
        for (double u = 0.02; u < 0.99; u += 0.0473) {
            const double r = mu_slope_quantile(&laws[k], u), step = 1e-4 * r;
            const double slope =
                (mu_slope_share(&laws[k], r + step) - mu_slope_share(&laws[k], r - step)) / (2 * step);
            const double wanted = 2 * pi * r * density(&laws[k], r) / pow(1 + r * r, 2);
            assert_true(fabs(slope / wanted - 1) < 1e-6);
        }
    }
}

static void quantiles_invert_shares(void **state) {
    (void)state;
    static const double u[] = {0, 1e-12, 1e-3, 0.25, 0.5, 0.9, 0.9999, 1 - 1e-9};
    for (int k = 0; k < LAWS; k++) {
        assert_true(mu_slope_quantile(&laws[k], 0) == 0);
        for (int i = 1; i < 8; i++) {
            const double back = mu_slope_share(&laws[k], mu_slope_quantile(&laws[k], u[i]));
            /* Near 1 the share itself has an ulp of 1e-16; elsewhere a few roundings, magnified by exponents to 25. */
            assert_true(fabs(back - u[i]) < 1e-13 * fmax(u[i], 1e-300) + 3e-16);
        }
    }
    assert_non_null(mu_slope_trouble(&(mu_slope_law){MU_SLOPE_GTR, 1.2, 2, 0}));
    assert_non_null(mu_slope_trouble(&(mu_slope_law){MU_SLOPE_STD, 0.3, 1.5, 0}));
    assert_non_null(mu_slope_trouble(&(mu_slope_law){MU_SLOPE_GGX, (double)NAN, 0, 0}));
}

static void ranks(void **state) {
    (void)state;
    enum { COUNT = 5000 };
    mu_ranked *items = malloc(COUNT * sizeof *items), *spare = malloc(COUNT * sizeof *spare);
    for (uint32_t k = 0; k < COUNT; k++) /* with equal ones and zeros among them */
        items[k] = (mu_ranked){(float)floor(exp(12 * mu_noise_uniform(1, k))) - 1, k};
    mu_rank_sort(items, spare, COUNT);
    for (uint32_t k = 1; k < COUNT; k++) {
        assert_true(items[k - 1].key <= items[k].key);
        if (items[k - 1].key == items[k].key) assert_true(items[k - 1].index < items[k].index);
    }
    free(items);
    free(spare);
}

static double *rough(uint32_t n, double height, uint64_t seed) {
    double *h = malloc((size_t)n * n * sizeof *h);
    for (size_t k = 0; k < (size_t)n * n; k++) h[k] = (double)(float)(height * mu_noise_normal(seed, k));
    return h;
}

static void pyramid_bounds(void **state) {
    (void)state;
    const uint32_t sizes[] = {2, 7, 16, 37};
    for (int k = 0; k < 4; k++) {
        const uint32_t n = sizes[k];
        double *h = rough(n, 1, 5);
        const mu_heightfield f = {h, n, n};
        mu_pyramid p;
        assert_true(mu_pyramid_make(&p, &f));
        for (uint64_t trial = 0; trial < 300; trial++) {
            int64_t c[4];
            for (uint64_t q = 0; q < 4; q++) c[q] = (int64_t)(90 * mu_noise_uniform(6, 4 * trial + q)) - 45;
            const int64_t i0 = c[0], i1 = i0 + (c[1] + 45) / 3, j0 = c[2], j1 = j0 + (c[3] + 45) / 3;
            double most = -INFINITY;
            for (int64_t i = i0; i <= i1; i++)
                for (int64_t j = j0; j <= j1; j++)
                    most = fmax(most, h[((i % n + n) % n) * n + (j % n + n) % n]);
            assert_true(mu_pyramid_most(&p, i0, i1, j0, j1) >= most);
            if (i1 - i0 < 3 && j1 - j0 < 3)
                assert_true(mu_pyramid_most(&p, i0, i1, j0, j1) == most); /* single vertices */
        }
        mu_pyramid_free(&p);
        free(h);
    }
}

/* ----------------------------------------------------------------------------------------------- brute force */

static void baked(const mu_heightfield *f, const double m[4], int64_t i, int64_t j, double p[3]) {
    const int64_t n = f->nx;
    p[0] = m[0] * (double)i + m[1] * (double)j;
    p[1] = m[2] * (double)i + m[3] * (double)j;
    p[2] = f->h[((i % n + n) % n) * n + (j % n + n) % n];
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Moeller and Trumbore, 1997. */
static _Bool meets(const double o[3], const double d[3], const double p[3][3]) {
    double e1[3], e2[3], s[3], h[3], q[3];
    for (int k = 0; k < 3; k++) e1[k] = p[1][k] - p[0][k], e2[k] = p[2][k] - p[0][k], s[k] = o[k] - p[0][k];
    cross(d, e2, h);
    const double a = dot(e1, h);
    if (a == 0) return 0;
    const double u = dot(s, h) / a;
    cross(s, e1, q);
    const double v = dot(d, q) / a, t = dot(e2, q) / a;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0;
}

/* All triangles of all periods that a ray can reach, each on its own: no walk, no lattice, only baked vertices. */
static _Bool sees(const mu_heightfield *f, const mu_sight *s, uint32_t i, uint32_t j, int64_t around) {
    static const int corner[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 1}, {0, 1}, {1, 0}}};
    double p[3][3], o[3], normal[3], a[3], b[3];
    for (int k = 0; k < 3; k++)
        baked(f, s->m, (int64_t)i + corner[s->upper][k][0], (int64_t)j + corner[s->upper][k][1], p[k]);
    const double wb = s->upper ? 1 - s->u : s->u, wc = s->upper ? 1 - s->v : s->v;
    for (int k = 0; k < 3; k++) {
        a[k] = p[1][k] - p[0][k], b[k] = p[2][k] - p[0][k];
        o[k] = p[0][k] + wb * a[k] + wc * b[k];
    }
    cross(a, b, normal);
    if (!((normal[2] < 0 ? -1 : 1) * dot(normal, s->w) > 0)) return 0;
    const int64_t n = f->nx;
    for (int64_t x = -around * n; x < (around + 1) * n; x++)
        for (int64_t y = -around * n; y < (around + 1) * n; y++)
            for (int upper = 0; upper < 2; upper++) {
                if (x == i && y == j && upper == s->upper) continue;
                for (int k = 0; k < 3; k++)
                    baked(f, s->m, x + corner[upper][k][0], y + corner[upper][k][1], p[k]);
                if (meets(o, s->w, (const double(*)[3])p)) return 0;
            }
    return 1;
}

static const double maps[][4] = {{1, 0, 0, 1},          {5, 0, 0, 1},          {1, 2, 0, 1},
                                 {0.8, 0.5, 0.3, -1.2}, {0.6, -0.8, 0.8, 0.6}, {6.1, 7.9, 0.05, 0.08}};
enum { MAPS = sizeof maps / sizeof maps[0] };

/* Bit for bit: a ray that passes an edge so closely that rounding decides does not happen among these. */
static void caster_equals_brute_force(void **state) {
    (void)state;
    const uint32_t n = 11; /* not a multiple of the lanes */
    double *h = rough(n, 0.8, 7);
    const mu_heightfield f = {h, n, n};
    mu_caster *caster = mu_caster_make(&f);
    uint8_t visible[16];
    int seen = 0, hidden = 0;
    for (int map = 0; map < MAPS; map++)
        for (uint64_t k = 0; k < 8; k++) {
            const double *m = maps[map];
            mu_sight s = {.m = {m[0], m[1], m[2], m[3]}, .upper = (int)(k % 2)};
            /* Original views of tan theta up to 3, carried by M: heights of +-3 reach over 18 cells, two periods. */
            const double turn = 2 * pi * mu_noise_uniform(8, 3 * k),
                         tangent = 3 * mu_noise_uniform(8, 3 * k + 1);
            const double x = tangent * cos(turn), y = tangent * sin(turn);
            s.w[0] = m[0] * x + m[1] * y, s.w[1] = m[2] * x + m[3] * y, s.w[2] = 1;
            s.u = s.upper ? 0.75 : 0.25, s.v = 0.5;
            if (k >= 4) { /* any other point, too */
                const double u = mu_noise_uniform(9, k), v = (1 - u) * mu_noise_uniform(10, k);
                s.u = s.upper ? 1 - u : u, s.v = s.upper ? 1 - v : v;
            }
            mu_cast *cast;
            assert_int_equal(mu_cast_make(&cast, caster, &s), MU_WALK_OK);
            for (uint32_t i = 0; i < n; i++) {
                mu_cast_row(cast, i, visible);
                for (uint32_t j = 0; j < n; j++) {
                    const _Bool truth = sees(&f, &s, i, j, 2);
                    assert_int_equal(visible[j], truth);
                    if (truth) assert_true(mu_caster_sees(caster, &s, i, j));
                    seen += truth, hidden += !truth;
                }
            }
            mu_cast_free(cast);
        }
    assert_true(seen > 1000 && hidden > 1000);
    mu_caster_free(caster);
    free(h);
}

/* One ray at a time and sixteen at once agree; long walks over many periods, skipping included. */
static void single_rays_equal_rows(void **state) {
    (void)state;
    const uint32_t n = 50;
    double *h = rough(n, 1.5, 11);
    const mu_heightfield f = {h, n, n};
    mu_caster *caster = mu_caster_make(&f);
    uint8_t visible[50];
    for (int k = 0; k < 6; k++) {
        const double *m = maps[k];
        const double x = 6 * cos(k + 0.3), y = 60 * sin(k + 0.3);
        const mu_sight s = {.m = {m[0], m[1], m[2], m[3]},
                            .w = {m[0] * x + m[1] * y, m[2] * x + m[3] * y, 1},
                            .u = k % 2 ? 0.75 : 0.25,
                            .v = 0.5,
                            .upper = k % 2};
        mu_cast *cast;
        assert_int_equal(mu_cast_make(&cast, caster, &s), MU_WALK_OK);
        for (uint32_t i = 0; i < n; i++) {
            mu_cast_row(cast, i, visible);
            for (uint32_t j = 0; j < n; j++) {
                double slope[2];
                mu_facet_slope(&f, i, j, s.upper, slope);
                const _Bool faces = mu_facet_facing(m, slope, s.w) > 0;
                assert_int_equal(visible[j], faces && mu_caster_sees(caster, &s, i, j));
            }
        }
        mu_cast_free(cast);
    }
    mu_caster_free(caster);
    free(h);
}

/* Heights moved by whole cells, over the border of the period, move the bits and change none: the numbers in every
 * comparison are the same. */
static void periodic(void **state) {
    (void)state;
    const uint32_t n = 24;
    double *h = rough(n, 1, 12), *moved = malloc((size_t)n * n * sizeof *moved);
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) moved[(i + 5) % n * n + (j + 17) % n] = h[i * n + j];
    const mu_heightfield f = {h, n, n}, g = {moved, n, n};
    mu_caster *a = mu_caster_make(&f), *b = mu_caster_make(&g);
    const mu_sight s = {.m = {1, 2, 0, 1}, .w = {3, 1, 1}, .u = 0.25, .v = 0.5};
    mu_cast *ca, *cb;
    uint8_t row[24], other[24];
    assert_int_equal(mu_cast_make(&ca, a, &s), MU_WALK_OK);
    assert_int_equal(mu_cast_make(&cb, b, &s), MU_WALK_OK);
    for (uint32_t i = 0; i < n; i++) {
        mu_cast_row(ca, i, row);
        mu_cast_row(cb, (i + 5) % n, other);
        for (uint32_t j = 0; j < n; j++) assert_int_equal(row[j], other[(j + 17) % n]);
    }
    mu_cast_free(ca), mu_cast_free(cb), mu_caster_free(a), mu_caster_free(b);
    free(h), free(moved);
}

static void horizon_and_zenith(void **state) {
    (void)state;
    double *h = rough(8, 1, 13), flat[16] = {0};
    const mu_heightfield f = {h, 8, 8}, level = {flat, 4, 4};
    mu_caster *caster = mu_caster_make(&f), *plain = mu_caster_make(&level);
    mu_sight s = {.m = {1, 0, 0, 1}, .w = {0, 0, 1}, .u = 0.25, .v = 0.5};
    mu_cast *cast;
    uint8_t row[8];
    assert_int_equal(mu_cast_make(&cast, caster, &s), MU_WALK_OK);
    mu_cast_row(cast, 3, row);
    for (int j = 0; j < 8; j++)
        assert_int_equal(row[j], 1); /* from straight above all of a heightfield is seen */
    mu_cast_free(cast);
    s.w[0] = 1, s.w[2] = 1e-9;
    assert_int_equal(mu_cast_make(&cast, caster, &s), MU_WALK_TOO_LONG);
    assert_int_equal(mu_cast_make(&cast, plain, &s), MU_WALK_OK); /* over a plain nothing stands in the way */
    mu_cast_row(cast, 1, row);
    for (int j = 0; j < 4; j++) assert_int_equal(row[j], 1);
    mu_cast_free(cast), mu_caster_free(caster), mu_caster_free(plain);
    free(h);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_integrate_the_density),
        cmocka_unit_test(quantiles_invert_shares),
        cmocka_unit_test(ranks),
        cmocka_unit_test(pyramid_bounds),
        cmocka_unit_test(caster_equals_brute_force),
        cmocka_unit_test(single_rays_equal_rows),
        cmocka_unit_test(periodic),
        cmocka_unit_test(horizon_and_zenith),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
