/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* index.c: open addressing, at most half full; words are mixed by the finaliser of SplitMix64 (Steele et al. 2014). */
#include "core/tension/index.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

_Bool mu_index_make(mu_index *index, uint32_t width, uint32_t most) {
    uint64_t slots = 2;
    while (slots < 2 * (uint64_t)most) slots *= 2;
    *index = (mu_index){.width = width, .mask = slots - 1};
    index->keys = malloc(((size_t)most + 1) * width * sizeof *index->keys);
    index->slot = malloc(slots * sizeof *index->slot);
    if (!index->keys || !index->slot) return 0;
    memset(index->slot, 0xff, slots * sizeof *index->slot);
    return 1;
}

void mu_index_free(mu_index *index) {
    free(index->keys);
    free(index->slot);
    *index = (mu_index){0};
}

static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

uint32_t mu_index_of(mu_index *index, const uint64_t *key) {
    uint64_t hash = 0;
    const size_t bytes = index->width * sizeof *key;
    for (uint32_t k = 0; k < index->width; k++) hash = mix(hash + 0x9e3779b97f4a7c15u + key[k]);
    for (uint64_t at = hash & index->mask;; at = (at + 1) & index->mask) {
        const uint32_t number = index->slot[at];
        if (number == UINT32_MAX) {
            memcpy(index->keys + (size_t)index->count * index->width, key, bytes);
            return index->slot[at] = index->count++;
        }
        if (!memcmp(index->keys + (size_t)number * index->width, key, bytes)) return number;
    }
}

uint64_t mu_index_word(double value) {
    uint64_t word = 0x7ff8000000000000u;
    if (isfinite(value)) {
        const double positive = value == 0 ? 0 : value;
        memcpy(&word, &positive, sizeof word);
    }
    return word;
}
