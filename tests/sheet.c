/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* sheet.c: see sheet.h. */
#include "tests/sheet.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/shapes.h"

static void set_uvs(sheet *s) {
    for (size_t i = 0; i < 3 * (size_t)s->triangles; i++)
        memcpy(s->uv + 2 * i, s->rest + 3 * (size_t)s->corner[i], 2 * sizeof *s->uv);
}

sheet sheet_make(uint32_t across, uint32_t up) {
    sheet s = {.vertices = (across + 1) * (up + 1), .triangles = 2 * across * up};
    const size_t vertices = s.vertices, triangles = s.triangles;
    s.rest = calloc(3 * vertices, sizeof *s.rest);
    s.deformed = calloc(3 * vertices, sizeof *s.deformed);
    s.uv = calloc(6 * triangles, sizeof *s.uv);
    s.corner = calloc(3 * triangles, sizeof *s.corner);
    assert_true(s.rest && s.deformed && s.uv && s.corner);
    for (uint32_t j = 0; j <= up; j++)
        for (uint32_t i = 0; i <= across; i++) {
            double *p = s.rest + 3 * ((size_t)j * (across + 1) + i);
            p[0] = (double)i / across, p[1] = (double)j / up;
        }
    uint32_t *c = s.corner;
    for (uint32_t j = 0; j < up; j++)
        for (uint32_t i = 0; i < across; i++, c += 6) {
            const uint32_t a = j * (across + 1) + i, b = a + across + 1;
            const uint32_t cell[6] = {a, a + 1, b, b + 1, b, a + 1};
            memcpy(c, cell, sizeof cell);
        }
    memcpy(s.deformed, s.rest, 3 * vertices * sizeof *s.rest);
    set_uvs(&s);
    return s;
}

void sheet_shake(sheet *s, uniform *random, double by) {
    double cell = 1;
    for (size_t k = 0; k < 2; k++) cell = fmin(cell, fabs(s->rest[3 * (size_t)s->corner[2 - k] + 1 - k]));
    for (size_t i = 0; i < 3 * (size_t)s->vertices; i++)
        if (i % 3 < 2) s->rest[i] += cell * test_between(random, -by, by);
    for (uint32_t *c = s->corner; c < s->corner + 3 * (size_t)s->triangles; c += 6)
        if (test_between(random, 0, 1) < 0.5) {
            const uint32_t turned[6] = {c[0], c[1], c[3], c[0], c[3], c[2]};
            memcpy(c, turned, sizeof turned);
        }
    memcpy(s->deformed, s->rest, 3 * (size_t)s->vertices * sizeof *s->rest);
    set_uvs(s);
}

void sheet_bend(double x, double y, double p[3]) {
    p[0] = x + 0.3 * x * x, p[1] = y + 0.2 * sin(2 * x), p[2] = 0.25 * sin(3 * x) * cos(2 * y);
}

/* The Cholesky factor of J^T J. */
void sheet_bend_map(double x, double y, double m[4]) {
    const double px[3] = {1 + 0.6 * x, 0.4 * cos(2 * x), 0.75 * cos(3 * x) * cos(2 * y)},
                 py[3] = {0, 1, -0.5 * sin(3 * x) * sin(2 * y)};
    double xx = 0, xy = 0, yy = 0;
    for (int k = 0; k < 3; k++) xx += px[k] * px[k], xy += px[k] * py[k], yy += py[k] * py[k];
    m[0] = sqrt(xx), m[1] = xy / m[0], m[2] = 0, m[3] = sqrt(yy - m[1] * m[1]);
}

mu_tension *sheet_tension(const sheet *s) {
    const mu_tension_input input = {s->vertices, s->triangles, s->corner, s->rest, s->deformed, s->uv, s->uv};
    mu_tension *tension = mu_tension_make(&input);
    assert_non_null(tension);
    return tension;
}

void sheet_free(sheet *s) {
    free(s->rest);
    free(s->deformed);
    free(s->uv);
    free(s->corner);
}
