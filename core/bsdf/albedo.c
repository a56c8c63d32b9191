/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.c: makes the tables of albedo.h, from the very surface that they complete, as fine as the definition asks: a
 * patch is halved along an axis until what lies between its nodes (look_between) differs from what its nodes say by no more than
 * half of what E may be off, either axis adding its part. A kink halves with the cells, all else quarters; what is between
 * nodes is computed to be compared, so that every cell of the finished patch was tested; of tables that stand between
 * others (of blurring, of a grid) that a kink halves is trusted, which saves half of the work. Nothing is computed twice. Where
 * halving has to end before (ALBEDO_HALVINGS, or memory), `unsure` says by how much.
 */
#include "core/bsdf/multiple.h"
#include "core/bsdf/random.h"
#include "core/bsdf/singular.h"

#if MU_REAL_BITS == 24

/* Walks that tell where light leaves; nodes along a side of a patch at most, what is midway between them included. */
enum { WALKS = 2048, FINEST = ALBEDO_HALVINGS + 1, SIDE = (1 << FINEST) + 1 };
static const double roundest = 0.999; /* B/A that u knows: ln 1 is 0 */
static const double smallest = 1e-12; /* singular value of L, lest it leave float's range */
static const float least = 1e-7f;     /* what is lost at least: the lobe exists everywhere */

/* One patch while it grows. */
typedef struct patch_maker {
    const albedo_source *source;
    const mu_albedo *table;
    const mu_albedo_side *side;
    double core;
    float turn; /* +1; -1 from below */
    int quadrant, column, row;
    int log[2];                    /* along u, S */
    int parted;                    /* light is transmitted, too */
    float seen[SIDE][SIDE];        /* [u][S]: what was evaluated already, else NaN */
    float edge[ALBEDO_ROWS][SIDE]; /* of the patches of the column before, where they meet those of this */
} patch_maker;

static int bind_source(const albedo_source *s, const float w[3], closure *c) {
    if (!MU(mu_bind)(s->surface, w, s->transform, c)) return 0;
    if (s->blur > 0) MU(mu_blur)(c, s->blur);
    return 1;
}

double mu_albedo_core(const albedo_source *s, const closure *c) {
    const int is_gtr = s->definition->ndf == MU_GTR &&
                       c->kernel->plans[PLAN_GENERAL] == s->surface->kernel->plans[PLAN_GENERAL];
    return is_gtr ? fmin(1, (double)s->surface->alpha / s->surface->unit) : 1;
}

/* 1 - E at u and S of the patch, from 0 to 1. */
static float evaluate(const patch_maker *m, double u, double s) {
    float w[3];
    closure c;
    mu_albedo_direction(m->table, m->side, &m->table->frame, m->quadrant,
                        (float)((m->column + u) / m->table->columns),
                        (float)albedo_s(m->side, (m->row + s) / ALBEDO_ROWS), w);
    for (int k = 0; k < 3; k++) w[k] *= m->turn;
    if (!bind_source(m->source, w, &c)) return 1;
    if (m->source->slopes && c.kernel->traits & HAS_JUMPS) {
        m->source->effort->panels += ALBEDO_SLOPES / 11; /* of as many slopes */
        return fmaxf(1 - mu_albedo_of_slopes(&c, m->source->slopes), least);
    }
    const double allowed = fmin(m->source->error / 4, 1e-3);
    return fmaxf(1 - MU(albedo_integral)(&c, m->core, allowed, m->source->effort), least);
}

/* The value at j, i of 2^log each; each is evaluated once. */
static float at(patch_maker *m, int j, int log_u, int i, int log_s) {
    const double u = (double)j / (1 << log_u), s = (double)i / (1 << log_s);
    if (log_u > FINEST || log_s > FINEST) return evaluate(m, u, s);
    float *known = &m->seen[m->table->columns == 1 ? 0 : j << (FINEST - log_u)][i << (FINEST - log_s)];
    if (isnan(*known)) *known = evaluate(m, u, s);
    return *known;
}

/* Where the patch's line at u meets the angle at which total reflection begins: S from 0 to 1, or below 0 if nowhere. */
static float critical(const patch_maker *m, double u) {
    const double index = m->source->definition->dielectric, eta = m->turn < 0 ? 1 / index : index;
    float w[3];
    if (!m->parted || !(eta < 1)) return -1;
    mu_albedo_direction(m->table, m->side, &m->table->frame, m->quadrant,
                        (float)((m->column + u) / m->table->columns), 0.5f, w);
    const float flat = hypotf(w[0], w[1]), sine = (float)eta;
    const float at_it[3] = {w[0] / flat * sine, w[1] / flat * sine, sqrtf(1 - sine * sine)};
    const albedo_place place = albedo_locate(m->table, m->side, &m->table->frame, at_it);
    return place.patch % ALBEDO_ROWS == m->row ? place.s : -1;
}

