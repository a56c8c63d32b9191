/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* light_parts.h: the kinds of light that light.c chooses among; seen by light*.c and their tests only. World
 * space. */
#ifndef MU_LIGHT_PARTS_H
#define MU_LIGHT_PARTS_H

#include "core/render/light.h"
#include "core/render/sphere_table.h"

#define MU_PI_F 3.14159265f

static inline float mu_luminance(const float rgb[3]) {
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; /* ITU-R BT.709 */
}

/* ------------------------------------------------------------------------- environment image and studio */

typedef struct mu_sky {
    int width, height; /* of the image; 0: the studio */
    float *pixels;     /* RGB, row by row from the top, not yet scaled */
    float scale[3];
    float turn[2]; /* cos, sin of the rotation about +z */
    mu_sphere_table table;
    double fluence; /* luminance integrated over the sphere */
} mu_sky;

_Bool mu_sky_make_environment(mu_sky *sky, const mu_light *light, mu_error *error);
_Bool mu_sky_make_studio(mu_sky *sky, const mu_light *light, mu_error *error);
/* Takes over `pixels` (malloc). */
_Bool mu_sky_make_from_pixels(mu_sky *sky, const mu_light *light, float *pixels, int width, int height,
                              mu_error *error);
void mu_sky_free(mu_sky *sky);
void mu_sky_sample(const mu_sky *sky, const float u[2], mu_vec3 *direction, float radiance[3], float *pdf);
void mu_sky_escaped(const mu_sky *sky, mu_vec3 direction, float radiance[3], float *pdf);

/* Bilinear lookup at (u, v), and its exact mean over each pixel, as luminance. */
void mu_environment_radiance(const mu_sky *sky, float u, float v, float radiance[3]);
void mu_environment_means(const mu_sky *sky, float *luminance);
/* The studio, unrotated and unscaled. */
void mu_studio_radiance(mu_vec3 direction, float radiance[3]);
/* A raster to draw from, of cells of 1.4 degrees: well below the width of the studio's soft edges. */
enum { MU_STUDIO_WIDTH = 256, MU_STUDIO_HEIGHT = 128 };
void mu_studio_means(const float scale[3], float *luminance);

/* ------------------------------------------------------------------------------------------------ point */

/* Irradiance on what faces it as `radiance`, pdf 1, delta; pdf 0 outside of its cone. */
void mu_point_light_sample(const mu_light *light, mu_vec3 p, mu_light_sample *out);

/* -------------------------------------------------------------------------------------------- rectangle */

typedef struct mu_rectangle_light {
    mu_vec3 corner, x, y; /* unit axes along the edges; (x, y, normal) need not be right-handed */
    mu_vec3 normal;       /* emits on this side */
    float width, height, area;
    _Bool right_angled;
    float radiance[3];
} mu_rectangle_light;

void mu_rectangle_light_make(mu_rectangle_light *rectangle, const mu_light *light);
/* pdf 0 where p is behind the light or in its plane. */
void mu_rectangle_light_sample(const mu_rectangle_light *rectangle, mu_vec3 p, const float u[2],
                               mu_vec3 *direction, float *distance, float *pdf);
float mu_rectangle_light_pdf(const mu_rectangle_light *rectangle, mu_vec3 p, mu_vec3 direction,
                             float distance);

#endif
