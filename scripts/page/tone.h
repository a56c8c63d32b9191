/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tone.h: from radiance to bytes: times the exposure x goes to x (1 + x / w²) / (1 + x), which shows w as white
 * (Reinhard et al. 2002), then through the transfer curve of sRGB. By a table over x / (1 + x), for three powers a
 * pixel are too many.
 */
#ifndef PAGE_TONE_H
#define PAGE_TONE_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define PAGE_WHITE 6.0f

enum { PAGE_TONES = 4096 };

typedef struct page_tone {
    uint8_t of[PAGE_TONES + 1];
} page_tone;

static inline void page_tone_make(page_tone *t) {
    for (int i = 0; i <= PAGE_TONES; i++) {
        const float y = (float)i / PAGE_TONES, x = y < 1 ? y / (1 - y) : PAGE_WHITE;
        const float shown = fminf(y * (1 + x / (PAGE_WHITE * PAGE_WHITE)), 1);
        const float coded = shown <= 0.0031308f ? 12.92f * shown : 1.055f * powf(shown, 1 / 2.4f) - 0.055f;
        t->of[i] = (uint8_t)(255 * coded + 0.5f);
    }
}

/* Where radiances are in the table; four at a time. */
static inline void page_tone_places(float exposure, size_t count, const float *restrict radiance,
                                    int *restrict place) {
    for (size_t i = 0; i < count; i++) {
        const float x = exposure * (radiance[i] > 0 ? radiance[i] : 0), most = x < 1e6f ? x : 1e6f;
        place[i] = (int)(most / (1 + most) * PAGE_TONES + 0.5f);
    }
}

/* Bytes r, g, b, a of three of them and an opacity. */
static inline uint32_t page_tone_bytes(const page_tone *t, const int place[3], float opacity) {
    return (uint32_t)t->of[place[0]] | (uint32_t)t->of[place[1]] << 8 | (uint32_t)t->of[place[2]] << 16 |
           (uint32_t)(opacity * 255 + 0.5f) << 24;
}

#endif
