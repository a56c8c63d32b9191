/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * cells.c: the directional albedo of a slope histogram, F included, by halving blocks of its cells. Not in the papers.
 *
 * Of the slope p of the histogram's own space let (mu, 1) be the micronormal in the world (core/bsdf/albedo_quadrature.c); wo.(mu, 1)
 * is linear in p, k(p), and
 *
 *     E(wo) = 1/cos_o  integral of P22(p) max(0, k(p)) F G2 dp.
 *
 * P22 jumps from cell to cell, F G2 does not. So a block of cells that faces wo is estimated by its mass, times k and F G2 at its
 * centre of mass. Mass and k are exact, however noisy the histogram is: only the curvature of F G2 within the block is left out.
 * Blocks that the line k = 0 crosses are halved down to cells, and these into parts; their density is even, so what of them
 * faces wo is known (half_plane.c). A block is halved along the axis where that changes its estimate most, until for CALM halvings
 * in a row neither axis changes it by more than is allowed; both last changes are added to it then.
 * Of a random walk it is what leaves after one facet, as walks.c has it.
 */
#include "core/ibl/cells.h"

#include "core/bsdf/distribution.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/tabulated.h"
#include "core/ibl/ibl.h"

#include "core/bsdf/real.h"

/* Halvings of a block at most (20 come down to a cell of 1024 by 1024); halvings in a row that must change hardly anything; facets, beyond
 * which nothing is halved any more. */
enum { DEEPEST = 40, CALM = 2, FACETS = 1 << 16 };
/* Of what E may be off: the change that is hardly anything (there are some hundred blocks, with errors of either sign); and the
 * block that is nothing, and is not halved. */
static const double each = 1.0 / 4, nothing = 1.0 / 32;
/* The largest block that is not halved anyway, as a share of what is seen; and, of one that reflects upwards in part, of `area`. */
static const double largest = 1.0 / 64, wide = 4;

/* Cells [first, last) of columns and rows; where that is one, [low, high) of it, from 0 to 1. */
typedef struct block {
    size_t first[2], last[2];
    double low[2], high[2];
} block;

typedef struct looking {
    const closure *c;
    const tabulated_grid *grid;
    double v[4], tilt[2], o[3], k[3];
    double size[2];    /* of a cell under M, along columns and rows */
    double allowed;    /* error of E times cos_o */
    double seen, area; /* sigma(wo), or cos_o if that is more; and the error of it that leaves E what is allowed: G2 <= cos_o / seen */
    size_t facets;
    double along; /* 1 + Lambda_o of a walk, cliffs included; 0: it is none */
    int parts;    /* r, g, b; and 1 in place of F */
} looking;

/* The estimate of a block, times cos_o. */
typedef struct part {
    double rgb[CELL_PARTS], mass, facing; /* facing: its mass times k, or a bound of that where it is cut */
    int cut;                     /* k = 0 goes through it */
    int crossed;                 /* maybe some of it reflects wo upwards, and some does not */
} part;

static int is_cell(const block *b, int axis) {
    return b->last[axis] - b->first[axis] == 1;
}

/* mu of p. */
static void world(const looking *l, const double p[2], double mu[2]) {
    const double q[2] = {p[0] - l->tilt[0], p[1] - l->tilt[1]};
    for (int k = 0; k < 2; k++) mu[k] = l->v[k] * q[0] + l->v[2 + k] * q[1];
}

/* Of the slope p, F G2. */
static void passed(looking *l, const double p[2], double rgb[CELL_PARTS]) {
    double m[2];
    world(l, p, m);
    const double up = 1 / sqrt(m[0] * m[0] + m[1] * m[1] + 1), unit[3] = {m[0] * up, m[1] * up, up};
    const double facing = l->o[0] * unit[0] + l->o[1] * unit[1] + l->o[2] * unit[2];
    real i[3], F[CELL_PARTS] = {1, 1, 1, 1};
    for (int k = 0; k < CELL_PARTS; k++) rgb[k] = 0;
    l->facets++;
    for (int k = 0; k < 3; k++) i[k] = R(2 * facing * unit[k] - l->o[k]);
    if (!(facing > 0 && i[2] > 0)) return;
    const surface *s = l->c->surface;
    if (s->fresnel.kind) MU(fresnel_eval)(&s->fresnel, l->c->eta, smaller(R(facing), 1), F);
    const double G2 = l->along > 0 ? 1 / (l->along + MU(mu_ibl_walk_lambda)(l->c, i)) : (double)l->c->kernel->shadowing(l->c, i, 0);
    for (int k = 0; k < l->parts; k++) rgb[k] = (double)F[k] * G2;
}

