/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_scene.h: the materials of given scenes. */
#ifndef MU_CHECK_SCENE_H
#define MU_CHECK_SCENE_H

#include "core/render/check_material.h"

typedef struct mu_check_materials {
    mu_check_material *items;
    size_t count;
} mu_check_materials;

/* Adds the constant materials of the scene file that offer the probe; says on stderr which others are passed
 * over and why. False if the file or a material in it is wrong. */
_Bool mu_check_collect(mu_check_materials *all, mu_plugins *plugins, const char *file,
                       musurf_precision precision, mu_error *error);
void mu_check_materials_free(mu_check_materials *all);

#endif
