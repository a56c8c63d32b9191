/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_material.c: materials from JSON through the plugins as built: template_material.so and
 * musurf_material.so. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "core/render/material_settings.h"

typedef struct reading {
    mu_document document;
    mu_material material;
    mu_error error;
    _Bool good;
} reading;

static reading read_text(mu_plugins *plugins, const char *text) {
    reading r = {.good = 0};
    if (!mu_document_parse(&r.document, "f", text, strlen(text), 1, &r.error)) fail_msg("%s", r.error.text);
    const mu_place root = mu_place_root(&r.document);
    r.good = mu_material_read(&r.material, plugins, &root, &r.error);
    assert_int_equal(r.good, r.error.text[0] == '\0');
    return r;
}

static void end(reading *r) {
    mu_material_free(&r->material);
    mu_document_free(&r->document);
}

static void expect_error(mu_plugins *plugins, const char *text, const char *start) {
    reading r = read_text(plugins, text);
    assert_false(r.good);
    assert_null(r.material.compiled);
    if (strncmp(r.error.text, start, strlen(start)) != 0) assert_string_equal(r.error.text, start);
    end(&r);
}

static int open_plugins(void **state) {
    const char *build = getenv("BUILD");
    setenv("MUSURF_PLUGIN_PATH", build ? build : "build", 1);
    *state = mu_plugins_new();
    return *state ? 0 : -1;
}

static int close_plugins(void **state) {
    mu_plugins_free(*state);
    return 0;
}

/* Shared objects are opened once each, and only those that are named. */
static void test_lambert(void **state) {
    mu_plugins *plugins = mu_plugins_new();
    (void)state;
    assert_null(mu_plugins_opened(plugins, 0));
    reading r = read_text(plugins, "{\"material\": \"template.lambert\", \"reflectance\": [0.2, 0.4, 0.8]}");
    if (!r.good) fail_msg("%s", r.error.text);
    assert_non_null(strstr(mu_plugins_opened(plugins, 0), "/template_material.so"));
    assert_null(mu_plugins_opened(plugins, 1));
    assert_int_equal(r.material.plan.lobes, MUSURF_DIFFUSE_REFLECTION);

    /* f cos = reflectance cos / pi */
    unsigned char closure[256] __attribute__((aligned(64)));
    assert_in_range(r.material.plan.closure_bytes, 1, sizeof closure);
    const float wo[3] = {0, 0, 1}, wi[3] = {0.6f, 0, 0.8f};
    musurf_value value;
    assert_int_not_equal(r.material.type->setup(r.material.compiled, wo, NULL, 0, closure), 0);
    r.material.type->eval(closure, wi, MUSURF_ALL_LOBES, &value);
    for (int i = 0; i < 3; i++) {
        const float expected = (float[]){0.2f, 0.4f, 0.8f}[i] * 0.8f / 3.14159265f;
        assert_float_equal(value.f[i], expected, 1e-6f * expected); /* four roundings of 2^-24 */
    }
    end(&r);
    mu_plugins_free(plugins);
}

static void test_microfacet(void **state) {
    static const char *const good[] = {
        "{\"material\": \"musurf.microfacet\"}",
        "{\"material\": \"musurf.microfacet\", \"ndf\": \"gtr\", \"alpha\": 0.0121, \"gamma\": 1.7,\n"
        "  \"transform\": [[1, 2], [0, 1]], \"fresnel\": {\"conductor\": \"Ag\"}}",
        "{\"material\": \"musurf.microfacet\", \"ndf\": \"beckmann\", \"fresnel\": \"none\"}",
        "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"fresnel\": {\"schlick\": [0.9, 0.8, "
        "0.3]}}",
        "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"fresnel\": {\"dielectric\": 1.5}}",
        "{\"material\": \"musurf.microfacet\", \"fresnel\": {\"conductor\": {\"n\": [0.2, 0.9, 1], \"k\": "
        "3}}}",
    };
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        reading r = read_text(*state, good[i]);
        if (!r.good) fail_msg("%s", r.error.text);
        assert_non_null(r.material.compiled);
        assert_in_range(r.material.plan.closure_bytes, 1, 4096);
        assert_int_equal(r.material.plan.slot_floats, 0);
        assert_int_equal(r.material.jacobian.map, MU_JACOBIAN_NONE);
        end(&r);
    }
}

/* The plugin judges what only it can judge; the message stands at the parameter. */
static void test_the_plugins_own_words(void **state) {
    expect_error(*state, "{\"material\": \"musurf.microfacet\",\n \"transform\": [[1, 2], [2, 4]]}",
                 "f:2:15: $.transform: ");
    expect_error(*state, "{\"material\": \"musurf.microfacet\", \"ndf\": \"gtr\",\n\"alpha\": 1.5}",
                 "f:2:10: $.alpha: ");
    expect_error(*state, "{\"material\": \"musurf.microfacet\",\n\"alpha\": -1}",
                 "f:2:10: $.alpha: is -1; it must be");
}

static void test_names(void **state) {
    expect_error(*state, "{}", "f:1:1: $.material: is missing; a string is needed");
    expect_error(*state, "3", "f:1:1: $: is 3; an object is needed");
    expect_error(*state, "{\"material\": 3}", "f:1:14: $.material: is 3; a string is needed");
    expect_error(*state, "{\"material\": \"microfacet\"}",
                 "f:1:14: $.material: \"microfacet\" does not name a material");
    expect_error(*state, "{\"material\": \"../../x.y\"}",
                 "f:1:14: $.material: \"../../x.y\" does not name a material");
    expect_error(*state, "{\"material\": \"musurf.\"}",
                 "f:1:14: $.material: \"musurf.\" does not name a material");
    expect_error(*state, "{\"material\": \"musurf.velvet\"}",
                 "f:1:14: $.material: \"musurf.velvet\" is not in ");
    expect_error(*state, "{\"material\": \"nobody.velvet\"}",
                 "f:1:14: $.material: there is no plugin nobody_material.so in ");
}

