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
#include "core/bsdf/walk_steps.h"

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
