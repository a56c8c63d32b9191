/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * light_sky.c: what the environment image and the studio have in common: radiance from everywhere, turned
 * about +z, drawn through one sphere table.
 */
#include "core/render/light_parts.h"

#include <stdlib.h>
#include <string.h>

static _Bool make(mu_sky *sky, const mu_light *light, mu_error *error) {
    for (int c = 0; c < 3; c++) sky->scale[c] = light->scale[c];
    sky->turn[0] = cosf(light->rotation);
    sky->turn[1] = sinf(light->rotation);
    const uint32_t width = sky->width ? (uint32_t)sky->width : MU_STUDIO_WIDTH;
    const uint32_t height = sky->width ? (uint32_t)sky->height : MU_STUDIO_HEIGHT;
    float *means = malloc((size_t)width * height * sizeof *means);
    if (!means) return mu_fail(error, "not enough memory for an environment of %u x %u", width, height);
    if (sky->width)
        mu_environment_means(sky, means);
    else
        mu_studio_means(sky->scale, means);
    const _Bool made = mu_sphere_table_make(&sky->table, width, height, means, error);
    for (uint32_t row = 0; made && sky->table.height && row < height; row++) {
        double sum = 0;
        for (size_t i = 0; i < width; i++) sum += (double)means[row * (size_t)width + i];
        sky->fluence += sum / (double)sky->table.rows[row].inverse_cell;
    }
    free(means);
    return made;
}

_Bool mu_sky_make_studio(mu_sky *sky, const mu_light *light, mu_error *error) {
    memset(sky, 0, sizeof *sky);
    return make(sky, light, error);
}

_Bool mu_sky_make_from_pixels(mu_sky *sky, const mu_light *light, float *pixels, int width, int height,
                              mu_error *error) {
    memset(sky, 0, sizeof *sky);
    sky->width = width;
    sky->height = height;
    sky->pixels = pixels;
    if (make(sky, light, error)) return 1;
    mu_sky_free(sky);
    return 0;
}

void mu_sky_free(mu_sky *sky) {
    free(sky->pixels);
    mu_sphere_table_free(&sky->table);
    memset(sky, 0, sizeof *sky);
}

static mu_vec3 turned(const mu_sky *sky, mu_vec3 w, float sign) {
    const float c = sky->turn[0], s = sign * sky->turn[1];
    return mu_v3(c * w.x - s * w.y, s * w.x + c * w.y, w.z);
}

static void radiance_at(const mu_sky *sky, mu_vec3 own, float u, float v, float radiance[3]) {
    if (sky->width)
        mu_environment_radiance(sky, u, v, radiance);
    else
        mu_studio_radiance(own, radiance);
    for (int c = 0; c < 3; c++) radiance[c] *= sky->scale[c];
}

void mu_sky_sample(const mu_sky *sky, const float u[2], mu_vec3 *direction, float radiance[3], float *pdf) {
    mu_sphere_point point;
    mu_sphere_table_sample(&sky->table, u, &point);
    *direction = turned(sky, point.direction, 1);
    *pdf = point.pdf;
    if (point.pdf > 0) radiance_at(sky, point.direction, point.u, point.v, radiance);
}

void mu_sky_escaped(const mu_sky *sky, mu_vec3 direction, float radiance[3], float *pdf) {
    const mu_vec3 own = turned(sky, direction, -1);
    float u, v;
    mu_sphere_table_locate(own, &u, &v);
    radiance_at(sky, own, u, v, radiance);
    *pdf = mu_sphere_table_pdf(&sky->table, u, v);
}
