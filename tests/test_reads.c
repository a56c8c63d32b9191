/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_reads.c: what every technique of image-based lighting promises of its reads, whatever lobe and view it is given; and that
 * filtered importance sampling integrates the lobe.
 */
#include "core/ibl/globe.h"
#include "core/ibl/reads.h"

#include "tests/bsdf_fixture.h"

static const mu_ibl_technique techniques[] = {MU_IBL_SPLIT, MU_IBL_BENT_NORMAL, MU_IBL_MAJOR_AXIS, MU_IBL_LOBE, MU_IBL_FILTERED};

static mu_ibl_plan plan_of(mu_ibl_technique technique, size_t reads) {
    mu_ibl_settings_f settings = mu_ibl_settings_default_f();
    mu_ibl_plan plan;
    settings.samples = reads;
    mu_ibl_plan_make(technique, &settings, &plan);
    return plan;
}

/* Directions are unit and weights 1 in all, each sum of some 100 floats and the mirror's few products: 64 roundings of 2^-24 each are
 * 4e-6, of a sum of squares twice that. */
static void check(const mu_ibl_plan *plan, const mu_ibl_lobe_f *lobe, const float wo[3], size_t most) {
    mu_ibl_read reads[MU_IBL_READS_MOST];
    const size_t n = mu_ibl_reads(plan, lobe, wo, reads);
    double sum = 0;
    assert_true(n >= 1 && n <= most);
    for (size_t i = 0; i < n; i++) {
        const float *d = reads[i].direction;
        const double square = (double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2];
        if (!(fabs(square - 1) < 1e-5))
            fail_msg("technique %d, sigma %g %g, wo.z %g: read %zu is %g long", (int)plan->technique, (double)lobe->sigma[0],
                     (double)lobe->sigma[1], (double)wo[2], i, sqrt(square));
        assert_true(reads[i].roughness >= 0 && reads[i].roughness <= 1);
        assert_true(reads[i].weight >= 0 && reads[i].weight <= 1.00001f);
        sum += (double)reads[i].weight;
    }
    assert_true(fabs(sum - 1) < 1e-5);
}

static void test_any_lobe_and_view(void **state) {
    static const float sigmas[] = {0, 1e-30f, 1e-6f, 0.01f, 0.3f, 1, 30, 1e10f, 1e30f}, cosines[] = {1e-30f, 1e-6f, 0.01f, 0.4f, 0.99f, 1};
    static const size_t counts[] = {1, 2, 7, 16, 64};
    (void)state;
    for (size_t t = 0; t < sizeof techniques / sizeof *techniques; t++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            const mu_ibl_plan plan = plan_of(techniques[t], counts[c]);
            for (size_t i = 0; i < sizeof sigmas / sizeof *sigmas; i++)
                for (size_t j = 0; j <= i; j++)
                    for (size_t k = 0; k < sizeof cosines / sizeof *cosines; k++)
                        for (int side = 0; side < 3; side++) {
                            const float z = cosines[k], r = sqrtf(1 - z * z), phi = 0.7f * (float)side;
                            const mu_ibl_lobe_f lobe = {.sigma = {sigmas[i], sigmas[j]}, .turn = {0.6f, 0.8f}};
                            const float wo[3] = {r * cosf(phi), r * sinf(phi), z};
                            check(&plan, &lobe, wo, counts[c]);
                        }
        }
}

/* Of several views of a lobe at a time: the very same. */
static void test_of_views(void **state) {
    uniform u = {51};
    (void)state;
    for (size_t t = 0; t < sizeof techniques / sizeof *techniques; t++)
        for (size_t views = 1; views <= MU_IBL_AXES; views += 5) {
            const mu_ibl_plan plan = plan_of(techniques[t], 1 + views);
            const mu_ibl_lobe_f lobe = {.sigma = {2 * uniform_float(&u), 0.1f * uniform_float(&u)}, .turn = {0.6f, 0.8f}};
            static mu_ibl_view many[MU_IBL_AXES];
            float wo[3][MU_IBL_AXES];
            for (size_t i = 0; i < MU_IBL_AXES; i++) {
                const float z = 0.01f + 0.99f * uniform_float(&u), phi = 6.28f * uniform_float(&u), r = sqrtf(1 - z * z);
                wo[0][i] = r * cosf(phi), wo[1][i] = r * sinf(phi), wo[2][i] = z;
            }
            mu_ibl_reads_of_views(&plan, &lobe, views, wo, many);
            for (size_t i = 0; i < views; i++) {
                mu_ibl_read one[MU_IBL_READS_MOST];
                assert_int_equal(many[i].count, mu_ibl_reads(&plan, &lobe, (const float[3]){wo[0][i], wo[1][i], wo[2][i]}, one));
                for (size_t j = 0; j < many[i].count; j++) {
                    assert_true(many[i].x[j] == one[j].direction[0] && many[i].y[j] == one[j].direction[1]);
                    assert_true(many[i].z[j] == one[j].direction[2]);
                    assert_true(many[i].roughness[j] == one[j].roughness && many[i].weight[j] == one[j].weight);
                }
            }
        }
}

