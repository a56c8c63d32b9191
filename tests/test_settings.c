/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_settings.c: JSON becomes settings by a parameter table alone. The table here is the test's own and has
 * every kind of parameter; no plugin takes part. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>

#include "core/render/material_settings.h"

#define PARAM(ID, NAME, KIND, ...)                                                                           \
    {                                                                                                        \
        .size = sizeof(musurf_param), .id = (ID), .name = (NAME), .label = "", .doc = "", .unit = "",        \
        .kind = (KIND), __VA_ARGS__                                                                          \
    }

static const char *const shapes[] = {"round", "flat", "glass", "metal", NULL};
static const char *const metals[] = {"gold", "iron", NULL};
static const musurf_param params[] = {
    PARAM(11, "size", MUSURF_NUMBER, .min = 0, .max = 1, .flags = MUSURF_MIN_EXCLUDED),
    PARAM(12, "tint", MUSURF_COLOR, .min = 0, .max = INFINITY),
    PARAM(13, "map", MUSURF_MATRIX, .min = -INFINITY, .max = INFINITY),
    PARAM(14, "both", MUSURF_FLAG, .max = 1),
    PARAM(15, "shape", MUSURF_CHOICE, .choices = shapes, .initial_choice = "round"),
    PARAM(16, "shape.glass", MUSURF_NUMBER, .min = 1, .max = 3, .flags = MUSURF_MAX_EXCLUDED),
    PARAM(17, "shape.metal", MUSURF_CHOICE, .choices = metals, .initial_choice = "gold"),
    PARAM(18, "shape.metal.n", MUSURF_COLOR, .min = 0, .max = INFINITY),
    PARAM(19, "shape.metal.k", MUSURF_COLOR, .min = 0, .max = INFINITY),
    PARAM(20, "noise.scale", MUSURF_NUMBER, .min = -INFINITY, .max = INFINITY),
};
static const musurf_material_type type = {
    .size = sizeof type, .param_count = sizeof params / sizeof params[0], .id = "test.all", .params = params};

typedef struct reading {
    mu_document document;
    mu_settings settings;
    mu_error error;
    _Bool good;
} reading;

static reading read_text(const char *text) {
    static const char *const reserved[] = {"material", NULL};
    reading r = {.good = 0};
    if (!mu_document_parse(&r.document, "f", text, strlen(text), 1, &r.error)) fail_msg("%s", r.error.text);
    const mu_place root = mu_place_root(&r.document);
    r.good = mu_settings_read(&r.settings, &type, &root, reserved, &r.error);
    return r;
}

static void end(reading *r) {
    mu_settings_free(&r->settings);
    mu_document_free(&r->document);
}

static const musurf_setting *set(const reading *r, const char *name) {
    return mu_settings_find(&r->settings, mu_type_find(&type, name));
}

static void expect_values(const reading *r, const char *name, size_t count, const double *values) {
    const musurf_setting *s = set(r, name);
    assert_non_null(s);
    assert_int_equal(s->source, MUSURF_CONSTANT);
    for (size_t i = 0; i < count; i++) assert_true(s->values[i] == values[i]);
}

static void test_every_kind(void **state) {
    (void)state;
    reading r = read_text(
        "{\"material\": \"test.all\", \"size\": 1, \"tint\": [1, 0.5, 7], \"map\": [[1, 2], [3, 4]], "
        "\"both\": true, \"shape\": \"flat\", \"noise\": {\"scale\": -3}}");
    if (!r.good) fail_msg("%s", r.error.text);
    assert_int_equal(r.settings.count, 6);
    expect_values(&r, "size", 1, (const double[]){1});
    expect_values(&r, "tint", 3, (const double[]){1, 0.5, 7});
    expect_values(&r, "map", 4, (const double[]){1, 2, 3, 4});
    expect_values(&r, "both", 1, (const double[]){1});
    assert_string_equal(set(&r, "shape")->text, "flat");
    expect_values(&r, "noise.scale", 1, (const double[]){-3});
    end(&r);
}

