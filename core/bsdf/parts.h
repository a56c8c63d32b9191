/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * parts.h: visible normals of any isotropic distribution, from draws of its slope's length alone. Not in the paper.
 *
 * From w = (r, 0, z) a slope of length t and azimuth phi shows the area max(0, z + r t cos phi), which lies below
 * z + r t max(0, cos phi): a part with the density of D cos, and one with that times t, cos phi. What the envelope has
 * more than the area is where cos phi < 0 only: at least half of the draws are accepted from every direction above the
 * horizon. From below, z < 0 (a tilted surface asks that), the second part alone lies above, and accepts fewer.
 */
#ifndef MU_PARTS_H
#define MU_PARTS_H

#include "core/bsdf/cap.h"
#include "core/bsdf/random.h"

/* A slope's length as a quotient, part[0] / part[1]. */
typedef struct parts {
    real horizon; /* sigma at the horizon: the mean of t, over pi */
    void (*plain)(const base *b, real u, real part[2]);
    void (*by_length)(const base *b, random_stream *more, real part[2]); /* density times t */
} parts;

/* A normal by D cos, whose slope has this length. */
static inline void slope_by_parts(void (*plain)(const base *, real, real[2]), const base *b, const real u[3],
                                  real n[3]) {
    real part[2];
    plain(b, u[0], part);
    slope_normal(part[0], part[1], u[1], n);
}

static inline void visible_by_parts(const parts *p, const base *b, const real w[3], const real u[3],
                                    real n[3]) {
    random_stream more = random_start(u);
    const real r = sqrt(flat_square(w)), z = w[2];
    const real along[2] = {r > 0 ? w[0] / r : 1, r > 0 ? w[1] / r : 0};
    const real first = larger(z, 0), total = first + r * p->horizon;
    real u0 = u[0], u1 = u[1], pick = u[2];
    for (int k = 0; k < (z < 0 ? FROM_BELOW : 1024); k++) {
        real part[2], sine, cosine, shown = 1;
        const int plain = pick * total < first;
        if (plain) {
            p->plain(b, u0, part);
            sine = sin(R(2 * PI) * u1), cosine = cos(R(2 * PI) * u1);
            if (cosine < 0) shown = (z * part[1] + r * part[0] * cosine) / (z * part[1]);
        } else {
            p->by_length(b, &more, part);
            sine = 2 * u1 - 1, cosine = sqrt((1 - sine) * (1 + sine));
            if (z < 0) shown = (z * part[1] + r * part[0] * cosine) / (r * part[0] * cosine);
        }
        n[0] = part[0] * (along[0] * cosine - along[1] * sine);
        n[1] = part[0] * (along[1] * cosine + along[0] * sine);
        n[2] = part[1];
        if (shown >= 1 || random_next(&more) < shown) return;
        u0 = random_next(&more), u1 = random_next(&more), pick = random_next(&more);
    }
}

/* t = e^ln_t as a quotient whose larger part is 1. */
static inline void part_from_log(real ln_t, real part[2]) {
    part[0] = ln_t > 0 ? 1 : exp(ln_t);
    part[1] = ln_t > 0 ? exp(-ln_t) : 1;
}

#endif
