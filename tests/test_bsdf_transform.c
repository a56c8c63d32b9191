/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_transform.c: what a linear map must do to a microsurface, told without the core's own formulas.
 * Tolerance 1e-12: a dozen double operations and inputs whose own rounding is amplified by M (condition below
 * 100).
 */
#include "tests/bsdf_fixture.h"

enum { CASES = 200 };
static const double tolerance = 1e-12;

static const struct {
    mu_ndf ndf;
    double alpha, gamma;
} bases[] = {
    {MU_GGX, 0.3, 2}, {MU_BECKMANN, 0.4, 2}, {MU_GTR, 0.2, 0.7}, {MU_GTR, 0.0121, 1.7}, {MU_GTR, 0.5, 4.5}};
enum { BASES = sizeof bases / sizeof bases[0] };

/* Eq. (7) and (8) with the classic D of Heitz 2014, for M = diag(alpha/alpha_x, alpha/alpha_y), Eq. (29). */
static void equals_classic_anisotropy(void **state) {
    (void)state;
    uniform u = {1};
    bsdf b;
    for (int i = 0; i < CASES; i++) {
        const double alpha = 0.3, ax = 0.05 + uniform_double(&u), ay = 0.05 + uniform_double(&u);
        const mu_ndf ndf = i % 2 ? MU_GGX : MU_BECKMANN;
        const mu_definition d = bsdf_definition(ndf, alpha, 2, alpha / ax, 0, 0, alpha / ay);
        double wo[3], m[3];
        bsdf_direction(0.05 + 0.95 * uniform_double(&u), 7 * uniform_double(&u), wo);
        bsdf_direction(0.3 + 0.7 * uniform_double(&u), 7 * uniform_double(&u), m);
        bsdf_bind_double(&b, &d, wo);
        const double x = pow(m[0] / m[2] / ax, 2) + pow(m[1] / m[2] / ay, 2), cos4 = pow(m[2], 4);
        const double expected = (ndf == MU_GGX ? 1 / pow(1 + x, 2) : exp(-x)) / (TEST_PI * ax * ay * cos4);
        bsdf_near(mu_normal_d(&b.d, m).D, expected, tolerance * (1 + x));
        const double at = hypot(ax * wo[0], ay * wo[1]) / wo[2], c = 1 / at;
        const double lambda =
            ndf == MU_GGX ? (sqrt(1 + at * at) - 1) / 2 : (exp(-c * c) / (c * sqrt(TEST_PI)) - erfc(c)) / 2;
        bsdf_near(1 + mu_view_d(&b.d, wo).Lambda, 1 + lambda, tolerance);
    }
}

static void turned(const double w[3], double phi, double out[3]) {
    out[0] = cos(phi) * w[0] - sin(phi) * w[1], out[1] = sin(phi) * w[0] + cos(phi) * w[1], out[2] = w[2];
}

/* f, pdf and sigma under M at (wo, wi) equal those under R M at (R wo, R wi); R a rotation, or a mirror. */
static void isometry_moves_with_the_surface(void **state) {
    (void)state;
    uniform u = {2};
    for (int i = 0; i < CASES; i++) {
        const int k = i % BASES, mirror = i % 3 == 0;
        double m[4], wo[3], wi[3], to[3], ti[3];
        bsdf a, b;
        bsdf_random_map(&u, m);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wo);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wi);
        const double phi = 7 * uniform_double(&u), c = cos(phi), s = sin(phi), sign = mirror ? -1 : 1;
        turned(wo, phi, to), turned(wi, phi, ti);
        to[0] *= sign, ti[0] *= sign;
        const mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, m[0], m[1], m[2], m[3]);
        const mu_definition e =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, sign * (c * m[0] - s * m[2]),
                            sign * (c * m[1] - s * m[3]), s * m[0] + c * m[2], s * m[1] + c * m[3]);
        mu_value_d x, y;
        bsdf_bind_double(&a, &d, wo), bsdf_bind_double(&b, &e, to);
        mu_eval_d(&a.d, wi, &x), mu_eval_d(&b.d, ti, &y);
        bsdf_near(y.f[0], x.f[0],
                  1e-9); /* Beckmann's exponent multiplies the rounding of the turned directions */
        bsdf_near(y.pdf, x.pdf, 1e-9);
        bsdf_near(y.pdf_reverse, x.pdf_reverse, 1e-9);
        bsdf_near(mu_view_d(&b.d, to).sigma, mu_view_d(&a.d, wo).sigma, tolerance);
    }
}

