/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_table.c: nodes by even_light.c, where albedo_place.h has them.
 *
 * A material that is the same mirrored at the lobe's axes, which is tried out, is asked for a quarter turn; a
 * tilt and a histogram are not: more nodes, and creases where what masks the view begins. So each node is told from others twice as far
 * apart: of a smooth table that is off by 16 times what lies between nodes is, at a crease twice. Where it is off by more than TOLD the
 * middle of the cells around is asked, and those that are off by more than NEAR are no part of the table; where by more than CREASED, none
 * of them are: the middle may be near by chance.
 */
#include "core/render/albedo_place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ibl/even.h"
#include "core/render/albedo_source.h"
#include "core/render/surface_rows.h"

/* Ratio of neighbouring sigmas, in ln; and the most nodes for it. */
#define SIGMA_STEP 0.25f
enum { SIGMAS_MOST = 16 };
/* What a node may be off, of a table over sigmas twice that; calls of a material for all nodes, and of one at least, or half of that. */
#define ENOUGH 1e-4
enum { CALLS = 1 << 24, LEAST_CALLS = 1 << 12 };
/* As above. */
#define TOLD 6e-4f
#define NEAR 4e-4f
#define CREASED 3e-3f
/* Of what is mirrored, which has no creases, no cell is dropped for what its nodes tell, and none that is near enough still: it is
 * integrated for every hit. Nor of walks, whose hits take ten times as long, and whose nodes and middles have standard errors of 2.5e-4 each. */
#define NEAR_STILL 8e-4f
typedef struct work {
    const mu_albedo_table *table;
    const mu_material *material;
    const musurf_map *map;
    const musurf_slopes *slopes;
    const musurf_moments *still;
    double root[3]; /* of the moments before M: lower triangle; 0: a mirror, which no M makes rough */
    const mu_ibl_lobe_f *lobe;
    double enough; /* that a node may be off */
    size_t most;   /* calls of a node */
    _Bool drawn; /* f is noise: its own samples, or what knows better, do better than directions */
} work;

/* The M that makes the slopes' standard deviations `sigma` along x and y: M = diag(1 / sigma) R root^T, since then M^-T root root^T
 * M^-1 is diag(sigma²) whatever turn R is; and the lobe under it. What is radially symmetric before M is the same under all R. */
static void node_map(const work *w, const float sigma[2], double turn, float m[4], mu_ibl_lobe_d *lobe) {
    const double c = cos(turn), s = sin(turn), *r = w->root, *mean = w->still->mean;
    const double rows[4] = {c * r[0], c * r[1] - s * r[2], s * r[0], s * r[1] + c * r[2]};
    for (int k = 0; k < 4; k++) m[k] = (float)(r[0] > 0 ? rows[k] / (double)sigma[k / 2] : k % 3 == 0);
    const double det = (double)m[0] * (double)m[3] - (double)m[1] * (double)m[2];
    *lobe = (mu_ibl_lobe_d){.sigma = {(double)sigma[0], (double)sigma[1]}, .turn = {1, 0}};
    lobe->mean[0] = ((double)m[3] * mean[0] - (double)m[2] * mean[1]) / det;
    lobe->mean[1] = ((double)m[0] * mean[1] - (double)m[1] * mean[0]) / det;
}

/* A closure under the M of two sigmas, and what is asked of it. */
typedef struct seat {
    float sigma[2], m[4];
    mu_ibl_lobe_d lobe;
    mu_albedo_bound bound;
    mu_even_source source;
} seat;

static void seat_free(seat *s) {
    free(s->bound.closure);
}