/* What a line between nodes is off at S, at u = j of 2^log. */
static float off_at(patch_maker *m, int j, float s) {
    const int log_u = m->log[0], log_s = m->log[1];
    float within = s;
    const int cell = albedo_cell(&within, log_s);
    const float from = at(m, j, log_u, cell, log_s), to = at(m, j, log_u, cell + 1, log_s);
    return fabsf(evaluate(m, (double)j / (1 << log_u), (double)s) - from - (to - from) * within);
}

/* The most that lines between nodes along an axis are off what is midway; or, of what transmits, at quarters, since inflections
 * hide midway what is off on both sides of it, and where total reflection begins, however narrow that is. */
static float look_between(patch_maker *m, int axis, size_t panels) {
    const int cells = 1 << m->log[axis], lines = 1 << m->log[!axis], parts = m->parted ? 2 : 1;
    float worst = 0;
    for (int k = 0; k <= (m->table->columns == 1 ? 0 : lines); k++) {
        const float kink = axis ? critical(m, (double)k / lines) : -1;
        if (kink >= 0) worst = fmaxf(worst, off_at(m, k, kink));
        for (int i = 0; i < cells << parts && m->source->effort->panels < panels; i++) {
            const int cell = i >> parts, step = i - (cell << parts);
            if (!step) continue;
            const int *const log = m->log;
            const float here =
                            axis ? at(m, k, log[0], i, log[1] + parts) : at(m, i, log[0] + parts, k, log[1]),
                        from = axis ? at(m, k, log[0], cell, log[1]) : at(m, cell, log[0], k, log[1]),
                        to = axis ? at(m, k, log[0], cell + 1, log[1]) : at(m, cell + 1, log[0], k, log[1]);
            worst = fmaxf(worst, fabsf(here - from - (to - from) * (float)step / (float)(1 << parts)));
        }
    }
    return worst;
}

/* Halves until both axes are near enough, or the work so far comes to `panels`; returns what is left. */
static float grow(patch_maker *m, size_t most, size_t panels) {
    const float wanted = (float)m->source->error / 2;
    const int isotropic = m->table->columns == 1;
    /* a cell at least for each 1.5 of ln(A/B) that u is to a column */
    const float steps = m->table->frame.log / (1.5f * (float)m->table->columns);
    m->log[0] = isotropic ? 0 : steps > 2 ? (int)ceilf(log2f(steps)) : 1, m->log[1] = 1;
    float left[2] = {0, 0};
    int done[2] = {isotropic, 0};
    for (int axis = !isotropic; !done[0] || !done[1]; axis = isotropic ? 1 : !axis) {
        if (done[axis]) continue;
        const float before = left[axis];
        left[axis] = look_between(m, axis, panels);
        done[axis] = 1;
        /* of a look that has to end early, what the one before said is known, at most */
        if (m->source->effort->panels >= panels) left[axis] = fmaxf(left[axis], before);
        if (left[axis] <= wanted) continue;
        const size_t cells = (size_t)1 << (m->log[0] + m->log[1]);
        if (m->log[axis] >= m->source->halvings || m->source->effort->panels >= panels ||
            2 * (2 * cells + (1u << m->log[0]) + (2u << m->log[1])) > most)
            continue;
        m->log[axis]++;
        done[axis] = 0;
        if (!isotropic && left[axis] > 4 * wanted)
            done[!axis] = 0; /* new rows have to be seen along the other axis */
        left[axis] /= 2;
        if (m->source->trusting && left[axis] <= wanted) done[axis] = 1;
    }
    return fmaxf(left[0], left[1]) > wanted ? left[0] + left[1] : 0;
}

/* Nothing is known of a patch but the edges where it meets those before. */
static void start(patch_maker *m, int k) {
    float below[SIDE];
    const int row = k % ALBEDO_ROWS, column = k / ALBEDO_ROWS % m->table->columns;
    if (column > 0 || row > 0)
        for (int j = 0; j < SIDE; j++) below[j] = m->seen[j][SIDE - 1];
    for (int i = 0; i < SIDE; i++) {
        if (k > 0) m->edge[m->row][i] = m->seen[SIDE - 1][i];
        for (int j = 0; j < SIDE; j++) m->seen[j][i] = NAN;
    }
    m->row = row, m->column = column, m->quadrant = k / ALBEDO_ROWS / m->table->columns;
    for (int i = 0; column > 0 && i < SIDE; i++) m->seen[0][i] = m->edge[row][i];
    for (int j = 0; row > 0 && j < SIDE; j++) m->seen[j][0] = below[j];
}

