/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* answers.c: line in, line out; what a line asks is its command's business. */
#include "core/render/answers.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/render/lines.h"
#include "core/render/query.h"

typedef struct answers {
    mu_answerer *answer;
    void *context;
    mu_json json;
    const char *name; /* of the file, for messages */
    size_t lines, bad;
    int output_failure; /* errno of the write that failed */
} answers;

/* True unless standard output failed. */
static _Bool answer_line(answers *a, mu_line status, const char *text, size_t length, size_t number) {
    mu_error error = {.text = ""};
    mu_document document = {0};
    _Bool good = 0;
    a->lines++;
    if (status == MU_LINE_TOO_LONG)
        mu_fail(&error, "%s:%zu: the line is longer than %d MiB", a->name, number, MU_DOCUMENT_LIMIT >> 20);
    else if (mu_document_parse(&document, a->name, text, length, number, &error))
        good = a->answer(a->context, &document, &a->json, &error);
    if (!good) {
        a->bad++;
        mu_json_begin(&a->json);
        mu_query_put_id(&a->json, text, status == MU_LINE ? length : 0, 1);
        mu_json_string(&a->json, "error", error.text);
    }
    mu_document_free(&document);
    if (mu_json_write(&a->json, stdout)) return 1;
    a->output_failure = errno;
    return 0;
}

static _Bool is_blank(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++)
        if (!strchr(" \t\r", text[i]) || !text[i]) return 0;
    return 1;
}

static _Bool flush_answers(void *context) {
    answers *a = context;
    if (fflush(stdout) == 0) return 1;
    a->output_failure = errno;
    return 0;
}

static int answer_all(answers *a, const mu_usage *usage, int file) {
    mu_lines lines = {.file = file, .before_read = flush_answers, .context = a};
    const char *text;
    size_t length;
    mu_line status;
    _Bool written = 1;
    while (written) {
        status = mu_lines_next(&lines, MU_DOCUMENT_LIMIT, &text, &length);
        if (status == MU_LINES_END || status == MU_LINES_FAILED) break;
        if (!is_blank(text, length)) written = answer_line(a, status, text, length, lines.number);
    }
    const int failure = lines.failure;
    mu_lines_free(&lines);
    if (a->output_failure || !flush_answers(a)) {
        fprintf(stderr, "musurf %s: standard output: %s\n", usage->command, strerror(a->output_failure));
        return MU_EXIT_FAILED;
    }
    if (failure) return mu_refuse(usage, "%s: cannot be read: %s", a->name, strerror(failure));
    if (a->bad)
        fprintf(stderr, "musurf %s: %zu of %zu lines could not be answered\n", usage->command, a->bad,
                a->lines);
    return a->bad ? MU_EXIT_FAILED : MU_EXIT_OK;
}

int mu_answer_file(const mu_usage *usage, const char *input, mu_answerer *answer, void *context) {
    const _Bool standard = strcmp(input, "-") == 0;
    const int file = standard ? STDIN_FILENO : open(input, O_RDONLY | O_CLOEXEC);
    if (file < 0) return mu_refuse(usage, "%s: cannot be opened: %s", input, strerror(errno));
    answers a = {.answer = answer, .context = context, .name = standard ? "stdin" : input};
    const int code = answer_all(&a, usage, file);
    mu_json_free(&a.json);
    if (!standard) close(file);
    return code;
}
