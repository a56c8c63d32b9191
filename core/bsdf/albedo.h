/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.h: tables of what single scattering loses, 1 - E(w), E the directional albedo for F = 1 (or of both sides of a
 * surface that transmits): made when a surface is, by albedo.c; float whatever the precision of shading.
 *
 * E of a transformed microsurface is smooth in the slopes' own units, which is where tables are laid: with V = s M^-1, s the
 * slope unit, L is V without the rotation that comes last, its singular values A >= B made a, b, at most 1 (of what is rougher
 * than 1 along an axis: such a surface changes at every angle). With (x, y) = L w.xy and r its length,
 *     S = 1 - (1 - (r / (r + w.z))²)^(1/2^n),     u = ln((X + Y) / (X + Y B/A)) / ln(A/B),   X = |x|/a, Y = |y|/b,
 * and the quadrant of (x, y). S is 1/4 (n = 0) where a direction is as far from the horizon as the slopes are, equal in area
 * around the normal, and 1 at the horizon, where E of a rough surface turns to 1 over decades of w.z: n = 0, 1, 2 the rougher
 * it is. u is a logarithm between the azimuths of the world, Y/X about 1, and those of the microsurface before M, about A/B,
 * and linear beyond either: E may turn with both, and with any in between. Solid angle by
 *     du dS = 2^(1-n) (1 - S)^(1-2^n) (1 - B/A) r² / (ln(A/B) (X + Y) (X + Y B/A) (r + w.z)³) dw.
 * What glass lets through depends on angles in the world, too, however smooth or steep its slopes are. Where E asks for it,
 * S is a logarithm as u is, of tau = tan of the angle to the normal, linear below 1/P and beyond 1/p, P = max(A, 1), p = min(B, 1):
 *     S = ln((1 + P tau) / (1 + p tau)) / ln(P/p),   du dS = (P - p) (1 + tau²)^1.5 / ((1 + P tau) (1 + p tau) ln(P/p) tau) du/dpsi dw,
 * psi the azimuth. Where slopes along x are steep and those along y small, facets face x alone, and from the denser side total
 * reflection begins where the cosine to that is c: E jumps there, beside a root, or a layer. Then u is folded to be 1/2 there, and beside that a root of what it was.
 * Where the microsurface is not even (tilted, say), E turns by azimuth at the normal itself, and where tails are heavy (slopes
 * of no variance) E has a tip there, r^(2 gamma - 2) of std and gtr: sqrt(S) takes the place of S in interpolation; cells are drawn from uniformly in S nevertheless.
 * Where cells do not come near enough (E of tilted glass jumps along curves) a patch stays open: E is integrated there while
 * shading (albedo_open.c), and its values serve to draw directions.
 * The square [0, 1]² is cut into patches, each of them into halves and they into others where E asks for it, and the last into cells:
 * halved along either axis until what is interpolated is as near as wanted, by bilinear interpolation. A microsurface that is level, and isotropic
 * before M, has four equal quadrants, of which one is kept; one that M leaves isotropic knows no u, which is the azimuth then.
 */
#ifndef MU_ALBEDO_H
#define MU_ALBEDO_H

#include <math.h>
#include <stddef.h>

#include "core/bsdf/albedo_lengths.h"

/* Root patches along S, and along u at most; halvings of one at most. */
enum {
    ALBEDO_ROWS = 4,
    ALBEDO_COLUMNS = 2,
    ALBEDO_ROOTS = 4 * ALBEDO_ROWS * ALBEDO_COLUMNS,
    ALBEDO_HALVINGS = 16,
    ALBEDO_PATCH_FLOATS = 16 /* of values to a patch, or there is no room for it */
};

typedef struct albedo_patch {
    uint32_t node, cell; /* its first */
    uint32_t child;      /* the first of two patches that it is halved to; else 0 */
    uint8_t log_u, log_s, axis;
    uint8_t open; /* its values are not near enough */
} albedo_patch;

typedef struct mu_albedo_side {
    const float *lost;       /* 1 - E, above 0, patch by patch, u by u */
    const float *cumulative; /* of the lobe (1 - E) cos, by cells */
    const albedo_patch *patch;
    uint32_t patches, cells;
    float average; /* of what is interpolated: 1/pi times the integral of (1 - E) cos */
    float passes;  /* of light that is scattered on: the share that leaves on the other side */
    int roots;     /* n */
    int rooted;    /* sqrt(S) takes the place of S */
    int worldly;   /* S is a logarithm of tau */
    float fold;    /* c, where u is folded; else 0 */
    float open;    /* share of the open patches in the average of cos */
    float unsure;  /* the most that a value was off, of what is not open; or 0 */
} mu_albedo_side;

typedef struct mu_albedo {
    mu_albedo_frame frame;  /* of the M that it was made for */
    int quadrants, columns; /* 1 or 4; 1 or ALBEDO_COLUMNS */
    mu_albedo_side side[2]; /* above; below too if the surface transmits */
} mu_albedo;

