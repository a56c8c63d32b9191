/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* sheet.h: the unit square as a grid of triangles with its coordinates as texture, to be deformed by tests. */
#ifndef MU_TEST_SHEET_H
#define MU_TEST_SHEET_H

#include "core/tension/tension.h"
#include "tests/uniform.h"

typedef struct sheet {
    uint32_t vertices, triangles;
    double *rest, *deformed; /* the same at first */
    double *uv;              /* 6 per triangle, used for both */
    uint32_t *corner;
} sheet;

/* across * up cells of two triangles; cut along (1,0)-(0,1). */
sheet sheet_make(uint32_t across, uint32_t up);
/* Moves all vertices at random by up to `by` of a cell, texture too, and cuts cells either way. */
void sheet_shake(sheet *s, uniform *random, double by);
/* Where the point (x, y) of a smoothly bent sheet is, and the exact M of that deformation with u along x. */
void sheet_bend(double x, double y, double p[3]);
void sheet_bend_map(double x, double y, double m[4]);
mu_tension *sheet_tension(const sheet *s);
void sheet_free(sheet *s);

#endif
