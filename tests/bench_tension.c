/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_tension.c: M of a million triangles and of the vertices between them, on one core. Goal: under 2 s of processor
 * time. Exits with 1 where it is missed.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <time.h>

#include <cmocka.h>

#include "tests/sheet.h"

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(void) {
    uniform random = {1};
    sheet s = sheet_make(708, 708);
    sheet_shake(&s, &random, 0.2);
    for (size_t i = 0; i < s.vertices; i++)
        s.deformed[3 * i + 2] = sin(5 * s.rest[3 * i]) * s.rest[3 * i + 1];
    const double start = seconds();
    mu_tension *tension = sheet_tension(&s);
    const double used = seconds() - start;
    printf("tension: %u triangles, %u points in %.2f s of one core; goal 2 s\n", s.triangles, tension->points,
           used);
    mu_tension_free(tension);
    sheet_free(&s);
    return used < 2 ? 0 : 1;
}
