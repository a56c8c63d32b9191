/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * scene_transform.c: "transform", from an object's own space to the world's; column vectors.
 *
 * Either the 3 or 4 rows of a matrix, or a list of steps applied in the order written: a point is first put
 * through the first step, then through the second. Composed in double precision, rounded to float once.
 */
#include <string.h>

#include "core/render/affine.h"
#include "core/render/scene_read.h"

typedef struct mu_rows {
    double m[3][4];
} mu_rows;

static const mu_rows identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/* First `first`, then `then`. */
static mu_rows composed(const mu_rows *first, const mu_rows *then) {
    mu_rows out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) {
            out.m[i][j] = j == 3 ? then->m[i][3] : 0;
            for (int k = 0; k < 3; ++k) out.m[i][j] += then->m[i][k] * first->m[k][j];
        }
    return out;
}

static _Bool read_matrix(const mu_place *place, mu_rows *out, mu_error *error) {
    const size_t rows = json_array_size(place->value);
    if (rows != 3 && rows != 4)
        return mu_place_fail(place, error, "must be a matrix of 3 or 4 rows with 4 numbers each");
    for (size_t i = 0; i < rows; ++i) {
        const mu_place row = mu_place_element(place, i);
        double last[4];
        if (!mu_place_numbers(&row, 4, -MU_LARGEST, MU_LARGEST, i < 3 ? out->m[i] : last, error)) return 0;
        if (i == 3 && (last[0] != 0 || last[1] != 0 || last[2] != 0 || last[3] != 1))
            return mu_place_fail(&row, error, "the last row of an affine map must be [0, 0, 0, 1]");
    }
    return 1;
}

/* Right-handed about the axis (x, y, z), in degrees. */
static _Bool read_rotation(const mu_place *place, mu_rows *out, mu_error *error) {
    double v[4];
    if (!mu_place_numbers(place, 4, -MU_LARGEST, MU_LARGEST, v, error)) return 0;
    const mu_dvec3 k = mu_dnormalise(mu_d3(v[0], v[1], v[2]));
    if (!(mu_dlength(k) > 0))
        return mu_place_fail(place, error, "the axis [x, y, z, degrees] must not be zero");
    const double turns = remainder(v[3], 360), angle = turns * (3.14159265358979323846 / 180);
    /* Quarter turns are exact. */
    const double c = fabs(turns) == 90 ? 0 : cos(angle), s = fabs(turns) == 180 ? 0 : sin(angle), d = 1 - c;
    *out = (mu_rows){{{c + k.x * k.x * d, k.x * k.y * d - k.z * s, k.x * k.z * d + k.y * s, 0},
                      {k.y * k.x * d + k.z * s, c + k.y * k.y * d, k.y * k.z * d - k.x * s, 0},
                      {k.z * k.x * d - k.y * s, k.z * k.y * d + k.x * s, c + k.z * k.z * d, 0}}};
    return 1;
}

static _Bool read_step(const mu_place *step, mu_rows *out, mu_error *error) {
    double v[3];
    if (!mu_place_only(step, mu_scene_keys(MU_KEYS_STEP), error)) return 0;
    if (json_object_size(step->value) != 1)
        return mu_place_fail(step, error, "a step has exactly one of: translate rotate scale matrix");
    *out = identity;
    mu_place place = mu_place_member(step, "matrix");
    if (place.value) return read_matrix(&place, out, error);
    place = mu_place_member(step, "rotate");
    if (place.value) return read_rotation(&place, out, error);
    place = mu_place_member(step, "translate");
    if (place.value) {
        if (!mu_place_numbers(&place, 3, -MU_LARGEST, MU_LARGEST, v, error)) return 0;
        for (int i = 0; i < 3; ++i) out->m[i][3] = v[i];
        return 1;
    }
    place = mu_place_member(step, "scale");
    if (json_is_array(place.value)) {
        if (!mu_place_numbers(&place, 3, -MU_LARGEST, MU_LARGEST, v, error)) return 0;
    } else {
        if (!mu_place_number(&place, -MU_LARGEST, MU_LARGEST, v, error)) return 0;
        v[1] = v[2] = v[0];
    }
    for (int i = 0; i < 3; ++i) out->m[i][i] = v[i];
    return 1;
}

static _Bool read_rows(const mu_place *place, mu_rows *rows, mu_error *error) {
    if (!json_is_array(place->value) || !json_array_size(place->value))
        return mu_place_fail(place, error,
                             "must be the rows of a matrix, or a list of steps such as "
                             "{\"translate\": [0, 0, 1]}");
    if (json_is_array(json_array_get(place->value, 0))) return read_matrix(place, rows, error);
    *rows = identity;
    for (size_t i = 0; i < json_array_size(place->value); ++i) {
        const mu_place step = mu_place_element(place, i);
        mu_rows next;
        if (!read_step(&step, &next, error)) return 0;
        *rows = composed(rows, &next);
    }
    return 1;
}

_Bool mu_read_transform(const mu_place *parent, mu_affine *out, mu_error *error) {
    const mu_place place = mu_place_member(parent, "transform");
    mu_rows rows = identity;
    mu_map map;
    if (place.value && !read_rows(&place, &rows, error)) return 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) {
            if (!(fabs(rows.m[i][j]) <= MU_LARGEST))
                return mu_place_fail(&place, error, "has an entry of %g; all must be within %g", rows.m[i][j],
                                     MU_LARGEST);
            out->row[i][j] = (float)rows.m[i][j];
        }
    if (!mu_map_make(&map, out))
        return mu_place_fail(&place, error, "is singular: it flattens its object to nothing (determinant %g)",
                             map.determinant);
    return 1;
}
