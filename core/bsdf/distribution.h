/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * distribution.h: what a normal distribution must say of itself, in its own space. It never hears of M, of tilt, of
 * masking forms or of refraction.
 *
 * One file per distribution defines the functions below (static inline), then
 *     #define DISTRIBUTION name
 *     #include "core/bsdf/transformed.h"
 * which writes the whole BSDF under any map around them, without a call in between, and one row in surface.c.
 *
 * Slopes are measured in a unit that the distribution chooses (GGX and Beckmann: alpha itself, so that they
 * have no parameter left). Its mean slope is 0. Vectors are not normalised.
 *
 *   real density(const base *b, const real u[3], real n2)
 *       n2² times D of the unnormalised normal; D(k u) = k^-4 D(u). D = P22(slope) / u.z^4, 1/sr. u.z >= 0.
 *   real z_lambda(const base *b, const real w[3])
 *       z Lambda of the unnormalised direction, w.z >= 0: the area that faces away, sigma(-w) = sigma(w) - w.z;
 *       finite where w.z = 0. Degree 1.
 *   void sample_slope(const base *b, const real u[3], real n[3])
 *       a normal by D cos, Eq. (25); any length.
 *   void sample_visible(const base *b, const real w[3], const real u[3], real n[3])
 *       a normal by the visible normals from w, Eq. (27); w and n of any length, w.z of any sign.
 *       Below the horizon a loop of rejection may need 1/sigma(w) tries; it is met as seldom, so that its mean cost is
 *       bounded still: FROM_BELOW tries.
 *   size_t table_bytes(const mu_definition *d)
 *   double prepare(base *b, const mu_definition *d, void *table)
 *       fills b and the table; returns the slope unit.
 *   TRAITS: a constant, OR of the bits below.
 */
#ifndef MU_DISTRIBUTION_H
#define MU_DISTRIBUTION_H

#include "core/bsdf/flakes.h"
#include "core/bsdf/linear_map.h"

enum { MU_SHAPE = 20, FROM_BELOW = 65536 };

enum {
    PICKS = 1,       /* sample_visible uses u[2] */
    ANISOTROPIC = 2, /* turning the microsurface changes it */
    IS_UNIT_GGX = 4, /* may be sampled within a bound, bounded.h */
    IS_DELTA = 8,    /* one normal: directions have probabilities, not densities */
    HAS_JUMPS = 16   /* a histogram: no rule for smooth integrands converges on its P22 */
};

/* A prepared distribution. What `shape` holds is each one's own business. */
typedef struct MU(mu_base) {
    real shape[MU_SHAPE];
    const void *table;
} base;

/* x² + y², which saturates rather than overflow. */
static inline real flat_square(const real u[3]) {
    return smaller(u[0] * u[0] + u[1] * u[1], REAL_MAX / 16);
}

/* ln(1 + p/q) of positive p and q, also where the quotient overflows. */
static inline real log1p_ratio(real p, real q) {
    const real quotient = p / q;
    return quotient <= REAL_MAX ? log1p(quotient) : log(p) - log(q);
}

/* A distribution with the generic transform compiled around it, for one plan (linear_map.h). */
struct MU(mu_kernel) {
    const char *name;
    const kernel *plans[PLAN_COUNT]; /* this distribution's kernels */
    unsigned traits;
    size_t (*table_bytes)(const mu_definition *d);
    double (*prepare)(base *b, const mu_definition *d, void *table);
    void (*view)(const closure *c, const real w[3], real *sigma,
                 real *lambda); /* view_z sigma_M, view_z cos Lambda_M */
    /* a unit normal by the visible normals from any direction, also from below; 0 if there is none */
    int (*normal)(const closure *c, const real from[3], const real u[3], real m[3]);
    real (*density)(const closure *c, const real wm[3]);
    real (*shadowing)(const closure *c, const real i[3], int transmitted); /* G2 */
    void (*eval)(const closure *c, const real wi[3], value *out);
    void (*sample)(const closure *c, mu_sampler sampler, const real u[3], sample *out);
};

typedef struct MU(mu_fresnel) {
    mu_fresnel_kind kind;
    real a[3], b[3]; /* F0; or n and k; or a[0] = eta */
} fresnel;

/* F at the cosine between a direction and the micronormal (fresnel.c). `eta` is n_transmitted/n_incident of a
 * dielectric from this side. */
void MU(fresnel_eval)(const fresnel *f, real eta, real cosine, real out[3]);
real MU(fresnel_dielectric)(real eta, real cosine);
real MU(fresnel_between)(real eta, real cosine, real g);

/* Does it draw from all normals, by D cos, rather than from visible ones? */
static inline int draws_all(mu_sampler sampler) {
    return sampler == MU_SAMPLE_NDF || sampler == MU_SAMPLE_MIXED;
}

/* Does it draw some directions uniformly? */
static inline int mixes(mu_sampler sampler) {
    return sampler == MU_SAMPLE_MIXED || sampler == MU_SAMPLE_VISIBLE_UNIFORM ||
           sampler == MU_SAMPLE_FOLDED_UNIFORM;
}

/* Does it turn up what falls below the horizon? */
static inline int folds(mu_sampler sampler) {
    return sampler == MU_SAMPLE_FOLDED || sampler == MU_SAMPLE_FOLDED_UNIFORM;
}

/* wi as seen from the side that it is on, i.z >= 0: turned over with wo, and again if it is on the other side than wo; then
 * 1 is returned. */
static inline int closure_turn(const closure *c, const real wi[3], real i[3]) {
    const int transmitted = c->side * wi[2] < 0;
    const real turn = transmitted ? -c->side : c->side;
    for (int k = 0; k < 3; k++) i[k] = turn * wi[k];
    return transmitted;
}

/* What radiance is of importance: refraction spreads and narrows it by n² (Veach 1997, Section 5.2). */
static inline real closure_transport(const closure *c, int transmitted) {
    return transmitted && !c->importance ? 1 / square(c->eta) : 1;
}

/* K / E[K] of the flakes in the closure's footprint around the normal n, of squared length n2 (glint.c). */
real MU(glint_count)(const closure *c, const real n[3], real n2);

struct MU(mu_surface) {
    const kernel *kernel; /* of the definition's M, and of any M */
    const kernel *general;
    base base;
    fresnel fresnel;
    mu_sampler sampler;
    mu_masking_form masking;
    int transmission;
    int is_delta;    /* the distribution's trait */
    int compensated; /* keeps tables of what it loses: a mirror has none */
    real alpha;
    real uniform_share; /* of the samplers that mix with uniform directions */
    double unit;        /* of slopes */
    double tilt[2];
    map map; /* of the definition's M */
    size_t table_bytes;
    const char *name;
    mu_flake_cdf *flake_cdf; /* NULL: not discrete */
    double flake_cone;
    mu_flakes flakes;
};

#endif
