/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* posed_nodes.c: where nodes are at a moment of an animation, and what targets weigh then; see posed.h. */
#include <assimp/types.h>

#include <assimp/anim.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/posed.h"

static mu_affine64 product(const mu_affine64 *a, const mu_affine64 *b) {
    mu_affine64 out;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            out.row[i][j] = j == 3 ? a->row[i][3] : 0;
            for (int k = 0; k < 3; k++) out.row[i][j] += a->row[i][k] * b->row[k][j];
        }
    return out;
}

/* Which keys `ticks` lies between, and how far on; both the same at and beyond the ends. `time`: of the first key, the
 * keys being `stride` bytes apart. */
static double between(const double *time, size_t stride, unsigned count, double ticks, unsigned *before,
                      unsigned *after) {
    const char *const keys = (const char *)time;
    unsigned next = 0;
    while (next < count && *(const double *)(const void *)(keys + next * stride) <= ticks) next++;
    *before = next ? next - 1 : 0;
    *after = next < count ? next : count - 1;
    const double from = *(const double *)(const void *)(keys + *before * stride),
                 to = *(const double *)(const void *)(keys + *after * stride);
    return to > from ? fmin(1, fmax(0, (ticks - from) / (to - from))) : 0;
}

static void vector_at(const struct aiVectorKey *keys, unsigned count, double ticks, double none,
                      double out[3]) {
    unsigned a, b;
    out[0] = out[1] = out[2] = none;
    if (!count) return;
    const double t = between(&keys->mTime, sizeof *keys, count, ticks, &a, &b);
    const struct aiVector3D *p = &keys[a].mValue, *q = &keys[b].mValue;
    out[0] = (1 - t) * (double)p->x + t * (double)q->x;
    out[1] = (1 - t) * (double)p->y + t * (double)q->y;
    out[2] = (1 - t) * (double)p->z + t * (double)q->z;
}

/* Along the shortest arc; unit. What is not finite stays so, and is found when vertices are checked. */
static void rotation_at(const struct aiQuatKey *keys, unsigned count, double ticks, double out[4]) {
    unsigned a, b;
    const double none[4] = {1, 0, 0, 0};
    memcpy(out, none, sizeof none);
    if (!count) return;
    const double t = between(&keys->mTime, sizeof *keys, count, ticks, &a, &b);
    const struct aiQuaternion *p = &keys[a].mValue, *q = &keys[b].mValue;
    const double from[4] = {(double)p->w, (double)p->x, (double)p->y, (double)p->z},
                 to[4] = {(double)q->w, (double)q->x, (double)q->y, (double)q->z};
    double cosine = 0, apart = 0, together = 0, length = 0;
    for (int k = 0; k < 4; k++) cosine += from[k] * to[k];
    const double side = cosine < 0 ? -1 : 1;
    for (int k = 0; k < 4; k++)
        apart += pow(from[k] - side * to[k], 2), together += pow(from[k] + side * to[k], 2);
    const double angle = 2 * atan2(sqrt(apart), sqrt(together)), sine = sin(angle);
    for (int k = 0; k < 4; k++) {
        out[k] = !(sine <= 1e-9) ? (sin((1 - t) * angle) * from[k] + sin(t * angle) * side * to[k]) / sine
                             : (1 - t) * from[k] + t * side * to[k];
        length += out[k] * out[k];
    }
    for (int k = 0; k < 4; k++) out[k] = length == 0 ? none[k] : out[k] / sqrt(length);
}

static mu_affine64 channel_at(const struct aiNodeAnim *channel, double ticks) {
    double t[3], s[3], q[4];
    mu_affine64 out;
    vector_at(channel->mPositionKeys, channel->mNumPositionKeys, ticks, 0, t);
    vector_at(channel->mScalingKeys, channel->mNumScalingKeys, ticks, 1, s);
    rotation_at(channel->mRotationKeys, channel->mNumRotationKeys, ticks, q);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) out.row[i][j] = r[i][j] * s[j];
        out.row[i][3] = t[i];
    }
    return out;
}

static mu_affine64 local(const mu_posed *posed, const struct aiNode *node) {
    const struct aiMatrix4x4 *m = &node->mTransformation;
    for (unsigned i = 0; posed->animation && i < posed->animation->mNumChannels; i++) {
        const struct aiNodeAnim *channel = posed->animation->mChannels[i];
        if (!strcmp(channel->mNodeName.data, node->mName.data)) return channel_at(channel, posed->ticks);
    }
    return (mu_affine64){{{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
                          {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
                          {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}}};
}

static uint32_t count(const struct aiNode *node) {
    uint32_t sum = 1;
    for (unsigned i = 0; i < node->mNumChildren; i++) sum += count(node->mChildren[i]);
    return sum;
}

static void walk(mu_posed *posed, const struct aiNode *node, const mu_affine64 *parent) {
    const mu_affine64 own = local(posed, node), world = parent ? product(parent, &own) : own;
    posed->node[posed->nodes] = node;
    posed->world[posed->nodes++] = world;
    for (unsigned i = 0; i < node->mNumChildren; i++) walk(posed, node->mChildren[i], &world);
}

_Bool mu_posed_nodes(mu_posed *posed) {
    const size_t nodes = count(posed->scene->mRootNode);
    posed->node = malloc(nodes * sizeof *posed->node);
    posed->world = malloc(nodes * sizeof *posed->world);
    if (!posed->node || !posed->world) return 0;
    walk(posed, posed->scene->mRootNode, NULL);
    return 1;
}

const mu_affine64 *mu_posed_world(const mu_posed *posed, const char *node) {
    for (uint32_t i = 0; i < posed->nodes; i++)
        if (!strcmp(posed->node[i]->mName.data, node)) return &posed->world[i];
    return NULL;
}

/* FBX files call a node's channel "node*0". */
static _Bool is_named(const char *channel, const char *name) {
    const size_t length = strlen(name);
    return length && !strncmp(channel, name, length) && (!channel[length] || channel[length] == '*');
}

static double weight_of(const struct aiMeshMorphKey *key, unsigned target) {
    for (unsigned i = 0; i < key->mNumValuesAndWeights; i++)
        if (key->mValues[i] == target) return key->mWeights[i];
    return 0;
}

_Bool mu_posed_weight(const mu_posed *posed, const char *node, const struct aiMesh *part, unsigned target,
                      double *weight) {
    for (unsigned i = 0; posed->animation && i < posed->animation->mNumMorphMeshChannels; i++) {
        const struct aiMeshMorphAnim *channel = posed->animation->mMorphMeshChannels[i];
        unsigned a, b;
        if (!channel->mNumKeys ||
            !(is_named(channel->mName.data, node) || is_named(channel->mName.data, part->mName.data)))
            continue;
        const double t =
            between(&channel->mKeys->mTime, sizeof *channel->mKeys, channel->mNumKeys, posed->ticks, &a, &b);
        *weight = (1 - t) * weight_of(&channel->mKeys[a], target) + t * weight_of(&channel->mKeys[b], target);
        return 1;
    }
    return 0;
}
