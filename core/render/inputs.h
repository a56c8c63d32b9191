/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * inputs.h: files of which something is made are not replaced by what is made of them.
 *
 * Every text in a scene that names a file, relative to the scene, counts as one of these: meshes, meshes at rest, pictures,
 * histograms, materials in files of their own, and what those name.
 */
#ifndef MU_INPUTS_H
#define MU_INPUTS_H

#include "core/render/document.h"

/* Whether writing `output` would replace `input`: both are there, and one file. Either may be NULL. */
_Bool mu_is_same_file(const char *output, const char *input);
/* Fails if it would. */
_Bool mu_input_keep(const char *output, const char *input, mu_error *error);
/* Fails if one of the outputs, of which some may be NULL, would replace the scene's file or what it names. */
_Bool mu_inputs_keep(const mu_document *scene, const char *const *outputs, size_t count, mu_error *error);

#endif