/* Stretching a shape-invariant surface q times is dividing its roughness by q, from 1e-12 to 1e12. */
static void scale_trades_with_roughness(void **state) {
    (void)state;
    uniform u = {3};
    for (int i = 0; i < CASES; i++) {
        const double q = pow(10, 24 * uniform_double(&u) - 12);
        double m[4], wo[3], wi[3];
        bsdf a, b;
        bsdf_random_map(&u, m);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wo);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wi);
        const mu_ndf ndf = i % 2 ? MU_GGX : MU_BECKMANN;
        const mu_definition d = bsdf_definition(ndf, 0.5, 2, m[0], m[1], m[2], m[3]);
        const mu_definition e = bsdf_definition(ndf, 0.5 * q, 2, q * m[0], q * m[1], q * m[2], q * m[3]);
        mu_value_d x, y;
        bsdf_bind_double(&a, &d, wo), bsdf_bind_double(&b, &e, wo);
        mu_eval_d(&a.d, wi, &x), mu_eval_d(&b.d, wi, &y);
        bsdf_near(y.f[0], x.f[0], 1e-10);
        bsdf_near(y.pdf, x.pdf, 1e-10);
    }
}

/* The plan without matrices, taken where M only turns, mirrors and scales, against the general one, taken where M is
 * pushed per hit: the same values, and in the samplers' own frame the same draws. */
static void uniform_plan_equals_general(void **state) {
    (void)state;
    uniform u = {7};
    for (int i = 0; i < CASES; i++) {
        const int k = i % BASES;
        const double scale = pow(10, 4 * uniform_double(&u) - 2), phi = 7 * uniform_double(&u);
        const double c = i % 3 ? scale : scale * cos(phi), s = i % 3 ? 0 : scale * sin(phi),
                     sign = i % 2 ? -1 : 1;
        const mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, c, -s * sign, s, c * sign);
        const mu_definition same =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, scale, 0, 0, scale);
        double wo[3], wi[3];
        bsdf a, b;
        mu_closure_d general;
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wo);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wi);
        bsdf_bind_double(&a, &d, wo), bsdf_bind_double(&b, &same, wo);
        assert_true(mu_bind_d(a.d.surface, wo, d.transform, &general));
        assert_ptr_not_equal(a.d.kernel, general.kernel);
        mu_value_d x, y;
        mu_eval_d(&a.d, wi, &x), mu_eval_d(&general, wi, &y);
        bsdf_near(x.f[0], y.f[0], tolerance);
        bsdf_near(x.pdf, y.pdf, tolerance);
        bsdf_near(x.pdf_reverse, y.pdf_reverse, tolerance);
        assert_true(mu_bind_d(b.d.surface, wo, same.transform, &general));
        const double three[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
        mu_sample_d p, q;
        mu_sample_wi_d(&a.d, three, &p), mu_sample_wi_d(&general, three, &q);
        assert_int_equal(p.rejected, q.rejected);
        for (int j = 0; j < 3; j++) assert_true(fabs(p.wi[j] - q.wi[j]) < tolerance);
        if (!p.rejected) bsdf_near(p.pdf, q.pdf, tolerance / wo[2]);
    }
}

/* Reciprocity: f(wo, wi) = f(wi, wo), and the two pdfs change places. */
static void is_reciprocal(void **state) {
    (void)state;
    uniform u = {4};
    for (int i = 0; i < CASES; i++) {
        const int k = i % BASES;
        double m[4], wo[3], wi[3];
        bsdf a, b;
        bsdf_random_map(&u, m);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wo);
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wi);
        const mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, m[0], m[1], m[2], m[3]);
        mu_value_d x, y;
        bsdf_bind_double(&a, &d, wo), bsdf_bind_double(&b, &d, wi);
        mu_eval_d(&a.d, wi, &x), mu_eval_d(&b.d, wo, &y);
        bsdf_near(y.f[0], x.f[0], tolerance);
        bsdf_near(y.pdf_reverse, x.pdf, tolerance);
        bsdf_near(y.pdf, x.pdf_reverse, tolerance);
    }
}

