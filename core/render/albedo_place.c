/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_place.c: see albedo_place.h. Cubic between nodes, which four neighbours tell (Lagrange).
 *
 * Heights: the albedo of a smooth surface falls off within a cosine of about the slope roughness s along the view. Near the horizon
 * it goes with the root of the cosine; at the pole, if tilted, with the sine. The root of h = z / (1 + sine), the tangent of half the
 * elevation, does both: nodes are even in asinh(root(h / s)). Azimuths: the roughness along the view changes from one axis' to the
 * other's within a part of the quarter turn that is as small as their ratio, beside either axis: nodes are even in the azimuth of
 * (sqrt(sigma_U) x, sqrt(sigma_V) y), which widens both.
 */
#include "core/render/albedo_place.h"

#include <math.h>

#define TWO_PI 6.28318530717958647692

/* How far beyond the outermost nodes of a sigma a hit may be, in nodes. */
#define BEYOND 0.02f
/* The view of the node on the horizon. */
#define LEAST_COSINE 1e-6f
/* Roughnesses of which the height of nodes takes notice. */
#define SMOOTHEST 1e-4f
#define ROUGHEST  0.5f

/* Twice the variance of slopes along the view: alpha² of GGX. */
static float scale_along(const float sigma[2], float x, float y) {
    const float flat = x * x + y * y, u = sigma[0] * x, v = sigma[1] * y;
    const float square = flat > 0 ? 2 * (u * u + v * v) / flat : 2 * sigma[0] * sigma[0];
    return fminf(fmaxf(sqrtf(square), SMOOTHEST), ROUGHEST);
}

static mu_albedo_place place_of(const float sigma[2], float x, float y, float z) {
    const float inverse = 1 / scale_along(sigma, x, y);
    const float u = sigma[1] > 0 ? sqrtf(sigma[0]) * x : x, v = sigma[1] > 0 ? sqrtf(sigma[1]) * y : y;
    const float turns = atan2f(v, u) * (float)(1 / TWO_PI), h = z / (1 + sqrtf(x * x + y * y));
    return (mu_albedo_place){asinhf(sqrtf(fmaxf(h, 0) * inverse)) / asinhf(sqrtf(inverse)), turns < 0 ? turns + 1 : turns};
}

/* And back, to a unit vector. */
void mu_albedo_view_of(const float sigma[2], mu_albedo_place at, float w[3]) {
    const double angle = TWO_PI * (double)at.around;
    double x = cos(angle), y = sin(angle);
    if (sigma[1] > 0) x /= sqrt((double)sigma[0]), y /= sqrt((double)sigma[1]);
    const double scale = (double)scale_along(sigma, (float)x, (float)y);
    const double root = sinh((double)at.height * asinh(sqrt(1 / scale))), h = scale * root * root;
    const double z = fmin(fmax(2 * h / (1 + h * h), (double)LEAST_COSINE), 1);
    const double flat = sqrt((1 - z) * (1 + z)) / hypot(x, y);
    w[0] = (float)(flat * x), w[1] = (float)(flat * y), w[2] = (float)z;
}

/* Up to four nodes, from `first` on, and their weights. */
typedef struct stencil {
    uint32_t first, count;
    float weight[4];
} stencil;

static stencil four(float x) {
    const float a = x + 1, b = x - 1, c = x - 2; /* from nodes at -1, 0, 1, 2 */
    return (stencil){0, 4, {-x * b * c / 6, a * b * c / 2, -a * x * c / 2, a * x * b / 6}};
}

/* At `at` nodes from the first of `count`, of which there are 1 or at least 4. */
static stencil among(float at, uint32_t count) {
    if (count == 1) return (stencil){0, 1, {1}};
    const float inside = fminf(fmaxf(at, 0), (float)(count - 1));
    const uint32_t node = (uint32_t)inside, first = node < 1 ? 0 : node + 3 > count ? count - 4 : node - 1;
    stencil s = four(inside - (float)(first + 1));
    s.first = first;
    return s;
}

