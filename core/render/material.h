/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * material.h: plugins, and materials made from JSON by a plugin's parameter table.
 *
 * "material": "vendor.name" names a type of vendor_material.so, looked for where search.h
 * says. Everything else in the object is a parameter of that table, except
 * the keys that the renderer itself serves ("jacobian", "normal_map"). What may vary may have a source (source.h) instead of a value.
 * Warnings of a plugin go to stderr. {"file": name} stands for the material in that file (material_file.h).
 */
#ifndef MU_MATERIAL_H
#define MU_MATERIAL_H

#include "core/render/document.h"
#include "core/render/jacobian.h"
#include "plugin/musurf_plugin.h"

/* Shared objects opened so far; each is opened once, and only when something names it. */
typedef struct mu_plugins mu_plugins;

mu_plugins *mu_plugins_new(void);
void mu_plugins_free(mu_plugins *plugins); /* after all materials */
/* NULL on failure: the error says which files were tried, or what the vendor's plugin offers. */
const musurf_material_type *mu_plugins_type(mu_plugins *plugins, const char *id, mu_error *error);
/* The files opened, for --explain; NULL past the end. */
const char *mu_plugins_opened(const mu_plugins *plugins, size_t index);

/* What the renderer hands to setup: M and the footprint, where it makes them, then values from sources (varying.h). */
enum { MU_SLOT_TRANSFORM = 0, MU_SLOT_FOOTPRINT = 4, MU_SLOT_VALUES = 10, MU_SLOTS = 26 };

struct mu_varying;
struct mu_blend;
struct mu_normal_map;

typedef struct mu_material {
    const musurf_material_type *type;
    musurf_material *compiled;
    musurf_plan plan;
    mu_jacobian jacobian; /* if any, "transform" is pushed through slots[0..3] at each hit */
    struct mu_varying *varying; /* parameters with sources; NULL: none */
    struct mu_blend *blend;     /* parameters between whose values materials are blended; `compiled` is its first */
    struct mu_normal_map *normal_map; /* NULL: none, or one that leans nowhere */
    uint64_t digest;      /* of grids and pictures among its settings, which the document may only name */
    float transform[4];   /* the constant "transform", onto which the others go: M = J T transform */
    _Bool tension;        /* T transform is pushed through slots[0..3] at each hit: T of the mesh's deformation */
    _Bool footprints;     /* the footprint is pushed through slots[4..9] at each hit */
    _Bool one_footprint;  /* the material has one of its own */
} mu_material;

/* The material described by the object at `place`. The plugin's own message about a parameter is put into the
 * error with that parameter's place in the document. */
_Bool mu_material_read(mu_material *material, mu_plugins *plugins, const mu_place *place, mu_error *error);
/* The same for a picture: with "sampler": "auto" where the plugin's sampler has that choice and the material names none.
 * `deforming`: of an object that deforms; if its type has no transform that may vary, `tension` is not set. */
_Bool mu_material_read_to_render(mu_material *material, mu_plugins *plugins, const mu_place *place,
                                 _Bool deforming, mu_error *error);
void mu_material_free(mu_material *material);

/* Its sources (source.h), blended ones last; NULL past the end. */
struct mu_source *mu_material_source(const mu_material *material, size_t index);

#endif
