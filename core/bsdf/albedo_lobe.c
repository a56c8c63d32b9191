/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_lobe.c: the smooth lobe of albedo.h, lost(w) cos w: how much of it lies in which cell, and directions drawn from it,
 * uniform in u and S within a cell; and what is lost on average, of open patches by quadratures at some thousand places.
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

/* Gauss-Legendre on [0, 1], 4 nodes. */
static const double node[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                               0.93056815579702629};
static const double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872693};

/* Where what is lost is asked to tell its average over open patches. */
enum { PLACES = 1 << 12 };

void mu_albedo_direction(const mu_albedo *t, const mu_albedo_side *side, const mu_albedo_frame *f,
                         int quadrant, float u, float s, float w[3]) {
    float rest = fmaxf(1 - s, 0), tau = 0;
    for (int k = 0; k < side->roots; k++) rest *= rest;
    const float root = side->roots ? sqrtf(1 - rest) : sqrtf(fminf(s, 1)),
                r = root * (1 + root) / fmaxf(rest, 1e-7f);
    const int round = t->columns == 1;
    if (side->worldly) {
        rest = fmaxf(rest, 1e-7f);
        tau = expm1f((1 - rest) * t->frame.span) / (t->frame.steep * -expm1f(-rest * t->frame.span));
        if (side->fold > 0) {
            const float fold = albedo_fold(t, side, fmaxf(tau, 1e-12f));
            const float beside = 2 * u - 1;
            u = fold + beside * fabsf(beside) * (u < 0.5f ? fold : 1 - fold);
        }
    }
    const float x = round ? cosf(u * (float)(PI / 2)) : -expm1f((u - 1) * t->frame.log) / t->frame.k,
                y = round ? sinf(u * (float)(PI / 2)) : expm1f(u * t->frame.log),
                scale = (side->worldly ? 1 : r) / hypotf(x, y);
    const float q[2] = {quadrant & 1 ? -scale * x : scale * x, quadrant & 2 ? -scale * y : scale * y};
    w[0] = f->from[0] * q[0] + f->from[1] * q[1];
    w[1] = f->from[2] * q[0] + f->from[3] * q[1];
    if (side->worldly) {
        const float flat = tau / hypotf(w[0], w[1]);
        w[0] *= flat, w[1] *= flat;
    }
    const float length = hypotf(hypotf(w[0], w[1]), 1);
    w[0] /= length, w[1] /= length, w[2] = 1 / length;
}

static void integrate_panel(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side,
                            int quadrant, double u0, double u1, double s0, double s1, double sums[2]) {
    for (int i = 0; i < 16; i++) {
        float w[3];
        mu_albedo_direction(t, side, f, quadrant, (float)(u0 + (u1 - u0) * node[i / 4]),
                            (float)(s0 + (s1 - s0) * node[i % 4]), w);
        const albedo_place at = albedo_locate(t, side, f, w);
        const double cosines =
            weight[i / 4] * weight[i % 4] * (u1 - u0) * (s1 - s0) * (double)w[2] / (double)at.stretch;
        sums[0] += cosines * (double)albedo_lost(side, at), sums[1] += cosines;
    }
}

/* The integral of lost cos over u0 ... u1 of a cell of S, and of cos, by Gauss's rule. A cell at S = 0 is halved toward it: of
 * a smooth surface that is where most directions are. */
static void integrate(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, int quadrant,
                      double u0, double u1, double s0, double s1, double sums[2]) {
    double high = s1;
    if (side->worldly) { /* a logarithm: panels of 0.7 at most */
        const int whole = 1 << side->roots;
        const int parts =
            (int)ceil((pow(1 - s0, whole) - pow(1 - s1, whole)) * (double)t->frame.span / 0.7 + 1e-9);
        for (int k = 0; k < parts; k++)
            integrate_panel(t, f, side, quadrant, u0, u1, s0 + (s1 - s0) * k / parts,
                            s0 + (s1 - s0) * (k + 1) / parts, sums);
        return;
    }
    for (; s0 == 0 && high > 0.25 * (double)f->det; high /= 2)
        integrate_panel(t, f, side, quadrant, u0, u1, high / 2, high, sums);
    integrate_panel(t, f, side, quadrant, u0, u1, s0, high, sums);
}

