/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.c: makes the tables of albedo.h, from the very surface that they complete: their frames, roots, and the share of
 * light that passes; albedo_patch.c fills them.
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/random.h"
#include "core/bsdf/singular.h"

#if MU_REAL_BITS == 24

enum { WALKS = 2048 };                /* that tell where light leaves */
static const double roundest = 0.999; /* B/A that u knows: ln 1 is 0 */
static const float widely = 6;        /* ln(P/p) from which on S is a logarithm */
static const double smallest = 1e-12; /* singular value of L, lest it leave float's range */

int mu_albedo_bind(const albedo_source *s, const float w[3], closure *c) {
    if (!MU(mu_bind)(s->surface, w, s->transform, c)) return 0;
    if (s->blur > 0) MU(mu_blur)(c, s->blur);
    return 1;
}

/* Blurring makes GGX of what is not. */
static int is_blurred(const albedo_source *s, const closure *c) {
    return c->kernel->plans[PLAN_GENERAL] != s->surface->kernel->plans[PLAN_GENERAL];
}

void mu_albedo_measure(const albedo_source *s, albedo_lengths *out) {
    closure c;
    mu_albedo_bind(s, (const float[]){0, 0, 1}, &c);
    /* gtr of gamma < 1 is measured in slopes of 1, but crowds at alpha too */
    const int is_gtr = s->definition->ndf == MU_GTR && !is_blurred(s, &c);
    mu_albedo_lengths_of(&c, is_gtr ? fmin(1, (double)s->surface->alpha / s->surface->unit) : 1, out);
}

float mu_albedo_lost(const albedo_source *s, const closure *c) {
    if (s->slopes && c->kernel->traits & HAS_JUMPS)
        return 1 - mu_albedo_of_slopes(c, s->slopes, s->stride ? s->begin : 0, s->stride ? s->stride : 1,
                                       s->effort);
    return 1 - MU(albedo_integral)(c, s->lengths[is_blurred(s, c)], s->allowed, s->effort);
}

