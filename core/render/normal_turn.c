/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* normal_turn.c: see normal_turn.h. Slopes (dz/dx, dz/dy) in the frame of shading; in double. Nothing here allocates. */
#include "core/render/normal_turn.h"

#include <string.h>

#include "core/render/covariance.h"

#define MATCHED 0.81093021621632876 /* -2 ln(2/3): a third of Gaussian slopes are within the root of this, in deviations, of 1/2 */

/* The lower triangle of what stands for a material's slopes before M; false: there is nothing to widen. */
static _Bool root_of(const mu_normal_map *map, const musurf_material *compiled, double root[3], double mean[2]) {
    static const double still[4] = {1, 0, 0, 1};
    musurf_moments s;
    if (map->slopes->moments(compiled, still, &s) != MUSURF_OK || !(s.xx > 0 && s.yy > 0)) return 0;
    root[0] = sqrt(s.xx), root[1] = s.xy / root[0], root[2] = sqrt(fmax(s.yy - root[1] * root[1], 0));
    mean[0] = s.mean[0], mean[1] = s.mean[1];
    return root[2] > 0;
}

void mu_normal_map_bind(mu_normal_map *map, const mu_material *material) {
    const musurf_material_type *type = material->type;
    double root[3], mean[2];
    float m[4], slots[MU_SLOTS] = {[MU_SLOT_TRANSFORM] = 1, [MU_SLOT_TRANSFORM + 3] = 1};
    map->slopes = type->extension ? type->extension(MUSURF_SLOPES_ID) : NULL;
    map->map = type->extension ? type->extension(MUSURF_MAP_ID) : NULL;
    if (map->slopes && map->map && map->map->size >= sizeof *map->map && map->placement.filtered &&
        root_of(map, material->compiled, root, mean) && map->map->compose(material->compiled, slots, m))
        return;
    map->slopes = NULL, map->map = NULL;
}

/* What of the slope's length can be had without mirroring `w`, whose z is positive, into the surface. With the normal (-s, 1)
 * not normalised the mirrored direction's z is 2 (w.z - s.w) / (1 + s^2) - w.z, and that is 0 at this share of s. */
static double bearable(const double s[2], const double w[3]) {
    const double along = s[0] * w[0] + s[1] * w[1], square = s[0] * s[0] + s[1] * s[1];
    if (!(2 * (w[2] - along) < w[2] * (1 + square))) return 1;
    return w[2] / (along + sqrt(along * along + w[2] * w[2] * square));
}

/* The frame turned by a slope in it; false: it stays as it is. */
static _Bool turn(mu_shading *shading, mu_vec3 wo, const double slope[2]) {
    const mu_frame *f = &shading->frame;
    const double side = shading->wo[2] < 0 ? -1 : 1;
    const double w[3] = {side * (double)shading->wo[0], side * (double)shading->wo[1], side * (double)shading->wo[2]};
    const double part = bearable(slope, w);
    const float x = (float)(part * slope[0]), y = (float)(part * slope[1]);
    if (x == 0 && y == 0) return 0;
    const mu_vec3 n = mu_normalise(mu_sub(f->n, mu_add(mu_scale(f->t, x), mu_scale(f->b, y))));
    const mu_frame turned = mu_shading_frame(n, f->t);
    const mu_vec3 local = mu_to_local(&turned, wo);
    if (!((double)local.z * side > 0)) return 0; /* by rounding, at the very horizon */
    shading->frame = turned;
    shading->wo[0] = local.x, shading->wo[1] = local.y, shading->wo[2] = local.z;
    return 1;
}

/* K K^T of K = M^-T root. */
static void covariance_under(const double root[3], const double m[4], double out[3]) {
    const double det = m[0] * m[3] - m[1] * m[2], inverse[4] = {m[3] / det, -m[1] / det, -m[2] / det, m[0] / det};
    const double ax = inverse[0] * root[0] + inverse[2] * root[1], bx = inverse[2] * root[2],
                 ay = inverse[1] * root[0] + inverse[3] * root[1], by = inverse[3] * root[2];
    out[0] = ax * ax + bx * bx, out[1] = ax * ay + bx * by, out[2] = ay * ay + by * by;
}

/* r of normal_turn.h, by the mean of the axes in which both are round. */
static double part_of(const double own[3], const double more[3]) {
    const double det = own[0] * own[2] - own[1] * own[1];
    const double ratio = MATCHED * (own[2] * more[0] - 2 * own[1] * more[1] + own[0] * more[2]) / (2 * det);
    return ratio < 1e30 ? ratio / (1 + ratio) : 1;
}

/* The M that has `all` instead: m = N root^T of N whose covariance is K K^T, and N again of its new one. */
static void widened(const double root[3], const double m[4], const double all[3], double out[4]) {
    /* root^-T = (1/a, -b/(a c); 0, 1/c) of root = (a, 0; b, c) */
    const double a = root[0], b = root[1], c = root[2];
    const double n[4] = {m[0] / a, (m[1] - m[0] * b / a) / c, m[2] / a, (m[3] - m[2] * b / a) / c};
    double wide[4];
    mu_covariance_map(all, n, wide);
    out[0] = wide[0] * a, out[1] = wide[0] * b + wide[1] * c;
    out[2] = wide[2] * a, out[3] = wide[2] * b + wide[3] * c;
}

