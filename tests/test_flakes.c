/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_flakes.c: the flakes of flakes.h are points: the same for every question, so that counts of disjoint regions
 * add up; as many in the mean as the model says, over every kind of footprint and cone; spread no wider than a Poisson
 * process; unrelated between places; and counted in bounded time. Random comparisons: 24 means, 22 spreads, 4
 * correlations.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <time.h>
#include <cmocka.h>

#include "core/bsdf/flakes.h"
#include "tests/moments.h"
#include "tests/uniform.h"

static const double pi = 3.14159265358979323846;

static void normal(double theta, double phi, double m[3]) {
    m[0] = sin(theta) * cos(phi), m[1] = sin(theta) * sin(phi), m[2] = cos(theta);
}

/* The box is the cone's sector: for GGX cos(theta)² = 1 - p, so its solid angle is read off p; for Beckmann, X = -ln(1 -
 * p). p loses at most 2^-53 / (1 - p) of 1 - p to its rounding, some ten more for the rest. */
static void test_the_box_has_the_cones_solid_angle(void **state) {
    (void)state;
    const double thetas[] = {0, 1e-5, 0.01, 0.05, 0.0500001, 0.3, 1, 1.4, 1.5},
                 taus[] = {1e-4, 0.003, 0.05, 0.07};
    for (int t = 0; t < 9; t++)
        for (int k = 0; k < 4; k++)
            for (int beckmann = 0; beckmann < 2; beckmann++) {
                const double theta = thetas[t], tau = taus[k], phi = 7 * t + k;
                mu_flake_cdf *cdf = beckmann ? mu_flake_cdf_beckmann : mu_flake_cdf_ggx;
                double m[3], cosine[2];
                normal(theta, phi, m);
                const mu_flake_normals box = mu_flake_cone(cdf, m, tau);
                const double p = cdf(tan(theta) * tan(theta)), turns = phi / (2 * pi) - box.q;
                assert_true(box.p[0] >= 0 && box.p[0] <= p && p <= box.p[1] && box.p[1] <= 1);
                assert_true(box.p[1] - box.p[0] >= 0x1p-41 && box.q_width > 0 && box.q_width <= 1);
                assert_true(box.q >= 0 && box.q <= 1 && turns - floor(turns) <= box.q_width);
                if (theta + tau > pi / 2 || (beckmann && theta > 1.2))
                    continue; /* cut off; below the least size */
                for (int i = 0; i < 2; i++) {
                    const double x = beckmann ? -log1p(-box.p[i]) : box.p[i] / (1 - box.p[i]);
                    cosine[i] = 1 / sqrt(1 + x);
                }
                const double cone = 1 - cos(tau), sector = (cosine[0] - cosine[1]) * box.q_width;
                const double rounding = 16 * 0x1p-53 / (1 - box.p[1]) * box.q_width + 0x1p-52;
                assert_true(fabs(sector - cone) <= rounding);
            }
    /* around the pole all azimuths, in the tail but a few */
    double pole[3] = {0, 0, 1}, nothing[3] = {0, 0, 0}, below[3] = {1, 0, -1};
    assert_true(mu_flake_cone(mu_flake_cdf_ggx, pole, 0.1).q_width == 1);
    assert_true(mu_flake_cone(mu_flake_cdf_ggx, nothing, 0).q_width == 1);
    assert_true(mu_flake_cone(mu_flake_cdf_beckmann, below, 0.1).q_width < 0.1);
}

/* A box of (u, v) as a footprint. */
static void rectangle(double u0, double u1, double v0, double v1, double out[6]) {
    out[0] = (u0 + u1) / 2, out[1] = (v0 + v1) / 2;
    out[2] = (u1 - u0) / 2, out[3] = out[4] = 0, out[5] = (v1 - v0) / 2;
}

static double counted(const mu_flakes *f, const double footprint[6], const mu_flake_normals *box) {
    const mu_flake_tally tally = mu_flake_count(f, footprint, box);
    assert_int_equal(tally.thinning, 0);
    return tally.count;
}

/* Cut at a random place along u, v, p or q, or along the diagonals of a parallelogram, the parts hold what the whole
 * does. Coordinates are multiples of 2^-20, so that centre and half-axes of both sides meet exactly. */
