/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* vary_name.h: from the name of a varying value (vary.h) to its path in the scene file, and along that path. */
#ifndef MU_VARY_NAME_H
#define MU_VARY_NAME_H

#include "core/render/document.h"

/* "$.materials.metal.alpha" for "alpha", "metal.alpha", or itself; to be freed. NULL: the error says why. */
char *mu_vary_path(const char *name, const mu_document *scene, mu_error *error);
/* Sets what stands at the path. All but its last step must be there. */
_Bool mu_vary_set(const char *path, json_t *value, mu_document *scene, mu_error *error);

#endif
