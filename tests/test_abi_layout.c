/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_abi_layout.c: sizes, offsets and values of musurf_plugin.h and musurf_probe.h as literal numbers
 * (LP64). A change that moves any of them breaks plugins and hosts already built, so it must break this test.
 */
#include "plugin/musurf_probe.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define AT(type, field, offset) assert_int_equal(offsetof(type, field), offset)

static void cold_structs_have_golden_layouts(void **state) {
    (void)state;
    assert_int_equal(sizeof(void *), 8);
    assert_int_equal(sizeof(musurf_host), 40);
    AT(musurf_host, size, 0), AT(musurf_host, abi_minor, 4), AT(musurf_host, context, 8);
    AT(musurf_host, message, 16), AT(musurf_host, allocate, 24), AT(musurf_host, release, 32);
    assert_int_equal(sizeof(musurf_param), 128);
    AT(musurf_param, size, 0), AT(musurf_param, id, 4), AT(musurf_param, name, 8),
        AT(musurf_param, label, 16);
    AT(musurf_param, doc, 24), AT(musurf_param, unit, 32), AT(musurf_param, kind, 40),
        AT(musurf_param, flags, 44);
    AT(musurf_param, min, 48), AT(musurf_param, max, 56), AT(musurf_param, soft_min, 64);
    AT(musurf_param, soft_max, 72), AT(musurf_param, initial, 80), AT(musurf_param, initial_choice, 112);
    AT(musurf_param, choices, 120);
    assert_int_equal(sizeof(musurf_setting), 40);
    AT(musurf_setting, size, 0), AT(musurf_setting, param, 4), AT(musurf_setting, source, 8);
    AT(musurf_setting, slot, 12), AT(musurf_setting, values, 16), AT(musurf_setting, text, 24);
    AT(musurf_setting, count, 32);
    assert_int_equal(sizeof(musurf_plan), 56);
    AT(musurf_plan, size, 0), AT(musurf_plan, closure_bytes, 4), AT(musurf_plan, closure_alignment, 8);
    AT(musurf_plan, lobes, 12), AT(musurf_plan, needs, 16), AT(musurf_plan, slot_floats, 20);
    AT(musurf_plan, table_bytes, 24), AT(musurf_plan, material_bytes, 28), AT(musurf_plan, name, 32);
    AT(musurf_plan, left_out, 40), AT(musurf_plan, sampler, 48);
    assert_int_equal(sizeof(musurf_material_type), 136);
    AT(musurf_material_type, size, 0), AT(musurf_material_type, param_count, 4),
        AT(musurf_material_type, id, 8);
    AT(musurf_material_type, label, 16), AT(musurf_material_type, doc, 24),
        AT(musurf_material_type, params, 32);
    AT(musurf_material_type, compile, 40), AT(musurf_material_type, release, 48);
    AT(musurf_material_type, describe, 56), AT(musurf_material_type, setup, 64);
    AT(musurf_material_type, eval, 72), AT(musurf_material_type, sample, 80),
        AT(musurf_material_type, pdf, 88);
    AT(musurf_material_type, albedo, 96), AT(musurf_material_type, blur, 104);
    AT(musurf_material_type, eval_batch, 112), AT(musurf_material_type, sample_batch, 120);
    AT(musurf_material_type, extension, 128);
    assert_int_equal(sizeof(musurf_plugin), 48);
    AT(musurf_plugin, size, 0), AT(musurf_plugin, abi_minor, 4), AT(musurf_plugin, name, 8);
    AT(musurf_plugin, version, 16), AT(musurf_plugin, license, 24), AT(musurf_plugin, type_count, 32);
    AT(musurf_plugin, types, 40);
    assert_int_equal(sizeof(musurf_probe), 24);
    AT(musurf_probe, size, 0), AT(musurf_probe, evaluate, 8), AT(musurf_probe, sample, 16);
}

