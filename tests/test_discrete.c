/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_discrete.c: discrete GGX and Beckmann are the smooth ones in the mean over footprints, under any M and tilt, in
 * reflection and refraction; pdfs and sampled directions are the smooth ones' bits; f is reciprocal for every single
 * footprint; M acts on them as on a black box; from afar they are smooth, with a variance of 1/E[K]. Flakes themselves are
 * held to their laws in test_flakes.c. Random comparisons: 12 means, 6 variances.
 */
#include <string.h>
#include <time.h>

#include "tests/bsdf_fixture.h"
#include "tests/moments.h"

/* Skewed, mirrored or plain; tilted or not. */
static mu_definition flaky(mu_ndf ndf, int map) {
    static const double maps[3][4] = {{1, 0.8, -0.3, 1.4}, {-0.7, 0.2, 0.5, 1.1}, {1, 0, 0, 1}};
    mu_definition d = bsdf_definition(ndf, 0.3, 2, maps[map][0], maps[map][1], maps[map][2], maps[map][3]);
    d.tilt[0] = map == 2 ? 0 : 0.1, d.tilt[1] = map == 2 ? 0 : -0.2;
    d.flake_density = 1e4, d.flake_cone = 0.05, d.flake_seed = 3;
    return d;
}

static mu_definition smooth_of(const mu_definition *discrete) {
    mu_definition d = *discrete;
    d.ndf = d.ndf == MU_DISCRETE_GGX ? MU_GGX : MU_BECKMANN;
    return d;
}

static void refracting(mu_definition *d) {
    d->fresnel = MU_FRESNEL_DIELECTRIC, d->dielectric = 1.5, d->transmission = 1;
}

/* The n-th of many places far apart, with half-axes of about `half`. */
static void footprint_at(uniform *random, int n, double half, double out[6]) {
    const double turn = 2 * TEST_PI * uniform_double(random), c = half * cos(turn), s = half * sin(turn);
    const double footprint[6] = {n % 300 + uniform_double(random),
                                 floor(n / 300.0) + uniform_double(random),
                                 c,
                                 s,
                                 -s + 0.3 * c,
                                 c + 0.3 * s};
    memcpy(out, footprint, sizeof footprint);
}

/* Few flakes, so that the mean is one of very different values. */
static void test_the_mean_over_footprints_is_smooth(void **state) {
    (void)state;
    enum { SAMPLES = 30000 };
    const double wo[3] = {0.48, -0.36, 0.8}, ways[2][3] = {{-0.3, 0.5, 0.812}, {-0.36, 0.2, -0.911}};
    for (int i = 0; i < 8; i++) {
        const int refracted = i / 4;
        mu_definition d = flaky(i % 2 ? MU_DISCRETE_BECKMANN : MU_DISCRETE_GGX, i / 2 % 2);
        if (refracted) refracting(&d);
        const mu_definition smooth = smooth_of(&d);
        bsdf flakes, plain;
        double wi[3],
            length = sqrt(ways[refracted][0] * ways[refracted][0] + ways[refracted][1] * ways[refracted][1] +
                          ways[refracted][2] * ways[refracted][2]);
        for (int k = 0; k < 3; k++) wi[k] = ways[refracted][k] / length;
        bsdf_bind_double(&flakes, &d, wo), bsdf_bind_double(&plain, &smooth, wo);
        mu_value_d expected, value;
        mu_sample_d drawn, sample;
        mu_eval_d(&plain.d, wi, &expected);
        uniform random = {100 + (uint64_t)i};
        double u[3];
        do { /* a direction on the side that is asked about */
            for (int k = 0; k < 3; k++) u[k] = uniform_double(&random);
            mu_sample_wi_d(&plain.d, u, &drawn);
        } while (drawn.rejected || drawn.transmitted != refracted);
        assert_true(expected.f[0] > 0);
        moments f = {0}, weight = {0};
        for (int n = 0; n < SAMPLES; n++) {
            double footprint[6];
            footprint_at(&random, n, 0.02, footprint);
            mu_footprint_d(&flakes.d, footprint);
            mu_eval_d(&flakes.d, wi, &value);
            mu_sample_wi_d(&flakes.d, u, &sample);
            accumulate(&f, value.f[0] / expected.f[0]);
            accumulate(&weight, sample.weight[0] / drawn.weight[0]);
            /* the directions and their densities know no flakes */
            assert_true(value.pdf == expected.pdf && value.pdf_reverse == expected.pdf_reverse);
            assert_true(sample.pdf == drawn.pdf && sample.pdf_reverse == drawn.pdf_reverse);
            assert_memory_equal(sample.wi, drawn.wi, sizeof drawn.wi);
            assert_true(fabs(sample.f[0] * drawn.weight[0] - sample.weight[0] * drawn.f[0]) <=
                        1e-12 * sample.weight[0] * drawn.f[0]);
        }
        agrees(&f, 1, 0, refracted ? "refraction, f over smooth f" : "reflection, f over smooth f");
        if (i % 4 < 2) agrees(&weight, 1, 0, "weight over smooth weight");
    }
}

