/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_rows.h: work on the rows of a surface, shared among threads; who does which row is of no consequence. */
#ifndef MU_SURFACE_ROWS_H
#define MU_SURFACE_ROWS_H

#include <stdint.h>

void mu_rows(uint32_t count, uint32_t threads, void (*work)(void *context, uint32_t row), void *context);

#endif
