/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* material_file.c: a material that stands in a file of its own. What is wrong in it is said with its own name, line and column. */
#include "core/render/material_file.h"

#include <stdlib.h>
#include <string.h>

_Bool mu_names_material_file(const mu_place *place) {
    return json_is_object(place->value) && json_object_get(place->value, "file") &&
           !json_object_get(place->value, "material");
}

_Bool mu_material_file_read(mu_document *document, const mu_place *place, mu_error *error) {
    static const char *const known[] = {"file", NULL};
    const mu_place member = mu_place_member(place, "file");
    const char *name;
    *document = (mu_document){0};
    if (!mu_place_only(place, known, error) || !mu_place_string(&member, &name, error)) return 0;
    char *file = mu_document_beside(place->document, name);
    mu_error why = {.text = ""};
    const _Bool good = file && mu_document_read(document, file, &why);
    if (!file) {
        mu_place_fail(&member, error, "not enough memory");
    } else if (!good) { /* a file that is there says by itself where it is wrong */
        const size_t length = strlen(file);
        if (strncmp(why.text, file, length) == 0 && why.text[length] == ':' && why.text[length + 1] == ' ')
            mu_place_fail(&member, error, "%s", why.text);
        else
            mu_fail(error, "%s", why.text);
    }
    free(file);
    if (!good) return 0;
    const mu_place root = mu_place_root(document);
    if (!mu_names_material_file(&root)) return 1;
    const mu_place other = mu_place_member(&root, "file");
    mu_place_fail(&other, error, "a material file holds a material, not the name of another file");
    mu_document_free(document);
    return 0;
}

/* FNV-1a. */
uint64_t mu_material_file_digest(const mu_document *document) {
    uint64_t digest = 0xcbf29ce484222325u;
    for (size_t i = 0; i < document->length; i++)
        digest = (digest ^ (unsigned char)document->text[i]) * 0x100000001b3u;
    return digest;
}