static void test_counts_add_up(void **state) {
    (void)state;
    uniform random = {11};
    double flakes = 0;
    int sheared = 0;
    for (int i = 0; i < 3000; i++) {
        const mu_flakes f = mu_flakes_make(pow(10, 2 + 3 * uniform_double(&random)), 0.3, 5);
        const double size = sqrt(200 / f.density);
        double x[8];
        for (int k = 0; k < 8; k++) x[k] = ldexp(floor(ldexp(uniform_double(&random) * size, 20)), -20);
        for (int k = 0; k < 5; k++)
            x[k] += ldexp(ceil(0x1p20 / sqrt(f.density)), -20); /* no part below a flake */
        const double u[3] = {x[0], x[0] + x[1], x[0] + x[1] + x[2]}, v[2] = {-x[3], x[4]};
        mu_flake_normals box = {{uniform_double(&random) * 0.7, 0}, uniform_double(&random), 0.2}, left,
                         right;
        box.p[1] = box.p[0] + 0.3 * uniform_double(&random);
        box.q_width += i % 3 ? 0.5 * uniform_double(&random) : 0.8;
        double whole[6], part[2][6];
        rectangle(u[0], u[2], v[0], v[1], whole);
        if (mu_flake_count(&f, whole, &box).thinning) continue;
        const double all = counted(&f, whole, &box);
        flakes += all;
        rectangle(u[0], u[1], v[0], v[1], part[0]), rectangle(u[1], u[2], v[0], v[1], part[1]);
        assert_true(counted(&f, part[0], &box) + counted(&f, part[1], &box) == all);
        left = right = box;
        left.p[1] = right.p[0] = box.p[0] + uniform_double(&random) * (box.p[1] - box.p[0]);
        assert_true(counted(&f, whole, &left) + counted(&f, whole, &right) == all);
        left = right = box;
        left.q_width = box.q_width * uniform_double(&random);
        right.q = box.q + left.q_width, right.q_width = box.q_width - left.q_width;
        right.q -= floor(right.q);
        assert_true(counted(&f, whole, &left) + counted(&f, whole, &right) == all);
        /* sheared: [c - a, c + a] cut at c */
        const double a[2] = {x[5], x[6]}, b[2] = {-x[6], x[7] / 4 + x[5]},
                     s[6] = {u[1], v[0], 2 * a[0], 2 * a[1], b[0], b[1]};
        const double s0[6] = {s[0] - a[0], s[1] - a[1], a[0], a[1], b[0], b[1]};
        const double s1[6] = {s[0] + a[0], s[1] + a[1], a[0], a[1], b[0], b[1]};
        if (fmin(hypot(a[0], a[1]), fabs(a[0] * b[1] - a[1] * b[0]) / hypot(a[0] + b[0], a[1] + b[1]) / 2) <
            1 / sqrt(f.density))
            continue; /* would grow to a flake's width */
        if (mu_flake_count(&f, s, &box).thinning) continue;
        sheared++;
        assert_true(counted(&f, s0, &box) + counted(&f, s1, &box) == counted(&f, s, &box));
    }
    print_message("additivity over %.0f flakes, %d parallelograms\n", flakes, sheared);
    assert_true(flakes > 5e4 && sheared > 500);
}

typedef struct situation {
    const char *name;
    double theta, tau, flakes; /* of the cone; N A, of all normals */
    double stretch;            /* of the footprint's half-axes, at random angles */
    int beckmann;
    int samples;
} situation;

/* Mean 1, and variance at most 1 / E[K], over footprints far apart, so that they are independent. Where the
 * footprint is a fraction of a cell the variance is nearly Poisson's: at least half of it. The sample variance of n
 * ratios of kurtosis k is off by sqrt((k - 1) / n); k is taken from the sample. */
