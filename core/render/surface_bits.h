/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_bits.h: what the views of a measured surface see, facet by facet, as a NumPy file. */
#ifndef MU_SURFACE_BITS_H
#define MU_SURFACE_BITS_H

#include "core/render/surface_measure.h"

/* uint8 [views][2][nx][ny], L then U, 1 = seen; NumPy's format 1.0, C order. */
_Bool mu_surface_bits(const char *file, const mu_measuring *measured, mu_error *error);

#endif
