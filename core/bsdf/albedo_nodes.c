/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_nodes.c: at which roughnesses tables stand, between which what is lost is interpolated (mu_albedo_share): as few as
 * keep what probes say within an error, where this distribution needs them. Roughnesses as log2.
 *
 * Probes are asked at STEPS + 1 roughnesses; from each node the next is the farthest from which lines between both are near
 * enough at all of them in between. Where that takes too many nodes, the error grows until it does not.
 */
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

enum { STEPS = 72 };
static const float widest = 2.1f; /* between nodes: averages are quadratic there, and know less of them */

/* The most that probes are off between the steps i and j. */
static float off_between(const albedo_probes *p, const float (*lost)[ALBEDO_PROBES], const float *x, int i,
                         int j) {
    float most = 0;
    for (int m = i + 1; m < j; m++) {
        const float share = mu_albedo_share(x[m], x[i], x[j]);
        for (int k = 0; k < p->count; k++)
            most = fmaxf(most, fabsf(lost[m][k] - lost[i][k] - share * (lost[j][k] - lost[i][k])));
    }
    return most;
}

/* Nodes that keep to `error`, `most` + 1 at most; how many. */
static int place(const albedo_probes *p, const float (*lost)[ALBEDO_PROBES], const float *x, float error,
                 int most, float *nodes) {
    int count = 0, i = 0;
    nodes[count++] = x[0];
    while (i < STEPS && count <= most) {
        int j = i + 1;
        while (j < STEPS && x[j + 1] - x[i] <= widest && off_between(p, lost, x, i, j + 1) <= error) j++;
        if (count < most) nodes[count] = x[j];
        count++, i = j;
    }
    return count;
}

int mu_albedo_place_nodes(const albedo_probes *p, float from, float to, float error, int most, float *nodes) {
    float lost[STEPS + 1][ALBEDO_PROBES], x[STEPS + 1];
    if (!(to > from)) {
        nodes[0] = from;
        return 1;
    }
    for (int i = 0; i <= STEPS; i++) {
        x[i] = from + (to - from) * (float)i / STEPS;
        for (int k = 0; k < p->count; k++) lost[i][k] = p->lost(p->context, x[i], k);
    }
    int count;
    while ((count = place(p, (const float(*)[ALBEDO_PROBES])lost, x, error, most, nodes)) > most)
        error *= 1.1f;
    return count;
}

#endif
