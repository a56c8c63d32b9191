/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* real.h: the arithmetic of this room. Each source is compiled once per precision, with MU_REAL_BITS 24
 * or 53. */
#ifndef MU_REAL_H
#define MU_REAL_H

#include <float.h>
#include <stddef.h>
#include <tgmath.h>

#include "core/bsdf/musurf.h"

#if MU_REAL_BITS == 24
typedef float real;
#define MU(id)   id##_f
#define REAL_MAX FLT_MAX
#define REAL_MIN FLT_MIN
#define REAL_EPSILON FLT_EPSILON
#elif MU_REAL_BITS == 53
typedef double real;
#define MU(id)   id##_d
#define REAL_MAX DBL_MAX
#define REAL_MIN DBL_MIN
#define REAL_EPSILON DBL_EPSILON
#else
#error "compile with -DMU_REAL_BITS=24 (float) or 53 (double)"
#endif

/* A constant in the precision at hand. */
#define R(x)   ((real)(x))
#define PI     3.14159265358979323846
#define INV_PI 0.31830988618379067154

typedef MU(mu_map) map;
typedef MU(mu_surface) surface;
typedef MU(mu_closure) closure;
typedef MU(mu_value) value;
typedef MU(mu_sample) sample;
typedef MU(mu_kernel) kernel;

/* For what the plain plans run: a call less per evaluation. */
#define HOT static inline __attribute__((always_inline))

/* fmin and fmax honour NaN at the cost of a call; these compile to one instruction. */
static inline real smaller(real a, real b) {
    return a < b ? a : b;
}
static inline real larger(real a, real b) {
    return a > b ? a : b;
}
static inline real square(real x) {
    return x * x;
}
static inline real dot(const real a[3], const real b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

#endif