static _Bool seat_make(const work *w, uint32_t first, uint32_t second, double turn, seat *s) {
    const mu_albedo_table *t = w->table;
    const mu_ibl_lobe_f *of = w->lobe;
    *s = (seat){.sigma = {of->sigma[0], of->sigma[1]}, .m = {1, 0, 0, 1}, .bound = {w->material->type, NULL, w->slopes}};
    s->lobe = (mu_ibl_lobe_d){.sigma = {(double)of->sigma[0], (double)of->sigma[1]},
                              .turn = {(double)of->turn[0], (double)of->turn[1]},
                              .mean = {(double)of->mean[0], (double)of->mean[1]}};
    if (w->map) {
        if (t->sigmas[0] > 1) s->sigma[0] = expf(t->least[0] + (float)first * t->step[0]);
        if (t->sigmas[1] > 1) s->sigma[1] = expf(t->least[1] + (float)second * t->step[1]);
        node_map(w, s->sigma, turn, s->m, &s->lobe);
    }
    s->bound.closure = aligned_alloc(64, (w->material->plan.closure_bytes + 63u) / 64 * 64);
    if (!s->bound.closure) return 0;
    s->source = mu_albedo_source(&s->bound, &s->lobe);
    if (w->material->plan.lobes & MUSURF_DELTA_LOBES || !(s->sigma[1] > 0)) s->source.lobe = NULL;
    return 1;
}

/* Seen from v, of the lobe's axes: wo; false: black. */
static _Bool seat_look(const work *w, const seat *s, const float v[3], double wo[3]) {
    const double *turn = s->lobe.turn, x = (double)v[0], y = (double)v[1];
    wo[0] = turn[0] * x - turn[1] * y, wo[1] = turn[1] * x + turn[0] * y, wo[2] = (double)v[2];
    const float seen[3] = {(float)wo[0], (float)wo[1], v[2]};
    return (w->map ? w->map->setup(w->material->compiled, seen, s->m, NULL, 0, s->bound.closure)
                   : w->material->type->setup(w->material->compiled, seen, NULL, 0, s->bound.closure)) != 0;
}

/* [any] All heights of an azimuth and two sigmas. */
static void fill(void *context, uint32_t row) {
    const work *w = context;
    const mu_albedo_table *t = w->table;
    const uint32_t azimuth = row % t->rows, second = row / t->rows % t->sigmas[1], first = row / t->rows / t->sigmas[1];
    float *rgb = t->rgb + (size_t)3 * row * t->heights;
    seat s;
    const _Bool made = seat_make(w, first, second, 0, &s);
    const mu_even_effort effort = {w->enough, w->most};
    if (w->drawn) s.source.lobe = NULL;
    for (uint32_t i = 0; i < t->heights; i++, rgb += 3) {
        float v[3];
        double wo[3];
        rgb[0] = rgb[1] = rgb[2] = made ? 0 : NAN;
        if (!made) continue;
        mu_albedo_view_of(s.sigma, (mu_albedo_place){(float)i / (float)(t->heights - 1), (float)azimuth / (float)t->azimuths}, v);
        if (!seat_look(w, &s, v, wo)) continue;
        const mu_even_mean mean = mu_even_light(&s.source, wo, &effort);
        for (int c = 0; c < 3; c++) rgb[c] = (float)mean.rgb[c];
    }
    if (made) seat_free(&s);
}

/* f of a view and a direction of light, both mirrored at U (1), at V (2) or both (3), of the lobe's axes; where f is noise, the pdf. */
static double mirrored(const work *w, const seat *s, const float v[3], const float l[3], int at) {
    double wo[3];
    const float turn[2] = {(float)s->lobe.turn[0], (float)s->lobe.turn[1]}, x = at & 2 ? -l[0] : l[0], y = at & 1 ? -l[1] : l[1];
    if (!seat_look(w, s, (const float[3]){at & 2 ? -v[0] : v[0], at & 1 ? -v[1] : v[1], v[2]}, wo)) return 0;
    musurf_value value;
    w->material->type->eval(s->bound.closure, (const float[3]){turn[0] * x - turn[1] * y, turn[1] * x + turn[0] * y, l[2]}, MUSURF_ALL_LOBES, &value);
    if (!value.lobes) return 0;
    return w->drawn ? 3 * (double)value.pdf : (double)value.f[0] + (double)value.f[1] + (double)value.f[2];
}

