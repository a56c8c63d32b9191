/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* rank.h: which of many non-negative numbers is the k-th smallest, by radix sort: linear in their number. */
#ifndef MU_RANK_H
#define MU_RANK_H

#include <stddef.h>
#include <stdint.h>

typedef struct mu_ranked {
    float key; /* >= 0, no NaN: then its bits sort as a number */
    uint32_t index;
} mu_ranked;

/* Sorts items by key, equal keys keeping their order. `spare` is as long and is overwritten. */
void mu_rank_sort(mu_ranked *items, mu_ranked *spare, size_t count);

#endif