/* Sums of reads, of one level or of several, against one read after the other. All terms are positive, texels 0.5 to 1: a sum of 64 reads of
 * two levels, weights of 5 roundings each, is right to 128 + 8 roundings, and so is the other: 272 * 2^-24 of it. Texels are random:
 * a wrong one would be seen at once. */
static void test_sums(void **state) {
    enum { LEVELS = 5 };
    static const size_t sides[LEVELS] = {64, 32, 32, 32, 16};
    static float memory[4 * (66 * 66 + 3 * 34 * 34 + 18 * 18)];
    uniform u = {52};
    mu_ibl_globe globe;
    (void)state;
    assert_int_equal(mu_ibl_globe_floats(LEVELS, sides), sizeof memory / sizeof *memory);
    mu_ibl_globe_lay(&globe, LEVELS, sides, memory);
    for (size_t i = 0; i < sizeof memory / sizeof *memory; i++) memory[i] = 0.5f + uniform_float(&u) / 2;
    for (int run = 0; run < 400; run++) {
        mu_ibl_batch batch = {.count = 1 + (size_t)run % MU_IBL_BATCH};
        float level = run % 3 ? (float)(LEVELS - 1) * uniform_float(&u) : (float)(run % LEVELS), sum[4] = {0.25f, 0, 0, 0}, one[4] = {0.25f, 0, 0, 0};
        for (size_t i = 0; i < batch.count; i++) {
            const float z = 2 * uniform_float(&u) - 1, phi = 6.28f * uniform_float(&u), r = sqrtf(1 - z * z);
            if (run % 2) level = (float)(LEVELS - 1) * uniform_float(&u);
            batch.x[i] = r * cosf(phi), batch.y[i] = r * sinf(phi), batch.z[i] = z;
            batch.level[i] = level, batch.weight[i] = 0.1f + uniform_float(&u);
            mu_ibl_globe_add(&globe, (const float[3]){batch.x[i], batch.y[i], z}, level, batch.weight[i], one);
        }
        mu_ibl_globe_sum(&globe, &batch, sum);
        for (int k = 0; k < 4; k++)
            if (!(fabs((double)sum[k] / (double)one[k] - 1) < 272 * 0x1p-24))
                fail_msg("%zu reads, level %g: %g, one by one %g", batch.count, (double)level, (double)sum[k], (double)one[k]);
    }
}

/* Mean squares of the distance from the mirrored view along and across it, of 64 reads, against a million midpoints of the integral of f cos
 * (density.c). A read stands in the middle of an eighth of the radial mass: of the outermost, whose mean square is about a third of
 * all, that is off by the half at most, and no other by more; together a third. A lobe of other roughness is so by its square. */
static void test_filtered_integrates(void **state) {
    const mu_ibl_plan plan = plan_of(MU_IBL_FILTERED, 64);
    const mu_ibl_lobe_f lobe = {.sigma = {0.2f, 0.05f}, .turn = {1, 0}};
    const float wo[3] = {0.6f, 0, 0.8f};
    mu_ibl_read reads[MU_IBL_READS_MOST];
    double found[2] = {0, 0}, right[2] = {0, 0}, all = 0;
    (void)state;
    assert_int_equal(mu_ibl_reads(&plan, &lobe, wo, reads), 64);
    for (int i = 0; i < 64; i++)
        for (int k = 0; k < 2; k++) {
            const double away = (double)reads[i].direction[k] - (k ? 0.0 : -0.6);
            found[k] += (double)reads[i].weight * away * away;
        }
    const mu_ibl_lobe_d exact = {.sigma = {0.2, 0.05}, .turn = {1, 0}};
    const double view[3] = {0.6, 0, 0.8};
    enum { SIDE = 1000 };
    static double points[3 * SIDE], density[SIDE];
    for (int i = 0; i < SIDE; i++) { /* over the unit disk below the hemisphere: d omega = dx dy / z */
        const double x = -1 + (2 * i + 1.0) / SIDE;
        for (int j = 0; j < SIDE; j++) {
            const double y = -1 + (2 * j + 1.0) / SIDE, square = x * x + y * y;
            points[3 * j] = square < 1 ? x : 0, points[3 * j + 1] = square < 1 ? y : 0, points[3 * j + 2] = square < 1 ? sqrt(1 - square) : 1;
        }
        assert_true(mu_ibl_density(&exact, view, MU_IBL_REFLECTED, SIDE, points, density));
        for (int j = 0; j < SIDE; j++) {
            const double y = -1 + (2 * j + 1.0) / SIDE;
            if (!(x * x + y * y < 1)) continue;
            const double mass = density[j] / points[3 * j + 2];
            all += mass, right[0] += mass * (x + 0.6) * (x + 0.6), right[1] += mass * y * y;
        }
    }
    for (int k = 0; k < 2; k++) {
        print_message("mean square along %d: %g, exactly %g\n", k, found[k], right[k] / all);
        assert_true(fabs(found[k] / (right[k] / all) - 1) < 1.0 / 3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_any_lobe_and_view), cmocka_unit_test(test_of_views), cmocka_unit_test(test_sums),
                                       cmocka_unit_test(test_filtered_integrates)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
