/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_digest.h: 64 bits that change when a checkpoint of the scene no longer fits. */
#ifndef MU_SCENE_DIGEST_H
#define MU_SCENE_DIGEST_H

#include "core/render/scene.h"

/* Of everything the samples depend on but the size of the image: the scene's text, meshes, environment image, grids
 * of materials, plugins (the files' bytes), the seed and the version of musurf. Against mistakes, not against malice. */
uint64_t mu_scene_digest(const mu_scene *scene, uint64_t seed);

/* `digest` changed by the bytes of a file, or of a text. */
uint64_t mu_digest_file(uint64_t digest, const char *file);
uint64_t mu_digest_text(uint64_t digest, const char *text);

#endif
