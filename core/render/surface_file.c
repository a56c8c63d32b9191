/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_file.c: writes heightfields as OpenEXR images (exr_write.h), channel "Y". */
#include "core/render/surface_file.h"

#include <stdio.h>

#include "core/render/exr_write.h"

typedef struct mu_surface_job {
    const mu_heightfield *f;
    const mu_surface_info *info;
} mu_surface_job;

static exr_result_t put_law(exr_context_t exr, const mu_slope_law *law) {
    exr_result_t code = exr_attr_set_string(exr, 0, "ndf", mu_slope_names()[law->kind]);
    if (!code && law->kind != MU_SLOPE_PHONG) code = exr_attr_set_double(exr, 0, "alpha", law->alpha);
    if (!code && (law->kind == MU_SLOPE_GTR || law->kind == MU_SLOPE_STD))
        code = exr_attr_set_double(exr, 0, "gamma", law->gamma);
    if (!code && law->kind == MU_SLOPE_PHONG) code = exr_attr_set_double(exr, 0, "exponent", law->exponent);
    return code;
}

static exr_result_t put_head(exr_context_t exr, const void *context) {
    static const char *const layouts[] = {"heights; scanline = x, pixel in it = y, cell 1, periodic",
                                          "heights; scanline = x, pixel in it = y, cell 1, does not repeat"};
    const mu_surface_info *info = ((const mu_surface_job *)context)->info;
    char number[32];
    exr_result_t code = mu_exr_put_text(exr, "software", "musurf " MUSURF_VERSION);
    code = code ? code : mu_exr_put_text(exr, "layout", layouts[info->open]);
    code = code ? code : exr_attr_set_string(exr, 0, "command", info->command);
    if (code || !info->recipe) return code;
    code = put_law(exr, &info->recipe->law);
    snprintf(number, sizeof number, "%llu",
             (unsigned long long)info->recipe->seed); /* EXR has no 64-bit integers */
    code = code ? code : exr_attr_set_string(exr, 0, "seed", number);
    code = code ? code : exr_attr_set_double(exr, 0, "correlation", info->recipe->correlation);
    code = code ? code : exr_attr_set_double(exr, 0, "clip", info->recipe->clip);
    code = code ? code : exr_attr_set_int(exr, 0, "passes", (int32_t)info->passes);
    code = code ? code : exr_attr_set_double(exr, 0, "deviationLower", info->deviation[0]);
    code = code ? code : exr_attr_set_double(exr, 0, "deviationUpper", info->deviation[1]);
    return code ? code : exr_attr_set_double(exr, 0, "steepestSlope", info->steepest);
}

static void put_lines(void *context, uint32_t i, uint32_t lines, size_t stride, mu_exr_element *out) {
    const mu_heightfield *f = ((const mu_surface_job *)context)->f;
    (void)stride;
    for (size_t k = 0; k < (size_t)lines * f->ny; k++) out[k].number = (float)f->h[(size_t)i * f->ny + k];
}

_Bool mu_surface_write(const char *file, const mu_heightfield *f, const mu_surface_info *info,
                       mu_error *error) {
    static const mu_exr_channel channel = {"Y", EXR_PIXEL_FLOAT};
    mu_surface_job job = {f, info};
    const mu_exr_image image = {.part = "surface",
                                .width = f->ny,
                                .height = f->nx,
                                .treatment = EXR_PERCEPTUALLY_LINEAR,
                                .channels = &channel,
                                .channel_count = 1,
                                .head = put_head,
                                .fill = put_lines,
                                .context = &job};
    return mu_exr_write(file, &image, error);
}
