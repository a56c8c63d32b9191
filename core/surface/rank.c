/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* rank.c: least significant digit first, four digits of 8 bits; an even number of passes ends where it began. */
#include "core/surface/rank.h"

#include <string.h>

static uint32_t bits(float key) {
    uint32_t word;
    memcpy(&word, &key, sizeof word);
    return word;
}

void mu_rank_sort(mu_ranked *items, mu_ranked *spare, size_t count) {
    size_t starts[4][256] = {{0}};
    for (size_t k = 0; k < count; k++) {
        const uint32_t word = bits(items[k].key);
        for (int digit = 0; digit < 4; digit++) starts[digit][word >> (8 * digit) & 255]++;
    }
    for (int digit = 0; digit < 4; digit++) {
        size_t sum = 0;
        for (int value = 0; value < 256; value++) {
            const size_t here = starts[digit][value];
            starts[digit][value] = sum;
            sum += here;
        }
        for (size_t k = 0; k < count; k++)
            spare[starts[digit][bits(items[k].key) >> (8 * digit) & 255]++] = items[k];
        mu_ranked *const swap = items;
        items = spare;
        spare = swap;
    }
}
