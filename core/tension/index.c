/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* index.c: open addressing, at most half full; words are mixed by the finaliser of SplitMix64 (Steele et al. 2014). */
#include "core/tension/index.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Slots for twice the keys and more, all empty. */
static _Bool make_slots(mu_index *index) {
    uint64_t slots = 2;
    while (slots < 2 * (uint64_t)index->room) slots *= 2;
    uint32_t *slot = realloc(index->slot, slots * sizeof *slot);
    if (!slot) return 0;
    memset(slot, 0xff, slots * sizeof *slot);
    index->slot = slot, index->mask = slots - 1;
    return 1;
}

_Bool mu_index_make(mu_index *index, uint32_t width, uint32_t room) {
    *index = (mu_index){.width = width, .room = room};
    index->keys = malloc(((size_t)room + 1) * width * sizeof *index->keys);
    return index->keys && make_slots(index);
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

static uint64_t hash_of(const mu_index *index, const uint64_t *key) {
    uint64_t hash = 0;
    for (uint32_t k = 0; k < index->width; k++) hash = mix(hash + 0x9e3779b97f4a7c15u + key[k]);
    return hash & index->mask;
}

static _Bool grow(mu_index *index) {
    const uint32_t room = index->room < UINT32_MAX / 2 ? 2 * index->room + 8 : UINT32_MAX - 1;
    uint64_t *keys = realloc(index->keys, ((size_t)room + 1) * index->width * sizeof *keys);
    if (!keys || room <= index->room) return 0;
    index->keys = keys, index->room = room;
    if (!make_slots(index)) return 0;
    for (uint32_t i = 0; i < index->count; i++) {
        uint64_t at = hash_of(index, index->keys + (size_t)i * index->width);
        while (index->slot[at] != UINT32_MAX) at = (at + 1) & index->mask;
        index->slot[at] = i;
    }
    return 1;
}

uint32_t mu_index_of(mu_index *index, const uint64_t *key) {
    const size_t bytes = index->width * sizeof *key;
    if (index->count == index->room && !grow(index)) return UINT32_MAX;
    for (uint64_t at = hash_of(index, key);; at = (at + 1) & index->mask) {
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