/* Does some of the rectangle about p reflect wo upwards, to |mu - wo.xy / wo.z| < 1 / wo.z? *crossed: not all of it. */
static int reflects(const looking *l, const double p[2], const double half[2], int *crossed) {
    double mu[2];
    world(l, p, mu);
    const double from = hypot(mu[0] * l->o[2] - l->o[0], mu[1] * l->o[2] - l->o[1]) - 1,
                 reach = l->o[2] * (hypot(l->v[0], l->v[1]) * half[0] + hypot(l->v[2], l->v[3]) * half[1]);
    *crossed = from + reach > 0;
    return from < reach;
}

/* Mass, and where it is in the mean. */
static double mass_of(const tabulated_grid *g, const block *b, double mean[2]) {
    const size_t stride = g->columns + 1;
    double mass = 0, x = 0, y = 0, area = 1;
    for (size_t j = b->first[1]; j < b->last[1]; j++) {
        const double *sums = g->mass + j * stride, *moment = g->moment + j * stride,
                     row = sums[b->last[0]] - sums[b->first[0]];
        mass += row, x += moment[b->last[0]] - moment[b->first[0]], y += row * ((double)j + 0.5);
    }
    if (!(mass > 0)) return 0;
    mean[0] = x / mass, mean[1] = g->origin[1] + y / mass * g->cell[1];
    for (int k = 0; k < 2; k++)
        mean[k] += ((b->low[k] + b->high[k]) / 2 - 0.5) * g->cell[k], area *= b->high[k] - b->low[k];
    return mass * area;
}

static part value_of(looking *l, const block *b) {
    const tabulated_grid *g = l->grid;
    double p[2], half[2], rgb[CELL_PARTS];
    part out = {.mass = mass_of(g, b, p)};
    if (!(out.mass > 0)) return out;
    double k = l->k[2], middle[2], centre = l->k[2], span[2], away = 0;
    for (int a = 0; a < 2; a++) {
        const double low = (double)b->first[a] + b->low[a], high = (double)b->last[a] - 1 + b->high[a];
        half[a] = (high - low) / 2 * g->cell[a], middle[a] = g->origin[a] + (high + low) / 2 * g->cell[a];
        k += l->k[a] * p[a], centre += l->k[a] * middle[a], span[a] = 2 * fabs(l->k[a]) * half[a];
    }
    half_plane h = {.more = fmax(span[0], span[1]), .less = fmin(span[0], span[1])};
    h.half = (h.more + h.less) / 2;
    if (h.less < 1e-18 * h.more) h.less = 0;
    h.per_less = h.less > 0 ? 1 / h.less : 0;
    if (!(centre > -h.half) || !reflects(l, middle, half, &out.crossed)) return (part){.mass = 0};
    out.cut = centre < h.half;
    if (out.cut) { /* as if even; where it is seen in the mean, roughly: between its middle and its nearest corner */
        const double top = centre + h.half, at = fmax(centre, 0.7 * top);
        for (int a = 0; a < 2; a++)
            p[a] = middle[a] + copysign(half[a], l->k[a]) * (h.half > 0 ? (at - centre) / h.half : 0);
        k = mu_half_plane_cell(&h, centre), away = top;
    }
    out.facing = out.mass * (out.cut ? away : k);
    passed(l, p, rgb);
    for (int i = 0; i < l->parts; i++) out.rgb[i] = out.mass * k * rgb[i];
    return out;
}

/* Along columns or rows. */
static void halve(const block *b, int axis, block half[2]) {
    half[0] = half[1] = *b;
    if (is_cell(b, axis))
        half[0].high[axis] = half[1].low[axis] = (b->low[axis] + b->high[axis]) / 2;
    else
        half[0].last[axis] = half[1].first[axis] = (b->first[axis] + b->last[axis]) / 2;
}

/* Where to halve: where a half is empty; where it makes the most of a difference; or where it is longer under M. */
static int axis_of(const looking *l, const block *b, part of[2][2], const double off[2]) {
    double side[2];
    for (int a = 0; a < 2; a++)
        side[a] = l->size[a] * (is_cell(b, a) ? b->high[a] - b->low[a] : (double)(b->last[a] - b->first[a]));
    for (int a = 0; a < 2; a++)
        if (!(of[a][0].mass > 0 && of[a][1].mass > 0)) return a;
    return fmax(off[0], off[1]) > each * l->allowed ? off[1] > off[0] : side[1] > side[0];
}

