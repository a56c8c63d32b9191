/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* material_grid.c: numbers over a rectangle, from JSON, an image or a heightfield. */
#include "core/render/material_grid.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/image_read.h"
#include "core/render/slope_histogram.h"

enum { HEAD = 6, MOST = 1024 };

/* Room for the head and the cells; the head is filled in. */
static double *make(const mu_place *place, size_t columns, size_t rows, const double bounds[4], size_t *count,
                    mu_error *error) {
    *count = HEAD + columns * rows;
    double *values = malloc(*count * sizeof *values);
    if (!values) {
        mu_place_fail(place, error, "not enough memory");
        return NULL;
    }
    values[0] = (double)columns, values[1] = (double)rows;
    memcpy(values + 2, bounds, 4 * sizeof *bounds);
    return values;
}

static _Bool good_size(const mu_place *place, size_t columns, size_t rows, mu_error *error) {
    return (columns >= 1 && columns <= MOST && rows >= 1 && rows <= MOST) ||
           mu_place_fail(place, error, "has %zu columns and %zu rows; from 1 to %d are possible", columns,
                         rows, MOST);
}

static _Bool read_bounds(const mu_place *parent, const char *key, double bounds[4], mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    if (!mu_place_numbers(&place, 4, -DBL_MAX, DBL_MAX, bounds, error)) return 0;
    if (bounds[0] < bounds[1] && bounds[2] < bounds[3]) return 1;
    return mu_place_fail(&place, error,
                         "are x_min, x_max, y_min, y_max: the second must be above the first, and the "
                         "fourth above the third");
}

/* "columns" and "rows" are there for the reader's sake; they must be right. */
static _Bool agrees(const mu_place *parent, const char *key, size_t found, mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    long long said;
    if (!place.value) return 1;
    if (!mu_place_integer(&place, 1, MOST, &said, error)) return 0;
    return (size_t)said == found || mu_place_fail(&place, error, "is %lld, but weights has %zu", said, found);
}

static _Bool read_row(const musurf_param *p, const mu_place *row, size_t columns, double *out,
                      mu_error *error) {
    if (!json_is_array(row->value) || json_array_size(row->value) != columns)
        return mu_place_fail(row, error, "is not a row of %zu numbers, as the first is", columns);
    for (size_t i = 0; i < columns; i++) {
        const mu_place cell = mu_place_element(row, i);
        if (!mu_place_number(&cell, p->min, p->max, out + i, error)) return 0;
    }
    return 1;
}

static double *read_inline(const musurf_param *p, const mu_place *place, size_t *count, mu_error *error) {
    static const char *const known[] = {"columns", "rows", "bounds", "weights", NULL};
    double bounds[4];
    if (!mu_place_only(place, known, error) || !read_bounds(place, "bounds", bounds, error)) return NULL;
    const mu_place weights = mu_place_member(place, "weights"), first = mu_place_element(&weights, 0);
    const size_t rows = json_array_size(weights.value), columns = json_array_size(first.value);
    if (!json_is_array(first.value)) {
        mu_place_fail(&weights, error, "are rows of numbers, [[...], ...]");
        return NULL;
    }
    if (!good_size(&weights, columns, rows, error) || !agrees(place, "columns", columns, error) ||
        !agrees(place, "rows", rows, error))
        return NULL;
    double *values = make(place, columns, rows, bounds, count, error);
    for (size_t j = 0; values && j < rows; j++) {
        const mu_place row = mu_place_element(&weights, j);
        if (read_row(p, &row, columns, values + HEAD + j * columns, error)) continue;
        free(values);
        return NULL;
    }
    return values;
}

/* The plane of the image that the member names; every number in it is finite. */
static float *read_plane(const mu_place *parent, const char *key, int *width, int *height, mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    const char *name;
    if (!mu_place_string(&place, &name, error)) return NULL;
    char *file = mu_document_beside(place.document, name);
    mu_error why = {.text = ""};
    float *pixels = file ? mu_image_read_plane(file, NULL, width, height, &why) : NULL;
    free(file);
    if (!pixels) {
        mu_place_fail(&place, error, "%s", why.text[0] ? why.text : "not enough memory");
        return NULL;
    }
    for (size_t i = 0; i < (size_t)*width * (size_t)*height; i++) {
        if (isfinite(pixels[i])) continue;
        mu_place_fail(&place, error, "%s: pixel %zu of line %zu is no finite number", name,
                      i % (size_t)*width, i / (size_t)*width);
        free(pixels);
        return NULL;
    }
    return pixels;
}

