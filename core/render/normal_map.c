/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* normal_map.c: normal maps from JSON and pictures to moments of slopes, and look-ups. */
#include "core/render/normal_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/source_picture.h"

#define STEEPEST 1000.0 /* 89.9 degrees */

typedef struct reading {
    mu_normal_map *map;
    const mu_place *file;
    const char *names[3];
    double strength, down; /* down: -1 where y is against v */
    double range[2];
    _Bool ranged; /* by the user */
} reading;

static _Bool read_numbers(reading *r, const mu_place *place, mu_error *error) {
    static const char *const ys[] = {"up", "down", NULL};
    const mu_place y = mu_place_member(place, "y"), strength = mu_place_member(place, "strength"),
                   range = mu_place_member(place, "range"), wrap = mu_place_member(place, "wrap");
    size_t down = 0;
    if ((y.value && !mu_place_choice(&y, ys, &down, error)) ||
        (strength.value && !mu_place_number(&strength, -STEEPEST, STEEPEST, &r->strength, error)) ||
        (range.value && !mu_place_numbers(&range, 2, -1e6, 1e6, r->range, error)) ||
        !mu_source_placement(&r->map->placement, place, error))
        return 0;
    r->down = down ? -1 : 1, r->ranged = range.value != NULL;
    if (r->map->placement.wrap == MU_WRAP_MIRROR)
        return mu_place_fail(&wrap, error, "is \"mirror\": a mirrored copy would lean to the wrong side; \"repeat\" or \"clamp\"");
    for (int k = 0; k < 2; k++) /* turned over, the picture leans the other way, too */
        r->map->sign[k] = r->map->placement.scale[k] < 0 ? -1 : 1;
    return 1;
}

/* The channels: 0 or 2 or 3 of them are named. */
static _Bool read_channels(reading *r, const mu_place *place, mu_picture_request *request, mu_error *error) {
    const mu_place channels = mu_place_member(place, "channels");
    request->count = 3;
    if (!channels.value) return 1;
    request->count = json_array_size(channels.value) == 2 ? 2 : 3;
    request->names = r->names, request->named = 1;
    return mu_source_texts(&channels, request->count, r->names, error);
}

/* What the codes mean, in double: of whole-number files [-1, 1], where no code is 0: the two beside it are. */
static double component(const reading *r, double code, double step) {
    const double low = r->ranged || !(step > 0) ? r->range[0] : -1, high = r->ranged || !(step > 0) ? r->range[1] : 1;
    const double value = low + code * (high - low);
    return fabs(value) <= 0.501 * step * fabs(high - low) ? 0 : value;
}

/* A floating-point file that has no negative number was hardly meant as it stands. */
static void warn_of_range(const reading *r, const mu_mipmap *picture, mu_error *error) {
    const size_t count = (size_t)picture->level[0].width * (size_t)picture->level[0].height;
    double sum[2] = {0, 0};
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 2; k++) {
            const double x = (double)picture->texels[i * (size_t)picture->channels + k];
            if (x < 0) return;
            sum[k] += x / (double)count;
        }
    mu_error warning = {.text = ""};
    if (!(fabs(sum[0] - 0.5) < 0.1 && fabs(sum[1] - 0.5) < 0.1)) return;
    mu_place_fail(r->file, &warning, "no number of this floating-point file is negative; if 0.5 is meant to be 0, say \"range\": [-1, 1]");
    mu_warn(error, "%s", warning.text);
}

static _Bool slope_of(const reading *r, const mu_mipmap *picture, size_t i, double step, float slope[2], mu_error *error) {
    const float *at = picture->texels + i * (size_t)picture->channels;
    const double x = component(r, (double)at[0], step), y = component(r, (double)at[1], step);
    const double z = picture->channels > 2 ? component(r, (double)at[2], step) : sqrt(fmax(1 - x * x - y * y, 0));
    const int width = picture->level[0].width;
    if (!(z > 0 && fabs(x) <= STEEPEST * z && fabs(y) <= STEEPEST * z))
        return mu_place_fail(r->file, error,
                             "pixel %zu of line %zu (both from 0) is the normal (%.4g, %.4g, %.4g); one of a map points outward, "
                             "its z above 0 and a thousandth of x and y",
                             i % (size_t)width, i / (size_t)width, x, y, z);
    slope[0] = (float)(-x / z * r->strength), slope[1] = (float)(-y / z * r->strength * r->down);
    return 1;
}

