/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * pose.h: a pose of a mesh that its file can deform: weights of its morph targets, and a moment of one of its animations.
 *
 * Written {"morph": {"Inflate": 0.7}, "animation": "Walk", "time": 1.25}. Targets that are not named have the
 * animation's weight, else 0; a target or an animation without a name has its number, from 0 on. Seconds before the
 * first or after the last key stand still.
 */
#ifndef MU_POSE_H
#define MU_POSE_H

#include <stdint.h>

#include "core/render/document.h"

typedef struct mu_morph {
    char *name;
    double weight;
} mu_morph;

typedef struct mu_pose {
    _Bool bind;      /* none of all this: the shape that is deformed, with the nodes as the file has them */
    char *animation; /* NULL: none */
    double time;     /* seconds */
    mu_morph *morph;
    uint32_t morphs;
} mu_pose;

/* `place` has a value. */
_Bool mu_pose_read(const mu_place *place, mu_pose *pose, mu_error *error);
/* From the command line: JSON. */
_Bool mu_pose_parse(const char *text, mu_pose *pose, mu_error *error);
void mu_pose_free(mu_pose *pose);

#endif
