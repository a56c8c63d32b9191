/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * double_ggx.h: a test double of a material's probe, written from the textbook and apart from musurf's core,
 * with faults that can be switched on: what the checks must accept, and what they must find.
 *
 * Anisotropic GGX with roughness ax, ay along x, y and F = 1; Heitz 2014, "Understanding the
 * masking-shadowing function", Eq. (85), (86), (99); visible normals by Heitz 2018, "Sampling the GGX
 * distribution of visible normals".
 */
#ifndef TESTS_DOUBLE_GGX_H
#define TESTS_DOUBLE_GGX_H

#include "core/render/check_subject.h"

typedef struct double_ggx {
    double ax, ay;
    double mass;         /* 1; multiplies D: 1.01 is a distribution that is not normalised */
    double sampler_bias; /* 0; the visible sampler draws normals of roughness (1 + bias) ax */
    double pdf_of_ndf;   /* 0; 1: the pdf of D cos is returned for the visible sampler */
} double_ggx;

/* The double behind the probe's interface; `ggx` is borrowed. */
mu_subject double_ggx_subject(const double_ggx *ggx);

#endif
