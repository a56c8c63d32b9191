/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* covariance.c: M to the covariance of slopes, and back by the symmetric root of its inverse. */
#include "core/render/covariance.h"

#include <math.h>
#include <string.h>

void mu_covariance_of(const double m[4], double s[3]) {
    const double scale = fmax(fmax(fabs(m[0]), fabs(m[1])), fmax(fabs(m[2]), fabs(m[3])));
    const double a = m[0] / scale, c = m[1] / scale, b = m[2] / scale, d = m[3] / scale;
    const double determinant = (a * d - c * b) * scale, square = determinant * determinant;
    s[0] = (b * b + d * d) / square, s[1] = -(a * b + c * d) / square, s[2] = (a * a + c * c) / square;
}

/* The nearest rotation, or mirror: of a 2x2 matrix the polar decomposition in closed form. */
static void turn_of(const double m[4], double q[4]) {
    const _Bool mirror = m[0] * m[3] - m[1] * m[2] < 0;
    const double x = mirror ? m[0] - m[3] : m[0] + m[3], y = mirror ? m[1] + m[2] : m[2] - m[1];
    const double length = hypot(x, y), c = length > 0 ? x / length : 1, s = length > 0 ? y / length : 0;
    q[0] = c, q[1] = mirror ? s : -s, q[2] = s, q[3] = mirror ? -c : c;
}

void mu_covariance_map(const double s[3], const double mean[4], double m[4]) {
    double of_mean[3], q[4];
    mu_covariance_of(mean, of_mean);
    const double near =
        0x1p-20 * (s[0] + s[2]); /* three numbers rounded by 2^-24 of themselves, and a margin */
    if (fabs(of_mean[0] - s[0]) <= near && fabs(of_mean[1] - s[1]) <= near &&
        fabs(of_mean[2] - s[2]) <= near) {
        memcpy(m, mean, 4 * sizeof *m);
        return;
    }
    turn_of(mean, q);
    /* S^(-1/2) = (adj S + r) / (r sqrt(tr S + 2 r)), r = sqrt(det S): by Cayley and Hamilton */
    const double r = sqrt(fmax(s[0] * s[2] - s[1] * s[1], 0)), scale = 1 / (r * sqrt(s[0] + s[2] + 2 * r));
    const double h[4] = {scale * (s[2] + r), -scale * s[1], -scale * s[1], scale * (s[0] + r)};
    for (int i = 0; i < 4; i++) m[i] = h[i / 2 * 2] * q[i % 2] + h[i / 2 * 2 + 1] * q[2 + i % 2];
}

/* xx^2, xx xy, xy^2, xx yy, xy yy, yy^2 of each part. */
static void squares(const float *s, float *out) {
    int n = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) out[n++] = s[i] * s[j];
}

static double spread(const float *s, const float *e) {
    const double xx = (double)s[0], xy = (double)s[1], yy = (double)s[2], det = xx * yy - xy * xy;
    const double a = yy / det, b = -xy / det, c = xx / det; /* S^-1 */
    const double trace = a * a * (double)e[0] + 4 * a * b * (double)e[1] +
                         2 * (b * b + a * c) * (double)e[2] + 2 * b * b * (double)e[3] +
                         4 * b * c * (double)e[4] + c * c * (double)e[5];
    return fmax(trace / 2 - 1, 0);
}

_Bool mu_covariance_spread(mu_mipmap *picture) {
    mu_mipmap moments;
    const int width = picture->level[0].width, height = picture->level[0].height, n = picture->channels;
    if (!mu_mipmap_make(&moments, width, height, 6, picture->wrap)) return 0;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        squares(picture->texels + i * (size_t)n + 4, moments.texels + 6 * i);
    mu_mipmap_build(&moments);
    const size_t count = mu_mipmap_bytes(picture) / ((size_t)n * sizeof(float));
    for (size_t i = 0; i < count; i++) {
        float *const texel = picture->texels + i * (size_t)n;
        texel[7] = (float)spread(texel + 4, moments.texels + 6 * i);
    }
    mu_mipmap_free(&moments);
    return 1;
}
