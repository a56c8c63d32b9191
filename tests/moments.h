/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* moments.h: a mean of independent values, and its Z-test against the truth. Include after cmocka.h. */
#ifndef MU_TEST_MOMENTS_H
#define MU_TEST_MOMENTS_H

#include <math.h>

#include "tests/significance.h"

typedef struct moments {
    double n, sum, squares;
} moments;

static inline void accumulate(moments *m, double x) {
    m->n++;
    m->sum += x;
    m->squares += x * x;
}

/* p-value of mean = truth; `slack` is the bias that float rounding is allowed. */
static inline void agrees(const moments *m, double truth, double slack, const char *what) {
    const double mean = m->sum / m->n, variance = fmax(m->squares / m->n - mean * mean, 0) / (m->n - 1);
    const double off = fmax(fabs(mean - truth) - slack, 0), z = variance > 0 ? off / sqrt(variance)
                                                                : off > 0    ? 1e9
                                                                             : 0;
    print_message("%s: %.7g, exact %.7g, z = %.2f\n", what, mean, truth, z);
    assert_true(p_of_z(z) > significance_level());
}

#endif