static size_t fill_side(const albedo_source *source, const mu_albedo *t, double core, float turn,
                        mu_albedo_side *out, float *values, size_t most) {
    patch_maker m = {.source = source, .table = t, .side = out, .core = core, .turn = turn};
    m.parted = source->surface->transmission;
    const int patches = t->quadrants * t->columns * ALBEDO_ROWS;
    albedo_effort *const effort = source->effort;
    size_t nodes = 0, cells = 0, left = source->panels / (source->surface->transmission ? 2 : 1);
    out->unsure = 0, effort->off = 0;
    for (int k = 0; k < patches; k++) {
        start(&m, k);
        /* what is left, but for the least of those to come */
        const size_t used = nodes + cells, kept = (size_t)(patches - 1 - k) * 13, before = effort->panels;
        const size_t memory = most > used + kept ? most - used - kept : 0;
        /* of work, too, whatever those before have left, and a hard one more than its part */
        out->unsure =
            fmaxf(out->unsure, grow(&m, memory, before + left / (size_t)(1 + (patches - 1 - k) / 4)));
        left -= effort->panels - before < left ? effort->panels - before : left;
        const int across = 1 << m.log[0], up = 1 << m.log[1];
        out->patch[k] =
            (albedo_patch){(uint32_t)nodes, (uint32_t)cells, (uint8_t)m.log[0], (uint8_t)m.log[1]};
        for (int j = 0; j <= across; j++)
            for (int i = 0; i <= up; i++) values[nodes++] = at(&m, j, m.log[0], i, m.log[1]);
        cells += (size_t)(across * up);
    }
    if (effort->off > source->error / 2) out->unsure = fmaxf(out->unsure, (float)effort->off);
    out->lost = values, out->cells = (uint32_t)cells;
    mu_albedo_fill_lobe(t, out, values + nodes);
    return nodes + cells;
}

/* Of what meets two facets or more and leaves, the share that leaves on the upper side, under uniform light from above:
 * walks from cosine-distributed directions. */
static double share_above(const albedo_source *source) {
    multiple with = {0};
    MU(multiple_average)(source->surface, with.average);
    double above = 0, all = 0;
    for (int i = 0; i < WALKS; i++) {
        const float u0 = ((float)i + 0.5f) / WALKS, u1 = (float)fmod(i * 0.61803398874989485, 1);
        const float sine = sqrtf(u0), phi = (float)(2 * PI) * u1;
        const float wo[3] = {sine * cosf(phi), sine * sinf(phi), sqrtf(1 - u0)}, u[3] = {u0, u1, 0.5f};
        closure c;
        walk_end end;
        if (!bind_source(source, wo, &c)) continue;
        MU(walk_trace)(c.kernel, &c, &with, u, &end);
        if (end.bounces < 2 || !(end.i[2] > 0)) continue;
        all++;
        if (!end.transmitted) above++;
    }
    return all > 0 ? above / all : 0.5;
}

/* L = diag(a, b) R from V: turned to the axes of M, those of V^T V; and what is rougher than 1 along one is bounded. */
float mu_albedo_lay(const double v[4], mu_albedo_frame *f) {
    const double plus = hypot(v[0] + v[3], v[1] - v[2]), minus = hypot(v[0] - v[3], v[1] + v[2]);
    const double large = fmax((plus + minus) / 2, (double)FLT_MIN),
                 n[4] = {v[0] / large, v[1] / large, v[2] / large, v[3] / large};
    const double ratio = fmax(fabs(product_difference(n[0], n[3], n[1], n[2])), smallest);
    /* twice the axes' angle, and the half of it that does not cancel */
    const double p = n[0] * n[0] + n[2] * n[2] - n[1] * n[1] - n[3] * n[3],
                 q = 2 * (n[0] * n[1] + n[2] * n[3]), r = hypot(p, q), root = sqrt((r + fabs(p)) / 2);
    double c = 1, s = 0;
    if (r > 0) {
        const double other = fabs(q) / (2 * root), length = sqrt(r);
        c = (p >= 0 ? root : other) / length, s = -copysign(p >= 0 ? other : root, q) / length;
    }
    const double a = fmin(fmax(large, smallest), 1), b = fmin(fmax(large * ratio, smallest), 1);
    *f = (mu_albedo_frame){.to = {(float)(a * c), (float)(-a * s), (float)(b * s), (float)(b * c)},
                           .from = {(float)(c / a), (float)(s / b), (float)(-s / a), (float)(c / b)},
                           .det = (float)(a * b),
                           .k = (float)(b / a),
                           .ratio = (float)fmin(ratio, roundest)};
    f->log = -logf(f->ratio);
    return (float)large;
}

