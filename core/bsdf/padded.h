/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* padded.h: where one piece of a surface's memory ends and the next begins, in bytes: at cache lines. */
#ifndef MU_PADDED_H
#define MU_PADDED_H

#include <stddef.h>

enum { MU_ALIGNMENT = 64 };

static inline size_t padded(size_t bytes) {
    return (bytes + MU_ALIGNMENT - 1) / MU_ALIGNMENT * MU_ALIGNMENT;
}

#endif
