/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* displacement.c: the derivative of a uniform cubic B-spline over a picture (de Boor, "A Practical Guide to Splines"). */
#include "core/render/displacement.h"

#include <math.h>

/* Weights of four texels in a row, t in [0, 1) from the second to the third, and their derivatives by t. */
static void weights(double t, double value[4], double slope[4]) {
    const double s = 1 - t;
    value[0] = s * s * s / 6, value[3] = t * t * t / 6;
    value[1] = (4 - 6 * t * t + 3 * t * t * t) / 6, value[2] = (4 - 6 * s * s + 3 * s * s * s) / 6;
    slope[0] = -s * s / 2, slope[3] = t * t / 2;
    slope[1] = t * (1.5 * t - 2), slope[2] = -s * (1.5 * s - 2);
}

/* The texel that continues a row of `count`. */
static int continued(mu_wrap wrap, double index, int count) {
    if (wrap == MU_WRAP_CLAMP) return (int)fmin(fmax(index, 0), count - 1);
    const double period = wrap == MU_WRAP_MIRROR ? 2.0 * count : count;
    const int i = (int)(index - period * floor(index / period));
    return i < count ? i : 2 * count - 1 - i;
}

void mu_displacement_at(const mu_displacement *d, double u, double v, double change[4]) {
    const mu_mipmap *p = &d->picture;
    const int width = p->level[0].width, height = p->level[0].height;
    const double x = u * width - 0.5, y = (1 - v) * height - 0.5, left = floor(x), top = floor(y);
    double across[4], across_slope[4], down[4], down_slope[4];
    change[0] = change[1] = change[2] = change[3] = 0;
    if (!(fabs(left) < 1e15 && fabs(top) < 1e15)) return;
    weights(x - left, across, across_slope);
    weights(y - top, down, down_slope);
    for (int j = 0; j < 4; j++) {
        const int row = continued(p->wrap, top - 1 + j, height);
        for (int i = 0; i < 4; i++) {
            const int column = continued(p->wrap, left - 1 + i, width);
            const float *at = p->texels + 2 * ((size_t)row * (size_t)width + (size_t)column);
            for (int c = 0; c < 2; c++) {
                change[2 * c] += across_slope[i] * down[j] * (double)at[c];
                change[2 * c + 1] -= across[i] * down_slope[j] * (double)at[c];
            }
        }
    }
    for (int k = 0; k < 4; k++) change[k] *= d->scale * (k % 2 ? height : width);
}
