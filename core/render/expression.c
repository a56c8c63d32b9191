/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* expression.c: a formula's program, run on dual numbers. */
#include "core/render/expression.h"

#include <math.h>

#include "core/render/expression_codes.h"

/* f(a), where f' is `slope` at a. */
static mu_dual chain(double value, double slope, mu_dual a) {
    return (mu_dual){value, slope * a.du, slope * a.dv};
}

/* f(a, b) of the partial derivatives `fa` and `fb`. */
static mu_dual chain2(double value, double fa, mu_dual a, double fb, mu_dual b) {
    return (mu_dual){value, fa * a.du + fb * b.du, fa * a.dv + fb * b.dv};
}

/* A constant exponent needs no logarithm of the base, which may be negative or 0. */
static mu_dual power(mu_dual a, mu_dual b) {
    const double value = pow(a.value, b.value);
    if (b.du == 0 && b.dv == 0)
        return chain(value, b.value == 0 ? 0 : b.value * pow(a.value, b.value - 1), a);
    return chain2(value, b.value * pow(a.value, b.value - 1), a, value * log(a.value), b);
}

static mu_dual of_one(int code, mu_dual a) {
    const double x = a.value;
    double y;
    switch (code) {
    case MU_STEP_NEGATE:
        return chain(-x, -1, a);
    case MU_STEP_sin:
        return chain(sin(x), cos(x), a);
    case MU_STEP_cos:
        return chain(cos(x), -sin(x), a);
    case MU_STEP_tan:
        y = tan(x);
        return chain(y, 1 + y * y, a);
    case MU_STEP_asin:
        return chain(asin(x), 1 / sqrt((1 - x) * (1 + x)), a);
    case MU_STEP_acos:
        return chain(acos(x), -1 / sqrt((1 - x) * (1 + x)), a);
    case MU_STEP_atan:
        return chain(atan(x), 1 / (1 + x * x), a);
    case MU_STEP_sinh:
        return chain(sinh(x), cosh(x), a);
    case MU_STEP_cosh:
        return chain(cosh(x), sinh(x), a);
    case MU_STEP_tanh:
        y = cosh(x);
        return chain(tanh(x), 1 / (y * y), a);
    case MU_STEP_exp:
        y = exp(x);
        return chain(y, y, a);
    case MU_STEP_log:
        return chain(log(x), 1 / x, a);
    case MU_STEP_sqrt:
        y = sqrt(x);
        return chain(y, 1 / (2 * y), a);
    case MU_STEP_abs:
        return chain(fabs(x), x > 0 ? 1 : x < 0 ? -1 : 0, a);
    case MU_STEP_floor:
        return chain(floor(x), 0, a);
    default: /* MU_STEP_fract */
        return chain(x - floor(x), 1, a);
    }
}

static mu_dual of_two(int code, mu_dual a, mu_dual b) {
    const double x = a.value, y = b.value;
    double square;
    switch (code) {
    case MU_STEP_ADD:
        return chain2(x + y, 1, a, 1, b);
    case MU_STEP_SUBTRACT:
        return chain2(x - y, 1, a, -1, b);
    case MU_STEP_MULTIPLY:
        return chain2(x * y, y, a, x, b);
    case MU_STEP_DIVIDE:
        return chain2(x / y, 1 / y, a, -x / (y * y), b);
    case MU_STEP_POWER:
        return power(a, b);
    case MU_STEP_atan2:
        square = x * x + y * y;
        return chain2(atan2(x, y), y / square, a, -x / square, b);
    case MU_STEP_hypot:
        return chain2(hypot(x, y), x / hypot(x, y), a, y / hypot(x, y), b);
    case MU_STEP_min:
        return x < y ? a : b;
    default: /* MU_STEP_max */
        return x > y ? a : b;
    }
}

static int is_of_two(int code) {
    return (code >= MU_STEP_ADD && code <= MU_STEP_POWER) || code >= MU_STEP_atan2;
}

mu_dual mu_expression_at(const mu_expression *expression, double u, double v) {
    mu_dual stack[MU_EXPRESSION_DEPTH];
    int top = -1;
    for (int i = 0; i < expression->count; i++) {
        const mu_step *step = &expression->steps[i];
        if (step->code == MU_STEP_NUMBER)
            stack[++top] = (mu_dual){step->number, 0, 0};
        else if (step->code == MU_STEP_U)
            stack[++top] = (mu_dual){u, 1, 0};
        else if (step->code == MU_STEP_V)
            stack[++top] = (mu_dual){v, 0, 1};
        else if (is_of_two(step->code)) {
            top--;
            stack[top] = of_two(step->code, stack[top], stack[top + 1]);
        } else
            stack[top] = of_one(step->code, stack[top]);
    }
    return stack[0];
}
