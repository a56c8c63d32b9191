/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * slope_width.c: how wide the slopes of a definition are spread: the least slope at which its D bends, before M. By it is told
 * whether float holds a surface, whether a tilt is too steep for it, and what is a mirror. Slopes (tan of the micronormal's
 * angle), in double. Where each comes from is said in the distribution's own file.
 */
#include "core/bsdf/real.h"
#include "core/bsdf/tabulated.h"

#if MU_REAL_BITS == 53

double mu_slope_width(const mu_definition *d) {
    switch (d->ndf) {
    case MU_FLAT:
        return 0;
    case MU_GTR: /* a large gamma narrows it: D falls as (1 + X/a)^-gamma, X the squared slope */
        return d->alpha / sqrt(fmax(1, d->gamma));
    case MU_PHONG: /* Student-t with (gamma - 1) alpha² = 1 */
        return sqrt(2 / (d->exponent + 2));
    case MU_SHEEN: /* sqrt(k + 1), k = 1 / 2 alpha */
        return d->alpha > 0 ? sqrt(1 + 0.5 / d->alpha) : 0;
    case MU_TABULATED: {
        double mean[2], covariance[3];
        mu_tabulated_moments(d, mean, covariance);
        return mu_tabulated_spread(covariance);
    }
    case MU_CUSTOM: /* its author's business */
        return INFINITY;
    default:
        return d->alpha;
    }
}

int mu_is_mirror(const mu_definition *d) {
    /* a histogram's cells have a width, and it need not be there any more */
    return d->ndf != MU_TABULATED && mu_slope_width(d) == 0;
}

int mu_passes_straight(const mu_definition *d) {
    return d->transmission && (float)d->dielectric == 1;
}

int mu_is_discrete(const mu_definition *d) {
    return (d->ndf == MU_DISCRETE_GGX || d->ndf == MU_DISCRETE_BECKMANN) && !mu_is_mirror(d);
}

#endif
