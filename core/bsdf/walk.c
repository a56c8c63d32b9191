/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * walk.c: multiple scattering by random walks on the Smith microsurface: Heitz, Hanika, d'Eon & Dachsbacher 2016,
 * "Multiple-scattering microfacet BSDFs with the Smith model", for any distribution under any map as a black box: all that
 * is asked for is sigma_M of a direction, D_M of a normal, and a normal seen from a direction. Conductors and dielectrics.
 *
 * A ray's place is its depth, ln C1(h) <= 0 with C1 the distribution function of heights, whatever that is: nothing else
 * enters. A ray along w meets facets whose area, seen against it, is sigma(-w) per unit of macrosurface, so that down and
 * up alike its depth changes by |w.z| / sigma(-w) times an exponential deviate until it meets one (their Eq. 14 to 16 in
 * these terms: exponent 1 + Lambda down, Lambda up); beyond 0 it has left. Each facet is one of the visible normals
 * from -w. Inside the dielectric everything is turned over, w to -w and C1 to 1 - C1.
 *
 * Not in the paper: tilt. Facets of mean slope t do not close: their normals add up to (-T, 1), T = M^-T t. What is
 * missing are cliffs of area |T| that face T/|T|: with them sigma(w) - sigma(-w) = w.z again, light is conserved and f
 * reciprocal. Cliffs are taken as diffuse, their albedo F averaged over the hemisphere, and they mask: single scattering
 * on a tilted surface is darker than that of refraction.h and reflection.h, which know of no cliffs.
 */
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
    random_stream random;
} walk;

static real cliffs_seen(const walk *p, const real from[3]) {
    return larger(p->cliff[0] * from[0] + p->cliff[1] * from[1], 0);
}

/* sigma, cliffs included. */
static real area_seen(const walk *p, const real from[3]) {
    real sigma, lambda;
    p->full->view(p->c, from, &sigma, &lambda);
    return larger(sigma / p->c->map.view_z, 0) + cliffs_seen(p, from);
}

static walk walk_start(const kernel *full, const closure *c, const multiple *with, random_stream random) {
    walk p = {.full = full, .c = c, .with = with, .weight = {1, 1, 1}, .random = random};
    const map *m = &c->map;
    map_mean(m, p.cliff);
    for (int k = 0; k < 2; k++) p.cliff[k] /= m->view_z;
    for (int k = 0; k < 3; k++) p.w[k] = -c->wo[k];
    p.steepness = hypot(p.cliff[0], p.cliff[1]);
    return p;
}

static real eta_of(const walk *p, int side) {
    return side ? 1 / p->c->eta : p->c->eta;
}

/* Averages are kept from above and below; `side` is relative to wo. */
static real average_of(const walk *p, int k) {
    const int transmits = p->c->surface->transmission;
    return p->with->average[transmits ? (p->c->side < 0) ^ p->side : k];
}

/* To the next facet; 0: there is none. `seen` is the area against the ray. */
static int advance(walk *p, real from[3], real *seen) {
    for (int k = 0; k < 3; k++) from[k] = -p->w[k];
    *seen = area_seen(p, from);
    if (!(*seen > 0)) return 0;
    const real step = -log(1 - random_next(&p->random)) * (p->w[2] / *seen);
    p->depth += step;
    return p->depth < 0 && *seen > 0;
}

/* The same place as seen from the other side: ln(1 - C1). */
static real turned_over(real depth) {
    return depth < -R(0.7) ? log1p(-exp(depth)) : log(larger(-expm1(depth), REAL_MIN));
}

/* Scatters the ray off a cliff: diffuse, about T. */
static void scatter_off_cliff(walk *p) {
    const real r2 = random_next(&p->random), phi = R(2 * PI) * random_next(&p->random);
    const real out = sqrt(1 - r2), along = sqrt(r2) * cos(phi), x = p->cliff[0] / p->steepness,
               y = p->cliff[1] / p->steepness;
    const real w[3] = {out * x - along * y, out * y + along * x, sqrt(r2) * sin(phi)};
    for (int k = 0; k < 3; k++) p->w[k] = w[k];
    if (!p->c->surface->transmission) {
        for (int k = 0; k < 3; k++) p->weight[k] *= average_of(p, k);
    } else if (random_next(&p->random) >= average_of(p, 0)) {
        p->side ^= 1, p->depth = turned_over(p->depth);
    }
}

