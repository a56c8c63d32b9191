/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_anisotropy.c: each converter of anisotropy against the D its own system defines, written here as there.
 *
 * Tolerance 64 eps k, k = alpha_max / alpha_min the condition of M. The entries of M carry up to 4 eps of the largest
 * (a cosine, a sine, products, sums), and so does u = M^T m, whose length is at least 1/k of the largest entry's share:
 * 4 eps k in u. D goes with |u|^-4, 16 eps k, and with det M, 8 eps k; turning the normal into the other system's
 * tangent frame adds 2 eps, four times and times k, 8 eps k. That is 32 eps k; the kernels' own roundings, some 30 eps,
 * fit into the other half.
 */
#include <float.h>

#include "tests/bsdf_fixture.h"

enum { CASES = 300 };

/* One system's anisotropy: roughness alpha along a tangent at `rotation` and along its bitangent. */
typedef struct axes {
    double t, b, rotation;
} axes;

static double between(uniform *u, double low, double high) {
    return low + (high - low) * uniform_double(u);
}

/* The normal in the frame (T, N x T, N), T = (cos rotation, sin rotation, 0). */
static void in_tangent_frame(const double h[3], double rotation, double out[3]) {
    const double c = cos(rotation), s = sin(rotation);
    out[0] = c * h[0] + s * h[1], out[1] = c * h[1] - s * h[0], out[2] = h[2];
}

