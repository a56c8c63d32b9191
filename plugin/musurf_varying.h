/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_varying.h: M of a point, where parts of the microsurface's shape come from slots:
 * M = transform * stretch * own, and own is R diag(base/x, base/y) R^T of slope roughnesses x, y and a rotation R, or
 * base/alpha R A R^T of another system's anisotropy A. The surface itself is made with slope roughness `base`, which
 * M turns into any other: of the distributions whose alpha is a scale of slopes, that is all that alpha does.
 */
#ifndef MUSURF_VARYING_H
#define MUSURF_VARYING_H

#include <stdint.h>

/* A number that is constant or varies. */
typedef struct musurf_varying_number {
    double value;
    uint32_t slot;
    uint16_t varies, squared; /* squared: the slot holds a roughness whose square is meant */
} musurf_varying_number;

typedef struct musurf_varying {
    int transform_varies;
    uint32_t transform_slot;
    double transform[4];                            /* where it is constant */
    musurf_varying_number stretch, rotation, alpha; /* alpha: where `along` is false */
    musurf_varying_number x, y;                     /* slope roughnesses along the axes */
    int along;                                      /* x and y count; else own and alpha */
    double own[4];                                  /* A */
    double base;
} musurf_varying;

/* Rows of M. What no surface has is taken to the nearest that there is: slope roughness from 1e-6 to 1e6, |stretch| up to
 * 1 - 1e-6. */
void musurf_varying_compose(const musurf_varying *varying, const float *slots, float m[4]);

#endif
