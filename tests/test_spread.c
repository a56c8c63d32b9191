/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_spread.c: reads all over a lobe (core/ibl/spread.c): that they stand where the lobe is, turn with it, follow its mean
 * slope and its tail, and that their number changes without a jump.
 */
#include <string.h>

#include "core/ibl/prefilter.h"
#include "core/ibl/reads.h"
#include "tests/bsdf_fixture.h"

static mu_ibl_plan plan_of(size_t reads) {
    mu_ibl_settings_f settings = mu_ibl_settings_default_f();
    mu_ibl_plan plan;
    settings.samples = reads;
    mu_ibl_plan_make(MU_IBL_LOBE, &settings, &plan);
    return plan;
}

/* A blurred read sees the mean of its kernel: shorter than the direction. */
static double blurred(float roughness) {
    static mu_ibl_tap taps[1024];
    double sum = 0;
    const size_t n = mu_ibl_taps(roughness * roughness, 1024, 512, 8, taps);
    for (size_t i = 0; i < n; i++) sum += (double)taps[i].weight * (double)taps[i].local[2];
    return sum;
}

/* Sum of weights times directions, and the exact mean of f cos over 500² midpoints of the disk below the hemisphere. */
static void mean_of_reads(const mu_ibl_plan *plan, const mu_ibl_lobe_f *lobe, const float wo[3], double mean[2]) {
    mu_ibl_read reads[MU_IBL_READS_MOST];
    const size_t n = mu_ibl_reads(plan, lobe, wo, reads);
    mean[0] = mean[1] = 0;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 2; k++)
            mean[k] += (double)reads[i].weight * (double)reads[i].direction[k] * blurred(reads[i].roughness);
}

static void exact_mean(const mu_ibl_lobe_d *lobe, const double view[3], double mean[2]) {
    enum { SIDE = 500 };
    double points[3 * SIDE], density[SIDE], all = 0;
    mean[0] = mean[1] = 0;
    for (int i = 0; i < SIDE; i++) { /* d omega = dx dy / z */
        const double x = -1 + (2 * i + 1.0) / SIDE;
        size_t count = 0;
        for (int j = 0; j < SIDE; j++) {
            const double y = -1 + (2 * j + 1.0) / SIDE, square = x * x + y * y;
            if (!(square < 1)) continue;
            points[3 * count] = x, points[3 * count + 1] = y, points[3 * count + 2] = sqrt(1 - square), count++;
        }
        assert_true(mu_ibl_density(lobe, view, MU_IBL_REFLECTED, count, points, density));
        for (size_t j = 0; j < count; j++) {
            const double mass = density[j] / points[3 * j + 2];
            all += mass;
            for (int k = 0; k < 2; k++) mean[k] += mass * points[3 * j + (size_t)k];
        }
    }
    for (int k = 0; k < 2; k++) mean[k] /= all;
}

/* From above, what 16 reads leave out is beyond v = 2.2, 1 - tanh 2.2 = 2.4 % of the mass, at most 1 away from the rest's mean. From low
 * views the sphere bends what the sum of round lobes takes for a plane; over all views the means are nearer than half as far as
 * those of the major axis. */
static void test_where_the_lobe_is(void **state) {
    static const struct {
        double sigma[2], cosine;
    } each[] = {{{0.2, 0.05}, 0.8}, {{0.3, 0.3}, 0.95}, {{0.2, 0.1}, 0.3}, {{0.4, 0.1}, 0.6}, {{0.4, 0.1}, 0.3}, {{0.1, 0.1}, 0.2}};
    (void)state;
    const mu_ibl_plan plan = plan_of(16);
    mu_ibl_plan axis;
    mu_ibl_plan_make(MU_IBL_MAJOR_AXIS, &plan.settings, &axis);
    double off[2] = {0, 0};
    for (size_t e = 0; e < sizeof each / sizeof *each; e++) {
        const double z = each[e].cosine, r = sqrt(1 - z * z), view[3] = {r * 0.6, r * 0.8, z};
        const mu_ibl_lobe_d exact = {.sigma = {each[e].sigma[0], each[e].sigma[1]}, .turn = {1, 0}};
        const mu_ibl_lobe_f lobe = {.sigma = {(float)each[e].sigma[0], (float)each[e].sigma[1]}, .turn = {1, 0}};
        const float wo[3] = {(float)view[0], (float)view[1], (float)view[2]};
        double right[2], found[2][2];
        exact_mean(&exact, view, right);
        for (int t = 0; t < 2; t++) {
            mean_of_reads(t ? &axis : &plan, &lobe, wo, found[t]);
            const double away = hypot(found[t][0] - right[0], found[t][1] - right[1]);
            print_message("lobe %zu, %s: %g, %g; exactly %g, %g; off %g\n", e, t ? "axis" : "lobe", found[t][0], found[t][1], right[0],
                          right[1], away);
            if (!t && z >= 0.8) assert_true(away < 0.024);
            off[t] += away;
        }
    }
    assert_true(off[0] < off[1] / 2);
}

