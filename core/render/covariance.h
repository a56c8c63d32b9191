/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * covariance.h: what averages where M varies inside a pixel.
 *
 * Slopes of a surface under M have the covariance alpha^2/2 (M M^T)^-1 (Cocco et al. 2024, section 4.1; for GGX, whose own
 * is infinite, a way to write widths), and covariances of parts of a surface average to that of the whole, as M does not.
 * S = (M M^T)^-1, [xx xy; xy yy], leaves the constant factor out. What S does not tell of M is a rotation or a mirror
 * that acts first; an isotropic surface does not show it, others do, and it is taken from the mean of M.
 */
#ifndef MU_COVARIANCE_H
#define MU_COVARIANCE_H

#include "core/render/mipmap.h"

/* S of M, rows; not finite where M is singular. */
void mu_covariance_of(const double m[4], double s[3]);

/*
 * Of the levels of a picture of S (numbers 4 to 6 of each texel): how much S varies within a texel, into number 7:
 * E tr((S^-1 s)^2) / 2 - 1 of the parts s of mean S. 0: not at all; of alpha alone it is the relative variance of alpha^2.
 * False without memory.
 */
_Bool mu_covariance_spread(mu_mipmap *picture);

/* The M of covariance `s`, turned as `mean` is; `mean` itself, to the bit, where that has this covariance within what
 * rounding S to float leaves. */
void mu_covariance_map(const double s[3], const double mean[4], double m[4]);

#endif
