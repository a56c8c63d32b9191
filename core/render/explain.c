/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * explain.c: one JSON object with
 *   features, left_out   names from features.h; what each left-out one would have brought
 *   materials            of each: plan, sampler and why, bytes of closure, tables, textures and the whole, lobes, and what it left out
 *   meshes               of each: vertices, triangles, whether tangents were made and a mesh at rest read
 *   lights               bytes of the light filtered in advance, the sampling table and the image
 *   plugins, libraries   files opened by name; shared objects in the process
 */
#include "core/render/explain.h"

#include <errno.h>
#include <jansson.h>
#include <link.h>
#include <string.h>

#include "core/render/features.h"
#include "core/render/filtered.h"
#include "core/render/normal_map.h"
#include "core/render/varying.h"

/* "a, b" as ["a", "b"]. */
static json_t *split(const char *list) {
    json_t *out = json_array();
    while (list && *list) {
        const size_t length = strcspn(list, ",");
        json_array_append_new(out, json_stringn(list, length));
        list += length;
        list += strspn(list, ", ");
    }
    return out;
}

static json_t *material(const mu_named_material *named) {
    static const struct {
        uint32_t bit;
        const char *name;
    } lobes[] = {{MUSURF_GLOSSY_REFLECTION, "glossy_reflection"},
                 {MUSURF_DELTA_REFLECTION, "delta_reflection"},
                 {MUSURF_GLOSSY_TRANSMISSION, "glossy_transmission"},
                 {MUSURF_DELTA_TRANSMISSION, "delta_transmission"},
                 {MUSURF_DIFFUSE_REFLECTION, "diffuse_reflection"},
                 {MUSURF_DIFFUSE_TRANSMISSION, "diffuse_transmission"}};
    const musurf_plan *plan = &named->material.plan;
    const mu_normal_map *normals = named->material.normal_map;
    json_t *names = json_array();
    for (size_t i = 0; i < sizeof lobes / sizeof *lobes; ++i)
        if (plan->lobes & lobes[i].bit) json_array_append_new(names, json_string(lobes[i].name));
    return json_pack(
        "{s:s, s:s, s:s, s:s, s:I, s:I, s:I, s:I, s:I, s:b, s:s, s:o, s:o}", "name", named->name, "material",
        named->material.type->id, "plan", plan->name ? plan->name : "", "sampler",
        plan->sampler ? plan->sampler : "", "closure_bytes",
        (json_int_t)plan->closure_bytes, "table_bytes", (json_int_t)plan->table_bytes, "material_bytes",
        (json_int_t)plan->material_bytes, "texture_bytes",
        (json_int_t)((named->material.varying ? mu_mipmap_bytes(&named->material.varying->mipmap) : 0) +
                     (normals ? mu_mipmap_bytes(&normals->moments) : 0)), "slot_floats", (json_int_t)plan->slot_floats, "needs_tangent",
        (plan->needs & MUSURF_NEEDS_TANGENT) != 0, "normal_map",
        !normals ? "none" : normals->map ? "turns and widens" : "turns", "lobes", names, "left_out", split(plan->left_out));
}

static json_t *mesh(const mu_mesh *m) {
    return json_pack("{s:s, s:I, s:I, s:b, s:b, s:b}", "name", m->name, "vertices", (json_int_t)m->vertex_count,
                     "triangles", (json_int_t)m->triangle_count, "uvs", m->uvs != NULL, "tangents",
                     m->tangents != NULL, "tension", m->tension != NULL);
}

/* The dynamic linker's own list: the file names of all shared objects now in the process. */
static int collect(struct dl_phdr_info *info, size_t size, void *context) {
    const char *slash = strrchr(info->dlpi_name, '/');
    const char *name = slash ? slash + 1 : info->dlpi_name;
    (void)size;
    if (*name) json_array_append_new(context, json_string(name)); /* the program itself has no name */
    return 0;
}

_Bool mu_explain(const mu_scene *scene, const mu_lights *lights, FILE *out, mu_error *error) {
    const mu_feature *list = mu_feature_list();
    const uint32_t bits = mu_features_of(scene);
    json_t *needed = json_array(), *left_out = json_object(), *materials = json_array(),
           *meshes = json_array(), *plugins = json_array(), *libraries = json_array();
    for (int i = 0; i < MU_FEATURE_COUNT; ++i) {
        if (bits >> i & 1u)
            json_array_append_new(needed, json_string(list[i].name));
        else
            json_object_set_new(left_out, list[i].name, json_string(list[i].brings));
    }
    for (uint32_t i = 0; i < scene->material_count; ++i)
        json_array_append_new(materials, material(&scene->materials[i]));
    for (uint32_t i = 0; i < scene->mesh_count; ++i) json_array_append_new(meshes, mesh(&scene->meshes[i]));
    for (size_t i = 0; mu_plugins_opened(scene->plugins, i); ++i)
        json_array_append_new(plugins, json_string(mu_plugins_opened(scene->plugins, i)));
    dl_iterate_phdr(collect, libraries);

    json_t *file = json_string(scene->file);
    if (!file) file = json_string("(its name is not UTF-8)");
    json_t *all =
        json_pack("{s:o, s:o, s:o, s:o, s:o, s:{s:I, s:I, s:I}, s:o, s:o}", "scene", file, "features", needed,
                  "left_out", left_out, "materials", materials, "meshes", meshes, "lights", "filtered_bytes",
                  (json_int_t)(scene->integrator.by_image ? mu_filtered_bytes(lights) : 0), "table_bytes",
                  (json_int_t)mu_lights_table_bytes(lights), "image_bytes",
                  (json_int_t)mu_lights_image_bytes(lights), "plugins", plugins, "libraries", libraries);
    if (!all) return mu_fail(error, "not enough memory for --explain");
    errno = 0;
    const _Bool written =
        !json_dumpf(all, out, JSON_INDENT(2)) && fputc('\n', out) != EOF && fflush(out) != EOF;
    const int why = errno;
    json_decref(all);
    return written || mu_fail(error, "standard output: %s", why ? strerror(why) : "could not be written");
}
