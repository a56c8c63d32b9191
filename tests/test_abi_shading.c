/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_abi_shading.c: the hot half of the contract, for both plugins and every plan: batches give the bits of
 * the scalar calls at any stride, threads give the bits of one thread (run under the thread sanitizer too),
 * lobe masks are obeyed, and no answer is negative, NaN or infinite.
 */
#include "tests/abi_host.h"

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { N = 257, THREADS = 4, CLOSURE = 4096 };
static const float SLOTS[16] = {1, 2, 0, 1, 0.5f, 1.3f};

/* One material of one type with its plan. */
typedef struct subject {
    const musurf_material_type *type;
    musurf_material *material;
    musurf_plan plan;
    _Bool visible; /* draws visible normals: weights are F G2/G1 <= 1; those of D cos may exceed it, and a
                      * few flakes */
} subject;

static void each_subject(void (*body)(const subject *)) {
    for (int t = 0; t < ABI_TYPES; t++)
        for (int i = 0; abi_words(abi_type(t), i); i++) {
            subject s = {.type = abi_type(t)};
            s.visible =
                !strstr(abi_words(s.type, i), "sampler=ndf") && !strstr(abi_words(s.type, i), "footprint=");
            s.material = abi_material(s.type, NULL, abi_words(s.type, i));
            assert_non_null(s.material);
            s.plan = abi_plan(s.type, s.material);
            assert_true(s.plan.closure_bytes <= CLOSURE);
            body(&s);
            s.type->release(s.material);
        }
}

static void strides(const subject *s) {
    const musurf_material_type *type = s->type;
    unsigned char *closures = aligned_alloc(64, (size_t)N * CLOSURE);
    for (uint32_t i = 0; i < N; i++) {
        float wo[3];
        abi_direction(i, wo);
        assert_true(type->setup(s->material, wo, SLOTS, 0, closures + (size_t)i * CLOSURE) != 0);
    }
    static struct padded { float v[3], padding[2]; } wi[N], u[N];
    static struct answer {
        musurf_value value;
        uint32_t after;
    } values[N];
    static struct drawn {
        musurf_sample sample;
        uint32_t after;
    } samples[N];
    for (uint32_t i = 0; i < N; i++) abi_direction(i + 1000, wi[i].v), abi_uniforms(i, u[i].v);
    const size_t counts[] = {0, 1, 3, 64, N};
    for (unsigned mode = 0; mode < 4; mode++) {
        const size_t closure_stride = mode & 1 ? CLOSURE : 0, stride = mode & 2 ? sizeof wi[0] : 0;
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
            memset(values, 0x77, sizeof values);
            memset(samples, 0x77, sizeof samples);
            type->eval_batch(closures, closure_stride, wi[0].v, stride, MUSURF_ALL_LOBES, &values[0].value,
                             sizeof values[0], counts[c]);
            type->sample_batch(closures, closure_stride, u[0].v, stride, MUSURF_ALL_LOBES, &samples[0].sample,
                               sizeof samples[0], counts[c]);
            for (size_t i = 0; i < N; i++) {
                assert_int_equal(values[i].after, 0x77777777);
                assert_int_equal(samples[i].after, 0x77777777);
                if (i >= counts[c]) {
                    assert_int_equal(values[i].value.lobes, 0x77777777);
                    assert_int_equal(samples[i].sample.lobe, 0x77777777);
                    continue;
                }
                musurf_value value;
                musurf_sample sample;
                const unsigned char *closure = closures + i * closure_stride;
                const size_t j = stride ? i : 0;
                type->eval(closure, wi[j].v, MUSURF_ALL_LOBES, &value);
                type->sample(closure, u[j].v, MUSURF_ALL_LOBES, &sample);
                assert_memory_equal(&value, &values[i].value, sizeof value);
                assert_memory_equal(&sample, &samples[i].sample, sizeof sample);
            }
        }
    }
    free(closures);
}

static void batches_give_the_scalar_bits(void **state) {
    (void)state;
    each_subject(strides);
}

/* What one thread sees of a material. */
typedef struct view {
    const subject *subject;
    musurf_value values[N];
    musurf_sample samples[N];
    float pdf[N], albedo[N][3];
    _Alignas(64) unsigned char closure[CLOSURE];
} view;

