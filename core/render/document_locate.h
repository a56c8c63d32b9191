/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* document_locate.h: finds a value again in the text it was parsed from. */
#ifndef MU_DOCUMENT_LOCATE_H
#define MU_DOCUMENT_LOCATE_H

#include "core/render/document.h"

typedef struct mu_span { /* byte offsets into a text */
    size_t begin, end;
} mu_span;

/* Lines from 1, columns from 1 in characters. */
typedef struct mu_position {
    size_t line, column;
} mu_position;

/* Where `place` stands in its document: its value, or with `at_key` the member name before it. Where the
 * place does not exist, the nearest object or array around it that does. False if the text is not what was
 * parsed. */
_Bool mu_locate(const mu_place *place, _Bool at_key, mu_span *span);

/* The value of the top-level object's member `key`, in a text that need not be JSON throughout. */
_Bool mu_locate_member(const char *text, size_t length, const char *key, mu_span *value);

mu_position mu_position_of(const mu_document *document, size_t offset);

/* "$.objects[2].material" into `out`, shortened in the middle of long keys and at the front of deep paths. */
void mu_place_path(const mu_place *place, char *out, size_t size);

#endif
