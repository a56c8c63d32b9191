/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* boxes.c: the square waves and boxes of soup.h, and what is done to all of them. */
#include <string.h>

#include "core/surface/soup.h"

/* Two triangles of a parallelogram with a corner p and edges a, b; the normal is along a x b. */
static void put(mu_triangle *out, const double p[3], const double a[3], const double b[3]) {
    for (int k = 0; k < 3; k++) {
        out[0].p[0][k] = p[k];
        out[0].p[1][k] = p[k] + a[k];
        out[0].p[2][k] = p[k] + b[k];
        out[1].p[0][k] = p[k] + a[k] + b[k];
        out[1].p[1][k] = p[k] + b[k];
        out[1].p[2][k] = p[k] + a[k];
    }
}

void mu_soup_wave(mu_soup *soup, mu_triangle out[MU_WAVE_TRIANGLES], double period, double depth,
                  double width, double height, double slant) {
    *soup = (mu_soup){out, MU_WAVE_TRIANGLES, {{period, 0}, {0, depth}}};
    const double y[3] = {0, depth, 0}, rise[3] = {slant, 0, height}, fall[3] = {-slant, 0, -height};
    put(out, (const double[3]){width, 0, 0}, (const double[3]){period - width, 0, 0}, y);
    put(out + 2, (const double[3]){0, 0, 0}, rise, y);
    put(out + 4, rise, (const double[3]){width, 0, 0}, y);
    put(out + 6, (const double[3]){width + slant, 0, height}, fall, y);
}

void mu_soup_box(mu_soup *soup, mu_triangle out[MU_BOX_TRIANGLES], double period, double width, double height,
                 const double slant[2]) {
    *soup = (mu_soup){out, MU_BOX_TRIANGLES, {{period, 0}, {0, period}}};
    const double gap = period - width, zero[3] = {0, 0, 0};
    const double x[3] = {width, 0, 0}, y[3] = {0, width, 0}, up[3] = {slant[0], slant[1], height};
    put(out, up, x, y);
    put(out + 2, zero, x, up);                         /* toward -y */
    put(out + 4, y, up, x);                            /* toward +y */
    put(out + 6, zero, up, y);                         /* toward -x */
    put(out + 8, x, y, up);                            /* toward +x */
    put(out + 10, x, (const double[3]){gap, 0, 0}, y); /* the ground beside it, */
    put(out + 12, y, x, (const double[3]){0, gap, 0}); /* behind it, and at the corner */
    put(out + 14, (const double[3]){width, width, 0}, (const double[3]){gap, 0, 0},
        (const double[3]){0, gap, 0});
}

void mu_soup_turn_over(mu_soup *soup) {
    for (size_t k = 0; k < soup->count; k++)
        for (int corner = 0; corner < 3; corner++) soup->triangles[k].p[corner][2] *= -1;
}

static void move(double p[2], const double m[4]) {
    const double x = m[0] * p[0] + m[1] * p[1], y = m[2] * p[0] + m[3] * p[1];
    p[0] = x, p[1] = y;
}

void mu_soup_transform(mu_soup *soup, const double m[4]) {
    const _Bool mirror = m[0] * m[3] - m[1] * m[2] < 0;
    for (size_t k = 0; k < soup->count; k++) {
        mu_triangle *t = &soup->triangles[k];
        for (int corner = 0; corner < 3; corner++) move(t->p[corner], m);
        if (mirror) {
            double swap[3];
            memcpy(swap, t->p[1], sizeof swap);
            memcpy(t->p[1], t->p[2], sizeof swap);
            memcpy(t->p[2], swap, sizeof swap);
        }
    }
    move(soup->period[0], m);
    move(soup->period[1], m);
}

void mu_soup_normal(const mu_soup *soup, size_t index, double normal[3]) {
    const mu_triangle *t = &soup->triangles[index];
    double a[3], b[3];
    for (int k = 0; k < 3; k++) a[k] = t->p[1][k] - t->p[0][k], b[k] = t->p[2][k] - t->p[0][k];
    normal[0] = (a[1] * b[2] - a[2] * b[1]) / 2;
    normal[1] = (a[2] * b[0] - a[0] * b[2]) / 2;
    normal[2] = (a[0] * b[1] - a[1] * b[0]) / 2;
}