static void refine(looking *l, const block *b, const part *whole, int depth, int calm, double sum[CELL_PARTS]) {
    if (whole->facing <= nothing * l->area || depth == DEEPEST || l->facets > FACETS) {
        for (int i = 0; i < l->parts; i++) sum[i] += whole->rgb[i];
        return;
    }
    block half[2][2];
    part of[2][2];
    double off[2] = {0, 0}, less[CELL_PARTS] = {0};
    int known = whole->facing <= largest * l->seen && (!whole->cut || (is_cell(b, 0) && is_cell(b, 1))) &&
                (!whole->crossed || whole->facing <= wide * l->area);
    for (int a = 0; a < 2; a++) {
        halve(b, a, half[a]);
        for (int k = 0; k < 2; k++) of[a][k] = value_of(l, &half[a][k]);
        for (int i = 0; i < l->parts; i++) {
            const double change = of[a][0].rgb[i] + of[a][1].rgb[i] - whole->rgb[i];
            off[a] = fmax(off[a], fabs(change)), less[i] += change;
        }
        known = known && of[a][0].mass > 0 && of[a][1].mass > 0 && off[a] <= each * l->allowed;
    }
    calm = known ? calm + 1 : 0;
    if (calm == CALM) {
        for (int i = 0; i < l->parts; i++) sum[i] += whole->rgb[i] + less[i];
        return;
    }
    const int axis = axis_of(l, b, of, off);
    for (int k = 0; k < 2; k++)
        if (of[axis][k].mass > 0) refine(l, &half[axis][k], &of[axis][k], depth + 1, calm, sum);
}

static void all_cells(const closure *c, int parts, double along, double allowed, double sum[CELL_PARTS]) {
    const double z = (double)c->map.view_z;
    looking l = {.c = c, .grid = &((const tabulated *)c->surface->base.table)->grid, .allowed = allowed * (double)c->wo[2], .parts = parts, .along = along};
    for (int k = 0; k < 4; k++) l.v[k] = (double)c->map.view[k] / z;
    for (int k = 0; k < 3; k++) l.o[k] = (double)c->wo[k];
    for (int k = 0; k < 2; k++) {
        l.tilt[k] = (double)c->map.tilt[k];
        l.k[k] = l.v[2 * k] * l.o[0] + l.v[2 * k + 1] * l.o[1];
        l.size[k] = hypot(l.v[2 * k], l.v[2 * k + 1]) * l.grid->cell[k];
    }
    l.seen = fmax(l.o[2], (double)c->sigma / z), l.area = allowed * l.seen;
    l.k[2] = l.o[2] - l.k[0] * l.tilt[0] - l.k[1] * l.tilt[1];
    const block all = {{0, 0}, {l.grid->columns, l.grid->rows}, {0, 0}, {1, 1}};
    const part whole = value_of(&l, &all);
    for (int k = 0; k < CELL_PARTS; k++) sum[k] = 0;
    if (whole.mass > 0) refine(&l, &all, &whole, 0, 0, sum);
    for (int k = 0; k < CELL_PARTS; k++) sum[k] /= l.o[2];
}

void MU(mu_ibl_cells_once)(const closure *c, double along, double allowed, double rgb[CELL_PARTS]) {
    all_cells(c, CELL_PARTS, along, allowed, rgb);
}

int MU(mu_ibl_albedo_of_cells)(const closure *c, double allowed, double rgb[3]) {
    const surface *s = c->surface;
    if (!(c->kernel->traits & HAS_JUMPS) || c->kernel == c->kernel->plans[PLAN_WALK]) return 0;
    if (s->transmission || !(c->wo[2] > 0)) return 0;
    double sum[CELL_PARTS];
    all_cells(c, 3, 0, allowed, sum);
    const int lobe = c->kernel == c->kernel->plans[PLAN_COMPENSATED] && c->lobe.count;
    for (int k = 0; k < 3; k++) {
        rgb[k] = sum[k];
        /* what compensation returns of even light (compensated.c): lost(wi) / A is 1 on average */
        if (lobe) rgb[k] += (double)((1 - c->lobe.passes[0]) * c->lobe.lost * c->lobe.repeated[k]);
    }
    return 1;
}