static void test_the_mean_ratio_is_one(void **state) {
    (void)state;
    static const situation all[] = {
        {"pole, one flake", 0, 0.1, 100, 1, 0, 100000},
        {"pole, few", 0, 0.1, 1000, 1, 0, 100000},
        {"pole, hundreds", 0, 0.1, 30000, 1, 0, 10000},
        {"near the pole", 0.05, 0.1, 300, 1, 0, 100000},
        {"slope 1, one", 0.785, 0.1, 100, 1, 0, 100000},
        {"slope 1, few", 0.785, 0.1, 1500, 1, 0, 100000},
        {"slope 1, hundreds", 0.785, 0.1, 40000, 1, 0, 10000},
        {"tail", 1.4, 0.1, 1000, 1, 0, 100000},
        {"tail, many", 1.5, 0.1, 1e5, 1, 0, 20000},
        {"horizon", 1.57, 0.1, 1e4, 1, 0, 50000},
        {"wide cone", 0.5, 1, 10, 1, 0, 100000},
        {"narrow cone", 0.4, 0.004, 60000, 1, 0, 100000},
        {"narrow cone, few", 0.4, 0.004, 6e5, 1, 0, 100000},
        {"stretched", 0.3, 0.1, 3000, 30, 0, 30000},
        {"stretched, many", 0.3, 0.1, 60000, 30, 0, 10000},
        {"below a flake", 0.3, 0.3, 1e-6, 1, 0, 200000},
        {"thinned", 0.6, 0.1, 5e5, 1, 0, 10000},
        {"thinned twice", 0.6, 0.1, 3e6, 3, 0, 10000},
        {"Beckmann pole", 0, 0.1, 300, 1, 1, 100000},
        {"Beckmann", 0.9, 0.1, 1000, 1, 1, 100000},
        {"Beckmann tail", 1.2, 0.1, 3e4, 1, 1, 40000},
        {"Beckmann thinned", 1.2, 0.1, 1e6, 1, 1, 10000},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        const situation *at = &all[i];
        const mu_flakes f = mu_flakes_make(250, at->tau, 77 + i);
        uniform random = {1000 + i};
        double m[3], inverse = 0, fourth = 0;
        normal(at->theta, 2 + 5 * (double)i, m);
        const mu_flake_normals box =
            mu_flake_cone(at->beckmann ? mu_flake_cdf_beckmann : mu_flake_cdf_ggx, m, at->tau);
        const double half = sqrt(at->flakes / f.density) / 2, far = 1e3 * (half * at->stretch + f.side);
        int thinning = 0;
        moments ratio = {0};
        for (int n = 0; n < at->samples; n++) {
            const double turn = 7 * uniform_double(&random), c = cos(turn), s = sin(turn);
            const double long_ = half * sqrt(at->stretch), short_ = half / sqrt(at->stretch);
            const double footprint[6] = {far * ((n % 700) + uniform_double(&random) * 0.1),
                                         far * (floor(n / 700) + uniform_double(&random) * 0.1),
                                         long_ * c,
                                         long_ * s,
                                         -short_ * s + short_ * c / 2,
                                         short_ * c + short_ * s / 2};
            const mu_flake_tally tally = mu_flake_count(&f, footprint, &box);
            thinning = tally.thinning;
            inverse = ldexp(1 / tally.expected, -2 * thinning);
            const double r = mu_flake_ratio(&f, footprint, &box);
            assert_true(r >= 0);
            accumulate(&ratio, r);
            fourth += pow(r - 1, 4);
        }
        const double spread = (ratio.squares - 2 * ratio.sum + ratio.n) / ratio.n;
        const double error = sqrt(fmax(fourth / ratio.n - spread * spread, 0) / ratio.n);
        print_message("%-18s E[K] %8.4g thinning %d: variance E[K] %.3f +- %.3f; ", at->name, 1 / inverse,
                      thinning, spread / inverse, error / inverse);
        agrees(&ratio, 1, 0, "mean of ratio");
        if (spread > inverse) assert_true(p_of_z((spread - inverse) / error) > significance_level());
        assert_true(spread > (thinning || at->flakes * at->tau * at->tau > 100 ? 0.1 : 0.5) * inverse);
    }
}

