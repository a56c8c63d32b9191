/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_parse_shape.c: the microsurface of a material: which distribution, how rough, and the linear map M that deforms
 * it. M = transform * stretch * anisotropy: what stands last acts first. Varying, transform comes from slots.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "plugin/musurf_given.h"

/* The core's distributions by the order of the choices. */
static const mu_ndf ndf_of[] = {
    MU_GGX,          MU_BECKMANN,         MU_GTR, MU_STD, MU_PHONG, MU_SHEEN, MU_FLAT, MU_GGX, MU_TABULATED,
    MU_DISCRETE_GGX, MU_DISCRETE_BECKMANN};
enum { ELLIPSOID = 7 };

/* The first of these that is set, to something other than 0; or 0. */
static int any(const given *g, const uint32_t *ids) {
    for (; *ids; ids++) {
        const musurf_setting *s = g->by_id[*ids];
        if (musurf_varies(g, *ids)) return (int)*ids;
        if (s && !(*ids == TILT || *ids >= THETA_X || *ids == ROTATION)) return (int)*ids;
        if (s && (s->values[0] != 0 || (*ids == TILT && s->values[1] != 0))) return (int)*ids;
    }
    return 0;
}

static musurf_result misplaced(const given *g, int id, const char *why) {
    return musurf_fail(g->host, MUSURF_INVALID, (uint32_t)id, "%s", why);
}

/* What only some distributions have: an error where it is set, other than to its default, for one that would ignore it. */
static musurf_result refuse_unused(const given *g, mu_ndf ndf) {
    static const struct {
        uint32_t id;
        mu_ndf of[2];
        const char *why;
    } own[] = {
        {GAMMA, {MU_GTR, MU_STD}, "belongs to ndf \"gtr\" and \"std\", whose tail it is, but ndf is another"},
        {EXPONENT, {MU_PHONG, MU_PHONG}, "belongs to ndf \"phong\", but ndf is another"}};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
        if (ndf != own[i].of[0] && ndf != own[i].of[1] && musurf_differs(g, own[i].id))
            return misplaced(g, (int)own[i].id, own[i].why);
    static const uint32_t rough[] = {ALPHA, ROUGHNESS, ALPHA_X, ALPHA_Y};
    for (size_t i = 0; i < sizeof rough / sizeof rough[0]; i++)
        if (ndf == MU_FLAT && musurf_differs(g, rough[i]))
            return misplaced(g, (int)rough[i], "belongs to ndf of some roughness, but \"flat\" has none");
    return MUSURF_OK;
}

static musurf_result parse_alpha(const given *g, mu_definition *d) {
    if (g->by_id[ALPHA] && g->by_id[ROUGHNESS])
        return misplaced(g, ROUGHNESS, "set alpha or roughness (alpha is roughness squared), not both");
    d->alpha = g->by_id[ROUGHNESS] ? pow(musurf_number(g, ROUGHNESS), 2) : musurf_number(g, ALPHA);
    if (g->by_id[ROUGHNESS] && musurf_number(g, ROUGHNESS) > 0 && d->alpha == 0) d->alpha = DBL_TRUE_MIN;
    d->gamma = musurf_number(g, GAMMA);
    d->exponent = musurf_number(g, EXPONENT);
    musurf_numbers(g, TILT, 2, d->tilt);
    return MUSURF_OK;
}

