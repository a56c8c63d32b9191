/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_patch.c: grows the patches of a table's side as fine as the definition asks: cells are halved along an axis until
 * what lies between their nodes (look_between) differs from what the nodes say by no more than half of what E may be off, either
 * axis adding its part; where a patch has LEAF halvings of cells along an axis, it is itself halved, so that cells are small
 * only where E asks for it: along the curves where a tilted surface turns its back, or total reflection begins.
 *
 * A kink halves with the cells, all else quarters; what is between nodes is computed to be compared, so that every cell was
 * tested; of tables that stand between others (of blurring, of a grid) that a kink halves is trusted, which saves half of
 * the work. Hardly anything is computed twice. Where halving has to end before (`halvings`, memory, or work) the patch stays open; of
 * tables that may not have such patches, `unsure` says by how much that leaves values off.
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/distribution.h"
#include "core/bsdf/multiple.h"

#if MU_REAL_BITS == 24

enum { LEAF = 2, MOST_PLACES = 3 /* log2 */, FINEST = ALBEDO_HALVINGS + 1, KNOWN_BITS = 12 };
_Static_assert(ALBEDO_KNOWN == 1 << KNOWN_BITS, "a place for each");
static const double edge =
    2e-3; /* how near a fold is asked, in columns, and in S: float tells sides by the square */

/* A part of a root patch, along u and S: the at-th of 2^level, in 2^log cells. */
typedef struct rect {
    int level[2], at[2], log[2];
    float left[2]; /* along either axis: what it is off, as far as is known */
    int open;      /* and that is too much */
} rect;

/* S from which on a fold leaves anything on its steeper side, tau = c / sqrt(1 - c²). */
static double fold_begins(const patch_maker *m) {
    const double c = (double)m->side->fold, tau = c / sqrt(1 - c * c), steep = (double)m->table->frame.steep,
                 smooth = (double)m->table->frame.smooth;
    const double rest = log1p((steep - smooth) / (smooth * (1 + steep * tau))) / (double)m->table->frame.span;
    return 1 - pow(rest, 1.0 / (1 << m->side->roots));
}

float mu_albedo_toward(const patch_maker *m, const float w[3]) {
    const float at[3] = {m->turn * w[0], m->turn * w[1], m->turn * w[2]};
    closure c;
    if (!mu_albedo_bind(m->source, at, &c)) return 1;
    return fmaxf(mu_albedo_lost(m->source, &c), ALBEDO_LEAST);
}

float mu_albedo_evaluate(const patch_maker *m, double u, double s) {
    const mu_albedo_side *const side = m->side;
    float w[3];
    double at = albedo_s(side, (m->row + s) / ALBEDO_ROWS);
    if (side->fold > 0) u = fmin(fmax(u, edge), 1 - edge); /* on its own side of the fold */
    if (side->fold > 0 && m->column == 0) at = fmax(at, fold_begins(m) + edge / 10);
    mu_albedo_direction(m->table, side, &m->table->frame, m->quadrant,
                        (float)((m->column + u) / m->table->columns), (float)at, w);
    return mu_albedo_toward(m, w);
}

/* The value at j, i of 2^log each of the root patch. */
static float value_at(patch_maker *m, int j, int log_u, int i, int log_s) {
    const int round = m->table->columns == 1;
    const uint64_t column = (uint64_t)(m->quadrant * m->table->columns + m->column),
                   across = round ? 0 : (uint64_t)j << (FINEST - log_u),
                   up = ((uint64_t)m->row << FINEST) + ((uint64_t)i << (FINEST - log_s)),
                   where = 1 + up + ((4 << FINEST) + 1) * (across + ((1 << FINEST) + 1) * column);
    albedo_known *const k = &m->known[where * 0x9e3779b97f4a7c15u >> (64 - KNOWN_BITS)];
    if (k->where != where)
        *k = (albedo_known){where, mu_albedo_evaluate(m, (double)j / (1 << log_u), (double)i / (1 << log_s))};
    return k->value;
}

