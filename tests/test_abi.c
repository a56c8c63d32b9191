/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_abi.c: both plugins are held to the cold half of the contract in musurf_plugin.h: sound parameter
 * tables, structs of hosts built with earlier or later headers, refusals that name the parameter.
 */
#include "tests/abi_host.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const musurf_param *param_at(const musurf_material_type *type, uint32_t i) {
    return (const musurf_param *)(const void *)((const char *)type->params +
                                                i * (size_t)type->params[0].size);
}

static int numbers_of(musurf_kind kind) {
    return kind == MUSURF_COLOR       ? 3
           : kind == MUSURF_MATRIX    ? 4
           : kind == MUSURF_VECTOR    ? 2
           : kind == MUSURF_MATRIX3   ? 9
           : kind == MUSURF_FOOTPRINT ? 6
                                      : 1;
}

static void tables_are_sound(void **state) {
    (void)state;
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        assert_int_equal(type->size, sizeof *type);
        assert_true(strchr(type->id, '.') && *type->label && *type->doc);
        assert_true(type->param_count > 0);
        for (uint32_t i = 0; i < type->param_count; i++) {
            const musurf_param *param = param_at(type, i);
            assert_int_equal(param->size, type->params[0].size);
            assert_int_not_equal(param->id, MUSURF_NO_PARAM);
            assert_true(*param->name && *param->label && *param->doc && param->unit);
            for (uint32_t j = 0; j < i; j++) {
                assert_int_not_equal(param->id, param_at(type, j)->id);
                assert_string_not_equal(param->name, param_at(type, j)->name);
            }
            assert_in_range(param->kind, MUSURF_NUMBER, MUSURF_FOOTPRINT);
            if (param->kind == MUSURF_CHOICE) {
                assert_non_null(param->choices);
                int found = 0;
                for (const char *const *choice = param->choices; *choice; choice++)
                    found += !strcmp(*choice, param->initial_choice);
                assert_int_equal(found, 1);
                continue;
            }
            assert_null(param->choices);
            assert_true(param->min < param->max);
            assert_true(param->soft_min >= param->min && param->soft_max <= param->max);
            assert_true(isfinite(param->soft_min) && isfinite(param->soft_max));
            for (int k = 0; k < numbers_of(param->kind) && !(param->flags & MUSURF_NO_DEFAULT); k++) {
                const double x = param->initial[k];
                assert_true(param->flags & MUSURF_MIN_EXCLUDED ? x > param->min : x >= param->min);
                assert_true(param->flags & MUSURF_MAX_EXCLUDED ? x < param->max : x <= param->max);
            }
        }
    }
}

/* compile() must refuse, say why in one line about `param`, leave *out NULL and nothing allocated. */
static void refuses(const musurf_material_type *type, const musurf_setting *settings, size_t count,
                    musurf_result wanted, uint32_t param) {
    abi_host host;
    abi_host_start(&host);
    musurf_material *material = (musurf_material *)(void *)&host;
    assert_int_equal(type->compile(&host.host, settings, count, &material), wanted);
    assert_null(material);
    assert_int_equal(host.live, 0);
    assert_true(host.messages >= 1);
    assert_int_equal(host.param, param);
    assert_true(*host.text && !strchr(host.text, '\n'));
    /* and a host that does not listen lives through it too */
    host.host.message = NULL;
    assert_int_equal(type->compile(&host.host, settings, count, &material), wanted);
    assert_null(material);
}

/* Two columns and one row: each number wrong in its own way, and a count that is not that of the grid. */
static void wrong_grids_are_refused(const musurf_material_type *type, const musurf_param *param) {
    static const double good[8] = {2, 1, -1, 1, -1, 1, 0.5, 0.5};
    static const double wrong[][2] = {{0, 0},   {0, 1},        {0, 1.5}, {0, 1e300}, {1, 3},       {1, NAN},
                                      {2, NAN}, {5, INFINITY}, {7, NAN}, {6, -1},    {6, INFINITY}};
    double values[8];
    musurf_setting setting = {sizeof setting, param->id, MUSURF_CONSTANT, 0, values, NULL, 8};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        memcpy(values, good, sizeof values);
        values[(size_t)wrong[i][0]] = wrong[i][1];
        refuses(type, &setting, 1, MUSURF_INVALID, param->id);
    }
    memcpy(values, good, sizeof values);
    for (setting.count = 0; setting.count < 8; setting.count++)
        refuses(type, &setting, 1, MUSURF_INVALID, param->id);
    setting.count = 8,
    setting.size = (uint32_t)offsetof(musurf_setting, count); /* a host that cannot say how many */
    refuses(type, &setting, 1, MUSURF_INVALID, param->id);
}

