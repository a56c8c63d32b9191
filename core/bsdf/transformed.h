/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * transformed.h: the reflection BRDF of any distribution under any M (Section 4 of the paper: "a black box").
 *
 * A template: the including file has defined DISTRIBUTION and the functions that distribution.h lists.
 * With sigma(w) = cos(w) (1 + Lambda(w)) the projected area, and lambda = cos Lambda, both finite at the
 * horizon, f    = F D / (4 (cos_i sigma_o + cos_o lambda_i))     height-correlated G2 = 1 / (1 + Lambda_o +
 * Lambda_i) pdf  = D / (4 sigma_o)  by visible normals;           D cos_m / (4 wo.wm)  by D cos f cos_i / pdf
 * = F cos_i sigma_o / (cos_i sigma_o + cos_o lambda_i) = F G2 / G1 none of which has a 0/0 at grazing.
 * Directions are mapped by map_view, whose common factor view_z leaves the last line alone and appears once
 * in the first two.
 */
#include "core/bsdf/distribution.h"

static const real saturated = REAL_MAX;

/* +1, or -1 where M mirrors: only mutant 6 asks. */
static inline real orientation(const map *m) {
    return m->normal[0] * m->normal[3] < m->normal[1] * m->normal[2] ? R(-1) : R(1);
}

/* view_z lambda_M(v), Eq. (12): sigma_M(v) = |M^-1 v| sigma(M^-1 v / |M^-1 v|). */
static inline real view_lambda(map_kind kind, const closure *c, const real v[3]) {
    real w[3];
    map_view(kind, &c->map, v, w);
    const real r2 =
        smaller(w[0] * w[0] + w[1] * w[1], REAL_MAX / 16); /* M beyond linear_map.c's bounds saturates */
    return z_lambda(&c->surface->base, r2, w[2] * w[2], w[2]);
}

/* n2² D_M of a normal of squared length n2. */
static inline real transformed_density(map_kind kind, const closure *c, const real n[3], real n2) {
    real r2, z2;
    map_normal(kind, &c->map, n, &r2, &z2);
    const real d = density(&c->surface->base, r2, z2, n2); /* Eq. (22) */
    const real wrong = MUTANT(3, square((r2 + z2) / (n2 * square(c->map.normal_z))), R(1));
    return smaller(d * wrong, saturated) * MUTANT(6, orientation(&c->map), R(1));
}

/* cos_i / (cos_i sigma_o + cos_o lambda_i), or with 1 for cos_i. */
static inline real shadowing(const closure *c, real numerator, real cos_i, real lambda_i) {
    const real both = cos_i * c->sigma + c->wo[2] * lambda_i;
    return numerator / larger(MUTANT(4, cos_i * c->sigma, both), REAL_MIN);
}

/* h = wo + wi of unit vectors is normal to their difference. Rounding has left them a little too long or short, which
 * turns a short h, of grazing forward scattering; |wo - wi| is 2 there. Not in the paper. Returns |h|². */
static real sharpen(const real wo[3], const real wi[3], real h[3], real h2) {
    const real apart[3] = {wo[0] - wi[0], wo[1] - wi[1], wo[2] - wi[2]};
    const real off = (h[0] * apart[0] + h[1] * apart[1] + h[2] * apart[2]) / (4 - h2);
    for (int k = 0; k < 3; k++) h[k] -= off * apart[k];
    return h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
}

static inline void eval_of(map_kind kind, const closure *c, const real wi[3], value *out) {
    *out = (value){0};
    if (!(wi[2] > 0)) return;
    real h[3] = {c->wo[0] + wi[0], c->wo[1] + wi[1], c->wo[2] + wi[2]};
    real h2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    if (h2 < R(0.25)) h2 = sharpen(c->wo, wi, h, h2);
    const real sum2 = h2;
    for (int i = 0; h2 < R(1e-24) && i < 32; i++) { /* wi = -wo but for rounding: h² must not underflow */
        for (int k = 0; k < 3; k++) h[k] *= R(0x1p60);
        h2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    }
    const real quarter_d = transformed_density(kind, c, h, h2) / 4;
    const real lambda_i = view_lambda(kind, c, wi), scale = c->map.view_z;
    const real f =
        smaller(quarter_d * smaller(scale * shadowing(c, 1, wi[2], lambda_i), saturated), saturated);
    real F[3] = {1, 1, 1};
    if (c->surface->fresnel.kind) /* wo.wm = |h| / 2 */
        MU(fresnel_eval)(&c->surface->fresnel, smaller(sqrt(sum2) / 2, 1), F);
    for (int k = 0; k < 3; k++) out->f[k] = F[k] * f;
    const real sigma_i = scale * wi[2] + lambda_i;
    if (MUTANT(5, 1, c->surface->sampler == MU_SAMPLE_NDF)) {
        out->pdf = out->pdf_reverse =
            smaller(quarter_d * smaller(h[2] / (sqrt(h2) * sqrt(sum2) / 2), saturated), saturated);
    } else {
        out->pdf = smaller(quarter_d * (scale / larger(c->sigma, REAL_MIN)), saturated);
        out->pdf_reverse = smaller(quarter_d * (scale / larger(sigma_i, REAL_MIN)), saturated);
    }
}

