/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* srgb.h: the transfer function of sRGB, IEC 61966-2-1: codes and what is linear in light, both 1 for white. */
#ifndef MU_SRGB_H
#define MU_SRGB_H

#include <math.h>

static inline double mu_linear_from_srgb(double code) {
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

static inline double mu_srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

#endif
