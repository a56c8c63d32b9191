/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* polygons.c: PLY and glTF as they are numbered, through assimp without any of its post-processing. */
#include "core/render/polygons.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "core/render/mesh_internal.h"

typedef struct mu_gathered {
    const struct aiScene *scene;
    mu_polygons *out;
    _Bool any_uvs, any_normals;
    mu_error *error;
} mu_gathered;

static void count(mu_gathered *g, const struct aiNode *node, size_t total[3]) {
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *part = g->scene->mMeshes[node->mMeshes[i]];
        total[0] += part->mNumVertices;
        g->any_uvs |= part->mTextureCoords[0] != NULL;
        g->any_normals |= part->mNormals != NULL;
        for (unsigned f = 0; f < part->mNumFaces; f++)
            if (part->mFaces[f].mNumIndices >= 3) total[1]++, total[2] += part->mFaces[f].mNumIndices;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) count(g, node->mChildren[i], total);
}

static _Bool add_vertices(mu_gathered *g, const struct aiMesh *part, const mu_map *map) {
    for (unsigned i = 0; i < part->mNumVertices; i++, g->out->vertices++) {
        const struct aiVector3D *v = &part->mVertices[i];
        const mu_dvec3 p = mu_map_point(map, mu_d3((double)v->x, (double)v->y, (double)v->z));
        if (!(fabs(p.x) <= 1e9 && fabs(p.y) <= 1e9 && fabs(p.z) <= 1e9))
            return mu_fail(g->error, "%s: vertex %u has a position of (%g, %g, %g); must be within 1e9",
                           g->out->file, (unsigned)g->out->vertices, p.x, p.y, p.z);
        double *at = g->out->position + 3 * (size_t)g->out->vertices;
        at[0] = p.x, at[1] = p.y, at[2] = p.z;
    }
    return 1;
}

/* What the corner has besides its position. */
static void add_corner(mu_gathered *g, const struct aiMesh *part, const mu_map *map, unsigned i) {
    const size_t at = g->out->corners;
    if (g->out->uv) {
        const struct aiVector3D *uv = part->mTextureCoords[0] ? &part->mTextureCoords[0][i] : NULL;
        g->out->uv[2 * at] = uv ? (double)uv->x : NAN;
        g->out->uv[2 * at + 1] = uv ? (double)uv->y : NAN;
    }
    if (g->out->normal && part->mNormals) {
        const struct aiVector3D *v = &part->mNormals[i];
        const mu_dvec3 n = mu_transpose_times(map->inverse, mu_d3((double)v->x, (double)v->y, (double)v->z));
        const mu_vec3 unit = mu_single(mu_dnormalise(n));
        memcpy(g->out->normal + 3 * at, &unit, 3 * sizeof(float));
    }
}

static _Bool add_part(mu_gathered *g, const struct aiMesh *part, const mu_map *map) {
    mu_polygons *out = g->out;
    const uint32_t base = out->vertices;
    if (!add_vertices(g, part, map)) return 0;
    for (unsigned f = 0; f < part->mNumFaces; f++) {
        const struct aiFace *face = &part->mFaces[f];
        const unsigned last = face->mNumIndices - 1;
        if (face->mNumIndices < 3) continue;
        if (face->mNumIndices > MU_POLYGON_MOST)
            return mu_fail(g->error, "%s: a face of %u vertices; at most %d", out->file, face->mNumIndices,
                           MU_POLYGON_MOST);
        out->first[out->faces++] = out->corners;
        for (unsigned k = 0; k <= last; k++, out->corners++) {
            const unsigned i = face->mIndices[map->determinant < 0 ? last - k : k]; /* keep the outside */
            if (i >= part->mNumVertices)
                return mu_fail(g->error, "%s: a face names vertex %u of %u", out->file, i,
                               part->mNumVertices);
            out->vertex[out->corners] = base + i;
            add_corner(g, part, map, i);
        }
    }
    return 1;
}

static _Bool add_node(mu_gathered *g, const struct aiNode *node, const struct aiMatrix4x4 *parent) {
    struct aiMatrix4x4 m = *parent;
    aiMultiplyMatrix4(&m, &node->mTransformation);
    const mu_affine affine = {{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}};
    mu_map map;
    if (node->mNumMeshes && !mu_map_make(&map, &affine))
        return mu_fail(g->error, "%s: the transformation of node '%s' is singular", g->out->file,
                       node->mName.data);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (!add_part(g, g->scene->mMeshes[node->mMeshes[i]], &map)) return 0;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!add_node(g, node->mChildren[i], &m)) return 0;
    return 1;
}

static _Bool gather(mu_gathered *g) {
    mu_polygons *out = g->out;
    size_t total[3] = {0, 0, 0};
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    count(g, g->scene->mRootNode, total);
    if (!total[1]) return mu_fail(g->error, "%s: the mesh is empty: it has no faces", out->file);
    if (total[0] > 0x40000000u || total[2] > 0xc0000000u)
        return mu_fail(g->error, "%s: more than 2^30 vertices or 3 * 2^30 corners", out->file);
    out->position = malloc(3 * total[0] * sizeof *out->position + 1);
    out->first = malloc((total[1] + 1) * sizeof *out->first);
    out->vertex = malloc(total[2] * sizeof *out->vertex);
    out->uv = g->any_uvs ? malloc(2 * total[2] * sizeof *out->uv) : NULL;
    out->normal = g->any_normals ? calloc(total[2], 3 * sizeof *out->normal) : NULL;
    if (!out->position || !out->first || !out->vertex || (g->any_uvs && !out->uv) ||
        (g->any_normals && !out->normal))
        return mu_fail(g->error, "%s: not enough memory for %zu faces", out->file, total[1]);
    if (!add_node(g, g->scene->mRootNode, &identity)) return 0;
    out->first[out->faces] = out->corners;
    return 1;
}

static _Bool read_by_assimp(mu_polygons *polygons, const char *file, mu_error *error) {
    mu_gathered g = {
        .scene = aiImportFile(file, aiProcess_ValidateDataStructure), .out = polygons, .error = error};
    _Bool good;
    if (!g.scene)
        good = mu_fail(error, "%s: cannot be read as a mesh: %s", file, aiGetErrorString());
    else if (!g.scene->mRootNode || !g.scene->mNumMeshes)
        good = mu_fail(error, "%s: the mesh is empty: it has no faces", file);
    else
        good = gather(&g);
    if (g.scene) aiReleaseImport(g.scene);
    return good;
}

_Bool mu_polygons_read(mu_polygons *polygons, const char *file, mu_error *error) {
    const char *const dot = strrchr(file, '.');
    _Bool good;
    *polygons = (mu_polygons){.file = file};
    if (access(file, R_OK)) return mu_fail(error, "%s: %s", file, strerror(errno));
    if (dot && !strcasecmp(dot, ".obj"))
        good = mu_polygons_read_obj(polygons, file, error);
    else if (dot && !strcasecmp(dot, ".ply"))
        good = mu_ply_check(file, error) && read_by_assimp(polygons, file, error);
    else if (dot && (!strcasecmp(dot, ".gltf") || !strcasecmp(dot, ".glb")))
        good = read_by_assimp(polygons, file, error);
    else
        good = mu_fail(error, "%s: not a mesh file; must be .obj, .ply, .gltf or .glb", file);
    if (!good) mu_polygons_free(polygons);
    return good;
}

void mu_polygons_free(mu_polygons *polygons) {
    free(polygons->position);
    free(polygons->first);
    free(polygons->vertex);
    free(polygons->uv);
    free(polygons->normal);
    *polygons = (mu_polygons){.file = polygons->file};
}
