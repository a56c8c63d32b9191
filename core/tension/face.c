/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * face.c: M = D R^-1 of one triangle, section 5.1 and Figure 7 of Microsurface Transformations (Atanasov et al. 2022).
 *
 * A direction within a triangle is x e1 + y e2 of its edges e1, e2 from corner 0, and (x, y) stay what they are under
 * the deformation. dp/du = (dv2 e1 - dv1 e2) / det, det = du1 dv2 - du2 dv1.
 */
#include "core/tension/face.h"

#include <math.h>
#include <string.h>

/* Area over the longest edge's square below which corners rounded to float leave nothing of it: as of meshes. */
#define MU_FLAT 0x1p-23

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        out[k] = a[l] * b[m] - a[m] * b[l];
    }
}

/* One of the two triangles: edges from corner 0 to 1 and 2, twice the area, unit normal. */
typedef struct mu_shape {
    double e1[3], e2[3], n[3], twice_area, angle[3];
} mu_shape;

static double angle_between(const double a[3], const double b[3], double twice_area) {
    return atan2(twice_area, dot(a, b));
}

/* False without area. */
static _Bool make_shape(const mu_tension_input *input, const double *position, uint32_t triangle,
                        mu_shape *s) {
    const uint32_t *c = input->corner + 3 * (size_t)triangle;
    const double *p0 = position + 3 * (size_t)c[0], *p1 = position + 3 * (size_t)c[1],
                 *p2 = position + 3 * (size_t)c[2];
    double e3[3], back[3];
    memset(s, 0, sizeof *s);
    for (int k = 0; k < 3; k++) {
        s->e1[k] = p1[k] - p0[k], s->e2[k] = p2[k] - p0[k];
        e3[k] = p2[k] - p1[k], back[k] = -s->e1[k];
    }
    double n[3];
    cross(s->e1, s->e2, n);
    s->twice_area = sqrt(dot(n, n));
    const double longest = fmax(dot(e3, e3), fmax(dot(s->e1, s->e1), dot(s->e2, s->e2)));
    if (!(s->twice_area > MU_FLAT * longest)) return 0;
    for (int k = 0; k < 3; k++) s->n[k] = n[k] / s->twice_area;
    s->angle[0] = angle_between(s->e1, s->e2, s->twice_area);
    s->angle[1] = angle_between(back, e3, s->twice_area);
    s->angle[2] = acos(-1.0) - s->angle[0] - s->angle[1];
    return 1;
}

enum { UV_NONE, UV_FLAT, UV_GOOD };

/* (x, y) of dp/du, up to a positive factor, and the orientation in the texture. */
static int uv_direction(const double *uvs, uint32_t triangle, double xy[2], int *sign) {
    *sign = 0;
    if (!uvs) return UV_NONE;
    const double *uv = uvs + 6 * (size_t)triangle;
    for (int k = 0; k < 6; k++)
        if (!isfinite(uv[k])) return UV_NONE;
    const double du1 = uv[2] - uv[0], dv1 = uv[3] - uv[1], du2 = uv[4] - uv[0], dv2 = uv[5] - uv[1];
    const double det = du1 * dv2 - du2 * dv1, du3 = du2 - du1, dv3 = dv2 - dv1;
    const double longest = fmax(du1 * du1 + dv1 * dv1, fmax(du2 * du2 + dv2 * dv2, du3 * du3 + dv3 * dv3));
    if (!(fabs(det) > MU_FLAT * longest)) return UV_FLAT;
    *sign = det > 0 ? 1 : -1;
    xy[0] = *sign * dv2, xy[1] = -*sign * dv1;
    return UV_GOOD;
}

/* (x, y) of the projection of +x, or +y, onto the triangle. */
static void axis_direction(const mu_shape *s, double xy[2]) {
    double axis[3] = {1, 0, 0}, side[3];
    if (1 - s->n[0] * s->n[0] < 1e-6) axis[0] = 0, axis[1] = 1;
    /* a = x e1 + y e2 + z n: x = n . (a x e2) / area, y = n . (e1 x a) / area */
    cross(axis, s->e2, side);
    xy[0] = dot(s->n, side) / s->twice_area;
    cross(s->e1, axis, side);
    xy[1] = dot(s->n, side) / s->twice_area;
}