/* Along u a cell at 0 is halved toward it: where u is a logarithm, that is where most azimuths are; and of a frame whose axes differ by more
 * than the table's, they are nearer still. */
static double share(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, int quadrant,
                    double u0, double u1, double s0, double s1, double *cosines) {
    double sums[2] = {0, 0};
    if (side->worldly) {
        const int parts = (int)ceil((u1 - u0) * (double)t->frame.log / 0.7);
        for (int k = 0; k < parts; k++)
            integrate(t, f, side, quadrant, u0 + (u1 - u0) * k / parts, u0 + (u1 - u0) * (k + 1) / parts, s0,
                      s1, sums);
    } else if (u0 > 0) {
        integrate(t, f, side, quadrant, u0, u1, s0, s1, sums);
    } else {
        const double near = fmin(1, (double)(f->k / t->frame.k)),
                     log = t->columns == 1 ? near < 0.9 : (double)t->frame.log;
        double high = u1;
        for (; high * log > 0.5 * near; high /= 2)
            integrate(t, f, side, quadrant, high / 2, high, s0, s1, sums);
        integrate(t, f, side, quadrant, 0, high, s0, s1, sums);
    }
    *cosines += sums[1];
    return sums[0];
}

/* Sums over a side: the cells' integrals, unless they are NULL; and in open patches what is lost, at a place for so much of cos. */
typedef struct summing {
    const mu_albedo *t;
    const mu_albedo_frame *f;
    const mu_albedo_side *side;
    float *cells;
    double total, cosines, open;
    const patch_maker *maker; /* NULL: as interpolated */
    double every, owed, u, s; /* of these places */
} summing;

/* A cell, and the integral of cos over it. */
typedef struct lobe_cell {
    int quadrant;
    double u0, u1, s0, s1, cosines;
} lobe_cell;

/* What is lost over a cell of an open patch beyond what is interpolated there: an estimate without bias, by places of a sequence that
 * fills the square evenly (Roberts 2018). */
static double missed(summing *to, const lobe_cell *c) {
    double sum = 0;
    for (to->owed += c->cosines; to->owed > to->every; to->owed -= to->every) {
        float w[3];
        to->u = fmod(to->u + 0.7548776662466927, 1), to->s = fmod(to->s + 0.5698402909980532, 1);
        mu_albedo_direction(to->t, to->side, to->f, c->quadrant, (float)(c->u0 + (c->u1 - c->u0) * to->u),
                            (float)(c->s0 + (c->s1 - c->s0) * to->s), w);
        const albedo_place at = albedo_locate(to->t, to->side, to->f, w);
        const double here = (c->u1 - c->u0) * (c->s1 - c->s0) * (double)w[2] / (double)at.stretch;
        sum += to->every / c->cosines * here *
               (double)(mu_albedo_toward(to->maker, w) - albedo_lost(to->side, at));
    }
    return sum;
}

/* A patch from u on, `width` of u wide: row `row` of 4 2^log. */
static void sum_patch(summing *to, int quadrant, const albedo_patch *p, double u, double width, int row,
                      int log) {
    if (p->child) {
        const albedo_patch *const half = &to->side->patch[p->child];
        for (int k = 0; k < 2; k++)
            if (p->axis)
                sum_patch(to, quadrant, &half[k], u, width, 2 * row + k, log + 1);
            else
                sum_patch(to, quadrant, &half[k], u + k * width / 2, width / 2, row, log);
        return;
    }
    const int across = 1 << p->log_u, up = 1 << p->log_s, rows = ALBEDO_ROWS << (log + p->log_s);
    for (int i = 0; i < across * up; i++) {
        const double from = u + width * (i / up) / across, at = (row << p->log_s) + i % up;
        lobe_cell c = {quadrant,
                       from,
                       from + width / across,
                       albedo_s(to->side, at / rows),
                       albedo_s(to->side, (at + 1) / rows),
                       0};
        double sum = share(to->t, to->f, to->side, quadrant, c.u0, c.u1, c.s0, c.s1, &c.cosines);
        if (p->open && to->maker) sum += missed(to, &c);
        to->total += sum, to->cosines += c.cosines, to->open += p->open ? c.cosines : 0;
        if (to->cells) to->cells[p->cell + (uint32_t)i] = (float)fmax(sum, 1e-7 * c.cosines);
    }
}

