/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* globe.c: see globe.h. Rows are along y, columns along x of the square. In float; compiled once. */
#include "core/ibl/globe.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

size_t mu_ibl_globe_floats(size_t levels, const size_t *sides) {
    size_t sum = 0;
    for (size_t l = 0; l < levels; l++) sum += 4 * (sides[l] + 2) * (sides[l] + 2);
    return sum;
}

void mu_ibl_globe_lay(mu_ibl_globe *globe, size_t levels, const size_t *sides, float *memory) {
    globe->levels = levels;
    for (size_t l = 0; l < levels; l++) {
        globe->level[l] = (mu_ibl_square){sides[l], memory};
        memory += 4 * (sides[l] + 2) * (sides[l] + 2);
    }
}

/* On the octahedron |x| + |y| + |z| = 1. */
static void unfold(float u, float v, float p[3]) {
    const float x = 2 * u - 1, y = 2 * v - 1, z = 1 - fabs(x) - fabs(y);
    p[0] = z >= 0 ? x : copysign(1 - fabs(y), x);
    p[1] = z >= 0 ? y : copysign(1 - fabs(x), y);
    p[2] = z;
}

void mu_ibl_globe_direction(float x, float y, float direction[3]) {
    float p[3];
    unfold(x, y, p);
    const float length = sqrt(dot(p, p));
    for (int k = 0; k < 3; k++) direction[k] = p[k] / length;
}

static void copy(const mu_ibl_square *s, size_t to_row, size_t to_column, size_t row, size_t column) {
    const size_t whole = s->side + 2;
    for (size_t k = 0; k < 4; k++)
        s->texels[4 * (to_row * whole + to_column) + k] = s->texels[4 * (row * whole + column) + k];
}

/* Across an edge lies the same edge, mirrored at its middle; across a corner the corner opposite. Counted with the border. */
void mu_ibl_globe_border(mu_ibl_square *s) {
    const size_t n = s->side, last = n + 1;
    for (size_t i = 1; i <= n; i++) {
        copy(s, 0, i, 1, last - i), copy(s, last, i, n, last - i);
        copy(s, i, 0, last - i, 1), copy(s, i, last, last - i, n);
    }
    copy(s, 0, 0, n, n), copy(s, 0, last, n, 1), copy(s, last, 0, 1, n), copy(s, last, last, 1, 1);
}

/* Solid angle of a texel, up to a factor: 1 / |p|³, for the octahedron's faces are equally far. */
static float weight_at(size_t side, size_t row, size_t column) {
    float p[3];
    unfold(((float)column + 0.5f) / (float)side, ((float)row + 0.5f) / (float)side, p);
    const float square = dot(p, p);
    return 1 / (square * sqrt(square));
}

void mu_ibl_globe_halve(const mu_ibl_square *from, mu_ibl_square *to) {
    for (size_t row = 0; row < to->side; row++)
        for (size_t column = 0; column < to->side; column++) {
            float sum[4] = {0, 0, 0, 0}, all = 0;
            for (size_t k = 0; k < 4; k++) {
                const size_t y = 2 * row + k / 2, x = 2 * column + k % 2;
                const float weight = weight_at(from->side, y, x), *texel = mu_ibl_texel(from, y, x);
                for (size_t c = 0; c < 4; c++) sum[c] += weight * texel[c];
                all += weight;
            }
            for (size_t c = 0; c < 4; c++) mu_ibl_texel(to, row, column)[c] = sum[c] / all;
        }
    mu_ibl_globe_border(to);
}

static inline void bilinear(const mu_ibl_square *s, float u, float v, float weight, float *restrict rgb) {
    const float x = u * (float)s->side + 0.5f, y = v * (float)s->side + 0.5f; /* counted with the border */
    const int column = (int)x, row = (int)y, whole = (int)s->side + 2;
    const float right = x - (float)column, down = y - (float)row;
    const float *restrict a = s->texels + 4 * (row * whole + column), *restrict b = a + 4 * whole;
    const float w00 = weight * (1 - down) * (1 - right), w01 = weight * (1 - down) * right,
                w10 = weight * down * (1 - right), w11 = weight * down * right;
    for (int k = 0; k < 4; k++) rgb[k] += w00 * a[k] + w01 * a[4 + k] + w10 * b[k] + w11 * b[4 + k];
}

