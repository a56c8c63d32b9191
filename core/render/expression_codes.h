/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* expression_codes.h: the steps of a formula's program, shared by its parser and what runs it. */
#ifndef MU_EXPRESSION_CODES_H
#define MU_EXPRESSION_CODES_H

/* Steps that push; operators; functions of one and of two, which are called by these names. */
#define MU_EXPRESSION_OF_ONE(X)                                                                              \
    X(sin)                                                                                                   \
    X(cos) X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh) X(exp) X(log) X(sqrt) X(abs) X(floor)      \
        X(fract)
#define MU_EXPRESSION_OF_TWO(X) X(atan2) X(hypot) X(min) X(max)

#define X(name) MU_STEP_##name,
enum {
    MU_STEP_NUMBER,
    MU_STEP_U,
    MU_STEP_V,
    MU_STEP_NEGATE,
    MU_STEP_ADD,
    MU_STEP_SUBTRACT,
    MU_STEP_MULTIPLY,
    MU_STEP_DIVIDE,
    MU_STEP_POWER,
    MU_EXPRESSION_OF_ONE(X) MU_EXPRESSION_OF_TWO(X)
};
#undef X

#endif