static void wrong_settings_are_refused_by_name(void **state) {
    (void)state;
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        const double one = 1;
        refuses(type, &(musurf_setting){sizeof(musurf_setting), 987654, MUSURF_CONSTANT, 0, &one, NULL, 0}, 1,
                MUSURF_INVALID, 987654);
        for (uint32_t i = 0; i < type->param_count; i++) {
            const musurf_param *param = param_at(type, i);
            double bad[9];
            for (int k = 0; k < 9; k++) bad[k] = NAN;
            musurf_setting setting = {sizeof setting, param->id, MUSURF_CONSTANT, 0, NULL, NULL, 0};
            refuses(type, &setting, 1, MUSURF_INVALID, param->id); /* neither values nor text */
            setting.source = 77;
            refuses(type, &setting, 1, MUSURF_INVALID, param->id);
            setting.source = MUSURF_SLOT;
            if (!(param->flags & MUSURF_MAY_VARY)) refuses(type, &setting, 1, MUSURF_UNSUPPORTED, param->id);
            setting.source = MUSURF_CONSTANT;
            setting.text = "no such choice";
            if (param->kind == MUSURF_CHOICE) {
                refuses(type, &setting, 1, MUSURF_INVALID, param->id);
                continue;
            }
            setting.text = NULL;
            if (param->kind == MUSURF_GRID) {
                wrong_grids_are_refused(type, param);
                continue;
            }
            setting.values = bad;
            refuses(type, &setting, 1, MUSURF_INVALID, param->id);
            memset(bad, 0, sizeof bad);
            memcpy(bad, param->initial, sizeof param->initial);
            const int last = numbers_of(param->kind) - 1;
            bad[last] = INFINITY;
            refuses(type, &setting, 1, MUSURF_INVALID, param->id);
            if (isfinite(param->min)) {
                bad[last] =
                    param->flags & MUSURF_MIN_EXCLUDED ? param->min : nextafter(param->min, -INFINITY);
                refuses(type, &setting, 1, MUSURF_INVALID, param->id);
            }
            if (isfinite(param->max)) {
                bad[last] = param->flags & MUSURF_MAX_EXCLUDED ? param->max : nextafter(param->max, INFINITY);
                refuses(type, &setting, 1, MUSURF_INVALID, param->id);
            }
            if (param->kind == MUSURF_MATRIX) {
                const double singular[4] = {1, 2, 2, 4};
                setting.values = singular;
                refuses(type, &setting, 1, MUSURF_INVALID, param->id);
            }
            musurf_setting twice[2] = {setting, setting};
            bad[last] = last < 4 ? param->initial[last] : 1;
            twice[0].values = twice[1].values = bad;
            refuses(type, twice, 2, MUSURF_INVALID, param->id);
        }
    }
}

static void hosts_of_any_size_work(void **state) {
    (void)state;
    const uint32_t sizes[] = {16, 24, 32, 40, 64, 4096};
    for (int t = 0; t < ABI_TYPES; t++) {
        for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
            abi_host host;
            abi_host_start(&host);
            char *bytes = abi_guarded(sizes[i]);
            memset(bytes, 0xff, sizes[i]); /* what a later header might hold: nothing we may read */
            host.host.size = sizes[i];
            memcpy(bytes, &host.host, sizes[i] < sizeof host.host ? sizes[i] : sizeof host.host);
            musurf_material *material = NULL;
            const musurf_material_type *type = abi_type(t);
            assert_int_equal(type->compile((const musurf_host *)(const void *)bytes, NULL, 0, &material),
                             MUSURF_OK);
            assert_int_equal(host.allocations > 0, sizes[i] >= 40); /* half a pair of functions is none */
            const musurf_setting unknown = {sizeof unknown, 987654, 0, 0, NULL, NULL, 0};
            musurf_material *none;
            assert_int_equal(type->compile((const musurf_host *)(const void *)bytes, &unknown, 1, &none),
                             MUSURF_INVALID);
            assert_int_equal(host.messages > 0, sizes[i] >= 24);
            abi_guarded_free(bytes, sizes[i]); /* the material must not need the struct any more */
            type->release(material);
            assert_int_equal(host.live, 0);
        }
        abi_type(t)->release(NULL);
    }
}

