/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_plane.h: the slope plane in which a material's micronormals look round, and coordinates on parts of
 * it.
 *
 * Slopes are p = -(m_x, m_y) / m_z. A plane is a linear map p = A s such that the distribution of s is
 * roughly round and of size one; A is a choice of coordinates only: every integral is right for any
 * invertible A, a bad A merely makes it slow. Polar coordinates s = e^t (cos psi, sin psi) follow every scale
 * of a distribution alike.
 *
 * A region is a part of the plane that is star-shaped about the origin: the whole plane; the slopes visible
 * from v; the slopes that reflect v upwards. It is mapped to the rectangle y in [0,2], x in [0,1]: y to psi
 * (measured from the direction of A^T v_xy), x to t between a lower end, below which lies less than e^-32 of
 * a disc of size one, and the region's own edge at that psi; so that integrands have no edge inside the
 * rectangle.
 */
#ifndef MU_CHECK_PLANE_H
#define MU_CHECK_PLANE_H

typedef struct mu_plane {
    double to_slope[4];   /* A, rows */
    double from_slope[4]; /* its inverse */
    double area;          /* |det A| */
    double condition;     /* of A: largest over smallest singular value */
    double narrowest;     /* the smallest singular value of A: width of the lobe in slopes */
    double spread; /* the logarithm of the largest radius at which the distribution changes its shape; >= 0 */
} mu_plane;

/* A = size M^-T, with M given by its rows; false if M is singular. */
_Bool mu_plane_from_transform(mu_plane *plane, const double m[4], double size, double spread);

/* From `count` slopes (x, y pairs): the shape by Tyler's estimator, which needs no moments, the size by the
 * median radius. `scratch` holds 2 count doubles. False if they lie on a line. */
_Bool mu_plane_from_slopes(mu_plane *plane, const double *slopes, int count, double *scratch);

typedef enum mu_region_kind { MU_WHOLE_PLANE, MU_VISIBLE_SLOPES, MU_REFLECTING_SLOPES } mu_region_kind;

typedef struct mu_region {
    const mu_plane *plane;
    mu_region_kind kind;
    double view[3];
    double axis[2]; /* unit: psi = 0 in the s plane */
    double slant;   /* |A^T v_xy| / v_z */
    double low;     /* of t */
    double far;     /* 1/r where the plane counts as ended: e^-30 beyond the spread */
} mu_region;

mu_region mu_region_make(const mu_plane *plane, mu_region_kind kind, const double view[3]);

/* The micronormal at (x, y), and the area of slopes per area of (x, y) there. */
double mu_region_point(const mu_region *region, double x, double y, double m[3]);

/* Where a micronormal lies; false if outside of the region. */
_Bool mu_region_locate(const mu_region *region, const double m[3], double *x, double *y);

#endif
