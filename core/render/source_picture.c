/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* source_picture.c: a picture through OpenImageIO's module, all its levels but the finest left out (mipmap.h). */
#include "core/render/source_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/image_read.h"
#include "core/render/material_settings.h"
#include "core/render/srgb.h"

/* Ranges are applied in double, and not at all where they are none: what a file holds is what is meant. */
static _Bool convert(float *values, size_t count, const mu_picture_request *r, size_t *bad) {
    const _Bool placed = r->range[0] != 0 || r->range[1] != 1;
    for (size_t i = 0; i < count; i++) {
        double x = (double)values[i];
        if (r->srgb) x = mu_linear_from_srgb(x);
        if (placed) x = r->range[0] + x * (r->range[1] - r->range[0]);
        values[i] = (float)x;
        if (isfinite(values[i]) && (!r->param || mu_param_allows(r->param, x))) continue;
        *bad = i;
        return 0;
    }
    return 1;
}

static _Bool refuse(const mu_place *file, const mu_picture_request *r, double value, size_t pixel, int width,
                    mu_error *error) {
    char range[160] = "";
    if (r->param) mu_param_range(r->param, range, sizeof range);
    const size_t x = pixel % (size_t)width, y = pixel / (size_t)width;
    if (!isfinite(value) || !range[0])
        return mu_place_fail(file, error, "pixel %zu of line %zu (both from 0) is %g; it must be finite", x,
                             y, value);
    return mu_place_fail(file, error, "pixel %zu of line %zu (both from 0) gives %.9g; it must be %s%s%s", x,
                         y, value, range, r->param->unit[0] ? " " : "", r->param->unit);
}

_Bool mu_source_picture(mu_mipmap *picture, const mu_place *file, const mu_picture_request *request,
                        mu_wrap wrap, mu_error *error) {
    const char *name;
    int width, height;
    double step = 0;
    if (!mu_place_string(file, &name, error)) return 0;
    char *path = mu_document_beside(file->document, name);
    mu_error why = {.text = ""};
    float *values = path ? mu_image_read_channels(path, request->names, request->named, request->count,
                                                  &width, &height, &step, &why)
                         : NULL;
    free(path);
    if (!values) return mu_place_fail(file, error, "%s", why.text[0] ? why.text : "not enough memory");
    const size_t count = (size_t)width * (size_t)height * (size_t)request->count;
    size_t bad = 0;
    _Bool good = convert(values, count, request, &bad) ||
                 refuse(file, request, (double)values[bad], bad / (size_t)request->count, width, error);
    if (good && !mu_mipmap_make(picture, width, height, request->count, wrap))
        good = mu_place_fail(file, error, "not enough memory for %d x %d texels", width, height);
    if (good) memcpy(picture->texels, values, count * sizeof *values);
    if (request->step) *request->step = step;
    free(values);
    return good;
}
