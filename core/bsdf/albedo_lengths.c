/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_lengths.c: the tails of albedo_lengths.h, by a walk along one azimuth of slopes in steps of ln t, short where the tail
 * falls fast, integrated by Simpson's rule. Not in the papers.
 *
 * They place nodes of a quadrature which weights them by the true density: they need not be exact, but smooth, so x between
 * them is a cubic of what lies beyond, with the true slopes at both ends.
 */
#include "core/bsdf/albedo_lengths.h"
#include "core/bsdf/albedo_slopes.h"

#if MU_REAL_BITS == 24

/* From so far below where slopes crowd to where a tail t^-0.2 has lost 1 - 2e-4 of itself, in ln t; steps; and at most by what
 * a step may change the reach. */
static const double below = 7, furthest = 41.5, widest = 0.25, least = 0.01, steepest = 0.3,
                    negligible = 1e-28;

/* P22 at the length t; of what is not isotropic, the mean over azimuths. */
static double density_at(const albedo_slopes *s, double t) {
    const int azimuths = s->c->kernel->traits & ANISOTROPIC ? 8 : 1;
    double sum = 0;
    for (int k = 0; k < azimuths; k++) {
        double unit[3];
        const double phi = 2 * PI * k / azimuths, p[2] = {t * cos(phi), t * sin(phi)};
        sum += albedo_slope_density(s, p, unit) / azimuths;
    }
    return sum;
}

static albedo_length length_at(const albedo_slopes *s, double x) {
    const double t = exp(x), mass = density_at(s, t) * t * t;
    return (albedo_length){.x = x, .mass = mass, .reach = mass * t};
}

void mu_albedo_lengths_of(const closure *c, double core, albedo_lengths *out) {
    const albedo_slopes s = albedo_slopes_of(c);
    double x = log(core) - below, step = widest, most = 0;
    int n = 0;
    while (n < ALBEDO_LENGTHS && x < furthest) {
        const albedo_length l = length_at(&s, x);
        if (n > 0 && l.reach < steepest * out->at[n - 1].reach && step > least) {
            step /= 2, x -= step;
            continue;
        }
        out->at[n++] = l;
        most = fmax(most, l.reach);
        if (l.reach < negligible * most) break;
        x += step;
    }
    out->count = n;
    for (int k = n - 2; k >= 0; k--) { /* by Simpson's rule */
        albedo_length *const l = &out->at[k], *const next = l + 1;
        const albedo_length middle = length_at(&s, (l->x + next->x) / 2);
        const double sixth = (next->x - l->x) / 6;
        l->beyond[0] = next->beyond[0] + sixth * (l->mass + 4 * middle.mass + next->mass);
        l->beyond[1] = next->beyond[1] + sixth * (l->reach + 4 * middle.reach + next->reach);
    }
}

static double mixed(const albedo_length *l, length_mix mix) {
    return mix.mass * l->beyond[0] + mix.reach * l->beyond[1];
}
static double rate_at(const albedo_length *l, length_mix mix) {
    return mix.mass * l->mass + mix.reach * l->reach;
}

double mu_albedo_beyond(const albedo_lengths *l, length_mix mix, double t, int *step) {
    const double x = t > 0 ? log(t) : -INFINITY;
    int low = 0, high = l->count - 1;
    *step = x > l->at[low].x ? high - 1 : 0;
    if (!(x > l->at[low].x)) return mixed(&l->at[low], mix);
    if (!(x < l->at[high].x)) return 0;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (l->at[middle].x > x)
            high = middle;
        else
            low = middle;
    }
    *step = low;
    const albedo_length *const a = &l->at[low], *const b = &l->at[high];
    const double width = b->x - a->x, y = (x - a->x) / width, from = mixed(a, mix), to = mixed(b, mix),
                 rise = to - from, r0 = -width * rate_at(a, mix), r1 = -width * rate_at(b, mix);
    return from + y * (r0 + y * (3 * rise - 2 * r0 - r1 + y * (r0 + r1 - 2 * rise)));
}

static inline double least_of(double a, double b) {
    return a < b ? a : b;
}

double mu_albedo_length(const albedo_lengths *l, length_mix mix, double beyond, int *step, double *rate) {
    int k = *step;
    while (k < l->count - 2 && mixed(&l->at[k + 1], mix) >= beyond) k++;
    const albedo_length *const a = &l->at[k], *const b = a + 1;
    const double width = b->x - a->x, from = mixed(a, mix), fall = from - mixed(b, mix);
    *step = k, *rate = 0;
    if (!(fall > 0)) return exp(a->x);
    /* at most thrice the chord: the cubic stays monotone (Fritsch & Carlson 1980) */
    const double over = 1 / fall, y = least_of(beyond < from ? (from - beyond) * over : 0, 1),
                 r0 = least_of(fall / rate_at(a, mix), 3 * width),
                 r1 = least_of(fall / rate_at(b, mix), 3 * width), bend = 3 * width - 2 * r0 - r1,
                 twist = r0 + r1 - 2 * width;
    const double slope = r0 + y * (2 * bend + 3 * y * twist);
    *rate = slope > 0 ? slope * over : 0;
    return exp(a->x + y * (r0 + y * (bend + y * twist)));
}

#endif
