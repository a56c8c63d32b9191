/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * material_file.h: {"file": "gold.json"} in the place of a material: one that stands in a file of its own, which other hosts
 * and scenes may read, too. The file holds the object that would stand here; "$schema" and "description" may be in it.
 */
#ifndef MU_MATERIAL_FILE_H
#define MU_MATERIAL_FILE_H

#include <stdint.h>

#include "core/render/document.h"

/* Whether the object at `place` names a file in place of a material. */
_Bool mu_names_material_file(const mu_place *place);
/* Reads the file, which is beside the document; to be freed with mu_document_free. */
_Bool mu_material_file_read(mu_document *document, const mu_place *place, mu_error *error);
/* 64 bits that change with the file's text. */
uint64_t mu_material_file_digest(const mu_document *document);

#endif