/* Both directions see the same flakes, in reflection and through a dielectric: what they make of the smooth f, which is
 * held to reciprocity elsewhere, is the same to the last places of the quotient. H is computed from either side, and a flake
 * may lie between the two roundings, one in some 2^40: none of these. */
static void test_reciprocity(void **state) {
    (void)state;
    uniform random = {7};
    int lit = 0;
    for (int n = 0; n < 20000; n++) {
        mu_definition d = flaky(n % 2 ? MU_DISCRETE_BECKMANN : MU_DISCRETE_GGX, n % 3);
        refracting(&d);
        double a[3], b[3], footprint[6];
        bsdf_direction(0.05 + 0.9 * uniform_double(&random), 7 * uniform_double(&random), a);
        bsdf_direction(0.05 + 0.9 * uniform_double(&random), 7 * uniform_double(&random), b);
        if (n % 5 == 0) b[2] = -b[2];
        footprint_at(&random, n, 0.2, footprint);
        const mu_definition smooth = smooth_of(&d);
        bsdf there, back;
        mu_value_d f[2], g[2]; /* smooth, discrete */
        for (int k = 0; k < 2; k++) {
            bsdf_bind_double(&there, k ? &d : &smooth, a);
            assert_true(mu_bind_d(mu_surface_make_d(k ? &d : &smooth, back.in_double), b, NULL, &back.d));
            mu_footprint_d(&there.d, footprint), mu_footprint_d(&back.d, footprint);
            mu_eval_d(&there.d, b, &f[k]), mu_eval_d(&back.d, a, &g[k]);
        }
        lit += f[1].f[0] > 0;
        if (f[0].f[0] > 0) bsdf_near(f[1].f[0] / f[0].f[0], g[1].f[0] / g[0].f[0], 1e-14);
    }
    assert_true(lit > 5000);
}

/* D_M(m; cone t) = |det M| / |M^T m|^4 D(u; cone t sqrt(J)), u = M^T m: Eq. (22) for the discrete D, where J, the share of
 * the flakes in a cone against that in the cone around u, is taken from a GGX written here. The lattice depends on a
 * definition's cone through a power of two: pairs with different ones are passed over. */