static void place_sigmas(mu_albedo_table *t, const mu_ibl_lobe_f *low, const mu_ibl_lobe_f *high) {
    for (int k = 0; k < 2; k++) {
        const float range = logf(high->sigma[k] / low->sigma[k]);
        t->least[k] = logf(low->sigma[k]);
        if (!(range > 1e-4f)) {
            t->least[k] += range / 2;
            continue;
        }
        const float wanted = fmaxf(ceilf(range / SIGMA_STEP) + 1, 4);
        t->sigmas[k] = wanted < SIGMAS_MOST ? (uint32_t)wanted : SIGMAS_MOST;
        t->step[k] = range / (float)(t->sigmas[k] - 1);
    }
}

/* Do mirrors at the lobe's axes leave the albedo as it is, to EVEN, under a turn before M, too, where M varies? Few directions tell: they
 * are mirrored, too, so that what their sums are off cancels. Of an alpha of some 1e-3 float's rounding of f may be taken for a difference, which costs no more than time. */
#define EVEN 3e-4
static _Bool is_even(const work *w) {
    enum { VIEWS = 4, LIGHTS = 34 };
    const mu_ibl_fibonacci lattice = mu_ibl_fibonacci_below(LIGHTS);
    seat s;
    if (!seat_make(w, 0, 0, 0.5, &s)) return 0;
    _Bool even = s.source.lobe;
    for (int i = 0; even && i < VIEWS; i++) {
        float v[3];
        double wo[3], off[4] = {0, 0, 0, 0};
        mu_albedo_view_of(s.sigma, (mu_albedo_place){(float)(i + 1) / (VIEWS + 1), 0.07f + (float)i * 0.3f}, v);
        if (!seat_look(w, &s, v, wo)) continue;
        mu_ibl_even directions;
        mu_ibl_even_make(&s.lobe, wo, &directions);
        for (uint32_t j = 0; j < LIGHTS; j++) {
            double u[2], wi[3];
            mu_ibl_fibonacci_at(lattice, (const double[2]){0, 0}, j, u);
            const double weight = mu_ibl_even_direction(&directions, u, wi) / LIGHTS, *turn = s.lobe.turn;
            if (!(weight > 0)) continue;
            const float l[3] = {(float)(turn[0] * wi[0] + turn[1] * wi[1]), (float)(turn[0] * wi[1] - turn[1] * wi[0]), (float)wi[2]};
            const double f = mirrored(w, &s, v, l, 0);
            for (int at = 1; at < 4; at++) off[at] += weight * (mirrored(w, &s, v, l, at) - f);
        }
        for (int at = 1; at < 4; at++) even = even && fabs(off[at]) <= 3 * EVEN; /* r, g and b */
    }
    seat_free(&s);
    return even;
}

/* Is f noise, as a random walk's, so that samples are to be asked? Then it is not in between two directions what it is at these. */
static _Bool is_drawn(const work *w) {
    enum { PAIRS = 34 };
    seat s;
    float v[3];
    double wo[3];
    int unlike = 0;
    if (!seat_make(w, 0, 0, 0, &s)) return 0;
    mu_albedo_view_of(s.sigma, (mu_albedo_place){0.6f, 0.1f}, v);
    if (s.source.lobe && seat_look(w, &s, v, wo)) {
        mu_ibl_even directions;
        mu_ibl_even_make(&s.lobe, wo, &directions);
        for (uint32_t i = 0; i < PAIRS; i++) {
            double u[2], wi[3], f[3][EVEN_PARTS] = {{0}};
            mu_ibl_fibonacci_at(mu_ibl_fibonacci_below(PAIRS), (const double[2]){0, 0}, i, u);
            for (int k = 0; k < 3; k++, u[0] *= 0.999)
                if (mu_ibl_even_direction(&directions, u, wi) > 0) s.source.toward(s.source.context, wi, f[k]);
            unlike += fabs((f[0][0] + f[2][0]) / 2 - f[1][0]) > 2e-3 * f[1][0];
        }
    }
    seat_free(&s);
    return unlike > PAIRS / 4;
}

