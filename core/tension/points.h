/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* points.h: M of the points of charts, once all triangles have theirs: of a site (site.h), seen along u (direction.h). */
#ifndef MU_TENSION_POINTS_H
#define MU_TENSION_POINTS_H

#include "core/tension/patch.h"

typedef struct mu_chart_point {
    uint32_t corner; /* the first one that is it */
    int chart;
    _Bool has_m;         /* one of its triangles does */
    double weight;       /* of its triangles' corners: what its direction weighs among charts */
    double direction[2]; /* of u, in the frame of the site */
    double shared[2];    /* the same, once charts have agreed */
} mu_chart_point;

/* normals: 6 per place, the first three the sum of normals at rest. Fills m of the tension's points.
 * False: out of memory. */
_Bool mu_points_finish(mu_ground *ground, const double *normals, mu_chart_point *points, mu_tension *out);

#endif