static void test_the_transform_is_a_black_box(void **state) {
    (void)state;
    uniform random = {17};
    int compared = 0, empty = 0;
    while (compared < 3000) {
        mu_definition d = flaky(MU_DISCRETE_GGX, 2);
        bsdf_random_map(&random, d.transform);
        d.flake_cone = 0.02 + 0.1 * uniform_double(&random);
        const double *M = d.transform, alpha2 = d.alpha * d.alpha;
        double m[3], footprint[6];
        bsdf_direction(0.3 + 0.7 * uniform_double(&random), 7 * uniform_double(&random), m);
        footprint_at(&random, compared, 0.1, footprint);
        const double u[3] = {M[0] * m[0] + M[2] * m[1], M[1] * m[0] + M[3] * m[1], m[2]},
                     length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), cosine = u[2] / length;
        const double det = fabs(M[0] * M[3] - M[1] * M[2]);
        const double ggx = alpha2 / (TEST_PI * pow(cosine * cosine * (alpha2 - 1) + 1, 2));
        const double mapped = det / pow(length, 4) * ggx, J = mapped * m[2] / (ggx * cosine);

        mu_definition original = flaky(MU_DISCRETE_GGX, 2);
        original.flake_cone = d.flake_cone * sqrt(J);
        if (original.flake_cone > 0.5 ||
            ceil(log2(2 * d.alpha / original.flake_cone)) != ceil(log2(2 * d.alpha / d.flake_cone)))
            continue;
        const double up[3] = {0, 0, 1}, unit[3] = {u[0] / length, u[1] / length, cosine};
        bsdf black, box;
        bsdf_bind_double(&black, &d, up), bsdf_bind_double(&box, &original, up);
        mu_footprint_d(&black.d, footprint), mu_footprint_d(&box.d, footprint);
        const double whole = mu_normal_d(&black.d, m).D, part = mu_normal_d(&box.d, unit).D;
        compared++;
        empty += whole == 0;
        bsdf_near(whole, det / pow(length, 4) * part, 1e-9);
    }
    assert_true(empty > 10 && empty < 2900);
}

/* The same flakes in float and double: a rounding of 2^-22 or so of a normal, against boxes whose sides are 2^-6 or
 * more, moves one of some 10 flakes across a side in one of 1000 questions; 20 are allowed. */
static void test_float_and_double_see_the_same_flakes(void **state) {
    (void)state;
    uniform random = {23};
    int different = 0, lit = 0;
    for (int n = 0; n < 20000; n++) {
        const mu_definition d = flaky(n % 2 ? MU_DISCRETE_BECKMANN : MU_DISCRETE_GGX, n % 3),
                            smooth = smooth_of(&d);
        double wo[3], wi[3], footprint[6];
        bsdf_direction(0.1 + 0.9 * uniform_double(&random), 7 * uniform_double(&random), wo);
        bsdf_direction(0.1 + 0.9 * uniform_double(&random), 7 * uniform_double(&random), wi);
        footprint_at(&random, n, n % 4 < 2 ? 0.05 : 0.5, footprint);
        bsdf flakes, plain;
        bsdf_bind(&flakes, &d, wo), bsdf_bind_double(&plain, &smooth, wo);
        mu_footprint_d(&flakes.d, footprint), mu_footprint_f(&flakes.f, footprint);
        const float wi_f[3] = {(float)wi[0], (float)wi[1], (float)wi[2]};
        mu_value_d in_double, expected;
        mu_value_f in_float;
        mu_eval_d(&flakes.d, wi, &in_double), mu_eval_f(&flakes.f, wi_f, &in_float);
        mu_eval_d(&plain.d, wi, &expected);
        lit += in_double.f[0] > 0;
        different +=
            fabs((double)in_float.f[0] - in_double.f[0]) > 1e-3 * fmax(in_double.f[0], expected.f[0]);
    }
    print_message("%d of %d differ\n", different, lit);
    assert_true(lit > 5000 && different <= 20);
}

/* Without a footprint, with one of infinite size, blurred: the smooth surface's bits, in the same plan. */
static void test_smooth_without_a_footprint(void **state) {
    (void)state;
    const double wo[3] = {0.6, 0, 0.8}, wi[3] = {-0.36, 0.48, 0.8}, near[6] = {0.2, 0.3, 0.01, 0, 0, 0.01},
                 far[6] = {0.2, 0.3, INFINITY, 0, 0, 0.01}, lost[6] = {NAN, NAN, 0.01, 0, 0, 0.01};
    const mu_definition d = flaky(MU_DISCRETE_GGX, 0), smooth = smooth_of(&d);
    bsdf flakes, plain;
    mu_value_d value, expected;
    bsdf_bind_double(&flakes, &d, wo), bsdf_bind_double(&plain, &smooth, wo);
    mu_eval_d(&plain.d, wi, &expected);
    mu_footprint_d(&flakes.d, near);
    mu_eval_d(&flakes.d, wi, &value);
    assert_true(value.f[0] != expected.f[0]);
    const double *smoothing[] = {NULL, far, lost};
    for (int i = 0; i < 3; i++) {
        mu_footprint_d(&flakes.d, smoothing[i]);
        mu_eval_d(&flakes.d, wi, &value);
        assert_memory_equal(&value, &expected, sizeof value);
    }
    mu_footprint_d(&flakes.d, near);
    mu_blur_d(&flakes.d, 0.4), mu_blur_d(&plain.d, 0.4);
    mu_eval_d(&flakes.d, wi, &value), mu_eval_d(&plain.d, wi, &expected);
    assert_memory_equal(&value, &expected, sizeof value);
    /* a footprint means nothing to others, a mirror among them */
    mu_definition mirror = d;
    mirror.alpha = 0;
    bsdf_bind_double(&flakes, &mirror, wo);
    mu_footprint_d(&flakes.d, near);
    assert_false(flakes.d.has_footprint);
    bsdf_bind_double(&plain, &smooth, wo);
    mu_footprint_d(&plain.d, near);
    assert_false(plain.d.has_footprint);
}

