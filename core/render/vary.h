/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * vary.h: values of a scene file that take a list of others, one after another: "alpha=.1:.2:.4,gamma=1..4/7".
 *
 * A name is `$.` and a path into the scene file ("$.lights[0].rotation"), MATERIAL.KEY of a named material, or a KEY
 * of the scene's material where only one is, or only one gives that key.
 */
#ifndef MU_VARY_H
#define MU_VARY_H

#include "core/render/document.h"

enum { MU_VARY_MOST = 6, MU_VARY_VALUES = 1024 };

typedef struct mu_variation {
    char *name;     /* as given */
    char *path;     /* "$.materials.metal.alpha", once bound */
    json_t *values; /* an array */
} mu_variation;

typedef struct mu_variations {
    mu_variation of[MU_VARY_MOST];
    size_t count;
} mu_variations;

/* Adds what the text lists: NAME=VALUE:VALUE..., joined by commas. A value is a number, any JSON, or a word; A..B/N
 * are N numbers from A to B at equal distances. */
_Bool mu_vary_parse(mu_variations *variations, const char *text, mu_error *error);
void mu_vary_free(mu_variations *variations);

/* Finds what the names mean in this scene file. */
_Bool mu_vary_bind(mu_variations *variations, const mu_document *scene, mu_error *error);
/* Puts value `which[i]` of each bound variation into the document's values; its text stays. */
_Bool mu_vary_apply(const mu_variations *variations, const size_t *which, mu_document *scene, mu_error *error);
/* "alpha 0.25" */
void mu_vary_caption(const mu_variation *variation, size_t which, char *out, size_t size);

#endif