static inline void sample_of(map_kind kind, const closure *c, mu_sampler sampler, const real u[3],
                             sample *out) {
    *out = (sample){.rejected = 1};
    real n[3];
    if (sampler == MU_SAMPLE_VISIBLE) {
        real w[3];
        map_view(kind, &c->map, c->wo, w);
        sample_visible(&c->surface->base, w, u, n); /* Eq. (28) */
    } else {
        sample_slope(&c->surface->base, u, n); /* Eq. (25) */
    }
    const real r2 = n[0] * n[0] + n[1] * n[1], z2 = n[2] * n[2];
    real m[3];
    map_normal_back(kind, &c->map, n, m); /* Eq. (26) */
    const real length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    if (!(length > 0)) return;
    for (int k = 0; k < 3; k++) out->wm[k] = m[k] /= length;
    const real cosine = m[0] * c->wo[0] + m[1] * c->wo[1] + m[2] * c->wo[2];
    real wi[3];
    for (int k = 0; k < 3; k++) wi[k] = 2 * cosine * m[k] - c->wo[k];
    if (!(cosine > 0 && wi[2] > 0)) return;
    const real unit = R(1) / sqrt(wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2]);
    for (int k = 0; k < 3; k++) out->wi[k] = wi[k] *= unit;

    /* D_M from the sampled normal itself, not from M^T m: exact however near to singular M is */
    const real stretch = length / (c->map.view_z * c->map.normal_z);
    const real d = smaller(density(&c->surface->base, r2, z2, stretch * stretch), saturated);
    const real lambda_i = view_lambda(kind, c, wi), scale = c->map.view_z, sigma_i = scale * wi[2] + lambda_i;
    const real ratio =
        smaller(shadowing(c, wi[2], wi[2], lambda_i) * MUTANT(8, c->wo[2] * scale, c->sigma), 1);
    real F[3] = {1, 1, 1};
    if (c->surface->fresnel.kind) MU(fresnel_eval)(&c->surface->fresnel, smaller(cosine, 1), F);
    const real f = smaller(d / 4 * smaller(scale * shadowing(c, 1, wi[2], lambda_i), saturated), saturated);
    real weight = ratio; /* F G2 / G1 */
    if (sampler == MU_SAMPLE_NDF) {
        out->pdf = out->pdf_reverse = smaller(d / 4 * (m[2] / cosine), saturated);
        weight = smaller(shadowing(c, wi[2], wi[2], lambda_i) * scale * (cosine / larger(m[2], REAL_MIN)),
                         saturated);
    } else {
        out->pdf = smaller(d / 4 * (scale / larger(c->sigma, REAL_MIN)), saturated);
        out->pdf_reverse = smaller(d / 4 * (scale / larger(sigma_i, REAL_MIN)), saturated);
    }
    for (int k = 0; k < 3; k++) out->f[k] = F[k] * f, out->weight[k] = F[k] * weight;
    out->rejected = 0;
}

#define KERNEL_NAME_(name) MU(mu_kernel_##name)
#define KERNEL_NAME(name)  KERNEL_NAME_(name)
#define STRING_(name)      #name
#define STRING(name)       STRING_(name)

/* The kernel's functions, compiled for one kind of map. */
#define FOR_MAPS(name, kind)                                                                                 \
    static real lambda_##name(const closure *c, const real v[3]) {                                           \
        return view_lambda(kind, c, v);                                                                      \
    }                                                                                                        \
    static real sigma_##name(const closure *c, const real v[3]) {                                            \
        return c->map.view_z * v[2] + view_lambda(kind, c, v);                                               \
    }                                                                                                        \
    static real density_##name(const closure *c, const real m[3]) {                                          \
        return m[2] > 0 ? transformed_density(kind, c, m, m[0] * m[0] + m[1] * m[1] + m[2] * m[2]) : 0;      \
    }                                                                                                        \
    static void eval_##name(const closure *c, const real wi[3], value *out) {                                \
        eval_of(kind, c, wi, out);                                                                           \
    }                                                                                                        \
    static void sample_##name(const closure *c, mu_sampler sampler, const real u[3], sample *out) {          \
        sample_of(kind, c, sampler, u, out);                                                                 \
    }
#define FUNCTIONS(name) lambda_##name, sigma_##name, density_##name, eval_##name, sample_##name

FOR_MAPS(general, MAP_GENERAL)
FOR_MAPS(uniform, MAP_UNIFORM)

static const kernel uniform = {STRING(DISTRIBUTION), NULL, table_bytes, prepare, FUNCTIONS(uniform)};
extern const kernel KERNEL_NAME(DISTRIBUTION);
const kernel KERNEL_NAME(DISTRIBUTION) = {STRING(DISTRIBUTION), &uniform, table_bytes, prepare,
                                          FUNCTIONS(general)};
