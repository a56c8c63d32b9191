/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_digest.c: a multiplicative hash, eight bytes at a time (after Knuth's golden-ratio multiplier). */
#include "core/render/scene_digest.h"

#include <stdio.h>
#include <string.h>

static uint64_t mix(uint64_t digest, uint64_t word) {
    digest = (digest ^ word) * 0x9e3779b97f4a7c15u;
    return digest ^ digest >> 32;
}

/* The length goes in too, so that two pieces side by side cannot trade bytes. */
static uint64_t add(uint64_t digest, const void *data, size_t bytes) {
    const char *from = data;
    digest = mix(digest, bytes);
    while (from && bytes) {
        uint64_t word = 0;
        const size_t part = bytes < sizeof word ? bytes : sizeof word;
        memcpy(&word, from, part);
        digest = mix(digest, word);
        from += part;
        bytes -= part;
    }
    return digest;
}

/* A file that cannot be read counts as its absence: whoever needs it has complained already. */
static uint64_t add_file(uint64_t digest, const char *file) {
    char block[8192];
    size_t got;
    FILE *stream = fopen(file, "rbe");
    if (!stream) return mix(digest, 0);
    while ((got = fread(block, 1, sizeof block, stream)) > 0) digest = add(digest, block, got);
    fclose(stream);
    return digest;
}

uint64_t mu_scene_digest(const mu_scene *scene, uint64_t seed) {
    uint64_t digest = add(seed, MUSURF_VERSION, strlen(MUSURF_VERSION));
    digest = add(digest, scene->text, strlen(scene->text));
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        const mu_mesh *mesh = &scene->meshes[i];
        const size_t n = mesh->vertex_count;
        digest = add(digest, mesh->indices, 3 * sizeof(uint32_t) * mesh->triangle_count);
        digest = add(digest, mesh->positions, 3 * sizeof(float) * n);
        digest = add(digest, mesh->normals, mesh->normals ? 3 * sizeof(float) * n : 0);
        digest = add(digest, mesh->uvs, mesh->uvs ? 2 * sizeof(float) * n : 0);
        if (mesh->tension) digest = add(digest, mesh->tension, 4 * sizeof(float) * n);
        for (int k = 0; k < MU_ATTRIBUTES; ++k)
            if (mesh->attributes[k]) digest = add(digest, mesh->attributes[k], sizeof(float) * n);
        digest = add(digest, mesh->tangents, mesh->tangents ? 4 * sizeof(float) * n : 0);
    }
    for (uint32_t i = 0; i < scene->light_count; ++i)
        if (scene->lights[i].kind == MU_ENVIRONMENT && scene->lights[i].image)
            digest = add_file(digest, scene->lights[i].image);
    for (uint32_t i = 0; i < scene->material_count; ++i)
        digest = mix(digest, scene->materials[i].material.digest);
    digest = mix(digest, scene->integrator.by_image ? 1u + (uint64_t)scene->integrator.technique : 0);
    digest = mix(digest, scene->integrator.reads);
    digest = add(digest, &scene->integrator.k, sizeof scene->integrator.k);
    digest = add(digest, &scene->integrator.beta, sizeof scene->integrator.beta);
    digest = mix(digest, scene->integrator.appendix_c);
    digest = mix(digest, 2u * scene->integrator.tails + scene->integrator.means);
    const char *plugin;
    for (size_t i = 0; (plugin = mu_plugins_opened(scene->plugins, i)); ++i)
        digest = add_file(digest, plugin);
    return digest;
}

uint64_t mu_digest_file(uint64_t digest, const char *file) {
    return add_file(digest, file);
}

uint64_t mu_digest_text(uint64_t digest, const char *text) {
    return add(digest, text, strlen(text));
}
