/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* pose.c: a pose read from a scene or from the command line. */
#include "core/render/pose.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/scene_read.h"

static _Bool read_morphs(const mu_place *place, mu_pose *pose, mu_error *error) {
    const char *name;
    json_t *value;
    if (!place->value) return 1;
    if (!json_is_object(place->value))
        return mu_place_fail(place, error, "must be an object: names of targets, each with its weight");
    pose->morph = calloc(json_object_size(place->value) + 1, sizeof *pose->morph);
    if (!pose->morph) return mu_fail(error, "not enough memory for a pose");
    json_object_foreach(place->value, name, value) {
        const mu_place weight = mu_place_member(place, name);
        mu_morph *morph = &pose->morph[pose->morphs];
        if (!mu_place_number(&weight, -1e3, 1e3, &morph->weight, error)) return 0;
        morph->name = strdup(name);
        if (!morph->name) return mu_fail(error, "not enough memory for a pose");
        pose->morphs++;
    }
    return 1;
}

static _Bool read_animation(const mu_place *place, mu_pose *pose, mu_error *error) {
    char number[24];
    const char *name = number;
    if (!place->value) return 1;
    if (json_is_integer(place->value)) {
        long long value;
        if (!mu_place_integer(place, 0, 1 << 20, &value, error)) return 0;
        snprintf(number, sizeof number, "%lld", value);
    } else if (!mu_place_string(place, &name, error)) {
        return 0;
    }
    pose->animation = strdup(name);
    return pose->animation || mu_fail(error, "not enough memory for a pose");
}

_Bool mu_pose_read(const mu_place *place, mu_pose *pose, mu_error *error) {
    memset(pose, 0, sizeof *pose);
    if (!mu_place_only(place, mu_scene_keys(MU_KEYS_POSE), error)) return 0;
    const mu_place morph = mu_place_member(place, "morph"), animation = mu_place_member(place, "animation"),
                   time = mu_place_member(place, "time");
    const _Bool good = read_morphs(&morph, pose, error) && read_animation(&animation, pose, error) &&
                       (!time.value || mu_place_number(&time, 0, 1e9, &pose->time, error)) &&
                       (!time.value || pose->animation ||
                        mu_place_fail(&time, error, "is the time of an \"animation\", which is not named"));
    if (!good) mu_pose_free(pose);
    return good;
}

_Bool mu_pose_parse(const char *text, mu_pose *pose, mu_error *error) {
    mu_document document;
    memset(pose, 0, sizeof *pose);
    if (!mu_document_parse(&document, "--pose", text, strlen(text), 1, error)) return 0;
    const mu_place root = mu_place_root(&document);
    const _Bool good = mu_pose_read(&root, pose, error);
    mu_document_free(&document);
    return good;
}

void mu_pose_free(mu_pose *pose) {
    for (uint32_t i = 0; i < pose->morphs; i++) free(pose->morph[i].name);
    free(pose->morph);
    free(pose->animation);
    memset(pose, 0, sizeof *pose);
}
