/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_grid.c: tables for an M of the point, of a microsurface that is level, and isotropic before M: what it loses depends on
 * the two slope roughnesses that M makes of it, the singular values A >= B of s M^-1 (s the slope unit), and on the axes.
 *
 * A table for each pair of nodes of both; between them the mean of three, by triangles with an edge along A = B, linear in
 * log2 A and log2 B, at the place that a direction has in the frame of the very M (albedo_set.h). Nodes are dense where slopes
 * are about 1, far apart below, where what is lost at such a place changes by O(A²), and the first table stands for all that is smoother.
 * ln of averages is quadratic on each triangle. What triangles leave is measured where they are largest, at the middle of the long
 * edge (gap_of): where it is too much, and beyond the last node, where tables would have to be many, none is chosen. Of reflection
 * alone: what glass lets through depends on angles in the world besides, which no few tables follow.
 */
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/multiple.h"

#if MU_REAL_BITS == 24

/* Roughnesses of the first table and the last, and of the first node of all: to the first table nodes lie evenly, for the sake of
 * averages, which change long after what is lost at a place. */
static const float first = -7.5f, last = 1.15f, smoothest = -16;
enum { GRID_HALVINGS = 8, SMOOTH = ALBEDO_SMOOTH_NODES, PROBES = 4, ROOTS_HOLD = 3, HEIGHTS = 6, SHAPES = 4 };

float mu_albedo_share(float log_a, float from, float to) {
    const float h = exp2f(1.5f * log_a), low = exp2f(1.5f * from), high = exp2f(1.5f * to);
    return (h - low) / (high - low) * (1 + high) / (1 + h);
}

/* What the smoothest nodes lose at a place is what the next does. */
static int table_at(int i, int j) {
    return albedo_grid_node(i > SMOOTH ? i - SMOOTH : 0, j > SMOOTH ? j - SMOOTH : 0);
}

typedef struct corner {
    int i, j;
    float share;
} corner;

/* The interval of log2 of a roughness. */
static int interval(const albedo_grid *grid, float *x) {
    int i = 0;
    *x = fminf(fmaxf(*x, grid->node[0]), grid->node[grid->count - 1]);
    while (i < grid->count - 2 && *x >= grid->node[i + 1]) i++;
    return i;
}

/* The triangle of intervals i >= j, and shares in it, of places within both. */
static void triangle(int i, int j, float fx, float fy, corner c[3]) {
    if (i == j) fy = fminf(fy, fx);
    const float low = fminf(fx, fy), high = fmaxf(fx, fy);
    c[0] = (corner){i, j, 1 - high};
    c[1] = fx >= fy ? (corner){i + 1, j, high - low} : (corner){i, j + 1, high - low};
    c[2] = (corner){i + 1, j + 1, low};
}

/* exp of what is quadratic on a triangle, from the values at its corners and midway. */
static float average_at(const float *log_average, const corner c[3]) {
    float sum = 0;
    for (int k = 0; k < 3; k++) {
        const corner *d = &c[(k + 1) % 3];
        sum += c[k].share * (2 * c[k].share - 1) * log_average[albedo_grid_node(2 * c[k].i, 2 * c[k].j)] +
               4 * c[k].share * d->share * log_average[albedo_grid_node(c[k].i + d->i, c[k].j + d->j)];
    }
    return expf(sum);
}

int mu_albedo_grid_choose(const albedo_grid *grid, const double v[4], mu_lobe *out) {
    const float a = mu_albedo_lay(v, &out->frame), b = a * out->frame.ratio, *const n = grid->node;
    float x = log2f(a), y = log2f(b);
    if (x > n[grid->count - 1] + 1e-4f) return 0;
    const int i = interval(grid, &x), j = interval(grid, &y);
    corner c[3];
    if (grid->open[albedo_grid_node(i, j)]) return 0;
    triangle(i, j, mu_albedo_share(x, n[i], n[i + 1]), mu_albedo_share(y, n[j], n[j + 1]), c);
    out->count = out->open = 0, out->passes[0] = 0;
    for (int k = 0; k < 3; k++) {
        if (!(c[k].share > 0)) continue;
        out->level[out->count] = &grid->table[table_at(c[k].i, c[k].j)];
        out->passes[0] += c[k].share * out->level[out->count]->side[0].passes;
        out->share[out->count++] = c[k].share;
    }
    triangle(i, j, (x - n[i]) / (n[i + 1] - n[i]), (y - n[j]) / (n[j + 1] - n[j]), c);
    out->average[0] = average_at(grid->log_average, c), out->average[1] = 0;
    return 1;
}

float mu_albedo_grid_reach(const albedo_grid *grid) {
    int i = 0;
    for (; i < grid->count - 1; i++)
        for (int j = 0; j <= i; j++)
            if (grid->open[albedo_grid_node(i, j)]) return exp2f(grid->node[i]);
    return exp2f(grid->node[i]);
}

/* s M^-1 midway between nodes. */
static void view_at(const albedo_grid *grid, int twice_i, int twice_j, double v[4]) {
    const int at[2] = {twice_i, twice_j};
    double rough[2];
    for (int k = 0; k < 2; k++)
        rough[k] = exp2((double)(grid->node[at[k] / 2] + grid->node[(at[k] + 1) / 2]) / 2);
    v[0] = rough[0], v[1] = v[2] = 0, v[3] = rough[1];
}

/* 1 - E of single scattering at V, toward w. */
static float lost_of(const albedo_source *source, const double v[4], const float w[3]) {
    const double unit = source->surface->unit;
    const float m[4] = {(float)(unit / v[0]), 0, 0, (float)(unit / v[3])};
    closure c;
    if (!MU(mu_bind)(source->surface, w, m, &c)) return 1;
    return mu_albedo_lost(source, &c);
}

