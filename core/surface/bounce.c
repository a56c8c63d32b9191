/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* bounce.c: closest hits by walking over edges, and mirrors one after the other. */
#include "core/surface/bounce.h"

#include <math.h>

#include "core/surface/walk.h"

mu_mirrors mu_mirrors_make(const mu_heightfield *f, const double m[4]) {
    mu_mirrors mirrors = {*f, {m[0], m[1], m[2], m[3]}, f->h[0]};
    for (size_t k = 0; k < mu_cells(f); k++) mirrors.high = fmax(mirrors.high, f->h[k]);
    return mirrors;
}

static uint32_t wrapped(int64_t i, uint32_t n) {
    const int64_t rest = i % (int64_t)n;
    return (uint32_t)(rest < 0 ? rest + n : rest);
}

/* How far a ray that began at height z is above the surface over an edge. */
static double gap(const mu_mirrors *mirrors, const mu_spot *spot, double z, const mu_crossing *e) {
    const uint32_t nx = mirrors->f.nx, ny = mirrors->f.ny;
    const double a = mirrors->f.h[(size_t)wrapped((int64_t)spot->i + e->left[0], nx) * ny +
                                  wrapped((int64_t)spot->j + e->left[1], ny)];
    const double b = mirrors->f.h[(size_t)wrapped((int64_t)spot->i + e->right[0], nx) * ny +
                                  wrapped((int64_t)spot->j + e->right[1], ny)];
    return z + e->rise - ((1 - e->weight) * a + e->weight * b);
}

static void place(const mu_crossing *e, double p[2]) {
    for (int k = 0; k < 2; k++) p[k] = e->left[k] + e->weight * (e->right[k] - e->left[k]);
}

/*
 * Into the triangle, by 1e-12 of a cell at least: a walk begins inside one. That is far more than the rounding of the
 * sides by which it chooses its way, some 1e-16 of a cell times the condition of M, and far less than matters.
 */
static void settle(mu_spot *spot) {
    const double least = 1e-12;
    double a = spot->upper ? 1 - spot->u : spot->u, b = spot->upper ? 1 - spot->v : spot->v;
    a = fmax(a, least), b = fmax(b, least);
    const double excess = a + b - (1 - least);
    if (excess > 0) {
        double *const larger = a > b ? &a : &b;
        *larger -= excess;
    }
    spot->u = spot->upper ? 1 - a : a;
    spot->v = spot->upper ? 1 - b : b;
}

/* The spot between two crossings of one triangle; s stands at the second. */
static void land(const mu_mirrors *mirrors, mu_spot *spot, const mu_stepper *s, const double from[2],
                 double share) {
    const int32_t *const corner[3] = {s->edge.left, s->edge.right, s->behind};
    double to[2], p[2];
    int32_t least[2], sum = 0;
    place(&s->edge, to);
    for (int k = 0; k < 2; k++) {
        p[k] = from[k] + share * (to[k] - from[k]);
        least[k] = corner[0][k];
        for (int c = 1; c < 3; c++) least[k] = corner[c][k] < least[k] ? corner[c][k] : least[k];
    }
    for (int c = 0; c < 3; c++) sum += corner[c][0] - least[0];
    *spot = (mu_spot){wrapped((int64_t)spot->i + least[0], mirrors->f.nx),
                      wrapped((int64_t)spot->j + least[1], mirrors->f.ny), sum == 2, p[0] - least[0],
                      p[1] - least[1]};
    settle(spot);
}

mu_ray_end mu_mirrors_cast(const mu_mirrors *mirrors, mu_spot *spot, const double d[3]) {
    const double z = mu_facet_height(&mirrors->f, spot->i, spot->j, spot->upper, spot->u, spot->v);
    mu_stepper s;
    /* Straight up there is nothing; nor within 1e-15 of it, where the way to the highest height is too short to cross an
     * edge unless the spot is that near to one. A facet sends nothing straight down. */
    if (fmax(fabs(d[0]), fabs(d[1])) < 1e-15 * fabs(d[2])) return d[2] > 0 ? MU_RAY_ESCAPES : MU_RAY_LOST;
    if (!mu_stepper_begin(&s, mirrors->m, d, spot->u, spot->v, spot->upper)) return MU_RAY_LOST;
    double before = fmax(0, gap(mirrors, spot, z, &s.edge)); /* its own facet lies below the ray */
    for (size_t steps = 0; !(d[2] >= 0 && z + s.edge.rise > mirrors->high); steps++) {
        if (steps > MU_WALK_MOST) return MU_RAY_LOST;
        const mu_crossing entry = s.edge;
        mu_stepper_next(&s);
        const double after = gap(mirrors, spot, z, &s.edge);
        if (after < 0) {
            double from[2];
            place(&entry, from);
            land(mirrors, spot, &s, from, before / (before - after));
            return MU_RAY_HITS;
        }
        before = after;
    }
    return MU_RAY_ESCAPES;
}

static void unit_normal(const mu_mirrors *mirrors, const mu_spot *spot, double normal[3]) {
    double slope[2];
    mu_facet_slope(&mirrors->f, spot->i, spot->j, spot->upper, slope);
    mu_facet_normal(mirrors->m, slope, normal);
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int k = 0; k < 3; k++) normal[k] /= length;
}

void mu_mirror_follow(const mu_mirrors *mirrors, const mu_spot *start, const double v[3], uint32_t most,
                      mu_mirror_path *path) {
    mu_spot spot = *start;
    double d[3] = {-v[0], -v[1], -v[2]}, normal[3];
    path->end = MU_PATH_OVER_LIMIT;
    for (path->count = 0; path->count < most;) {
        unit_normal(mirrors, &spot, normal);
        const double cosine = fmax(0, -(d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2]));
        for (int k = 0; k < 3; k++) path->out[k] = d[k] += 2 * cosine * normal[k];
        path->cosine[path->count++] = fmin(cosine, 1);
        const mu_ray_end end = mu_mirrors_cast(mirrors, &spot, d);
        if (end == MU_RAY_HITS) continue;
        path->end = end == MU_RAY_ESCAPES ? MU_PATH_ESCAPED : MU_PATH_LOST;
        return;
    }
}
