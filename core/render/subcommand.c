/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* subcommand.c: finds the word, or the one that was meant. */
#include "core/render/subcommand.h"

#include <stdio.h>
#include <string.h>

#include "core/render/document.h"
#include "core/render/error.h"

enum { MU_SUBCOMMANDS_MOST = 16 };

int mu_run_subcommand(const mu_usage *usage, const mu_subcommand *of, int argc, char **argv) {
    const char *known[MU_SUBCOMMANDS_MOST + 1] = {NULL};
    char list[256] = "";
    for (int k = 0; of[k].name && k < MU_SUBCOMMANDS_MOST; k++) {
        if (argc > 1 && strcmp(argv[1], of[k].name) == 0) return of[k].run(argc - 1, argv + 1);
        const size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", k ? (of[k + 1].name ? ", " : " or ") : "",
                 of[k].name);
        known[k] = of[k].name;
    }
    mu_options given = mu_options_begin(usage, argc, argv);
    const int met = mu_options_next(&given);
    if (met == MU_OPTIONS_HELP || met == MU_OPTIONS_REFUSED) return mu_options_exit(met);
    if (met != MU_OPTIONS_OPERAND) return mu_refuse(usage, "%s? See musurf %s --help", list, usage->command);
    const char *const nearest = mu_nearest(given.value, known);
    return nearest ? mu_refuse(usage, "there is no \"%.60s\"; did you mean \"%s\"?", given.value, nearest)
                   : mu_refuse(usage, "there is no \"%.60s\"; %s?", given.value, list);
}