/* Scatters it off a facet, whose normal is returned; 0 if there is none. */
static int scatter_off_facet(walk *p, const real from[3], real m[3]) {
    const real u[3] = {random_next(&p->random), random_next(&p->random), random_next(&p->random)};
    if (!p->full->normal(p->c, from, u, m)) return 0;
    const real facing = dot(from, m), eta = eta_of(p, p->side);
    if (!(facing > 0)) return 0;
    real F[3];
    MU(fresnel_eval)(&p->c->surface->fresnel, eta, smaller(facing, 1), F);
    if (p->c->surface->transmission && random_next(&p->random) >= F[0]) {
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
static int scatter(walk *p, const real from[3], real seen, real m[3]) {
    const real cliffs = cliffs_seen(p, from);
    if (cliffs > 0 && random_next(&p->random) * seen < cliffs) {
        scatter_off_cliff(p);
        return 2;
    }
    return scatter_off_facet(p, from, m);
}

void MU(walk_trace)(const kernel *full, const closure *c, const multiple *with, const real u[3],
                    walk_end *out) {
    walk p = walk_start(full, c, with, random_start(u));
    *out = (walk_end){.m = {0, 0, 1}};
    for (int bounce = 0; bounce <= WALK_BOUNCES; bounce++) {
        real from[3], m[3], seen;
        if (!advance(&p, from, &seen)) {
            if (!(p.w[2] > 0)) return;
            for (int k = 0; k < 3; k++) out->i[k] = p.w[k], out->weight[k] = p.weight[k];
            out->transmitted = p.side, out->bounces = bounce;
            return;
        }
        const int what = scatter(&p, from, seen, m);
        if (!what) return;
        for (int k = 0; k < 3 && bounce == 0 && what == 1; k++) out->m[k] = m[k];
    }
}

/* Toward i: the density of the facets at hand that send the ray there, 1/sr, with F or 1 - F. */
static void toward(const walk *p, const real from[3], real seen, const real i[3], int refracted, real F[3]) {
    const real eta = eta_of(p, p->side);
    refraction r = {.H = {from[0] + i[0], from[1] + i[1], from[2] + i[2]}};
    if (refracted)
        r = refraction_between(eta, from, i);
    else
        r.H2 = dot(r.H, r.H), r.o_H = dot(r.H, from);
    F[0] = F[1] = F[2] = 0;
    if (!(r.H[2] > 0 && r.H2 > 0 && r.o_H > 0)) return;
    const real length = sqrt(r.H2), m[3] = {r.H[0] / length, r.H[1] / length, r.H[2] / length};
    const real d = p->full->density(p->c, m) / seen,
               density = refracted ? refraction_spread(&r, d) * square(eta) : d / 4;
    MU(fresnel_eval)(&p->c->surface->fresnel, eta, smaller(r.o_H / length, 1), F);
    for (int k = 0; k < 3; k++) F[k] = smaller((refracted ? 1 - F[k] : F[k]) * density, REAL_MAX);
}

/* The same of the cliffs. */
static void add_cliffs(const walk *p, const real from[3], real seen, const real i[3], int refracted,
                       real f[3]) {
    const real there = cliffs_seen(p, from);
    if (!(there > 0)) return;
    const real d = there / seen * R(INV_PI) * cliffs_seen(p, i) / p->steepness;
    for (int k = 0; k < 3; k++) f[k] += d * (refracted ? 1 - average_of(p, k) : average_of(p, k));
}

static random_stream random_of(const closure *c, const multiple *with, const real wi[3]) {
    const uint64_t o = random_start(c->wo).state, i = random_start(wi).state;
    return (random_stream){mu_mix(o + MU_GOLDEN * with->salt + (c->side < 0)) ^ i};
}

void MU(walk_estimate)(const kernel *full, const closure *c, const multiple *with, const real wi[3],
                       int first, int last, real f[3]) {
    walk p = walk_start(full, c, with, random_of(c, with, wi));
    real i[3];
    const int target = closure_turn(c, wi, i);
    const real under[3] = {-i[0], -i[1], -i[2]};
    f[0] = f[1] = f[2] = 0;
    if (!(i[2] > 0)) return;
    const real Lambda = area_seen(&p, under) / i[2];
    for (int bounce = 1; bounce <= last; bounce++) {
        real from[3], seen, m[3], part[3];
        if (!advance(&p, from, &seen)) return;
        const int refracted = p.side != target;
        if (!refracted || c->surface->transmission) {
            const real open = exp((refracted ? turned_over(p.depth) : p.depth) * Lambda);
            if (bounce >= first) {
                toward(&p, from, seen, i, refracted, part);
            } else {
                part[0] = part[1] = part[2] = 0;
            }
            add_cliffs(&p, from, seen, i, refracted, part);
            for (int k = 0; k < 3; k++) f[k] += p.weight[k] * (open / i[2]) * part[k];
        }
        if (!scatter(&p, from, seen, m)) return;
    }
}
