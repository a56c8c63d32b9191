/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_abi_memory.c: who allocates, when, and what happens if there is no memory. This program's own malloc
 * family, which also serves the shared objects that it opens, counts its calls: shading must make none.
 */
#include "tests/abi_host.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
enum { COUNTED = 0 }; /* the sanitizer owns malloc; the plain build counts */
static size_t calls_of_malloc(void) {
    return 0;
}
#else
enum { COUNTED = 1 };
static atomic_size_t calls;
static size_t calls_of_malloc(void) {
    return atomic_load(&calls);
}

/* glibc's own entry points: what the names below would have reached. */
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *memory, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);
void __libc_free(void *memory);
void *malloc(size_t bytes);
void *calloc(size_t count, size_t bytes);
void *realloc(void *memory, size_t bytes);
void *aligned_alloc(size_t alignment, size_t bytes);
void *memalign(size_t alignment, size_t bytes);
int posix_memalign(void **out, size_t alignment, size_t bytes);
void free(void *memory);

void *malloc(size_t bytes) {
    atomic_fetch_add(&calls, 1);
    return __libc_malloc(bytes);
}
void *calloc(size_t count, size_t bytes) {
    atomic_fetch_add(&calls, 1);
    return __libc_calloc(count, bytes);
}
void *realloc(void *memory, size_t bytes) {
    atomic_fetch_add(&calls, 1);
    return __libc_realloc(memory, bytes);
}
void *aligned_alloc(size_t alignment, size_t bytes) {
    atomic_fetch_add(&calls, 1);
    return __libc_memalign(alignment, bytes);
}
void *memalign(size_t alignment, size_t bytes) {
    atomic_fetch_add(&calls, 1);
    return __libc_memalign(alignment, bytes);
}
int posix_memalign(void **out, size_t alignment, size_t bytes) {
    atomic_fetch_add(&calls, 1);
    *out = __libc_memalign(alignment, bytes);
    return *out ? 0 : ENOMEM;
}
void free(void *memory) {
    if (memory) atomic_fetch_add(&calls, 1);
    __libc_free(memory);
}
#endif

/* Each allocation of compile() in turn gets NULL: the answer is NO_MEMORY and everything before is given
 * back. */
static void running_out_of_memory_leaks_nothing(void **state) {
    (void)state;
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        for (int i = 0; abi_words(type, i); i++) {
            abi_settings settings;
            abi_settings_read(&settings, type, abi_words(type, i));
            int needed = 0;
            for (musurf_result result = MUSURF_NO_MEMORY; result != MUSURF_OK; needed++) {
                assert_true(needed < 1000);
                abi_host host;
                abi_host_start(&host);
                host.fail_at = needed + 1;
                musurf_material *material = (musurf_material *)(void *)&host;
                result = type->compile(&host.host, settings.setting, settings.count, &material);
                if (result == MUSURF_OK) {
                    assert_int_equal(host.allocations, needed); /* the one to fail was never asked for */
                    type->release(material);
                } else {
                    assert_int_equal(result, MUSURF_NO_MEMORY);
                    assert_null(material);
                }
                assert_int_equal(host.live, 0);
            }
            assert_true(needed > 1); /* at least the material itself came from the host */
        }
    }
}

/* With the host's allocator, compile uses nothing else; without, it uses malloc: which also shows that we
 * count. */
static void the_hosts_allocator_is_the_only_one(void **state) {
    (void)state;
    if (!COUNTED) skip();
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        for (int i = 0; abi_words(type, i); i++) {
            abi_host host;
            abi_host_start(&host);
            abi_settings settings;
            abi_settings_read(&settings, type, abi_words(type, i));
            musurf_material *material;
            size_t before = calls_of_malloc();
            assert_int_equal(type->compile(&host.host, settings.setting, settings.count, &material),
                             MUSURF_OK);
            assert_int_equal(calls_of_malloc() - before, (size_t)host.allocations); /* the host's own */
            type->release(material);
            assert_int_equal(host.live, 0);

            const musurf_host bare = {.size = sizeof bare};
            before = calls_of_malloc();
            assert_int_equal(type->compile(&bare, settings.setting, settings.count, &material), MUSURF_OK);
            assert_true(calls_of_malloc() > before);
            type->release(material);
        }
    }
}

