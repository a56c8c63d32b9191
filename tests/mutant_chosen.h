/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mutant_chosen.h: the mutant (core/bsdf/mutant.h) of this process, by the environment variable MUSURF_CHOSEN_MUTANT; 0 without. For
 * test_mutants.py, which has the core compiled with -DMUSURF_MUTANT=mu_mutant_chosen -include tests/mutant_chosen.h. Known before
 * anything else runs, in each object of its own.
 */
#ifndef MU_MUTANT_CHOSEN_H
#define MU_MUTANT_CHOSEN_H

#include <stdlib.h>

static int mu_mutant_chosen;

__attribute__((constructor)) static void mu_mutant_choose(void) {
    const char *text = getenv("MUSURF_CHOSEN_MUTANT");
    mu_mutant_chosen = text ? atoi(text) : 0;
}

#endif