static void *shade(void *argument) {
    view *v = argument;
    const musurf_material_type *type = v->subject->type;
    for (uint32_t i = 0; i < N; i++) {
        float wo[3], wi[3], u[3];
        abi_direction(i, wo), abi_direction(i + 1000, wi), abi_uniforms(i, u);
        type->setup(v->subject->material, wo, SLOTS, 0, v->closure);
        type->eval(v->closure, wi, MUSURF_ALL_LOBES, &v->values[i]);
        type->sample(v->closure, u, MUSURF_ALL_LOBES, &v->samples[i]);
        v->pdf[i] = type->pdf(v->closure, wi, MUSURF_ALL_LOBES);
        type->albedo(v->closure, v->albedo[i]);
    }
    /* compile and describe are [any] too */
    musurf_material *mine = abi_material(type, NULL, "");
    abi_plan(type, v->subject->material);
    type->release(mine);
    return NULL;
}

static void together(const subject *s) {
    view *views = aligned_alloc(64, (THREADS + 1) * sizeof *views);
    memset(views, 0, (THREADS + 1) * sizeof *views);
    pthread_t threads[THREADS];
    for (int i = 0; i <= THREADS; i++) views[i].subject = s;
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, shade, &views[i]), 0);
    for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
    shade(&views[THREADS]); /* alone */
    for (int i = 0; i < THREADS; i++)
        assert_memory_equal(views[i].values, views[THREADS].values,
                            offsetof(view, closure) - offsetof(view, values));
    free(views);
}

static void threads_give_the_bits_of_one(void **state) {
    (void)state;
    each_subject(together);
}

static void sound(float x) {
    assert_true(isfinite(x) && x >= 0);
}

static float length_of(const float v[3]) {
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void range(const subject *s) {
    const musurf_material_type *type = s->type;
    _Alignas(64) unsigned char closure[CLOSURE];
    for (uint32_t i = 0; i < 4 * N; i++) {
        float wo[3], wi[3], u[3], rgb[3];
        abi_direction(i, wo), abi_direction(i + 1000, wi), abi_uniforms(i, u);
        if (i % 11 == 3) u[0] = u[1] = 0;
        if (i % 11 == 4) u[0] = u[1] = u[2] = 0x1.fffffep-1f;
        const uint32_t lobes = type->setup(s->material, wo, SLOTS, 0, closure);
        assert_int_equal(lobes & ~s->plan.lobes, 0);
        if (!lobes) continue;
        musurf_value value, none;
        musurf_sample sample;
        type->eval(closure, wi, MUSURF_ALL_LOBES, &value);
        for (int k = 0; k < 3; k++) sound(value.f[k]);
        sound(value.pdf), sound(value.pdf_reverse);
        assert_int_equal(value.lobes & ~lobes, 0);
        assert_true(value.lobes ||
                    (value.f[0] == 0 && value.pdf == 0)); /* delta and black contribute nothing */
        assert_true(type->pdf(closure, wi, MUSURF_ALL_LOBES) == value.pdf);
        type->eval(closure, wi, 0, &none);
        assert_true(none.lobes == 0 && none.f[0] == 0 && none.f[1] == 0 && none.f[2] == 0 && none.pdf == 0);
        type->albedo(closure, rgb);
        for (int k = 0; k < 3; k++) assert_true(rgb[k] >= 0 && rgb[k] <= 1);

        type->sample(closure, u, MUSURF_ALL_LOBES, &sample);
        for (int k = 0; k < 3; k++)
            sound(sample.weight[k]), assert_true(!s->visible || sample.weight[k] <= 1 + 1e-5f);
        sound(sample.pdf), sound(sample.pdf_reverse);
        if (sample.lobe) {
            assert_int_equal(sample.lobe & (sample.lobe - 1), 0);
            assert_int_equal(sample.lobe & ~lobes, 0);
            /* unit to rounding: a square root of a sum of three squares is good to 2 ulp, a product adds 1 */
            assert_true(fabsf(length_of(sample.wi) - 1) < 1e-6f && fabsf(length_of(sample.wm) - 1) < 1e-6f);
            assert_true(sample.wi[2] > 0 && sample.eta > 0 && sample.roughness >= 0);
        } else {
            assert_true(sample.pdf == 0 && sample.weight[0] == 0);
        }
        type->sample(closure, u, 0, &sample);
        assert_int_equal(sample.lobe, 0);
        assert_true(sample.pdf == 0 && sample.weight[0] == 0);

        wi[2] = -wi[2]; /* opaque: nothing from below */
        type->eval(closure, wi, MUSURF_ALL_LOBES, &value);
        assert_true(value.lobes == 0 && value.f[0] == 0 && value.pdf == 0);
        wo[2] = -wo[2];
        assert_int_equal(type->setup(s->material, wo, SLOTS, 0, closure), 0);
    }
}

static void answers_are_in_range(void **state) {
    (void)state;
    each_subject(range);
}

/* eval's reverse pdf is the pdf with the roles exchanged; a closure is plain bytes that may be copied. */
static void roles(const subject *s) {
    const musurf_material_type *type = s->type;
    _Alignas(64) unsigned char there[CLOSURE], back[CLOSURE], copy[CLOSURE];
    for (uint32_t i = 0; i < N; i++) {
        float wo[3], wi[3];
        abi_direction(i, wo), abi_direction(i + 1000, wi);
        musurf_value forward, reverse;
        if (!type->setup(s->material, wo, SLOTS, 0, there)) continue;
        if (!type->setup(s->material, wi, SLOTS, 0, back)) continue;
        memcpy(copy, there, s->plan.closure_bytes);
        memset(there, 0xee, sizeof there);
        type->eval(copy, wi, MUSURF_ALL_LOBES, &forward);
        type->eval(back, wo, MUSURF_ALL_LOBES, &reverse);
        /* the same half-vector (a sum commutes), then sigma and D by formulas of at most some hundred
         * roundings of 2^-24, none of them amplified: 1e-4 holds both routes together */
        assert_true(fabsf(forward.pdf - reverse.pdf_reverse) <= 1e-4f * forward.pdf + 1e-30f);
        assert_true(fabsf(reverse.pdf - forward.pdf_reverse) <= 1e-4f * reverse.pdf + 1e-30f);
        /* reciprocity of f */
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(forward.f[k] * wo[2] - reverse.f[k] * wi[2]) <=
                        1e-4f * forward.f[k] * wo[2] + 1e-30f);
    }
}

