/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* posed.c: see posed.h. In double precision; what the file holds is float. */
#include "core/render/posed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/text.h"

/* Ticks per second where a file does not say: as assimp's own viewer. */
#define MU_TICKS 25.0

static _Bool is_called(const char *name, unsigned number, const char *asked) {
    char text[16];
    snprintf(text, sizeof text, "%u", number);
    return *name ? !strcmp(name, asked) : !strcmp(text, asked);
}

static void list_name(char *list, size_t size, const char *name, unsigned number) {
    char text[80];
    if (*name)
        snprintf(text, sizeof text, "%s\"%.60s\"", *list ? ", " : "", name);
    else
        snprintf(text, sizeof text, "%s%u", *list ? ", " : "", number);
    if (!strstr(list, text)) mu_append(list, size, text);
}

static _Bool find_animation(mu_posed *posed) {
    char list[300] = "";
    if (!posed->pose->animation) return 1;
    for (unsigned i = 0; i < posed->scene->mNumAnimations; i++) {
        const struct aiAnimation *animation = posed->scene->mAnimations[i];
        list_name(list, sizeof list, animation->mName.data, i);
        if (!is_called(animation->mName.data, i, posed->pose->animation)) continue;
        const double rate = animation->mTicksPerSecond > 0 ? animation->mTicksPerSecond : MU_TICKS;
        posed->animation = animation;
        posed->ticks = posed->pose->time * rate;
        return 1;
    }
    return mu_fail(posed->error, "%s: there is no animation \"%.60s\"; the file has %s", posed->name,
                   posed->pose->animation, *list ? list : "none");
}

static _Bool check_targets(const mu_posed *posed) {
    for (uint32_t k = 0; k < posed->pose->morphs; k++) {
        char list[300] = "";
        _Bool found = 0;
        for (unsigned i = 0; i < posed->scene->mNumMeshes; i++) {
            const struct aiMesh *part = posed->scene->mMeshes[i];
            for (unsigned t = 0; t < part->mNumAnimMeshes; t++) {
                list_name(list, sizeof list, part->mAnimMeshes[t]->mName.data, t);
                found |= is_called(part->mAnimMeshes[t]->mName.data, t, posed->pose->morph[k].name);
            }
        }
        if (!found)
            return mu_fail(posed->error, "%s: there is no morph target \"%.60s\"; the file has %s",
                           posed->name, posed->pose->morph[k].name, *list ? list : "none");
    }
    return 1;
}

_Bool mu_posed_make(mu_posed *posed, const char *name, const struct aiScene *scene, const mu_pose *pose,
                    mu_error *error) {
    *posed = (mu_posed){.name = name, .scene = scene, .pose = pose, .error = error};
    if (!find_animation(posed) || !check_targets(posed)) return 0;
    return mu_posed_nodes(posed) || mu_fail(error, "%s: not enough memory for a pose", name);
}

void mu_posed_free(mu_posed *posed) {
    free(posed->node);
    free(posed->world);
    posed->node = NULL, posed->world = NULL;
}

/* What the pose, or else the animation, gives a target. */
static double target_weight(const mu_posed *posed, const struct aiNode *node, const struct aiMesh *part,
                            unsigned target) {
    double weight = 0;
    if (posed->pose->bind) return 0;
    for (uint32_t k = 0; k < posed->pose->morphs; k++)
        if (is_called(part->mAnimMeshes[target]->mName.data, target, posed->pose->morph[k].name))
            return posed->pose->morph[k].weight;
    mu_posed_weight(posed, node->mName.data, part, target, &weight);
    return weight;
}

static void put(double *out, const struct aiVector3D *v) {
    out[0] = (double)v->x, out[1] = (double)v->y, out[2] = (double)v->z;
}

static void add_difference(double *out, double weight, const struct aiVector3D *to,
                           const struct aiVector3D *from) {
    out[0] += weight * ((double)to->x - (double)from->x);
    out[1] += weight * ((double)to->y - (double)from->y);
    out[2] += weight * ((double)to->z - (double)from->z);
}

static _Bool morph(const mu_posed *posed, const struct aiNode *node, const struct aiMesh *part,
                   double *positions, double *normals) {
    for (size_t i = 0; i < part->mNumVertices; i++) {
        put(positions + 3 * i, &part->mVertices[i]);
        if (normals) put(normals + 3 * i, &part->mNormals[i]);
    }
    for (unsigned t = 0; t < part->mNumAnimMeshes; t++) {
        const struct aiAnimMesh *target = part->mAnimMeshes[t];
        const double weight = target_weight(posed, node, part, t);
        if (weight == 0) continue;
        if (target->mNumVertices != part->mNumVertices)
            return mu_fail(posed->error, "%s: a morph target has %u vertices, its mesh %u", posed->name,
                           target->mNumVertices, part->mNumVertices);
        for (size_t i = 0; i < part->mNumVertices; i++) {
            if (target->mVertices)
                add_difference(positions + 3 * i, weight, &target->mVertices[i], &part->mVertices[i]);
            if (normals && target->mNormals)
                add_difference(normals + 3 * i, weight, &target->mNormals[i], &part->mNormals[i]);
        }
    }
    return 1;
}