/* The value at j, i of a part whose cells are halved `more` times along an axis, or -1 for neither. */
static float at(patch_maker *m, const rect *r, int j, int i, int axis, int more) {
    const int log_u = r->log[0] + (axis == 0 ? more : 0), log_s = r->log[1] + (axis == 1 ? more : 0);
    return value_at(m, (r->at[0] << log_u) + j, r->level[0] + log_u, (r->at[1] << log_s) + i,
                    r->level[1] + log_s);
}

/* Where the root patch's line at u meets the angle at which total reflection begins: S from 0 to 1, or below 0 if nowhere. */
static float critical(const patch_maker *m, double u) {
    const double index = m->source->definition->dielectric, eta = m->turn < 0 ? 1 / index : index;
    float w[3];
    if (!m->parted || !(eta < 1)) return -1;
    mu_albedo_direction(m->table, m->side, &m->table->frame, m->quadrant,
                        (float)((m->column + u) / m->table->columns), 0.5f, w);
    const float flat = hypotf(w[0], w[1]), sine = (float)eta;
    const float at_it[3] = {w[0] / flat * sine, w[1] / flat * sine, sqrtf(1 - sine * sine)};
    const albedo_place place = albedo_root(m->table, m->side, &m->table->frame, at_it);
    return place.patch % ALBEDO_ROWS == m->row ? place.s : -1;
}

/* What a line between nodes, the j-th, is off at S of the root patch. */
static float off_at(patch_maker *m, const rect *r, int j, float s) {
    float within = s * (float)(1 << r->level[1]) - (float)r->at[1];
    if (!(within >= 0 && within <= 1)) return 0;
    const int cell = albedo_cell(&within, r->log[1]);
    const float from = at(m, r, j, cell, -1, 0), to = at(m, r, j, cell + 1, -1, 0);
    const double u = (r->at[0] + (double)j / (1 << r->log[0])) / (1 << r->level[0]);
    return fabsf(mu_albedo_evaluate(m, u, (double)s) - from - (to - from) * within);
}

/* What a cell is off in its middle. */
static float off_within(patch_maker *m, const rect *r, int j, int i) {
    const int log_u = r->log[0] + 1, log_s = r->log[1] + 1;
    const float here = value_at(m, (r->at[0] << log_u) + 2 * j + 1, r->level[0] + log_u,
                                (r->at[1] << log_s) + 2 * i + 1, r->level[1] + log_s);
    return fabsf(here - (at(m, r, j, i, -1, 0) + at(m, r, j + 1, i, -1, 0) + at(m, r, j, i + 1, -1, 0) +
                         at(m, r, j + 1, i + 1, -1, 0)) /
                            4);
}

/* The most that lines between nodes along an axis are off what is midway; half of what cells are off in their middle, to which
 * both axes add; and what lines are off where total reflection begins, however narrow that is. */
static float look_between(patch_maker *m, const rect *r, int axis, size_t facets) {
    const int cells = 1 << r->log[axis], lines = 1 << r->log[!axis], round = m->table->columns == 1;
    float worst = 0;
    for (int k = 0; k <= (round ? 0 : lines); k++) {
        const float kink = axis ? critical(m, (r->at[0] + (double)k / lines) / (1 << r->level[0])) : -1;
        if (kink >= 0) worst = fmaxf(worst, off_at(m, r, k, kink));
        for (int i = 0; i < cells && m->source->effort->facets < facets; i++) {
            const float here = axis ? at(m, r, k, 2 * i + 1, 1, 1) : at(m, r, 2 * i + 1, k, 0, 1),
                        from = axis ? at(m, r, k, i, -1, 0) : at(m, r, i, k, -1, 0),
                        to = axis ? at(m, r, k, i + 1, -1, 0) : at(m, r, i + 1, k, -1, 0);
            worst = fmaxf(worst, fabsf(here - (from + to) / 2));
            if (k < lines && !round) worst = fmaxf(worst, off_within(m, r, axis ? k : i, axis ? i : k) / 2);
        }
    }
    return worst;
}