/* Of slopes in one frame to those about their mean in another, to first order: n.t' / n.m of n = (-s, 1). */
static void in_frame(const mu_frame *from, const mu_frame *to, double c[3]) {
    const double n = (double)mu_dot(to->n, from->n);
    const double txx = n * (double)mu_dot(to->t, from->t), txy = n * (double)mu_dot(to->t, from->b),
                 tyx = n * (double)mu_dot(to->b, from->t), tyy = n * (double)mu_dot(to->b, from->b);
    const double xx = c[0], xy = c[1], yy = c[2];
    c[0] = txx * txx * xx + 2 * txx * txy * xy + txy * txy * yy;
    c[1] = txx * tyx * xx + (txx * tyy + txy * tyx) * xy + txy * tyy * yy;
    c[2] = tyx * tyx * xx + 2 * tyx * tyy * xy + tyy * tyy * yy;
}

/* The picture's axes to those of the frame: v runs along b or against it, and from behind z is the other way. */
static void in_shading(const mu_shading *shading, _Bool turned, double mean[2], double c[3]) {
    const mu_hit *hit = shading->hit;
    const _Bool against = mu_dot(mu_cross(hit->dpdu, hit->dpdv), hit->ng) < 0;
    if (turned) mean[0] = -mean[0];
    if (against) mean[1] = -mean[1];
    if (turned != against) c[1] = -c[1];
}

/* The whole M of a hit in m[0..3]; false: it cannot be told, or is singular. */
static _Bool whole_map(const mu_shading *shading, const mu_normal_map *map, double m[4]) {
    float composed[4];
    const float *at = shading->slots + MU_SLOT_TRANSFORM;
    if (!shading->map) {
        if (!shading->pushed || !map->map->compose(shading->compiled, shading->pushed, composed)) return 0;
        at = composed;
    }
    for (int i = 0; i < 4; i++) m[i] = (double)at[i];
    const double det = m[0] * m[3] - m[1] * m[2];
    return det * det > 0 && det * det <= 1e300;
}

/* What is seen at once, made small enough to be one lobe. */
static void look(const mu_normal_map *map, const mu_shading *shading, _Bool turned, const float footprint[6], double trust,
                 const double own[3], double mean[2], double c[3]) {
    for (double share = 1;; share /= 2) {
        mu_normal_map_at(map, footprint, share, 0, mean, c);
        in_shading(shading, turned, mean, c);
        const double part = part_of(own, c);
        if (part * (1 - part) <= trust || share < 0x1p-20) return;
        if (!isfinite(footprint[2] + footprint[3] + footprint[4] + footprint[5])) return;
    }
}

void mu_normal_turn(mu_shading *shading, const mu_material *material, const mu_beam *beam, mu_vec3 wo, _Bool turned) {
    const mu_normal_map *map = material->normal_map;
    const mu_frame before = shading->frame;
    const double share = beam ? (double)beam->share : 1, side = shading->wo[2] < 0 ? -1 : 1;
    float footprint[6] = {shading->hit->uv[0], shading->hit->uv[1], INFINITY, INFINITY, INFINITY, INFINITY};
    double mean[2], c[3] = {0, 0, 0}, m[4], own[3], root[3], lean[2];
    const _Bool wide = map->map && whole_map(shading, map, m) && root_of(map, shading->compiled, root, lean);
    if (!wide) {
        mu_normal_map_at(map, footprint, 1, 1, mean, c);
        in_shading(shading, turned, mean, c);
        turn(shading, wo, mean);
        return;
    }
    if (beam) mu_footprint_at(shading->hit, mu_scale(wo, -1), beam, footprint);
    for (int i = 2; i < 6; i++) footprint[i] *= (float)share;
    covariance_under(root, m, own);
    look(map, shading, turned, footprint, MU_NORMAL_TRUST * share * share, own, mean, c);
    if (c[0] + c[2] > 0) {
        const double w[2] = {side * (double)shading->wo[0], side * (double)shading->wo[1]};
        const double x = c[0] * w[0] + c[1] * w[1], y = c[1] * w[0] + c[2] * w[1];
        const double reach = fabs((double)shading->wo[2]) + sqrt(fmax(x * w[0] + y * w[1], 0));
        mean[0] += x / reach, mean[1] += y / reach;
    }
    turn(shading, wo, mean);
    if (!(c[0] + c[2] > 0)) return;
    double all[3], out[4];
    in_frame(&before, &shading->frame, c);
    for (int k = 0; k < 3; k++) all[k] = own[k] + MATCHED * c[k];
    widened(root, m, all, out);
    for (int i = 0; i < 4; i++)
        if (!(fabs(out[i]) <= 1e18)) return;
    for (int i = 0; i < 4; i++) shading->slots[MU_SLOT_TRANSFORM + i] = (float)out[i];
    shading->map = map->map;
    if (lean[0] == 0 && lean[1] == 0) return;
    /* M' has leaned the material's own mean slope less than M did: the frame makes up for it */
    const double was = m[0] * m[3] - m[1] * m[2], is = out[0] * out[3] - out[1] * out[2];
    const double rest[2] = {(m[3] * lean[0] - m[2] * lean[1]) / was - (out[3] * lean[0] - out[2] * lean[1]) / is,
                            (m[0] * lean[1] - m[1] * lean[0]) / was - (out[0] * lean[1] - out[1] * lean[0]) / is};
    turn(shading, wo, rest);
}
