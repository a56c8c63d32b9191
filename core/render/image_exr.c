/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_exr.c: the film as an OpenEXR image (exr_write.h). */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "core/render/exr_write.h"
#include "core/render/image.h"

/* ------------------------------------------------------------------------------------------------ channels
 */

enum { CHANNELS = 12 };
static const char *const channel_names[CHANNELS] = {"R",        "G",        "B",        "A",
                                                    "albedo.R", "albedo.G", "albedo.B", "normal.X",
                                                    "normal.Y", "normal.Z", "variance", "samples"};
enum { VARIANCE = 10, SAMPLES = 11 };

#define HALF_MAX 65504.0

static float bounded(double value, _Bool half) {
    const double most = half ? HALF_MAX : (double)FLT_MAX;
    return (float)(value > most ? most : value < -most ? -most : value);
}

/* True if the pixel is too bright for its kind of number. */
static _Bool put_pixel(mu_exr_element *out, size_t stride, const mu_pixel *pixel, _Bool half) {
    double rgb[3];
    mu_pixel_rgb(pixel, rgb);
    const _Bool clamped = half && fmax(rgb[0], fmax(rgb[1], rgb[2])) > HALF_MAX;
    for (size_t c = 0; c < 3; ++c) {
        out[c * stride].number = bounded(rgb[c], half);
        out[(4 + c) * stride].number = bounded((double)pixel->albedo[c], half);
        out[(7 + c) * stride].number = bounded((double)pixel->normal[c], half);
    }
    out[3 * stride].number = pixel->samples ? (float)((double)pixel->hits / pixel->samples) : 0;
    out[VARIANCE * stride].number = bounded(mu_pixel_variance(pixel), 0);
    out[SAMPLES * stride].count = pixel->samples;
    return clamped;
}

/* -------------------------------------------------------------------------------------------------- header
 */

static exr_result_t put_vector(exr_context_t exr, const char *name, mu_vec3 v) {
    const exr_attr_v3f_t value = {.x = v.x, .y = v.y, .z = v.z};
    return exr_attr_set_v3f(exr, 0, name, &value);
}

static exr_result_t put_camera(exr_context_t exr, const mu_camera *camera) {
    const _Bool perspective = camera->kind == MU_PERSPECTIVE;
    const double degrees = 360 / 3.14159265358979323846;
    exr_result_t code =
        mu_exr_put_text(exr, "cameraProjection", perspective ? "perspective" : "orthographic");
    code = code ? code : put_vector(exr, "cameraPosition", camera->position);
    code = code ? code : put_vector(exr, "cameraForward", camera->forward);
    code = code ? code : put_vector(exr, "cameraRight", camera->right);
    code = code ? code : put_vector(exr, "cameraUp", camera->up);
    if (code) return code;
    return perspective
               ? exr_attr_set_float(exr, 0, "cameraFovVertical", /* degrees */
                                    (float)(degrees * atan((double)camera->half_height)))
               : exr_attr_set_float(exr, 0, "cameraHeight", 2 * camera->half_height); /* world units */
}

typedef struct mu_exr_job {
    const mu_film *film;
    const mu_film_settings *settings;
    const mu_image_info *info;
    size_t clamped; /* pixels */
} mu_exr_job;

static exr_result_t put_head(exr_context_t exr, const void *context) {
    static const exr_attr_chromaticities_t rec709 = {.64f, .33f, .30f, .60f, .15f, .06f, .3127f, .3290f};
    const mu_exr_job *job = context;
    const mu_image_info *info = job->info;
    char number[32], software[128]; /* a text called "version" would break the reader: the name is reserved */
    snprintf(software, sizeof software, "musurf %s", info->version ? info->version : "");
    exr_result_t code = mu_exr_put_text(exr, "software", software);
    code = code ? code : mu_exr_put_text(exr, "softwareVersion", info->version);
    code = code ? code : mu_exr_put_text(exr, "command", info->command);
    code = code ? code : mu_exr_put_text(exr, "sceneFile", info->scene_file);
    code = code ? code : mu_exr_put_text(exr, "scene", info->scene_text);
    snprintf(number, sizeof number, "%llu", (unsigned long long)info->seed); /* EXR has no 64-bit integers */
    code = code ? code : mu_exr_put_text(exr, "seed", number);
    code = code ? code : exr_attr_set_int(exr, 0, "samples", (int32_t)info->samples);
    code = code ? code : exr_attr_set_double(exr, 0, "seconds", info->seconds);
    code = code ? code : exr_attr_set_double(exr, 0, "noise", mu_film_noise(job->film));
    code = code ? code : exr_attr_set_chromaticities(exr, 0, "chromaticities", &rec709);
    return code ? code : put_camera(exr, &info->camera);
}

static void put_lines(void *context, uint32_t y, uint32_t lines, size_t stride, mu_exr_element *out) {
    mu_exr_job *job = context;
    const size_t width = job->film->width;
    for (size_t i = 0; i < lines * width; ++i)
        job->clamped += put_pixel(out + i, stride, &job->film->pixels[y * width + i], job->settings->half);
}

_Bool mu_image_write_exr(const char *file, const mu_film *film, const mu_film_settings *settings,
                         const mu_image_info *info, mu_error *error) {
    mu_exr_channel channels[CHANNELS];
    mu_exr_job job = {film, settings, info, 0};
    for (int c = 0; c < CHANNELS; ++c)
        channels[c] = (mu_exr_channel){channel_names[c], c == SAMPLES                     ? EXR_PIXEL_UINT
                                                         : c < VARIANCE && settings->half ? EXR_PIXEL_HALF
                                                                                          : EXR_PIXEL_FLOAT};
    const mu_exr_image image = {.part = "musurf",
                                .width = film->width,
                                .height = film->height,
                                .treatment = EXR_PERCEPTUALLY_LOGARITHMIC,
                                .channels = channels,
                                .channel_count = CHANNELS,
                                .head = put_head,
                                .fill = put_lines,
                                .context = &job};
    const _Bool good = mu_exr_write(file, &image, error);
    if (job.clamped)
        mu_warn(
            error,
            "%s: %zu pixels are brighter than %.0f and written as that; \"pixels\": \"float\" in the film "
            "would keep them",
            file, job.clamped, HALF_MAX);
    return good;
}