static size_t floats_of(const rect *r) {
    const size_t across = (size_t)1 << r->log[0], up = (size_t)1 << r->log[1];
    return (across + 1) * (up + 1) + across * up;
}

/* May a part have twice as many cells, as one patch or two, besides what is pending? */
static int has_room(const patch_maker *m, const rect *r, int patches) {
    const size_t needed = 2 * floats_of(r) + m->pending;
    return m->nodes + m->side->cells + needed <= m->floats && m->side->patches + (size_t)patches <= m->most;
}

/* Halves cells until both axes are near enough, or the work so far comes to `facets`; what is left is added to the side's.
 * Returns the axis along which the patch itself has to be halved, or -1. */
static int refine(patch_maker *m, rect *r, size_t facets) {
    const albedo_source *const source = m->source;
    const float wanted = (float)source->error / 2;
    const int isotropic = m->table->columns == 1;
    /* a cell at least for each 1.5 that u, or S, is a logarithm of, to a column or row */
    const float cells[2] = {m->table->frame.log / (1.5f * (float)m->table->columns),
                            m->side->worldly ? m->table->frame.span / (1.5f * ALBEDO_ROWS) : 0};
    float *const left = r->left;
    int done[2] = {isotropic, 0}, split = -1;
    /* of a root patch something has to be known: its first looks have no end */
    int unknown[2] = {!(left[0] > 0 || left[1] > 0), !(left[0] > 0 || left[1] > 0)};
    for (int axis = !isotropic; !done[0] || !done[1]; axis = isotropic ? 1 : !axis) {
        if (done[axis]) continue;
        const float before = left[axis];
        const int few = (float)(1 << (r->level[axis] + r->log[axis])) < cells[axis];
        left[axis] = few ? 1 : look_between(m, r, axis, unknown[axis] ? SIZE_MAX : facets);
        done[axis] = 1, unknown[axis] = 0;
        /* of a look that has to end early, what the one before said is known, at most */
        if (source->effort->facets >= facets && !few) left[axis] = fmaxf(left[axis], before);
        if (left[axis] <= wanted) continue;
        if (r->level[axis] + r->log[axis] >= source->halvings || (source->effort->facets >= facets && !few))
            continue;
        if (r->log[axis] == LEAF) {
            if (split < 0 || left[axis] > left[split]) split = axis;
            continue;
        }
        if (!has_room(m, r, 0)) continue;
        r->log[axis]++;
        done[axis] = 0;
        if (!isotropic && left[axis] > 4 * wanted)
            done[!axis] = split == !axis; /* new rows have to be seen along the other axis */
        left[axis] /= 2;
        if (source->trusting && left[axis] <= wanted) done[axis] = 1;
    }
    if (split >= 0 && has_room(m, r, 2)) return split;
    r->open = fmaxf(left[0], left[1]) > wanted;
    if (r->open && !source->opens) m->side->unsure = fmaxf(m->side->unsure, left[0] + left[1]);
    return -1;
}

static void store(patch_maker *m, albedo_patch *p, const rect *r) {
    const int across = 1 << r->log[0], up = 1 << r->log[1];
    *p = (albedo_patch){.node = (uint32_t)m->nodes,
                        .cell = m->side->cells,
                        .log_u = (uint8_t)r->log[0],
                        .log_s = (uint8_t)r->log[1],
                        .open = (uint8_t)(r->open && m->source->opens)};
    for (int j = 0; j <= across; j++)
        for (int i = 0; i <= up; i++) m->values[m->nodes++] = at(m, r, j, i, -1, 0);
    m->side->cells += (uint32_t)(across * up);
}

/* Is a patch near enough at other places of its cells, too? What was looked at before lies on a lattice, where an edge may cut a
 * corner, or be midway by chance. More of them the fewer times it was halved, of a sequence that fills the square evenly
 * (Roberts 2018). */
