/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* polygons.c: PLY, glTF and FBX as they are numbered, through assimp without any of its post-processing. */
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
#include "core/render/posed.h"

typedef struct mu_gathered {
    const struct aiScene *scene;
    mu_posed posed;
    _Bool has_pose;
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

/* A mesh of a node: where its vertices and normals are in the world. */
typedef struct mu_standing {
    double *position; /* 3 each */
    float *normal;    /* 3 each; NULL: none */
    _Bool mirrored;
} mu_standing;

static void stand(const struct aiMesh *part, const mu_map *map, mu_standing *out) {
    for (size_t i = 0; i < part->mNumVertices; i++) {
        const struct aiVector3D *v = &part->mVertices[i];
        const mu_dvec3 p = mu_map_point(map, mu_d3((double)v->x, (double)v->y, (double)v->z));
        memcpy(out->position + 3 * i, &p, sizeof p);
        if (!out->normal) continue;
        const struct aiVector3D *n = &part->mNormals[i];
        const mu_vec3 unit = mu_single(
            mu_dnormalise(mu_transpose_times(map->inverse, mu_d3((double)n->x, (double)n->y, (double)n->z))));
        memcpy(out->normal + 3 * i, &unit, 3 * sizeof(float));
    }
    out->mirrored = map->determinant < 0;
}

static _Bool add_vertices(mu_gathered *g, const struct aiMesh *part, const mu_standing *standing) {
    for (size_t i = 0; i < part->mNumVertices; i++, g->out->vertices++) {
        const double *p = standing->position + 3 * i;
        if (!(fabs(p[0]) <= 1e9 && fabs(p[1]) <= 1e9 && fabs(p[2]) <= 1e9))
            return mu_fail(g->error, "%s: vertex %u has a position of (%g, %g, %g); must be within 1e9",
                           g->out->file, (unsigned)g->out->vertices, p[0], p[1], p[2]);
        memcpy(g->out->position + 3 * (size_t)g->out->vertices, p, 3 * sizeof *p);
    }
    return 1;
}

/* What the corner has besides its position. */
static void add_corner(mu_gathered *g, const struct aiMesh *part, const mu_standing *standing, unsigned i) {
    const size_t at = g->out->corners;
    if (g->out->uv) {
        const struct aiVector3D *uv = part->mTextureCoords[0] ? &part->mTextureCoords[0][i] : NULL;
        g->out->uv[2 * at] = uv ? (double)uv->x : NAN;
        g->out->uv[2 * at + 1] = uv ? (double)uv->y : NAN;
    }
    if (g->out->normal && standing->normal)
        memcpy(g->out->normal + 3 * at, standing->normal + 3 * (size_t)i, 3 * sizeof(float));
}

static _Bool add_faces(mu_gathered *g, const struct aiMesh *part, const mu_standing *standing,
                       uint32_t base) {
    mu_polygons *out = g->out;
    for (unsigned f = 0; f < part->mNumFaces; f++) {
        const struct aiFace *face = &part->mFaces[f];
        const unsigned last = face->mNumIndices - 1;
        if (face->mNumIndices < 3) continue;
        if (face->mNumIndices > MU_POLYGON_MOST)
            return mu_fail(g->error, "%s: a face of %u vertices; at most %d", out->file, face->mNumIndices,
                           MU_POLYGON_MOST);
        out->first[out->faces++] = out->corners;
        for (unsigned k = 0; k <= last; k++, out->corners++) {
            const unsigned i = face->mIndices[standing->mirrored ? last - k : k]; /* keep the outside */
            if (i >= part->mNumVertices)
                return mu_fail(g->error, "%s: a face names vertex %u of %u", out->file, i,
                               part->mNumVertices);
            out->vertex[out->corners] = base + i;
            add_corner(g, part, standing, i);
        }
    }
    return 1;
}

static _Bool add_part(mu_gathered *g, const struct aiNode *node, const struct aiMesh *part,
                      const mu_map *map) {
    const size_t count = part->mNumVertices;
    const uint32_t base = g->out->vertices;
    mu_standing s = {.position = malloc((3 * count + 1) * sizeof *s.position),
                     .normal = part->mNormals ? malloc((3 * count + 1) * sizeof *s.normal) : NULL};
    _Bool good = s.position && (s.normal || !part->mNormals);
    if (!good) mu_fail(g->error, "%s: not enough memory for %zu vertices", g->out->file, count);
    if (good && g->has_pose)
        good = mu_posed_part(&g->posed, node, part, s.position, s.normal, &s.mirrored);
    else if (good)
        stand(part, map, &s);
    good = good && add_vertices(g, part, &s) && add_faces(g, part, &s, base);
    free(s.position);
    free(s.normal);
    return good;
}

static _Bool add_node(mu_gathered *g, const struct aiNode *node, const struct aiMatrix4x4 *parent) {
    struct aiMatrix4x4 m = *parent;
    aiMultiplyMatrix4(&m, &node->mTransformation);
    const mu_affine affine = {{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}};
    mu_map map;
    if (node->mNumMeshes && !g->has_pose && !mu_map_make(&map, &affine))
        return mu_fail(g->error, "%s: the transformation of node '%s' is singular", g->out->file,
                       node->mName.data);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (!add_part(g, node, g->scene->mMeshes[node->mMeshes[i]], &map)) return 0;
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

static _Bool read_by_assimp(mu_polygons *polygons, const char *file, const mu_pose *pose, mu_error *error) {
    mu_gathered g = {.scene = aiImportFile(file, aiProcess_ValidateDataStructure),
                     .has_pose = pose != NULL,
                     .out = polygons,
                     .error = error};
    _Bool good;
    if (!g.scene)
        good = mu_fail(error, "%s: cannot be read as a mesh: %s", file, aiGetErrorString());
    else if (!g.scene->mRootNode || !g.scene->mNumMeshes)
        good = mu_fail(error, "%s: the mesh is empty: it has no faces", file);
    else
        good = (!pose || mu_posed_make(&g.posed, file, g.scene, pose, error)) && gather(&g);
    mu_posed_free(&g.posed);
    if (g.scene) aiReleaseImport(g.scene);
    return good;
}

_Bool mu_polygons_can_pose(const char *file) {
    const char *const dot = strrchr(file, '.');
    return dot && (!strcasecmp(dot, ".gltf") || !strcasecmp(dot, ".glb") || !strcasecmp(dot, ".fbx"));
}

_Bool mu_polygons_read(mu_polygons *polygons, const char *file, const mu_pose *pose, mu_error *error) {
    const char *const dot = strrchr(file, '.');
    const _Bool can_pose = mu_polygons_can_pose(file), obj = dot && !strcasecmp(dot, ".obj"),
                ply = dot && !strcasecmp(dot, ".ply");
    _Bool good;
    *polygons = (mu_polygons){.file = file};
    if (access(file, R_OK)) return mu_fail(error, "%s: %s", file, strerror(errno));
    if (!can_pose && !obj && !ply)
        good = mu_fail(error, "%s: not a mesh file; must be .obj, .ply, .gltf, .glb or .fbx", file);
    else if (!can_pose && pose)
        good = mu_fail(error, "%s: holds no poses; .gltf, .glb and .fbx files may", file);
    else if (obj)
        good = mu_polygons_read_obj(polygons, file, error);
    else
        good = (can_pose || mu_ply_check(file, error)) && read_by_assimp(polygons, file, pose, error);
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
