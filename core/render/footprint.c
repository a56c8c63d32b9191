/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* footprint.c: pixels and cones of rays, and what they cover of a surface. World space in, texture coordinates out. */
#include "core/render/footprint.h"

/* The side of a pixel at unit depth; of an orthographic camera at any. */
static float pixel_side(const mu_camera *camera, const mu_film_settings *film) {
    return 2 * camera->half_height / (float)film->height;
}

mu_beam mu_beam_of_pixel(const mu_camera *camera, const mu_film_settings *film, mu_vec3 p) {
    float side = pixel_side(camera, film);
    if (camera->kind == MU_PERSPECTIVE) side *= mu_dot(mu_sub(p, camera->position), camera->forward);
    return (mu_beam){mu_scale(camera->right, side), mu_scale(camera->up, side), 1};
}

mu_cone mu_cone_of_pixel(const mu_camera *camera, const mu_film_settings *film) {
    const float side = pixel_side(camera, film);
    return camera->kind == MU_PERSPECTIVE ? (mu_cone){0, side} : (mu_cone){side, 0};
}

mu_beam mu_beam_of_cone(float width, mu_vec3 direction) {
    const mu_vec3 aside = fabsf(direction.x) < 0.5f ? mu_v3(1, 0, 0) : mu_v3(0, 1, 0);
    const mu_vec3 x = mu_normalise(mu_cross(direction, aside)), y = mu_cross(direction, x);
    return (mu_beam){mu_scale(x, width), mu_scale(y, width), 1};
}

/* Half of `side`, along the ray onto the tangent plane, by least squares in the derivatives of p by u and v. */
static void half_axis(const mu_hit *hit, mu_vec3 direction, mu_vec3 side, float out[2]) {
    const float slip = mu_dot(side, hit->ng) / mu_dot(direction, hit->ng);
    const mu_vec3 along = mu_sub(side, mu_scale(direction, slip));
    const double uu = (double)mu_dot(hit->dpdu, hit->dpdu), uv = (double)mu_dot(hit->dpdu, hit->dpdv),
                 vv = (double)mu_dot(hit->dpdv, hit->dpdv);
    const double u = (double)mu_dot(hit->dpdu, along), v = (double)mu_dot(hit->dpdv, along);
    const double determinant = uu * vv - uv * uv;
    out[0] = (float)((vv * u - uv * v) / (2 * determinant));
    out[1] = (float)((uu * v - uv * u) / (2 * determinant));
}

void mu_footprint_at(const mu_hit *hit, mu_vec3 direction, const mu_beam *beam, float out[6]) {
    out[0] = hit->uv[0], out[1] = hit->uv[1];
    half_axis(hit, direction, beam->x, out + 2);
    half_axis(hit, direction, beam->y, out + 4);
}
