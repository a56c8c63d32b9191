/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* explain.h: `--explain`, what a scene needed and what was left out, as one JSON object. */
#ifndef MU_EXPLAIN_H
#define MU_EXPLAIN_H

#include <stdio.h>

#include "core/render/light.h"

/* Call it once everything is built. Bytes are those of what was built, and the shared objects listed are
 * those in the process at that moment, as the dynamic linker tells them: neither is what the program believes
 * of itself. */
_Bool mu_explain(const mu_scene *scene, const mu_lights *lights, FILE *out, mu_error *error);

#endif
