/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* refract.c: Snell's law at facets, and the transmitted part of Eq. (11f) by sorting them. */
#include "core/surface/refract.h"

#include <math.h>

/* eta t = -(w + (sqrt(eta^2 - sin^2) - cos) m), the difference without its cancellation. */
_Bool mu_refract(double eta, const double w[3], const double m[3], double cosine, double t[3]) {
    const double inside = eta * eta - (1 - cosine) * (1 + cosine);
    if (!(inside > 0)) return 0;
    const double along = (eta - 1) * (eta + 1) / (sqrt(inside) + cosine);
    for (int k = 0; k < 3; k++) t[k] = -(w[k] + along * m[k]) / eta;
    return 1;
}

double mu_facet_refract(const mu_heightfield *f, const double m[4], const double w[3], double eta, uint32_t i,
                        uint32_t j, int upper, double normal[3], double t[3]) {
    double r[3];
    const double weight = mu_facet_mirror(f, m, w, i, j, upper, normal, r);
    const double cosine = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
    if (!(weight > 0 && mu_refract(eta, w, normal, fmin(cosine, 1), t))) t[0] = t[1] = t[2] = 0;
    return weight;
}

double mu_refract_groups(const mu_group *groups, size_t count, const double w[3], double eta,
                         const mu_lighting *lighting) {
    double sum = 0;
    for (size_t k = 0; k < count; k++) {
        double normal[3], t[3];
        if (!mu_group_normal(&groups[k], normal)) continue;
        const double cosine = fmin(w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2], 1);
        if (!mu_refract(eta, w, normal, cosine, t)) continue; /* by rounding */
        sum += groups[k].weight * (1 - lighting->fresnel(lighting->context, cosine)) *
               lighting->radiance(lighting->context, t);
    }
    return sum / (eta * eta);
}