static double *read_file(const mu_place *place, size_t *count, mu_error *error) {
    static const char *const known[] = {"bounds", "file", NULL};
    double bounds[4];
    int width, height;
    if (!mu_place_only(place, known, error) || !read_bounds(place, "bounds", bounds, error)) return NULL;
    float *pixels = read_plane(place, "file", &width, &height, error);
    if (!pixels) return NULL;
    double *values = good_size(place, (size_t)width, (size_t)height, error)
                         ? make(place, (size_t)width, (size_t)height, bounds, count, error)
                         : NULL;
    for (size_t i = HEAD; values && i < *count; i++) values[i] = (double)pixels[i - HEAD];
    free(pixels);
    return values;
}

static double *read_heightfield(const mu_place *place, size_t *count, mu_error *error) {
    static const char *const known[] = {"heightfield", "bins", "range", NULL};
    const mu_place bins = mu_place_member(place, "bins"), range = mu_place_member(place, "range");
    double bounds[4];
    long long side = 128;
    int width, height;
    if (!mu_place_only(place, known, error) ||
        (bins.value && !mu_place_integer(&bins, 1, MOST, &side, error)) ||
        (range.value && !read_bounds(place, "range", bounds, error)))
        return NULL;
    float *heights = read_plane(place, "heightfield", &width, &height, error);
    double *values = NULL;
    if (heights) {
        if (!range.value) mu_slope_bounds(heights, (size_t)height, (size_t)width, bounds);
        values = make(place, (size_t)side, (size_t)side, bounds, count, error);
    }
    if (values) {
        const size_t outside =
            mu_slope_histogram(heights, (size_t)height, (size_t)width, bounds, (size_t)side, values + HEAD);
        if (outside) {
            mu_place_fail(&range, error,
                          "%zu of %zu slopes lie outside; without a range there is room for all", outside,
                          2 * (size_t)width * (size_t)height);
            free(values);
            values = NULL;
        }
    }
    free(heights);
    return values;
}

double *mu_grid_read(const musurf_param *p, const mu_place *place, size_t *count, mu_error *error) {
    if (json_object_get(place->value, "heightfield")) return read_heightfield(place, count, error);
    if (json_object_get(place->value, "file")) return read_file(place, count, error);
    if (json_object_get(place->value, "weights")) return read_inline(p, place, count, error);
    mu_place_fail(place, error,
                  "is {\"bounds\": [x_min, x_max, y_min, y_max], \"weights\": [[...], ...]}, or names a "
                  "\"file\" in place of weights, or a \"heightfield\"");
    return NULL;
}

json_t *mu_grid_schema(const musurf_param *p) {
    json_t *cell = json_pack("{s:s}", "type", "number"),
           *bounds = json_pack("{s:{s:s}, s:s, s:i, s:i}", "items", "type", "number", "type", "array",
                               "minItems", 4, "maxItems", 4);
    if (isfinite(p->min)) json_object_set_new(cell, "minimum", json_real(p->min));
    if (isfinite(p->max)) json_object_set_new(cell, "maximum", json_real(p->max));
    json_t *row = json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", cell, "minItems", 1, "maxItems",
                            MOST),
           *rows = json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", row, "minItems", 1, "maxItems",
                             MOST),
           *number = json_pack("{s:s, s:i, s:i}", "type", "integer", "minimum", 1, "maximum", MOST),
           *text = json_pack("{s:s}", "type", "string");
    json_t *schema = json_pack(
        "{s:[{s:s, s:{s:O, s:O, s:O, s:O}, s:[s, s], s:b}, {s:s, s:{s:O, s:O}, s:[s, s], s:b}, {s:s, s:{s:O, "
        "s:O, s:O}, s:[s], s:b}]}",
        "anyOf", "type", "object", "properties", "columns", number, "rows", number, "bounds", bounds,
        "weights", rows, "required", "bounds", "weights", "additionalProperties", 0, "type", "object",
        "properties", "bounds", bounds, "file", text, "required", "bounds", "file", "additionalProperties", 0,
        "type", "object", "properties", "heightfield", text, "bins", number, "range", bounds, "required",
        "heightfield", "additionalProperties", 0);
    json_decref(number), json_decref(text), json_decref(bounds), json_decref(rows);
    return schema;
}