/* Seed 001: A, or roughness along the axes and three angles. Writes the ellipsoid's own map under `outer`. */
static musurf_result parse_ellipsoid(const given *g, mu_definition *d, const double outer[4], double m[4]) {
    const int foreign = any(g, (const uint32_t[]){ROTATION, DISNEY, CYCLES, OPENPBR, GLTF, COVARIANCE, 0});
    if (foreign)
        return misplaced(g, foreign, "an ellipsoid has alpha_x, alpha_y, theta_x, theta_y, theta_z, or A");
    double A[9];
    if (g->by_id[A_MATRIX]) {
        const int twice =
            any(g, (const uint32_t[]){ALPHA, ROUGHNESS, ALPHA_X, ALPHA_Y, THETA_X, THETA_Y, THETA_Z, 0});
        if (twice) return misplaced(g, twice, "A says all of an ellipsoid already");
        musurf_numbers(g, A_MATRIX, 9, A);
    } else {
        const double alpha[2] = {g->by_id[ALPHA_X] ? musurf_number(g, ALPHA_X) : d->alpha,
                                 g->by_id[ALPHA_Y] ? musurf_number(g, ALPHA_Y) : d->alpha};
        const double theta[3] = {musurf_number(g, THETA_X), musurf_number(g, THETA_Y),
                                 musurf_number(g, THETA_Z)};
        mu_ellipsoid_matrix(alpha, theta, A);
    }
    d->ndf = MU_GGX, d->alpha = 1;
    if (mu_ellipsoid_under(A, outer, m, d->tilt)) return MUSURF_OK;
    return misplaced(
        g,
        g->by_id[A_MATRIX]  ? A_MATRIX
        : g->by_id[ALPHA_X] ? ALPHA_X
                            : ALPHA,
        "makes a singular A: an ellipsoid has three axes, and no normal of the surface lies in its plane");
}

/* The histogram, which stays with the host: it is read while the surface is made. */
static musurf_result parse_histogram(const given *g, mu_definition *d) {
    const musurf_setting *s = g->by_id[HISTOGRAM];
    if (d->ndf != MU_TABULATED)
        return s ? misplaced(g, HISTOGRAM, "belongs to ndf \"tabulated\", but ndf is another") : MUSURF_OK;
    if (!s) return misplaced(g, NDF, "\"tabulated\" needs a histogram");
    const int foreign = any(g, (const uint32_t[]){ALPHA, ROUGHNESS, ALPHA_X, ALPHA_Y, GLTF, COVARIANCE, 0});
    if (foreign)
        return misplaced(g, foreign, "has no meaning here: the histogram tells how rough the surface is");
    d->histogram_columns = (size_t)s->values[0], d->histogram_rows = (size_t)s->values[1];
    memcpy(d->histogram_bounds, s->values + 2, sizeof d->histogram_bounds);
    d->histogram = s->values + 6;
    return MUSURF_OK;
}

/* alpha_x, alpha_y, or the anisotropy of another system (musurf.h), turned by rotation. */
static musurf_result parse_anisotropy(const given *g, mu_definition *d, double m[4]) {
    const int foreign = any(g, (const uint32_t[]){A_MATRIX, THETA_X, THETA_Y, THETA_Z, 0});
    if (foreign) return misplaced(g, foreign, "belongs to the ellipsoid, but ndf is another");
    const double rotation = musurf_number(g, ROTATION);
    const int along = any(g, (const uint32_t[]){ALPHA_X, ALPHA_Y, 0});
    int system = musurf_choice(g, ANISOTROPY), named = g->by_id[ANISOTROPY] != NULL;
    for (uint32_t id = DISNEY; id <= COVARIANCE; id++) {
        if (!g->by_id[id]) continue;
        if (named && system != (int)(id - DISNEY) + 1)
            return misplaced(g, (int)id, "is the anisotropy of one system, but another one is set");
        system = (int)(id - DISNEY) + 1, named = 1;
    }
    if (along && system) return misplaced(g, along, "set alpha_x and alpha_y, or anisotropy, not both");
    if (along) {
        const int roughness = any(g, (const uint32_t[]){ALPHA, ROUGHNESS, 0});
        double x = musurf_number(g, g->by_id[ALPHA_X] ? ALPHA_X : ALPHA_Y),
               y = musurf_number(g, g->by_id[ALPHA_Y] ? ALPHA_Y : ALPHA_X);
        if (roughness) x = g->by_id[ALPHA_X] ? x : d->alpha, y = g->by_id[ALPHA_Y] ? y : d->alpha;
        double base = roughness ? d->alpha : sqrt(x) * sqrt(y);
        if (d->ndf == MU_PHONG) base = mu_slope_width(d); /* its own slope roughness */
        if (d->ndf != MU_PHONG) d->alpha = base;
        if (mu_transform_alphas(base, x, y, rotation, m)) return MUSURF_OK;
        return musurf_fail(g->host, MUSURF_INVALID, (uint32_t)along,
                           "alpha_x %.9g and alpha_y %.9g with alpha %.9g: all three above 0, or all 0", x, y,
                           base);
    }
    const double amount = system >= 1 && system <= 4 ? musurf_number(g, DISNEY + (uint32_t)system - 1) : 0;
    double c[4];
    musurf_numbers(g, COVARIANCE, 4, c);
    int good = 1;
    switch (system) {
    case 1:
        good = mu_transform_disney(amount, rotation, m);
        break;
    case 2:
        good = mu_transform_cycles(amount, rotation, m);
        break;
    case 3:
        good = mu_transform_openpbr(amount, rotation, m);
        break;
    case 4:
        if (d->alpha > 1) return misplaced(g, GLTF, "is defined for alpha in [0, 1]");
        good = mu_transform_gltf(d->alpha, amount, rotation, m);
        break;
    case 5:
        if (c[1] != c[2]) return misplaced(g, COVARIANCE, "a covariance is symmetric: [[xx, xy], [xy, yy]]");
        good = mu_transform_covariance(d->alpha, c[0], c[1], c[3], rotation, m);
        break;
    default:
        break;
    }
    if (good) return MUSURF_OK;
    return misplaced(g, system == 5 ? COVARIANCE : DISNEY + system - 1,
                     system == 5   ? "a covariance of slopes is positive definite, and alpha above 0"
                     : system == 4 ? "needs alpha above 0"
                                   : "is out of range");
}

