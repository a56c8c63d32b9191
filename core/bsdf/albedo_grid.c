/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_grid.c: tables for an M of the point, of a microsurface that is level, and isotropic before M: what it loses depends on
 * the two slope roughnesses that M makes of it, the singular values A >= B of s M^-1 (s the slope unit), and on the axes.
 *
 * A table for each pair of nodes of both; between them the mean of three, by triangles with an edge along A = B, linear in
 * log2 A and log2 B, at the place that a direction has in the frame of the very M (albedo_set.h). Nodes are dense where slopes
 * are about 1, far apart below, where what is lost at such a place changes by O(A²); above 2 they are few, for the sake of time.
 * Beyond both ends the end stands in. ln of averages is quadratic on each triangle. What triangles leave is measured where they are
 * largest, at the middle of the long edge (measure_gap).
 */
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/multiple.h"

#if MU_REAL_BITS == 24

/* Roughnesses of the first table, and of what stands for all that is smoother. Up to `promised` nodes are placed, and `unsure` is of
 * these; steeper tables are for what is beyond what is promised, and coarser. */
static const float first = -7.5f, promised = 1.15f, smoothest = -16, steep[] = {1.9f, 2.9f, 4.2f};
enum {
    GRID_HALVINGS = 8,
    STEEP_HALVINGS = 4,
    STEEP = 3,
    PROBES = 4,
    ROOTS_HOLD = 3,
    HEIGHTS = 6,
    SHAPES = 4
};

float mu_albedo_share(float log_a, float from, float to) {
    const float h = exp2f(1.5f * log_a), low = exp2f(1.5f * from), high = exp2f(1.5f * to);
    return (h - low) / (high - low) * (1 + high) / (1 + h);
}