void mu_albedo_turn(mu_albedo_frame *f, double turn) {
    const double c = cos(turn), s = sin(turn);
    for (int k = 0; k < 2; k++) {
        const double x = (double)f->to[2 * k], y = (double)f->to[2 * k + 1], u = (double)f->from[k],
                     v = (double)f->from[2 + k];
        f->to[2 * k] = (float)(x * c - y * s), f->to[2 * k + 1] = (float)(x * s + y * c);
        f->from[k] = (float)(c * u - s * v), f->from[2 + k] = (float)(s * u + c * v);
    }
}

static void lay(const closure *c, mu_albedo *t) {
    const map *m = &c->map;
    double v[4];
    for (int k = 0; k < 4; k++) v[k] = (double)m->view[k] / (double)m->view_z;
    mu_albedo_lay(v, &t->frame);
    const singular s = singular_of(v);
    const int isotropic = fabs(s.small) >= s.large * (1 - 1e-6);
    const int level = m->tilt[0] == 0 && m->tilt[1] == 0 && !(c->kernel->traits & ANISOTROPIC);
    t->quadrants = level ? 1 : 4;
    t->columns = level && isotropic ? 1 : ALBEDO_COLUMNS;
}

/* n by which 8 steps of S say E best, at two azimuths. */
static int best_roots(const albedo_source *source, const mu_albedo *t, double core, float turn,
                      mu_albedo_side *side, double *error_of_it) {
    enum { MOST = 4, STEPS = 16, AZIMUTHS = 2 };
    double least_error = INFINITY;
    int best = 0;
    for (side->roots = 0; side->roots < MOST; side->roots++) {
        patch_maker m = {.source = source, .table = t, .side = side, .core = core, .turn = turn};
        double error = 0;
        for (int k = 0; k < (t->columns == 1 ? 1 : AZIMUTHS); k++) {
            float lost[STEPS + 1];
            for (int i = 0; i <= STEPS; i++)
                lost[i] = evaluate(&m, t->columns * (0.3 + 0.4 * k), (double)i / STEPS * ALBEDO_ROWS);
            for (int i = 1; i < STEPS; i += 2)
                error += pow(fabs((double)lost[i] - ((double)lost[i - 1] + (double)lost[i + 1]) / 2), 2);
        }
        if (error < least_error) least_error = error, best = side->roots;
    }
    *error_of_it = least_error;
    return best;
}

/* And sqrt(S) where the microsurface is not even, or if that halves what is off. */
static void choose_roots(const albedo_source *source, const mu_albedo *t, double core, float turn,
                         mu_albedo_side *side) {
    double plain, rooted;
    side->rooted = t->quadrants > 1;
    const int roots = best_roots(source, t, core, turn, side, &plain);
    if (!side->rooted && !source->trusting) {
        side->rooted = 1;
        const int others = best_roots(source, t, core, turn, side, &rooted);
        if (rooted < plain / 4) {
            side->roots = others;
            return;
        }
        side->rooted = 0;
    }
    side->roots = roots;
}

size_t mu_albedo_make(const albedo_source *source, mu_albedo *t, float *values, size_t most) {
    const float up[3] = {0, 0, 1};
    closure c;
    bind_source(source, up, &c);
    lay(&c, t);
    const double core = mu_albedo_core(source, &c);
    const int sides = source->surface->transmission ? 2 : 1;
    size_t used = 0;
    t->side[1].cells = 0;
    for (int i = 0; i < sides; i++) {
        mu_albedo_side *const side = &t->side[i];
        if (source->like)
            side->roots = source->like->side[i].roots, side->rooted = source->like->side[i].rooted;
        else
            choose_roots(source, t, core, i ? -1.0f : 1.0f, side);
        used += fill_side(source, t, core, i ? -1.0f : 1.0f, &t->side[i], values + used,
                          (most - used) / (size_t)(sides - i));
        t->side[i].passes = 0;
    }
    if (sides == 1) return used;
    /* passes average is the same from both sides but for eta², or the surface were not reciprocal */
    const double eta2 = source->definition->dielectric * source->definition->dielectric,
                 above = (double)t->side[0].average, below = (double)t->side[1].average * eta2;
    const double passes = fmin((1 - share_above(source)) * above, fmin(above, below));
    t->side[0].passes = (float)(passes / above);
    t->side[1].passes = (float)(passes / below);
    return used;
}

#endif