/* disney.brdf: GTR2_aniso */
static double gtr2_aniso(double n, double x, double y, double ax, double ay) {
    return 1 / (TEST_PI * ax * ay * pow(pow(x / ax, 2) + pow(y / ay, 2) + n * n, 2));
}
/* Cycles, bsdf_microfacet.h: bsdf_aniso_D */
static double cycles_d(double ax, double ay, const double h[3]) {
    const double x = h[0] / ax, y = h[1] / ay, squared = x * x + y * y + h[2] * h[2];
    return 1 / TEST_PI / (ax * ay * squared * squared);
}
/* KHR_materials_anisotropy: D_GGX_anisotropic */
static double gltf_d(double n, double t, double b, double at, double ab) {
    const double a2 = at * ab, f[3] = {ab * t, at * b, a2 * n};
    const double w2 = a2 / (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    return a2 * w2 * w2 / TEST_PI;
}
/* OpenPBR, "Microfacet model": (1 + tan^2 (cos^2 phi / at^2 + sin^2 phi / ab^2))^-2 over pi at ab cos^4 */
static double openpbr_d(double cosine, double phi, double at, double ab) {
    const double tan2 = (1 - cosine) * (1 + cosine) / (cosine * cosine);
    const double bracket = 1 + tan2 * (pow(cos(phi) / at, 2) + pow(sin(phi) / ab, 2));
    return 1 / (TEST_PI * at * ab * pow(cosine, 4) * bracket * bracket);
}

static double core_d(mu_ndf ndf, double alpha, const double m[4], const double h[3]) {
    const double up[3] = {0, 0, 1};
    const mu_definition d = bsdf_definition(ndf, alpha, 2, m[0], m[1], m[2], m[3]);
    bsdf b;
    bsdf_bind_double(&b, &d, up);
    return mu_normal_d(&b.d, h).D;
}

static void near_d(double alpha, const double m[4], const double h[3], double expected, axes a) {
    const double condition = fmax(a.t / a.b, a.b / a.t);
    bsdf_near(core_d(MU_GGX, alpha, m, h), expected, 64 * DBL_EPSILON * condition);
    mu_anisotropy back;
    assert_true(mu_transform_anisotropy(m, alpha, &back));
    bsdf_near(back.alpha_x, fmax(a.t, a.b), 64 * DBL_EPSILON * condition);
    bsdf_near(back.alpha_y, fmin(a.t, a.b), 64 * DBL_EPSILON * condition);
}

/* A normal anywhere above the horizon, and as it is seen from a frame that is turned. */
static double random_normal(uniform *u, double rotation, double h[3], double local[3]) {
    const double phi = 2 * TEST_PI * uniform_double(u);
    bsdf_direction(between(u, 0.05, 1), phi, h);
    in_tangent_frame(h, rotation, local);
    return phi;
}

static void alphas_are_along_the_axes(void **state) {
    (void)state;
    uniform u = {11};
    for (int i = 0; i < CASES; i++) {
        const double alpha = between(&u, 0.01, 1);
        const axes a = {between(&u, 0.01, 1), between(&u, 0.01, 1), between(&u, -7, 7)};
        double m[4], h[3], l[3];
        random_normal(&u, a.rotation, h, l);
        assert_true(mu_transform_alphas(alpha, a.t, a.b, a.rotation, m));
        near_d(alpha, m, h, gtr2_aniso(l[2], l[0], l[1], a.t, a.b), a);
    }
}

static void disney_and_principled(void **state) {
    (void)state;
    uniform u = {12};
    for (int i = 0; i < CASES; i++) {
        const double roughness = between(&u, 0.1, 1), anisotropic = i % 10 ? uniform_double(&u) : 1;
        const double turns = uniform_double(&u); /* Principled's Anisotropic Rotation */
        const double aspect = sqrt(1 - anisotropic * .9);
        const axes a = {roughness * roughness / aspect, roughness * roughness * aspect, 2 * TEST_PI * turns};
        double m[4], h[3], l[3];
        random_normal(&u, a.rotation, h, l);
        assert_true(mu_transform_disney(anisotropic, a.rotation, m));
        near_d(roughness * roughness, m, h, gtr2_aniso(l[2], l[0], l[1], a.t, a.b), a);
        near_d(roughness * roughness, m, h, cycles_d(a.t, a.b, l), a);
    }
}

static void cycles_anisotropic(void **state) {
    (void)state;
    uniform u = {13};
    for (int i = 0; i < CASES; i++) {
        const double roughness = between(&u, 0.1, 1), param = between(&u, -1, 1), turns = uniform_double(&u);
        const double square = roughness * roughness, anisotropy = fmin(fmax(param, -0.99), 0.99);
        axes a = {0, 0, 2 * TEST_PI * turns};
        if (anisotropy < 0)
            a.t = square / (1 + anisotropy), a.b = square * (1 + anisotropy);
        else
            a.t = square * (1 - anisotropy), a.b = square / (1 - anisotropy);
        double m[4], same[4], h[3], l[3];
        random_normal(&u, a.rotation, h, l);
        assert_true(mu_transform_cycles(param, a.rotation, m));
        near_d(square, m, h, cycles_d(a.t, a.b, l), a);
        assert_true(mu_transform_stretch(anisotropy, a.rotation, same)); /* Eq. (31) */
        for (int j = 0; j < 4; j++) assert_true(same[j] == m[j]);
    }
}

static void openpbr(void **state) {
    (void)state;
    uniform u = {14};
    for (int i = 0; i < CASES; i++) {
        const double roughness = between(&u, 0.1, 1), anisotropy = 0.99 * uniform_double(&u);
        const double at = roughness * roughness * sqrt(2 / (1 + pow(1 - anisotropy, 2)));
        const axes a = {at, (1 - anisotropy) * at, between(&u, -7, 7)};
        double m[4], h[3], l[3];
        const double phi = random_normal(&u, a.rotation, h, l) - a.rotation; /* from the tangent */
        assert_true(mu_transform_openpbr(anisotropy, a.rotation, m));
        near_d(roughness * roughness, m, h, openpbr_d(h[2], phi, a.t, a.b), a);
    }
}

static void gltf(void **state) {
    (void)state;
    uniform u = {15};
    for (int i = 0; i < CASES; i++) {
        const double roughness = between(&u, 0.1, 1), strength = i % 10 ? uniform_double(&u) : 1;
        const double alpha = roughness * roughness, squared = strength * strength;
        const axes a = {alpha * (1 - squared) + 1.0 * squared, alpha, between(&u, -7, 7)};
        double m[4], h[3], l[3];
        random_normal(&u, a.rotation, h, l);
        assert_true(mu_transform_gltf(alpha, strength, a.rotation, m));
        near_d(alpha, m, h, gltf_d(l[2], l[0], l[1], a.t, a.b), a);
    }
}

/* Beckmann: slopes are normal with covariance Sigma, whatever alpha. GGX: Student's t with two degrees of freedom and
 * that scale matrix times two, Cocco et al. 2024 with [Hei14]. Here k = condition of Sigma, the square of M's. */
static void covariance_of_slopes(void **state) {
    (void)state;
    uniform u = {16};
    for (int i = 0; i < CASES; i++) {
        const double alpha = between(&u, 0.05, 2), rotation = i % 2 ? between(&u, -7, 7) : 0;
        const double sx = between(&u, 0.05, 1), sy = between(&u, 0.05, 1), rho = between(&u, -0.95, 0.95);
        const double xx = sx * sx, yy = sy * sy, xy = rho * sx * sy, det = xx * yy - xy * xy;
        double m[4], h[3], l[3];
        random_normal(&u, rotation, h, l);
        const double x = -l[0] / l[2], y = -l[1] / l[2], cos4 = pow(l[2], 4);
        const double quadric = (yy * x * x - 2 * xy * x * y + xx * y * y) / det;
        const double normal = exp(-quadric / 2) / (2 * TEST_PI * sqrt(det) * cos4);
        const double student = pow(1 + quadric / 2, -2) / (2 * TEST_PI * sqrt(det) * cos4);
        const double k = pow(xx + yy, 2) / det, tolerance = 64 * DBL_EPSILON * k;
        assert_true(mu_transform_covariance(alpha, xx, xy, yy, rotation, m));
        bsdf_near(core_d(MU_GGX, alpha, m, h), student, tolerance);
        if (normal > 1e-250) bsdf_near(core_d(MU_BECKMANN, alpha, m, h), normal, tolerance * (1 + quadric));
    }
}

/* Matrices whose singular values and rotations are known exactly: integers, U diag(p, 1) V with U and V Pythagorean. */
static void decomposes_known_matrices(void **state) {
    (void)state;
    uniform u = {17};
    for (int i = 0; i < 20 * CASES; i++) {
        const double a = 1 + floor(between(&u, 0, 40)), b = floor(between(&u, -40, 41));
        const double c = 1 + floor(between(&u, 0, 40)), d = floor(between(&u, -40, 41));
        const double ux = a * a - b * b, uy = 2 * a * b, vx = c * c - d * d, vy = 2 * c * d;
        const double length = (a * a + b * b) * (c * c + d * d);
        const double p = ldexp(1, 1 + i % 27), sign = i % 2 ? -1 : 1; /* condition 2 to 1.3e8; mirrors */
        const int scale = i % 81 - 40;                                /* 1e-12 to 1e12 */
        const double m[4] = {
            ldexp(ux * p * vx - uy * sign * vy, scale), ldexp(-ux * p * vy - uy * sign * vx, scale),
            ldexp(uy * p * vx + ux * sign * vy, scale), ldexp(-uy * p * vy + ux * sign * vx, scale)};
        mu_anisotropy out;
        assert_true(mu_transform_anisotropy(m, 0.3, &out));
        /* a hypotenuse, a sum, a determinant, three quotients: under 8 eps */
        bsdf_near(out.alpha_x, ldexp(0.3 / length, -scale), 8 * DBL_EPSILON);
        bsdf_near(out.alpha_y, ldexp(0.3 / (length * p), -scale), 8 * DBL_EPSILON);
        assert_true(out.rotation > -TEST_PI / 2 && out.rotation <= TEST_PI / 2);
        /* two arc tangents up to pi, each to 2 eps of itself; p = 2 is far enough from isotropic not to amplify them */
        assert_true(fabs(sin(out.rotation - atan2(uy, ux) - TEST_PI / 2)) < 16 * DBL_EPSILON);
    }
}

/* Products of continued-fraction steps [n 1; 1 0]: integers of determinant +-1, so small = 1 / large, and condition up
 * to 1e10: what a difference of hypotenuses would lose. */
static void keeps_the_digits_of_the_small_one(void **state) {
    (void)state;
    uniform u = {20};
    for (int i = 0; i < CASES; i++) {
        double m[4] = {1, 0, 0, 1};
        while (fabs(m[0]) < (i % 2 ? 1e2 : 1e4)) {
            const double n = 1 + floor(9 * uniform_double(&u)), first = m[0], second = m[2];
            m[0] = n * first + m[1], m[2] = n * second + m[3], m[1] = first, m[3] = second;
        }
        const double squares = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3]; /* exact: below 2^53 */
        const double large = sqrt((squares + sqrt((squares - 2) * (squares + 2))) / 2);
        const double angle =
            atan2(2 * (m[0] * m[2] + m[1] * m[3]), m[0] * m[0] + m[1] * m[1] - m[2] * m[2] - m[3] * m[3]) / 2;
        mu_anisotropy out;
        assert_true(mu_transform_anisotropy(m, 1, &out));
        bsdf_near(out.alpha_x, large, 8 * DBL_EPSILON);
        bsdf_near(out.alpha_y, 1 / large, 8 * DBL_EPSILON);
        assert_true(fabs(sin(out.rotation - angle - TEST_PI / 2)) < 16 * DBL_EPSILON);
    }
    /* stretched along x, but for less than a rounding of the angle: x is across, +90 degrees and never -90 */
    const double edge[4] = {2, 0, 1e-20, 1};
    mu_anisotropy out;
    assert_true(mu_transform_anisotropy(edge, 1, &out));
    assert_true(out.rotation == TEST_PI / 2);
}

