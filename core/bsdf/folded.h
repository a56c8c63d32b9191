/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * folded.h: visible normals whose reflections below the horizon are not lost (part of transformed.h). Not in the papers.
 *
 * A direction that visible normals send below the horizon is turned up again, z to -z. So i is reached as itself and as its
 * mirror image j = (i.x, i.y, -i.z): the density is the sum of both, closed for any distribution under any map, and no
 * sample is wasted. f cos / pdf falls below F G2 / G1 by what comes back: never above 1. Where nothing falls below, as with
 * short tails seen from above, it is sampling of visible normals.
 */

/* Density of the reflections from o that come back to i, for sigma of o. */
static inline real folded_density(plan_kind plan, const closure *c, const real o[3], const real i[3],
                                  real sigma_o) {
    const real j[3] = {i[0], i[1], -i[2]};
    real h[3] = {o[0] + j[0], o[1] + j[1], o[2] + j[2]}, h2 = dot(h, h);
    if (h2 < R(0.25)) h2 = sharpen(o, j, h, h2);
    if (!(h[2] > 0)) return 0; /* no micronormal points down */
    return smaller(transformed_density(plan, c, h, h2) / 4 * (c->map.view_z / larger(sigma_o, REAL_MIN)),
                   saturated);
}