/* Lobe, mean slope and view turned about z: so are the reads. Where the lobe's axes are not alike, directions of them are known to some
 * 2^-24 over the square of their difference, a tenth; read by read 1e-4 is ample, for both turns and one in pairs. */
static void test_turns(void **state) {
    (void)state;
    const mu_ibl_plan plans[] = {plan_of(16), plan_of(0)};
    uniform u = {71};
    for (int i = 0; i < 200; i++) {
        const mu_ibl_plan *plan = &plans[i % 2];
        const float z = 0.05f + 0.9f * (float)uniform_double(&u), r = sqrtf(1 - z * z), phi = 6.28f * (float)uniform_double(&u);
        const float turn = 6.28f * (float)uniform_double(&u), c = cosf(turn), s = sinf(turn);
        const float mean[2] = {0.3f * (float)uniform_double(&u), 0.2f};
        const float sigma = 0.02f + 0.2f * (float)uniform_double(&u);
        const mu_ibl_lobe_f lobe = {.sigma = {4 * sigma, sigma}, .turn = {1, 0}, .mean = {mean[0], mean[1]}};
        const mu_ibl_lobe_f turned = {
            .sigma = {4 * sigma, sigma}, .turn = {c, s}, .mean = {c * mean[0] - s * mean[1], s * mean[0] + c * mean[1]}};
        const float wo[3] = {r * cosf(phi), r * sinf(phi), z}, there[3] = {c * wo[0] - s * wo[1], s * wo[0] + c * wo[1], z};
        mu_ibl_read before[MU_IBL_READS_MOST], after[MU_IBL_READS_MOST];
        const size_t n = mu_ibl_reads(plan, &lobe, wo, before);
        assert_int_equal(mu_ibl_reads(plan, &turned, there, after), n);
        float worst[2] = {0, 0}; /* in order, and the other way round: the axis has no sign */
        for (size_t j = 0; j < n; j++)
            for (int way = 0; way < 2; way++) {
                const float *d = before[j].direction;
                const mu_ibl_read *a = &after[way ? n - 1 - j : j];
                const float expected[3] = {c * d[0] - s * d[1], s * d[0] + c * d[1], d[2]};
                for (int k = 0; k < 3; k++) worst[way] = fmaxf(worst[way], fabsf(a->direction[k] - expected[k]));
                worst[way] = fmaxf(worst[way], fmaxf(fabsf(a->weight - before[j].weight), fabsf(a->roughness - before[j].roughness)));
            }
        if (!(fminf(worst[0], worst[1]) < 1e-4f)) fail_msg("case %d: off by %g, %g", i, (double)worst[0], (double)worst[1]);
    }
}

/* A smooth surface of a mean slope is a mirror at the normal (-slope, 1), for reads of all weights and numbers. */
static void test_mean_slope(void **state) {
    (void)state;
    const mu_ibl_plan plans[] = {plan_of(16), plan_of(0), plan_of(1)};
    const mu_ibl_lobe_f lobe = {.sigma = {1e-6f, 1e-6f}, .turn = {1, 0}, .mean = {0.2f, -0.3f}};
    const float wo[3] = {0.48f, 0.36f, 0.8f}, n[3] = {-0.2f, 0.3f, 1}, twice = 2 * (n[0] * wo[0] + n[1] * wo[1] + n[2] * wo[2]) / 1.13f;
    for (size_t p = 0; p < 3; p++) {
        mu_ibl_read reads[MU_IBL_READS_MOST];
        const size_t count = mu_ibl_reads(&plans[p], &lobe, wo, reads);
        for (size_t j = 0; j < count; j++) /* slopes of 10 sigma and roundings */
            for (int k = 0; k < 3; k++) assert_true(fabsf(reads[j].direction[k] - (twice * n[k] - wo[k])) < 1e-4f);
    }
}