/* M -> alphas -> M' with M' M'^T = M M^T, to 64 eps of the largest entry. */
static void round_trip(void **state) {
    (void)state;
    uniform u = {18};
    for (int i = 0; i < CASES; i++) {
        double m[4], n[4];
        mu_anisotropy out;
        bsdf_random_map(&u, m);
        assert_true(mu_transform_anisotropy(m, 0.2, &out));
        assert_true(out.alpha_x >= out.alpha_y);
        assert_true(mu_transform_alphas(0.2, out.alpha_x, out.alpha_y, out.rotation, n));
        const double tolerance = 64 * DBL_EPSILON * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3]);
        assert_true(fabs(m[0] * m[0] + m[1] * m[1] - n[0] * n[0] - n[1] * n[1]) < tolerance);
        assert_true(fabs(m[0] * m[2] + m[1] * m[3] - n[0] * n[2] - n[1] * n[3]) < tolerance);
        assert_true(fabs(m[2] * m[2] + m[3] * m[3] - n[2] * n[2] - n[3] * n[3]) < tolerance);
    }
}

static void isotropic_maps_have_no_direction(void **state) {
    (void)state;
    uniform u = {19};
    for (int i = 0; i < CASES; i++) {
        const double q = pow(10, between(&u, -12, 12)), f = between(&u, -4, 4), g = between(&u, -4, 4);
        const double c = cos(f), s = sin(f), d = cos(g), t = sin(g), sign = i % 2 ? -1 : 1;
        const double m[4] = {q * (c * d - sign * s * t),
                             q * (-c * t - sign * s * d), /* R(f) diag(1, +-1) R(g) */
                             q * (s * d + sign * c * t), q * (-s * t + sign * c * d)};
        mu_anisotropy out;
        assert_true(mu_transform_anisotropy(m, 0.3, &out));
        assert_true(out.rotation == 0 && out.alpha_x == out.alpha_y);
        bsdf_near(out.alpha_x, 0.3 / q, 16 * DBL_EPSILON);
    }
    const double identity[4] = {1, 0, 0, 1};
    mu_anisotropy out;
    assert_true(mu_transform_anisotropy(identity, 0.3, &out));
    assert_true(out.alpha_x == 0.3 && out.alpha_y == 0.3 && out.rotation == 0);
}