static void add_scaled(mu_affine64 *sum, double weight, const mu_affine64 *m) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) sum->row[i][j] += weight * m->row[i][j];
}

/* From the mesh to where its bone is. */
static _Bool bone_matrix(const mu_posed *posed, const struct aiBone *bone, mu_affine64 *out) {
    const mu_affine64 *world = mu_posed_world(posed, bone->mName.data);
    const struct aiMatrix4x4 *o = &bone->mOffsetMatrix;
    const double offset[4][4] = {{(double)o->a1, (double)o->a2, (double)o->a3, (double)o->a4},
                                 {(double)o->b1, (double)o->b2, (double)o->b3, (double)o->b4},
                                 {(double)o->c1, (double)o->c2, (double)o->c3, (double)o->c4},
                                 {0, 0, 0, 1}};
    if (!world)
        return mu_fail(posed->error, "%s: there is no node for the bone \"%.60s\"", posed->name,
                       bone->mName.data);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            out->row[i][j] = 0;
            for (int k = 0; k < 4; k++) out->row[i][j] += world->row[i][k] * offset[k][j];
        }
    return 1;
}

/* One matrix per vertex: the mean of its bones'. */
static _Bool find_skin(const mu_posed *posed, const struct aiMesh *part, const mu_affine64 *own,
                       mu_affine64 *skin) {
    double *weights = calloc((size_t)part->mNumVertices + 1, sizeof *weights);
    if (!weights) return mu_fail(posed->error, "%s: not enough memory for a pose", posed->name);
    memset(skin, 0, part->mNumVertices * sizeof *skin);
    _Bool good = 1;
    for (unsigned b = 0; b < part->mNumBones && good; b++) {
        const struct aiBone *bone = part->mBones[b];
        mu_affine64 m;
        good = bone_matrix(posed, bone, &m);
        for (unsigned k = 0; k < bone->mNumWeights && good; k++) {
            const unsigned i = bone->mWeights[k].mVertexId;
            const double weight = (double)bone->mWeights[k].mWeight;
            if (i >= part->mNumVertices || !(weight >= 0))
                good = mu_fail(posed->error, "%s: bone \"%.60s\" has a weight of %g for vertex %u of %u",
                               posed->name, bone->mName.data, weight, i, part->mNumVertices);
            else
                add_scaled(&skin[i], weight, &m), weights[i] += weight;
        }
    }
    for (size_t i = 0; i < part->mNumVertices; i++) {
        const mu_affine64 sum = skin[i];
        if (weights[i] > 0)
            memset(&skin[i], 0, sizeof *skin), add_scaled(&skin[i], 1 / weights[i], &sum);
        else
            skin[i] = *own;
    }
    free(weights);
    return good;
}

static double cofactors(const mu_affine64 *m, double out[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            out[i][j] = m->row[a][c] * m->row[b][d] - m->row[a][d] * m->row[b][c];
        }
    return m->row[0][0] * out[0][0] + m->row[0][1] * out[0][1] + m->row[0][2] * out[0][2];
}

static void place(const mu_affine64 *m, double *p) {
    const mu_dvec3 v = mu_d3(p[0], p[1], p[2]);
    for (int i = 0; i < 3; i++)
        p[i] = m->row[i][0] * v.x + m->row[i][1] * v.y + m->row[i][2] * v.z + m->row[i][3];
}

static void turn(const mu_affine64 *m, const double *n, float *out) {
    double c[3][3];
    const double side = cofactors(m, c) < 0 ? -1 : 1;
    const mu_dvec3 turned =
        mu_matrix_times((const double(*)[3])c, mu_d3(side * n[0], side * n[1], side * n[2]));
    const mu_vec3 unit = mu_single(mu_dnormalise(turned));
    memcpy(out, &unit, 3 * sizeof *out);
}

_Bool mu_posed_part(const mu_posed *posed, const struct aiNode *node, const struct aiMesh *part,
                    double *positions, float *normals, _Bool *mirrored) {
    const size_t count = part->mNumVertices;
    const _Bool skinned = part->mNumBones && !posed->pose->bind;
    double *before = normals ? malloc((3 * count + 1) * sizeof *before) : NULL, minors[3][3];
    mu_affine64 *skin = skinned ? malloc((count + 1) * sizeof *skin) : NULL, own;
    _Bool good = (before || !normals) && (skin || !skinned);
    if (!good) mu_fail(posed->error, "%s: not enough memory for a pose", posed->name);
    for (uint32_t i = 0; i < posed->nodes; i++)
        if (posed->node[i] == node) own = posed->world[i];
    if (part->mNumBones && posed->pose->bind) good = good && bone_matrix(posed, part->mBones[0], &own);
    good = good && morph(posed, node, part, positions, before) &&
           (!skinned || find_skin(posed, part, &own, skin));
    for (size_t i = 0; good && i < count; i++) {
        const mu_affine64 *m = skinned ? &skin[i] : &own;
        place(m, positions + 3 * i);
        if (normals) turn(m, before + 3 * i, normals + 3 * i);
    }
    if (good) *mirrored = cofactors(skinned && count ? &skin[0] : &own, minors) < 0;
    free(before);
    free(skin);
    return good;
}