/* One fixed region that cuts through cells, over seeds: the flakes are uniform within their cells. */
static void test_every_seed_is_as_good(void **state) {
    (void)state;
    const double m[3] = {0.3, 0.2, 0.9}, footprint[6] = {0.313, -0.722, 0.03, 0.011, -0.02, 0.04};
    for (int beckmann = 0; beckmann < 2; beckmann++) {
        moments ratio = {0};
        const mu_flake_normals box =
            mu_flake_cone(beckmann ? mu_flake_cdf_beckmann : mu_flake_cdf_ggx, m, 0.1);
        for (uint64_t seed = 0; seed < 100000; seed++) {
            const mu_flakes f = mu_flakes_make(1e5, 0.1, seed);
            accumulate(&ratio, mu_flake_ratio(&f, footprint, &box));
        }
        agrees(&ratio, 1, 0, "mean of ratio over seeds");
    }
}

typedef struct correlation {
    double n, x, y, xx, yy, xy;
} correlation;

static void pair(correlation *c, double x, double y) {
    c->n++, c->x += x, c->y += y, c->xx += x * x, c->yy += y * y, c->xy += x * y;
}

static double correlated(const correlation *c, const char *what) {
    const double r =
        (c->n * c->xy - c->x * c->y) / sqrt((c->n * c->xx - c->x * c->x) * (c->n * c->yy - c->y * c->y));
    print_message("%s: correlation %.4f\n", what, r);
    return r;
}

/* A footprint that moves by a quarter of its size keeps three quarters of its flakes: of a Poisson process the
 * correlation would be 0.75, and here, with a third of a cell's width, it is nearly so. One that moves far has others, as have the neighbouring cell, other normals and the next
 * seed. Correlations of n independent pairs spread by 1 / sqrt(n). */
static void test_flakes_stay_where_they_are(void **state) {
    (void)state;
    const double m[3] = {0.3, 0.2, 0.9}, other[3] = {-0.3, -0.2, 0.9};
    const mu_flakes f = mu_flakes_make(1e4, 0.1, 3), g = mu_flakes_make(1e4, 0.1, 4);
    const mu_flake_normals box = mu_flake_cone(mu_flake_cdf_ggx, m, 0.1);
    const mu_flake_normals aside = mu_flake_cone(mu_flake_cdf_ggx, other, 0.1);
    assert_true(box.q + box.q_width < aside.q || aside.p[0] > box.p[1]);
    correlation near = {0}, far = {0}, cells = {0}, normals = {0}, seeds = {0};
    const double half = f.side / 2;
    for (int i = 0; i < 40000; i++) {
        /* every third cell of every third row: no cell enters twice */
        const double u = 3 * f.side * (i % 200) + half, v = 3 * f.side * floor(i / 200) + half;
        double at[6] = {u, v, half, 0, 0, half};
        const double here = counted(&f, at, &box);
        assert_true(here == counted(&f, at, &box));
        pair(&normals, here, counted(&f, at, &aside));
        pair(&seeds, here, counted(&g, at, &box));
        at[0] = u + 2 * half;
        pair(&cells, here, counted(&f, at, &box));
        at[0] = u + 1e6 * f.side;
        pair(&far, here, counted(&f, at, &box));
        double moving[6] = {u, v, half / 3, 0, 0, half / 3};
        const double before = counted(&f, moving, &box);
        moving[0] += half / 6;
        pair(&near, before, counted(&f, moving, &box));
    }
    const double kept = correlated(&near, "moved by a quarter");
    assert_true(kept > 0.6 && kept < 0.9);
    const double others[4] = {correlated(&far, "a million cells away"),
                              correlated(&cells, "neighbouring cells"), correlated(&normals, "other normals"),
                              correlated(&seeds, "next seed")};
    for (int i = 0; i < 4; i++) assert_true(p_of_z(others[i] * sqrt(near.n)) > significance_level());
}

