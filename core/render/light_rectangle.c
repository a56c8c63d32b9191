/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * light_rectangle.c: a rectangle that emits evenly from one side, drawn evenly over the solid angle it fills.
 *
 * Source: Urena, Fajardo and King, "An area-preserving parametrization for spherical rectangles", EGSR 2013.
 * In double precision, for the solid angle is 2 pi less than a sum of four angles. Where it is so small that
 * little is left of it, and for parallelograms, points are drawn evenly over the area instead; there the two
 * differ little.
 */
#include "core/render/light_parts.h"

/* A dozen rounding errors of 2^-53 leave the solid angle correct to one part in 10^7 down to here. */
#define SMALLEST 1e-8

#define PI 3.14159265358979323846

typedef struct mu_spherical_rectangle {
    double x0, x1, y0, y1, z; /* of the rectangle as seen from p; z < 0 */
    double b0, b1, k, solid_angle;
} mu_spherical_rectangle;

void mu_rectangle_light_make(mu_rectangle_light *rectangle, const mu_light *light) {
    const mu_affine *m = &light->to_world;
    const mu_vec3 x = mu_scale(mu_affine_vector(m, mu_v3(1, 0, 0)), light->size[0]);
    const mu_vec3 y = mu_scale(mu_affine_vector(m, mu_v3(0, 1, 0)), light->size[1]);
    const mu_vec3 cross = mu_cross(x, y), side = mu_affine_vector(m, mu_v3(0, 0, 1));
    rectangle->corner = mu_sub(mu_affine_point(m, mu_v3(0, 0, 0)), mu_scale(mu_add(x, y), 0.5f));
    rectangle->width = mu_length(x);
    rectangle->height = mu_length(y);
    rectangle->area = mu_length(cross);
    rectangle->x = mu_normalise(x);
    rectangle->y = mu_normalise(y);
    rectangle->normal = mu_scale(mu_normalise(cross), mu_dot(cross, side) < 0 ? -1 : 1);
    rectangle->right_angled = fabsf(mu_dot(rectangle->x, rectangle->y)) < 1e-6f; /* a few roundings */
    for (int c = 0; c < 3; c++) rectangle->radiance[c] = light->scale[c];
}

/* The sum of two angles in [0, pi], given their cosines, as a point of the unit circle. */
static void sum_of_angles(double a, double b, double *cosine, double *sine) {
    const double c = sqrt(fmax(1 - a * a, 0)), d = sqrt(fmax(1 - b * b, 0));
    *cosine = a * b - c * d;
    *sine = c * b + a * d;
}

/* In [0, 2 pi) */
static double turn(double cosine, double sine) {
    const double angle = atan2(sine, cosine);
    return angle < 0 ? angle + 2 * PI : angle;
}

/* False where the area is to be drawn from. */
static _Bool spherical(const mu_rectangle_light *r, mu_vec3 p, mu_spherical_rectangle *s) {
    if (!r->right_angled) return 0;
    const mu_vec3 d = mu_sub(r->corner, p);
    s->x0 = (double)mu_dot(d, r->x);
    s->y0 = (double)mu_dot(d, r->y);
    s->z = (double)mu_dot(d, r->normal);
    s->x1 = s->x0 + (double)r->width;
    s->y1 = s->y0 + (double)r->height;
    const double zz = s->z * s->z;
    const double n0 = 1 / sqrt(zz + s->y0 * s->y0), n1 = 1 / sqrt(zz + s->x1 * s->x1);
    const double n2 = 1 / sqrt(zz + s->y1 * s->y1), n3 = 1 / sqrt(zz + s->x0 * s->x0);
    /* The four edges' planes have unit normals (0, z, -y0) n0, (-z, 0, x1) n1, (0, -z, y1) n2, (z, 0, -x0)
     * n3. */
    /* The interior angles g0 ... g3 between them; the solid angle is their sum less 2 pi, so the angle of the
     * product of their points on the circle: nothing cancels against 2 pi. */
    double c01, s01, c23, s23;
    sum_of_angles(s->y0 * s->x1 * n0 * n1, -s->x1 * s->y1 * n1 * n2, &c01, &s01);
    sum_of_angles(s->y1 * s->x0 * n2 * n3, -s->x0 * s->y0 * n3 * n0, &c23, &s23);
    s->b0 = -s->y0 * n0;
    s->b1 = s->y1 * n2;
    s->k = 2 * PI - turn(c23, s23);
    s->solid_angle = turn(c01 * c23 - s01 * s23, s01 * c23 + c01 * s23);
    /* Rounding may turn nothing into a full turn; half the sphere is the most that a plane can fill. */
    if (s->solid_angle > 2 * PI - 1e-6) s->solid_angle = 0;
    return s->solid_angle > SMALLEST;
}

/* The point (x, y) of the rectangle, from p, that (u0, u1) stands for. */
static void spherical_point(const mu_spherical_rectangle *s, double u0, double u1, double *x, double *y) {
    const double au = u0 * s->solid_angle + s->k, sine = sin(au);
    const double fu = (cos(au) * s->b0 - s->b1) / (sine == 0 ? 1e-300 : sine);
    const double cu = fmin(fmax(copysign(1 / sqrt(fu * fu + s->b0 * s->b0), fu), -1), 1);
    const double xu = -(cu * s->z) / fmax(sqrt(1 - cu * cu), 1e-300);
    *x = fmin(fmax(xu, s->x0), s->x1);
    const double d = sqrt(*x * *x + s->z * s->z);
    const double h0 = s->y0 / sqrt(d * d + s->y0 * s->y0), h1 = s->y1 / sqrt(d * d + s->y1 * s->y1);
    const double hv = h0 + u1 * (h1 - h0), rest = 1 - hv * hv;
    *y = fmin(fmax(rest > 0 ? hv * d / sqrt(rest) : s->y1, s->y0), s->y1);
}

void mu_rectangle_light_sample(const mu_rectangle_light *r, mu_vec3 p, const float u[2], mu_vec3 *direction,
                               float *distance, float *pdf) {
    *pdf = 0;
    const mu_vec3 corner = mu_sub(r->corner, p);
    if (!(mu_dot(corner, r->normal) < 0)) return; /* behind, or edge-on */
    mu_spherical_rectangle s;
    const _Bool round = spherical(r, p, &s);
    mu_vec3 to;
    if (round) {
        double x, y;
        spherical_point(&s, (double)u[0], (double)u[1], &x, &y);
        to = mu_add(mu_add(mu_scale(r->x, (float)x), mu_scale(r->y, (float)y)),
                    mu_scale(r->normal, (float)s.z));
    } else {
        to = mu_add(corner, mu_add(mu_scale(r->x, u[0] * r->width), mu_scale(r->y, u[1] * r->height)));
    }
    *distance = mu_length(to);
    *direction = mu_normalise(to);
    if (round)
        *pdf = (float)(1 / s.solid_angle);
    else
        *pdf = *distance * *distance / (r->area * -mu_dot(*direction, r->normal));
    if (!(*pdf > 0) || !isfinite(*pdf)) *pdf = 0;
}

float mu_rectangle_light_pdf(const mu_rectangle_light *r, mu_vec3 p, mu_vec3 direction, float distance) {
    const float facing = -mu_dot(direction, r->normal);
    if (!(facing > 0) || !(mu_dot(mu_sub(r->corner, p), r->normal) < 0)) return 0;
    mu_spherical_rectangle s;
    if (spherical(r, p, &s)) return (float)(1 / s.solid_angle);
    const float pdf = distance * distance / (r->area * facing);
    return isfinite(pdf) ? pdf : 0;
}
