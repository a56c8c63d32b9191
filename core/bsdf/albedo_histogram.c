/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_histogram.c: the directional albedo of single scattering of a slope histogram, where P22 has jumps and no rule for
 * smooth integrands converges. Not in the papers.
 *
 * The integral of albedo_quadrature.c over slopes p in slope units, by the points of a lattice that the inversion of the
 * histogram's sums (tabulated_draw.c), which takes its jumps away, makes slopes of: half of them with the density of the mass,
 * half with that of the mass times a bound of |L^-1 p| (tabulated.h), which follows the area that faces a grazing view, each
 * weighted by the balance heuristic (Veach & Guibas 1995). What is left under the sum is bounded, and jumps nowhere but from
 * row to row. The slopes are the same for all views: E is as smooth in the view as masking is.
 */
#include "core/bsdf/multiple.h"
#include "core/bsdf/tabulated.h"

#if MU_REAL_BITS == 24

void mu_albedo_slopes(const mu_surface_f *s, albedo_slope out[ALBEDO_SLOPES]) {
    const tabulated_grid *g = &((const tabulated *)s->base.table)->grid;
    double x[2] = {0.5, 0.5};
    for (int n = 0; n < ALBEDO_SLOPES; n++) {
        /* Kronecker's by powers of the plastic number (Roberts 2018, "The unreasonable effectiveness of quasirandom
         * sequences"); either half is a lattice of its own, shifted */
        x[0] = fmod(x[0] + 0.7548776662466927, 1), x[1] = fmod(x[1] + 0.5698402909980532, 1);
        const int far = n < ALBEDO_SLOPES / 2;
        const tabulated_place at = far ? mu_tabulated_draw(g, g->reach, g->reach_below, x[0], x[1])
                                       : mu_tabulated_draw(g, g->mass, g->mass_below, x[0], x[1]);
        const size_t i = at.row * (g->columns + 1) + at.column;
        const double reach = (g->reach[i + 1] - g->reach[i]) / (g->mass[i + 1] - g->mass[i]);
        out[n] = (albedo_slope){{at.p[0], at.p[1]}, 2 / (1 + reach / g->mean_reach) / ALBEDO_SLOPES};
    }
}

/* In facets, of 100 to 160 ns: a slope that nothing passes takes 5 ns, for no masking is sought; others 55, and 110 where light is
 * transmitted, too. */
static size_t work_of(const mu_closure_f *c, int slopes, int passing) {
    return (size_t)(passing * (c->surface->transmission ? 12 : 6) + slopes - passing) / 16;
}

float mu_albedo_of_slopes(const mu_closure_f *c, const albedo_slope slopes[ALBEDO_SLOPES], int begin,
                          int stride, albedo_effort *effort) {
    const double z = (double)c->map.view_z, v[4] = {(double)c->map.view[0] / z, (double)c->map.view[1] / z,
                                                    (double)c->map.view[2] / z, (double)c->map.view[3] / z};
    const double tilt[2] = {(double)c->map.tilt[0], (double)c->map.tilt[1]},
                 o[3] = {(double)c->wo[0], (double)c->wo[1], (double)c->wo[2]};
    double sum = 0, area = 0;
    int passing = 0;
    if (!(o[2] > 0)) return 1;
    for (int n = begin; n < ALBEDO_SLOPES; n += stride) {
        const double p[2] = {slopes[n].p[0] - tilt[0], slopes[n].p[1] - tilt[1]};
        const double m[3] = {v[0] * p[0] + v[2] * p[1], v[1] * p[0] + v[3] * p[1], 1};
        const double seen = o[0] * m[0] + o[1] * m[1] + o[2];
        if (!(seen > 0)) continue;
        const double length = sqrt(m[0] * m[0] + m[1] * m[1] + 1),
                     unit[3] = {m[0] / length, m[1] / length, 1 / length};
        const double passed = MU(albedo_passed)(c, unit, seen / length);
        passing += passed > 0;
        sum += slopes[n].weight * seen * passed;
        area += slopes[n].weight * seen;
    }
    effort->facets += work_of(c, (ALBEDO_SLOPES - begin + stride - 1) / stride, passing);
    /* the area is better known: of what hardly loses anything what these slopes are off of it must not count as lost */
    return area > 0 ? (float)fmin(sum / area * ((double)c->sigma / z / o[2]), 1) : 0;
}

#endif