/* The frame of V = s M^-1; returns A. */
float mu_albedo_lay(const double v[4], mu_albedo_frame *out);
/* Of a table made where directions are R(-turn) times those of the frame that it is to have. */
void mu_albedo_turn(mu_albedo_frame *f, double turn);

/* A direction's place: patch, and in it u and S from 0 to 1; and du dS / dw there. Of which the patch is a part: halvings along
 * u and S, and the row that it is of all 4 2^log_s. */
typedef struct albedo_place {
    int patch;
    float u, s, stretch;
    int log_u, log_s, row;
} albedo_place;

static inline float albedo_row(const mu_albedo_side *side, float s) {
    return side->rooted ? sqrtf(s) : s;
}
/* And back. */
static inline double albedo_s(const mu_albedo_side *side, double row) {
    return side->rooted ? row * row : row;
}

/* u at which a tau is folded: above 0, lest a half be empty. */
static inline float albedo_fold(const mu_albedo *t, const mu_albedo_side *side, float tau) {
    const float cosine2 = side->fold * side->fold * (1 + 1 / (tau * tau));
    if (!(cosine2 < 1)) return 1e-6f;
    const float y = sqrtf((1 - cosine2) / cosine2);
    return fmaxf(log1pf((1 - t->frame.ratio) * y / (1 + t->frame.ratio * y)) / t->frame.log, 1e-6f);
}

/* The root patch. */
static inline albedo_place albedo_root(const mu_albedo *t, const mu_albedo_side *side,
                                       const mu_albedo_frame *f, const float w[3]) {
    const float x = f->to[0] * w[0] + f->to[1] * w[1], y = f->to[2] * w[0] + f->to[3] * w[1];
    const float r2 = x * x + y * y, r = sqrtf(r2), n = r + w[2], flat = t->frame.ratio;
    const float X = r > 0 ? t->frame.k * fabsf(x) : t->frame.k, Y = r > 0 ? fabsf(y) : t->frame.k,
                both = X + Y, least = X + flat * Y;
    const int round = t->columns == 1;
    const float u = round ? 0.5f : fminf(log1pf((1 - flat) * Y / least) / t->frame.log, 1);
    const float around = round ? 0.63661977f * f->det
                               : (r > 0 ? r2 : 1 + t->frame.k * t->frame.k) / both / (t->frame.log * least) *
                                     (t->frame.k * f->det * (1 - flat)); /* det r2 alone may underflow */
    const int quadrant = t->quadrants == 1 ? 0 : (x < 0) + 2 * (y < 0);
    float up, rest, column = u, stretch, part = 1; /* up: S before roots, and rest what it leaves to 1 */
    if (side->worldly) {
        const float steep = t->frame.steep, smooth = t->frame.smooth, all = steep - smooth,
                    tau = fmaxf(sqrtf(w[0] * w[0] + w[1] * w[1]), 1e-12f) / fmaxf(w[2], 1e-20f),
                    above = 1 + steep * tau, below = 1 + smooth * tau, secant = sqrtf(1 + tau * tau);
        up = fminf(log1pf(all * tau / below) / t->frame.span, 1);
        rest = log1pf(all / (smooth * above)) / t->frame.span;
        stretch = r > 0 ? (1 - flat) * (X * X + Y * Y) / (t->frame.log * both * least) : 1;
        if (side->fold > 0) {
            const float fold = albedo_fold(t, side, tau), width = u < fold ? fold : 1 - fold,
                        beside = sqrtf(fmaxf(fabsf(u - fold) / width, 1e-12f));
            column = u < fold ? (1 - beside) / 2 : (1 + beside) / 2;
            stretch /= 4 * width * beside;
        }
        stretch *= all / (above * below * t->frame.span) * secant / tau * secant * secant;
    } else {
        rest = w[2] * (n + r) / (n * n), up = r / n * (r / n);
        stretch = 2 * around / (n * n * n);
    }
    const float whole = rest;
    for (int k = 0; k < side->roots; k++) rest = sqrtf(rest), part /= 2, up /= 1 + rest;
    stretch *= part * (whole > 0 ? rest / whole : 1e30f);
    const float row = albedo_row(side, up) * ALBEDO_ROWS;
    column *= (float)t->columns;
    const int i = (int)fminf(row, ALBEDO_ROWS - 1), j = (int)fminf(column, (float)t->columns - 1);
    return (albedo_place){.patch = (quadrant * t->columns + j) * ALBEDO_ROWS + i,
                          .u = column - (float)j,
                          .s = row - (float)i,
                          .stretch = stretch,
                          .row = i};
}

static inline albedo_place albedo_locate(const mu_albedo *t, const mu_albedo_side *side,
                                         const mu_albedo_frame *f, const float w[3]) {
    albedo_place at = albedo_root(t, side, f, w);
    for (const albedo_patch *p = &side->patch[at.patch]; p->child; p = &side->patch[at.patch]) {
        float *const x = p->axis ? &at.s : &at.u;
        const int second = *x >= 0.5f;
        *x = 2 * *x - (float)second, at.patch = (int)p->child + second;
        if (p->axis)
            at.row = 2 * at.row + second, at.log_s++;
        else
            at.log_u++;
    }
    return at;
}