static void test_choices_with_values(void **state) {
    (void)state;
    reading r = read_text("{\"shape\": {\"glass\": 1.5}, \"tint\": 0.25}");
    assert_true(r.good);
    assert_string_equal(set(&r, "shape")->text, "glass");
    expect_values(&r, "shape.glass", 1, (const double[]){1.5});
    expect_values(&r, "tint", 3, (const double[]){0.25, 0.25, 0.25});
    end(&r);

    r = read_text("{\"shape\": {\"metal\": \"iron\"}}");
    assert_true(r.good);
    assert_string_equal(set(&r, "shape")->text, "metal");
    assert_string_equal(set(&r, "shape.metal")->text, "iron");
    assert_int_equal(r.settings.count, 2);
    end(&r);

    r = read_text("{\"shape\": {\"metal\": {\"n\": 1, \"k\": [2, 3, 4]}}}");
    assert_true(r.good);
    assert_string_equal(set(&r, "shape")->text, "metal");
    assert_null(set(&r, "shape.metal"));
    expect_values(&r, "shape.metal.n", 3, (const double[]){1, 1, 1});
    expect_values(&r, "shape.metal.k", 3, (const double[]){2, 3, 4});
    end(&r);

    r = read_text("{}");
    assert_true(r.good && r.settings.count == 0);
    end(&r);
}

static void test_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"{\"size\": 0}", "f:1:10: $.size: is 0; it must be above 0 and at most 1"},
        {"{\"size\": 1.01}", "f:1:10: $.size: is 1.01; it must be above 0 and at most 1"},
        {"{\"size\": \"1\"}", "f:1:10: $.size: is \"1\"; a number is needed"},
        {"{\"size\": null}", "f:1:10: $.size: is null; a number is needed"},
        {"{\"size\": {\"x\": 1}}", "f:1:10: $.size: is an object; a number is needed"},
        {"{\n\"sise\": 1}",
         "f:2:1: $.sise: this key is not known; did you mean \"size\"? Known: material, size, tint, "
         "map, both, shape, noise"},
        {"{\"tint\": [1, 2]}", "f:1:10: $.tint: a color is a number or [r, g, b]"},
        {"{\"tint\": [1, -2, 3]}", "f:1:14: $.tint[1]: is -2; it must be at least 0"},
        {"{\"map\": [1, 0, 0, 1]}",
         "f:1:9: $.map: a 2x2 matrix is written as its two rows, [[a, c], [b, d]]"},
        {"{\"map\": [[1, 0], [0, \"1\"]]}", "f:1:22: $.map[1][1]: is \"1\"; a number is needed"},
        {"{\"both\": 1}", "f:1:10: $.both: is 1; true or false is needed"},
        {"{\"shape\": \"rund\"}",
         "f:1:11: $.shape: \"rund\" is not known; did you mean \"round\"? Known: round, flat, "
         "glass, metal"},
        {"{\"shape\": {\"glas\": 1}}",
         "f:1:12: $.shape.glas: this key is not known; did you mean \"glass\"? Known: "
         "round, flat, glass, metal"},
        {"{\"shape\": {}}",
         "f:1:11: $.shape: is an empty object; a choice, or what belongs to one, is needed"},
        {"{\"shape\": {\"flat\": 1}}", "f:1:11: $.shape: \"flat\" takes no value; write \"flat\" alone"},
        {"{\"shape\": {\"glass\": 2, \"metal\": \"gold\"}}",
         "f:1:24: $.shape.metal: only one can be chosen, and \"glass\" is already"},
        {"{\"shape\": {\"glass\": 3}}", "f:1:21: $.shape.glass: is 3; it must be at least 1 and below 3"},
        {"{\"shape\": {\"metal\": {\"m\": 3}}}",
         "f:1:22: $.shape.metal.m: this key is not known; known: gold, iron, n, k"},
        {"{\"shape\": 3}", "f:1:11: $.shape: is 3; one of \"round\" \"flat\" \"glass\" \"metal\" is needed"},
        {"{\"noise\": 3}", "f:1:11: $.noise: is 3; an object is needed"},
        {"{\"shape.glass\": 2}",
         "f:1:2: $[\"shape.glass\"]: this key is not known; known: material, size, tint, map, "
         "both, shape, noise"},
        {"[]", "f:1:1: $: is an array of 0; an object is needed"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        reading r = read_text(cases[i].text);
        assert_false(r.good);
        assert_string_equal(r.error.text, cases[i].message);
        end(&r);
    }
}

/* A newer plugin may have longer records than ours: the table is read with its own stride. */
static void test_longer_records(void **state) {
    (void)state;
    struct longer {
        musurf_param param;
        double more;
    } table[2] = {{params[0], 1}, {params[3], 2}};
    table[0].param.size = table[1].param.size = sizeof table[0];
    const musurf_material_type newer = {
        .size = sizeof newer, .param_count = 2, .id = "test.newer", .params = &table[0].param};
    assert_ptr_equal(mu_type_find(&newer, "both"), &table[1].param);
    assert_ptr_equal(mu_type_find_id(&newer, 11), &table[0].param);
    assert_null(mu_type_find(&newer, "tint"));
}

