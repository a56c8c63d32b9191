/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * soup_file.h: triangles by hand, in double precision, from an OBJ file (v and f; faces of more corners are cut into
 * fans; normals, texture coordinates, names and materials are passed over) or a JSON file
 *     {"vertices": [[x, y, z], ...], "triangles": [[i, j, k], ...], "period": [[x, y], [x, y]]}
 * with indices from 0. Corners run counterclockwise seen from outside. "period" may be missing.
 */
#ifndef MU_SOUP_FILE_H
#define MU_SOUP_FILE_H

#include "core/render/error.h"
#include "core/surface/soup.h"

enum { MU_SOUP_MOST = 2000 }; /* triangles; the cost is their square */

/* By the file's first character but blanks: "{" is JSON. soup->triangles is to be freed. All have an area; `period` is all
 * 0 if there is none. */
_Bool mu_soup_read(const char *file, mu_soup *soup, mu_error *error);

#endif
