/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * visible.h: the micronormals that a view sees, as a disk, and how the mirror at them stretches that disk. In float.
 *
 * Any linear surface of GGX is the image of one of roughness 1, whose micronormals m' are those of a hemisphere: with the slopes
 * s = S s' + mean, S = sqrt(2) Sigma^1/2, a micronormal is along n = (S m'.xy - mean m'.z, m'.z), and the view is along
 * w = (S^T wo.xy, wo.z - mean.wo.xy), so that n.wo = m'.w. What is seen of the hemisphere from w is half a disk and half an
 * ellipse (Heitz 2018, "Sampling the GGX distribution of visible normals"), all of it seen alike: uniform on that area are the
 * visible micronormals. The whole disk goes there by (x, y) -> (x, (1 - h) sqrt(1 - x²) + h y), h = (1 + cos w) / 2.
 */
#ifndef MU_IBL_VISIBLE_H
#define MU_IBL_VISIBLE_H

#include "core/ibl/ibl.h"

#include "core/bsdf/real.h"

typedef struct visible {
    float s[2][2];          /* columns of S */
    float mean[2], wo[3];
    float w[3], length;     /* a unit vector, and what it was divided by */
    float x[3], y[3];       /* of the disk: across, and up */
    float half;             /* h */
} visible;

/* n of an m'. */
static inline void visible_normal(const visible *f, const float m[3], float n[3]) {
    n[0] = f->s[0][0] * m[0] + f->s[1][0] * m[1] - f->mean[0] * m[2];
    n[1] = f->s[0][1] * m[0] + f->s[1][1] * m[1] - f->mean[1] * m[2];
    n[2] = m[2];
}

HOT void visible_of(const mu_ibl_lobe_f *l, const float wo[3], visible *f) {
    const float root2 = 1.41421356237309504880f, most = 1e6f; /* beyond, squares of squares would overflow */
    const float u = smaller(root2 * l->sigma[0], most), v = smaller(root2 * l->sigma[1], most);
    f->s[0][0] = l->turn[0] * u, f->s[0][1] = l->turn[1] * u;
    f->s[1][0] = -l->turn[1] * v, f->s[1][1] = l->turn[0] * v;
    for (int k = 0; k < 2; k++) f->mean[k] = larger(-most, smaller(l->mean[k], most));
    for (int k = 0; k < 3; k++) f->wo[k] = wo[k];
    for (int k = 0; k < 2; k++) f->w[k] = f->s[k][0] * wo[0] + f->s[k][1] * wo[1];
    f->w[2] = wo[2] - f->mean[0] * wo[0] - f->mean[1] * wo[1];
    /* its largest part first made 1: of a view along the horizon squares may be 0 in float. No branches, and no root that waits for
     * another: views are worked out several at a time */
    const float part = larger(larger(fabs(f->w[0]), fabs(f->w[1])), fabs(f->w[2])), scale = larger(part, REAL_MIN), grown = 1 / scale;
    for (int k = 0; k < 3; k++) f->w[k] *= grown;
    f->w[2] = part > 0 ? f->w[2] : 1;
    const float square = f->w[0] * f->w[0] + f->w[1] * f->w[1], flat = sqrt(square), across = 1 / flat;
    const float length = sqrt(square + f->w[2] * f->w[2]), whole = 1 / length;
    f->length = length * (part > 0 ? scale : 0);
    f->x[0] = flat > 0 ? -f->w[1] * across : 1, f->x[1] = flat > 0 ? f->w[0] * across : 0, f->x[2] = 0;
    for (int k = 0; k < 3; k++) f->w[k] *= whole;
    f->y[0] = -f->w[2] * f->x[1], f->y[1] = f->w[2] * f->x[0], f->y[2] = flat * whole; /* w x (x, y, 0) */
    f->half = (1 + f->w[2]) / 2;
}

/* How far the mirrored view moves as the middle of the whole disk does: half-axes, `major` and `ratio` times that, of the ellipse that
 * its rim would become, and the direction on the disk that goes to the first; `normal`, |n| there. A ratio of 1 where none has length. */
typedef struct stretched {
    float major, ratio, turn[2], normal;
} stretched;

HOT void stretched_middle(const visible *f, stretched *e) {
    const float up = 1 - f->half, lift = sqrt(larger(1 - up * up, REAL_EPSILON));
    float m[3], d[2][3], n[3], moved[2][3], along[2];
    const float fall = up / lift;
    for (int k = 0; k < 3; k++) {
        m[k] = up * f->y[k] + lift * f->w[k];
        d[0][k] = f->x[k], d[1][k] = f->half * (f->y[k] - fall * f->w[k]);
    }
    visible_normal(f, m, n);
    const float squared = dot(n, n), inverse = 1 / squared, cosine = dot(n, f->wo);
    e->normal = sqrt(squared);
    for (int i = 0; i < 2; i++) {
        visible_normal(f, d[i], moved[i]);
        const float stays = dot(moved[i], n) * inverse;
        for (int k = 0; k < 3; k++) moved[i][k] -= stays * n[k];
        along[i] = dot(moved[i], f->wo);
    }
    /* of r = 2 (n.wo) n - wo, n a unit vector: dr.dr' = 4 ((n.wo)² dn.dn' + (dn.wo)(dn'.wo)) */
    float g[3];
    for (int k = 0; k < 3; k++) {
        const int i = k / 2, j = (k + 1) / 2;
        g[k] = 4 * inverse * (cosine * cosine * inverse * dot(moved[i], moved[j]) + along[i] * along[j]);
    }
    const float half = (g[0] - g[2]) / 2, apart = sqrt(half * half + g[1] * g[1]), large = (g[0] + g[2]) / 2 + apart;
    const float c = apart > 0 ? half / apart : 1, shrunk = 1 / large;
    e->turn[0] = sqrt(larger((1 + c) / 2, 0)), e->turn[1] = copysign(sqrt(larger((1 - c) / 2, 0)), g[1]);
    e->major = sqrt(large);
    const float ratio = sqrt(larger((g[0] * g[2] - g[1] * g[1]) * shrunk * shrunk, 0));
    e->ratio = large > 0 ? ratio : 1;
}

#endif
