/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * transformed.h: the BSDF of any distribution under any map (Section 4 of the paper: "a black box").
 *
 * A template: the including file has defined DISTRIBUTION, TRAITS and the functions that distribution.h lists.
 * With sigma(w) = cos(w) (1 + Lambda(w)) the projected area, and lambda = cos Lambda, both finite at the horizon,
 *     f             = F D / (4 (cos_i sigma_o + cos_o lambda_i))     height-correlated; shadowing.h has the other forms
 *     pdf           = D / (4 sigma_o)  by visible normals;           D cos_m / (4 wo.wm)  by D cos
 *     f cos_i / pdf = F cos_i sigma_o / (cos_i sigma_o + cos_o lambda_i) = F G2 / G1
 * none of which has a 0/0 at grazing. Directions are mapped by map_view, whose common factor view_z leaves the last line
 * alone and appears once in the first two.
 */
#include "core/bsdf/distribution.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/random.h"
#include "core/bsdf/shadowing.h"
#include "core/bsdf/snell.h"

static const real saturated = REAL_MAX;

/* +1, or -1 where M mirrors: only mutant 6 asks. */
static inline real orientation(const map *m) {
    return m->normal[0] * m->normal[3] < m->normal[1] * m->normal[2] ? R(-1) : R(1);
}

/* view_z sigma_M(v) and view_z lambda_M(v), Eq. (12): sigma_M(v) = |M^-1 v| sigma(M^-1 v / |M^-1 v|). */
static inline void view_of(plan_kind plan, const closure *c, const real v[3], real *sigma, real *lambda) {
    real w[3];
    const real raised = map_view(plan, &c->map, v, w), cosine = c->map.view_z * v[2];
    if (plan == PLAN_FULL && w[2] < 0) { /* the tilt shows the microsurface from below */
        const real up[3] = {-w[0], -w[1], -w[2]};
        *sigma = z_lambda(&c->surface->base, up);
        *lambda = *sigma - cosine;
        return;
    }
    const real away = z_lambda(&c->surface->base, w);
    *sigma = w[2] + away;
    *lambda = plan == PLAN_FULL ? raised + away : away;
}

/* D_M of a normal of squared length n2. */
static inline real transformed_density(plan_kind plan, const closure *c, const real n[3], real n2) {
    real u[3];
    map_normal(plan, &c->map, n, u);
    const real d = density(&c->surface->base, u, n2); /* Eq. (22) */
    const real wrong =
        MUTANT(3, square((flat_square(u) + u[2] * u[2]) / (n2 * square(c->map.normal_z))), R(1));
    return smaller(d * wrong, saturated) * MUTANT(6, orientation(&c->map), R(1));
}

/* What the flakes of this footprint make of D: 1 in the mean over footprints. */
static inline real glint(plan_kind plan, const closure *c, const real n[3], real n2) {
    return plan == PLAN_FULL && c->has_footprint ? MU(glint_count)(c, n, n2) : 1;
}

static inline void fresnel_of(const closure *c, real cosine, real F[3]) {
    F[0] = F[1] = F[2] = 1;
    if (c->surface->fresnel.kind) MU(fresnel_eval)(&c->surface->fresnel, c->eta, smaller(cosine, 1), F);
}

/* h = wo + wi of unit vectors is normal to their difference. Rounding has left them a little too long or short, which
 * turns a short h, of grazing forward scattering; |wo - wi| is 2 there. Not in the paper. Returns |h|². */
static real sharpen(const real wo[3], const real wi[3], real h[3], real h2) {
    const real apart[3] = {wo[0] - wi[0], wo[1] - wi[1], wo[2] - wi[2]};
    const real off = dot(h, apart) / (4 - h2);
    for (int k = 0; k < 3; k++) h[k] -= off * apart[k];
    return dot(h, h);
}

#include "core/bsdf/bounded.h"
#include "core/bsdf/folded.h"
#include "core/bsdf/reflection.h"
#include "core/bsdf/refraction.h"
#include "core/bsdf/sampling.h"

static inline void eval_of(plan_kind plan, const closure *c, const real wi[3], value *out) {
    if (TRAITS & IS_DELTA) {
        *out = (value){0};
        return;
    }
    if (plan != PLAN_FULL) {
        reflection_eval(plan, c, c->surface->sampler, wi, out);
        return;
    }
    real i[3];
    *out = (value){0};
    if (!closure_turn(c, wi, i))
        reflection_eval(plan, c, c->surface->sampler, i, out);
    else if (c->surface->transmission)
        refraction_eval(c, i, out);
}

#define KERNEL_NAME_(name) MU(mu_kernel_##name)
#define KERNEL_NAME(name)  KERNEL_NAME_(name)
#define STRING_(name)      #name
#define STRING(name)       STRING_(name)

/* The kernel's functions, compiled for one plan. */
#define FOR_PLANS(name, plan)                                                                                \
    static void view_##name(const closure *c, const real v[3], real *sigma, real *lambda) {                  \
        view_of(plan, c, v, sigma, lambda);                                                                  \
    }                                                                                                        \
    static real density_##name(const closure *c, const real m[3]) {                                          \
        return m[2] > 0 ? transformed_density(plan, c, m, dot(m, m)) : 0;                                    \
    }                                                                                                        \
    static real shadowing_##name(const closure *c, const real i[3], int transmitted) {                       \
        real sigma_i, lambda_i;                                                                              \
        view_of(plan, c, i, &sigma_i, &lambda_i);                                                            \
        return shadowing_of(plan, c, i, lambda_i, transmitted);                                              \
    }                                                                                                        \
    static void eval_##name(const closure *c, const real wi[3], value *out) {                                \
        eval_of(plan, c, wi, out);                                                                           \
    }                                                                                                        \
    static void sample_##name(const closure *c, mu_sampler sampler, const real u[3], sample *out) {          \
        sample_of(plan, c, sampler, u, out);                                                                 \
    }
FOR_PLANS(general, PLAN_GENERAL)
FOR_PLANS(uniform, PLAN_UNIFORM)
FOR_PLANS(full, PLAN_FULL)

static int normal_full(const closure *c, const real from[3], const real u[3], real m[3]) {
    real d;
    return draw_normal(PLAN_FULL, c, from, MU_SAMPLE_VISIBLE, u, m, &d);
}

static const kernel uniform, full, compensated, walk;

/* Multiple scattering, around the full plan. */
#define AROUND_FULL(name)                                                                                    \
    static void eval_##name(const closure *c, const real wi[3], value *out) {                                \
        MU(name##_eval)(&full, c, wi, out);                                                                  \
    }                                                                                                        \
    static void sample_##name(const closure *c, mu_sampler sampler, const real u[3], sample *out) {          \
        MU(name##_sample)(&full, c, sampler, u, out);                                                        \
    }
AROUND_FULL(compensated)
AROUND_FULL(walk)

extern const kernel KERNEL_NAME(DISTRIBUTION);
#define KERNEL(name, plan)                                                                                   \
    {                                                                                                        \
        STRING(DISTRIBUTION), {&KERNEL_NAME(DISTRIBUTION), &uniform, &full, &compensated, &walk}, TRAITS,    \
            table_bytes, prepare, view_##plan, normal_full, density_##plan, shadowing_##plan, eval_##name,   \
            sample_##name                                                                                    \
    }
static const kernel uniform = KERNEL(uniform, uniform), full = KERNEL(full, full),
                    compensated = KERNEL(compensated, full), walk = KERNEL(walk, full);
const kernel KERNEL_NAME(DISTRIBUTION) = KERNEL(general, general);
