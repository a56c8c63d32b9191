/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * pieces.c: a few slopes that stand for all of a histogram's under M, for integrals over f, which jumps from cell to cell: in
 * double. Not in the papers.
 *
 * A cell is cut into as many alike, as square under M as may be, as there is room for, and its middles stand for them: that is
 * exact for what is linear over a cell. Where there are more cells than room, so many are put together, and the fullest near
 * their middle stands for them, with the mass of all.
 */
#include "core/bsdf/distribution.h"
#include "core/bsdf/singular.h"
#include "core/bsdf/tabulated.h"
#include "core/ibl/ibl.h"

#include "core/bsdf/real.h"

/* What a block of cells comes to: in cells from the grid's origin; its mass over the density there. */
typedef struct piece {
    double x, y, area;
} piece;

static double mass_of(const tabulated_grid *g, size_t i, size_t j) {
    const double *sums = g->mass + j * (g->columns + 1) + i;
    return sums[1] - sums[0];
}

static size_t smaller_of(size_t a, size_t b) {
    return a < b ? a : b;
}

/* The cells [i, i + across) x [j, j + up). */
static piece merge(const tabulated_grid *g, size_t i, size_t j, size_t across, size_t up) {
    const size_t right = smaller_of(i + across, g->columns), top = smaller_of(j + up, g->rows);
    double all = 0, x = 0, y = 0, best = 0;
    piece out = {0, 0, 0};
    for (size_t r = j; r < top; r++)
        for (size_t c = i; c < right; c++) {
            const double m = mass_of(g, c, r);
            all += m, x += m * (double)c, y += m * (double)r;
        }
    for (size_t r = j; r < top; r++)
        for (size_t c = i; c < right; c++) {
            const double m = mass_of(g, c, r), dx = ((double)c - x / all) / (double)across,
                         dy = ((double)r - y / all) / (double)up;
            if (!(m / (0.01 + dx * dx + dy * dy) > best)) continue;
            best = m / (0.01 + dx * dx + dy * dy);
            out = (piece){(double)c + 0.5, (double)r + 0.5, all / m};
        }
    return out;
}

/* Numbers whose product is `product` at most, the first `ratio` times the second. */
static void factors(double product, double ratio, size_t out[2]) {
    const double first = fmin(fmax(sqrt(product * ratio), 1), product);
    out[1] = (size_t)fmax(floor(product / first), 1);
    out[0] = (size_t)fmax(floor(product / (double)out[1]), 1);
}

size_t MU(mu_ibl_pieces)(const surface *s, const double mean[2], const double m[4], size_t most, double (*out)[3]) {
    const tabulated_grid *g = &((const tabulated *)s->base.table)->grid;
    const double det = fabs(product_difference(m[0], m[3], m[1], m[2])), area = g->cell[0] * g->cell[1] * s->unit * s->unit / det;
    /* a cell's sides under M^-T */
    const double ratio = hypot(m[3], m[1]) * g->cell[0] / (hypot(m[2], m[0]) * g->cell[1]);
    size_t full = 0, block[2] = {1, 1}, cut[2] = {1, 1}, count = 0;
    for (size_t j = 0; j < g->rows; j++)
        for (size_t i = 0; i < g->columns; i++) full += mass_of(g, i, j) > 0;
    if (full > most) {
        factors((double)full / (double)most, 1 / ratio, block);
        while ((g->columns + block[0] - 1) / block[0] * ((g->rows + block[1] - 1) / block[1]) > most)
            ++*(block[0] > block[1] || block[0] >= g->columns ? &block[1] : &block[0]);
    } else {
        factors((double)most / (double)full, ratio, cut);
    }
    for (size_t j = 0; j < g->rows; j += block[1])
        for (size_t i = 0; i < g->columns; i += block[0]) {
            const piece p = merge(g, i, j, block[0], block[1]);
            for (size_t k = 0; p.area > 0 && k < cut[0] * cut[1]; k++) {
                const double at[2] = {p.x - 0.5 + ((double)(k % cut[0]) + 0.5) / (double)cut[0],
                                      p.y - 0.5 + ((double)(k / cut[0]) + 0.5) / (double)cut[1]};
                double slope[2]; /* p = -slope, about the mean */
                for (int a = 0; a < 2; a++) slope[a] = mean[a] - (g->origin[a] + at[a] * g->cell[a]) * s->unit;
                const double turned = m[0] * m[3] < m[1] * m[2] ? -det : det;
                out[count][0] = (m[3] * slope[0] - m[2] * slope[1]) / turned;
                out[count][1] = (m[0] * slope[1] - m[1] * slope[0]) / turned;
                out[count++][2] = p.area * area / (double)(cut[0] * cut[1]);
            }
        }
    return count;
}
