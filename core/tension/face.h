/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* face.h: M of one triangle, and what its corners weigh in the means. */
#ifndef MU_TENSION_FACE_H
#define MU_TENSION_FACE_H

#include "core/tension/shape.h"
#include "core/tension/tension.h"

typedef struct mu_tension_face {
    double m[4];
    double weight[3];                        /* area times angle at rest */
    double rest_n[3], deformed_n[3];         /* unit normals by winding; 0 without area */
    double rest_t[3];                        /* the u direction at rest, unit */
    double rest_angle[3], deformed_angle[3]; /* radians */
    int chart; /* 0 to 8, the orientations in both textures: corners with different ones are different points */
    _Bool usable; /* M exists */
} mu_tension_face;

/* The orientation in the textures, -1, 0 (none) or 1, that `chart` stands for. */
static inline int mu_tension_rest_sign(int chart) {
    return chart / 3 - 1;
}
static inline int mu_tension_deformed_sign(int chart) {
    return chart % 3 - 1;
}

/* The edges from corner 0; false without area. */
_Bool mu_tension_shape(const mu_tension_input *input, const double *position, uint32_t triangle,
                       mu_shape *shape);
/* Adds to the counts, all but `inverted` and `points_without`. */
mu_tension_face mu_tension_face_of(const mu_tension_input *input, uint32_t triangle,
                                   mu_tension_counts *counts);

#endif
