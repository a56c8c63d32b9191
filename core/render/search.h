/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * search.h: where shared objects are looked for that are opened by name, plugins of materials and the module that reads images: in the
 * directories of $MUSURF_PLUGIN_PATH, beside libmusurf_render.so where that is what runs, beside the running program, and in
 * ../lib/musurf from there.
 */
#ifndef MU_SEARCH_H
#define MU_SEARCH_H

#include <stddef.h>

enum { MU_LONGEST_PATH = 4096 };

/* [any] The index-th directory, in order. False past the last. */
_Bool mu_search_directory(size_t index, char *out, size_t size);

#endif