static int holds(patch_maker *m, const albedo_patch *p, const rect *r) {
    const int across = 1 << p->log_u, up = 1 << p->log_s, halved = r->level[0] + r->level[1],
              places = halved < MOST_PLACES ? across * up << (MOST_PLACES - halved) : across * up;
    float off = 0;
    for (int k = 0; k < places; k++) {
        const float x = m->place[0] = fmodf(m->place[0] + 0.75487767f, 1),
                    y = m->place[1] = fmodf(m->place[1] + 0.56984029f, 1);
        const int cell = k % (across * up), j = cell / up, i = cell % up;
        const float *const v = m->values + p->node + j * (up + 1) + i, *const next = v + up + 1,
                           low = v[0] + y * (v[1] - v[0]), high = next[0] + y * (next[1] - next[0]);
        const double u = (r->at[0] + (j + (double)x) / across) / (1 << r->level[0]),
                     s = (r->at[1] + (i + (double)y) / up) / (1 << r->level[1]);
        off = fmaxf(off, fabsf(mu_albedo_evaluate(m, u, s) - low - x * (high - low)));
    }
    return off <= (float)m->source->error * 0.8f;
}

/* A patch, and what it is halved to, until the work comes to `facets`: the first half may take three quarters of what is left. One
 * that does not hold is halved with its cells. */
static void fill(patch_maker *m, uint32_t patch, rect r, size_t facets) {
    int axis = refine(m, &r, facets), finer = 0;
    if (axis < 0) {
        albedo_patch *const p = &m->patch[patch];
        store(m, p, &r);
        if (p->open || !m->source->opens || m->source->trusting || holds(m, p, &r)) return;
        axis = m->table->columns == 1 || r.left[1] >= r.left[0], finer = 1;
        p->open = m->source->effort->facets >= facets || !has_room(m, &r, 2) ||
                  r.level[axis] + r.log[axis] >= m->source->halvings;
        if (p->open) return;
        m->nodes = p->node, m->side->cells = p->cell;
    }
    const uint32_t child = m->side->patches;
    m->side->patches += 2;
    m->patch[patch] = (albedo_patch){.cell = m->side->cells, .child = child, .axis = (uint8_t)axis};
    const size_t so_far = m->source->effort->facets;
    r.level[axis]++, r.at[axis] *= 2, r.log[axis] -= !finer;
    m->pending += floats_of(&r);
    fill(m, child, r, facets > so_far ? so_far + (facets - so_far) / 4 * 3 : so_far);
    m->pending -= floats_of(&r);
    r.at[axis]++;
    fill(m, child + 1, r, facets);
}

void mu_albedo_grow(patch_maker *m, size_t facets) {
    albedo_effort *const effort = m->source->effort;
    mu_albedo_side *const side = m->side;
    const int roots = m->table->quadrants * m->table->columns * ALBEDO_ROWS;
    /* what is not even turns within a quadrant as it likes, and a look sees nodes alone */
    const int least_log = m->table->quadrants > 1 && !m->source->trusting ? LEAF : 1;
    const rect whole = {{0, 0}, {0, 0}, {m->table->columns == 1 ? 0 : least_log, least_log}, {0, 0}, 0};
    side->unsure = 0, effort->off = 0;
    side->patch = m->patch, side->patches = (uint32_t)roots, side->cells = 0, m->nodes = 0;
    for (int k = 0; k < roots; k++) {
        const size_t before = effort->facets;
        m->row = k % ALBEDO_ROWS, m->column = k / ALBEDO_ROWS % m->table->columns;
        m->quadrant = k / ALBEDO_ROWS / m->table->columns;
        m->pending = (size_t)(roots - 1 - k) * floats_of(&whole);
        /* most of the work is for few of them: each may take all but some for the others */
        fill(m, (uint32_t)k, whole, before + (k == roots - 1 ? facets : facets / 8 * 7));
        facets -= effort->facets - before < facets ? effort->facets - before : facets;
    }
    if (effort->off > m->source->error / 2) side->unsure = fmaxf(side->unsure, (float)effort->off);
    side->lost = m->values;
    mu_albedo_fill_lobe(m, m->values + m->nodes);
}

#endif
