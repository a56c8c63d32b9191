/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * expression_parse.c: the text of a formula, by recursive descent, into steps in the order in which they are run.
 *
 *     sum     = product { ("+" | "-") product }
 *     product = signed { ("*" | "/") signed }
 *     signed  = ("+" | "-") signed | power
 *     power   = atom [ "^" signed ]
 *     atom    = number | "u" | "v" | "pi" | function "(" sum { "," sum } ")" | "(" sum ")"
 */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/expression.h"
#include "core/render/expression_codes.h"

enum { NESTING = 64 };

typedef struct mu_parser {
    const char *text, *at;
    mu_expression *out;
    int depth, nesting; /* numbers on the stack when the steps so far have run; parentheses around here */
    char *why;
    size_t size;
} mu_parser;

static _Bool sum(mu_parser *p);

static _Bool fail(mu_parser *p, const char *what) {
    if (*p->at)
        snprintf(p->why, p->size, "%s at \"%.20s\" (character %zu)", what, p->at,
                 (size_t)(p->at - p->text) + 1);
    else
        snprintf(p->why, p->size, "%s at its end", what);
    return 0;
}

static void skip(mu_parser *p) {
    while (isspace((unsigned char)*p->at)) p->at++;
}

static _Bool accept(mu_parser *p, char c) {
    skip(p);
    if (*p->at != c) return 0;
    p->at++;
    return 1;
}

/* `change`: by how much the step makes the stack higher. */
static _Bool emit(mu_parser *p, int code, double number, int change) {
    if (p->out->count == MU_EXPRESSION_STEPS || p->depth + change > MU_EXPRESSION_DEPTH)
        return fail(p, "is too long a formula");
    p->out->steps[p->out->count++] = (mu_step){code, number};
    p->depth += change;
    return 1;
}

static _Bool number(mu_parser *p) {
    char *end;
    const double value = strtod(p->at, &end);
    if (p->at[0] == '0' && (p->at[1] == 'x' || p->at[1] == 'X')) return fail(p, "needs a decimal number");
    if (!isfinite(value)) return fail(p, "has no finite number");
    p->at = end;
    return emit(p, MU_STEP_NUMBER, value, 1);
}

/* The code of a function; *count: its arguments. -1: there is none of that name. */
static int function(const char *name, size_t length, int *count) {
    static const struct {
        const char *name;
        int code, count;
    } known[] = {
#define X(name) {#name, MU_STEP_##name, 1},
        MU_EXPRESSION_OF_ONE(X)
#undef X
#define X(name) {#name, MU_STEP_##name, 2},
            MU_EXPRESSION_OF_TWO(X)
#undef X
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strlen(known[i].name) == length && !strncmp(known[i].name, name, length)) {
            *count = known[i].count;
            return known[i].code;
        }
    return -1;
}

static _Bool call(mu_parser *p, int code, int count) {
    if (!accept(p, '(')) return fail(p, "needs a \"(\" after a function");
    for (int i = 0; i < count; i++) {
        if (i && !accept(p, ',')) return fail(p, "needs a \",\" and a second value");
        if (!sum(p)) return 0;
    }
    if (!accept(p, ')')) return fail(p, "needs a \")\"");
    return emit(p, code, 0, 1 - count);
}

static _Bool name(mu_parser *p) {
    const char *from = p->at;
    size_t length = 0;
    int count;
    while (isalnum((unsigned char)from[length]) || from[length] == '_') length++;
    if (length == 1 && (*from == 'u' || *from == 'v')) {
        p->at++;
        return emit(p, *from == 'u' ? MU_STEP_U : MU_STEP_V, 0, 1);
    }
    if (length == 2 && !strncmp(from, "pi", 2)) {
        p->at += 2;
        return emit(p, MU_STEP_NUMBER, 3.14159265358979323846, 1);
    }
    const int code = function(from, length, &count);
    if (code < 0)
        return fail(p,
                    "knows u, v, pi, sin cos tan asin acos atan sinh cosh tanh exp log sqrt abs floor fract "
                    "atan2 hypot min max; not what stands");
    p->at += length;
    return call(p, code, count);
}

static _Bool atom(mu_parser *p) {
    skip(p);
    if (isdigit((unsigned char)*p->at) || *p->at == '.') return number(p);
    if (isalpha((unsigned char)*p->at)) return name(p);
    if (!accept(p, '(')) return fail(p, "needs a number, u, v, a function or a \"(\"");
    return sum(p) && (accept(p, ')') || fail(p, "needs a \")\""));
}

static _Bool sign(mu_parser *p) {
    if (++p->nesting > NESTING) return fail(p, "is nested too deeply");
    _Bool good;
    if (accept(p, '-'))
        good = sign(p) && emit(p, MU_STEP_NEGATE, 0, 0);
    else if (accept(p, '+'))
        good = sign(p);
    else
        good = atom(p) && (!accept(p, '^') || (sign(p) && emit(p, MU_STEP_POWER, 0, -1)));
    p->nesting--;
    return good;
}

static _Bool product(mu_parser *p) {
    if (!sign(p)) return 0;
    for (;;) {
        const int code = accept(p, '*') ? MU_STEP_MULTIPLY : accept(p, '/') ? MU_STEP_DIVIDE : -1;
        if (code < 0) return 1;
        if (!sign(p) || !emit(p, code, 0, -1)) return 0;
    }
}

static _Bool sum(mu_parser *p) {
    if (!product(p)) return 0;
    for (;;) {
        const int code = accept(p, '+') ? MU_STEP_ADD : accept(p, '-') ? MU_STEP_SUBTRACT : -1;
        if (code < 0) return 1;
        if (!product(p) || !emit(p, code, 0, -1)) return 0;
    }
}

_Bool mu_expression_parse(mu_expression *expression, const char *text, char *why, size_t size) {
    mu_parser p = {.text = text, .at = text, .out = expression, .why = why, .size = size};
    expression->count = 0;
    if (!sum(&p)) return 0;
    skip(&p);
    return !*p.at || fail(&p, "ends before what stands");
}