/* The azimuth, in degrees, of the brightest reflection 20 degrees off a mirror's, seen from above. */
static int brightest(double alpha, const double m[4]) {
    const double up[3] = {0, 0, 1};
    const mu_definition d = bsdf_definition(MU_GGX, alpha, 2, m[0], m[1], m[2], m[3]);
    bsdf b;
    bsdf_bind_double(&b, &d, up);
    int best = 0;
    double most = 0;
    for (int degree = 0; degree < 180; degree++) {
        double wi[3];
        mu_value_d value;
        bsdf_direction(cos(TEST_PI / 9), degree * TEST_PI / 180, wi);
        mu_eval_d(&b.d, wi, &value);
        if (value.f[0] > most) most = value.f[0], best = degree;
    }
    return best;
}

static void highlight_is_where_the_header_says(void **state) {
    (void)state;
    const double turn = 30 * TEST_PI / 180;
    double m[4];
    assert_true(mu_transform_alphas(0.1, 0.2, 0.05, turn, m));
    assert_int_equal(brightest(0.1, m), 30); /* along x */
    assert_true(mu_transform_alphas(0.1, 0.05, 0.2, turn, m));
    assert_int_equal(brightest(0.1, m), 120);
    assert_true(mu_transform_disney(0.8, turn, m));
    assert_int_equal(brightest(0.1, m), 30);
    assert_true(mu_transform_openpbr(0.8, turn, m));
    assert_int_equal(brightest(0.1, m), 30);
    assert_true(mu_transform_gltf(0.1, 0.6, turn, m));
    assert_int_equal(brightest(0.1, m), 30);
    assert_true(mu_transform_cycles(0.6, turn, m)); /* across the tangent */
    assert_int_equal(brightest(0.1, m), 120);
    assert_true(mu_transform_cycles(-0.6, turn, m));
    assert_int_equal(brightest(0.1, m), 30);
    assert_true(mu_transform_stretch(0.6, 0, m)); /* smooth along x, where it was stretched */
    assert_int_equal(brightest(0.1, m), 90);
    assert_true(m[0] > 1 && m[3] < 1 && m[1] == 0 && m[2] == 0);
    assert_true(mu_transform_covariance(0.1, 0.01, 0.008, 0.01, 0, m)); /* large along (1, 1) */
    assert_int_equal(brightest(0.1, m), 45);
    assert_true(mu_transform_covariance(0.1, 0.01, 0.008, 0.01, turn, m));
    assert_int_equal(brightest(0.1, m), 75);
    mu_anisotropy out;
    assert_true(mu_transform_anisotropy(m, 0.1, &out));
    bsdf_near(out.rotation, 75 * TEST_PI / 180, 64 * DBL_EPSILON);
}

