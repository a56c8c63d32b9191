/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * heightfield.h: a periodic surface of triangles, and its image under a linear map M.
 *
 * Heights h[i ny + j] stand over the points (i, j), nx by ny, of a square lattice of cell size 1, i along x, j along y;
 * beyond these the surface repeats. Each cell splits along (i+1,j)-(i,j+1) into
 *     L = (i,j), (i+1,j), (i,j+1)      and      U = (i+1,j+1), (i,j+1), (i+1,j).
 * M maps positions in the plane and leaves heights: Eq. (9) of Microsurface Transformations (Atanasov et al. 2022).
 * m[4] is [a c; b d] row by row: x' = m[0] x + m[1] y, y' = m[2] x + m[3] y.
 */
#ifndef MU_HEIGHTFIELD_H
#define MU_HEIGHTFIELD_H

#include <stddef.h>
#include <stdint.h>

typedef struct mu_heightfield {
    const double *h; /* nx * ny, borrowed */
    uint32_t nx, ny;
} mu_heightfield;

enum { MU_LOWER, MU_UPPER }; /* the two triangles of a cell */

static inline size_t mu_cells(const mu_heightfield *f) {
    return (size_t)f->nx * f->ny;
}

static inline double mu_height(const mu_heightfield *f, uint32_t i, uint32_t j) {
    return f->h[(size_t)(i < f->nx ? i : i - f->nx) * f->ny + (j < f->ny ? j : j - f->ny)];
}

/* dh/dx and dh/dy of a triangle before M: the differences of neighbouring heights. */
static inline void mu_facet_slope(const mu_heightfield *f, uint32_t i, uint32_t j, int upper, double s[2]) {
    const double h10 = mu_height(f, i + 1, j), h01 = mu_height(f, i, j + 1);
    const double corner = upper ? mu_height(f, i + 1, j + 1) : mu_height(f, i, j);
    s[0] = upper ? corner - h01 : h10 - corner;
    s[1] = upper ? corner - h10 : h01 - corner;
}

/*
 * The upward normal of the baked triangle, as long as twice its area, by the cross product of its baked edges
 * (m[0], m[2], s[0]) and (m[1], m[3], s[1]). A mirror (det M < 0) turns the triangle over; upward is what is meant.
 * Its z component is |det M|, twice the area over the plane.
 */
static inline void mu_facet_normal(const double m[4], const double s[2], double normal[3]) {
    const double sign = m[0] * m[3] - m[1] * m[2] < 0 ? -1 : 1;
    normal[0] = sign * (m[2] * s[1] - s[0] * m[3]);
    normal[1] = sign * (s[0] * m[1] - m[0] * s[1]);
    normal[2] = sign * (m[0] * m[3] - m[1] * m[2]);
}

/* Twice the triangle's area projected along w; positive where it faces w. */
static inline double mu_facet_facing(const double m[4], const double s[2], const double w[3]) {
    double normal[3];
    mu_facet_normal(m, s, normal);
    return w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
}

/* The surface's height above the point (i + u, j + v) of one triangle of cell (i, j); M leaves it. */
static inline double mu_facet_height(const mu_heightfield *f, uint32_t i, uint32_t j, int upper, double u,
                                     double v) {
    const double h10 = mu_height(f, i + 1, j), h01 = mu_height(f, i, j + 1);
    const double corner = upper ? mu_height(f, i + 1, j + 1) : mu_height(f, i, j);
    return upper ? corner + (1 - u) * (h01 - corner) + (1 - v) * (h10 - corner)
                 : corner + u * (h10 - corner) + v * (h01 - corner);
}

#endif