/* A message about a parameter points at the parameter, or as near to it as the document goes. */
static void test_messages_find_their_place(void **state) {
    (void)state;
    reading r = read_text("{\"size\": 1, \"shape\":\n {\"metal\": \"gold\"}}");
    const mu_place root = mu_place_root(&r.document);
    static const struct {
        const char *name, *message;
    } cases[] = {{"size", "f:1:10: $.size: no"},
                 {"shape.metal", "f:2:12: $.shape.metal: no"},
                 {"shape.metal.n", "f:2:12: $.shape.metal: no"},
                 {"tint", "f:1:1: $: no"},
                 {"", "f:1:1: $: no"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mu_error error = {.text = ""};
        mu_settings_fail(&root, cases[i].name, &error, "no");
        assert_string_equal(error.text, cases[i].message);
    }
    end(&r);
}

/* ----------------------------------------------------------------------------------------- plugin_check.c */

static const musurf_material_type *one_type[1];
static const musurf_plugin sound = {
    .size = sizeof sound, .name = "n", .version = "v", .license = "l", .type_count = 1, .types = one_type};

static void expect_plugin(const musurf_plugin *plugin, const musurf_material_type *offered,
                          const char *message) {
    mu_error error = {.text = ""};
    one_type[0] = offered;
    assert_int_equal(mu_plugin_check(plugin, "test", "x.so", &error), message[0] == '\0');
    assert_string_equal(error.text, message);
}

static void nothing(void) {}

static void test_unsound_plugins(void **state) {
    (void)state;
    /* The check never calls these; that they are functions of another kind does not matter here. */
    musurf_material_type whole = type;
    void (*const any)(void) = nothing;
    whole.label = whole.doc = "";
    unsigned char *const first = (unsigned char *)&whole.compile, *const last =
                                                                      (unsigned char *)&whole.extension;
    for (unsigned char *at = first; at <= last; at += sizeof any) memcpy(at, &any, sizeof any);
    expect_plugin(&sound, &whole, "");

    for (unsigned char *at = first; at <= last; at += sizeof any) {
        memset(at, 0, sizeof any);
        expect_plugin(&sound, &whole, "x.so: test.all lacks one of its functions");
        memcpy(at, &any, sizeof any);
    }
    expect_plugin(NULL, &whole, "x.so: musurf_plugin_v1 returned NULL");
    expect_plugin(&sound, NULL, "x.so: one of its material types is NULL");

    musurf_plugin shorter = sound;
    shorter.size = offsetof(musurf_plugin, types);
    expect_plugin(&shorter, &whole, "x.so: its plugin table is 40 bytes long; at least 48 are needed");
    musurf_plugin longer = sound;
    longer.size += 100;
    longer.abi_minor = 7;
    expect_plugin(&longer, &whole, "");

    musurf_material_type other = whole;
    other.size = offsetof(musurf_material_type, extension);
    expect_plugin(&sound, &other, "x.so: a material type is 128 bytes long; at least 136 are needed");
    other = whole;
    other.id = "tester.all";
    expect_plugin(&sound, &other, "x.so: material type \"tester.all\" is not of the vendor \"test\"");

    musurf_param table[2] = {params[0], params[1]};
    other = whole;
    other.params = table;
    other.param_count = 2;
    table[1].id = table[0].id;
    expect_plugin(&sound, &other, "x.so: parameters \"size\" and \"tint\" of test.all share a name or an id");
    table[1].id = 0;
    expect_plugin(&sound, &other, "x.so: parameter \"tint\" of test.all has the id 0, which is reserved");
    table[1] = params[4];
    table[1].choices = NULL;
    expect_plugin(&sound, &other, "x.so: parameter \"shape\" of test.all lacks its choices or its default");
    table[1] = params[1];
    table[1].doc = NULL;
    expect_plugin(&sound, &other,
                  "x.so: parameter 12 of test.all lacks a text; a name, label, doc and unit are needed");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_kind),
        cmocka_unit_test(test_choices_with_values),
        cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_longer_records),
        cmocka_unit_test(test_messages_find_their_place),
        cmocka_unit_test(test_unsound_plugins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