/* Eq. (3): D_M cos integrates to 1, by a midpoint rule in the slope plane whose angle and log radius are
 * periodic or decay: here to 1e-6 (the tail beyond slope 1e4 of the heaviest base). */
static void is_normalised(void **state) {
    (void)state;
    uniform u = {5};
    for (int i = 0; i < 2 * BASES; i++) {
        const int k = i % BASES;
        double m[4], wo[3] = {0, 0, 1}, sum = 0;
        bsdf b;
        bsdf_random_map(&u, m);
        const mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, m[0], m[1], m[2], m[3]);
        bsdf_bind_double(&b, &d, wo);
        const double step = 0.05, angle = TEST_PI / 128;
        for (double s = -14; s < 12; s += step) {
            for (int j = 0; j < 256; j++) {
                const double r = exp(s), length = sqrt(1 + r * r);
                const double n[3] = {r * cos(j * angle) / length, r * sin(j * angle) / length, 1 / length};
                sum += mu_normal_d(&b.d, n).D * pow(n[2], 4) * r * r * step * angle; /* P22, Eq. (4) */
            }
        }
        bsdf_near(sum, 1, 1e-6);
    }
}

/* What a double can hold and is well conditioned is a map, however large or small. */
static void takes_every_scale(void **state) {
    (void)state;
    mu_complaint why;
    const double most = 1.5e308, least = 1e-300, wo[3] = {0.6, 0, 0.8}, wi[3] = {0, 0.6, 0.8};
    const double maps[][4] = {
        {most, most, -most, most}, {most, most, -most, 1.4e308},  {most, 0, 0, most},
        {least, 0, 0, least},      {least, least, -least, least}, {1e-170, 0, 0, 1e-170},
        {1e160, 0, 0, 1e160},      {1e160, 1e160, 0, 2e160}};
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
        const mu_definition d =
            bsdf_definition(MU_GGX, 0.3, 2, maps[i][0], maps[i][1], maps[i][2], maps[i][3]);
        bsdf b;
        mu_value_d value;
        assert_true(mu_definition_check(&d, &why));
        bsdf_bind_double(&b, &d, wo);
        mu_eval_d(&b.d, wi, &value);
        assert_true(isfinite(value.f[0]) && isfinite(value.pdf) && value.f[0] >= 0 && value.pdf >= 0);
        const double sigma =
            mu_view_d(&b.d, wo).sigma; /* between cos and what slopes without end project to */
        assert_true(isfinite(sigma) && sigma >= wo[2]);
        if (maps[i][0] > 1) bsdf_near(sigma, wo[2], tolerance); /* flat */
    }
}

