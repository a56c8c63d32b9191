/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_progress.h: what a render says on stderr while it runs and when it ends. */
#ifndef MU_RENDER_PROGRESS_H
#define MU_RENDER_PROGRESS_H

#include "core/render/json_out.h"
#include "core/render/render.h"
#include "core/render/render_options.h"

typedef struct mu_progress {
    enum { MU_SHOW_NOTHING, MU_SHOW_LAST, MU_SHOW_BAR, MU_SHOW_JSON } show;
    const char *command; /* "render" */
    mu_json json;
    double last; /* when a line of JSON was written */
    _Bool drawn; /* a bar stands on the terminal's line */
} mu_progress;

mu_progress mu_progress_begin(const mu_render_options *options);
void mu_progress_report(mu_progress *progress, const mu_render_status *status);
/* Before the first sample: so many materials are ready for the light. */
void mu_progress_prepare(mu_progress *progress, uint32_t done, uint32_t count);
/* Takes the bar away, before something else is written. */
void mu_progress_clear(mu_progress *progress);
/* A remark in between. */
void mu_progress_note(mu_progress *progress, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* The same as mu_error's warn wants it; the context is the progress. */
void mu_progress_warn(void *progress, const char *text);
/* The last line: `event` is "done" or "interrupted", `file` the image that was written, or NULL. */
void mu_progress_end(mu_progress *progress, const char *event, const char *file, const mu_film *film);

#endif
