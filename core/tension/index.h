/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* index.h: numbers things by what they are: equal keys get one number, in order of first appearance. A hash table. */
#ifndef MU_TENSION_INDEX_H
#define MU_TENSION_INDEX_H

#include <stdint.h>

typedef struct mu_index {
    uint64_t *keys; /* `width` words each */
    uint32_t *slot;
    uint64_t mask;
    uint32_t width, count, room;
} mu_index;

/* For `room` different keys, before it has to grow. False: out of memory; freeing it is right then, too. */
_Bool mu_index_make(mu_index *index, uint32_t width, uint32_t room);
void mu_index_free(mu_index *index);
/* The number of the key; the former index->count if it was new, then counted. UINT32_MAX: it had to grow, and no memory. */
uint32_t mu_index_of(mu_index *index, const uint64_t *key);
/* A word for a double: 0 and -0 are equal, and so is all that is not a number. */
uint64_t mu_index_word(double value);

#endif