static void refuses_singular_maps(void **state) {
    (void)state;
    mu_complaint why;
    static const double bad[][4] = {{0, 0, 0, 0}, {1, 2, 2, 4}, {1, 0, 0, NAN}, {INFINITY, 0, 0, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        const mu_definition d = bsdf_definition(MU_GGX, 0.3, 2, bad[i][0], bad[i][1], bad[i][2], bad[i][3]);
        assert_false(mu_definition_check(&d, &why));
        assert_string_equal(why.field, "transform");
        const mu_definition good = mu_definition_default();
        const double up[3] = {0, 0, 1};
        bsdf b;
        bsdf_bind_double(&b, &good, up);
        assert_false(mu_bind_d(b.d.surface, up, bad[i], &b.d));
    }
}

/* An ellipsoid of little roughness along one axis keeps its digits whichever row of A that is: |det M| = |A n|³ / |det A|, and
 * M M^T and the tilt, -M^T b, do not feel the order of the rows. */
static void ellipsoid_keeps_the_digits_of_the_small_one(void **state) {
    (void)state;
    static const double thetas[][3] = {{0.3, -0.7, 0.5}, {-1.1, 0.2, 2}, {0, 0.9, -0.4}, {0.6, 0, 0}};
    static const int orders[][3] = {{0, 1, 2}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}};
    for (int i = 0; i < 4; i++)
        for (double small = 1; small > 1e-13; small /= 10) {
            const double alpha[2] = {0.5, small};
            double A[9], first[5];
            mu_ellipsoid_matrix(alpha, thetas[i], A);
            const double seen = hypot(hypot(A[2], A[5]), A[8]);
            for (int order = 0; order < 6; order++) {
                double B[9], m[4], tilt[2];
                for (int k = 0; k < 9; k++) B[k] = A[3 * orders[order][k / 3] + k % 3];
                assert_true(mu_ellipsoid(B, m, tilt));
                bsdf_near(fabs(m[0] * m[3] - m[1] * m[2]), seen * seen * seen / (0.5 * small), 1e-13);
                const double got[5] = {m[0] * m[0] + m[1] * m[1], m[0] * m[2] + m[1] * m[3],
                                       m[2] * m[2] + m[3] * m[3], fabs(tilt[0]), fabs(tilt[1])};
                for (int k = 0; k < 5; k++) {
                    if (order == 0) first[k] = got[k];
                    const double most = fmax(first[0], first[2]), scale = k < 3 ? most : fmax(1, sqrt(most));
                    assert_true(fabs(got[k] - first[k]) <= 1e-12 * scale);
                }
            }
        }
}

/* Under an ill-conditioned M the composed map is M times the ellipsoid's own, turned, and its determinant moves by no more than
 * twice what rounding M does to its own, |M00 M11| + |M01 M10| over |det M|: S of ellipsoid.c is at most 2 of those, |det| moves
 * by 2 delta S, and delta is 8 units: six roundings of an entry of Q, its product and the sum. 16 more are those of det Q itself. */
static void ellipsoid_composes_as_well_as_M_allows(void **state) {
    (void)state;
    const double unit = 0x1p-53, tilt[2] = {0.2, -0.4}, I[4] = {1, 0, 0, 1};
    double worst_of_products = 0;
    for (int i = 0; i < 400; i++) {
        const double turn = 0.7 * i, way = 1.9 * i, thin = i % 2 ? -1e-7 : 1e-7, c = cos(turn), s = sin(turn),
                     e = cos(way), f = sin(way);
        const double M[4] = {c * e - s * thin * f, -c * f - s * thin * e, s * e + c * thin * f,
                             -s * f + c * thin * e};
        double A[9], Q[4], P[4], own[2] = {tilt[0], tilt[1]}, all[2] = {tilt[0], tilt[1]};
        mu_ellipsoid_matrix((const double[]){i % 3 ? 1e-5 : 0.3, 0.3},
                            (const double[]){0.4, -0.2, 1.57 + 0.002 * (i % 40)}, A);
        assert_true(mu_ellipsoid_under(A, I, Q, own) && mu_ellipsoid_under(A, M, P, all));
        const double det_Q = Q[0] * Q[3],
                     det_M = fma(M[0], M[3], -M[1] * M[2]) - fma(M[1], M[2], -M[1] * M[2]),
                     det_P = fma(P[0], P[3], -P[1] * P[2]) - fma(P[1], P[2], -P[1] * P[2]);
        const double by_M = (fabs(M[0] * M[3]) + fabs(M[1] * M[2])) / fabs(det_M);
        assert_true(fabs(fabs(det_P / (det_M * det_Q)) - 1) <= unit * (2 * 8 * 2 * by_M + 16));
        double plain[4], largest = 0;
        for (int k = 0; k < 4; k++) plain[k] = M[k / 2 * 2] * Q[k % 2] + M[k / 2 * 2 + 1] * Q[2 + k % 2];
        for (int k = 0; k < 4; k++) largest = fmax(largest, fabs(plain[k]));
        for (int k = 0; k < 4; k++) { /* P P^T, and the tilt as P takes it along */
            const int x = k / 2 * 2, y = k % 2 * 2;
            bsdf_near((P[x] * P[y] + P[x + 1] * P[y + 1]) / largest / largest + 2,
                      (plain[x] * plain[y] + plain[x + 1] * plain[y + 1]) / largest / largest + 2, 1e-14);
        }
        const double reach = largest * hypot(own[0], own[1]);
        for (int k = 0; k < 4; k += 2)
            bsdf_near((P[k] * all[0] + P[k + 1] * all[1]) / reach + 2,
                      (plain[k] * own[0] + plain[k + 1] * own[1]) / reach + 2, 1e-14);
        const double det_plain =
            fma(plain[0], plain[3], -plain[1] * plain[2]) - fma(plain[1], plain[2], -plain[1] * plain[2]);
        worst_of_products =
            fmax(worst_of_products, fabs(det_plain / (det_M * det_Q) - 1) / (unit * (32 * by_M + 16)));
    }
    assert_true(worst_of_products > 20); /* a product of the two would not do */
}

