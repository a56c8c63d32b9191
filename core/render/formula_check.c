/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* formula_check.c: see formula_check.h. What shading takes is float: what overflows there is not finite. */
#include "core/render/formula_check.h"

#include <math.h>
#include <stdio.h>

#include "core/render/material_settings.h"

enum { RASTER = 64, TEXT = 256 };

typedef struct mu_places {
    int bad;
    double u, v;     /* of the first bad one */
    char what[TEXT]; /* it is, and what would be right */
} mu_places;

/* Says what is wrong at (u, v); false: nothing is. */
typedef _Bool mu_judge(const void *subject, double u, double v, char *what);

static _Bool tell(const mu_places *places, const mu_place *place, mu_error *error) {
    mu_error line = {.text = ""};
    if (places->bad == RASTER * RASTER)
        return mu_place_fail(place, error, "%s (at u = %g, v = %g, and at all places of the unit square)",
                             places->what, places->u, places->v);
    mu_place_fail(place, &line, "%s (at u = %g, v = %g; so do %d of %d x %d places of the unit square)",
                  places->what, places->u, places->v, places->bad, RASTER, RASTER);
    mu_warn(error, "%s", line.text);
    return 1;
}

static _Bool check(mu_judge *is_bad, const void *subject, const mu_place *place, mu_error *error) {
    mu_places places = {.bad = 0};
    for (int y = 0; y < RASTER; y++)
        for (int x = 0; x < RASTER; x++) {
            const double u = (x + 0.5) / RASTER, v = (y + 0.5) / RASTER;
            char what[TEXT];
            if (!is_bad(subject, u, v, what) || places.bad++) continue;
            places.u = u, places.v = v;
            snprintf(places.what, sizeof places.what, "%s", what);
        }
    return !places.bad || tell(&places, place, error);
}

/* For a message: whatever its sign is, "nan". */
static double unsigned_nan(double x) {
    return isnan(x) ? fabs(x) : x;
}

/* Of rows m, as floats. */
static _Bool is_no_map(const double m[4], char *what) {
    const float f[4] = {(float)m[0], (float)m[1], (float)m[2], (float)m[3]};
    const _Bool finite = isfinite(f[0]) && isfinite(f[1]) && isfinite(f[2]) && isfinite(f[3]);
    if (finite && (double)f[0] * (double)f[3] != (double)f[1] * (double)f[2]) return 0;
    snprintf(what, TEXT, "gives [[%g, %g], [%g, %g]], which must be %s", unsigned_nan(m[0]),
             unsigned_nan(m[1]), unsigned_nan(m[2]), unsigned_nan(m[3]), finite ? "invertible" : "finite");
    return 1;
}

static _Bool is_bad_value(const void *subject, double u, double v, char *what) {
    const mu_source *s = subject;
    double value[MU_SOURCE_NUMBERS];
    for (int k = 0; k < s->count; k++) {
        char range[160] = "";
        value[k] = mu_expression_at(s->formula + k, u, v).value;
        const _Bool finite = isfinite((float)value[k]);
        if (finite && mu_param_allows(s->param, value[k])) continue;
        if (finite) mu_param_range(s->param, range, sizeof range);
        snprintf(what, TEXT, "gives %g; it must be %s", unsigned_nan(value[k]), finite ? range : "finite");
        return 1;
    }
    return s->param->kind == MUSURF_MATRIX && s->count == 4 && is_no_map(value, what);
}

static _Bool is_bad_jacobian(const void *subject, double u, double v, char *what) {
    double j[4];
    mu_jacobian_at(subject, u, v, j);
    j[0] += 1, j[3] += 1;
    return is_no_map(j, what);
}

_Bool mu_formula_check(const mu_source *source, const mu_place *place, mu_error *error) {
    return check(is_bad_value, source, place, error);
}

_Bool mu_jacobian_check(const mu_jacobian *jacobian, const mu_place *place, mu_error *error) {
    return check(is_bad_jacobian, jacobian, place, error);
}
