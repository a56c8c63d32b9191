/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * soup.h: small surfaces as lists of triangles, periodic in the plane, and the exact share of each triangle's area that
 * directions see.
 *
 * For cases that pencil and paper answer: square waves and boxes, slanted until they hang over and their normals leave
 * the hemisphere, turned upside down, under any M, and loose facets. Shares come from polygons, not from samples: what
 * stands before a triangle is projected on it along the direction and cut away, so that they are exact to rounding.
 * Cost grows with the square of the number of triangles; some hundreds are meant.
 */
#ifndef MU_SOUP_H
#define MU_SOUP_H

#include <stddef.h>

/* Counterclockwise seen from outside, which is where its normal points. */
typedef struct mu_triangle {
    double p[3][3];
} mu_triangle;

typedef struct mu_soup {
    mu_triangle *triangles; /* of one period; the caller's */
    size_t count;
    double period[2][2]; /* two vectors in the plane that repeat it */
} mu_soup;

enum { MU_WAVE_TRIANGLES = 8, MU_BOX_TRIANGLES = 16 };

/*
 * A square wave of `period` along x, the same for all y (repeated every `depth`): ground at z = 0, a ridge of `width`
 * and `height` whose top is moved by `slant` along x; |slant| > 0 makes one side hang over. Fills 8 triangles: ground 0,
 * 1; rising side 2, 3; top 4, 5; falling side 6, 7.
 */
void mu_soup_wave(mu_soup *soup, mu_triangle out[MU_WAVE_TRIANGLES], double period, double depth,
                  double width, double height, double slant);
/*
 * A parallelepiped amid a square of ground of side `period`: foot of `width` a side with its corner at the origin, top
 * moved by slant[2]. Fills 16 triangles: top 0, 1; sides 2 to 9; ground 10 to 15.
 */
void mu_soup_box(mu_soup *soup, mu_triangle out[MU_BOX_TRIANGLES], double period, double width, double height,
                 const double slant[2]);
/* Heights change their sign: boxes become pits. Normals stay outside, above. */
void mu_soup_turn_over(mu_soup *soup);
/* M moves positions in the plane, m[4] row by row; a mirror keeps outside outside. */
void mu_soup_transform(mu_soup *soup, const double m[4]);

/* The triangle's normal, as long as its area. */
void mu_soup_normal(const mu_soup *soup, size_t index, double normal[3]);

/*
 * The share of the triangle's area that all of the directions w (w[2] > 0, any length) see: G1 of it for one direction,
 * G2 for two. 0 if it turns away from one. Negative if it is cut into too many pieces to be kept.
 */
double mu_soup_visible(const mu_soup *soup, size_t index, const double (*w)[3], size_t directions);

#endif
