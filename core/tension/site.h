/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * site.h: the deformation of the surface at a place, before any texture says where u is.
 *
 * log U (stretch.h) is first the mean of the triangles that meet there, weighted by area and angle at rest, each
 * turned into the plane of the place the shortest way. Then it is moved to what the fit (quadric.h) says, but no farther than
 * triangles within two rings are from the mean: between the first and that lies what a smooth surface can have, beyond
 * it what creases make of a polynomial. Frame: the first tangent of `rest`, without a plane the u directions themselves.
 */
#ifndef MU_TENSION_SITE_H
#define MU_TENSION_SITE_H

#include "core/tension/quadric.h"
#include "core/tension/shape.h"

typedef struct mu_site {
    mu_plane plane;
    _Bool flat;              /* has a plane: else there are no tangents */
    int degree;              /* of the fit that gives the tangents; 0: there are none */
    int rings;               /* of the patch */
    mu_shape rest, deformed; /* tangents dp/ds */
    double slope[2];         /* of v, if asked for */
    double log[3];
    const double *same; /* M of all triangles of the patch, bit for bit; NULL: they differ */
} mu_site;

/* The plane across `normal` along an edge of the place's first triangle; false if `whole` and some triangles do not face it. */
_Bool mu_site_plane(const mu_ground *ground, uint32_t place, const double normal[3], uint32_t own,
                    _Bool whole, mu_plane *plane);
/* `own`: as for patches, where there is no plane also whose triangles count. centre: a corner there; uvs: as of fits.
 * False: out of memory. site->log is not set where no triangle has M. */
_Bool mu_site_make(mu_ground *ground, uint32_t place, uint32_t own, uint32_t centre, const double *uvs,
                   mu_site *site);

/* Cosine and sine in the plane of a triangle's u direction, its plane turned the shortest way. */
void mu_site_turned(const mu_plane *plane, const mu_part *part, double turn[2]);
/* log U seen from axes turned by (cos, sin) against the former ones. */
void mu_site_turn(const double log[3], const double turn[2], double out[3]);

#endif
