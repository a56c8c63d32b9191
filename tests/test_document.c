/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_document.c: JSON documents know where each value stands, and every mistake gets its line.
 *
 * The oracle for positions is the text itself: each value of a generated document is a number that occurs
 * once, so that strstr finds it without knowing anything about JSON.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

#include "core/render/document_locate.h"

static mu_document parsed(const char *text) {
    mu_error error = {.text = ""};
    mu_document document;
    if (!mu_document_parse(&document, "file", text, strlen(text), 1, &error))
        fail_msg("%s: %s", text, error.text);
    return document;
}

/* ---------------------------------------------------------------------------------------------- positions */

typedef struct generator {
    char text[1 << 16];
    size_t length;
    uint32_t state; /* a linear congruential generator; its seed is fixed */
    int next;       /* the next number */
} generator;

static uint32_t draw(generator *g, uint32_t below) {
    g->state = g->state * 1664525u + 1013904223u;
    return (g->state >> 16) % below;
}

static void put(generator *g, const char *text) {
    const size_t length = strlen(text);
    assert_true(g->length + length < sizeof g->text);
    memcpy(g->text + g->length, text, length + 1);
    g->length += length;
}

static void space(generator *g) {
    static const char *const spaces[] = {"", "", " ", "\n", "\t", " \r\n  "};
    put(g, spaces[draw(g, 6)]);
}

/* Keys as written; what they mean is checked by walking with jansson's own decoding of them. */
static const char *const keys[] = {"\"a\"",         "\"\\u0061b\"", "\"\\\"]}\"",   "\"\\\\\"",
                                   "\"\\n\\t\\/\"", "\"\xc3\xa9\"", "\"\\u00e9x\"", "\"\\ud83d\\ude00\"",
                                   "\"\"",          "\"{[,:\""};

static void value(generator *g, int depth) {
    char number[32];
    const uint32_t kind = depth == 0 ? 0 : draw(g, 3);
    if (kind == 0) {
        snprintf(number, sizeof number, "%d", g->next++);
        put(g, number);
        return;
    }
    const uint32_t count = draw(g, 5), first = draw(g, 10);
    put(g, kind == 1 ? "[" : "{");
    for (uint32_t i = 0; i < count; i++) {
        if (i) put(g, ",");
        space(g);
        if (kind == 2) {
            put(g, keys[(first + i) % 10]);
            space(g);
            put(g, ":");
            space(g);
        }
        value(g, depth - 1);
        space(g);
    }
    put(g, kind == 1 ? "]" : "}");
}

static void expect_here(const mu_place *place, size_t *seen) {
    const mu_document *d = place->document;
    if (json_is_object(place->value)) {
        const char *key;
        json_t *member;
        json_object_foreach(place->value, key, member) {
            const mu_place at = mu_place_member(place, key);
            expect_here(&at, seen);
        }
    } else if (json_is_array(place->value)) {
        for (size_t i = 0; i < json_array_size(place->value); i++) {
            const mu_place at = mu_place_element(place, i);
            expect_here(&at, seen);
        }
    } else {
        char number[32];
        snprintf(number, sizeof number, "%d", (int)json_integer_value(place->value));
        mu_span span;
        assert_true(mu_locate(place, 0, &span));
        const char *const found = strstr(d->text, number);
        assert_ptr_equal(d->text + span.begin, found);
        assert_int_equal(span.end - span.begin, strlen(number));
        (*seen)++;
    }
}

static void test_positions_of_generated_documents(void **state) {
    (void)state;
    size_t seen = 0;
    for (uint32_t seed = 1; seed <= 300; seed++) {
        static generator g;
        g = (generator){.state = seed, .next = 100000};
        put(&g, "[");
        value(&g, 6);
        put(&g, "]");
        mu_document d = parsed(g.text);
        const mu_place root = mu_place_root(&d);
        size_t here = 0;
        expect_here(&root, &here);
        assert_int_equal(here, g.next - 100000);
        seen += here;
        mu_document_free(&d);
    }
    assert_true(seen > 1000);
}

