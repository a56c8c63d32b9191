/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * walks.c: the directional albedo of a random walk's surface (core/bsdf/walk.c), F included. Not in the papers.
 *
 * What leaves after one facet is no matter of chance: with A the area seen, cliffs included, A = (1 + Lambda) cos,
 *
 *     C = 1/cos_o  integral of (F D / 4 + cliffs) / (1 + Lambda_o + Lambda_i) dwi,
 *
 * along the lobe (even.c), or cell by cell of a histogram (cells.c). C' is the same for F = 1: 1 - C' of all light meets two facets or
 * more, and leaves as a share R of itself in the mean. That is told by walks, none of which decides by chance, either: after the first
 * facet and the second exp(depth Lambda) of its light leaves, which is added up, the rest is made to meet another one; only then is a walk
 * followed as it is. With Q what the first facet keeps and X what leaves in the end of what it keeps,
 *
 *     E = C + (1 - C') R,   R = mean of Q X / mean of Q,
 *
 * which is 1 where F is, however few the walks, and for all others has to know R alone, which varies little.
 *
 * Walks start from a lattice of rank 1 (Cools, Kuo & Nuyens 2006, "Constructing embedded lattice rules for multivariate integration"),
 * shifted SHIFTS times by vectors that are always the same, folded (1 - |2u - 1|) so that its sides join. Means of the shifts tell the
 * standard error. A view nearby is asked with the same numbers: no noise between them.
 */
#include "core/bsdf/walk_steps.h"
#include "core/ibl/cells.h"
#include "core/ibl/even.h"
#include "core/ibl/ibl.h"

#include "core/bsdf/real.h"

/* Facets after which light is made to meet another; numbers given, of two facets with cliffs; points of a lattice at first, and at most. */
enum { FORCED = 2, NUMBERS = 10, SHIFTS = 8, FIRST = 128, MOST = 1 << 14 };
static const uint32_t vector[NUMBERS] = {1, 182667, 469891, 498753, 110745, 446179, 250185, 118627, 245333, 283199};
/* The standard error that walks are asked for at least, a quarter of what an albedo may be off, 1e-3. */
#define ERROR 2.5e-4
/* A direction in float is rounded by 2^-25 of that. */
#define LEAST_SIGMA 1e-4
/* Directions asked for one facet, at most, and of cliffs. */
enum { DIRECTIONS = 1 << 12, OF_CLIFFS = 610 };

typedef struct asked {
    const closure *c;
    const multiple *with;
    walk start;
    double along; /* 1 + Lambda_o, cliffs included */
} asked;

static double lambda_of(const walk *p, const real i[3]) {
    return (double)(area_seen(p, (const real[3]){-i[0], -i[1], -i[2]}) / i[2]);
}

double MU(mu_ibl_walk_lambda)(const closure *c, const real i[3]) {
    const walk p = walk_start(c->kernel->plans[PLAN_FULL], c, multiple_of(c->surface), (random_stream){0});
    return lambda_of(&p, i);
}

/* Off one facet. */
static void toward(void *context, const double wi[3], double out[EVEN_PARTS]) {
    const asked *a = context;
    const real i[3] = {R(wi[0]), R(wi[1]), R(wi[2])}, *o = a->c->wo, h[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
    const real length = sqrt(dot(h, h)), m[3] = {h[0] / length, h[1] / length, h[2] / length};
    real F[EVEN_PARTS] = {1, 1, 1, 1};
    if (a->c->surface->fresnel.kind) MU(fresnel_eval)(&a->c->surface->fresnel, a->c->eta, smaller(dot(m, o), 1), F);
    const double d = (double)(a->start.full->density(a->c, m) / (4 * o[2])) / (a->along + lambda_of(&a->start, i));
    for (int k = 0; k < EVEN_PARTS; k++) out[k] = (double)F[k] * d;
}

/* Off one cliff. */
static void add_cliffs(const asked *a, double once[EVEN_PARTS]) {
    const walk *p = &a->start;
    const double seen = (double)cliffs_seen(p, a->c->wo) / (a->along * (double)a->c->wo[2]);
    if (!(seen > 0)) return;
    const mu_ibl_fibonacci lattice = mu_ibl_fibonacci_below(OF_CLIFFS);
    double mean = 0;
    for (uint32_t k = 0; k < lattice.count; k++) { /* about T, those that go up: a half of all */
        double u[2];
        mu_ibl_fibonacci_at(lattice, (const double[2]){0, 0}, k, u);
        const double out = sqrt(1 - u[0]), along = sqrt(u[0]) * cos(PI * u[1]), x = (double)(p->cliff[0] / p->steepness),
                     y = (double)(p->cliff[1] / p->steepness);
        const real i[3] = {R(out * x - along * y), R(out * y + along * x), R(sqrt(u[0]) * sin(PI * u[1]))};
        if (i[2] > 0) mean += a->along / (a->along + lambda_of(p, i)) / (2 * lattice.count);
    }
    for (int k = 0; k < EVEN_PARTS; k++) once[k] += seen * mean * (k < 3 ? (double)a->with->average[k] : 1);
}

/* Sigma under the closure's map. */
static mu_ibl_lobe_d lobe_of(const closure *c, const mu_ibl_slopes *still) {
    const double z = (double)c->map.view_z, unit = z * c->surface->unit;
    const real *v = c->map.view;
    const double a[4] = {(double)v[0] / unit, (double)v[2] / unit, (double)v[1] / unit, (double)v[3] / unit};
    real mean[2];
    map_mean(&c->map, mean);
    const double x[2] = {a[0] * still->xx + a[1] * still->xy, a[0] * still->xy + a[1] * still->yy},
                 y[2] = {a[2] * still->xx + a[3] * still->xy, a[2] * still->xy + a[3] * still->yy};
    return mu_ibl_lobe_of_d(&(mu_ibl_slopes){{(double)mean[0] / z, (double)mean[1] / z}, x[0] * a[0] + x[1] * a[1], x[0] * a[2] + x[1] * a[3], y[0] * a[2] + y[1] * a[3]});
}

/* 0: the lobe is too narrow for directions in float. */
static int leave_once(asked *a, const mu_ibl_slopes *still, double allowed, double once[EVEN_PARTS]) {
    if (a->c->kernel->traits & HAS_JUMPS) {
        MU(mu_ibl_cells_once)(a->c, a->along, allowed, once);
    } else {
        const mu_ibl_lobe_d lobe = lobe_of(a->c, still);
        mu_ibl_even even;
        if (!(lobe.sigma[1] > LEAST_SIGMA)) return 0;
        mu_ibl_even_make(&lobe, (const double[3]){(double)a->c->wo[0], (double)a->c->wo[1], (double)a->c->wo[2]}, &even);
        (void)mu_ibl_even_mean(&even, toward, a, allowed / 2, DIRECTIONS, once);
    }
    add_cliffs(a, once);
    return 1;
}

/* What leaves, of the ray as it is. */
static real leaving(const walk *p, real seen) {
    if (!(p->w[2] > 0)) return 0;
    return seen > 0 ? exp(p->depth * (seen / p->w[2])) : 1;
}

/* To the next facet, which but 1 - left of the light meets. */
static void meet(walk *p, real seen, real left) {
    p->depth -= log(1 - walk_next(p) * (1 - left)) * (p->w[2] / seen);
    p->depth = smaller(p->depth, -REAL_MIN);
}

/* Q X, and Q. */
static void follow(const asked *a, const real u[NUMBERS], double out[EVEN_PARTS]) {
    walk p = a->start;
    real from[3], m[3], seen;
    double rest = 1;
    p.given = u, p.given_end = u + NUMBERS, p.random = random_start(u);
    for (int k = 0; k < EVEN_PARTS; k++) out[k] = 0;
    if (!advance(&p, from, &seen) || !scatter(&p, from, seen, m)) return;
    for (int facets = 1; facets <= WALK_BOUNCES; facets++) {
        for (int k = 0; k < 3; k++) from[k] = -p.w[k];
        seen = area_seen(&p, from);
        const real left = leaving(&p, seen);
        const double part = facets > FORCED ? random_next(&p.random) < left : (double)left; /* of the rest, that is taken to leave */
        for (int k = 0; k < 3 && facets > 1; k++) out[k] += rest * part * (double)p.weight[k];
        rest *= 1 - part;
        if (facets == 1) out[3] = rest;
        if (!(part < 1) || !(seen > 0)) break;
        meet(&p, seen, left);
        if (!scatter(&p, from, seen, m)) break;
    }
}

/* The mean of the points first, first + step ... of a shifted lattice. */
static void take(const asked *a, uint32_t count, uint32_t first, uint32_t step, uint32_t shift, double mean[EVEN_PARTS]) {
    for (int k = 0; k < EVEN_PARTS; k++) mean[k] = 0;
    for (uint32_t i = first; i < count; i += step) {
        real u[NUMBERS];
        double one[EVEN_PARTS];
        for (uint32_t k = 0; k < NUMBERS; k++) {
            const uint32_t turn = (uint32_t)(mu_mix(MU_GOLDEN * (shift * NUMBERS + k + 1)) >> 32),
                           place = i * vector[k] * (uint32_t)(UINT64_C(0x100000000) / count) + turn;
            u[k] = smaller(R(1 - fabs(0x1p-31 * (double)place - 1)), 1 - REAL_EPSILON);
        }
        follow(a, u, one);
        for (int k = 0; k < EVEN_PARTS; k++) mean[k] += one[k] * step / count;
    }
}

/* R of all shifts; the largest of its standard errors. */
static double share_of(double by[SHIFTS][EVEN_PARTS], double share[3]) {
    double worst = 0, kept = 0;
    for (int s = 0; s < SHIFTS; s++) kept += by[s][3];
    for (int k = 0; k < 3; k++) {
        double square = 0;
        share[k] = 0;
        for (int s = 0; s < SHIFTS; s++) share[k] += kept > 0 ? by[s][k] / kept : 0;
        for (int s = 0; s < SHIFTS; s++) square += (by[s][k] - share[k] * by[s][3]) * (by[s][k] - share[k] * by[s][3]);
        worst = fmax(worst, square);
    }
    return kept > 0 ? sqrt(worst * SHIFTS / (SHIFTS - 1)) / kept : 0;
}

int MU(mu_ibl_albedo_of_walks)(const closure *c, const mu_ibl_slopes *still, double allowed, double rgb[3]) {
    if (c->kernel != c->kernel->plans[PLAN_WALK] || c->surface->transmission || !(c->wo[2] > 0)) return 0;
    asked a = {.c = c, .with = multiple_of(c->surface)};
    double by[SHIFTS][EVEN_PARTS], once[EVEN_PARTS], share[3];
    a.start = walk_start(c->kernel->plans[PLAN_FULL], c, a.with, (random_stream){0});
    a.along = (double)(area_seen(&a.start, c->wo) / c->wo[2]);
    if (!leave_once(&a, still, allowed, once)) return 0;
    const double more = fmax(1 - once[3], 0);
    for (uint32_t s = 0; s < SHIFTS; s++) take(&a, FIRST, 0, 1, s, by[s]);
    for (uint32_t count = FIRST; more * share_of(by, share) > fmax(allowed, ERROR) && count < MOST; count *= 2)
        for (uint32_t s = 0; s < SHIFTS; s++) {
            double next[EVEN_PARTS];
            take(&a, 2 * count, 1, 2, s, next);
            for (int k = 0; k < EVEN_PARTS; k++) by[s][k] = (by[s][k] + next[k]) / 2;
        }
    for (int k = 0; k < 3; k++) rgb[k] = once[k] + more * share[k];
    return 1;
}