/* Places in the square, 0 to 1. */
static inline void fold(float wx, float wy, float wz, float *u, float *v) {
    const float scale = 0.5f / (fabs(wx) + fabs(wy) + fabs(wz)), x = wx * scale, y = wy * scale;
    const float across = 0.5f - fabs(y), down = 0.5f - fabs(x);
    const float fx = x >= 0 ? across : -across, fy = y >= 0 ? down : -down; /* copysign would go one by one */
    *u = 0.5f + (wz >= 0 ? x : fx);
    *v = 0.5f + (wz >= 0 ? y : fy);
}

static inline void trilinear(const mu_ibl_globe *g, float u, float v, float level, float weight,
                             float *restrict rgb) {
    const int low = (int)level;
    const float share = low + 1 < (int)g->levels ? level - (float)low : 0;
    bilinear(&g->level[low], u, v, weight * (1 - share), rgb);
    if (share > 0) bilinear(&g->level[low + 1], u, v, weight * share, rgb);
}

void mu_ibl_globe_add(const mu_ibl_globe *g, const float w[3], float level, float weight, float rgb[4]) {
    float u, v, sum[4] = {rgb[0], rgb[1], rgb[2], rgb[3]}; /* nothing else can be meant: four at a time */
    fold(w[0], w[1], w[2], &u, &v);
    trilinear(g, u, v, level, weight, sum);
    for (int k = 0; k < 4; k++) rgb[k] = sum[k];
}

/* Below, one by one is faster. */
enum { SEVERAL = 4 };

/* Where reads look, each in its own square: its first texel, and weights of the four; worked out for several at a time. */
typedef struct spots {
    const float *texel[MU_IBL_BATCH];
    size_t row[MU_IBL_BATCH]; /* floats from one row to the next */
    float w[4][MU_IBL_BATCH];
} spots;

static inline void find_spots(size_t count, const mu_ibl_square *const *squares, const float *restrict u,
                              const float *restrict v, const float *restrict weight, spots *restrict s) {
    float side[MU_IBL_BATCH];
    int at[MU_IBL_BATCH];
    for (size_t i = 0; i < count; i++) side[i] = (float)squares[i]->side;
    for (size_t i = 0; i < count; i++) {
        const float x = u[i] * side[i] + 0.5f, y = v[i] * side[i] + 0.5f;
        const int column = (int)x, row = (int)y;
        const float right = x - (float)column, down = y - (float)row, lower = weight[i] * down,
                    upper = weight[i] - lower;
        at[i] = 4 * (row * ((int)side[i] + 2) + column);
        s->w[1][i] = upper * right, s->w[0][i] = upper - s->w[1][i];
        s->w[3][i] = lower * right, s->w[2][i] = lower - s->w[3][i];
    }
    for (size_t i = 0; i < count; i++) { /* most of a read's time is that of its texels to come */
        s->texel[i] = squares[i]->texels + at[i], s->row[i] = 4 * (squares[i]->side + 2);
        __builtin_prefetch(s->texel[i]);
        __builtin_prefetch(s->texel[i] + s->row[i]);
    }
}

static inline void sum_spots(size_t count, const spots *restrict s, float *restrict sum) {
    for (size_t i = 0; i < count; i++) {
        const float *restrict a = s->texel[i], *restrict b = a + s->row[i];
        for (int k = 0; k < 4; k++)
            sum[k] +=
                (s->w[0][i] * a[k] + s->w[1][i] * a[4 + k]) + (s->w[2][i] * b[k] + s->w[3][i] * b[4 + k]);
    }
}

static void sum_several(const mu_ibl_globe *g, const mu_ibl_batch *b, const float *u, const float *v,
                        float sum[4]) {
    const mu_ibl_square *squares[2][MU_IBL_BATCH];
    float near[MU_IBL_BATCH], far[MU_IBL_BATCH], farther = 0;
    spots s[2];
    const int last = (int)g->levels - 1;
    for (size_t i = 0; i < b->count; i++) {
        const int low = (int)b->level[i];
        squares[0][i] = &g->level[low], squares[1][i] = &g->level[low < last ? low + 1 : last];
        far[i] = b->weight[i] * (b->level[i] - (float)low), near[i] = b->weight[i] - far[i];
        farther += far[i];
    }
    find_spots(b->count, squares[0], u, v, near, &s[0]);
    if (farther > 0) find_spots(b->count, squares[1], u, v, far, &s[1]);
    sum_spots(b->count, &s[0], sum);
    if (farther > 0) sum_spots(b->count, &s[1], sum);
}

/* The same of one square for all, which is found sooner. Squares of the same side have the same. */
typedef struct places {
    int at[MU_IBL_BATCH];
    float w[4][MU_IBL_BATCH];
} places;

