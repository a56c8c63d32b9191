/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh.c: triangle meshes from OBJ, PLY, glTF and FBX files, read by assimp.
 *
 * All meshes of a file become one, each with its node's transformation applied; polygons are cut into
 * triangles, identical vertices joined, points and lines ignored. Coordinates stay as the file has them
 * (glTF's +y is up: turn it by "rotate": [1, 0, 0, 90]); v of the texture coordinates grows upwards.
 */
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "core/render/mesh_internal.h"

/* Coordinates up to this keep every product of three of them within float's range. */
#define MU_FARTHEST 1e9

typedef struct mu_gather {
    const struct aiScene *file;
    mu_mesh *mesh;
    mu_mesh_notes notes;
    _Bool has_uvs, lacks_uvs; /* some parts do, some do not */
    mu_error *error;
} mu_gather;

static const struct aiScene *import(const char *file) {
    struct aiPropertyStore *settings = aiCreatePropertyStore();
    if (!settings) return NULL;
    aiSetImportPropertyInteger(settings, AI_CONFIG_PP_RVC_FLAGS,
                               aiComponent_COLORS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                   aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS |
                                   aiComponent_TANGENTS_AND_BITANGENTS);
    aiSetImportPropertyInteger(settings, AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const struct aiScene *scene =
        aiImportFileExWithProperties(file,
                                     aiProcess_ValidateDataStructure | aiProcess_RemoveComponent |
                                         aiProcess_Triangulate | aiProcess_SortByPType,
                                     NULL, settings);
    aiReleasePropertyStore(settings);
    return scene;
}

static struct aiMatrix4x4 product(const struct aiMatrix4x4 *a, const struct aiMatrix4x4 *b) {
    struct aiMatrix4x4 result = *a;
    aiMultiplyMatrix4(&result, b);
    return result;
}

/* Counts what the node and its children will add. */
static void count(mu_gather *gather, const struct aiNode *node, size_t *vertices, size_t *triangles) {
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
        const struct aiMesh *part = gather->file->mMeshes[node->mMeshes[i]];
        *vertices += part->mNumVertices;
        *triangles += part->mNumFaces;
        *(part->mTextureCoords[0] ? &gather->has_uvs : &gather->lacks_uvs) = 1;
    }
    for (unsigned i = 0; i < node->mNumChildren; ++i) count(gather, node->mChildren[i], vertices, triangles);
}

/* Asked of the file's own vertices: joining would merge one that is not a number into another. */
static _Bool check_finite(const mu_gather *gather, const struct aiVector3D *vectors, unsigned count,
                          const char *what) {
    for (unsigned i = 0; vectors && i < count; ++i)
        if (!isfinite(vectors[i].x) || !isfinite(vectors[i].y) || !isfinite(vectors[i].z))
            return mu_fail(gather->error, "%s: vertex %u has a %s of (%g, %g, %g); must be finite",
                           gather->mesh->file, i, what, (double)vectors[i].x, (double)vectors[i].y,
                           (double)vectors[i].z);
    return 1;
}

static _Bool check_and_join(mu_gather *gather) {
    for (unsigned i = 0; i < gather->file->mNumMeshes; ++i) {
        const struct aiMesh *part = gather->file->mMeshes[i];
        if (!check_finite(gather, part->mVertices, part->mNumVertices, "position") ||
            !check_finite(gather, part->mNormals, part->mNumVertices, "normal") ||
            !check_finite(gather, part->mTextureCoords[0], part->mNumVertices, "texture coordinate"))
            return 0;
    }
    if (aiApplyPostProcessing(gather->file, aiProcess_JoinIdenticalVertices)) return 1;
    gather->file = NULL; /* assimp has released it */
    return mu_fail(gather->error, "%s: cannot be read as a mesh: %s", gather->mesh->file, aiGetErrorString());
}

static _Bool put(mu_gather *gather, float *out, mu_dvec3 v, double limit, const char *what) {
    if (!(fabs(v.x) <= limit && fabs(v.y) <= limit && fabs(v.z) <= limit))
        return mu_fail(gather->error, "%s: vertex %u has a %s of (%g, %g, %g); must be within %g",
                       gather->mesh->file, (unsigned)gather->mesh->vertex_count, what, v.x, v.y, v.z, limit);
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
    return 1;
}

static mu_dvec3 vector(const struct aiVector3D *v) {
    return mu_d3((double)v->x, (double)v->y, (double)v->z);
}

static _Bool add_vertices(mu_gather *gather, const struct aiMesh *part, const mu_map *map) {
    mu_mesh *mesh = gather->mesh;
    for (unsigned i = 0; i < part->mNumVertices; ++i, ++mesh->vertex_count) {
        const size_t at = mesh->vertex_count;
        if (!put(gather, mesh->positions + 3 * at, mu_map_point(map, vector(&part->mVertices[i])),
                 MU_FARTHEST, "position"))
            return 0;
        if (part->mNormals) {
            const mu_dvec3 n = vector(&part->mNormals[i]);
            if (!put(gather, mesh->normals + 3 * at, n, MU_FARTHEST, "normal")) return 0;
            if (!put(gather, mesh->normals + 3 * at, mu_dnormalise(mu_transpose_times(map->inverse, n)), 2,
                     "normal"))
                return 0;
        }
        if (mesh->uvs) {
            float uvw[3];
            const struct aiVector3D *uv = &part->mTextureCoords[0][i];
            if (!put(gather, uvw, mu_d3((double)uv->x, (double)uv->y, 0), MU_FARTHEST, "texture coordinate"))
                return 0;
            memcpy(mesh->uvs + 2 * at, uvw, 2 * sizeof(float));
        }
    }
    return 1;
}

_Bool mu_mesh_is_flat(const mu_mesh *mesh, const uint32_t corner[3]) {
    mu_dvec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = mu_dfloat(mesh->positions + 3 * (size_t)corner[k]);
    const mu_dvec3 a = mu_dsub(p[1], p[0]), b = mu_dsub(p[2], p[0]), c = mu_dsub(p[2], p[1]);
    const double longest = fmax(mu_ddot(a, a), fmax(mu_ddot(b, b), mu_ddot(c, c)));
    return !(mu_dlength(mu_dcross(a, b)) > 0x1p-23 * longest);
}

static _Bool add_part(mu_gather *gather, const struct aiMesh *part, const mu_map *map) {
    mu_mesh *mesh = gather->mesh;
    const uint32_t base = mesh->vertex_count;
    if (!add_vertices(gather, part, map)) return 0;
    for (unsigned f = 0; f < part->mNumFaces; ++f) {
        const struct aiFace *face = &part->mFaces[f];
        uint32_t *corner = mesh->indices + 3 * (size_t)mesh->triangle_count;
        if (face->mNumIndices != 3) continue;
        for (unsigned k = 0; k < 3; ++k) {
            if (face->mIndices[k] >= part->mNumVertices)
                return mu_fail(gather->error, "%s: a face names vertex %u of %u", mesh->file,
                               (unsigned)face->mIndices[k], (unsigned)part->mNumVertices);
            corner[map->determinant < 0 ? 2 - k : k] =
                base + face->mIndices[k]; /* mirrored: keep the outside */
        }
        if (mu_mesh_is_flat(mesh, corner))
            ++gather->notes.dropped;
        else
            ++mesh->triangle_count;
    }
    return 1;
}

static _Bool add_node(mu_gather *gather, const struct aiNode *node, const struct aiMatrix4x4 *parent) {
    const struct aiMatrix4x4 m = product(parent, &node->mTransformation);
    const mu_affine affine = {{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}};
    mu_map map;
    if (node->mNumMeshes && !mu_map_make(&map, &affine))
        return mu_fail(gather->error, "%s: the transformation of node '%s' is singular", gather->mesh->file,
                       node->mName.data);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
        if (!add_part(gather, gather->file->mMeshes[node->mMeshes[i]], &map)) return 0;
    for (unsigned i = 0; i < node->mNumChildren; ++i)
        if (!add_node(gather, node->mChildren[i], &m)) return 0;
    return 1;
}

static _Bool gather_all(mu_gather *gather) {
    mu_mesh *mesh = gather->mesh;
    size_t vertices = 0, triangles = 0;
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    count(gather, gather->file->mRootNode, &vertices, &triangles);
    gather->notes.uvs_lost = gather->has_uvs && gather->lacks_uvs;
    gather->has_uvs = !gather->lacks_uvs;
    if (!triangles) return mu_fail(gather->error, "%s: the mesh is empty: it has no faces", mesh->file);
    if (vertices > 0x40000000u || triangles > 0x40000000u)
        return mu_fail(gather->error, "%s: %zu triangles are more than 2^30", mesh->file, triangles);
    mesh->positions = calloc(3 * vertices + 4, sizeof(float));
    mesh->normals = calloc(3 * vertices + 4, sizeof(float));
    mesh->uvs = gather->has_uvs ? calloc(2 * vertices + 4, sizeof(float)) : NULL;
    mesh->indices = calloc(3 * triangles + 4, sizeof(uint32_t));
    if (!mesh->positions || !mesh->normals || !mesh->indices || (gather->has_uvs && !mesh->uvs))
        return mu_fail(gather->error, "%s: not enough memory for %zu triangles", mesh->file, triangles);
    if (!add_node(gather, gather->file->mRootNode, &identity)) return 0;
    if (!mesh->triangle_count)
        return mu_fail(gather->error, "%s: the mesh is empty: all its %u triangles have no area", mesh->file,
                       (unsigned)gather->notes.dropped);
    return mu_mesh_fill_normals(mesh, gather->error);
}

static _Bool has_suffix(const char *file, const char *suffix) {
    const char *dot = strrchr(file, '.');
    return dot && !strcasecmp(dot, suffix);
}

static _Bool check_format(const char *file, mu_error *error) {
    if (has_suffix(file, ".ply")) return mu_ply_check(file, error);
    if (has_suffix(file, ".obj") || has_suffix(file, ".gltf") || has_suffix(file, ".glb") || has_suffix(file, ".fbx"))
        return 1;
    return mu_fail(error, "%s: not a mesh file; must be .obj, .ply, .gltf, .glb or .fbx", file);
}

_Bool mu_mesh_read(mu_mesh *mesh, const char *file, mu_mesh_notes *notes, mu_error *error) {
    mu_gather gather = {.mesh = mesh, .error = error};
    *notes = gather.notes;
    memset(mesh, 0, sizeof *mesh);
    if (access(file, R_OK)) return mu_fail(error, "%s: %s", file, strerror(errno));
    if (!check_format(file, error)) return 0;
    mesh->file = strdup(file);
    if (!mesh->file) return mu_fail(error, "%s: not enough memory", file);
    gather.file = import(file);
    _Bool ok = 1;
    if (!gather.file)
        ok = mu_fail(error, "%s: cannot be read as a mesh: %s", file, aiGetErrorString());
    else if (!gather.file->mRootNode || !gather.file->mNumMeshes)
        ok = mu_fail(error, "%s: the mesh is empty: it has no faces", file);
    else
        ok = check_and_join(&gather) && gather_all(&gather);
    if (gather.file) aiReleaseImport(gather.file);
    if (!ok) mu_mesh_free(mesh);
    *notes = gather.notes;
    return ok;
}

void mu_mesh_free(mu_mesh *mesh) {
    free(mesh->name);
    free(mesh->file);
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->tangents);
    free(mesh->tension);
    free(mesh->use);
    for (int i = 0; i < MU_ATTRIBUTES; ++i) free(mesh->attributes[i]);
    free(mesh->indices);
    memset(mesh, 0, sizeof *mesh);
}
