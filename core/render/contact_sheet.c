/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* contact_sheet.c: copies pixels, draws letters. */
#include "core/render/contact_sheet.h"

#include <math.h>
#include <string.h>

#include "core/render/font.h"

enum { GAP = 4 }; /* pixels between cells, around the sheet, above and below a caption */

static uint32_t caption_height(const mu_contact_sheet *sheet) {
    return sheet->lines * MU_FONT_HEIGHT * sheet->zoom;
}

static uint32_t left(const mu_contact_sheet *sheet, uint32_t column) {
    return GAP + column * (sheet->cell_width + GAP);
}

static uint32_t top(const mu_contact_sheet *sheet, uint32_t row) {
    return GAP + row * (sheet->cell_height + caption_height(sheet) + 2 * GAP);
}

_Bool mu_contact_sheet_make(mu_contact_sheet *sheet, uint32_t columns, uint32_t rows, uint32_t cell_width,
                            uint32_t cell_height, uint32_t lines, float exposure, mu_error *error) {
    *sheet = (mu_contact_sheet){.columns = columns,
                                .rows = rows,
                                .cell_width = cell_width,
                                .cell_height = cell_height,
                                .lines = lines,
                                .zoom = cell_width < 384 ? 1 : cell_width / 384 + 1,
                                .ink = exp2f(-exposure)};
    const uint64_t width = (uint64_t)columns * (cell_width + GAP) + GAP;
    const uint64_t height = (uint64_t)rows * (cell_height + caption_height(sheet) + 2 * GAP) + GAP;
    if (width > MU_LONGEST_SIDE || height > MU_LONGEST_SIDE || width * height > MU_MOST_PIXELS)
        return mu_fail(error,
                       "a sheet of %u x %u cells of %u x %u pixels is too large: %llu x %llu; fewer values or "
                       "smaller cells (--size) are needed",
                       columns, rows, cell_width, cell_height, (unsigned long long)width,
                       (unsigned long long)height);
    if (!mu_film_make(&sheet->film, (uint32_t)width, (uint32_t)height, error)) return 0;
    for (size_t i = 0; i < (size_t)width * (size_t)height; ++i) sheet->film.pixels[i].samples = 1;
    return 1;
}

void mu_contact_sheet_free(mu_contact_sheet *sheet) {
    mu_film_free(&sheet->film);
}

void mu_contact_sheet_place(mu_contact_sheet *sheet, uint32_t column, uint32_t row, const mu_film *film) {
    mu_pixel *to = sheet->film.pixels + (size_t)top(sheet, row) * sheet->film.width + left(sheet, column);
    for (uint32_t y = 0; y < film->height; ++y)
        memcpy(to + (size_t)y * sheet->film.width, film->pixels + (size_t)y * film->width,
               film->width * sizeof *to);
    sheet->film.seconds += film->seconds;
    sheet->film.rays += film->rays;
    sheet->film.refused += film->refused;
}

void mu_contact_sheet_write(mu_contact_sheet *sheet, uint32_t column, uint32_t row, uint32_t line,
                            const char *text) {
    const uint32_t zoom = sheet->zoom, step = MU_FONT_WIDTH * zoom;
    const size_t room = sheet->cell_width / step, length = strlen(text);
    const size_t shown = length <= room ? length : room;
    mu_pixel *to = sheet->film.pixels +
                   (size_t)(top(sheet, row) + sheet->cell_height + GAP + line * MU_FONT_HEIGHT * zoom) *
                       sheet->film.width +
                   left(sheet, column);
    for (uint32_t y = 0; y < MU_FONT_HEIGHT * zoom; ++y)
        for (uint32_t x = 0; x < shown * step; ++x) {
            const size_t i = x / step;
            const char character = length > room && i + 3 >= room ? '.' : text[i];
            if (!mu_font_pixel(character, x % step / zoom, y / zoom)) continue;
            mu_pixel *pixel = to + (size_t)y * sheet->film.width + x;
            for (int c = 0; c < 3; ++c) pixel->rgb[c] = (double)sheet->ink;
        }
}
