/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_statistics.h: everything that microfacet theory says of a surface, counted on an explicit one: slopes, normals,
 * masking per normal, visible normals, joint visibility, and light reflected once and more often.
 *
 * Over one period of the baked surface, A_macro its area in the plane, per bin of directions:
 *   D      sum A / A_macro per solid angle                         G1(v, m)     sum A V(v) / sum A
 *   Dv     sum (v.m)+ A V(v) / ((v.n) A_macro) per solid angle      G2(v, m, l)  sum A V(v) V(l) / sum A
 * V is 0 for facets that turn away: the invariant masking of On Microsurface Transformations (Golubev), Eq. (2a), (12a).
 * V is seen at side^2 points spread evenly over each triangle: those of ((k + 1/2)/(2 side), (l + 1/2)/side) of a cell
 * that lie in it. From each visible point the mirrors' path is followed (bounce.h), with the weight
 *     (v.m) A / ((v.n) A_macro side^2) F(c_1) ... F(c_k),
 * and what escapes after k reflections is added up per bin of its direction: 1/sr. The weights at k = 0 sum to the
 * projected area over the plane's own, which is 1 but for the finite number of points; as in Eq. (11a), before it is
 * simplified, reflection is divided by this sum. Of blocks that matters much: one that leans toward the view shows more
 * than its share, but what becomes of its light does not depend on that. A light is a disc about a direction l, within
 * `radius` of it, of the radiance 1 / (pi sin^2 radius cos theta_l), whose irradiance is 1: then Eq. (11f) gives the
 * BRDF's mean over the disc, weighted by cosine.
 *
 * What a dielectric's facets refract, once, is followed from the same points (refract.h); below the surface, where a light
 * may be too. Bins of directions below are the mirror images, in the plane, of those above.
 *
 * All sums are kept per unit (ratio.h): each of several files is one, or else each of 4 x 4 blocks of a single surface.
 */
#ifndef MU_SURFACE_STATISTICS_H
#define MU_SURFACE_STATISTICS_H

#include "core/render/surface_tracer.h"
#include "core/surface/bounce.h"
#include "core/surface/ratio.h"
#include "core/surface/reflect.h"
#include "core/surface/reflectance.h"
#include "core/surface/underside.h"

enum {
    MU_STATISTICS_VIEWS = 16,
    MU_STATISTICS_LIGHTS = 16,
    MU_STATISTICS_BLOCKS = 16,
    MU_GROUPS_FINER = 8,
    MU_GROUP_RINGS = 360
};

/* What becomes of the light of a view, in the order of the cells of mu_seen.ends: shares of it. */
enum { MU_END_ESCAPED, MU_END_OVER_LIMIT, MU_END_LOST, MU_END_ABSORBED, MU_ENDS };
/* What becomes of it at the first facet: gets through; meets the underside again; is reflected, of which totally. The first
 * three add up to 1. */
enum { MU_THROUGH_ESCAPED, MU_THROUGH_CAUGHT, MU_THROUGH_REFLECTED, MU_THROUGH_TOTAL, MU_THROUGHS };
/* Cells of mu_gathering.slopes after its histogram. */
enum { MU_SLOPE_OUTSIDE, MU_SLOPE_X, MU_SLOPE_Y, MU_SLOPE_XX, MU_SLOPE_XY, MU_SLOPE_YY, MU_SLOPE_MORE };

typedef struct mu_lamp {
    double l[3], radius; /* unit vector; radians */
} mu_lamp;
static inline _Bool mu_lamp_below(const mu_lamp *lamp) {
    return lamp->l[2] < 0;
}
/* Of the light that comes from the direction w. */
double mu_lamp_radiance(const mu_lamp *lamp, const double w[3]);

/* Of light refracted once. */
typedef struct mu_through {
    mu_ratios ends;       /* MU_THROUGHS shares */
    mu_ratios directions; /* per bin, shares times 1/eta^2: radiance */
    mu_ratios lamps;      /* one cell a light: f */
    mu_group *groups;     /* of `finer`, if there are lights; what gets through, in shares before 1 - F */
} mu_through;

