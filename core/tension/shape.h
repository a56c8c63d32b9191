/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * shape.h: a parallelogram of two edges in space, the same of a deformed surface, and the M between them: M = D R^-1 of
 * section 5.1 and Figure 7. The edges are those of a triangle, or the tangents dp/ds of a surface at a point: M is the
 * same expression of both.
 */
#ifndef MU_TENSION_SHAPE_H
#define MU_TENSION_SHAPE_H

typedef struct mu_shape {
    double e1[3], e2[3], n[3], twice_area; /* n: unit, e1 x e2; 0 without area */
} mu_shape;

static inline double mu_shape_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline void mu_shape_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* False without area, to within what rounding corners to float leaves of it. */
_Bool mu_shape_make(mu_shape *shape, const double e1[3], const double e2[3]);
/* Unit vector along x e1 + y e2. */
void mu_shape_along(const mu_shape *shape, const double xy[2], double t[3]);
/* M, two rows, from the frame along rest_xy of the one to the frame along deformed_xy of the other. Both have area. */
void mu_shape_map(const mu_shape *rest, const double rest_xy[2], const mu_shape *deformed,
                  const double deformed_xy[2], double m[4]);
/* (x, y) of +x projected onto the plane, of +y where n is all but +-x. */
void mu_shape_axis(const mu_shape *shape, double xy[2]);

#endif
