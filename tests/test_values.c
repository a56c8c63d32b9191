/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_values.c: the typed readers of documents, the nearest known word, and messages that stay one printable
 * line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>

#include "core/render/document.h"
#include "core/render/philox.h"
#include "core/render/utf8.h"

static mu_document parsed(const char *text) {
    mu_error error = {.text = ""};
    mu_document document;
    if (!mu_document_parse(&document, "f", text, strlen(text), 1, &error)) fail_msg("%s", error.text);
    return document;
}

/* `read` fails with exactly this line. */
#define EXPECT(read, message)                                                                                \
    do {                                                                                                     \
        error.text[0] = '\0';                                                                                \
        assert_false(read);                                                                                  \
        assert_string_equal(error.text, message);                                                            \
    } while (0)

static void test_numbers(void **state) {
    (void)state;
    mu_document d = parsed("{\"x\": 1.5, \"i\": 3, \"v\": [1, 2.5, -1e300], \"s\": \"3\", \"e\": 2e3}");
    const mu_place root = mu_place_root(&d), x = mu_place_member(&root, "x"), i = mu_place_member(&root, "i"),
                   v = mu_place_member(&root, "v"), s = mu_place_member(&root, "s"),
                   e = mu_place_member(&root, "e"), none = mu_place_member(&root, "none");
    mu_error error = {.text = ""};
    double out, three[3];
    long long whole;
    assert_true(mu_place_number(&x, 0, 1.5, &out, &error) && out == 1.5);
    assert_true(mu_place_number(&i, 3, 3, &out, &error) && out == 3);
    assert_true(mu_place_numbers(&v, 3, -INFINITY, INFINITY, three, &error) && three[1] == 2.5 &&
                three[2] == -1e300);
    assert_true(mu_place_integer(&i, 0, 9, &whole, &error) && whole == 3);
    assert_true(mu_place_integer(&e, 0, 2000, &whole, &error) && whole == 2000);
    assert_string_equal(error.text, "");

    EXPECT(mu_place_number(&x, 0, 1, &out, &error), "f:1:7: $.x: is 1.5; a number from 0 to 1 is needed");
    EXPECT(mu_place_number(&s, 0, INFINITY, &out, &error),
           "f:1:48: $.s: is \"3\"; a number of at least 0 is needed");
    EXPECT(mu_place_number(&none, -INFINITY, INFINITY, &out, &error),
           "f:1:1: $.none: is missing; a number is needed");
    EXPECT(mu_place_numbers(&v, 2, 0, 1, three, &error),
           "f:1:25: $.v: is an array of 3; an array of 2 numbers is needed");
    EXPECT(mu_place_numbers(&v, 3, 0, 9, three, &error),
           "f:1:34: $.v[2]: is -1e+300; a number from 0 to 9 is needed");
    EXPECT(mu_place_integer(&x, 0, 9, &whole, &error),
           "f:1:7: $.x: is 1.5; a whole number from 0 to 9 is needed");
    mu_document_free(&d);
}

static void test_words(void **state) {
    (void)state;
    static const char *const choices[] = {"ggx", "beckmann", "gtr", NULL};
    mu_document d =
        parsed("{\"ndf\": \"gxg\", \"good\": \"gtr\", \"flag\": 1, \"o\": {\"ndff\": 1}, \"w\": \"zzzzz\"}");
    const mu_place root = mu_place_root(&d), ndf = mu_place_member(&root, "ndf"),
                   good = mu_place_member(&root, "good"), flag = mu_place_member(&root, "flag"),
                   o = mu_place_member(&root, "o"), w = mu_place_member(&root, "w");
    mu_error error = {.text = ""};
    size_t index;
    _Bool truth;
    const char *text;
    assert_true(mu_place_choice(&good, choices, &index, &error) && index == 2);
    assert_true(mu_place_string(&good, &text, &error) && strcmp(text, "gtr") == 0);
    EXPECT(mu_place_choice(&ndf, choices, &index, &error),
           "f:1:9: $.ndf: \"gxg\" is not known; did you mean \"ggx\"? Known: ggx, beckmann, gtr");
    EXPECT(mu_place_choice(&w, choices, &index, &error),
           "f:1:65: $.w: \"zzzzz\" is not known; known: ggx, beckmann, gtr");
    EXPECT(mu_place_choice(&flag, choices, &index, &error),
           "f:1:39: $.flag: is 1; one of \"ggx\" \"beckmann\" \"gtr\" is needed");
    EXPECT(mu_place_flag(&flag, &truth, &error), "f:1:39: $.flag: is 1; true or false is needed");
    static const char *const known[] = {"ndf", NULL};
    EXPECT(mu_place_only(&o, known, &error),
           "f:1:48: $.o.ndff: this key is not known; did you mean \"ndf\"? Known: ndf");
    mu_document_free(&d);
}

