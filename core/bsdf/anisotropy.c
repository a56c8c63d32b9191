/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * anisotropy.c: other systems' parameters of anisotropy to M, and M to slope roughnesses along two axes.
 *
 * Every converter ends in M = R diag(alpha/alpha_x, alpha/alpha_y) R^T (Eq. 29 with a rotation R): a microsurface
 * stretched q times along an axis is q times smoother along it. The conventions are in musurf.h, beside the
 * declarations. Frame: +x the tangent, +y the bitangent n x t; angles in radians, counter-clockwise about +z.
 */
#include "core/bsdf/real.h"
#include "core/bsdf/singular.h"

#if MU_REAL_BITS == 53

/* m = R [xx xy; xy yy] R^T; 0 if it is no map, or not finite. */
static int turned(double xx, double xy, double yy, double rotation, double m[4]) {
    const double c = cos(rotation), s = sin(rotation);
    m[0] = xx * c * c - 2 * xy * c * s + yy * s * s;
    m[1] = m[2] = (xx - yy) * c * s + xy * (c * c - s * s);
    m[3] = xx * s * s + 2 * xy * c * s + yy * c * c;
    return mu_transform_determinant(m) != 0;
}

static int lies_in(double x, double low, double high) {
    return x >= low && x <= high;
}

/* alpha / along, and 1 also where both are 0: a mirror stays one. */
static double stretch_to(double alpha, double along) {
    return alpha == along ? 1 : alpha / along;
}

int mu_transform_alphas(double alpha, double alpha_x, double alpha_y, double rotation, double m[4]) {
    return lies_in(alpha, 0, DBL_MAX) && lies_in(alpha_x, 0, DBL_MAX) && lies_in(alpha_y, 0, DBL_MAX) &&
           turned(stretch_to(alpha, alpha_x), 0, stretch_to(alpha, alpha_y), rotation, m);
}

/* Eq. (31) */
int mu_transform_stretch(double s, double rotation, double m[4]) {
    const double x = s < 0 ? 1 + s : 1 / (1 - s), y = s < 0 ? 1 / (1 + s) : 1 - s;
    return s > -1 && s < 1 && turned(x, 0, y, rotation, m);
}

int mu_transform_disney(double anisotropic, double rotation, double m[4]) {
    const double aspect = sqrt(1 - 0.9 * anisotropic);
    return lies_in(anisotropic, 0, 1) && turned(aspect, 0, 1 / aspect, rotation, m);
}

/* alpha_x = roughness^2 (1 - a), alpha_y = roughness^2 / (1 - a), a >= 0: Eq. (31) in other words */
int mu_transform_cycles(double anisotropy, double rotation, double m[4]) {
    return lies_in(anisotropy, -1, 1) &&
           mu_transform_stretch(fmin(fmax(anisotropy, -0.99), 0.99), rotation, m);
}

int mu_transform_openpbr(double anisotropy, double rotation, double m[4]) {
    const double ratio = 1 - anisotropy, along = sqrt((1 + ratio * ratio) / 2);
    return lies_in(anisotropy, 0, 1) && turned(along, 0, along / ratio, rotation, m);
}

int mu_transform_gltf(double alpha, double strength, double rotation, double m[4]) {
    const double mix = strength * strength, along = alpha * (1 - mix) + mix;
    return lies_in(alpha, 0, 1) && lies_in(strength, 0, 1) &&
           turned(stretch_to(alpha, along), 0, 1, rotation, m);
}

/* M = alpha/sqrt(2) Sigma^(-1/2), the symmetric root, by Cayley and Hamilton without a subtraction:
 * S^(-1/2) = (adj S + r) / (r sqrt(tr S + 2 r)), r = sqrt(det S). */
int mu_transform_covariance(double alpha, double xx, double xy, double yy, double rotation, double m[4]) {
    if (!(lies_in(alpha, 0, DBL_MAX) && lies_in(xx, DBL_TRUE_MIN, DBL_MAX) &&
          lies_in(yy, DBL_TRUE_MIN, DBL_MAX)))
        return 0;
    int exponent;
    (void)frexp(fmax(xx, yy), &exponent);
    exponent += exponent % 2; /* Sigma = 2^exponent S; its root wants an even one */
    const double sx = ldexp(xx, -exponent), sy = ldexp(yy, -exponent), sxy = ldexp(xy, -exponent);
    const double det = product_difference(sx, sy, sxy, sxy);
    if (!(det > 0)) return 0;
    const double r = sqrt(det);
    const double scale = ldexp(alpha / sqrt(2 * (sx + sy + 2 * r)) / r, -exponent / 2);
    return turned(scale * (sy + r), -scale * sxy, scale * (sx + r), rotation, m);
}

int mu_transform_anisotropy(const double transform[4], double alpha, mu_anisotropy *out) {
    if (mu_transform_determinant(transform) == 0) return 0;
    double m[4], largest = 0;
    int exponent;
    for (int i = 0; i < 4; i++) largest = fmax(largest, fabs(transform[i]));
    (void)frexp(largest, &exponent);
    for (int i = 0; i < 4; i++) m[i] = ldexp(transform[i], -exponent);

    const singular s = singular_of(m);
    const double small = fabs(s.small);
    /* Rounding leaves a product of rotations and scales this far from isotropic: its direction would be noise. */
    if (s.large - small <= 8 * DBL_EPSILON * s.large) {
        out->alpha_x = out->alpha_y = ldexp(alpha / sqrt(s.large * small), -exponent);
        out->rotation = 0;
        return 1;
    }
    out->alpha_x = ldexp(alpha / small, -exponent);
    out->alpha_y = ldexp(alpha / s.large, -exponent);
    const double left =
        s.sum / 2 + s.difference / 2; /* of the largest stretch, in [-pi, pi]; x is across it */
    out->rotation = left > 0 ? left - PI / 2 : left + PI / 2;
    if (out->rotation <= -PI / 2) out->rotation += PI;
    return 1;
}

#endif