static void sum_side(summing *to) {
    for (int k = 0; k < to->t->quadrants * to->t->columns * ALBEDO_ROWS; k++)
        sum_patch(to, k / ALBEDO_ROWS / to->t->columns, &to->side->patch[k],
                  (double)(k / ALBEDO_ROWS % to->t->columns) / to->t->columns, 1.0 / to->t->columns,
                  k % ALBEDO_ROWS, 0);
}

double mu_albedo_average(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side) {
    summing all = {.t = t, .f = f, .side = side};
    sum_side(&all);
    return all.total / all.cosines;
}

void mu_albedo_fill_lobe(const patch_maker *m, float *cumulative) {
    mu_albedo_side *const side = m->side;
    summing all = {.t = m->table, .f = &m->table->frame, .side = side, .cells = cumulative};
    sum_side(&all);
    side->open = (float)(all.open / all.cosines);
    if (all.open > 0) {
        all.maker = m, all.every = all.open / PLACES;
        all.total = all.cosines = all.open = 0;
        sum_side(&all);
    }
    side->average = (float)(all.total / all.cosines);
    side->cumulative = cumulative;
    double total = 0, so_far = 0;
    for (uint32_t cell = 0; cell < side->cells; cell++) total += (double)cumulative[cell];
    for (uint32_t cell = 0; cell < side->cells; cell++) {
        so_far += (double)cumulative[cell] / total;
        cumulative[cell] = (float)so_far;
    }
    cumulative[side->cells - 1] = 1;
}

void mu_albedo_draw(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, float u0,
                    float u1, float w[3]) {
    uint32_t low = 0, high = side->cells - 1;
    while (low < high) { /* the first cell whose sum is above u0 */
        const uint32_t middle = (low + high) / 2;
        if (side->cumulative[middle] > u0) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    const float before = low ? side->cumulative[low - 1] : 0;
    float within = fminf((u0 - before) / (side->cumulative[low] - before), 0x0.ffffffp0f);
    int root = 0, log = 0;
    while (root + 1 < t->quadrants * t->columns * ALBEDO_ROWS && side->patch[root + 1].cell <= low) root++;
    const albedo_patch *p = &side->patch[root];
    double at = root / ALBEDO_ROWS % t->columns, width = 1,
           row = root % ALBEDO_ROWS; /* in columns, and in rows of 2^-log */
    while (p->child) {
        const int second = side->patch[p->child + 1].cell <= low;
        if (p->axis)
            row = 2 * row + second, log++;
        else
            width /= 2, at += second * width;
        p = &side->patch[p->child + (uint32_t)second];
    }
    const int i = (int)(low - p->cell), up = 1 << p->log_s;
    int quadrant = root / ALBEDO_ROWS / t->columns;
    if (t->quadrants == 1) { /* which of the four */
        quadrant = (int)(4 * within);
        within = 4 * within - (float)quadrant;
    }
    at += width * ((double)(i / up) + (double)within) / (1 << p->log_u);
    row = row * up + i % up;
    const double rows = ALBEDO_ROWS << (log + p->log_s), from = albedo_s(side, row / rows),
                 to = albedo_s(side, (row + 1) / rows);
    mu_albedo_direction(t, side, f, quadrant, (float)(at / t->columns),
                        (float)(from + (to - from) * (double)u1), w);
}

#endif
