/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* answers.h: commands that read JSON Lines and answer each by a line of JSON, in the same order. */
#ifndef MU_ANSWERS_H
#define MU_ANSWERS_H

#include "core/render/document.h"
#include "core/render/json_out.h"
#include "core/render/options.h"

/* Fills `json` with the answer to one line: begun, with mu_query_put_id. False: `error` says why there is none. */
typedef _Bool mu_answerer(void *context, const mu_document *line, mu_json *json, mu_error *error);

/* Answers all lines of a file ("-": standard input) that are not blank, on standard output; one that cannot be answered
 * gets {"id", "error"}, and the others go on. The exit code: 1 if there was one, or standard output failed; 2 if the file
 * cannot be read. Answers are on their way before more is waited for. */
int mu_answer_file(const mu_usage *usage, const char *input, mu_answerer *answer, void *context);

#endif