/* What a world of radiance 1 + sin(8 x) sees through reads, as roughness and anisotropy change by 1/2000 in ln: the reads' numbers
 * change many times, yet nothing jumps. Directions and widths change no faster than a few times ln sigma does, radiance 8 times
 * that, in [0, 2]: 2000 steps over 4 in ln are 2e-3 each; 8 x 2e-3 x 2 / 2 = 1.6e-2 would be the fastest. A read that came with its full
 * weight, sech² 2 = 0.07 of a sum of 5 to 33, would be 2e-3 to 1.4e-2 at once, on top: against the neighbours' mean change the limit
 * is 1e-3. */
static void test_no_jump(void **state) {
    (void)state;
    const mu_ibl_plan plan = plan_of(0);
    const float wo[3] = {0.5f, 0.3f, 0.81240384f};
    for (int kind = 0; kind < 2; kind++) {
        double last[3] = {0, 0, 0};
        size_t changes = 0, before = 0;
        for (int i = 0; i <= 2000; i++) {
            const float sigma = expf(-5 + 4 * (float)i / 2000);
            const mu_ibl_lobe_f lobe = {.sigma = {kind ? 0.3f : sigma, kind ? 0.3f * expf(-4 + 4 * (float)i / 2000) : 0.004f}, .turn = {1, 0}};
            mu_ibl_read reads[MU_IBL_READS_MOST];
            double seen = 0;
            const size_t n = mu_ibl_reads(&plan, &lobe, wo, reads);
            assert_true(n <= MU_IBL_READS_CHOSEN);
            for (size_t j = 0; j < n; j++) seen += (double)reads[j].weight * (1 + sin(8 * (double)reads[j].direction[0]));
            changes += i > 0 && n != before;
            before = n;
            last[0] = last[1], last[1] = last[2], last[2] = seen;
            if (i >= 2 && !(fabs(last[2] - 2 * last[1] + last[0]) < 1e-3))
                fail_msg("kind %d, step %d, %zu reads: %g, %g, %g", kind, i, n, last[0], last[1], last[2]);
        }
        assert_true(changes >= 4);
    }
}

/* Heavier tails reach further, lighter ones less far, of a lobe that ends before the horizon; GGX's own tail changes nothing. */
static void test_tails(void **state) {
    (void)state;
    const mu_ibl_lobe_f lobe = {.sigma = {0.005f, 0.001f}, .turn = {1, 0}};
    const float wo[3] = {0, 0, 1};
    double reach[3];
    mu_ibl_read plain[MU_IBL_READS_MOST], reads[MU_IBL_READS_MOST];
    mu_ibl_plan plan = plan_of(16);
    mu_ibl_reads(&plan, &lobe, wo, plain);
    for (int kind = 0; kind < 3; kind++) {
        mu_definition d = bsdf_definition(kind == 0 ? MU_BECKMANN : kind == 1 ? MU_GGX : MU_GTR, 0.2, 1, 1, 0, 0, 1);
        float tail[MU_IBL_TAIL];
        for (size_t i = 0; i < MU_IBL_TAIL; i++) tail[i] = (float)mu_ibl_tail_of(&d, mu_ibl_tail_share(i));
        plan = plan_of(16);
        mu_ibl_plan_tail(&plan, tail);
        assert_int_equal(mu_ibl_reads(&plan, &lobe, wo, reads), 16);
        reach[kind] = fabs((double)reads[0].direction[0]);
        for (int j = 0; kind == 1 && j < 16; j++) /* what is 1 to a few roundings */
            for (int k = 0; k < 3; k++) assert_true(fabsf(reads[j].direction[k] - plain[j].direction[k]) < 1e-5f);
    }
    print_message("outermost read: Beckmann %g, GGX %g, GTR of gamma 1 %g\n", reach[0], reach[1], reach[2]);
    assert_true(reach[0] < 0.8 * reach[1] && reach[2] > 1.1 * reach[1]);
}