/* Between texels slopes go evenly, and the mean square of that is of texels i and j the sum of s_i s_j by 1/6, 2/3, 1/6 of
 * neighbours along each axis: a texel's part of it is its own slope times this mean of what is around it. Of equal ones exactly that. */
static double around(const mu_mipmap *p, int x, int y, int component) {
    static const double weight[3] = {1.0 / 6, 2.0 / 3, 1.0 / 6};
    const int width = p->level[0].width, height = p->level[0].height;
    const double own = (double)p->texels[5 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)component];
    double sum = 0;
    for (int k = 0; k < 9; k++) {
        const int beside[2] = {x + k % 3 - 1, y + k / 3 - 1}, count[2] = {width, height};
        int at[2];
        for (int i = 0; i < 2; i++) {
            const int over = p->wrap == MU_WRAP_REPEAT ? count[i] - 1 : 0;
            at[i] = beside[i] < 0 ? over : beside[i] >= count[i] ? count[i] - 1 - over : beside[i];
        }
        const size_t texel = (size_t)at[1] * (size_t)width + (size_t)at[0];
        sum += weight[k % 3] * weight[k / 3] * ((double)p->texels[5 * texel + (size_t)component] - own);
    }
    return own + sum;
}

/* The levels of `map`, of the normals in `picture`; *flat: they lean nowhere. */
static _Bool make_moments(const reading *r, const mu_mipmap *picture, double step, _Bool *flat, mu_error *error) {
    mu_normal_map *map = r->map;
    const int width = picture->level[0].width, height = picture->level[0].height;
    const size_t count = (size_t)width * (size_t)height;
    *flat = 1;
    if (!mu_mipmap_make(&map->moments, width, height, 5, map->placement.wrap))
        return mu_place_fail(r->file, error, "not enough memory for %d x %d texels", width, height);
    for (size_t i = 0; i < count; i++) {
        float *const texel = map->moments.texels + 5 * i;
        if (!slope_of(r, picture, i, step, texel, error)) return 0;
        for (int k = 0; k < 2; k++) {
            if (texel[k] != 0) *flat = 0;
            map->middle[k] += (double)texel[k] / (double)count;
        }
    }
    for (size_t i = 0; i < count && !*flat; i++) {
        float *const texel = map->moments.texels + 5 * i;
        const int column = (int)(i % (size_t)width), row = (int)(i / (size_t)width);
        const double x = (double)texel[0] - map->middle[0], y = (double)texel[1] - map->middle[1],
                     near_x = around(&map->moments, column, row, 0) - map->middle[0],
                     near_y = around(&map->moments, column, row, 1) - map->middle[1];
        texel[2] = (float)(x * near_x), texel[3] = (float)((x * near_y + y * near_x) / 2), texel[4] = (float)(y * near_y);
    }
    mu_mipmap_build(&map->moments);
    return 1;
}

_Bool mu_normal_map_read(mu_normal_map **out, const mu_place *place, mu_error *error) {
    static const char *const keys[] = {"file", "y", "strength", "range", "channels", "scale", "offset", "wrap", "filter", NULL};
    const mu_place file = mu_place_member(place, "file");
    double step = 0;
    mu_mipmap picture = {.channels = 0};
    mu_picture_request request = {.range = {0, 1}, .step = &step};
    _Bool flat = 1;
    *out = NULL;
    if (!mu_place_only(place, keys, error)) return 0;
    mu_normal_map *map = calloc(1, sizeof *map);
    reading r = {.map = map, .file = &file, .strength = 1, .range = {0, 1}};
    if (!map) return mu_place_fail(place, error, "not enough memory");
    _Bool good = read_numbers(&r, place, error) && read_channels(&r, place, &request, error) &&
                 mu_source_picture(&picture, &file, &request, map->placement.wrap, error);
    if (good && !(step > 0) && !r.ranged) warn_of_range(&r, &picture, error);
    good = good && make_moments(&r, &picture, step, &flat, error);
    mu_mipmap_free(&picture);
    if (good && !flat)
        *out = map;
    else
        mu_normal_map_free(map);
    return good;
}