/* Does what is noise know its albedo itself? */
static _Bool is_told(const work *w) {
    seat s;
    double wo[3], rgb[3];
    if (!seat_make(w, 0, 0, 0, &s)) return 0;
    const _Bool told = s.source.known && seat_look(w, &s, (const float[3]){0, 0, 1}, wo) && s.source.known(s.source.context, 1, rgb);
    seat_free(&s);
    return told;
}

/* By how much the middle of four values twice as far apart misses the one that is there; and so beside their first. */
static float missed(const float *v, ptrdiff_t step, const float at[4]) {
    float worst = 0;
    for (int c = 0; c < 3; c++) {
        float told = 0;
        for (int k = 0; k < 4; k++) told += at[k] * v[(2 * k - 3) * step + c];
        worst = fmaxf(worst, fabsf(told - v[c]));
    }
    return worst;
}

/* What a node is off from what the others say, along both axes; the outermost along views, around. */
static float told_off(const mu_albedo_table *t, uint32_t azimuth, uint32_t height) {
    static const float middle[4] = {-1.0f / 16, 9.0f / 16, 9.0f / 16, -1.0f / 16};
    float row[7 * 3];
    for (uint32_t k = 0; k < 7; k++)
        memcpy(row + 3 * k, t->rgb + (size_t)3 * (mu_albedo_row_of(t, azimuth + 3 * t->azimuths + k - 3) * t->heights + height), 3 * sizeof *row);
    const float off = missed(row + 9, 3, middle);
    if (height < 3 || height + 3 >= t->heights) return off;
    return off + missed(t->rgb + (size_t)3 * (mu_albedo_row_of(t, azimuth) * t->heights + height), 3, middle);
}

/* By how much the table misses what is at a place. */
static float distance_at(const work *w, const seat *s, mu_albedo_place at) {
    const mu_even_effort effort = {w->enough, w->most};
    float v[3], rgb[3], worst = 0;
    double wo[3];
    mu_albedo_view_of(s->sigma, at, v);
    if (!seat_look(w, s, v, wo)) return 0;
    (void)mu_albedo_interpolate(w->table, w->lobe, (const float[3]){(float)wo[0], (float)wo[1], (float)wo[2]}, rgb);
    const mu_even_mean mean = mu_even_light(&s->source, wo, &effort);
    for (int c = 0; c < 3; c++) worst = fmaxf(worst, fabsf((float)mean.rgb[c] - rgb[c]));
    return worst;
}

/* [any] The cells of an azimuth that are no part of the table. */
static void mark(void *context, uint32_t azimuth) {
    static const float places[3][2] = {{0.5f, 0.5f}, {0.2f, 0.25f}, {0.8f, 0.75f}};
    const work *w = context;
    const mu_albedo_table *t = w->table;
    const _Bool level = t->azimuths == 1 || t->rows < t->azimuths;
    unsigned char *sharp = t->sharp + (size_t)azimuth * (t->heights - 1);
    seat s;
    if (!seat_make(w, 0, 0, 0, &s)) {
        memset(sharp, 1, t->heights - 1);
        return;
    }
    for (uint32_t i = 0; i + 1 < t->heights; i++) {
        const _Bool outermost = i < 3 || i + 4 >= t->heights; /* of nodes that are not told along views */
        float off = 0;
        for (uint32_t k = 0; k < 4; k++) off = fmaxf(off, told_off(t, azimuth + k / 2, i + k % 2));
        sharp[i] = !level && off > CREASED;
        for (int k = 0; !sharp[i] && k < (outermost || off > CREASED ? 3 : off > TOLD); k++)
            sharp[i] = distance_at(w, &s, (mu_albedo_place){((float)i + places[k][0]) / (float)(t->heights - 1),
                                                            ((float)azimuth + places[k][1]) / (float)t->azimuths}) > (level || w->drawn ? NEAR_STILL : NEAR);
    }
    seat_free(&s);
}

