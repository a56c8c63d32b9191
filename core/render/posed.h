/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * posed.h: the vertices of an imported file in a pose: morph targets, then bones, then nodes.
 *
 * A vertex is v + sum of w_i (v_i - v) over the targets; with bones it goes to the weighted mean of G_b O_b over them, G_b
 * the bone's node in the world, O_b the file's matrix from the mesh to the bone; without bones to G of its own node.
 * Nodes with keys have T R S of those, linear between keys, rotations along the shortest arc (glTF 2.0, 3.11).
 * Normals go with the cofactors of all that.
 *
 * The bind shape has no targets and stays as it is; a mesh with bones is where its first bone carries it as the file
 * stands, for only that bone knows the size it will have. (Rigid motions are no matter of tension.)
 */
#ifndef MU_POSED_H
#define MU_POSED_H

#include <assimp/scene.h>

#include "core/render/affine.h"
#include "core/render/pose.h"

typedef struct mu_affine64 {
    double row[3][4];
} mu_affine64;

typedef struct mu_posed {
    const char *name; /* of the file */
    const struct aiScene *scene;
    const mu_pose *pose;
    const struct aiAnimation *animation;
    double ticks;
    const struct aiNode **node; /* in the order of a walk from the root */
    mu_affine64 *world;
    uint32_t nodes;
    mu_error *error;
} mu_posed;

/* Fails on animations and targets that the file has not. */
_Bool mu_posed_make(mu_posed *posed, const char *name, const struct aiScene *scene, const mu_pose *pose,
                    mu_error *error);
void mu_posed_free(mu_posed *posed);
/* positions: 3 per vertex; normals: 3, unit, or NULL; mirrored: whether faces turn over. */
_Bool mu_posed_part(const mu_posed *posed, const struct aiNode *node, const struct aiMesh *part,
                    double *positions, float *normals, _Bool *mirrored);

/* posed_nodes.c: the world matrices of all nodes, and the weight that the animation gives a target; false: none. */
_Bool mu_posed_nodes(mu_posed *posed);
const mu_affine64 *mu_posed_world(const mu_posed *posed, const char *node);
_Bool mu_posed_weight(const mu_posed *posed, const char *node, const struct aiMesh *part, unsigned target,
                      double *weight);

#endif
