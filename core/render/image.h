/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image.h: films written as images: OpenEXR with everything, PNG to look at. Both by the rule of output.h. */
#ifndef MU_IMAGE_H
#define MU_IMAGE_H

#include "core/render/film.h"

/* What goes into the header of the image besides pixels. Texts are borrowed; NULL leaves the attribute out.
 */
typedef struct mu_image_info {
    const char *scene_file, *scene_text, *command, *version;
    uint64_t seed;
    uint32_t samples; /* per pixel; where pixels differ, the least */
    double seconds;
    mu_camera camera;
} mu_image_info;

/*
 * EXR through OpenEXR's C core, ZIP, linear Rec. 709. Channels R G B (mean radiance), A (fraction of samples
 * that hit something), albedo.R/G/B, normal.X/Y/Z (world space, mean over samples, so shorter than 1 where it
 * varies): half or float as the film says, halves clamped to +-65504; variance (of the mean luminance):
 * float; samples: uint.
 */
_Bool mu_image_write_exr(const char *file, const mu_film *film, const mu_film_settings *settings,
                         const mu_image_info *info, mu_error *error);
/* 8-bit sRGB preview with the film's exposure and the soft shoulder of mu_tone_curve. */
_Bool mu_image_write_png(const char *file, const mu_film *film, const mu_film_settings *settings,
                         const mu_image_info *info, mu_error *error);

/*
 * The preview's curve from linear radiance (after exposure) to linear display light in [0, 1): the identity
 * up to 0.8, then 1 - 0.2 exp(-(x - 0.8)/0.2), which goes on with the same slope and never clips.
 */
double mu_tone_curve(double x);
/* sRGB (IEC 61966-2-1) code value 0...255 of linear light in [0, 1]. */
uint8_t mu_tone_srgb8(double linear);

#endif