_Bool mu_albedo_table_make(mu_albedo_table *t, const mu_material *material, const musurf_map *map,
                           const musurf_moments *still, const mu_ibl_lobe_f *low, const mu_ibl_lobe_f *high,
                           uint64_t hits, uint32_t threads, mu_error *error) {
    *t = (mu_albedo_table){.heights = 96, .azimuths = 1, .rows = 1, .sigmas = {1, 1}};
    work w = {.table = t, .material = material, .map = map, .still = still, .lobe = low};
    w.slopes = material->type->extension ? material->type->extension(MUSURF_SLOPES_ID) : NULL;
    if (map && low->sigma[1] > 0) { /* else there is no M that makes it of a mirror: the identity stands for all */
        w.root[0] = sqrt(still->xx), w.root[1] = still->xx > 0 ? still->xy / w.root[0] : 0;
        w.root[2] = sqrt(fmax(still->yy - w.root[1] * w.root[1], 0));
        place_sigmas(t, low, high);
    }
    const _Bool varies = t->sigmas[0] * t->sigmas[1] > 1;
    w.enough = varies ? 2 * ENOUGH : ENOUGH;
    w.drawn = is_drawn(&w);
    const _Bool blind = w.drawn && !is_told(&w); /* samples are all that there is */
    const _Bool rough = low->sigma[1] > 0 && !(material->plan.lobes & MUSURF_DELTA_LOBES);
    t->drawn = blind;
    _Bool even = 1;
    if (varies) t->heights = 32;
    if (map || material->plan.needs & MUSURF_NEEDS_TANGENT) {
        even = is_even(&w);
        if (map && rough && !even) return 1;
        t->azimuths = varies ? 64 : !w.drawn ? 128 : even ? 64 : 48; /* of what takes many calls, and is smoother, fewer */
        if (!even || (w.drawn && !varies)) t->heights = w.drawn ? 48 : 64;
        t->rows = even ? t->azimuths / 4 + 1 : t->azimuths;
    }
    const size_t nodes = (size_t)t->sigmas[0] * t->sigmas[1] * t->rows * t->heights;
    if (rough && !blind && hits < nodes) return 1; /* a hit is integrated as soon as a node */
    const size_t least = varies ? LEAST_CALLS / 2 : LEAST_CALLS;
    w.most = CALLS / nodes > least ? CALLS / nodes : least;
    t->rgb = malloc(mu_albedo_table_bytes(t));
    if (!t->rgb) return mu_fail(error, "not enough memory for a table of albedos");
    mu_rows(t->sigmas[0] * t->sigmas[1] * t->rows, threads, fill, &w);
    for (size_t i = 0; i < mu_albedo_table_bytes(t) / sizeof(float); i++)
        if (!isfinite(t->rgb[i])) return mu_fail(error, "a table of albedos could not be made");
    if (varies || blind) return 1;
    unsigned char *sharp = calloc((size_t)mu_albedo_intervals(t) * (t->heights - 1), 1);
    if (!sharp) return mu_fail(error, "not enough memory for a table of albedos");
    t->sharp = sharp;
    mu_rows(mu_albedo_intervals(t), threads, mark, &w);
    return 1;
}

void mu_albedo_table_free(mu_albedo_table *t) {
    free(t->rgb);
    free(t->sharp);
    t->rgb = NULL, t->sharp = NULL;
}

size_t mu_albedo_table_bytes(const mu_albedo_table *t) {
    return 3 * sizeof(float) * t->heights * t->rows * t->sigmas[0] * t->sigmas[1];
}