static void roles_exchange(void **state) {
    (void)state;
    each_subject(roles);
}

/* What sample says of its direction is what eval says: pdf, reverse pdf, and weight * pdf = f |wi.z|. */
static void ties(const subject *s) {
    const musurf_material_type *type = s->type;
    _Alignas(64) unsigned char closure[CLOSURE];
    int compared = 0;
    for (uint32_t i = 0; i < 4 * N; i++) {
        float wo[3], u[3];
        musurf_sample sample;
        musurf_value value;
        abi_direction(i, wo), abi_uniforms(i, u);
        if (wo[2] < 0.2f || !type->setup(s->material, wo, SLOTS, 0, closure)) continue;
        type->sample(closure, u, MUSURF_ALL_LOBES, &sample);
        if (sample.wi[2] < 0.2f || !sample.lobe || sample.lobe & MUSURF_DELTA_LOBES) continue;
        type->eval(closure, sample.wi, MUSURF_ALL_LOBES, &value);
        /* Rounding wi moves the half-vector by 2^-24, in units of the lobe's width 2^-24/0.004 (alpha 0.0121,
         * slopes shrunk 2.4 times by the skew); |wo + wi| >= 0.4 may shorten it, D goes with at most its
         * fourth power */
        const float allowed = 4 * 0x1p-24f / 0.004f / 0.4f * 4;
        assert_true(fabsf(value.pdf - sample.pdf) <= allowed * sample.pdf);
        assert_true(fabsf(value.pdf_reverse - sample.pdf_reverse) <= allowed * sample.pdf_reverse);
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(value.f[k] - sample.weight[k] * sample.pdf) <= allowed * value.f[k]);
        compared++;
    }
    assert_true(compared > N || s->plan.lobes & MUSURF_DELTA_LOBES);
}

static void samples_are_what_eval_says(void **state) {
    (void)state;
    each_subject(ties);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_give_the_scalar_bits), cmocka_unit_test(threads_give_the_bits_of_one),
        cmocka_unit_test(answers_are_in_range),         cmocka_unit_test(roles_exchange),
        cmocka_unit_test(samples_are_what_eval_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