/* Line and column by hand, columns in characters. */
static void test_line_and_column(void **state) {
    (void)state;
    mu_document d =
        parsed("{\n  \"\xc3\xa9\xf0\x9f\x98\x80\": {\"b\": [1,\n 2, \"x\"]},\r\n\"\\u0041\":null}");
    const mu_place root = mu_place_root(&d), e = mu_place_member(&root, "\xc3\xa9\xf0\x9f\x98\x80"),
                   b = mu_place_member(&e, "b"), one = mu_place_element(&b, 0), x = mu_place_element(&b, 2),
                   a = mu_place_member(&root, "A"), missing = mu_place_member(&e, "missing");
    const struct {
        const mu_place *place;
        _Bool at_key;
        const char *message;
    } cases[] = {
        {&root, 0, "file:1:1: $: here"},
        {&e, 0, "file:2:9: $[\"\xc3\xa9\xf0\x9f\x98\x80\"]: here"},
        {&e, 1, "file:2:3: $[\"\xc3\xa9\xf0\x9f\x98\x80\"]: here"},
        {&one, 0, "file:2:16: $[\"\xc3\xa9\xf0\x9f\x98\x80\"].b[0]: here"},
        {&x, 0, "file:3:5: $[\"\xc3\xa9\xf0\x9f\x98\x80\"].b[2]: here"},
        {&a, 0, "file:4:10: $.A: here"},
        {&a, 1, "file:4:1: $.A: here"},
        {&missing, 0, "file:2:9: $[\"\xc3\xa9\xf0\x9f\x98\x80\"].missing: here"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mu_error error = {.text = ""};
        assert_false(cases[i].at_key ? mu_place_fail_key(cases[i].place, &error, "here")
                                     : mu_place_fail(cases[i].place, &error, "here"));
        assert_string_equal(error.text, cases[i].message);
    }
    mu_document_free(&d);
}

/* A path too long for a line is shortened; the end of it, where the mistake is, stays. */
static void test_long_paths(void **state) {
    (void)state;
    enum { DEPTH = 1000 };
    char text[2 * DEPTH + 2];
    memset(text, '[', DEPTH);
    text[DEPTH] = '7';
    memset(text + DEPTH + 1, ']', DEPTH);
    text[2 * DEPTH + 1] = '\0';
    mu_document d = parsed(text);
    static mu_place places[DEPTH + 1];
    places[0] = mu_place_root(&d);
    for (int i = 0; i < DEPTH; i++) places[i + 1] = mu_place_element(places + i, 0);
    mu_error error = {.text = ""};
    mu_place_fail(places + DEPTH, &error, "here");
    assert_true(strncmp(error.text, "file:1:1001: $...", 17) == 0);
    assert_non_null(strstr(error.text, "[0]: here"));
    assert_true(strlen(error.text) < 400);
    mu_document_free(&d);
}

/* ------------------------------------------------------------------------------------------------- syntax */

static void test_syntax_errors(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
        size_t length; /* 0: strlen */
    } cases[] = {
        {"", "file:1:1: $: is empty; a JSON object is needed", 0},
        {" \n\t", "file:1:1: $: is empty; a JSON object is needed", 0},
        {"{\"a\": 1,\n \"b\": [1, 2}", "file:2:12: $.b[1]: ']' expected at '}'", 0},
        {"{\"a\": 1,\n \"b\": [1, 2",
         "file:2:12: $.b[1]: the text ends, but the '[' of line 2, column 7 is not closed", 0},
        {"{\"a\": {\"b\": [] ",
         "file:1:16: $.a.b: the text ends, but the '{' of line 1, column 7 is not closed", 0},
        {"{\"a\": 1, \"\\u0061\": 2}",
         "file:1:10: $: the key \"\\u0061\" stands here a second time; give it once", 0},
        {"{\"a\": 1e999}",
         "file:1:7: $.a: the number 1e999 is too large; at most 1.797e308, whole numbers to 2^63-1", 0},
        {"{\"a\": -1e999}",
         "file:1:7: $.a: the number -1e999 is too large; at most 1.797e308, whole numbers to 2^63-1", 0},
        {"[99999999999999999999]",
         "file:1:2: $[0]: the number 99999999999999999999 is too large; at most 1.797e308, "
         "whole numbers to 2^63-1",
         0},
        {"[NaN]", "file:1:2: $[0]: NaN is not JSON; a finite number is needed", 0},
        {"[1,\n Infinity]", "file:2:2: $[1]: Infinity is not JSON; a finite number is needed", 0},
        {"{} x", "file:1:4: $: more text, x after the end of the document; nothing may follow it", 0},
        {"[\"\xff\"]", "file:1:3: $[0]: byte 0xff is not UTF-8", 0},
        {"[\n\"\xc3\xa9\xed\xa0\x80\"]", "file:2:3: $[0]: byte 0xed is not UTF-8", 0},
        {"[1,\0 2]", "file:1:4: $[1]: a NUL byte; JSON text is needed", 7},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mu_error error = {.text = ""};
        mu_document d;
        const size_t length = cases[i].length ? cases[i].length : strlen(cases[i].text);
        assert_false(mu_document_parse(&d, "file", cases[i].text, length, 1, &error));
        assert_string_equal(error.text, cases[i].message);
        assert_null(d.root);
    }
}

