/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * walk.h: the edges of the baked mesh that a ray passes over.
 *
 * M takes the lattice point (i, j) to i e1 + j e2, with e1, e2 the columns of M: the baked vertices. A ray along w over
 * the point u e1 + v e2 of cell (0, 0) goes from triangle to triangle: it leaves one between the vertex A on its left
 * and B on its right, enters the next, whose third vertex is A + B - P if the last one's was P, and this vertex
 * replaces A or B, on whose side it is. Sides are cross products in the transformed plane; M^-1 appears nowhere.
 *
 * Over an edge the surface is a line between two heights, and between edges it is plane. So it stands above the ray
 * somewhere if and only if it does over one of these edges.
 */
#ifndef MU_WALK_H
#define MU_WALK_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "core/surface/heightfield.h"

/* An edge that the ray passes over; vertices in cells from the ray's own cell. */
typedef struct mu_crossing {
    int32_t left[2], right[2];
    double weight; /* of the right vertex; the left one has 1 - weight */
    double rise;   /* how far the ray has risen over its start */
} mu_crossing;

typedef struct mu_stepper {
    double e1[2], e2[2], from[2],
        along[2];       /* in the transformed plane; `along` has a largest component of 1 */
    double climb;       /* rise per unit of (q - from) . along, q the place */
    int32_t behind[2];  /* the third vertex of the triangle that the ray leaves next */
    mu_crossing edge;   /* where it leaves it */
    double left, right; /* how far the edge's ends are on either side; left >= 0 > right */
} mu_stepper;

/* Positive to the left of the ray. */
static inline double mu_stepper_side(const mu_stepper *s, const int32_t p[2]) {
    const double x = p[0] * s->e1[0] + p[1] * s->e2[0] - s->from[0];
    const double y = p[0] * s->e1[1] + p[1] * s->e2[1] - s->from[1];
    return s->along[0] * y - s->along[1] * x;
}

static inline void mu_stepper_meet(mu_stepper *s) {
    mu_crossing *const e = &s->edge;
    e->weight = s->left / (s->left - s->right);
    const double i = e->left[0] + e->weight * (e->right[0] - e->left[0]);
    const double j = e->left[1] + e->weight * (e->right[1] - e->left[1]);
    const double x = i * s->e1[0] + j * s->e2[0] - s->from[0], y = i * s->e1[1] + j * s->e2[1] - s->from[1];
    e->rise = s->climb * (x * s->along[0] + y * s->along[1]);
}

/*
 * Stands where the ray from (u, v), inside the lower or upper triangle of its cell, leaves that triangle along w. False
 * if it never does, w being vertical. w may have any length and go up or down. det M != 0.
 */
_Bool mu_stepper_begin(mu_stepper *s, const double m[4], const double w[3], double u, double v, int upper);

static inline void mu_stepper_next(mu_stepper *s) {
    mu_crossing *const e = &s->edge;
    const int32_t ahead[2] = {e->left[0] + e->right[0] - s->behind[0],
                              e->left[1] + e->right[1] - s->behind[1]};
    const double side = mu_stepper_side(s, ahead);
    int32_t *const replaced = side >= 0 ? e->left : e->right;
    s->behind[0] = replaced[0], s->behind[1] = replaced[1];
    replaced[0] = ahead[0], replaced[1] = ahead[1];
    if (side >= 0)
        s->left = side;
    else
        s->right = side;
    mu_stepper_meet(s);
}

typedef struct mu_walk {
    mu_crossing *crossings; /* by rising distance */
    size_t count;
} mu_walk;

typedef enum mu_walk_result { MU_WALK_OK, MU_WALK_TOO_LONG, MU_WALK_NO_MEMORY } mu_walk_result;

enum { MU_WALK_MOST = 1 << 23 }; /* crossings: 256 MB */

/*
 * All the crossings until the ray has risen by more than `range`, the surface's extent, but the first. That one is on
 * the border of the ray's own triangle, and a triangle that faces w lies below the rays that leave it: no ray can meet
 * its own triangle, whatever rounding does. Free with mu_walk_free.
 */
mu_walk_result mu_walk_make(mu_walk *walk, const double m[4], const double w[3], double u, double v,
                            int upper, double range);
void mu_walk_free(mu_walk *walk);

#endif
