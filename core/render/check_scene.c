/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_scene.c: the materials of a scene file; nothing else of the scene is read. */
#include "core/render/check_scene.h"

#include <stdio.h>
#include <stdlib.h>

/* One material of a scene; one that cannot be checked is named, with the reason, and passed over. */
static _Bool collect(mu_check_materials *all, mu_plugins *plugins, const mu_place *place,
                     musurf_precision precision, mu_error *error) {
    mu_check_material *items = realloc(all->items, (all->count + 1) * sizeof *items);
    if (!items) return mu_fail(error, "not enough memory");
    all->items = items;
    mu_check_material *item = &items[all->count];
    mu_material test;
    mu_error why = {.text = ""};
    if (!mu_material_read(&test, plugins, place, error)) return 0; /* wrong, not merely out of scope */
    mu_material_free(&test);
    if (!mu_check_material_read(item, plugins, place, precision, &why)) {
        fprintf(stderr, "musurf check: passed over: %s\n", why.text);
        return 1;
    }
    if (!mu_subject_find_plane(&item->subject)) {
        fprintf(stderr, "musurf check: passed over: %s: its sampled normals lie on a line\n", item->json);
        mu_check_material_free(item);
        return 1;
    }
    if (item->subject.bounces == MU_WALKS)
        fprintf(stderr,
                "musurf check: %s: a random walk: f is an estimate and pdf not the density of its samples, which nobody "
                "knows, so energy and reciprocity are asked on average, and no law of f, weight or pdf at a point\n",
                item->json);
    all->count++;
    return 1;
}

_Bool mu_check_collect(mu_check_materials *all, mu_plugins *plugins, const char *file,
                       musurf_precision precision, mu_error *error) {
    mu_document document;
    if (!mu_document_read(&document, file, error)) return 0;
    const mu_place root = mu_place_root(&document), materials = mu_place_member(&root, "materials");
    const mu_place objects = mu_place_member(&root, "objects");
    const size_t before = all->count;
    _Bool good = 1, any = 0;
    const char *name;
    json_t *value;
    json_object_foreach(materials.value, name, value) {
        const mu_place place = mu_place_member(&materials, name);
        any = 1;
        good = good && collect(all, plugins, &place, precision, error);
    }
    for (size_t i = 0; good && i < json_array_size(objects.value); i++) {
        const mu_place object = mu_place_element(&objects, i), place = mu_place_member(&object, "material");
        if (!json_is_object(place.value)) continue; /* a name: it stands in "materials" */
        any = 1;
        good = collect(all, plugins, &place, precision, error);
    }
    if (good && !any)
        good = mu_place_fail(&root, error, "has no materials: neither in \"materials\" nor in \"objects\"");
    else if (good && all->count == before)
        fprintf(stderr, "musurf check: %s: none of its materials can be checked\n", file);
    mu_document_free(&document);
    return good;
}

void mu_check_materials_free(mu_check_materials *all) {
    for (size_t i = 0; i < all->count; i++) mu_check_material_free(&all->items[i]);
    free(all->items);
    *all = (mu_check_materials){NULL, 0};
}
