/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_plane.h: the slope plane in which a material's micronormals look round, and coordinates on parts of
 * it.
 *
 * Slopes are p = -(m_x, m_y) / m_z. A plane is a map p = c + A s such that the distribution of s is roughly
 * round, of size one and about the origin; A and c are a choice of coordinates only: every integral is right for any
 * invertible A, a bad one merely makes it slow. Polar coordinates s = e^t (cos psi, sin psi) follow every scale
 * of a distribution alike.
 *
 * A region is a convex part of the plane: the whole plane; the slopes visible from v; the slopes that reflect v
 * upwards. Its origin is c if that lies inside, or the slope 0, which always does. It is mapped to the rectangle y in [0,2], x in [0,1]: y to psi
 * (measured from the direction of A^T v_xy), x to t between a lower end, below which lies less than e^-32 of
 * a disc of size one, and the region's own edge at that psi; so that integrands have no edge inside the
 * rectangle.
 */
#ifndef MU_CHECK_PLANE_H
#define MU_CHECK_PLANE_H

typedef struct mu_plane {
    double centre[2];     /* c: the mean slope of a tilted microsurface */
    double to_slope[4];   /* A, rows */
    double from_slope[4]; /* its inverse */
    double area;          /* |det A| */
    double condition;     /* of A: largest over smallest singular value */
    double narrowest;     /* the smallest singular value of A: width of the lobe in slopes */
    double lost;          /* share of the projected area that may lie beyond the ends of regions */
    double spread; /* the logarithm of the largest radius at which the distribution changes its shape; >= 0 */
} mu_plane;

/* A = size M^-T and c = M^-T tilt, with M given by its rows; false if M is singular. tilt may be NULL. */
_Bool mu_plane_from_transform(mu_plane *plane, const double m[4], const double *tilt, double size,
                              double spread);

/* From `count` slopes (x, y pairs): the shape by Tyler's estimator, which needs no moments, the size by the
 * median radius; about their middle if that is not 0. `scratch` holds 2 count doubles. False if they lie on a line. */
_Bool mu_plane_from_slopes(mu_plane *plane, const double *slopes, int count, double *scratch);

typedef enum mu_region_kind { MU_WHOLE_PLANE, MU_VISIBLE_SLOPES, MU_REFLECTING_SLOPES } mu_region_kind;

typedef struct mu_region {
    const mu_plane *plane;
    mu_region_kind kind;
    double view[3];
    double origin[2]; /* slope at s = 0 */
    double axis[2];   /* unit: psi = 0 in the s plane */
    double height;    /* v.m / m_z at the origin: v_z - v_xy.origin */
    double slant;     /* |A^T v_xy| / height */
    double low;       /* of t */
    double far;       /* 1/r where the plane counts as ended: e^-30 beyond the spread */
} mu_region;

mu_region mu_region_make(const mu_plane *plane, mu_region_kind kind, const double view[3]);

/* The micronormal at (x, y), and the area of slopes per area of (x, y) there. */
double mu_region_point(const mu_region *region, double x, double y, double m[3]);

/* Where a micronormal lies; false if outside of the region. */
_Bool mu_region_locate(const mu_region *region, const double m[3], double *x, double *y);

#endif