static void hot_records_are_frozen(void **state) {
    (void)state;
    assert_int_equal(sizeof(musurf_value), 24);
    AT(musurf_value, f, 0), AT(musurf_value, pdf, 12), AT(musurf_value, pdf_reverse, 16);
    AT(musurf_value, lobes, 20);
    assert_int_equal(sizeof(musurf_sample), 56);
    AT(musurf_sample, wi, 0), AT(musurf_sample, wm, 12), AT(musurf_sample, weight, 24);
    AT(musurf_sample, pdf, 36), AT(musurf_sample, pdf_reverse, 40), AT(musurf_sample, eta, 44);
    AT(musurf_sample, roughness, 48), AT(musurf_sample, lobe, 52);
    assert_int_equal(sizeof(musurf_probe_values), 112);
    AT(musurf_probe_values, Lambda, 0), AT(musurf_probe_values, sigma, 8), AT(musurf_probe_values, D, 16);
    AT(musurf_probe_values, G1, 24), AT(musurf_probe_values, Dv, 32), AT(musurf_probe_values, f, 40);
    AT(musurf_probe_values, F, 64), AT(musurf_probe_values, G2, 88), AT(musurf_probe_values, pdf, 96);
    AT(musurf_probe_values, delta, 104);
    assert_int_equal(sizeof(musurf_probe_sample), 112);
    AT(musurf_probe_sample, wi, 0), AT(musurf_probe_sample, wm, 24), AT(musurf_probe_sample, f, 48);
    AT(musurf_probe_sample, weight, 72), AT(musurf_probe_sample, pdf, 96);
    AT(musurf_probe_sample, rejected, 104), AT(musurf_probe_sample, delta, 108);
}

static void named_numbers_keep_their_values(void **state) {
    (void)state;
    assert_string_equal(MUSURF_ENTRY_NAME, "musurf_plugin_v1");
    assert_string_equal(MUSURF_PROBE_ID, "musurf.probe/1");
    assert_int_equal(MUSURF_ABI_MAJOR, 1);
    assert_int_equal(sizeof(musurf_result), 4);
    const unsigned values[][2] = {{MUSURF_OK, 0},
                                  {MUSURF_INVALID, 1},
                                  {MUSURF_NO_MEMORY, 2},
                                  {MUSURF_UNSUPPORTED, 3},
                                  {MUSURF_INFO, 0},
                                  {MUSURF_WARNING, 1},
                                  {MUSURF_ERROR, 2},
                                  {MUSURF_NUMBER, 1},
                                  {MUSURF_COLOR, 2},
                                  {MUSURF_MATRIX, 3},
                                  {MUSURF_CHOICE, 4},
                                  {MUSURF_FLAG, 5},
                                  {MUSURF_VECTOR, 6},
                                  {MUSURF_MATRIX3, 7},
                                  {MUSURF_GRID, 8},
                                  {MUSURF_FOOTPRINT, 9},
                                  {MUSURF_MAY_VARY, 1},
                                  {MUSURF_MIN_EXCLUDED, 2},
                                  {MUSURF_MAX_EXCLUDED, 4},
                                  {MUSURF_NO_DEFAULT, 8},
                                  {MUSURF_CONSTANT, 0},
                                  {MUSURF_SLOT, 1},
                                  {MUSURF_GLOSSY_REFLECTION, 1},
                                  {MUSURF_DELTA_REFLECTION, 2},
                                  {MUSURF_GLOSSY_TRANSMISSION, 4},
                                  {MUSURF_DELTA_TRANSMISSION, 8},
                                  {MUSURF_DIFFUSE_REFLECTION, 16},
                                  {MUSURF_DIFFUSE_TRANSMISSION, 32},
                                  {MUSURF_ALL_LOBES, 0xffffffffu},
                                  {MUSURF_DELTA_LOBES, 10},
                                  {MUSURF_IMPORTANCE, 1},
                                  {MUSURF_NEEDS_TANGENT, 1},
                                  {MUSURF_NEEDS_SLOTS, 2},
                                  {MUSURF_NEEDS_FOOTPRINT, 4},
                                  {MUSURF_FLOAT, 24},
                                  {MUSURF_DOUBLE, 53},
                                  {MUSURF_SAMPLE_AS_SET, 0},
                                  {MUSURF_SAMPLE_VISIBLE, 1},
                                  {MUSURF_SAMPLE_NDF, 2}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++)
        assert_int_equal(values[i][0], values[i][1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cold_structs_have_golden_layouts),
        cmocka_unit_test(hot_records_are_frozen),
        cmocka_unit_test(named_numbers_keep_their_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