/* out = a b, rows. */
static void multiply(const double a[4], const double b[4], double out[4]) {
    for (int i = 0; i < 4; i++) out[i] = a[i / 2 * 2] * b[i % 2] + a[i / 2 * 2 + 1] * b[2 + i % 2];
}

musurf_result musurf_parse_shape(const given *g, parsed *out) {
    static const uint32_t shaping[] = {STRETCH, ALPHA, ROUGHNESS, ALPHA_X, ALPHA_Y, ROTATION};
    mu_definition *d = &out->definition;
    double m[4] = {1, 0, 0, 1}, transform[4] = {1, 0, 0, 1};
    musurf_result result = parse_alpha(g, d);
    if (result != MUSURF_OK) return result;
    const int ndf = musurf_choice(g, NDF);
    d->ndf = ndf_of[ndf];
    result = refuse_unused(g, d->ndf);
    if (result != MUSURF_OK) return result;
    const int foreign = d->ndf == MU_PHONG ? any(g, (const uint32_t[]){ALPHA, ROUGHNESS, 0}) : 0;
    if (foreign) return misplaced(g, foreign, "phong has an exponent in place of a roughness");
    result = parse_histogram(g, d);
    if (result != MUSURF_OK) return result;
    double stretch[4], outer[4];
    (void)mu_transform_stretch(musurf_number(g, STRETCH), 0, stretch); /* Eq. (31); singular: M is refused */
    const musurf_setting *set = g->by_id[TRANSFORM];
    out->varying = musurf_varies(g, TRANSFORM);
    if (!out->varying) musurf_numbers(g, TRANSFORM, 4, transform);
    for (size_t i = 0; i < sizeof shaping / sizeof *shaping; i++) out->composed |= musurf_varies(g, shaping[i]);
    multiply(transform, stretch, outer);
    if (out->composed) { /* of which `own` is the rightmost factor */
        static const double identity[4] = {1, 0, 0, 1};
        memcpy(out->inner, identity, sizeof identity);
        result = ndf == ELLIPSOID ? parse_ellipsoid(g, d, identity, out->inner) : parse_anisotropy(g, d, out->inner);
        if (result == MUSURF_OK) result = musurf_varying_parse(g, d, ndf == ELLIPSOID, out->inner, &out->shape);
        memcpy(m, out->inner, sizeof m);
        multiply(outer, m, out->inner);
    } else if (ndf == ELLIPSOID) {
        result = parse_ellipsoid(g, d, outer, out->inner);
    } else {
        result = parse_anisotropy(g, d, m);
        multiply(outer, m, out->inner);
    }
    if (out->varying) out->slot = set->slot; /* what varies is put before `inner`, point by point */
    out->varying |= out->composed;
    memcpy(d->transform, out->inner, sizeof d->transform);
    return result;
}