/* The same where the last node is followed by the first: indices may exceed `count`. */
static stencil around(float turns, uint32_t count) {
    if (count == 1) return (stencil){0, 1, {1}};
    const float at = turns * (float)count;
    const uint32_t node = (uint32_t)at;
    stencil s = four(at - (float)node);
    s.first = node + count - 1;
    return s;
}

/* Between azimuths: the interval that is like it among those that there are. */
static uint32_t interval_of(const mu_albedo_table *t, uint32_t interval) {
    uint32_t a = interval % t->azimuths;
    if (t->rows == t->azimuths) return a;
    if (2 * a >= t->azimuths) a = t->azimuths - 1 - a;
    return 4 * a >= t->azimuths ? t->azimuths / 2 - 1 - a : a;
}

uint32_t mu_albedo_intervals(const mu_albedo_table *t) {
    return t->rows == t->azimuths ? t->azimuths : t->azimuths / 4;
}

/* The row that has the azimuth. */
uint32_t mu_albedo_row_of(const mu_albedo_table *t, uint32_t azimuth) {
    uint32_t a = azimuth % t->azimuths;
    if (t->rows == t->azimuths) return a;
    if (2 * a > t->azimuths) a = t->azimuths - a;
    return 4 * a > t->azimuths ? t->azimuths / 2 - a : a;
}

/* False: its cell is no part of the table, or a sigma is beyond the nodes. */
_Bool mu_albedo_interpolate(const mu_albedo_table *t, const mu_ibl_lobe_f *lobe, const float wo[3], float rgb[3]) {
    const float *turn = lobe->turn;
    const mu_albedo_place at = place_of(lobe->sigma, turn[0] * wo[0] + turn[1] * wo[1], turn[0] * wo[1] - turn[1] * wo[0], wo[2]);
    const stencil z = among(at.height * (float)(t->heights - 1), t->heights), phi = around(at.around, t->azimuths);
    stencil s[2];
    _Bool inside = 1;
    for (int k = 0; k < 2; k++) {
        const float node = t->sigmas[k] > 1 ? (logf(lobe->sigma[k]) - t->least[k]) / t->step[k] : 0;
        inside = inside && node >= -BEYOND && node <= (float)(t->sigmas[k] - 1) + BEYOND;
        s[k] = among(node, t->sigmas[k]);
    }
    if (t->sharp) {
        const uint32_t cell = (uint32_t)fmaxf(at.height * (float)(t->heights - 1), 0), azimuth = (uint32_t)(at.around * (float)t->azimuths);
        inside = !t->sharp[(size_t)interval_of(t, azimuth) * (t->heights - 1) + (cell < t->heights - 2 ? cell : t->heights - 2)];
    }
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (uint32_t i = 0; i < s[0].count; i++)
        for (uint32_t j = 0; j < s[1].count; j++)
            for (uint32_t k = 0; k < phi.count; k++) {
                const float weight = s[0].weight[i] * s[1].weight[j] * phi.weight[k];
                const uint32_t row = ((s[0].first + i) * t->sigmas[1] + s[1].first + j) * t->rows +
                                     mu_albedo_row_of(t, phi.first + k);
                const float *a = t->rgb + (size_t)3 * (row * t->heights + z.first);
                for (uint32_t l = 0; l < 4; l++)
                    for (int c = 0; c < 3; c++) rgb[c] += weight * z.weight[l] * a[3 * l + (uint32_t)c];
            }
    for (int c = 0; c < 3; c++) rgb[c] = fmaxf(rgb[c], 0);
    return inside;
}

_Bool mu_albedo_table_at(const mu_albedo_table *t, const mu_ibl_lobe_f *lobe, const float wo[3], float rgb[3]) {
    return t->rgb && mu_albedo_interpolate(t, lobe, wo, rgb);
}