static void test_first_line_counts(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    mu_document d;
    assert_false(mu_document_parse(&d, "stdin", "{\"a\" 1}", 7, 41, &error));
    assert_string_equal(error.text, "stdin:41:6: $.a: ':' expected at '1'");
}

static void test_byte_order_mark(void **state) {
    (void)state;
    mu_document d = parsed("\xef\xbb\xbf{\"a\": 3}");
    assert_int_equal(json_integer_value(json_object_get(d.root, "a")), 3);
    mu_document_free(&d);
}

/* Brackets by the megabyte are refused at jansson's limit, before memory or stack are gone. */
static void test_deep_nesting(void **state) {
    (void)state;
    const size_t length = 8 << 20;
    char *text = malloc(length);
    assert_non_null(text);
    for (int object = 0; object < 2; object++) {
        for (size_t i = 0; i < length; i++) text[i] = object ? "{\"a\":"[i % 5] : '[';
        mu_error error = {.text = ""};
        mu_document d;
        assert_false(mu_document_parse(&d, "file", text, length, 1, &error));
        assert_non_null(strstr(error.text, ": $...: nested deeper than 2048 levels"));
    }
    free(text);
}

/* -------------------------------------------------------------------------------------------------- files */

static void expect_refused(const char *file, const char *end) {
    mu_error error = {.text = ""};
    mu_document d;
    assert_false(mu_document_read(&d, file, &error));
    assert_true(strncmp(error.text, file, strlen(file)) == 0);
    assert_string_equal(error.text + strlen(file), end);
}

static void test_files(void **state) {
    (void)state;
    char folder[] = "/tmp/musurf-document-XXXXXX", file[64];
    assert_non_null(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/scene.json", folder);
    expect_refused(folder, ": is a directory; a JSON file is needed");
    expect_refused(file, ": cannot be opened: No such file or directory");

    FILE *out = fopen(file, "w");
    assert_non_null(out);
    assert_int_equal(fclose(out), 0);
    expect_refused(file, ":1:1: $: is empty; a JSON object is needed");
    if (geteuid() != 0) { /* root may read everything */
        assert_int_equal(chmod(file, 0), 0);
        expect_refused(file, ": cannot be opened: Permission denied");
        assert_int_equal(chmod(file, 0600), 0);
    }
    assert_int_equal(truncate(file, 100 << 20), 0);
    expect_refused(file, ":1:1: $: larger than 8 MiB; no document needs that");

    out = fopen(file, "w");
    assert_non_null(out);
    fputs("{\"alpha\": 0.5}", out);
    assert_int_equal(fclose(out), 0);
    mu_error error = {.text = ""};
    mu_document d;
    assert_true(mu_document_read(&d, file, &error));
    assert_true(json_number_value(json_object_get(d.root, "alpha")) == 0.5);
    mu_document_free(&d);
    unlink(file);
    rmdir(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_positions_of_generated_documents),
        cmocka_unit_test(test_line_and_column),
        cmocka_unit_test(test_long_paths),
        cmocka_unit_test(test_syntax_errors),
        cmocka_unit_test(test_first_line_counts),
        cmocka_unit_test(test_byte_order_mark),
        cmocka_unit_test(test_deep_nesting),
        cmocka_unit_test(test_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