static void refuses_what_is_out_of_range(void **state) {
    (void)state;
    double m[4];
    mu_anisotropy out;
    static const double singular[4] = {1, 2, 2, 4}, infinite[4] = {INFINITY, 0, 0, 1};
    assert_false(mu_transform_alphas(0.3, 0, 0.3, 0, m) || mu_transform_alphas(0.3, -0.3, 0.3, 0, m) ||
                 mu_transform_alphas(0, 0.3, 0.3, 0, m) || mu_transform_alphas(NAN, 0.3, 0.3, 0, m) ||
                 mu_transform_alphas(0.3, 0.3, 0.3, NAN, m) || mu_transform_alphas(0.3, INFINITY, 1, 0, m));
    assert_false(mu_transform_stretch(1, 0, m) || mu_transform_stretch(-1, 0, m) ||
                 mu_transform_stretch(2.5, 0, m) || mu_transform_stretch(NAN, 0, m) ||
                 mu_transform_stretch(0.5, INFINITY, m));
    assert_false(mu_transform_disney(-0.1, 0, m) || mu_transform_disney(1.01, 0, m) ||
                 mu_transform_disney(NAN, 0, m));
    assert_false(mu_transform_cycles(-1.01, 0, m) || mu_transform_cycles(1.01, 0, m) ||
                 mu_transform_cycles(NAN, 0, m));
    assert_false(mu_transform_openpbr(-0.1, 0, m) || mu_transform_openpbr(1, 0, m) ||
                 mu_transform_openpbr(NAN, 0, m));
    assert_false(mu_transform_gltf(0.1, 1.1, 0, m) || mu_transform_gltf(1.1, 0.5, 0, m) ||
                 mu_transform_gltf(0, 0.5, 0, m) || mu_transform_gltf(0.1, NAN, 0, m));
    assert_false(mu_transform_covariance(0.1, 1, 1, 1, 0, m) || mu_transform_covariance(0.1, 1, 2, 1, 0, m) ||
                 mu_transform_covariance(0.1, -1, 0, -1, 0, m) || mu_transform_covariance(0, 1, 0, 1, 0, m) ||
                 mu_transform_covariance(0.1, 1, NAN, 1, 0, m) ||
                 mu_transform_covariance(0.1, INFINITY, 0, 1, 0, m));
    assert_false(mu_transform_anisotropy(singular, 0.3, &out) ||
                 mu_transform_anisotropy(infinite, 0.3, &out));
    /* and takes what is just in it: mirrors stay mirrors, extremes of Sigma have roots */
    assert_true(mu_transform_alphas(0, 0, 0, 1, m) && mu_transform_gltf(0, 0, 1, m));
    assert_true(mu_transform_covariance(1, 2e-300, 0, 8e-300, 0, m));
    bsdf_near(m[0], 0.5e150, 16 * DBL_EPSILON);
    bsdf_near(m[3], 0.25e150, 16 * DBL_EPSILON);
    assert_true(mu_transform_covariance(1, 2e-23, 0, 8e300, 0, m) == 0); /* condition above 1e30 for M */
    assert_true(mu_transform_covariance(1, 2e303, 0, 8e301, 0, m));
    bsdf_near(m[0], sqrt(0.5 / 2e303), 16 * DBL_EPSILON);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(alphas_are_along_the_axes),
                                       cmocka_unit_test(disney_and_principled),
                                       cmocka_unit_test(cycles_anisotropic),
                                       cmocka_unit_test(openpbr),
                                       cmocka_unit_test(gltf),
                                       cmocka_unit_test(covariance_of_slopes),
                                       cmocka_unit_test(decomposes_known_matrices),
                                       cmocka_unit_test(keeps_the_digits_of_the_small_one),
                                       cmocka_unit_test(round_trip),
                                       cmocka_unit_test(isotropic_maps_have_no_direction),
                                       cmocka_unit_test(highlight_is_where_the_header_says),
                                       cmocka_unit_test(refuses_what_is_out_of_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