/* Samples of a pixel look between each other's reads: four at quarters of a step. In the middle of a lobe that is narrow and seen from
 * above, steps in asinh of the slope are even to sinh'(v) - 1, v two steps at most, of (1.4 ln 16 or less) / 8 each: within 45 %. As many
 * reads, and a fourth as far apart: they are narrower; one read has none to look between. */
static void test_phases(void **state) {
    (void)state;
    enum { SAMPLES = 4 };
    mu_ibl_plan plan = plan_of(16);
    const mu_ibl_lobe_f lobe = {.sigma = {0.01f, 0.0005f}, .turn = {1, 0}};
    const float wo[3] = {0, 0, 1};
    double place[2 * SAMPLES];
    mu_ibl_read reads[MU_IBL_READS_MOST];
    mu_ibl_reads(&plan, &lobe, wo, reads);
    const double alone = (double)reads[7].roughness;
    mu_ibl_plan_phases(&plan, SAMPLES + 1); /* rounded down */
    for (size_t phase = 0; phase < SAMPLES; phase++) {
        assert_int_equal(mu_ibl_reads_of_phase(&plan, phase, &lobe, wo, reads), 16);
        for (size_t k = 0; k < 2; k++) place[2 * phase + k] = (double)reads[7 + k].direction[0];
    }
    const double step = fabs(place[1] - place[0]);
    for (size_t i = 0; i < 2 * SAMPLES; i++)
        for (size_t j = 0; j < i; j++) assert_true(fabs(place[i] - place[j]) > 0.55 * 0.25 * step);
    assert_true((double)reads[7].roughness < 0.8 * alone); /* its root is */
    plan = plan_of(1);
    mu_ibl_plan_phases(&plan, SAMPLES);
    const mu_ibl_plan single = plan_of(1);
    for (size_t phase = 0; phase < SAMPLES; phase++) {
        mu_ibl_read one;
        mu_ibl_reads_of_phase(&plan, phase, &lobe, wo, reads);
        mu_ibl_reads(&single, &lobe, wo, &one);
        assert_memory_equal(one.direction, reads[0].direction, sizeof one.direction);
    }
}

/* A lobe that is nearly round, seen from above, needs one read where the mirrored view is, as wide as the lobe: whatever sample of a
 * pixel it is for. One read by order is as wide as the mean of both axes; by need as wide as the sum of few says, 0.73 of the lobe across or
 * more: of ratios from 0.9 on 0.73 * 0.9 / sqrt(0.9) or more of that one's alpha, and no more than it, to the roundings of a root; but
 * every fourth sample's is the wide one, 1 + 12 alpha^1.5 times. */
static void test_nearly_round(void **state) {
    static const float sigmas[] = {1e-4f, 0.01f, 0.1f, 0.5f}, ratios[] = {0.9f, 0.97f, 0.98f, 0.985f, 0.99f, 0.995f, 0.999f, 0.99999f, 1};
    enum { SAMPLES = 4 };
    const mu_ibl_plan single = plan_of(1);
    const float wo[3] = {0, 0, 1};
    size_t alone = 0;
    (void)state;
    for (size_t p = 1; p <= SAMPLES; p += SAMPLES - 1) {
        mu_ibl_plan plan = plan_of(0);
        mu_ibl_plan_phases(&plan, p);
        for (size_t i = 0; i < sizeof sigmas / sizeof *sigmas; i++)
            for (size_t k = 0; k < sizeof ratios / sizeof *ratios; k++)
                for (size_t phase = 0; phase < p; phase++) {
                    const mu_ibl_lobe_f lobe = {.sigma = {sigmas[i], ratios[k] * sigmas[i]}, .turn = {1, 0}};
                    mu_ibl_read one, reads[MU_IBL_READS_MOST];
                    mu_ibl_reads(&single, &lobe, wo, &one);
                    const size_t n = mu_ibl_reads_of_phase(&plan, phase, &lobe, wo, reads);
                    const double middle = (double)reads[n / 2].roughness, alpha = middle * middle / ((double)one.roughness * (double)one.roughness);
                    const double wide = phase == 2 ? 12 * pow(sqrt(2) * (double)sigmas[i], 1.5) : 0;
                    if (!(alpha > 0.69 && alpha < 1.00001 * (1 + wide)))
                        fail_msg("sigma %g, ratio %g, phase %zu: %g", (double)sigmas[i], (double)ratios[k], phase, alpha);
                    for (int c = 0; n == 1 && c < 3; c++) assert_true(fabsf(reads[0].direction[c] - one.direction[c]) < 1e-6f);
                    alone += n == 1;
                }
    }
    assert_true(alone > 0);
}

