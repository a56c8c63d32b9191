/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated.h: a slope histogram made ready, in double whatever the precision of shading.
 *
 * P22 is constant in each cell. All is in p = n.xy / n.z of normals, which is minus the slope (dz/dx, dz/dy), with the mean
 * taken out, in units of the root mean square slope: the histogram's first column is the grid's last.
 */
#ifndef MU_TABULATED_H
#define MU_TABULATED_H

#include <stddef.h>

#include "core/bsdf/musurf.h"

enum { TABULATED_MOST = 1024 }; /* cells along one side */
/* In a base's `shape`. */
enum {
    TABULATED_ORIGIN = 0,
    TABULATED_PER_CELL = 2,
    TABULATED_CELLS = 4, /* columns, rows */
    TABULATED_ROOT = 6   /* grid.root */
};

/* A cell so narrow and so full that no table follows the crease it makes in the masking: more than 1/64 of all. */
enum { TABULATED_HEAVY = 64 };
typedef struct tabulated_cell {
    double p[2], mass; /* its middle */
} tabulated_cell;

typedef struct tabulated_grid {
    size_t columns, rows;  /* without the empty margins of the histogram */
    size_t last[2];        /* cell (i, j) is that of the histogram at column last[0] - i, row last[1] - j */
    double largest, total; /* weight; sum of the weights over the largest */
    double origin[2], cell[2]; /* cell (i, j) spans origin + (i, j) cell ... + (1, 1) cell; |cell| > 0 */
    double root[3];            /* the covariance of p is L L^T, L = [root[0] 0; root[1] root[2]] */
    double farthest; /* |L^-1 p| differs that much from the middle of a cell to its corner, at most */
    double mean_reach;
    double *mass;   /* per row, columns + 1 sums over the cells to the left: of the mass */
    double *moment; /* of the mass times x at the middle of the cell */
    double *reach;  /* of the mass times a bound of |L^-1 p|: that at the middle, plus `farthest` */
    double *mass_below, *reach_below; /* rows + 1 sums over the rows below */
    size_t heavy;                     /* how many cells are */
    double light;                     /* the mass of the others */
    tabulated_cell heavy_cell[TABULATED_HEAVY];
} tabulated_grid;

/* tabulated_grid.c: mean slope (dz/dx, dz/dy) and covariance xx, xy, yy of a checked definition; bytes for the grid's
 * sums; the grid itself. */
void mu_tabulated_moments(const mu_definition *d, double mean[2], double covariance[3]);
double mu_tabulated_spread(const double covariance[3]); /* the root mean square slope */
/* P22 of a cell. */
double mu_tabulated_density(const tabulated_grid *grid, const mu_definition *d, size_t column, size_t row);
size_t mu_tabulated_grid_bytes(const mu_definition *d);
void mu_tabulated_grid_make(tabulated_grid *grid, const mu_definition *d, double *sums);

/* What a half-plane holds of the grid: the positive part of k[0] x + k[1] y + k[2] (half_plane.c). */
typedef struct half_plane {
    double k[3];
    double span[2];                    /* what it grows by across a cell, not negative */
    double half, less, per_less, more; /* half the sum of both; the smaller, its inverse or 0, the larger */
} half_plane;
typedef struct cut_cells { /* of one row */
    size_t first, last;    /* [first, last) are cut; the cells beyond one of them are inside */
    double centre, area;   /* k at x = 0 in the middle of the row; the integral over the row */
} cut_cells;
half_plane mu_half_plane(const tabulated_grid *grid, const double k[3]);
cut_cells mu_half_plane_row(const half_plane *h, const tabulated_grid *grid, size_t row);
double mu_half_plane_cell(const half_plane *h,
                          double middle); /* mean over a cell, from the value at its middle */

/* A place whose density is that of `sums` and `below`: of the mass, or the reach (tabulated_draw.c). */
typedef struct tabulated_place {
    size_t column, row;
    double p[2];
} tabulated_place;
tabulated_place mu_tabulated_draw(const tabulated_grid *grid, const double *sums, const double *below,
                                  double u0, double u1);

/* z Lambda of w, exact: the part of the projected area that faces away (tabulated_smith.c). */
double mu_tabulated_away(const tabulated_grid *grid, const double w[3]);
/* The same of the heavy cells alone. */
double mu_tabulated_heavy(const tabulated_grid *grid, const double w[3]);
/* p of a visible normal from w, by inversion of the exact areas of rows and cells; `more` makes a uniform number
 * (tabulated_visible.c). */
void mu_tabulated_visible(const tabulated_grid *grid, const double w[3], const double u[2],
                          double (*more)(void *state), void *state, double p[2]);

/* The same area without them for float: a table over all directions above the horizon (tabulated_smith.c). */
enum { TABULATED_AZIMUTHS = 256, TABULATED_HEIGHTS = 128, TABULATED_STRIDE = TABULATED_HEIGHTS + 3 };
size_t mu_tabulated_table_bytes(void);
void mu_tabulated_table_build(const tabulated_grid *grid, float *table);

/* What tabulated.c keeps in a base's table. */
typedef struct tabulated {
    tabulated_grid grid;
    const float *away;   /* the table; float only */
    const void *density; /* P22, row by row, reals */
} tabulated;

#endif
