/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* reflectance.c: Fresnel's equations in complex numbers. */
#include "core/surface/reflectance.h"

#include <complex.h>
#include <math.h>

/* With n and k complex index and c the cosine outside, q = n cos_t: r_s = (c - q)/(c + q), r_p = (n^2 c - q)/(n^2 c + q). */
static double from_index(double n, double k, double c) {
    const double complex index = CMPLX(n, k), square = index * index;
    const double complex q = csqrt(square - (1 - c) * (1 + c));
    if (cabs(c + q) == 0) return 1; /* grazing on a medium with the same index */
    const double s = cabs((c - q) / (c + q)), p = cabs((square * c - q) / (square * c + q));
    return fmin(1, (s * s + p * p) / 2);
}

double mu_reflectance_at(const mu_reflectance *r, int channel, double cosine) {
    switch (r->kind) {
    case MU_REFLECTS_SCHLICK:
        return r->a[channel] + (1 - r->a[channel]) * pow(1 - cosine, 5);
    case MU_REFLECTS_INDEX:
        return from_index(r->a[channel], r->b[channel], cosine);
    case MU_REFLECTS_ALL:
        break;
    }
    return 1;
}