/* Of GGX of an alpha of 1 every half vector is as likely, so that f cos is the same all around the normal, from whatever view: there a single
 * read looks, to the few roundings of a mirror. */
static void test_roughest(void **state) {
    (void)state;
    const mu_ibl_plan plan = plan_of(1);
    const mu_ibl_lobe_f lobe = {.sigma = {0.70710678f, 0.70710678f}, .turn = {1, 0}};
    for (int i = 1; i <= 20; i++) {
        const float z = (float)i / 20, wo[3] = {-0.6f * sqrtf(1 - z * z), 0.8f * sqrtf(1 - z * z), z};
        mu_ibl_read read;
        mu_ibl_reads(&plan, &lobe, wo, &read);
        assert_true(fabsf(read.direction[0]) + fabsf(read.direction[1]) < 1e-4f && read.direction[2] > 0.9999f);
    }
}

/* What a sum of filtered levels is off from f cos seen from above, of all; both are as the kernel's formula (prefilter.c) and density.c have them,
 * made 1 in sum over 2000 midpoints of the polar angle. */
static double off_from_above(const mu_ibl_lobe_d *lobe, size_t count, const mu_ibl_read *reads) {
    enum { STEPS = 2000 };
    static double points[3 * STEPS], exact[STEPS], sum[STEPS], own[STEPS];
    const double view[3] = {0, 0, 1};
    double all = 0, off = 0;
    for (int i = 0; i < STEPS; i++) {
        const double theta = (i + 0.5) / STEPS * 1.57079632679489662;
        points[3 * i] = sin(theta), points[3 * i + 1] = 0, points[3 * i + 2] = cos(theta), sum[i] = 0;
    }
    assert_true(mu_ibl_density(lobe, view, MU_IBL_REFLECTED, STEPS, points, exact));
    for (int i = 0; i < STEPS; i++) all += exact[i] *= points[3 * i];
    for (size_t k = 0; k < count; k++) {
        const double a2 = pow((double)reads[k].roughness, 4);
        double whole = 0;
        for (int i = 0; i < STEPS; i++) {
            const double c2 = (1 + points[3 * i + 2]) / 2, d = c2 * (a2 - 1) + 1;
            whole += own[i] = points[3 * i + 2] * points[3 * i] / (d * d);
        }
        for (int i = 0; i < STEPS; i++) sum[i] += (double)reads[k].weight * own[i] / whole;
    }
    for (int i = 0; i < STEPS; i++) off += fabs(exact[i] / all - sum[i]);
    return off;
}

static void test_wide_reads(void **state) {
    (void)state;
    const mu_ibl_plan plans[2] = {plan_of(1), plan_of(8)};
    const float wo[3] = {0, 0, 1};
    for (int i = 0; i < 2; i++) {
        const double sigma = (i ? 0.36 : 0.16) / sqrt(2);
        const mu_ibl_lobe_d exact = {.sigma = {sigma, sigma}, .turn = {1, 0}};
        const mu_ibl_lobe_f lobe = {.sigma = {(float)sigma, (float)sigma}, .turn = {1, 0}};
        double off[2];
        for (int k = 0; k < 2; k++) {
            mu_ibl_read reads[MU_IBL_READS_MOST];
            const size_t n = mu_ibl_reads(&plans[k], &lobe, wo, reads);
            off[k] = off_from_above(&exact, n, reads);
        }
        print_message("alpha %g: one read is off by %g, eight by %g\n", i ? 0.36 : 0.16, off[0], off[1]);
        assert_true(off[1] < off[0] / 2);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_roughest), cmocka_unit_test(test_nearly_round), cmocka_unit_test(test_wide_reads), cmocka_unit_test(test_phases), cmocka_unit_test(test_where_the_lobe_is), cmocka_unit_test(test_turns),
                                       cmocka_unit_test(test_mean_slope), cmocka_unit_test(test_no_jump), cmocka_unit_test(test_tails)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
