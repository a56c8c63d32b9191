/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * light_environment.c: radiance from a latitude-longitude image, laid out as sphere_table.h says: +z up, the
 * middle column towards +x, the column a quarter to the right of it towards -y (as Blender and Cycles have
 * it).
 *
 * Pixels stand for their centres and are interpolated bilinearly, around in u and held at the poles in v. The
 * table gets the exact mean of that interpolant over each pixel, so that where radiance is positive so is the
 * density.
 */
#include "core/render/image_read.h"
#include "core/render/light_parts.h"

#include <stdio.h>
#include <stdlib.h>

/* Some thousand times the sun's radiance in W/(m^2 sr nm); anything above is a broken file, and would
 * overflow. */
#define BRIGHTEST 1e12f

/* Filtering a photograph leaves negative traces beside bright edges; up to this share of the mean they are no news. */
#define TRACE 0.01

/* NaN and negative become 0, too bright and infinite the limit. Returns how many pixels that changed by more than a
 * trace. */
static size_t clean(float *pixels, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < 3 * count; i++)
        if (pixels[i] > 0 && pixels[i] <= BRIGHTEST) sum += (double)pixels[i];
    const float trace = (float)(TRACE * sum / (3.0 * (double)count));
    size_t changed = 0;
    for (size_t i = 0; i < count; i++) {
        _Bool bad = 0;
        for (float *c = pixels + 3 * i; c < pixels + 3 * i + 3; c++) {
            if (*c >= 0 && *c <= BRIGHTEST) continue;
            if (!(*c < 0 && *c >= -trace)) bad = 1;
            *c = *c > BRIGHTEST ? BRIGHTEST : 0;
        }
        changed += bad;
    }
    return changed;
}

_Bool mu_sky_make_environment(mu_sky *sky, const mu_light *light, mu_error *error) {
    int width, height;
    float *pixels = mu_image_read(light->image, &width, &height, error);
    if (!pixels) return 0;
    const size_t count = (size_t)width * (size_t)height, changed = clean(pixels, count);
    if (changed)
        mu_warn(error, "%s%s%s: %zu of %zu pixels were negative, not finite or above %g; clamped",
                light->place ? light->place : "", light->place ? ": " : "", light->image, changed, count,
                (double)BRIGHTEST);
    return mu_sky_make_from_pixels(sky, light, pixels, width, height, error);
}

static const float *pixel(const mu_sky *sky, int column, int row) {
    const int width = sky->width, height = sky->height;
    column = column < 0 ? column + width : column >= width ? column - width : column;
    row = row < 0 ? 0 : row >= height ? height - 1 : row;
    return sky->pixels + 3 * ((size_t)row * (size_t)width + (size_t)column);
}

void mu_environment_radiance(const mu_sky *sky, float u, float v, float radiance[3]) {
    const float x = u * (float)sky->width - 0.5f, y = v * (float)sky->height - 0.5f;
    const float left = floorf(x), top = floorf(y), s = x - left, t = y - top;
    const int i = (int)left, j = (int)top;
    const float *a = pixel(sky, i, j), *b = pixel(sky, i + 1, j);
    const float *c = pixel(sky, i, j + 1), *d = pixel(sky, i + 1, j + 1);
    for (int k = 0; k < 3; k++)
        radiance[k] = (1 - t) * ((1 - s) * a[k] + s * b[k]) + t * ((1 - s) * c[k] + s * d[k]);
}

/* The mean over a pixel of the interpolant is the tensor product of (1/8, 6/8, 1/8) with itself. */
void mu_environment_means(const mu_sky *sky, float *luminance) {
    static const float weight[3] = {1.f / 8, 6.f / 8, 1.f / 8};
    for (int row = 0; row < sky->height; row++)
        for (int column = 0; column < sky->width; column++) {
            float sum[3] = {0, 0, 0};
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++) {
                    const float *near = pixel(sky, column + i, row + j), w = weight[i + 1] * weight[j + 1];
                    for (int c = 0; c < 3; c++) sum[c] += w * near[c] * sky->scale[c];
                }
            *luminance++ = mu_luminance(sum);
        }
}
