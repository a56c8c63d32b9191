/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* jacobian.c: maps of the texture square, from JSON, and their derivatives. */
#include "core/render/jacobian.h"

#include <math.h>

#include "core/render/source_picture.h"

static _Bool read_power_shear(mu_jacobian *jacobian, const mu_place *place, mu_error *error) {
    static const char *const keys[] = {"map", "amount", "exponent", NULL};
    static const char *const maps[] = {"power_shear", NULL};
    const mu_place map = mu_place_member(place, "map"), amount = mu_place_member(place, "amount"),
                   exponent = mu_place_member(place, "exponent");
    size_t which;
    if (!mu_place_only(place, keys, error) || !mu_place_choice(&map, maps, &which, error)) return 0;
    jacobian->map = MU_JACOBIAN_POWER_SHEAR;
    /* The Jacobian is handed to shading as floats. Below exponent 1 it would be infinite at u = 0. */
    return mu_place_number(&amount, -1e6, 1e6, &jacobian->amount, error) &&
           mu_place_number(&exponent, 1, 1e3, &jacobian->exponent, error);
}

static _Bool read_formula(mu_expression *out, const mu_place *place, mu_error *error) {
    const char *text;
    char why[256];
    if (!mu_place_string(place, &text, error)) return 0;
    return mu_expression_parse(out, text, why, sizeof why) ||
           mu_place_fail(place, error, "is no formula such as \"v + 2*u^5\": it %s", why);
}

static _Bool read_displacement(mu_jacobian *jacobian, const mu_place *place, mu_error *error) {
    static const char *const keys[] = {"displacement", "scale", "channels", "range", "wrap", NULL};
    static const char *const wraps[] = {"repeat", "clamp", "mirror", NULL};
    const mu_place file = mu_place_member(place, "displacement"), scale = mu_place_member(place, "scale"),
                   channels = mu_place_member(place, "channels"), range = mu_place_member(place, "range"),
                   wrap = mu_place_member(place, "wrap");
    const char *names[2];
    size_t which = MU_WRAP_REPEAT;
    mu_picture_request request = {.count = 2, .range = {0, 1}, .names = channels.value ? names : NULL};
    jacobian->displacement.scale = 1;
    if (!mu_place_only(place, keys, error) ||
        (scale.value && !mu_place_number(&scale, -1e6, 1e6, &jacobian->displacement.scale, error)) ||
        (channels.value && !mu_source_texts(&channels, 2, names, error)) ||
        (range.value && !mu_place_numbers(&range, 2, -1e6, 1e6, request.range, error)) ||
        (wrap.value && !mu_place_choice(&wrap, wraps, &which, error)))
        return 0;
    request.named = channels.value != NULL;
    jacobian->map = MU_JACOBIAN_DISPLACEMENT;
    return mu_source_picture(&jacobian->displacement.picture, &file, &request, (mu_wrap)which, error);
}

void mu_jacobian_free(mu_jacobian *jacobian) {
    mu_mipmap_free(&jacobian->displacement.picture);
}

_Bool mu_jacobian_read(mu_jacobian *jacobian, const mu_place *place, mu_error *error) {
    static const char *const any[] = {"map",   "amount",   "exponent", "u",    "v", "displacement",
                                      "scale", "channels", "range",    "wrap", NULL};
    static const char *const formulas[] = {"u", "v", NULL};
    const mu_place u = mu_place_member(place, "u"), v = mu_place_member(place, "v");
    if (!mu_place_only(place, any, error)) return 0;
    if (json_object_get(place->value, "map")) return read_power_shear(jacobian, place, error);
    if (json_object_get(place->value, "displacement")) return read_displacement(jacobian, place, error);
    if (!u.value && !v.value)
        return mu_place_fail(
            place, error, "needs a named \"map\", a map's formulas \"u\" and \"v\", or a \"displacement\"");
    jacobian->map = MU_JACOBIAN_EXPRESSION;
    return mu_place_only(place, formulas, error) && read_formula(&jacobian->u, &u, error) &&
           read_formula(&jacobian->v, &v, error);
}

json_t *mu_jacobian_schema(void) {
    return json_pack("{s:s, s:[{s:s, s:{s:{s:[s]}, s:{s:s, s:f, s:f}, s:{s:s, s:f, s:f}}, s:[s, s, s], s:b},"
                     "{s:s, s:{s:{s:s}, s:{s:s}}, s:[s, s], s:b},"
                     "{s:s, s:{s:{s:s}, s:{s:s, s:f, s:f}, s:o, s:o, s:{s:[s, s, s]}}, s:[s], s:b}]}",
                     "description",
                     "M is the Jacobian of a map of the texture square; power_shear: T(u,v) = (u, v + amount "
                     "u^exponent); else formulas of T(u,v), such as \"u\" and \"v + 2*u^5\", or a picture of "
                     "T(u,v) - (u,v)",
                     "anyOf", "type", "object", "properties", "map", "enum", "power_shear", "amount", "type",
                     "number", "minimum", -1e6, "maximum", 1e6, "exponent", "type", "number", "minimum", 1.0,
                     "maximum", 1e3, "required", "map", "amount", "exponent", "additionalProperties", 0,
                     "type", "object", "properties", "u", "type", "string", "v", "type", "string", "required",
                     "u", "v", "additionalProperties", 0, "type", "object", "properties", "displacement",
                     "type", "string", "scale", "type", "number", "minimum", -1e6, "maximum", 1e6, "channels",
                     json_pack("{s:s, s:{s:s}, s:i, s:i}", "type", "array", "items", "type", "string",
                               "minItems", 2, "maxItems", 2),
                     "range",
                     json_pack("{s:s, s:{s:s, s:f, s:f}, s:i, s:i}", "type", "array", "items", "type",
                               "number", "minimum", -1e6, "maximum", 1e6, "minItems", 2, "maxItems", 2),
                     "wrap", "enum", "repeat", "clamp", "mirror", "required", "displacement",
                     "additionalProperties", 0);
}

void mu_jacobian_at(const mu_jacobian *jacobian, double u, double v, double change[4]) {
    change[0] = change[1] = change[2] = change[3] = 0;
    if (jacobian->map == MU_JACOBIAN_POWER_SHEAR) {
        if (jacobian->amount != 0)
            change[2] = jacobian->amount * jacobian->exponent * pow(u, jacobian->exponent - 1);
    } else if (jacobian->map == MU_JACOBIAN_EXPRESSION) {
        const mu_dual x = mu_expression_at(&jacobian->u, u, v), y = mu_expression_at(&jacobian->v, u, v);
        change[0] = x.du - 1, change[1] = x.dv, change[2] = y.du, change[3] = y.dv - 1;
    } else if (jacobian->map == MU_JACOBIAN_DISPLACEMENT) {
        mu_displacement_at(&jacobian->displacement, u, v, change);
    }
}
