/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * distribution.h: what a normal distribution must say of itself, in its own space. It never hears of M.
 *
 * One file per distribution defines the functions below (static inline), then
 *     #define DISTRIBUTION name
 *     #include "core/bsdf/transformed.h"
 * which writes the whole BRDF under any M around them, without a call in between, and one row in surface.c.
 *
 * Slopes are measured in a unit that the distribution chooses (GGX and Beckmann: alpha itself, so that they
 * have no parameter left). Vectors are not normalised: a normal is given by r2 = x² + y² and z2 = z², a
 * direction likewise.
 *
 *   real density(const base *b, real r2, real z2, real n2)
 *       n2² times D of the unnormalised normal; D(k u) = k^-4 D(u). D = P22(r2/z2) / z2², 1/sr.
 *   real z_lambda(const base *b, real r2, real z2, real z)
 *       z Lambda of the unnormalised direction: sigma = z + z Lambda, finite where z = 0. Degree 1.
 *   void sample_slope(const base *b, const real u[3], real n[3])
 *       a normal by D cos, Eq. (25); any length.
 *   void sample_visible(const base *b, const real w[3], const real u[3], real n[3])
 *       a normal by the visible normals from w, Eq. (27); w and n of any length.
 *   double prepare(base *b, double alpha, double gamma, void *table)
 *       fills b and the table; returns the slope unit.
 *   size_t table_bytes(double alpha, double gamma)
 */
#ifndef MU_DISTRIBUTION_H
#define MU_DISTRIBUTION_H

#include "core/bsdf/linear_map.h"

enum { MU_SHAPE = 20 };

/* A prepared distribution. What `shape` holds is each one's own business. */
typedef struct MU(mu_base) {
    real shape[MU_SHAPE];
    const real *table;
} base;

/* A distribution with the generic transform compiled around it. */
struct MU(mu_kernel) {
    const char *name;
    const kernel *uniform; /* the same where M is a multiple of 1: it multiplies no matrix */
    size_t (*table_bytes)(double alpha, double gamma);
    double (*prepare)(base *b, double alpha, double gamma, void *table);
    real (*lambda)(const closure *c, const real w[3]); /* view_z cos Lambda_M */
    real (*sigma)(const closure *c, const real w[3]);  /* view_z sigma_M */
    real (*density)(const closure *c, const real wm[3]);
    void (*eval)(const closure *c, const real wi[3], value *out);
    void (*sample)(const closure *c, mu_sampler sampler, const real u[3], sample *out);
};

typedef struct MU(mu_fresnel) {
    mu_fresnel_kind kind;
    real a[3], b[3]; /* F0; or n and k; or a[0] = eta */
} fresnel;

/* F at the cosine between a direction and the micronormal (fresnel.c). */
void MU(fresnel_eval)(const fresnel *f, real cosine, real out[3]);

struct MU(mu_surface) {
    const kernel *kernel; /* of the definition's M, and of any M; NULL: a mirror */
    const kernel *general;
    base base;
    fresnel fresnel;
    mu_sampler sampler;
    real alpha;
    double unit; /* of slopes */
    map map;     /* of the definition's M */
    size_t table_bytes;
    const char *name;
};

#endif
