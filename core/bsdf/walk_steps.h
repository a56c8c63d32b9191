/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * walk_steps.h: one step of a random walk on the microsurface (walk.c says which), to the next facet and off it. Its random numbers
 * are those that are given, as long as there are any, and then a stream's.
 */
#ifndef MU_WALK_STEPS_H
#define MU_WALK_STEPS_H

#include "core/bsdf/multiple.h"
#include "core/bsdf/random.h"
#include "core/bsdf/snell.h"

typedef struct walk {
    const kernel *full;
    const closure *c;
    const multiple *with;
    real cliff[2], steepness; /* T, |T| */
    real w[3];                /* of the ray, turned over with the side */
    real depth;
    int side; /* 0: that of wo */
    real weight[3];
    const real *given, *given_end;
    random_stream random;
} walk;

static inline real walk_next(walk *p) {
    return p->given < p->given_end ? *p->given++ : random_next(&p->random);
}

static inline real cliffs_seen(const walk *p, const real from[3]) {
    return larger(p->cliff[0] * from[0] + p->cliff[1] * from[1], 0);
}

/* sigma, cliffs included. */
static inline real area_seen(const walk *p, const real from[3]) {
    real sigma, lambda;
    p->full->view(p->c, from, &sigma, &lambda);
    return larger(sigma / p->c->map.view_z, 0) + cliffs_seen(p, from);
}

static inline walk walk_start(const kernel *full, const closure *c, const multiple *with, random_stream random) {
    walk p = {.full = full, .c = c, .with = with, .weight = {1, 1, 1}, .random = random};
    const map *m = &c->map;
    map_mean(m, p.cliff);
    for (int k = 0; k < 2; k++) p.cliff[k] /= m->view_z;
    for (int k = 0; k < 3; k++) p.w[k] = -c->wo[k];
    p.steepness = hypot(p.cliff[0], p.cliff[1]);
    return p;
}

static inline real eta_of(const walk *p, int side) {
    return side ? 1 / p->c->eta : p->c->eta;
}

/* Averages are kept from above and below; `side` is relative to wo. */
static inline real average_of(const walk *p, int k) {
    const int transmits = p->c->surface->transmission;
    return p->with->average[transmits ? (p->c->side < 0) ^ p->side : k];
}

/* To the next facet; 0: there is none. `seen` is the area against the ray. */
static inline int advance(walk *p, real from[3], real *seen) {
    for (int k = 0; k < 3; k++) from[k] = -p->w[k];
    *seen = area_seen(p, from);
    if (!(*seen > 0)) return 0;
    const real step = -log(1 - walk_next(p)) * (p->w[2] / *seen);
    p->depth += step;
    return p->depth < 0 && *seen > 0;
}

/* The same place as seen from the other side: ln(1 - C1). */
static inline real turned_over(real depth) {
    return depth < -R(0.7) ? log1p(-exp(depth)) : log(larger(-expm1(depth), REAL_MIN));
}

/* Scatters the ray off a cliff: diffuse, about T. */
static inline void scatter_off_cliff(walk *p) {
    const real r2 = walk_next(p), phi = R(2 * PI) * walk_next(p);
    const real out = sqrt(1 - r2), along = sqrt(r2) * cos(phi), x = p->cliff[0] / p->steepness,
               y = p->cliff[1] / p->steepness;
    const real w[3] = {out * x - along * y, out * y + along * x, sqrt(r2) * sin(phi)};
    for (int k = 0; k < 3; k++) p->w[k] = w[k];
    if (!p->c->surface->transmission) {
        for (int k = 0; k < 3; k++) p->weight[k] *= average_of(p, k);
    } else if (walk_next(p) >= average_of(p, 0)) {
        p->side ^= 1, p->depth = turned_over(p->depth);
    }
}

/* Scatters it off a facet, whose normal is returned; 0 if there is none. */
static inline int scatter_off_facet(walk *p, const real from[3], real m[3]) {
    const real u[3] = {walk_next(p), walk_next(p), walk_next(p)};
    if (!p->full->normal(p->c, from, u, m)) return 0;
    const real facing = dot(from, m), eta = eta_of(p, p->side);
    if (!(facing > 0)) return 0;
    real F[3];
    MU(fresnel_eval)(&p->c->surface->fresnel, eta, smaller(facing, 1), F);
    if (p->c->surface->transmission && walk_next(p) >= F[0]) {
        (void)refract(eta, from, m, facing, p->w); /* turned over */
        p->side ^= 1, p->depth = turned_over(p->depth);
        return p->w[2] != 0 || p->w[0] != 0 || p->w[1] != 0;
    }
    for (int k = 0; k < 3; k++) {
        p->w[k] = 2 * facing * m[k] - from[k];
        if (!p->c->surface->transmission) p->weight[k] *= F[k];
    }
    const real length = sqrt(dot(p->w, p->w));
    for (int k = 0; k < 3; k++) p->w[k] /= length;
    return 1;
}

/* 1: off a facet, 2: off a cliff. */
static inline int scatter(walk *p, const real from[3], real seen, real m[3]) {
    const real cliffs = cliffs_seen(p, from);
    if (cliffs > 0 && walk_next(p) * seen < cliffs) {
        scatter_off_cliff(p);
        return 2;
    }
    return scatter_off_facet(p, from, m);
}

#endif