/* The edges in the frame t, n x t: (e1.t, e1.b, e2.t, e2.b). */
static void edges_in_frame(const mu_shape *s, const double xy[2], double edges[4]) {
    double t[3], b[3];
    for (int k = 0; k < 3; k++) t[k] = xy[0] * s->e1[k] + xy[1] * s->e2[k];
    const double length = sqrt(dot(t, t));
    for (int k = 0; k < 3; k++) t[k] /= length;
    cross(s->n, t, b);
    edges[0] = dot(s->e1, t), edges[1] = dot(s->e1, b);
    edges[2] = dot(s->e2, t), edges[3] = dot(s->e2, b);
}

static _Bool same_uvs(const mu_tension_input *input, uint32_t triangle) {
    return !memcmp(input->rest_uv + 6 * (size_t)triangle, input->deformed_uv + 6 * (size_t)triangle,
                   6 * sizeof(double));
}

/* What the two textures say of a triangle. */
typedef struct mu_textures {
    int rest, deformed; /* UV_NONE, UV_FLAT, UV_GOOD */
    int rest_sign, deformed_sign;
    double rest_xy[2], deformed_xy[2];
} mu_textures;

/* The u direction in both triangles. */
static void find_directions(const mu_tension_input *input, uint32_t triangle, const mu_shape *rest,
                            mu_textures *t, mu_tension_counts *counts) {
    if (t->rest == UV_GOOD && t->deformed == UV_GOOD) {
        counts->uv_changed += !same_uvs(input, triangle);
    } else if (t->rest == UV_GOOD) {
        counts->uv_once++;
        memcpy(t->deformed_xy, t->rest_xy, sizeof t->rest_xy);
    } else if (t->deformed == UV_GOOD) {
        counts->uv_once++;
        memcpy(t->rest_xy, t->deformed_xy, sizeof t->rest_xy);
    } else {
        ++*(t->rest == UV_FLAT || t->deformed == UV_FLAT ? &counts->uv_flat : &counts->uv_none);
        axis_direction(rest, t->rest_xy);
        memcpy(t->deformed_xy, t->rest_xy, sizeof t->rest_xy);
    }
    counts->uv_mirrored += t->rest_sign < 0 || t->deformed_sign < 0;
}

mu_tension_face mu_tension_face_of(const mu_tension_input *input, uint32_t triangle,
                                   mu_tension_counts *counts) {
    mu_tension_face face = {.usable = 0};
    mu_shape rest, deformed;
    mu_textures t;
    double r[4], d[4];
    t.rest = uv_direction(input->rest_uv, triangle, t.rest_xy, &t.rest_sign);
    t.deformed = uv_direction(input->deformed_uv, triangle, t.deformed_xy, &t.deformed_sign);
    face.chart = 4 + 3 * t.rest_sign + t.deformed_sign;
    const _Bool rest_good = make_shape(input, input->rest, triangle, &rest);
    const _Bool deformed_good = make_shape(input, input->deformed, triangle, &deformed);
    memcpy(face.rest_n, rest.n, sizeof rest.n);
    memcpy(face.deformed_n, deformed.n, sizeof deformed.n);
    memcpy(face.rest_angle, rest.angle, sizeof rest.angle);
    memcpy(face.deformed_angle, deformed.angle, sizeof deformed.angle);
    if (!rest_good || !deformed_good) {
        ++*(rest_good ? &counts->deformed_flat : &counts->rest_flat);
        return face;
    }
    find_directions(input, triangle, &rest, &t, counts);
    edges_in_frame(&rest, t.rest_xy, r);
    edges_in_frame(&deformed, t.deformed_xy, d);
    /* M R = D with the edges as columns; det R is twice the area */
    for (int k = 0; k < 2; k++) {
        face.m[2 * k] = (d[k] * r[3] - d[2 + k] * r[1]) / rest.twice_area;
        face.m[2 * k + 1] = (d[2 + k] * r[0] - d[k] * r[2]) / rest.twice_area;
    }
    for (int k = 0; k < 3; k++) face.weight[k] = rest.twice_area * rest.angle[k];
    face.usable = 1;
    return face;
}