static void settings_of_another_header_work(void **state) {
    (void)state;
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        abi_settings now;
        abi_settings_read(&now, type, t ? "ndf=gtr alpha=0.25 gamma=1.5" : "reflectance=0.2,0.3,0.4");
        /* and of an earlier one, without `count` */
        for (uint32_t size = (uint32_t)offsetof(musurf_setting, count); size <= 80; size += 8) {
            char *bytes = abi_guarded(size * now.count);
            memset(bytes, 0xff, size * now.count);
            for (size_t i = 0; i < now.count; i++) {
                memcpy(bytes + i * size, &now.setting[i],
                       size < sizeof now.setting[i] ? size : sizeof now.setting[i]);
                memcpy(bytes + i * size, &size, sizeof size);
            }
            abi_host host;
            abi_host_start(&host);
            musurf_material *material, *same;
            assert_int_equal(
                type->compile(&host.host, (const musurf_setting *)(const void *)bytes, now.count, &material),
                MUSURF_OK);
            abi_guarded_free(bytes, size * now.count);
            assert_int_equal(type->compile(&host.host, now.setting, now.count, &same), MUSURF_OK);
            _Alignas(64) unsigned char closure[2][4096];
            const float wo[3] = {0.6f, 0, 0.8f}, wi[3] = {0, 0.6f, 0.8f};
            musurf_value value[2];
            musurf_material *both[2] = {material, same};
            for (int i = 0; i < 2; i++) {
                assert_true(abi_plan(type, both[i]).closure_bytes <= sizeof closure[i]);
                assert_true(type->setup(both[i], wo, NULL, 0, closure[i]) != 0);
                type->eval(closure[i], wi, MUSURF_ALL_LOBES, &value[i]);
                assert_true(value[i].f[0] > 0);
            }
            assert_memory_equal(&value[0], &value[1], sizeof value[0]);
            type->release(material);
            type->release(same);
            assert_int_equal(host.live, 0);
        }
    }
}

static void plans_are_written_no_further_than_their_size(void **state) {
    (void)state;
    const uint32_t sizes[] = {4, 8, 12, 16, 20, 24, 28, 32, 40, 48, 56, 128};
    for (int t = 0; t < ABI_TYPES; t++) {
        const musurf_material_type *type = abi_type(t);
        musurf_material *material = abi_material(type, NULL, "");
        const musurf_plan whole = abi_plan(type, material);
        assert_true(whole.closure_alignment && whole.closure_alignment <= 64);
        assert_int_equal(whole.closure_alignment & (whole.closure_alignment - 1), 0);
        assert_true(whole.lobes && *whole.name && whole.left_out);
        for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
            const uint32_t size = sizes[i], known = size < 56 ? size : 56;
            const uint32_t held = (size + 7) / 8 * 8; /* the struct's alignment is the caller's duty */
            unsigned char *bytes = abi_guarded(held);
            memset(bytes, 0x5a, held);
            memcpy(bytes, &size, sizeof size);
            type->describe(material, (musurf_plan *)(void *)bytes);
            assert_memory_equal(bytes, &size, sizeof size);
            assert_memory_equal(bytes + 4, (const unsigned char *)&whole + 4, known - 4);
            for (uint32_t k = known; k < held; k++) assert_int_equal(bytes[k], 0x5a);
            abi_guarded_free(bytes, held);
        }
        type->release(material);
    }
}

