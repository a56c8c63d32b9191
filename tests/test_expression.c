/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_expression.c: formulas against the C library, their derivatives against closed forms written here, and what is no
 * formula.
 */
#include "core/render/expression.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static mu_dual at(const char *text, double u, double v) {
    mu_expression e;
    char why[256] = "";
    if (!mu_expression_parse(&e, text, why, sizeof why)) fail_msg("%s: %s", text, why);
    return mu_expression_at(&e, u, v);
}

/* A few roundings each, of terms that do not cancel. */
static void assert_close(double a, double b) {
    if (!(fabs(a - b) <= 16 * DBL_EPSILON * fmax(fabs(b), 1))) fail_msg("%.17g is not %.17g", a, b);
}

static void test_values_and_derivatives(void **state) {
    (void)state;
    const double u = 0.7, v = 0.3, p = 3.14159265358979323846;
    const struct {
        const char *text;
        double value, du, dv;
    } known[] = {
        {"u", u, 1, 0},
        {"v + 2*u^5", v + 2 * pow(u, 5), 10 * pow(u, 4), 1},
        {"-u^2", -u * u, -2 * u, 0},
        {"2^-1 * u", u / 2, 0.5, 0},
        {"2^3^2", 512, 0, 0},
        {"u - v - 1", u - v - 1, 1, -1},
        {"u / v / 2", u / v / 2, 1 / (2 * v), -u / (2 * v * v)},
        {"(u + v) * (u - v)", u * u - v * v, 2 * u, -2 * v},
        {"u^v", pow(u, v), v * pow(u, v - 1), pow(u, v) * log(u)},
        {"sin(2*pi*u)", sin(2 * p * u), 2 * p * cos(2 * p * u), 0},
        {"cos(u*v)", cos(u * v), -v * sin(u * v), -u * sin(u * v)},
        {"tan(v)", tan(v), 0, 1 / (cos(v) * cos(v))},
        {"asin(u)", asin(u), 1 / sqrt(1 - u * u), 0},
        {"acos(u)", acos(u), -1 / sqrt(1 - u * u), 0},
        {"atan(u)", atan(u), 1 / (1 + u * u), 0},
        {"sinh(u) + cosh(v)", sinh(u) + cosh(v), cosh(u), sinh(v)},
        {"tanh(u)", tanh(u), 1 / (cosh(u) * cosh(u)), 0},
        {"exp(-u*u)", exp(-u * u), -2 * u * exp(-u * u), 0},
        {"log(u)", log(u), 1 / u, 0},
        {"sqrt(v)", sqrt(v), 0, 1 / (2 * sqrt(v))},
        {"abs(v - u)", u - v, 1, -1},
        {"floor(5*u)", 3, 0, 0},
        {"fract(5*u)", 5 * u - 3, 5, 0},
        {"atan2(v - 1, u)", atan2(v - 1, u), (1 - v) / (u * u + (v - 1) * (v - 1)),
         u / (u * u + (v - 1) * (v - 1))},
        {"hypot(u, v)", hypot(u, v), u / hypot(u, v), v / hypot(u, v)},
        {"min(u, v*v)", v * v, 0, 2 * v},
        {"max(u, v)", u, 1, 0},
        {" 1.5e1*+u ", 15 * u, 15, 0},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const mu_dual got = at(known[i].text, u, v);
        assert_close(got.value, known[i].value);
        assert_close(got.du, known[i].du);
        assert_close(got.dv, known[i].dv);
    }
}

static void test_constant_exponents_at_zero_and_below(void **state) {
    (void)state;
    assert_true(at("u^5", 0, 0).du == 0);
    assert_true(at("u^1", 0, 0).du == 1);
    assert_true(at("u^0", 0, 0).du == 0);
    assert_close(at("u^3", -2, 0).du, 12);
    assert_true(!isfinite(at("sqrt(u)", 0, 0).du));
}

static void test_what_is_no_formula(void **state) {
    (void)state;
    const struct {
        const char *text, *says;
    } wrong[] = {{"", "at its end"},           {"v + 2*", "at its end"},  {"v + 2*u^", "at its end"},
                 {"2 u", "character 3"},       {"w", "character 1"},      {"sin u", "\"(\" after a function"},
                 {"atan2(u)", "second"},       {"(u", "\")\""},           {"u)", "character 2"},
                 {"1e999", "finite"},          {"0x10*u", "decimal"},        {"u ** 2", "character 4"}, {"sinus(u)", "knows u, v, pi"},
                 {"u + x1*2", "(character 5)"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        mu_expression e;
        char why[256] = "";
        assert_false(mu_expression_parse(&e, wrong[i].text, why, sizeof why));
        if (!strstr(why, wrong[i].says)) fail_msg("\"%s\": %s", wrong[i].text, why);
    }
}

/* Neither steps nor stack nor recursion run over: each is refused at its limit. */
static void test_limits(void **state) {
    (void)state;
    char text[4096] = "", why[256];
    mu_expression e;
    for (int i = 0; i < 47; i++) strcat(text, "u+");
    strcat(text, "u");
    assert_true(mu_expression_parse(&e, text, why, sizeof why));
    strcat(text, "+u+u");
    assert_false(mu_expression_parse(&e, text, why, sizeof why));
    text[0] = '\0';
    for (int i = 0; i < MU_EXPRESSION_DEPTH + 1; i++) strcat(text, "u*(1-");
    assert_false(mu_expression_parse(&e, text, why, sizeof why));
    memset(text, '(', 4000), text[4000] = '\0';
    assert_false(mu_expression_parse(&e, text, why, sizeof why));
    memset(text, '-', 4000), text[4000] = '\0';
    assert_false(mu_expression_parse(&e, text, why, sizeof why));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_and_derivatives),
        cmocka_unit_test(test_constant_exponents_at_zero_and_below),
        cmocka_unit_test(test_what_is_no_formula),
        cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
