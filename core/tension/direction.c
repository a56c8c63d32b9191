/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* direction.c: see direction.h. dp/du is along sign(det) (dv/ds2 p1 - dv/ds1 p2). */
#include "core/tension/direction.h"

#include <math.h>
#include <string.h>

#include "core/tension/face.h"

const double *mu_direction_uvs(const mu_tension_input *input, int chart) {
    if (mu_tension_rest_sign(chart)) return input->rest_uv;
    return mu_tension_deformed_sign(chart) ? input->deformed_uv : NULL;
}

/* Cosine and sine of x e1 + y e2 against e1. */
static void in_frame(const mu_shape *shape, const double xy[2], double direction[2]) {
    double t[3], side[3];
    const double size = sqrt(mu_shape_dot(shape->e1, shape->e1));
    mu_shape_along(shape, xy, t);
    mu_shape_cross(shape->n, shape->e1, side);
    direction[0] = mu_shape_dot(t, shape->e1) / size;
    direction[1] = mu_shape_dot(t, side) / size;
}

static _Bool normalise(double v[2]) {
    const double size = hypot(v[0], v[1]);
    if (!(size > 1e-6)) return 0;
    v[0] /= size, v[1] /= size;
    return 1;
}

/* The mean over the chart's triangles at the place; false if they cancel. */
static _Bool find_mean(const mu_ground *g, uint32_t point, const mu_plane *plane, double mean[2]) {
    mean[0] = mean[1] = 0;
    double weight = 0;
    for (uint32_t i = g->first[point]; i < g->first[point + 1]; i++) {
        const uint32_t corner = g->corner[i];
        const mu_part *part = &g->part[corner / 3];
        double turn[2];
        if (!mu_part_faces(part, plane->n)) continue;
        mu_site_turned(plane, part, turn);
        for (int k = 0; k < 2; k++) mean[k] += part->weight[corner % 3] * turn[k];
        weight += part->weight[corner % 3];
    }
    for (int k = 0; k < 2; k++) mean[k] /= weight;
    return weight > 0 && normalise(mean);
}

/* The largest sine of the last patch's directions against the mean, or one that is `enough`; 2 where u is anywhere. */
static double widest(const mu_ground *g, const mu_plane *plane, const double mean[2], double enough) {
    double most = 0;
    for (uint32_t i = 0; i < g->count && most < enough; i++) {
        double turn[2];
        mu_site_turned(plane, &g->part[g->face[i]], turn);
        if (!(turn[0] * mean[0] + turn[1] * mean[1] > 0)) return 2;
        most = fmax(most, fabs(mean[0] * turn[1] - mean[1] * turn[0]));
    }
    return most;
}

/* Turns `fitted` back to where triangles are at most, of two rings if need be. Sines have small angles exactly.
 * False: out of memory. */
static _Bool limit(mu_ground *g, uint32_t place, uint32_t point, const mu_plane *plane, const double mean[2],
                   double fitted[2]) {
    const double cosine = fitted[0] * mean[0] + fitted[1] * mean[1],
                 sine = mean[0] * fitted[1] - mean[1] * fitted[0], off = cosine > 0 ? fabs(sine) : 1.5;
    if (off <= widest(g, plane, mean, off)) return 1;
    if (!mu_patch_collect(g, place, plane->n, point, 2)) return 0;
    const double most = widest(g, plane, mean, off);
    if (off <= most) return 1;
    const double along = sqrt(fmax(0, 1 - most * most)), across = copysign(most, sine);
    fitted[0] = mean[0] * along - mean[1] * across;
    fitted[1] = mean[1] * along + mean[0] * across;
    return 1;
}

/* Slopes of v over the point's own chart, of degree 2, or 1. */
static _Bool find_slope(mu_ground *g, uint32_t point, uint32_t centre, const double *uvs, const mu_site *site,
                        double out[2], _Bool *found) {
    double slope[MU_QUADRIC_VALUES][2];
    mu_quadric fit;
    *found = 0;
    for (int rings = 1; rings <= 2 && !*found; rings++) {
        if (!mu_patch_collect(g, mu_ground_place(g, centre), site->plane.n, point, rings)) return 0;
        mu_quadric_fit(g, &site->plane, centre, uvs, &fit);
        *found = mu_quadric_slopes(&fit, 2, rings > 1 ? MU_QUADRIC_WIDE : MU_QUADRIC_NEAR, slope);
    }
    *found = *found || mu_quadric_slopes(&fit, 1, MU_QUADRIC_WIDE, slope);
    if (*found) memcpy(out, slope[MU_QUADRIC_V], 2 * sizeof *out);
    return 1;
}

_Bool mu_direction_find(mu_ground *g, uint32_t point, uint32_t centre, int chart, _Bool alone,
                        const mu_site *site, double direction[2]) {
    const double *uvs = mu_direction_uvs(g->in, chart);
    double slope[2] = {site->slope[0], site->slope[1]}, mean[2], xy[2];
    direction[0] = 1, direction[1] = 0;
    if (!site->flat) return 1; /* its frame is u's */
    if (!uvs && site->degree) {
        mu_shape_axis(&site->rest, xy);
        in_frame(&site->rest, xy, direction);
        return 1;
    }
    const _Bool meaning = find_mean(g, point, &site->plane, mean);
    if (meaning) memcpy(direction, mean, sizeof mean);
    if (!uvs || !site->degree) return 1;
    _Bool found = alone && site->degree == 2 && site->rings == 1; /* the last patch is still the site's */
    if (!found && !find_slope(g, point, centre, uvs, site, slope, &found)) return 0;
    const int sign =
        mu_tension_rest_sign(chart) ? mu_tension_rest_sign(chart) : mu_tension_deformed_sign(chart);
    xy[0] = sign * slope[1], xy[1] = -sign * slope[0];
    if (!found || !(fabs(xy[0]) + fabs(xy[1]) > 0)) return 1;
    in_frame(&site->rest, xy, direction);
    return !meaning || limit(g, mu_ground_place(g, centre), point, &site->plane, mean, direction);
}