typedef struct mu_seen {
    double w[3], unit[3];      /* as asked but for a power of two; as a unit vector */
    mu_ratios facing, masking; /* per bin of normals: area that faces w, that w sees, over all area */
    mu_ratios projected;       /* one cell: projected area that w sees over that which faces w */
    mu_ratios identity; /* one cell: over the plane's own; its top is the bottom of all that follows but normals */
    mu_ratios normals; /* per bin: Dv times the solid angle */
    mu_ratios ends[3]; /* per colour: MU_ENDS shares, then the albedo of each order */
    mu_ratios directions[3]; /* per colour: per order and bin, shares */
    mu_ratios lamps[3];      /* per colour, two cells a light: f of one reflection, of all */
    mu_group *groups;        /* of `finer`, if there are lights; what escapes after one reflection */
    mu_through through;
    uint8_t *visible;        /* nx * ny, of the point at hand */
} mu_seen;

typedef struct mu_seen_pair {
    uint32_t a, b;
    mu_ratios facing, masking; /* as in mu_seen, but both views */
    mu_ratios share;           /* one cell: facets seen by both over facets that face both */
} mu_seen_pair;

typedef struct mu_gathering {
    /* asked */
    double m[4];
    const mu_tracer *tracer;
    uint32_t side, threads, bounces; /* bounces 0: no reflection */
    mu_directions bins;
    uint32_t view_count, lamp_count, file_count, slope_cells;
    double slope_bounds[4]; /* x_min, x_max, y_min, y_max; all 0: from the first surface */
    mu_lamp lamps[MU_STATISTICS_LIGHTS];
    mu_reflectance reflectance;
    _Bool transmission; /* then the reflectance is a dielectric's, of one colour */
    void (*progress)(void *context, double done);
    void *context;
    /* gathered */
    mu_directions
        finer; /* MU_GROUPS_FINER times the rings and sectors, at most MU_GROUP_RINGS and four times that */
    mu_seen views[MU_STATISTICS_VIEWS];
    mu_caster *underside; /* of the surface at hand, for transmission */
    mu_seen_pair *pairs;
    uint32_t pair_count;
    size_t units;
    double *macro;     /* per unit: A_macro, in facets */
    double *facets;    /* per bin of normals, of all files */
    mu_ratios slopes;  /* slope_cells^2 shares, row by row from y_min on, then MU_SLOPE_MORE */
    mu_ratios normals; /* per bin: area over A_macro */
    double total;      /* facets */
    double correlation[2],
        block; /* of the first file, in cells: 1/e lengths along x, y; the side of a block */
} mu_gathering;

/* After what is asked is set. Each file is added in turn, 0 ... file_count - 1. All are freed by mu_gathering_free. */
_Bool mu_gathering_begin(mu_gathering *g, mu_error *error);
_Bool mu_gathering_add(mu_gathering *g, uint32_t file, const mu_heightfield *f, mu_error *error);
void mu_gathering_free(mu_gathering *g);

static inline size_t mu_gathering_unit(const mu_gathering *g, uint32_t file, const mu_heightfield *f,
                                       uint32_t i, uint32_t j) {
    return g->file_count > 1 ? file : (size_t)((uint64_t)i * 4 / f->nx * 4 + (uint64_t)j * 4 / f->ny);
}
static inline int mu_gathering_channels(const mu_gathering *g) {
    return g->reflectance.channels;
}

/* Slopes and normals of a surface (surface_slopes.c); bins[upper nx ny + i ny + j] is the bin of each facet's normal. */
_Bool mu_gathering_normals(mu_gathering *g, uint32_t file, const mu_heightfield *f, uint32_t *bins,
                           mu_error *error);
/* Paths from one point of every facet that a view sees (surface_paths.c). */
_Bool mu_gathering_paths(mu_gathering *g, uint32_t file, const mu_mirrors *mirrors, mu_seen *seen, int upper,
                         const double point[2], mu_error *error);
/* The same of refracted light (surface_through.c), and room for it. */
_Bool mu_gathering_through(mu_gathering *g, uint32_t file, const mu_heightfield *f, mu_seen *seen, int upper,
                           const double point[2], mu_error *error);
_Bool mu_through_make(const mu_gathering *g, mu_seen *s);
void mu_through_free(mu_through *through);
/* Eq. (11f) from the groups, F and L once per group; one colour. Reflected or refracted, as the light is (surface_grouped.c). */
double mu_gathering_grouped(const mu_gathering *g, const mu_seen *seen, uint32_t lamp, int channel);

/* The JSON line on stdout (surface_report.c); false: errno says why. */
_Bool mu_gathering_report(const mu_gathering *g);

#endif