static inline void find_places(size_t count, float side, const float *restrict u, const float *restrict v,
                               const float *restrict weight, places *restrict p) {
    const int whole = 4 * ((int)side + 2);
    for (size_t i = 0; i < count; i++) {
        const float x = u[i] * side + 0.5f, y = v[i] * side + 0.5f;
        const int column = (int)x, row = (int)y;
        const float right = x - (float)column, down = y - (float)row, lower = weight[i] * down,
                    upper = weight[i] - lower;
        p->at[i] = row * whole + 4 * column;
        p->w[1][i] = upper * right, p->w[0][i] = upper - p->w[1][i];
        p->w[3][i] = lower * right, p->w[2][i] = lower - p->w[3][i];
    }
}

static inline void sum_places(size_t count, const mu_ibl_square *square, const places *restrict p,
                              float share, float *restrict sum) {
    const size_t row = 4 * (square->side + 2);
    float all[4] = {0, 0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const float *restrict a = square->texels + p->at[i], *restrict b = a + row;
        for (int k = 0; k < 4; k++)
            all[k] +=
                (p->w[0][i] * a[k] + p->w[1][i] * a[4 + k]) + (p->w[2][i] * b[k] + p->w[3][i] * b[4 + k]);
    }
    for (int k = 0; k < 4; k++) sum[k] += share * all[k];
}

/* All of one level. */
static void sum_alike(const mu_ibl_globe *g, const mu_ibl_batch *b, const float *u, const float *v,
                      float sum[4]) {
    const int low = (int)b->level[0];
    const float share = b->level[0] - (float)low;
    const mu_ibl_square *const near = &g->level[low], *const far = near + (low + 1 < (int)g->levels);
    places p;
    find_places(b->count, (float)near->side, u, v, b->weight, &p);
    sum_places(b->count, near, &p, 1 - share, sum);
    if (!(share > 0)) return;
    if (far->side != near->side) find_places(b->count, (float)far->side, u, v, b->weight, &p);
    sum_places(b->count, far, &p, share, sum);
}

static inline int alike(const mu_ibl_batch *b) {
    int others = 0;
    for (size_t i = 0; i < b->count; i++) others |= b->level[i] != b->level[0];
    return !others;
}

void mu_ibl_globe_sum(const mu_ibl_globe *g, const mu_ibl_batch *b, float rgb[4]) {
    float u[MU_IBL_BATCH], v[MU_IBL_BATCH], sum[4] = {rgb[0], rgb[1], rgb[2], rgb[3]};
    for (size_t i = 0; i < b->count; i++) fold(b->x[i], b->y[i], b->z[i], &u[i], &v[i]);
    if (b->count < SEVERAL)
        for (size_t i = 0; i < b->count; i++) trilinear(g, u[i], v[i], b->level[i], b->weight[i], sum);
    else if (alike(b))
        sum_alike(g, b, u, v, sum);
    else
        sum_several(g, b, u, v, sum);
    for (int k = 0; k < 4; k++) rgb[k] = sum[k];
}

void mu_ibl_globe_filter_row(const mu_ibl_globe *from, size_t taps, const mu_ibl_tap *tap, size_t row,
                             mu_ibl_square *to) {
    for (size_t column = 0; column < to->side; column++) {
        float n[3], sum[4] = {0, 0, 0, 0};
        mu_ibl_globe_direction(((float)column + 0.5f) / (float)to->side,
                               ((float)row + 0.5f) / (float)to->side, n);
        /* down the meridian and east; at the poles any */
        const float flat = hypot(n[0], n[1]);
        const float east[2] = {flat > 0 ? -n[1] / flat : 0, flat > 0 ? n[0] / flat : 1};
        const float down[3] = {n[2] * east[1], -n[2] * east[0], -flat};
        for (size_t first = 0; first < taps; first += MU_IBL_BATCH) {
            mu_ibl_batch b;
            b.count = taps - first < MU_IBL_BATCH ? taps - first : MU_IBL_BATCH;
            for (size_t i = 0; i < b.count; i++) {
                const float *l = tap[first + i].local;
                b.x[i] = l[0] * down[0] + l[1] * east[0] + l[2] * n[0], b.y[i] = l[0] * down[1] + l[1] * east[1] + l[2] * n[1];
                b.z[i] = l[0] * down[2] + l[2] * n[2], b.level[i] = tap[first + i].level, b.weight[i] = tap[first + i].weight;
            }
            mu_ibl_globe_sum(from, &b, sum);
        }
        for (int k = 0; k < 4; k++) mu_ibl_texel(to, row, column)[k] = sum[k];
    }
}

#endif
