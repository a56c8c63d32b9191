/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_surface_soup.c: boxes, square waves and loose facets against pencil and paper.
 *
 * Shares are exact but for rounding: each cut moves a corner by some 1e-16 of its distance, and slivers that are dropped
 * are below 1e-14 each, at most 512 of them; 1e-9 is far above both.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/surface/noise.h"
#include "core/surface/soup.h"

#define CLOSE(a, b) assert_true(fabs((a) - (b)) < 1e-9)

static double share(const mu_soup *soup, size_t first, size_t count, const double (*w)[3],
                    size_t directions) {
    double seen = 0, all = 0;
    for (size_t k = first; k < first + count; k++) {
        double n[3];
        mu_soup_normal(soup, k, n);
        const double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]),
                     part = mu_soup_visible(soup, k, w, directions);
        assert_true(part >= 0 && part < 1 + 1e-12);
        seen += area * part;
        all += area;
    }
    return seen / all;
}

/* Ground and top as wide as each other: of the facets with m = n, G1 tends to 1/2 as the view sinks, so that G1 G1 =
 * 1/4, but both directions see the same half, the tops: G2 = 1/2 (the example under Eq. 12c). */
static void square_wave(void **state) {
    (void)state;
    mu_triangle room[MU_WAVE_TRIANGLES];
    mu_soup soup;
    mu_soup_wave(&soup, room, 2, 1.5, 1, 0.5, 0);
    for (int turned = 0; turned < 2; turned++) { /* upside down it is the same wave, half a period on */
        for (double tangent = 0.5; tangent < 20; tangent *= 1.7) {
            const double w[2][3] = {{tangent, 0, 1}, {-tangent, 0, 1}};
            const double shadow = fmin(1, 0.5 * tangent);
            const size_t low = turned ? 4 : 0, high = turned ? 0 : 4;
            const double ground = share(&soup, low, 2, w, 1), top = share(&soup, high, 2, w, 1);
            const double both = share(&soup, low, 2, w, 2);
            CLOSE(ground, 1 - shadow);
            CLOSE(top, 1);
            CLOSE(both, fmax(0, 1 - 2 * shadow)); /* either side has its shadow */
            if (tangent < 2) continue;
            const double g1 = (ground + top) / 2, g2 = (both + share(&soup, high, 2, w, 2)) / 2;
            CLOSE(g1, 0.5);
            CLOSE(g1 * g1, 0.25);
            CLOSE(g2, 0.5);
        }
        mu_soup_turn_over(&soup);
    }
}

/* Along the ridges nothing is hidden but the sides that turn away; across at 45 degrees of azimuth, the shadow is as
 * long as the ridge is high times the tangent times cos 45. */
static void azimuth(void **state) {
    (void)state;
    mu_triangle room[MU_WAVE_TRIANGLES];
    mu_soup soup;
    mu_soup_wave(&soup, room, 2, 1.5, 1, 0.5, 0);
    const double along[1][3] = {{0, 3, 1}}, across[1][3] = {{1, 1, 1}};
    CLOSE(share(&soup, 0, 2, along, 1), 1);
    CLOSE(share(&soup, 0, 2, across, 1), 0.5);
}

/* A ridge that leans by `slant` over the ground on its right. From straight above it hides `slant` of the ground of 1;
 * the leaning side has a normal that points down, is never seen from above, and is seen from w if w leans more: only
 * where h w_x > slant w_z. */
static void overhang(void **state) {
    (void)state;
    mu_triangle room[MU_WAVE_TRIANGLES];
    mu_soup soup;
    double n[3];
    mu_soup_wave(&soup, room, 2, 1.5, 1, 0.5, 0.25);
    mu_soup_normal(&soup, 6, n);
    assert_true(n[2] < 0 && n[0] > 0);
    const double above[1][3] = {{0, 0, 1}}, steep[1][3] = {{0.4, 0, 1}}, low[1][3] = {{1, 0, 1}};
    CLOSE(share(&soup, 0, 2, above, 1), 0.75);
    CLOSE(share(&soup, 2, 2, above, 1), 1); /* the other side lies open */
    CLOSE(share(&soup, 6, 2, above, 1), 0);
    CLOSE(share(&soup, 6, 2, steep, 1), 0); /* 0.5 * 0.4 < 0.25 */
    /* Along (1, 0, 1) the leaning side is open. A ray from x on the ground is at height z over x + z; the side of the
     * next ridge is there at 2 + z/2, up to z = 1/2: it hides the ground from x = 1.75 on. */
    CLOSE(share(&soup, 6, 2, low, 1), 1);
    CLOSE(share(&soup, 0, 2, low, 1), 0.75);
}

