/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* ibl_picture.h: a lobe, its confidence region, its axis and samples, as SVG. */
#ifndef MU_IBL_PICTURE_H
#define MU_IBL_PICTURE_H

#include <stdio.h>

#include "core/render/command_ibl.h"

/* False if there is not enough memory. */
_Bool mu_ibl_draw(const mu_ibl_question *ask, FILE *out);

#endif