/* E[K] = N A times the share of the normals in the cone, which is about D_M(wm) cos_m 2 pi (1 - cos t): to 10 % for these.
 * The variance is at most 1 / E[K] and not far below; a footprint of half the size has it four times. */
static void test_variance_falls_with_size(void **state) {
    (void)state;
    enum { SAMPLES = 20000 };
    const double wo[3] = {0.48, -0.36, 0.8}, wm[3] = {0.1, 0.05, 0.9937303457175894};
    for (int i = 0; i < 6; i++) {
        const mu_definition d = flaky(i / 3 ? MU_DISCRETE_BECKMANN : MU_DISCRETE_GGX, 0),
                            smooth = smooth_of(&d);
        const double half = 0.01 * pow(2, i % 3 * 2);
        bsdf flakes, plain;
        bsdf_bind_double(&flakes, &d, wo), bsdf_bind_double(&plain, &smooth, wo);
        const double D = mu_normal_d(&plain.d, wm).D;
        const double share = D * wm[2] * 2 * TEST_PI * (1 - cos(d.flake_cone)),
                     expected = d.flake_density * 4 * half * half * share;
        uniform random = {31 + (uint64_t)i};
        moments square = {0};
        double sum = 0;
        for (int n = 0; n < SAMPLES; n++) {
            double footprint[6];
            footprint_at(&random, n, half, footprint);
            mu_footprint_d(&flakes.d, footprint);
            const double off = mu_normal_d(&flakes.d, wm).D / D - 1;
            accumulate(&square, off * off);
            sum += off;
        }
        const double variance = square.sum / SAMPLES,
                     error = sqrt((square.squares / SAMPLES - variance * variance) / SAMPLES);
        print_message("E[K] %.3g: variance times E[K] %.3f +- %.3f, mean %.4f\n", expected,
                      variance * expected, error * expected, 1 + sum / SAMPLES);
        const double over = variance * expected - 1.1, z = over / (error * expected);
        if (over > 0) assert_true(p_of_z(z) > significance_level());
        assert_true(variance * expected > 0.4);
    }
}

static void test_definitions_are_checked(void **state) {
    (void)state;
    const double bad[][2] = {{0, 0.1}, {-1, 0.1}, {INFINITY, 0.1}, {NAN, 0.1}, {1, 0}, {1, 1.6}, {1, NAN}};
    mu_complaint why;
    mu_definition d = flaky(MU_DISCRETE_BECKMANN, 0);
    assert_true(mu_definition_check(&d, &why));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        d.flake_density = bad[i][0], d.flake_cone = bad[i][1];
        assert_false(mu_definition_check(&d, &why));
        assert_string_equal(why.field, i < 4 ? "flake_density" : "flake_cone");
    }
    d.ndf = MU_BECKMANN;
    assert_true(mu_definition_check(&d, &why));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_mean_over_footprints_is_smooth),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_the_transform_is_a_black_box),
        cmocka_unit_test(test_float_and_double_see_the_same_flakes),
        cmocka_unit_test(test_smooth_without_a_footprint),
        cmocka_unit_test(test_variance_falls_with_size),
        cmocka_unit_test(test_definitions_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
