/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_material.h: from JSON to a subject under test. */
#ifndef MU_CHECK_MATERIAL_H
#define MU_CHECK_MATERIAL_H

#include "core/render/check_subject.h"
#include "core/render/material.h"

typedef struct mu_check_material {
    mu_material material;
    mu_subject subject; /* its plane is left to the caller */
    char *json;
} mu_check_material;

/* False with the reason: not a material, not one that can be probed at all points alike, a mirror. */
_Bool mu_check_material_read(mu_check_material *out, mu_plugins *plugins, const mu_place *place,
                             musurf_precision precision, mu_error *error);
_Bool mu_check_material_parse(mu_check_material *out, mu_plugins *plugins, const char *json,
                              musurf_precision precision, mu_error *error);
void mu_check_material_free(mu_check_material *material);

#endif
