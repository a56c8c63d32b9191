/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_set.h: all tables of a surface (albedo_set.c), and which of them say what a closure loses: a mean of four at most,
 * each over its own L. What is interpolated is linear in the tables, and so are its average and its lobe: nothing is lost in
 * between that the tables themselves do not lose.
 *
 * A surface has one table, and one for each roughness on a grid to which it may be blurred: a factor of 2 apart, from its own
 * least roughness on, coarser than its own. For an M of the point (compensation_varies) it has a grid over the slope
 * roughnesses that M may make instead of those (albedo_grid.c), and one of GGX, which is what blurring makes of it.
 */
#ifndef MU_ALBEDO_SET_H
#define MU_ALBEDO_SET_H

#include "core/bsdf/albedo.h"

enum { ALBEDO_BLURS = 10 };

/* From the least slope roughness of a grid to its most, in octaves, and steps of an octave: of GGX and heavier tails, and of any other,
 * which changes faster. Floats that its tables take, as a mean and at most. */
#define ALBEDO_GRID_LEAST (1 / 128.0f)
enum {
    ALBEDO_OCTAVES = 8,
    ALBEDO_HEAVY_STEPS = 2,
    ALBEDO_STEPS = 3,
    ALBEDO_GRID_MEAN = 1 << 10,
    ALBEDO_GRID_MOST = 1 << 12
};

/* Tables at slope roughnesses i >= j (albedo_grid_node). */
typedef struct albedo_grid {
    const mu_albedo *table;
    int steps; /* of an octave */
} albedo_grid;

static inline int albedo_grid_node(int i, int j) {
    return i * (i + 1) / 2 + j;
}
static inline int albedo_grid_tables(int steps) {
    return albedo_grid_node(ALBEDO_OCTAVES * steps + 1, 0);
}

struct mu_albedo_set {
    int levels;                /* 1 + blurs */
    float first_blur;          /* of level[1] */
    float unsure;              /* of level[0], and of the grids */
    size_t bytes;              /* that it takes */
    albedo_grid grid, blurred; /* for an M of the point; else of no tables */
    mu_albedo level[1 + ALBEDO_BLURS];
    float values[];
};

/* Memory for the set of a definition, scratch included, and making it there. */
size_t mu_albedo_set_bytes(const mu_definition *d);
void mu_albedo_set_make(const mu_definition *d, mu_albedo_set *out);
/* The tables of the definition's M blurred to alpha; 0: not at all. */
void mu_albedo_set_choose(const mu_albedo_set *set, float blur, mu_lobe *out);

/* Makes the tables of a grid in `most` floats; returns how many it took. */
size_t mu_albedo_grid_make(const albedo_source *source, int steps, mu_albedo *table, float *values,
                           size_t most, float *unsure);
/* Its tables for slope roughnesses a >= b: all but turn and averages of the lobe. */
void mu_albedo_grid_choose(const albedo_grid *grid, float a, float b, mu_lobe *out);
/* All of it for the grid of a set, blurred or not, at V = s M^-1. */
void mu_albedo_set_choose_at(const mu_albedo_set *set, int blurred, const float v[4], mu_lobe *out);

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
