/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * expression.h: formulas of texture coordinates, such as "v + 2*u^5", with their exact derivatives.
 *
 * A text is parsed once, into a short program of a stack machine; that is run on dual numbers (value, d/du, d/dv),
 * Clifford's numbers with epsilon^2 = 0 in two directions, so that derivatives carry rounding alone and no step has to
 * be chosen. Running allocates nothing.
 */
#ifndef MU_EXPRESSION_H
#define MU_EXPRESSION_H

#include <stddef.h>

typedef struct mu_dual {
    double value, du, dv;
} mu_dual;

enum { MU_EXPRESSION_STEPS = 96, MU_EXPRESSION_DEPTH = 24 };

typedef struct mu_step {
    int code; /* of expression_codes.h */
    double number;
} mu_step;

typedef struct mu_expression {
    int count;
    mu_step steps[MU_EXPRESSION_STEPS];
} mu_expression;

/*
 * Numbers, u, v, pi; + - * / ^ (to the right first, before a sign: -u^2 is -(u^2)) and parentheses; sin cos tan asin
 * acos atan sinh cosh tanh exp log sqrt abs floor fract of one, atan2(y, x) hypot min max of two. False, and one line
 * in `why`, with the column, if the text is not that.
 */
_Bool mu_expression_parse(mu_expression *expression, const char *text, char *why, size_t size);

/* [any] Not finite where the formula is not: log(0), or the derivative of sqrt there. */
mu_dual mu_expression_at(const mu_expression *expression, double u, double v);

#endif
