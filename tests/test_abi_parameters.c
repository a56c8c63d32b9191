/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_abi_parameters.c: the parameters of "musurf.microfacet" as hosts and scene files have them stored: a name goes with its id and
 * kind for ever. What is new takes an id above all that were; what is removed leaves its id unused.
 */
#include "tests/abi_host.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static const struct known {
    uint32_t id;
    musurf_kind kind;
    const char *name;
} KNOWN[] = {
    {1, MUSURF_CHOICE, "ndf"},
    {2, MUSURF_NUMBER, "alpha"},
    {3, MUSURF_NUMBER, "roughness"},
    {4, MUSURF_NUMBER, "gamma"},
    {5, MUSURF_MATRIX, "transform"},
    {6, MUSURF_NUMBER, "stretch"},
    {7, MUSURF_CHOICE, "fresnel"},
    {8, MUSURF_COLOR, "fresnel.schlick"},
    {9, MUSURF_NUMBER, "fresnel.dielectric"},
    {10, MUSURF_CHOICE, "fresnel.conductor"},
    {11, MUSURF_COLOR, "fresnel.conductor.n"},
    {12, MUSURF_COLOR, "fresnel.conductor.k"},
    {13, MUSURF_CHOICE, "sampler"},
    {14, MUSURF_NUMBER, "exponent"},
    {15, MUSURF_NUMBER, "alpha_x"},
    {16, MUSURF_NUMBER, "alpha_y"},
    {17, MUSURF_NUMBER, "rotation"},
    {18, MUSURF_CHOICE, "anisotropy"},
    {19, MUSURF_NUMBER, "anisotropy.disney"},
    {20, MUSURF_NUMBER, "anisotropy.cycles"},
    {21, MUSURF_NUMBER, "anisotropy.openpbr"},
    {22, MUSURF_NUMBER, "anisotropy.gltf"},
    {23, MUSURF_MATRIX, "anisotropy.covariance"},
    {24, MUSURF_VECTOR, "tilt"},
    {25, MUSURF_MATRIX3, "A"},
    {26, MUSURF_NUMBER, "theta_x"},
    {27, MUSURF_NUMBER, "theta_y"},
    {28, MUSURF_NUMBER, "theta_z"},
    {29, MUSURF_CHOICE, "masking"},
    {30, MUSURF_FLAG, "transmission"},
    {31, MUSURF_GRID, "histogram"},
    {32, MUSURF_NUMBER, "flakes.density"},
    {33, MUSURF_NUMBER, "flakes.cone"},
    {34, MUSURF_NUMBER, "flakes.seed"},
    {35, MUSURF_FOOTPRINT, "footprint"},
    {36, MUSURF_CHOICE, "multiple_scattering"},
    {37, MUSURF_CHOICE, "smith"},
    {38, MUSURF_FLAG, "blurs"},
};
enum { KNOWN_COUNT = sizeof KNOWN / sizeof KNOWN[0] };

static const musurf_param *param_at(const musurf_material_type *type, uint32_t i) {
    return (const musurf_param *)(const void *)((const char *)type->params +
                                                i * (size_t)type->params[0].size);
}

static void names_keep_their_ids(void **state) {
    (void)state;
    const musurf_material_type *type = abi_type(1);
    assert_string_equal(type->id, "musurf.microfacet");
    for (uint32_t i = 0; i < type->param_count; i++) {
        const musurf_param *p = param_at(type, i);
        const struct known *by_id = NULL, *by_name = NULL;
        for (int k = 0; k < KNOWN_COUNT; k++) {
            if (KNOWN[k].id == p->id) by_id = KNOWN + k;
            if (!strcmp(KNOWN[k].name, p->name)) by_name = KNOWN + k;
        }
        assert_ptr_equal(by_id, by_name); /* neither an id nor a name that meant something else */
        if (by_id)
            assert_int_equal(p->kind, by_id->kind);
        else
            assert_true(p->id > KNOWN[KNOWN_COUNT - 1].id); /* new: add it above */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(names_keep_their_ids)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
