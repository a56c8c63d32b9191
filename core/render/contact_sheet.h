/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * contact_sheet.h: many films of one size side by side on a larger one, each with a caption below it.
 *
 * The sheet is itself a film, so that it is written like any other; paper and letters are pixels of one sample.
 */
#ifndef MU_CONTACT_SHEET_H
#define MU_CONTACT_SHEET_H

#include "core/render/film.h"

typedef struct mu_contact_sheet {
    mu_film film;
    uint32_t columns, rows;         /* of cells */
    uint32_t cell_width, cell_height; /* pixels of a cell's film */
    uint32_t lines;                 /* of a caption */
    uint32_t zoom;                  /* pixels per dot of a letter */
    float ink;                      /* radiance of the letters: white in the preview, whatever its exposure */
} mu_contact_sheet;

/* An empty sheet. `exposure` in stops, as in the film's settings. */
_Bool mu_contact_sheet_make(mu_contact_sheet *sheet, uint32_t columns, uint32_t rows, uint32_t cell_width,
                            uint32_t cell_height, uint32_t lines, float exposure, mu_error *error);
void mu_contact_sheet_free(mu_contact_sheet *sheet);
/* The film into the cell; of its samples the time and rays are added up. */
void mu_contact_sheet_place(mu_contact_sheet *sheet, uint32_t column, uint32_t row, const mu_film *film);
/* Line `line` of the caption; what is wider than the cell ends in "...". */
void mu_contact_sheet_write(mu_contact_sheet *sheet, uint32_t column, uint32_t row, uint32_t line,
                            const char *text);

#endif