void mu_normal_map_free(mu_normal_map *map) {
    if (!map) return;
    mu_mipmap_free(&map->moments);
    free(map);
}

static json_t *pair_schema(double most) {
    return json_pack("{s:s, s:{s:s, s:f, s:f}, s:i, s:i}", "type", "array", "items", "type", "number", "minimum", -most,
                     "maximum", most, "minItems", 2, "maxItems", 2);
}

json_t *mu_normal_map_schema(void) {
    return json_pack(
        "{s:s, s:s, s:{s:{s:s}, s:{s:[s,s]}, s:{s:s, s:f, s:f}, s:o, s:{s:s, s:{s:s}, s:i, s:i}, s:o, s:o, s:{s:[s,s]}, s:{s:[s,s]}},"
        " s:[s], s:b}",
        "description",
        "A picture of normals in the texture's frame: x along u, y along v (\"y\": \"down\": against it), z outward. Whole-number "
        "files mean [-1, 1], floats what they say; strength multiplies slopes. Near, it turns the frame of shading; from afar it widens "
        "the microsurface, unless filter is none",
        "type", "object", "properties", "file", "type", "string", "y", "enum", "up", "down", "strength", "type", "number",
        "minimum", -STEEPEST, "maximum", STEEPEST, "range", pair_schema(1e6), "channels", "type", "array", "items", "type",
        "string", "minItems", 2, "maxItems", 3, "scale", pair_schema(1e6), "offset", pair_schema(1e6), "wrap", "enum", "repeat",
        "clamp", "filter", "enum", "covariance", "none", "required", "file", "additionalProperties", 0);
}

void mu_normal_map_at(const mu_normal_map *map, const float footprint[6], double share, _Bool point, double mean[2],
                      double covariance[3]) {
    const mu_placement *p = &map->placement;
    double uv[2], axes[4], found[MU_MIPMAP_CHANNELS];
    for (int i = 0; i < 2; i++) uv[i] = (double)footprint[i] * p->scale[i] + p->offset[i];
    for (int i = 0; i < 4; i++) axes[i] = share * (double)footprint[2 + i] * p->scale[i % 2];
    mu_mipmap_at(&map->moments, uv, point ? NULL : axes, NULL, found);
    for (int k = 0; k < 2; k++) mean[k] = found[k] * map->sign[k];
    covariance[0] = covariance[1] = covariance[2] = 0;
    if (point) return;
    const double x = found[0] - map->middle[0], y = found[1] - map->middle[1];
    const double xx = found[2] - x * x, xy = found[3] - x * y, yy = found[4] - y * y;
    /* Three sums rounded to float, of numbers about as large as the first: what is left of equal ones is none. */
    if (!(xx + yy > 0x1p-21 * (found[2] + found[4]))) return;
    /* Less than a texel spans less of the slopes between it and the next, the smaller it is, and of their variance the square of
     * that. */
    const double wide[2] = {map->moments.level[0].width, map->moments.level[0].height};
    const double square = ((axes[0] * axes[0] + axes[2] * axes[2]) * wide[0] * wide[0] +
                           (axes[1] * axes[1] + axes[3] * axes[3]) * wide[1] * wide[1]) / 2;
    const double part = square < 1 ? square : 1;
    covariance[0] = part * fmax(xx, 0), covariance[2] = part * fmax(yy, 0);
    const double most = sqrt(covariance[0] * covariance[2]);
    covariance[1] = fmin(fmax(part * xy * map->sign[0] * map->sign[1], -most), most);
}
