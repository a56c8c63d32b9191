/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.h: tables of what single scattering loses, 1 - E(w), E the directional albedo for F = 1 (or of both sides of a
 * surface that transmits): made when a surface is, by albedo.c; float whatever the precision of shading.
 *
 * E of a transformed microsurface depends on the azimuth, and most where the direction is as far from the horizon as the
 * slopes are, so tables are laid over the hemisphere of L w: L is M^-1 up to its scale, its larger singular value 1 (of what
 * is rougher than 1 along an axis, that is bounded by 1: such a surface changes at every angle). The hemisphere is the
 * octahedron's upper half, turned into the square [-1,1]²: with |.|_1 its norm, z = (L w).z / |L w|_1 and s = 1 - z^(1/n),
 *     p = s / (1 - z) (L w).xy / |L w|_1,     (a, b) = (p.x + p.y, p.x - p.y),
 * where n >= 3 brings the directions as far from the horizon as the slopes are to about half of the way (and since E has
 * an infinite slope at the horizon itself). In between by bilinear interpolation; on the square's
 * diagonals, where the octahedron's edges are, by triangles on either side. Solid angle by
 *     da db = 2 |det L| s z^(1/n - 1) / (|L w|_1^3 (1 - z) n) dw.
 */
#ifndef MU_ALBEDO_H
#define MU_ALBEDO_H

#include <math.h>
#include <stddef.h>

#include "core/bsdf/musurf.h"

typedef struct mu_albedo_side {
    float *lost;       /* 1 - E, above 0: (cells + 1)² values */
    float *cumulative; /* of the lobe (1 - E) cos, by cells: cells² values */
    float average;     /* of what is interpolated: 1/pi times the integral of (1 - E) cos */
    float passes;      /* of light that is scattered on: the share that leaves on the other side */
} mu_albedo_side;

typedef struct mu_albedo {
    float to[4], from[4], det; /* L, its inverse, |det L| */
    float power, horizon;      /* n; the least z */
    int cells;                 /* along a side of the square */
    mu_albedo_side side[2];    /* above; below too if the surface transmits */
    float values[];            /* theirs */
} mu_albedo;

static inline size_t albedo_side_values(int cells) {
    const size_t n = (size_t)cells;
    return (n + 1) * (n + 1) + n * n;
}

static inline size_t albedo_bytes(const mu_definition *d) {
    return sizeof(mu_albedo) +
           (d->transmission ? 2 : 1) * albedo_side_values(d->compensation_cells) * sizeof(float);
}

/* A direction's place in the square, in cells, and da db / dw there. */
typedef struct albedo_place {
    float a, b, stretch;
} albedo_place;

static inline albedo_place albedo_locate(const mu_albedo *t, const float w[3]) {
    const float x = t->to[0] * w[0] + t->to[1] * w[1], y = t->to[2] * w[0] + t->to[3] * w[1];
    const float flat = fabsf(x) + fabsf(y), norm = flat + w[2], z = w[2] / norm, rest = flat / norm;
    const float s = -expm1f((z < 0.5f ? logf(z) : log1pf(-rest)) / t->power), half = (float)t->cells / 2;
    const float slope = rest > 0 ? s / rest : 1 / t->power, to = slope / norm;
    return (albedo_place){half * (1 + to * (x + y)), half * (1 + to * (x - y)),
                          2 * t->det / t->power * (to / norm) * ((1 - s) / w[2])};
}

static inline int albedo_cell(const mu_albedo *t, float x) {
    const int i = (int)x;
    return i < 0 ? 0 : i < t->cells ? i : t->cells - 1;
}

static inline float albedo_lost(const mu_albedo *t, const mu_albedo_side *s, albedo_place at) {
    const int j = albedo_cell(t, at.a), k = albedo_cell(t, at.b), nodes = t->cells + 1;
    const float *row = &s->lost[j * nodes + k], x = at.a - (float)j, y = at.b - (float)k;
    const float v00 = row[0], v01 = row[1], v10 = row[nodes], v11 = row[nodes + 1];
    if (j == k)
        return x > y ? v00 + x * (v10 - v00) + y * (v11 - v10) : v00 + y * (v01 - v00) + x * (v11 - v01);
    if (j + k == t->cells - 1)
        return x + y < 1 ? v00 + x * (v10 - v00) + y * (v01 - v00)
                         : v11 + (1 - x) * (v01 - v11) + (1 - y) * (v10 - v11);
    const float low = v00 + y * (v01 - v00), high = v10 + y * (v11 - v10);
    return low + x * (high - low);
}

/* The density of albedo_draw, 1/sr. */
static inline float albedo_density(const mu_albedo *t, const mu_albedo_side *s, albedo_place at) {
    const int cell = albedo_cell(t, at.a) * t->cells + albedo_cell(t, at.b);
    const float share = s->cumulative[cell] - (cell ? s->cumulative[cell - 1] : 0);
    const float square = (float)(t->cells * t->cells) / 4;
    return fminf(share * square * at.stretch, 0x1p+126f);
}

/* The direction at a place of the square [0, cells]². */
void mu_albedo_direction(const mu_albedo *t, float a, float b, float w[3]);
/* A direction of the lobe. */
void mu_albedo_draw(const mu_albedo *t, const mu_albedo_side *s, float u0, float u1, float w[3]);

/* Scratch memory of mu_albedo_make, and the tables of a definition. */
size_t mu_albedo_scratch(const mu_definition *d);
void mu_albedo_make(const mu_definition *d, mu_albedo *out, void *scratch);
/* E(wo) of the surface of a definition, by its panels (albedo_quadrature.c). */
float albedo_integral_f(const mu_surface_f *surface, const mu_definition *d, const float wo[3]);

#endif
