/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * jacobian.h: "jacobian" of a material: a map T(u,v) of the texture square, whose Jacobian at the hit becomes M
 * (Atanasov et al. 2022, Figure 1; shading.h says how).
 *
 *     {"map": "power_shear", "amount": a, "exponent": n}    T(u,v) = (u, v + a u^n)
 *     {"u": "u", "v": "v + 2*u^5"}                          any formulas (expression.h); the derivative is exact
 *     {"displacement": "d.exr", "scale": s}                 T(u,v) = (u,v) + s d(u,v), d by two channels of a picture
 *                                                           (displacement.h), with "channels", "range" and "wrap" (source.h)
 */
#ifndef MU_JACOBIAN_H
#define MU_JACOBIAN_H

#include "core/render/displacement.h"
#include "core/render/document.h"
#include "core/render/expression.h"

typedef struct mu_jacobian {
    enum { MU_JACOBIAN_NONE, MU_JACOBIAN_POWER_SHEAR, MU_JACOBIAN_EXPRESSION, MU_JACOBIAN_DISPLACEMENT } map;
    double amount, exponent; /* MU_JACOBIAN_POWER_SHEAR */
    mu_expression u, v;      /* MU_JACOBIAN_EXPRESSION: T */
    mu_displacement displacement;
} mu_jacobian;

_Bool mu_jacobian_read(mu_jacobian *jacobian, const mu_place *place, mu_error *error);
void mu_jacobian_free(mu_jacobian *jacobian);
json_t *mu_jacobian_schema(void);

/* [any] J - 1 at (u, v), rows; not finite where T has no derivative. */
void mu_jacobian_at(const mu_jacobian *jacobian, double u, double v, double change[4]);

#endif
