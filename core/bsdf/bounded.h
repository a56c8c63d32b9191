/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bounded.h: visible normals of GGX without most of those that reflect below the horizon (Tokuyoshi & Eto 2023, "Bounded VNDF
 * Sampling for Smith-GGX Reflections"), part of transformed.h.
 *
 * In the space where GGX is a hemisphere of unit roughness, a visible normal is the half-vector of w and a uniform direction
 * of the cap above -w.z; the cap above -k w.z suffices for all reflections above the horizon of the surface, with
 *     k = (1 - a²) s² / (s² + a² v.z²),   s = 1 + |v.xy|,
 * a, at most 1, the smaller slope roughness. The authors say so of two roughnesses along the axes; under any M they are the
 * singular values of (slope unit) M^-T, since turning either space about its normal changes nothing in the bound. The
 * density is that of visible normals with sigma - (1 - k) w.z / 2 in place of sigma.
 */
#include "core/bsdf/cap.h"

/* 1 - k, for v above the horizon. */
static inline real bound_of(const closure *c, const real v[3]) {
    const real z2 = v[2] * v[2], s2 = square(1 + sqrt(v[0] * v[0] + v[1] * v[1]));
    return c->least2 * (z2 + s2) / (s2 + c->least2 * z2);
}

/* view_z times what the cap above -k w.z shows of sigma less than the one above -w.z. */
static inline real bounded_less(const closure *c, mu_sampler sampler, const real v[3]) {
    if (!(TRAITS & IS_UNIT_GGX) || sampler != MU_SAMPLE_BOUNDED) return 0;
    return bound_of(c, v) * (c->map.view_z * v[2]) / 2;
}
