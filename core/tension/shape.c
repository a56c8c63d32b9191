/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* shape.c: see shape.h. A direction x e1 + y e2 keeps its (x, y) under the deformation. */
#include "core/tension/shape.h"

#include <math.h>
#include <string.h>

/* Area over the longest edge's square below which corners rounded to float leave nothing of it: as of meshes. */
#define MU_FLAT 0x1p-23

_Bool mu_shape_make(mu_shape *s, const double e1[3], const double e2[3]) {
    double e3[3], n[3];
    memset(s, 0, sizeof *s);
    for (int k = 0; k < 3; k++) s->e1[k] = e1[k], s->e2[k] = e2[k], e3[k] = e2[k] - e1[k];
    mu_shape_cross(e1, e2, n);
    s->twice_area = sqrt(mu_shape_dot(n, n));
    const double longest = fmax(mu_shape_dot(e3, e3), fmax(mu_shape_dot(e1, e1), mu_shape_dot(e2, e2)));
    if (!(s->twice_area > MU_FLAT * longest)) return 0;
    for (int k = 0; k < 3; k++) s->n[k] = n[k] / s->twice_area;
    return 1;
}

void mu_shape_along(const mu_shape *s, const double xy[2], double t[3]) {
    for (int k = 0; k < 3; k++) t[k] = xy[0] * s->e1[k] + xy[1] * s->e2[k];
    const double length = sqrt(mu_shape_dot(t, t));
    for (int k = 0; k < 3; k++) t[k] /= length;
}

/* The edges in the frame t, n x t: (e1.t, e1.b, e2.t, e2.b). */
static void edges_in_frame(const mu_shape *s, const double xy[2], double edges[4]) {
    double t[3], b[3];
    mu_shape_along(s, xy, t);
    mu_shape_cross(s->n, t, b);
    edges[0] = mu_shape_dot(s->e1, t), edges[1] = mu_shape_dot(s->e1, b);
    edges[2] = mu_shape_dot(s->e2, t), edges[3] = mu_shape_dot(s->e2, b);
}

void mu_shape_map(const mu_shape *rest, const double rest_xy[2], const mu_shape *deformed,
                  const double deformed_xy[2], double m[4]) {
    double r[4], d[4];
    edges_in_frame(rest, rest_xy, r);
    edges_in_frame(deformed, deformed_xy, d);
    /* M R = D with the edges as columns; det R is twice the area */
    for (int k = 0; k < 2; k++) {
        m[2 * k] = (d[k] * r[3] - d[2 + k] * r[1]) / rest->twice_area;
        m[2 * k + 1] = (d[2 + k] * r[0] - d[k] * r[2]) / rest->twice_area;
    }
}

void mu_shape_axis(const mu_shape *s, double xy[2]) {
    double axis[3] = {1, 0, 0}, side[3];
    if (1 - s->n[0] * s->n[0] < 1e-6) axis[0] = 0, axis[1] = 1;
    /* a = x e1 + y e2 + z n: x = n . (a x e2) / area, y = n . (e1 x a) / area */
    mu_shape_cross(axis, s->e2, side);
    xy[0] = mu_shape_dot(s->n, side) / s->twice_area;
    mu_shape_cross(s->e1, axis, side);
    xy[1] = mu_shape_dot(s->n, side) / s->twice_area;
}