/* A probe of a roughness: at a height in the frame, of what is as rough along both axes, or smooth along the other, or rough
 * along it, toward the axis of the lesser. */
static float probe_at(const void *context, float x, int probe) {
    static const double height[HEIGHTS] = {0.05, 0.2, 0.4, 0.6, 0.8, 0.95}, /* r / (r + w.z) of albedo.h */
        psi[SHAPES] = {PI / 4, PI / 4, 1.4, 1.4}, rough[SHAPES] = {0, 0, 1, 2};
    const albedo_source *const source = context;
    const int shape = probe / HEIGHTS;
    const double q = height[probe % HEIGHTS], z = 1 / q - 1, r = exp2((double)x);
    const double a = rough[shape] > 0 ? fmax(rough[shape], r) : r, b = rough[shape] > 0
                                                                           ? fmin(rough[shape], r)
                                                                       : shape == 1 ? exp2((double)first)
                                                                                    : r;
    const double v[4] = {a, 0, 0, b}, at[2] = {cos(psi[shape]) / fmin(a, 1), sin(psi[shape]) / fmin(b, 1)},
                 length = sqrt(at[0] * at[0] + at[1] * at[1] + z * z);
    const float w[3] = {(float)(at[0] / length), (float)(at[1] / length), (float)(z / length)};
    return lost_of(source, v, w);
}

/* What tables are off toward w. */
static float off_toward(const albedo_source *source, const mu_lobe *lobe, const double v[4],
                        const float w[3]) {
    float density;
    int open;
    return fabsf(lobe_told(lobe, 0, w, &density, &open) - lost_of(source, v, w));
}

/* The most that tables are off between the nodes i and j and the next: views at heights from an eighth to eight times the
 * roughness of their azimuth. */
static float gap_of(const albedo_source *source, const albedo_grid *grid, int i, int j) {
    double v[4];
    mu_lobe lobe;
    float most = 0;
    view_at(grid, 2 * i + 1, 2 * j + 1, v);
    if (!mu_albedo_grid_choose(grid, v, &lobe)) return 1;
    for (int k = 0; k < PROBES * PROBES; k++) {
        const double psi = PI / 2 * (k % PROBES + 0.5) / PROBES, a = v[0], b = v[3], x = cos(psi),
                     y = sin(psi) * sqrt(a / b), z = hypot(a * x, b * y) * exp2(2 * (k / PROBES) - 3),
                     length = sqrt(x * x + y * y + z * z);
        const float w[3] = {(float)(x / length), (float)(y / length), (float)(z / length)};
        most = fmaxf(most, off_toward(source, &lobe, v, w));
    }
    return most;
}

/* ln of the averages at nodes and midway. */
static void fill_averages(const albedo_grid *grid, float *out) {
    for (int i = 0; i < 2 * grid->count - 1; i++)
        for (int j = 0; j <= i; j++) {
            double v[4];
            mu_lobe lobe;
            view_at(grid, i, j, v);
            if (mu_albedo_grid_choose(grid, v, &lobe))
                out[albedo_grid_node(i, j)] = (float)log(lobe_average(&lobe, 0));
        }
}

/* Is a table around i and j off by more than is allowed in all? */
static int is_off(const albedo_source *source, const albedo_grid *grid, int i, int j) {
    int off = 0;
    for (int k = i; k <= i + 1; k++)
        for (int l = j; l <= j + 1 && l <= k; l++)
            off |= grid->table[table_at(k, l)].side[0].unsure > (float)source->error;
    return off;
}

void mu_albedo_grid_make(const albedo_source *like, mu_albedo *table, albedo_room *room, albedo_grid *out) {
    albedo_source source = *like;
    const size_t before = like->effort->facets;
    source.trusting = 1, source.error /= 2; /* the other half is for what lies between */
    float *const averages = room->values + room->used[0];
    room->used[0] += ALBEDO_GRID_AVERAGES;
    *out = (albedo_grid){.table = table, .log_average = averages};
    for (int k = 0; k < SMOOTH; k++) out->node[k] = smoothest + (first - smoothest) * (float)k / SMOOTH;
    const albedo_probes probes = {probe_at, &source, SHAPES * HEIGHTS};
    out->count = SMOOTH + mu_albedo_place_nodes(&probes, first, last, (float)source.error * 0.8f,
                                                ALBEDO_NODES, out->node + SMOOTH);
    for (int i = SMOOTH; i < out->count; i++)
        for (int j = SMOOTH; j <= i; j++) {
            mu_albedo *t = &table[table_at(i, j)];
            const float m[4] = {(float)(source.surface->unit / exp2((double)out->node[i])), 0, 0,
                                (float)(source.surface->unit / exp2((double)out->node[j]))};
            source.transform = m, source.halvings = GRID_HALVINGS;
            source.like = j == i || j % ROOTS_HOLD == SMOOTH ? NULL : &t[-1]; /* it changes slowly */
            /* a hard table may take more than its part of the work that is left */
            const size_t taken = source.effort->facets - before,
                         to_come = (size_t)(table_at(out->count - 1, out->count - 1) - table_at(i, j));
            source.facets = (like->facets > taken ? like->facets - taken : 0) / (1 + to_come / 8);
            mu_albedo_make(&source, t, room, (size_t)ALBEDO_GRID_MOST);
        }
    source.transform = NULL;
    fill_averages(out, averages);
    for (int i = out->count - 2; i >= 0; i--)
        for (int j = i; j >= 0; j--)
            out->open[albedo_grid_node(i, j)] =
                gap_of(&source, out, i, j) > (float)like->error || is_off(like, out, i, j);
}

#endif