static void test_jacobian(void **state) {
    reading r =
        read_text(*state, "{\"material\": \"musurf.microfacet\", \"transform\": [[5, 1], [0, 2]],"
                          " \"jacobian\": {\"map\": \"power_shear\", \"amount\": 2, \"exponent\": 5}}");
    if (!r.good) fail_msg("%s", r.error.text);
    assert_int_equal(r.material.jacobian.map, MU_JACOBIAN_POWER_SHEAR);
    assert_true(r.material.jacobian.amount == 2 && r.material.jacobian.exponent == 5);
    assert_memory_equal(r.material.transform, ((const float[]){5, 1, 0, 2}), sizeof r.material.transform);
    assert_int_equal(r.material.plan.slot_floats, 4);
    assert_true(r.material.plan.needs & MUSURF_NEEDS_SLOTS);
    end(&r);

    r = read_text(*state, "{\"material\": \"musurf.microfacet\","
                          " \"jacobian\": {\"map\": \"power_shear\", \"amount\": -0.5, \"exponent\": 1}}");
    if (!r.good) fail_msg("%s", r.error.text);
    assert_memory_equal(r.material.transform, ((const float[]){1, 0, 0, 1}), sizeof r.material.transform);
    end(&r);

#define WITH(JACOBIAN) "{\"material\": \"musurf.microfacet\",\n\"jacobian\": " JACOBIAN "}"
    expect_error(*state, WITH("3"), "f:2:13: $.jacobian: is 3; an object is needed");
    expect_error(*state, WITH("{\"map\": \"shear\", \"amount\": 1, \"exponent\": 1}"),
                 "f:2:21: $.jacobian.map: \"shear\" is not known");
    expect_error(*state, WITH("{\"map\": \"power_shear\", \"exponent\": 1}"),
                 "f:2:13: $.jacobian.amount: is missing");
    expect_error(*state, WITH("{\"map\": \"power_shear\", \"amount\": 1, \"exponent\": 0.5}"),
                 "f:2:61: $.jacobian.exponent: is 0.5; a number from 1 to 1000 is needed");
    expect_error(*state, WITH("{\"map\": \"power_shear\", \"amount\": 1, \"exponent\": 2, \"u\": 1}"),
                 "f:2:64: $.jacobian.u: this key is not known");
    /* A singular constant part stays singular whatever it is multiplied by. */
    expect_error(
        *state,
        WITH("{\"map\": \"power_shear\", \"amount\": 1, \"exponent\": 2}, \"transform\": [[1, 1], [1, 1]]"),
        "f:2:78: $.transform: ");
    expect_error(*state,
                 "{\"material\": \"template.lambert\",\n\"jacobian\": {\"map\": \"power_shear\", \"amount\": "
                 "1, \"exponent\": 2}}",
                 "f:2:1: $.jacobian: template.lambert has no transform that may vary");
}

/* Every default and every end of a range in the table is accepted by the plugin that wrote it. */
static void test_the_table_keeps_its_word(void **state) {
    static const char *const ids[] = {"musurf.microfacet", "template.lambert"};
    for (size_t t = 0; t < 2; t++) {
        mu_error error = {.text = ""};
        const musurf_material_type *type = mu_plugins_type(*state, ids[t], &error);
        if (!type) fail_msg("%s", error.text);
        for (uint32_t i = 0; i < type->param_count; i++) {
            const musurf_param *p = mu_type_param(type, i);
            musurf_setting setting = {sizeof setting,    p->id, MUSURF_CONSTANT, 0, p->initial,
                                      p->initial_choice, 0};
            const musurf_host host = {.size = sizeof host};
            musurf_material *material = NULL;
            if (strchr(p->name, '.') || (p->flags & MUSURF_NO_DEFAULT))
                continue; /* has a meaning only beside its choice */
            if (type->compile(&host, &setting, 1, &material) != MUSURF_OK) fail_msg("default of %s", p->name);
            type->release(material);
            for (const char *const *c = p->choices; p->kind == MUSURF_CHOICE && *c; c++) {
                static const double grid[7] = {1, 1, -1, 1, -1, 1, 1};
                const musurf_param *const histogram = mu_type_find(type, "histogram"),
                                   *const ndf = mu_type_find(type, "ndf");
                setting.text = *c;
                musurf_setting both[2] = {setting, setting}; /* what a choice cannot be without */
                size_t count = 1;
                if (strcmp(*c, "tabulated") == 0 && histogram)
                    both[count++] = (musurf_setting){
                        .size = sizeof setting, .param = histogram->id, .values = grid, .count = 7};
                if (strcmp(*c, "spline") == 0 && ndf)
                    both[count++] = (musurf_setting){.size = sizeof setting, .param = ndf->id, .text = "gtr"};
                if (type->compile(&host, both, count, &material) != MUSURF_OK)
                    fail_msg("%s of %s", *c, p->name);
                type->release(material);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lambert),
        cmocka_unit_test(test_microfacet),
        cmocka_unit_test(test_the_plugins_own_words),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_jacobian),
        cmocka_unit_test(test_the_table_keeps_its_word),
    };
    return cmocka_run_group_tests(tests, open_plugins, close_plugins);
}
