/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_refraction.c: see check_refraction.h. */
#include "core/render/check_refraction.h"

#include <math.h>

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

_Bool mu_refracted(double eta, const double wo[3], const double m[3], double wi[3], double *spread) {
    const double c = dot(wo, m), inside = 1 - (1 - c * c) / (eta * eta);
    if (!(c > 0 && inside > 0)) return 0;
    const double t = sqrt(inside), along = c - eta * t;
    for (int k = 0; k < 3; k++) wi[k] = -wo[k] / eta + (c / eta - t) * m[k];
    *spread = along * along / (eta * eta * t);
    return wi[2] < 0;
}

double mu_refraction_error(double eta, const double wo[3], const double wi[3], const double m[3]) {
    double h[3], across = 0;
    for (int k = 0; k < 3; k++) h[k] = wo[k] + eta * wi[k];
    const double along = dot(h, m);
    for (int k = 0; k < 3; k++) across = hypot(across, h[k] - along * m[k]);
    return across / sqrt(dot(h, h));
}

double mu_refraction_factor(double eta, const double wo[3], const double wi[3], const double m[3]) {
    const double o = dot(wo, m), i = dot(wi, m), h = o + eta * i;
    return fabs(o * i / (wo[2] * wi[2] * h * h));
}

_Bool mu_refraction_normal(double eta, const double wo[3], const double wi[3], double m[3]) {
    double length = 0;
    for (int k = 0; k < 3; k++) {
        m[k] = (wo[k] + eta * wi[k]) * (eta > 1 ? -1 : 1);
        length = hypot(length, m[k]);
    }
    for (int k = 0; k < 3; k++) m[k] /= length;
    return length > 0 && m[2] > 0 && dot(wo, m) > 0 && dot(wi, m) < 0;
}
