/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* subcommand.h: `musurf COMMAND WORD ...`, commands that are several. */
#ifndef MU_SUBCOMMAND_H
#define MU_SUBCOMMAND_H

#include "core/render/options.h"

typedef struct mu_subcommand {
    const char *name; /* NULL ends the list */
    int (*run)(int argc, char **argv);
} mu_subcommand;

/* Runs the one that argv[1] names, with that as its argv[0]; else says what there is. The exit code. */
int mu_run_subcommand(const mu_usage *usage, const mu_subcommand *list, int argc, char **argv);

#endif
