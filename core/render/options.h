/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* options.h: a command's arguments and its --help, both from one table, so that the help is complete. */
#ifndef MU_OPTIONS_H
#define MU_OPTIONS_H

#include <stdint.h>

typedef struct mu_option {
    const char *name;     /* "precision" for --precision, "o" for -o */
    const char *argument; /* "float|double"; NULL if it takes none */
    const char *doc;      /* lines separated by newlines */
} mu_option;

typedef struct mu_usage {
    const char *command;      /* "eval" */
    const char *synopsis;     /* "[--precision float|double] [FILE]" */
    const char *doc;          /* what it does; whole lines */
    const mu_option *options; /* ends with a NULL name; --help is understood without being listed */
    const char *more;         /* after the options; whole lines, or NULL */
} mu_usage;

typedef struct mu_options {
    const mu_usage *usage;
    int argc;
    char **argv;
    int next;
    _Bool operands_only; /* after "--" */
    const char *name;    /* of the option just met */
    const char *value;   /* its argument, or the operand */
} mu_options;

enum { MU_OPTIONS_END = -1, MU_OPTIONS_OPERAND = -2, MU_OPTIONS_REFUSED = -3, MU_OPTIONS_HELP = -4 };

mu_options mu_options_begin(const mu_usage *usage, int argc, char **argv);
/* Index of the option met, or one of the above. Refused: a line on stderr said why. Help: it is on stdout. */
int mu_options_next(mu_options *options);
/* The exit code for what is neither option nor operand. */
int mu_options_exit(int met);

/* The value of the option just met as a whole number; false after a line on stderr. */
_Bool mu_options_unsigned(const mu_options *options, uint64_t min, uint64_t max, uint64_t *out);
/* One of the NULL-terminated choices. */
_Bool mu_options_choice(const mu_options *options, const char *const *choices, int *out);
/* The processors that this process may use, which taskset and containers restrict. */
uint32_t mu_processors(void);
/* A line "musurf COMMAND: ..." on stderr. Always returns MU_EXIT_REFUSED. */
int mu_refuse(const mu_usage *usage, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