/* What the first node loses at a place is what the second does. */
static int table_at(int i, int j) {
    return albedo_grid_node(i > 1 ? i - 1 : 0, j > 1 ? j - 1 : 0);
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

void mu_albedo_grid_choose(const albedo_grid *grid, const double v[4], mu_lobe *out) {
    const float a = mu_albedo_lay(v, &out->frame), b = a * out->frame.ratio, *const n = grid->node;
    float x = log2f(a), y = log2f(b);
    const int i = interval(grid, &x), j = interval(grid, &y);
    corner c[3];
    triangle(i, j, mu_albedo_share(x, n[i], n[i + 1]), mu_albedo_share(y, n[j], n[j + 1]), c);
    out->count = out->open = 0, out->passes[0] = 0;
    for (int k = 0; k < 3; k++) {
        if (!(c[k].share > 0)) continue;
        out->level[out->count] = &grid->table[table_at(c[k].i, c[k].j)];
        out->passes[0] += c[k].share * out->level[out->count]->side[0].passes;
        out->share[out->count++] = c[k].share;
    }
    triangle(i, j, (x - n[i]) / (n[i + 1] - n[i]), (y - n[j]) / (n[j + 1] - n[j]), c);
    for (int side = 0; side < 2 && grid->log_average[side]; side++)
        out->average[side] = average_at(grid->log_average[side], c);
}

/* s M^-1 midway between nodes. */
static void view_at(const albedo_grid *grid, int twice_i, int twice_j, double v[4]) {
    const int at[2] = {twice_i, twice_j};
    double rough[2];
    for (int k = 0; k < 2; k++)
        rough[k] = exp2((double)(grid->node[at[k] / 2] + grid->node[(at[k] + 1) / 2]) / 2);
    v[0] = rough[0], v[1] = v[2] = 0, v[3] = rough[1];
}

/* 1 - E of single scattering at V, toward w, or -w from below. */
static float lost_of(const albedo_source *source, const double v[4], const float w[3], int below) {
    const double unit = source->surface->unit;
    const float m[4] = {(float)(unit / v[0]), 0, 0, (float)(unit / v[3])}, sign = below ? -1 : 1;
    closure c;
    if (!MU(mu_bind)(source->surface, (const float[]){sign * w[0], sign * w[1], sign * w[2]}, m, &c))
        return 1;
    return mu_albedo_lost(source, &c);
}

/* A probe of a roughness: at a height in the frame, of what is as rough along both axes, or smooth along the other, or rough
 * along it, toward the axis of the lesser; either side. */
static float probe_at(const void *context, float x, int probe) {
    static const double height[HEIGHTS] = {0.05, 0.2, 0.4, 0.6, 0.8, 0.95}, /* r / (r + w.z) of albedo.h */
        psi[SHAPES] = {PI / 4, PI / 4, 1.4, 1.4}, rough[SHAPES] = {0, 0, 1, 2};
    const albedo_source *const source = context;
    const int shape = probe / HEIGHTS % SHAPES;
    const double q = height[probe % HEIGHTS], z = 1 / q - 1, r = exp2((double)x);
    const double a = rough[shape] > 0 ? fmax(rough[shape], r) : r, b = rough[shape] > 0
                                                                           ? fmin(rough[shape], r)
                                                                       : shape == 1 ? exp2((double)first)
                                                                                    : r;
    const double v[4] = {a, 0, 0, b}, at[2] = {cos(psi[shape]) / fmin(a, 1), sin(psi[shape]) / fmin(b, 1)},
                 length = sqrt(at[0] * at[0] + at[1] * at[1] + z * z);
    const float w[3] = {(float)(at[0] / length), (float)(at[1] / length), (float)(z / length)};
    return lost_of(source, v, w, probe / HEIGHTS / SHAPES);
}

/* The most that tables are off between nodes: views at heights from an eighth to eight times the roughness of their azimuth. */
static float measure_gap(const albedo_source *source, const albedo_grid *grid, int count) {
    const int sides = source->surface->transmission ? 2 : 1;
    float most = 0;
    for (int i = 3; i < 2 * count - 2; i += 2)
        for (int j = 3; j <= i; j += 2) {
            double v[4];
            mu_lobe lobe;
            view_at(grid, i, j, v);
            mu_albedo_grid_choose(grid, v, &lobe);
            for (int k = 0; k < PROBES * PROBES; k++) {
                const double psi = PI / 2 * (k % PROBES + 0.5) / PROBES, a = v[0], b = v[3], x = cos(psi),
                             y = sin(psi) * sqrt(a / b), z = hypot(a * x, b * y) * exp2(2 * (k / PROBES) - 3),
                             length = sqrt(x * x + y * y + z * z);
                for (int side = 0; side < sides; side++) {
                    const float w[3] = {(float)(x / length), (float)(y / length), (float)(z / length)};
                    float density;
                    const float told = lobe_lost(&lobe, side, w, &density);
                    most = fmaxf(most, fabsf(told - lost_of(source, v, w, side)));
                }
            }
        }
    return most;
}

/* ln of the averages at nodes and midway. */
static void fill_averages(const albedo_grid *grid, int side, float *out) {
    for (int i = 0; i < 2 * grid->count - 1; i++)
        for (int j = 0; j <= i; j++) {
            double v[4];
            mu_lobe lobe;
            view_at(grid, i, j, v);
            mu_albedo_grid_choose(grid, v, &lobe);
            out[albedo_grid_node(i, j)] = (float)log(lobe_average(&lobe, side));
        }
}

void mu_albedo_grid_make(const albedo_source *like, mu_albedo *table, albedo_room *room, albedo_grid *out,
                         float *unsure) {
    const int sides = like->surface->transmission ? 2 : 1;
    albedo_source source = *like;
    const size_t before = like->effort->facets;
    source.trusting = 1, source.error /= 2; /* the other half is for what lies between */
    float *const averages = room->values + room->used[0];
    room->used[0] += (size_t)(sides * ALBEDO_GRID_AVERAGES);
    *out = (albedo_grid){.table = table, .node = {smoothest}};
    const albedo_probes probes = {probe_at, &source, SHAPES * HEIGHTS * sides};
    const int most = ALBEDO_NODES - 1 - STEEP;
    out->count =
        1 + mu_albedo_place_nodes(&probes, first, promised, (float)source.error * 0.8f, most, out->node + 1);
    const int gentle = out->count;
    for (int k = 0; k < STEEP; k++) out->node[out->count++] = steep[k];
    float worst = 0;
    for (int i = 1; i < out->count; i++)
        for (int j = 1; j <= i; j++) {
            mu_albedo *t = &table[table_at(i, j)];
            const float m[4] = {(float)(source.surface->unit / exp2((double)out->node[i])), 0, 0,
                                (float)(source.surface->unit / exp2((double)out->node[j]))};
            source.transform = m, source.halvings = i < gentle ? GRID_HALVINGS : STEEP_HALVINGS;
            /* it changes slowly, but where slopes are steep */
            source.like = j == i || i >= gentle || j % ROOTS_HOLD == 1 ? NULL : &t[-1];
            /* a hard table may take more than its part of the work that is left */
            const size_t taken = source.effort->facets - before,
                         to_come = (size_t)(table_at(out->count - 1, out->count - 1) - table_at(i, j));
            source.facets = (like->facets > taken ? like->facets - taken : 0) / (1 + to_come / 8);
            mu_albedo_make(&source, t, room, (size_t)(sides * ALBEDO_GRID_MOST));
            for (int side = 0; side < sides && i < gentle; side++) worst = fmaxf(worst, t->side[side].unsure);
        }
    source.transform = NULL;
    for (int side = 0; side < sides; side++) {
        fill_averages(out, side, averages + side * ALBEDO_GRID_AVERAGES);
        out->log_average[side] = averages + side * ALBEDO_GRID_AVERAGES;
    }
    worst = fmaxf(worst, measure_gap(&source, out, gentle));
    *unsure = worst > (float)like->error ? worst : 0;
}

#endif
