/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* document_syntax.h: errors in a text that is no JSON, said with line, column and path all the same. */
#ifndef MU_DOCUMENT_SYNTAX_H
#define MU_DOCUMENT_SYNTAX_H

#include "core/render/document.h"

/* "file:2:12: $.b[2]: ...": where the byte at `offset` stands, as far as the text before it tells. Always
 * false. */
_Bool mu_syntax_fail(const mu_document *document, size_t offset, mu_error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* What jansson found, said again. Always false. */
_Bool mu_syntax_retell(const mu_document *document, const json_error_t *found, mu_error *error);

#endif