/* For a surface without holes, what is seen along w adds up to the plane's own projection, Eq. (2a) and (3a). */
static double seen_area(const mu_soup *soup, const double w[3]) {
    double sum = 0;
    for (size_t k = 0; k < soup->count; k++) {
        double n[3], one[1][3];
        memcpy(one[0], w, sizeof one[0]);
        mu_soup_normal(soup, k, n);
        const double facing = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
        if (!(facing > 0)) continue;
        const double part = mu_soup_visible(soup, k, (const double(*)[3])one, 1);
        assert_true(part >= 0);
        sum += facing * part;
    }
    const double(*e)[2] = soup->period;
    return sum / (w[2] * fabs(e[0][0] * e[1][1] - e[0][1] * e[1][0]));
}

static void boxes_cover_the_plane(void **state) {
    (void)state;
    static const double maps[4][4] = {{1, 0, 0, 1}, {1, 2, 0, 1}, {0.3, -1.1, 0.8, 0.2}, {-4, 0.1, 0, 0.5}};
    for (uint64_t trial = 0; trial < 400; trial++) {
        mu_triangle room[MU_BOX_TRIANGLES];
        mu_soup soup;
        double u[8];
        for (uint64_t k = 0; k < 8; k++) u[k] = mu_noise_uniform(4, 8 * trial + k);
        const double slant[2] = {u[0] - 0.5, u[1] - 0.5};
        mu_soup_box(&soup, room, 1.7, 0.4 + u[2], 0.2 + u[3], slant);
        if (trial & 1) mu_soup_turn_over(&soup);
        mu_soup_transform(&soup, maps[trial / 2 % 4]);
        const double w[3] = {3 * u[4] - 1.5, 3 * u[5] - 1.5, 0.3 + u[6]};
        CLOSE(seen_area(&soup, w), 1);
    }
}

/* Shares of a transformed soup along M v are those of the original along v: masking is a geometric invariant. */
static void invariant(void **state) {
    (void)state;
    static const double maps[3][4] = {{1, 2, 0, 1}, {10, 0, 0, 0.1}, {-0.8, 0.5, 0.3, 1.2}};
    for (int k = 0; k < 3; k++) {
        const double *m = maps[k];
        const double slant[2] = {0.3, -0.2}, v[2][3] = {{1.3, 0.4, 1}, {-0.9, 0.7, 1}};
        double mv[2][3];
        for (int d = 0; d < 2; d++) {
            mv[d][0] = m[0] * v[d][0] + m[1] * v[d][1];
            mv[d][1] = m[2] * v[d][0] + m[3] * v[d][1];
            mv[d][2] = v[d][2];
        }
        mu_triangle room[2][MU_BOX_TRIANGLES];
        mu_soup original, moved;
        mu_soup_box(&original, room[0], 1.7, 0.9, 0.6, slant);
        mu_soup_box(&moved, room[1], 1.7, 0.9, 0.6, slant);
        mu_soup_transform(&moved, m);
        for (size_t t = 0; t < original.count; t++) { /* a mirror swaps two corners, which moves no area */
            CLOSE(mu_soup_visible(&original, t, v, 1), mu_soup_visible(&moved, t, (const double(*)[3])mv, 1));
            CLOSE(mu_soup_visible(&original, t, v, 2), mu_soup_visible(&moved, t, (const double(*)[3])mv, 2));
        }
    }
}

/* Two loose level facets, one a unit above the other and as large: along (1, 0, 1) the upper one's shadow is moved by
 * one; along (1/2, 0, 1), half a unit, it leaves the lower triangle what lies outside the moved one: 1 - (1/2)^2. */
static void loose_facets(void **state) {
    (void)state;
    mu_triangle room[2] = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}};
    mu_soup soup = {room, 2, {{10, 0}, {0, 10}}};
    const double above[1][3] = {{0, 0, 1}}, one[1][3] = {{1, 0, 1}}, half[1][3] = {{0.5, 0, 1}};
    CLOSE(mu_soup_visible(&soup, 0, above, 1), 0);
    CLOSE(mu_soup_visible(&soup, 0, one, 1), 1);
    CLOSE(mu_soup_visible(&soup, 0, half, 1), 0.75);
    const double pair[2][3] = {{0.5, 0, 1},
                               {-0.5, 0, 1}}; /* the two shadows are small triangles that meet in a point */
    CLOSE(mu_soup_visible(&soup, 0, pair, 2), 0.5);
    CLOSE(mu_soup_visible(&soup, 1, pair, 2), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(square_wave),           cmocka_unit_test(azimuth),   cmocka_unit_test(overhang),
        cmocka_unit_test(boxes_cover_the_plane), cmocka_unit_test(invariant), cmocka_unit_test(loose_facets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