/* What the library would take for an index, and tilts whose square in units of the roughness is no number. */
static void refuses_what_is_no_surface(void **state) {
    (void)state;
    static const char *const fields[] = {"ndf", "ndf", "sampler", "masking", "smith", "multiple", "fresnel"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        mu_complaint why;
        mu_definition d = mu_definition_default();
        if (i == 0) d.ndf = MU_NDF_COUNT;
        if (i == 1) d.ndf = (mu_ndf)-1;
        if (i == 2) d.sampler = MU_SAMPLER_COUNT;
        if (i == 3) d.masking = MU_MASKING_COUNT;
        if (i == 4) d.smith = MU_SMITH_COUNT;
        if (i == 5) d.multiple = MU_SCATTERING_COUNT;
        if (i == 6) d.fresnel = (mu_fresnel_kind)(MU_FRESNEL_CONDUCTOR + 1);
        assert_false(mu_definition_check(&d, &why));
        assert_string_equal(why.field, fields[i]);
    }
    static const mu_ndf ndfs[] = {MU_GGX, MU_BECKMANN, MU_GTR, MU_STD};
    for (size_t i = 0; i < sizeof ndfs / sizeof ndfs[0]; i++) {
        static const double alphas[] = {0, 5e-324, 1e-200, 1e-130};
        for (int k = 0; k < 4; k++) {
            mu_complaint why;
            mu_definition d = bsdf_definition(ndfs[i], alphas[k], 3, 1, 0, 0, 1);
            d.tilt[0] = 0.5;
            assert_int_equal(mu_definition_check(&d, &why), k == 0 || k == 3);
        }
    }
}

/* Lambda overflows where both directions all but lie on the horizon: G2 is 0 there, not 0 times infinity. */
static void is_finite_at_the_horizon(void **state) {
    (void)state;
    for (int form = 0; form < MU_MASKING_COUNT; form++) {
        mu_definition d = bsdf_definition(MU_GGX, 1e20, 2, 1, 0, 0, 1);
        d.masking = (mu_masking_form)form;
        const double w[3] = {1, 0, 1e-300};
        bsdf b;
        bsdf_bind_double(&b, &d, w);
        const double G2 = mu_pair_d(&b.d, w).G2;
        assert_true(G2 >= 0 && G2 <= 1e-100);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_classic_anisotropy),
                                       cmocka_unit_test(isometry_moves_with_the_surface),
                                       cmocka_unit_test(scale_trades_with_roughness),
                                       cmocka_unit_test(uniform_plan_equals_general),
                                       cmocka_unit_test(is_reciprocal),
                                       cmocka_unit_test(is_normalised),
                                       cmocka_unit_test(takes_every_scale),
                                       cmocka_unit_test(refuses_singular_maps),
                                       cmocka_unit_test(ellipsoid_keeps_the_digits_of_the_small_one),
                                       cmocka_unit_test(ellipsoid_composes_as_well_as_M_allows),
                                       cmocka_unit_test(refuses_what_is_no_surface),
                                       cmocka_unit_test(is_finite_at_the_horizon)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
