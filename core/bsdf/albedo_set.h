/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_set.h: all tables of a surface (albedo_set.c), and which of them say what a closure loses: a mean of four at most,
 * each over its own L. What is interpolated is linear in the tables, and so are its average and its lobe: nothing is lost in
 * between that the tables themselves do not lose.
 *
 * A surface has one table, and one for each roughness on a grid to which it may be blurred: a factor of 2 apart, from its own
 * least roughness on, coarser than its own.
 */
#ifndef MU_ALBEDO_SET_H
#define MU_ALBEDO_SET_H

#include "core/bsdf/albedo.h"

enum { ALBEDO_BLURS = 10 };

struct mu_albedo_set {
    int levels;       /* 1 + blurs */
    float first_blur; /* of level[1] */
    float unsure;     /* of level[0] */
    size_t bytes;     /* that it takes */
    mu_albedo level[1 + ALBEDO_BLURS];
    float values[];
};

/* Memory for the set of a definition, scratch included, and making it there. */
size_t mu_albedo_set_bytes(const mu_definition *d);
void mu_albedo_set_make(const mu_definition *d, mu_albedo_set *out);
/* The tables of the definition's M blurred to alpha; 0: not at all. */
void mu_albedo_set_choose(const mu_albedo_set *set, float blur, mu_lobe *out);

static inline void albedo_turn(const mu_lobe *l, const float w[3], float v[3]) {
    v[0] = l->turn[0] * w[0] - l->turn[1] * w[1];
    v[1] = l->turn[1] * w[0] + l->turn[0] * w[1];
    v[2] = w[2];
}

/* What is lost toward w, on a side, and the density of lobe_draw, 1/sr. */
static inline float lobe_lost(const mu_lobe *l, int side, const float w[3], float *density) {
    float v[3], lost = 0;
    albedo_turn(l, w, v);
    *density = 0;
    for (int k = 0; k < l->count; k++) {
        const mu_albedo *t = l->level[k];
        const albedo_place at = albedo_locate(t, v);
        lost += l->share[k] * albedo_lost(&t->side[side], at);
        *density +=
            l->share[k] * (t->side[side].average / l->average[side]) * albedo_density(t, &t->side[side], at);
    }
    return lost;
}

static inline void lobe_draw(const mu_lobe *l, int side, float u0, float u1, float w[3]) {
    float v[3], share = 1;
    int k = 0;
    for (; k < l->count; k++, u0 -= share) {
        share = l->share[k] * (l->level[k]->side[side].average / l->average[side]);
        if (u0 < share || k == l->count - 1) break;
    }
    mu_albedo_draw(l->level[k], &l->level[k]->side[side], fminf(fmaxf(u0 / share, 0), 0x0.ffffffp0f), u1, v);
    w[0] = l->turn[0] * v[0] + l->turn[1] * v[1];
    w[1] = l->turn[0] * v[1] - l->turn[1] * v[0];
    w[2] = v[2];
}

#endif