static void shading_allocates_nothing_and_calls_nobody(void **state) {
    (void)state;
    enum { N = 64 };
    static float wo[N][3], wi[N][3], u[N][3], slots[16];
    static musurf_value values[N];
    static musurf_sample samples[N];
    for (uint32_t i = 0; i < N; i++)
        abi_direction(i, wo[i]), abi_direction(i + N, wi[i]), abi_uniforms(i, u[i]);
    memcpy(slots, (float[]){1, 2, 0, 1, 0.5f, 1.3f}, 6 * sizeof *slots);
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        for (int m = 0; abi_words(type, m); m++) {
            abi_host host;
            abi_host_start(&host);
            musurf_material *material = abi_material(type, &host.host, abi_words(type, m));
            assert_non_null(material);
            const musurf_plan plan = abi_plan(type, material);
            _Alignas(64) unsigned char closure[4096];
            assert_true(plan.closure_bytes <= sizeof closure);
            const int allocations = host.allocations, live = host.live, messages = host.messages;
            const size_t before = calls_of_malloc();
            for (uint32_t i = 0; i < N; i++) {
                float rgb[3];
                if (!type->setup(material, wo[i], slots, i & 1 ? MUSURF_IMPORTANCE : 0, closure)) continue;
                type->eval(closure, wi[i], MUSURF_ALL_LOBES, values);
                type->sample(closure, u[i], MUSURF_ALL_LOBES, samples);
                type->pdf(closure, wi[i], MUSURF_ALL_LOBES);
                type->albedo(closure, rgb);
                type->eval_batch(closure, 0, wi[0], sizeof wi[0], MUSURF_ALL_LOBES, values, sizeof values[0],
                                 N);
                type->sample_batch(closure, 0, u[0], sizeof u[0], MUSURF_ALL_LOBES, samples,
                                   sizeof samples[0], N);
                type->blur(closure, 0.3f);
                type->eval(closure, wi[i], MUSURF_ALL_LOBES, values);
            }
            assert_int_equal(calls_of_malloc() - before, 0);
            assert_int_equal(host.allocations, allocations);
            assert_int_equal(host.live, live);
            assert_int_equal(host.messages, messages);
            type->release(material);
            assert_int_equal(host.live, 0);
        }
    }
}

/* Closures and slots are exactly as long as the plan says: both end at a page that faults. */
static void plans_tell_the_true_sizes(void **state) {
    (void)state;
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        for (int m = 0; abi_words(type, m); m++) {
            musurf_material *material = abi_material(type, NULL, abi_words(type, m));
            assert_non_null(material);
            const musurf_plan plan = abi_plan(type, material);
            assert_int_equal((plan.needs & MUSURF_NEEDS_SLOTS) != 0, plan.slot_floats > 0);
            assert_int_equal(plan.closure_bytes % plan.closure_alignment, 0);
            const size_t slot_bytes = plan.slot_floats * sizeof(float);
            unsigned char *closure = abi_guarded(plan.closure_bytes);
            float *slots = slot_bytes ? abi_guarded(slot_bytes) : NULL;
            const float some[6] = {1, 2, 0, 1, 0.5f, 1.3f};
            for (uint32_t i = 0; i < plan.slot_floats; i++) slots[i] = some[i % 6];
            for (uint32_t i = 0; i < 100; i++) {
                float wo[3], wi[3], u[3];
                abi_direction(i, wo), abi_direction(i + 100, wi), abi_uniforms(i, u);
                musurf_value value;
                musurf_sample sample;
                if (!type->setup(material, wo, slots, 0, closure)) continue;
                type->eval(closure, wi, MUSURF_ALL_LOBES, &value);
                type->sample(closure, u, MUSURF_ALL_LOBES, &sample);
                type->blur(closure, 0.5f);
                type->eval(closure, wi, MUSURF_ALL_LOBES, &value);
            }
            abi_guarded_free(closure, plan.closure_bytes);
            if (slots) abi_guarded_free(slots, slot_bytes);
            type->release(material);
        }
    }
}

static void plugins_come_and_go(void **state) {
    (void)state;
    const char *const names[] = {"template", "musurf"};
    for (int round = 0; round < 200; round++) {
        const abi_plugin opened = abi_open(names[round % 2]);
        assert_int_equal(opened.plugin->size, sizeof(musurf_plugin));
        assert_true(opened.plugin->type_count >= 1);
        for (size_t i = 0; i < opened.plugin->type_count; i++) {
            const musurf_material_type *type = opened.plugin->types[i];
            musurf_material *material = abi_material(type, NULL, "");
            assert_non_null(material);
            type->release(material);
            assert_null(type->extension("no.such/1"));
        }
        abi_close(opened);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plugins_come_and_go), /* first: nothing is open yet */
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(the_hosts_allocator_is_the_only_one),
        cmocka_unit_test(shading_allocates_nothing_and_calls_nobody),
        cmocka_unit_test(plans_tell_the_true_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
