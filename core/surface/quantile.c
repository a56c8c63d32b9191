/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* quantile.c: the closed forms of quantile.h. Shares near 0 and 1 keep their digits by expm1 and log1p. */
#include "core/surface/quantile.h"

#include <math.h>
#include <stddef.h>

const char *const *mu_slope_names(void) {
    static const char *const names[] = {"beckmann", "ggx", "gtr", "std", "phong", "sheen", NULL};
    return names;
}

const char *mu_slope_trouble(const mu_slope_law *law) {
    const _Bool sized = isfinite(law->alpha) && law->alpha > 0;
    switch (law->kind) {
    case MU_SLOPE_GTR:
        if (!(sized && law->alpha < 1)) return "alpha must lie between 0 and 1";
        return isfinite(law->gamma) && law->gamma >= 0 ? NULL : "gamma must be at least 0";
    case MU_SLOPE_STD:
        if (!sized) return "alpha must be above 0";
        return isfinite(law->gamma) && law->gamma > 1.5 ? NULL : "gamma must be above 3/2";
    case MU_SLOPE_PHONG:
        return isfinite(law->exponent) && law->exponent >= 0 ? NULL : "exponent must be at least 0";
    default:
        return sized ? NULL : "alpha must be above 0";
    }
}

/* GTR: with t = 2 (1-g) ln(1/a) and y = ln(w/a^2), from 0 to 2 ln(1/a), P = expm1((1-g) y) / expm1(t); y/(2 ln(1/a)) at
 * g = 1. r^2 = a^2 (e^y - 1)/(1 - a^2 e^y). */
static double gtr_quantile(const mu_slope_law *law, double u) {
    const double most = -2 * log(law->alpha), k = 1 - law->gamma, t = k * most;
    const double y = fabs(t) < 1e-9 ? u * most : t < 700 ? log1p(u * expm1(t)) / k : most + log(u) / k;
    const double a2 = law->alpha * law->alpha;
    if (!(y > 0)) return 0;
    return sqrt(a2 * expm1(y) / -expm1(y - most));
}

static double gtr_share(const mu_slope_law *law, double r) {
    const double most = -2 * log(law->alpha), k = 1 - law->gamma, t = k * most;
    const double a2 = law->alpha * law->alpha;
    const double y = log1p(r * r / a2) - log1p(r * r);
    return fabs(t) < 1e-9 ? y / most : t < 700 ? expm1(k * y) / expm1(t) : exp(k * y - t);
}

double mu_slope_quantile(const mu_slope_law *law, double u) {
    switch (law->kind) {
    case MU_SLOPE_BECKMANN:
        return law->alpha * sqrt(-log1p(-u));
    case MU_SLOPE_GGX:
        return law->alpha * sqrt(u / (1 - u));
    case MU_SLOPE_GTR:
        return gtr_quantile(law, u);
    case MU_SLOPE_STD: {
        const double g = law->gamma - 1;
        return law->alpha * sqrt(g * expm1(-log1p(-u) / g));
    }
    case MU_SLOPE_PHONG:
        return sqrt(expm1(-2 * log1p(-u) / (law->exponent + 2)));
    case MU_SLOPE_SHEEN:
        return u > 0 ? 1 / sqrt(expm1(-2 * log(u) / (2 + 1 / law->alpha))) : 0;
    }
    return 0;
}

double mu_slope_share(const mu_slope_law *law, double r) {
    const double r2 = r * r;
    switch (law->kind) {
    case MU_SLOPE_BECKMANN:
        return -expm1(-r2 / (law->alpha * law->alpha));
    case MU_SLOPE_GGX:
        return r2 / (r2 + law->alpha * law->alpha);
    case MU_SLOPE_GTR:
        return gtr_share(law, r);
    case MU_SLOPE_STD: {
        const double g = law->gamma - 1;
        return -expm1(-g * log1p(r2 / (g * law->alpha * law->alpha)));
    }
    case MU_SLOPE_PHONG:
        return -expm1(-(law->exponent / 2 + 1) * log1p(r2));
    case MU_SLOPE_SHEEN:
        return r > 0 ? exp(-(1 + 0.5 / law->alpha) * log1p(1 / r2)) : 0;
    }
    return 0;
}
