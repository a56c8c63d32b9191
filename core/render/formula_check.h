/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * formula_check.h: what formulas give over the unit square, told when a scene is read, as the texels of pictures are.
 *
 * Pictures are checked texel by texel (source_picture.h), formulas at the middles of 64 x 64 cells of the unit square. What is
 * good nowhere is refused. Where some places are not, a warning counts them, for the object may have none of them; if it
 * has, numbers are taken into their range there, a map without a derivative counts as none, and a surface whose M is singular or
 * not finite is black.
 */
#ifndef MU_FORMULA_CHECK_H
#define MU_FORMULA_CHECK_H

#include "core/render/jacobian.h"
#include "core/render/source.h"

/* Of MU_SOURCE_EXPRESSION; `place`: of the parameter. Numbers are finite and in its range, a matrix is not singular. */
_Bool mu_formula_check(const mu_source *source, const mu_place *place, mu_error *error);
/* The Jacobian is finite and not singular. */
_Bool mu_jacobian_check(const mu_jacobian *jacobian, const mu_place *place, mu_error *error);

#endif