static void test_nearest(void **state) {
    (void)state;
    static const char *const words[] = {"alpha", "roughness", "gamma", "ndf", "n", "k", NULL};
    assert_string_equal(mu_nearest("alfa", words), "alpha");
    assert_string_equal(mu_nearest("aplha", words), "alpha");
    assert_string_equal(mu_nearest("ALPHA", words), "alpha");
    assert_string_equal(mu_nearest("rough", words), "roughness");
    assert_string_equal(mu_nearest("gama", words), "gamma");
    assert_string_equal(mu_nearest("nfd", words), "ndf");
    assert_string_equal(mu_nearest("N", words), "n");
    assert_null(mu_nearest("q", words));
    assert_null(mu_nearest("position", words));
    assert_null(mu_nearest("", words));
}

/* A message is one line of printable text whatever is quoted in it. */
static void test_messages(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    assert_false(mu_fail(&error, "a\nb\x1b[31m\x7f \xc2\x9b \xff \xc3\xa9 %d", 7));
    assert_string_equal(error.text, "a?b?[31m? ? ? \xc3\xa9 7");
    assert_false(mu_fail(&error, "second"));
    assert_string_equal(error.text, "a?b?[31m? ? ? \xc3\xa9 7");

    char text[4001];
    for (size_t shift = 0; shift < 2; shift++) {
        memset(text, 'x', sizeof text);
        for (size_t i = shift; i + 1 < 4000; i += 2) memcpy(text + i, "\xc3\xa9", 2);
        text[4000] = '\0';
        mu_error cut = {.text = ""};
        mu_fail(&cut, "%s", text);
        const size_t length = strlen(cut.text);
        assert_in_range(length, 1000, sizeof cut.text - 1);
        assert_string_equal(cut.text + length - 3, "...");
        assert_int_equal(mu_utf8_valid(cut.text, length), length);
        assert_null(strchr(cut.text, '?'));
    }
}

/* RFC 3629, by brute force over all code points, and the ill-formed neighbours of its table. */
static void test_utf8(void **state) {
    (void)state;
    for (uint32_t code = 1; code < 0x110000; code++) {
        char s[4];
        size_t n;
        if (code < 0x80)
            s[0] = (char)code, n = 1;
        else if (code < 0x800)
            s[0] = (char)(0xc0 | code >> 6), s[1] = (char)(0x80 | (code & 63)), n = 2;
        else if (code < 0x10000)
            s[0] = (char)(0xe0 | code >> 12), s[1] = (char)(0x80 | (code >> 6 & 63)),
            s[2] = (char)(0x80 | (code & 63)), n = 3;
        else
            s[0] = (char)(0xf0 | code >> 18), s[1] = (char)(0x80 | (code >> 12 & 63)),
            s[2] = (char)(0x80 | (code >> 6 & 63)), s[3] = (char)(0x80 | (code & 63)), n = 4;
        const size_t expected = code >= 0xd800 && code < 0xe000 ? 0 : n;
        assert_int_equal(mu_utf8_character(s, n), expected);
        assert_int_equal(mu_utf8_character(s, n - 1), 0);
    }
    static const char *const bad[] = {"\x80",
                                      "\xc0\x80",
                                      "\xc1\xbf",
                                      "\xe0\x9f\xbf",
                                      "\xf0\x8f\xbf\xbf",
                                      "\xf4\x90\x80\x80",
                                      "\xf5\x80\x80\x80",
                                      "\xc3(",
                                      "\xe2\x82("};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_int_equal(mu_utf8_character(bad[i], strlen(bad[i])), 0);
}

/* Known answers published with Random123 (kat_vectors, philox4x32 10). */
static void test_philox(void **state) {
    (void)state;
    static const struct {
        uint32_t counter[4], key[2], out[4];
    } known[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
         {0xffffffff, 0xffffffff},
         {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
         {0xa4093822, 0x299f31d0},
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };
    for (size_t i = 0; i < 3; i++) {
        uint32_t out[4];
        mu_philox(known[i].counter, known[i].key, out);
        assert_memory_equal(out, known[i].out, sizeof out);
    }
    /* u[0] of (seed 0, index 0) is made of the first two words of the first known answer. */
    double u[3];
    mu_philox_uniforms(0, 0, u);
    assert_true(u[0] == (double)(UINT64_C(0x6627e8d5e169c58d) >> 11) * 0x1p-53);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),  cmocka_unit_test(test_words), cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_messages), cmocka_unit_test(test_utf8),  cmocka_unit_test(test_philox),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
