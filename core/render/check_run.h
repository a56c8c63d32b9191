/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_run.h: the jobs of a check, one per material, on any number of threads. The result is the same for
 * any number: each job has random streams of its own, and tallies are added in the order of jobs.
 */
#ifndef MU_CHECK_RUN_H
#define MU_CHECK_RUN_H

#include "core/render/check_material.h"
#include "core/render/check_tests.h"

typedef struct mu_check_settings {
    uint64_t seed;
    size_t materials; /* random ones */
    uint32_t threads;
    musurf_precision precision;
    mu_check_effort effort;
    int views; /* per material, at most MU_VIEWS */
    _Bool show_progress;
} mu_check_settings;

/* Random materials of type `type_id`, then `given` ones. Adds to the tally. */
_Bool mu_check_run(const mu_check_settings *settings, mu_plugins *plugins, const char *type_id,
                   mu_check_material *given, size_t given_count, mu_tally *tally, mu_error *error);

#endif
