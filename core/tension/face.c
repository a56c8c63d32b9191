/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * face.c: M = D R^-1 of one triangle, section 5.1 and Figure 7 of Microsurface Transformations (Atanasov et al. 2022).
 * Along its edges from corner 0, dp/du = (dv2 e1 - dv1 e2) / det, det = du1 dv2 - du2 dv1.
 */
#include "core/tension/face.h"

#include <math.h>
#include <string.h>

/* Below this, twice the area in the texture over the longest edge's square is none: as of meshes. */
#define MU_FLAT 0x1p-23

_Bool mu_tension_shape(const mu_tension_input *input, const double *position, uint32_t triangle,
                       mu_shape *shape) {
    const uint32_t *c = input->corner + 3 * (size_t)triangle;
    const double *p0 = position + 3 * (size_t)c[0], *p1 = position + 3 * (size_t)c[1],
                 *p2 = position + 3 * (size_t)c[2];
    double e1[3], e2[3];
    for (int k = 0; k < 3; k++) e1[k] = p1[k] - p0[k], e2[k] = p2[k] - p0[k];
    return mu_shape_make(shape, e1, e2);
}

static void find_angles(const mu_shape *s, double angle[3]) {
    double e3[3], back[3];
    for (int k = 0; k < 3; k++) e3[k] = s->e2[k] - s->e1[k], back[k] = -s->e1[k];
    angle[0] = atan2(s->twice_area, mu_shape_dot(s->e1, s->e2));
    angle[1] = atan2(s->twice_area, mu_shape_dot(back, e3));
    angle[2] = acos(-1.0) - angle[0] - angle[1];
}

enum { UV_NONE, UV_FLAT, UV_GOOD };

/* (x, y) of dp/du, up to a positive factor, and the orientation in the texture. */
static int uv_direction(const double *uvs, uint32_t triangle, double xy[2], int *sign) {
    *sign = 0;
    if (!uvs) return UV_NONE;
    const double *uv = uvs + 6 * (size_t)triangle;
    for (int k = 0; k < 6; k++)
        if (!isfinite(uv[k])) return UV_NONE;
    const double du1 = uv[2] - uv[0], dv1 = uv[3] - uv[1], du2 = uv[4] - uv[0], dv2 = uv[5] - uv[1];
    const double det = du1 * dv2 - du2 * dv1, du3 = du2 - du1, dv3 = dv2 - dv1;
    const double longest = fmax(du1 * du1 + dv1 * dv1, fmax(du2 * du2 + dv2 * dv2, du3 * du3 + dv3 * dv3));
    if (!(fabs(det) > MU_FLAT * longest)) return UV_FLAT;
    *sign = det > 0 ? 1 : -1;
    xy[0] = *sign * dv2, xy[1] = -*sign * dv1;
    return UV_GOOD;
}

/* But for what the float of another format leaves of them. */
static _Bool same_uvs(const mu_tension_input *input, uint32_t triangle) {
    const double *a = input->rest_uv + 6 * (size_t)triangle, *b = input->deformed_uv + 6 * (size_t)triangle;
    for (int k = 0; k < 6; k++)
        if (!(fabs(a[k] - b[k]) <= 0x1p-22 * fmax(1, fabs(a[k])))) return 0;
    return 1;
}

/* What the two textures say of a triangle. */
typedef struct mu_textures {
    int rest, deformed; /* UV_NONE, UV_FLAT, UV_GOOD */
    int rest_sign, deformed_sign;
    double rest_xy[2], deformed_xy[2];
} mu_textures;

/* The u direction in both triangles. */
static void find_directions(const mu_tension_input *input, uint32_t triangle, const mu_shape *rest,
                            mu_textures *t, mu_tension_counts *counts) {
    if (t->rest == UV_GOOD && t->deformed == UV_GOOD) {
        counts->uv_changed += !same_uvs(input, triangle);
    } else if (t->rest == UV_GOOD) {
        counts->uv_once++;
        memcpy(t->deformed_xy, t->rest_xy, sizeof t->rest_xy);
    } else if (t->deformed == UV_GOOD) {
        counts->uv_once++;
        memcpy(t->rest_xy, t->deformed_xy, sizeof t->rest_xy);
    } else {
        ++*(t->rest == UV_FLAT || t->deformed == UV_FLAT ? &counts->uv_flat : &counts->uv_none);
        mu_shape_axis(rest, t->rest_xy);
        memcpy(t->deformed_xy, t->rest_xy, sizeof t->rest_xy);
    }
    counts->uv_mirrored += t->rest_sign < 0 || t->deformed_sign < 0;
}

mu_tension_face mu_tension_face_of(const mu_tension_input *input, uint32_t triangle,
                                   mu_tension_counts *counts) {
    mu_tension_face face = {.usable = 0};
    mu_shape rest, deformed;
    mu_textures t;
    t.rest = uv_direction(input->rest_uv, triangle, t.rest_xy, &t.rest_sign);
    t.deformed = uv_direction(input->deformed_uv, triangle, t.deformed_xy, &t.deformed_sign);
    face.chart = 4 + 3 * t.rest_sign + t.deformed_sign;
    const _Bool rest_good = mu_tension_shape(input, input->rest, triangle, &rest);
    const _Bool deformed_good = mu_tension_shape(input, input->deformed, triangle, &deformed);
    if (rest_good) find_angles(&rest, face.rest_angle);
    if (deformed_good) find_angles(&deformed, face.deformed_angle);
    memcpy(face.rest_n, rest.n, sizeof rest.n);
    memcpy(face.deformed_n, deformed.n, sizeof deformed.n);
    if (!rest_good || !deformed_good) {
        ++*(rest_good ? &counts->deformed_flat : &counts->rest_flat);
        return face;
    }
    find_directions(input, triangle, &rest, &t, counts);
    mu_shape_along(&rest, t.rest_xy, face.rest_t);
    mu_shape_map(&rest, t.rest_xy, &deformed, t.deformed_xy, face.m);
    for (int k = 0; k < 3; k++) face.weight[k] = rest.twice_area * face.rest_angle[k];
    face.usable = 1;
    return face;
}
