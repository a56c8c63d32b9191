/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_tone.c: from linear light to the 8 bits of a preview. */
#include <math.h>

#include "core/render/image.h"
#include "core/render/srgb.h"

double mu_tone_curve(double x) {
    const double knee = 0.8, room = 1 - knee;
    if (!(x > 0)) return 0;
    return x <= knee ? x : 1 - room * exp(-(x - knee) / room);
}

uint8_t mu_tone_srgb8(double linear) {
    const double code = mu_srgb_from_linear(linear);
    return code <= 0 ? 0 : code >= 1 ? 255 : (uint8_t)(255 * code + 0.5);
}
