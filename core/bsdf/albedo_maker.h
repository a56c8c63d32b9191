/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_maker.h: what makes a side of a table (albedo_patch.c), for albedo.c, which makes tables. Float only.
 */
#ifndef MU_ALBEDO_MAKER_H
#define MU_ALBEDO_MAKER_H

#include "core/bsdf/albedo.h"

/* What is lost at least: the lobe exists everywhere. */
#define ALBEDO_LEAST 1e-7f

/* Values that were evaluated already: each in one of so many places, by where it is. */
enum { ALBEDO_KNOWN = 1 << 12 };
typedef struct albedo_known {
    uint64_t where; /* 0: none */
    float value;
} albedo_known;

/* A side of a table while its patches grow, one root patch after the other. */
typedef struct patch_maker {
    const albedo_source *source;
    const mu_albedo *table;
    mu_albedo_side *side;
    float *values;             /* of its nodes, and then of its cells */
    albedo_patch *patch;       /* its own */
    size_t floats, most;       /* that it may take, and patches */
    size_t nodes;              /* so far */
    size_t pending;            /* floats that patches need which are still to grow */
    float turn;                /* +1; -1 from below */
    int quadrant, column, row; /* of the root patch */
    float place[2];            /* in a cell: where it was asked last */
    int parted;                /* light is transmitted, too */
    albedo_known known[ALBEDO_KNOWN];
} patch_maker;

/* A closure of the source; 0 if it sees nothing. */
int mu_albedo_bind(const albedo_source *s, const float w[3], mu_closure_f *c);
/* Of what meets two facets or more and leaves, the share that leaves on the upper side, by so many walks. */
double mu_albedo_share_above(const albedo_source *source, int walks);
/* 1 - E toward w, which is seen from the side, w.z > 0. */
float mu_albedo_toward(const patch_maker *m, const float w[3]);
/* 1 - E at u and S of the root patch, from 0 to 1. */
float mu_albedo_evaluate(const patch_maker *m, double u, double s);
/* All patches of the side, and its lobe, by that much work (albedo_effort). */
void mu_albedo_grow(patch_maker *m, size_t facets);
/* The cells' shares of the lobe, once patches are grown, and its average (albedo_lobe.c). */
void mu_albedo_fill_lobe(const patch_maker *m, float *cumulative);

#endif
