/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_tension.c: what halving the triangles of a shaken, bent sheet costs and brings, on one core. Goals: a million
 * triangles and the vertices between them in under 2 s of processor time, and, from 32 x 32 to 512 x 512 cells, errors
 * of second order: 256 times smaller, half of which is left to the worst of ever more vertices. Exits with 1 where
 * either is missed.
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

static double worst_error(const sheet *s, const mu_tension *tension) {
    double worst = 0, exact[4];
    for (uint32_t i = 0; i < tension->points; i++) {
        const double *p = s->rest + 3 * (size_t)tension->point[i].vertex;
        sheet_bend_map(p[0], p[1], exact);
        for (int c = 0; c < 4; c++) worst = fmax(worst, fabs(tension->point[i].m[c] - exact[c]));
    }
    return worst;
}

/* Returns the worst error of vertices. */
static double measure(uint32_t n, double *used) {
    uniform random = {1};
    sheet s = sheet_make(n, n);
    sheet_shake(&s, &random, 0.2);
    for (size_t i = 0; i < s.vertices; i++) sheet_bend(s.rest[3 * i], s.rest[3 * i + 1], s.deformed + 3 * i);
    const double start = seconds();
    mu_tension *tension = sheet_tension(&s);
    *used = seconds() - start;
    const double worst = worst_error(&s, tension);
    printf("tension: %7u triangles, %6u points in %.4f s of one core; vertices off by %.2e\n", s.triangles,
           tension->points, *used, worst);
    mu_tension_free(tension);
    sheet_free(&s);
    return worst;
}

int main(void) {
    double used, coarse = 0, fine = 0;
    for (uint32_t n = 32; n <= 512; n *= 2) {
        fine = measure(n, &used);
        if (n == 32) coarse = fine;
    }
    measure(708, &used);
    printf("tension: a million triangles in %.2f s; goal 2 s; errors %.0f times smaller at 1/16 the size; "
           "goal 128\n",
           used, coarse / fine);
    return used < 2 && coarse / fine > 128 ? 0 : 1;
}