static inline int albedo_cell(float *x, int log) {
    const int n = 1 << log, i = (int)(*x *= (float)n), cell = i < n ? i : n - 1;
    *x -= (float)cell;
    return cell;
}

static inline float albedo_lost(const mu_albedo_side *side, albedo_place at) {
    const albedo_patch *p = &side->patch[at.patch];
    float x = at.u, y = at.s;
    const int j = albedo_cell(&x, p->log_u), i = albedo_cell(&y, p->log_s), next = (1 << p->log_s) + 1;
    const float *v = side->lost + p->node + j * next + i;
    const float low = v[0] + y * (v[1] - v[0]), high = v[next] + y * (v[next + 1] - v[next]);
    return low + x * (high - low);
}

/* The density of mu_albedo_draw, 1/sr. */
static inline float albedo_density(const mu_albedo *t, const mu_albedo_side *side, albedo_place at) {
    const albedo_patch *p = &side->patch[at.patch];
    float x = at.u, y = at.s;
    const int j = albedo_cell(&x, p->log_u), i = albedo_cell(&y, p->log_s),
              cell = (int)p->cell + (j << p->log_s) + i;
    const float share = side->cumulative[cell] - (cell ? side->cumulative[cell - 1] : 0);
    const float rows = (float)(ALBEDO_ROWS << (at.log_s + p->log_s)), row = (float)((at.row << p->log_s) + i);
    const float over_height =
        (side->rooted ? rows * rows / (2 * row + 1) : rows) / (t->quadrants == 1 ? 4 : 1);
    return fminf(share * (float)(t->columns << (at.log_u + p->log_u)) * over_height * at.stretch, 0x1p+126f);
}

/* The direction at u and S of a quadrant. */
void mu_albedo_direction(const mu_albedo *t, const mu_albedo_side *side, const mu_albedo_frame *f,
                         int quadrant, float u, float s, float w[3]);
/* A direction of the lobe. */
void mu_albedo_draw(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side, float u0,
                    float u1, float w[3]);
/* The average over another frame. */
double mu_albedo_average(const mu_albedo *t, const mu_albedo_frame *f, const mu_albedo_side *side);

/* What quadratures came to: facets that were asked, and by how much the worst of them missed what was allowed. */
typedef struct albedo_effort {
    size_t facets;
    double off;
} albedo_effort;

/* What tables are made of: a surface that scatters singly, at an M of its own or another, blurred or not. */
typedef struct albedo_source {
    const mu_surface_f *surface;
    const mu_definition *definition;
    const float *transform; /* NULL: the surface's */
    float blur;
    double error;                      /* that E may have */
    double allowed;                    /* of that, to the quadrature */
    int halvings;                      /* of a patch along an axis, at most ALBEDO_HALVINGS */
    const mu_albedo *like;             /* whose n and sqrt it takes; NULL: chosen */
    int trusting;                      /* not every cell is tested */
    int opens;                         /* patches may stay open */
    const struct albedo_slope *slopes; /* of a histogram */
    int begin, stride;                 /* and which of them, if not all: every so manieth */
    const albedo_lengths *lengths[2];  /* of slopes: of its distribution; of what is blurred, GGX */
    albedo_effort *effort;             /* so far */
    size_t facets;                     /* that refining a table may take, of that */
} albedo_source;
/* Where tables put their values, and their patches: so many of both, and so many taken. */
typedef struct albedo_room {
    float *values;
    albedo_patch *patch;
    size_t most[2], used[2];
} albedo_room;
/* Makes a table in `floats` values at most, and in what room there is. */
void mu_albedo_make(const albedo_source *source, mu_albedo *out, albedo_room *room, size_t floats);
/* The lengths of the slopes of what the source makes of a surface, blurred or not. */
void mu_albedo_measure(const albedo_source *source, albedo_lengths *out);
/* 1 - E of a closure of the source, to within a quarter of the source's error, or 1e-3. */
float mu_albedo_lost(const albedo_source *source, const mu_closure_f *c);

/* E(wo) of a closure of single scattering, by wedges of azimuth that are halved until they agree to within `allowed`
 * (albedo_quadrature.c), `lengths` those of its distribution; `effort` may be NULL, and is added to. */
float albedo_integral_f(const mu_closure_f *c, const albedo_lengths *lengths, double allowed,
                        albedo_effort *effort);
/* F G2 of what a facet reflects and (1 - F) G2 of what it refracts; its unit normal, and the cosine that it faces wo by. */
double albedo_passed_f(const mu_closure_f *c, const double unit[3], double facing);

/* E(wo) of a histogram: slopes in slope units, and their weights, made once for all views (albedo_histogram.c). */
enum { ALBEDO_SLOPES = 1 << 11 };
typedef struct albedo_slope {
    double p[2], weight;
} albedo_slope;
void mu_albedo_slopes(const mu_surface_f *s, albedo_slope out[ALBEDO_SLOPES]);
float mu_albedo_of_slopes(const mu_closure_f *c, const albedo_slope slopes[ALBEDO_SLOPES], int begin,
                          int stride, albedo_effort *effort);

#endif