/* Under uniform light from above: walks from cosine-distributed directions. */
double mu_albedo_share_above(const albedo_source *source, int walks) {
    multiple with = {0};
    MU(multiple_average)(source->surface, with.average);
    double above = 0, all = 0;
    for (int i = 0; i < walks; i++) {
        const float u0 = ((float)i + 0.5f) / (float)walks, u1 = (float)fmod(i * 0.61803398874989485, 1);
        const float sine = sqrtf(u0), phi = (float)(2 * PI) * u1;
        const float wo[3] = {sine * cosf(phi), sine * sinf(phi), sqrtf(1 - u0)}, u[3] = {u0, u1, 0.5f};
        closure c;
        walk_end end;
        if (!mu_albedo_bind(source, wo, &c)) continue;
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
    f->steep = (float)fmax(large, 1),
    f->smooth = (float)fmin(b / ((double)f->steep * (double)f->steep), 0.99),
    f->span = logf(f->steep / f->smooth);
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

/* A matrix of the length by which slopes are spread about 0 along w, sqrt(|V w|² + (mean . w)²): a tilt turns its back by that. */
static void with_mean(const double v[4], const double mean[2], double out[4]) {
    const double from = atan2(v[2], v[0]), c = cos(from),
                 s = sin(from); /* V by rows that leave [1 0] on the x axis */
    const double x = hypot(v[0], v[2]), y = c * v[1] + s * v[3], z = c * v[3] - s * v[1];
    const double length = hypot(x, mean[0]), p = x / length, q = mean[0] / length;
    out[0] = length, out[1] = p * y + q * mean[1], out[2] = 0, out[3] = hypot(z, p * mean[1] - q * y);
}

static void lay(const closure *c, mu_albedo *t) {
    const map *m = &c->map;
    double v[4], both[4], mean[2];
    for (int k = 0; k < 4; k++) v[k] = (double)m->view[k] / (double)m->view_z;
    for (int k = 0; k < 2; k++) mean[k] = (double)m->tilt[0] * v[k] + (double)m->tilt[1] * v[2 + k];
    with_mean(v, mean, both);
    mu_albedo_lay(both, &t->frame);
    const singular s = singular_of(v);
    const int isotropic = fabs(s.small) >= s.large * (1 - 1e-6);
    const int level = m->tilt[0] == 0 && m->tilt[1] == 0 && !(c->kernel->traits & ANISOTROPIC);
    t->quadrants = level ? 1 : 4;
    t->columns = level && isotropic ? 1 : ALBEDO_COLUMNS;
}

/* What light can do from a side that is denser, where facets face x alone: c of albedo.h; else 0. */
static float fold_of(const albedo_source *source, const mu_albedo *t, float turn) {
    const double index = source->definition->dielectric, eta = turn < 0 ? 1 / index : index;
    return t->frame.ratio < 0.125f && eta < 1 ? (float)sqrt((1 - eta) * (1 + eta)) : 0;
}

/* n by which 8 steps of S say E best, at two azimuths. */
static void choose_s(const albedo_source *source, const mu_albedo *t, float turn, mu_albedo_side *side,
                     double *error_of_it) {
    enum { MOST = 4, STEPS = 16, AZIMUTHS = 2 };
    double least_error = INFINITY;
    int best = 0;
    for (side->roots = 0; side->roots < MOST; side->roots++) {
        patch_maker m = {.source = source, .table = t, .side = side, .turn = turn};
        double error = 0;
        for (int k = 0; k < (t->columns == 1 ? 1 : AZIMUTHS); k++) {
            float lost[STEPS + 1];
            for (int i = 0; i <= STEPS; i++)
                lost[i] =
                    mu_albedo_evaluate(&m, t->columns * (0.3 + 0.4 * k), (double)i / STEPS * ALBEDO_ROWS);
            for (int i = 1; i < STEPS; i += 2)
                error += pow(fabs((double)lost[i] - ((double)lost[i - 1] + (double)lost[i + 1]) / 2), 2);
        }
        if (error < least_error) least_error = error, best = side->roots;
    }
    side->roots = best, *error_of_it = least_error;
}

/* And sqrt(S) where the microsurface is not even, or if that halves what is off; of glass without tilt whose slopes and angles are
 * of very different scales the logarithm. */
static void choose_roots(const albedo_source *source, const mu_albedo *t, float turn, mu_albedo_side *side) {
    double plain, rooted;
    const double *const tilt = source->definition->tilt;
    side->worldly = source->surface->transmission && !source->trusting && tilt[0] == 0 && tilt[1] == 0 &&
                    t->columns > 1 && t->frame.span > widely;
    side->fold = side->worldly ? fold_of(source, t, turn) : 0;
    side->rooted = t->quadrants > 1;
    choose_s(source, t, turn, side, &plain);
    if (side->rooted || source->trusting) return;
    const int roots = side->roots;
    side->rooted = 1;
    choose_s(source, t, turn, side, &rooted);
    if (!(rooted < plain / 4)) side->rooted = 0, side->roots = roots;
}

static size_t smallest_of(size_t a, size_t b) {
    return a < b ? a : b;
}

void mu_albedo_make(const albedo_source *source, mu_albedo *t, albedo_room *room, size_t floats) {
    const float up[3] = {0, 0, 1};
    closure c;
    mu_albedo_bind(source, up, &c);
    lay(&c, t);
    const int sides = source->surface->transmission ? 2 : 1;
    const size_t before = source->effort->facets;
    t->side[1].cells = 0;
    for (int i = 0; i < sides; i++) {
        mu_albedo_side *const side = &t->side[i];
        if (source->like)
            side->roots = source->like->side[i].roots, side->rooted = source->like->side[i].rooted,
            side->worldly = source->like->side[i].worldly, side->fold = source->like->side[i].fold;
        else
            choose_roots(source, t, i ? -1.0f : 1.0f, side);
        patch_maker m = {.source = source, .table = t, .side = side, .turn = i ? -1.0f : 1.0f};
        m.parted = source->surface->transmission;
        m.values = room->values + room->used[0], m.patch = room->patch + room->used[1];
        m.floats = smallest_of(floats, room->most[0] - room->used[0]) / (size_t)(sides - i);
        m.most =
            smallest_of(floats / ALBEDO_PATCH_FLOATS, room->most[1] - room->used[1]) / (size_t)(sides - i);
        const size_t so_far = source->effort->facets - before;
        mu_albedo_grow(&m, so_far < source->facets ? (source->facets - so_far) / (size_t)(sides - i) : 0);
        room->used[0] += m.nodes + side->cells, room->used[1] += side->patches;
        floats -= m.nodes + side->cells;
        side->passes = 0;
    }
    if (sides == 1) return;
    /* passes average is the same from both sides but for eta², or the surface were not reciprocal */
    const double eta2 = source->definition->dielectric * source->definition->dielectric,
                 above = (double)t->side[0].average, below = (double)t->side[1].average * eta2;
    const double passes = fmin((1 - mu_albedo_share_above(source, WALKS)) * above, fmin(above, below));
    t->side[0].passes = (float)(passes / above);
    t->side[1].passes = (float)(passes / below);
}

#endif
