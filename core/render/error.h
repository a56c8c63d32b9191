/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* error.h: one clear line for the user, carried up to the command that prints it, and warnings on the way. */
#ifndef MU_ERROR_H
#define MU_ERROR_H

/* Exit codes of every command (README, "The command line"). */
enum { MU_EXIT_OK = 0, MU_EXIT_FAILED = 1, MU_EXIT_REFUSED = 2, MU_EXIT_INTERRUPTED = 130 };

typedef struct mu_error {
    char text[1024]; /* no newline, no "musurf: " in front; empty while nothing went wrong */
    void (*warn)(void *context, const char *text); /* where warnings go; NULL: a line on stderr */
    void *context;
} mu_error;

/* Formats the message, keeping the first if one is there already (the first is the cause). Always returns
 * false, so `return mu_fail(error, ...)` reads well. Bytes that are not printable UTF-8 are replaced. */
_Bool mu_fail(mu_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* What the user should know although all goes on. Leaves error->text alone. */
void mu_warn(const mu_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
