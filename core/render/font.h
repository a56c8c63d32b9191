/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* font.h: letters for captions in images. */
#ifndef MU_FONT_H
#define MU_FONT_H

#include <stdint.h>

enum { MU_FONT_WIDTH = 6, MU_FONT_HEIGHT = 13 };

/* Whether the pixel of a printable ASCII character is set; x to the right, y downwards. Others are shown as "?". */
_Bool mu_font_pixel(char character, uint32_t x, uint32_t y);

#endif