/* A plan says whether a footprint is wanted, and setup reads one from its slots; without, the surface is as from afar. */
static void footprints_are_asked_for(void **state) {
    (void)state;
    static const struct {
        const char *words;
        uint32_t needs, slots;
    } cases[] = {
        {"ndf=discrete_ggx", MUSURF_NEEDS_FOOTPRINT, 0},
        {"ndf=discrete_ggx footprint=@3", MUSURF_NEEDS_FOOTPRINT | MUSURF_NEEDS_SLOTS, 9},
        {"ndf=discrete_ggx footprint=@0 transform=@6", MUSURF_NEEDS_FOOTPRINT | MUSURF_NEEDS_SLOTS, 10},
        {"ndf=discrete_ggx footprint=0.5,0.5,0.01,0,0,0.01", 0, 0},
        {"ndf=discrete_beckmann alpha=0 footprint=@3", 0, 0},
        {"ndf=ggx", 0, 0}};
    const musurf_material_type *type = abi_type(1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        musurf_material *material = abi_material(type, NULL, cases[i].words);
        assert_non_null(material);
        const musurf_plan plan = abi_plan(type, material);
        assert_int_equal(plan.needs & ~(uint32_t)MUSURF_NEEDS_TANGENT, cases[i].needs);
        assert_int_equal(plan.slot_floats, cases[i].slots);
        type->release(material);
    }
    /* in slots, constant, and none: the first two are the same bits, the last is what NULL and infinity come to */
    static const float near[6] = {0.5f, 0.25f, 0.125f, 0, 0, 0.125f},
                       far[6] = {0.5f, 0.25f, INFINITY, 0, 0, 1};
    static const struct {
        const char *words;
        const float *slots;
    } ways[] = {{" footprint=@0", near},
                {" footprint=0.5,0.25,0.125,0,0,0.125", NULL},
                {"", NULL},
                {" footprint=@0", NULL},
                {" footprint=@0", far}};
    const float wo[3] = {0.6f, 0, 0.8f}, wi[3] = {-0.48f, 0.36f, 0.8f};
    musurf_value value[5];
    for (int i = 0; i < 5; i++) {
        char words[160];
        snprintf(words, sizeof words, "ndf=discrete_ggx alpha=0.3 flakes.density=1e5 flakes.cone=0.1%s",
                 ways[i].words);
        musurf_material *material = abi_material(type, NULL, words);
        assert_non_null(material);
        _Alignas(64) unsigned char closure[512];
        assert_true(type->setup(material, wo, ways[i].slots, 0, closure) != 0);
        type->eval(closure, wi, MUSURF_ALL_LOBES, &value[i]);
        type->release(material);
    }
    assert_memory_equal(&value[0], &value[1], sizeof value[0]);
    assert_memory_equal(&value[2], &value[3], sizeof value[0]);
    assert_memory_equal(&value[2], &value[4], sizeof value[0]);
    assert_true(value[0].f[0] != value[2].f[0] && value[0].pdf == value[2].pdf);
}

/* An index that float takes for 1 bends nothing: a delta lobe, and the plan says so before it is met. */
static void straight_lobes_are_announced(void **state) {
    (void)state;
    const char *words[] = {"transmission=1 fresnel=dielectric fresnel.dielectric=1",
                           "transmission=1 fresnel=dielectric fresnel.dielectric=1.000000001",
                           "transmission=1 fresnel=dielectric fresnel.dielectric=0.99999998",
                           "transmission=1 fresnel=dielectric fresnel.dielectric=1.0000002",
                           "transmission=1 fresnel=dielectric fresnel.dielectric=1.000000001 alpha=1e-12",
                           "transmission=1 fresnel=dielectric fresnel.dielectric=1.0000002 alpha=1e-12"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        musurf_material *material = abi_material(abi_type(1), NULL, words[i]);
        assert_non_null(material);
        const uint32_t lobes = abi_plan(abi_type(1), material).lobes;
        _Alignas(64) unsigned char closure[4096];
        const float wo[3] = {0.6f, 0, 0.8f}, u[3] = {0.2f, 0.7f, 0.9999f};
        musurf_sample s = {0};
        assert_true(abi_type(1)->setup(material, wo, NULL, 0, closure));
        abi_type(1)->sample(closure, u, MUSURF_ALL_LOBES, &s);
        assert_true(s.lobe == MUSURF_DELTA_TRANSMISSION || s.lobe == MUSURF_GLOSSY_TRANSMISSION);
        assert_true(s.lobe & lobes);
        assert_int_equal((lobes & MUSURF_DELTA_TRANSMISSION) != 0, s.lobe == MUSURF_DELTA_TRANSMISSION);
        abi_type(1)->release(material);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(straight_lobes_are_announced),
        cmocka_unit_test(tables_are_sound),
        cmocka_unit_test(wrong_settings_are_refused_by_name),
        cmocka_unit_test(hosts_of_any_size_work),
        cmocka_unit_test(settings_of_another_header_work),
        cmocka_unit_test(plans_are_written_no_further_than_their_size),
        cmocka_unit_test(footprints_are_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
