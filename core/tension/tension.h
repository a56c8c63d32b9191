/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tension.h: how a mesh deforms, as the 2x2 map M that its microsurface undergoes: per triangle, and continuous.
 *
 * Microsurface Transformations (Atanasov et al. 2022), section 5.1 and Figure 7: the edges of a triangle at rest and
 * deformed, each in the plane of its own triangle and turned so that the u direction of the texture is +x, are
 * R = (r1 r2) and D = (d1 d2); M = D R^-1 maps positions of the tangent plane at rest to those of the deformed one.
 * Frames are orthonormal: t along dp/du, n by the triangle's own winding, b = n x t, also where the texture is
 * mirrored; that is the frame of shading. Units cancel.
 *
 * So M keeps the u direction: m10 = 0, m00 and m11 > 0, if both meshes have the same texture coordinates. Each mesh uses
 * its own; a triangle for which only one has them uses these twice; where there are none, or without area, u is the
 * projection of the mesh's +x axis at rest onto the triangle (+y where that is all but nothing), carried along.
 *
 * Continuous M: all corners at one place (same position at rest and deformed), with the same texture coordinates
 * and handedness, are one point of a chart. All points of a place see one deformation, whatever the seams of the texture
 * (site.h): the mean of log U = log(M^T M) / 2 over the triangles that meet there, weighted by area and angle at
 * rest (stretch.h says why), moved to that of a polynomial through the vertices around (quadric.h). Each point
 * expresses it along its own u (direction.h). Between the points of a triangle M is interpolated linearly
 * (mu_tension_mix): triangular matrices with positive diagonals stay so, hence invertible.
 *
 * Accuracy: on a smooth deformation a triangle's M is that of its middle to first order in its size; a point's M is
 * of second order, also at borders and wherever the vertices lie. Where textures of the two meshes differ, the turn
 * between them is a mean: of first order, but for even meshes.
 *
 * Deterministic: sums run in the order of the triangles. A mesh may be read by several threads.
 */
#ifndef MU_TENSION_H
#define MU_TENSION_H

#include <stddef.h>
#include <stdint.h>

/* Borrowed. Positions are finite, indices below `vertices`. */
typedef struct mu_tension_input {
    uint32_t vertices, triangles;
    const uint32_t *corner;              /* 3 per triangle: vertices */
    const double *rest, *deformed;       /* 3 per vertex */
    const double *rest_uv, *deformed_uv; /* 6 per triangle: u, v of each corner, not finite: none; or NULL */
} mu_tension_input;

/* Of triangles, unless it says otherwise. Enough for one message. */
typedef struct mu_tension_counts {
    uint32_t rest_flat;     /* without area at rest: no M of their own */
    uint32_t deformed_flat; /* with area at rest, without deformed: their M would be singular */
    uint32_t uv_none;       /* without texture coordinates in either mesh */
    uint32_t uv_flat;       /* with some, but without area in the texture */
    uint32_t uv_once;       /* with usable texture coordinates in one of the meshes only */
    uint32_t uv_changed;    /* with different ones: M contains the turn between them */
    uint32_t uv_mirrored;   /* clockwise in the texture: no fault */
    uint32_t inverted;      /* turned over against the triangles around them by the deformation */
    uint32_t
        points_without; /* points that only triangles without M touch, and vertices without triangle: M = 1 */
} mu_tension_counts;

typedef struct mu_tension_point {
    uint32_t vertex;   /* the first one at this place */
    uint32_t triangle; /* the first one that has it */
    double m[4];
} mu_tension_point;

typedef struct mu_tension {
    double *face;            /* 4 per triangle: M, two rows; one without takes the mean of its points */
    uint32_t *corner;        /* 3 per triangle: points */
    mu_tension_point *point; /* in order of first appearance */
    uint32_t points;
    uint32_t *vertex; /* per vertex: the first point at its place, UINT32_MAX where no triangle is */
    mu_tension_counts counts;
} mu_tension;

/* NULL: out of memory. */
mu_tension *mu_tension_make(const mu_tension_input *input);
void mu_tension_free(mu_tension *tension);

/* Within a triangle, at the barycentric coordinates (1 - u - v, u, v). Three equal matrices give the same one exactly. */
static inline void mu_tension_mix(const double *m0, const double *m1, const double *m2, double u, double v,
                                  double m[4]) {
    for (int k = 0; k < 4; k++) m[k] = m0[k] + u * (m1[k] - m0[k]) + v * (m2[k] - m0[k]);
}

#endif