/* Whatever is asked, the answer is a number; a footprint smaller than a flake is one flake wide. */
static void test_extremes_have_an_answer(void **state) {
    (void)state;
    const double numbers[] = {0, 1e-300, 1e-30, 1e-9, 1, 1e9, 1e30, 1e300, INFINITY, NAN, -1, -1e9};
    const double densities[] = {0, 1e-300, 1e-6, 1, 1e12, 1e300, INFINITY, NAN, -1},
                 taus[] = {0, 1e-9, 0.1, 9, NAN};
    uniform random = {4};
    for (int i = 0; i < 200000; i++) {
        const mu_flakes f = mu_flakes_make(densities[i % 9], taus[i / 9 % 5], 1);
        double footprint[6], m[3];
        for (int k = 0; k < 6; k++) footprint[k] = numbers[uniform_bits(&random) % 12];
        for (int k = 0; k < 3; k++)
            m[k] = numbers[uniform_bits(&random) % 12] * (k < 2 && uniform_bits(&random) % 2 ? -1 : 1);
        const mu_flake_normals box = mu_flake_cone(i % 2 ? mu_flake_cdf_ggx : mu_flake_cdf_beckmann, m,
                                                   taus[uniform_bits(&random) % 5]);
        assert_true(box.p[0] >= 0 && box.p[1] <= 1 && box.p[1] - box.p[0] >= 0x1p-41 && box.q_width > 0);
        const double ratio = mu_flake_ratio(&f, footprint, &box);
        assert_true(ratio >= 0 && ratio < INFINITY);
    }
    const double pole[3] = {0, 0, 1};
    const mu_flakes f = mu_flakes_make(1e12, 0.3, 1), many = mu_flakes_make(1e12, 0.3, 2);
    const mu_flake_normals box = mu_flake_cone(mu_flake_cdf_ggx, pole, 0.3);
    const double point[6] = {1e9, -1e9, 0, 0, 0, 0}, line[6] = {0, 0, 1e-5, 0, 0, 0},
                 all[6] = {0, 0, 1e9, 0, 0, 1e9};
    const double v = box.p[1] - box.p[0];
    assert_true(fabs(mu_flake_count(&f, point, &box).expected / v - 1) < 1e-12);
    assert_true(fabs(mu_flake_count(&f, line, &box).expected / (20 * v) - 1) < 1e-12);
    assert_true(mu_flake_ratio(&many, all, &box) == 1); /* 1e30 flakes */
}

/* Regions of any size and shape, and cones other than those expected: 30 us at the most were measured in the mean over any
 * of these groups; a lattice that did not give way would take seconds. */
static void test_the_work_is_bounded(void **state) {
    (void)state;
    uniform random = {21};
    double sum = 0;
    const clock_t start = clock();
    enum { REGIONS = 20000 };
    for (int i = 0; i < REGIONS; i++) {
        const mu_flakes f =
            mu_flakes_make(pow(10, 12 * uniform_double(&random)), pow(10, -6 * uniform_double(&random)), 1);
        double m[3], axes[2], turns[2];
        normal(1.57 * uniform_double(&random), 7 * uniform_double(&random), m);
        for (int k = 0; k < 2; k++) {
            axes[k] = pow(10, 12 * uniform_double(&random)) / sqrt(f.density);
            turns[k] = 7 * uniform_double(&random);
        }
        const double footprint[6] = {1e3 * uniform_double(&random), 1e3 * uniform_double(&random),
                                     axes[0] * cos(turns[0]),       axes[0] * sin(turns[0]),
                                     axes[1] * cos(turns[1]),       axes[1] * sin(turns[1])};
        const mu_flake_normals box = mu_flake_cone(i % 2 ? mu_flake_cdf_ggx : mu_flake_cdf_beckmann, m,
                                                   pow(10, -6 * uniform_double(&random)));
        sum += mu_flake_ratio(&f, footprint, &box);
    }
    const double us = (double)(clock() - start) / CLOCKS_PER_SEC * 1e6 / REGIONS;
    print_message("%.1f us a region, mean ratio %.3g\n", us, sum / REGIONS);
    assert_true(us < 500); /* sanitizers included */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_box_has_the_cones_solid_angle),
        cmocka_unit_test(test_counts_add_up),
        cmocka_unit_test(test_the_mean_ratio_is_one),
        cmocka_unit_test(test_every_seed_is_as_good),
        cmocka_unit_test(test_flakes_stay_where_they_are),
        cmocka_unit_test(test_extremes_have_an_answer),
        cmocka_unit_test(test_the_work_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
