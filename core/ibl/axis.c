/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * axis.c: the major axis of a lobe, and the samples on it (Sections 5.3 to 5.7). Computed in the frame of U, V and the
 * normal; what is handed out is in that of wo. Angles in radians.
 *
 * The axis is an arc of a great circle through the normal (Section 5.4), so that all its points, the samples too, are angles
 * in one plane: the clamped ends stand at atan T (clamp.h), `half` to either side of their middle. An interpolation between
 * unit vectors at -half and half is (p, q u) in the frame of the middle, u from 1 to -1, p and q those of the ends.
 */
#include "core/ibl/clamp.h"
#include "core/ibl/ibl.h"
#include "core/ibl/width.h"

typedef MU(mu_ibl_lobe) lobe;
typedef MU(mu_ibl_settings) settings;
typedef MU(mu_ibl_axis) axis;

/* Beyond, sums of two would overflow. */
#define STEEPEST (REAL_MAX / 4)

settings MU(mu_ibl_settings_default)(void) {
    return (settings){1, R(2.3), 16, MU_IBL_SYMMETRIC};
}

static void turn_back(const lobe *l, real x, real y, real out[2]) {
    out[0] = l->turn[0] * x - l->turn[1] * y;
    out[1] = l->turn[1] * x + l->turn[0] * y;
}

/* The micronormals of a slope of the lobe's frame and of its opposite, and half the way from one to the other. */
static void both_normals(const lobe *l, real x, real y, real out[2][3]) {
    const real length = length2(R(1), length2(x, y));
    turn_back(l, -x / length, -y / length, out[0]);
    out[1][0] = -out[0][0], out[1][1] = -out[0][1];
    out[0][2] = out[1][2] = 1 / length;
}

/* Appendix C. */
static real shift_of(mu_ibl_shift shift, const clamped *c, real apart) {
    const real first = smaller(larger(c->tau[0], 0), 1), second = smaller(larger(c->tau[1], 0), 1);
    return (shift == MU_IBL_SYMMETRIC ? c->skew : first > 0 ? first : second - 1) * apart;
}

/* Appendix D, and what Eq. (9) needs: where the outermost samples are, from the middle of the ends' angles. */
static void place_samples(const real cut[2], axis *out) {
    const real first = atan(cut[0]), second = atan(cut[1]), middle = (first + second) / 2,
               half = (first - second) / 2;
    out->middle[0] = sin(middle), out->middle[1] = cos(middle);
    /* (1 - zeta) middle + zeta end; 0 at zeta = 1 and ends that are opposite */
    out->reach[0] = larger(1 - out->zeta * (1 - cos(half)), REAL_EPSILON);
    out->reach[1] = out->zeta * sin(half);
}

/* `whole`: with the points and their parameters. */
static inline void make(const lobe *l, const real wo[3], const settings *s, int whole, axis *out) {
    const real r[2] = {smaller(s->k * l->sigma[0], STEEPEST), smaller(s->k * l->sigma[1], STEEPEST)};
    const real o[3] = {l->turn[0] * wo[0] + l->turn[1] * wo[1], l->turn[0] * wo[1] - l->turn[1] * wo[0],
                       larger(wo[2], 0)};
    extremum nearest, farthest;
    extrema_of(r, o, &nearest, &farthest);
    const real x = r[0] * farthest.cosine, y = r[1] * farthest.sine, steep = length2(x, y);
    if (whole) {
        both_normals(l, r[0] * nearest.cosine, r[1] * nearest.sine, out->near);
        both_normals(l, x, y, out->far);
    }

    /* the axis' plane: the first end's side, to which the micronormal leans against its slope */
    const real side[2] = {steep > 0 ? -x / steep : -farthest.cosine, steep > 0 ? -y / steep : -farthest.sine};
    turn_back(l, side[0], side[1], out->along);
    const real forward = steep > 0 ? -farthest.p / steep : side[0] * o[0] + side[1] * o[1];
    const clamped c = clamp_axis(forward, o[2], steep);
    real lean[2], rise[2];
    for (int end = 0; end < 2; end++) {
        const real length = length2(R(1), c.cut[end]);
        out->tau[end] = c.tau[end], lean[end] = c.cut[end] / length, rise[end] = 1 / length;
        for (int i = 0; i < 2; i++) out->far_clamped[end][i] = out->along[i] * lean[end];
        out->far_clamped[end][2] = rise[end];
    }

    out->delta = 0;
    if (whole || c.skew != 0) {
        out->t[0] = atan2(nearest.sine, nearest.cosine);
        out->t[1] = atan2(farthest.sine, farthest.cosine);
        out->delta = shift_of(s->shift, &c, out->t[0] - out->t[1]);
    }
    out->width = shifted_width(r, o, &nearest, out->delta);
    /* both reflect within a plane that holds but a part of the view: twice that times the sine of the angle between */
    out->length = 2 * length2(forward, o[2]) * (lean[0] * rise[1] - rise[0] * lean[1]);
    out->zeta = out->length > 0 ? larger(1 - out->width / out->length, -STEEPEST) : 0;
    out->radius = smaller(larger(out->width / (2 * s->k), s->beta / (2 * (real)s->samples) * out->length),
                          STEEPEST); /* Eq. (10) */
    place_samples(c.cut, out);
}

void MU(mu_ibl_axis_make)(const lobe *l, const real wo[3], const settings *s, axis *out) {
    make(l, wo, s, 1, out);
}

void MU(mu_ibl_axis_make_for_samples)(const lobe *l, const real wo[3], const settings *s, axis *out) {
    make(l, wo, s, 0, out);
}

void MU(mu_ibl_axis_batch)(size_t count, const lobe *lobes, size_t lobe_stride, const real *wo,
                           size_t wo_stride, const settings *s, axis *out) {
    for (size_t i = 0; i < count; i++)
        MU(mu_ibl_axis_make)(lobes + i * lobe_stride, wo + i * wo_stride, s, out + i);
}

void MU(mu_ibl_axis_sample)(const axis *a, size_t samples, size_t j, real micronormal[3]) {
    const real step = samples > 1 ? 1 - 2 * ((real)j / (real)(samples - 1)) : 0;
    const real p = a->reach[0], q = step * a->reach[1], length = length2(p, q);
    const real lean = (p * a->middle[0] + q * a->middle[1]) / length;
    micronormal[0] = lean * a->along[0];
    micronormal[1] = lean * a->along[1];
    micronormal[2] = (p * a->middle[1] - q * a->middle[0]) / length;
}

real MU(mu_ibl_level)(real radius, size_t levels) {
    return levels > 1 ? smaller(sqrt(larger(radius, 0)), 1) * (real)(levels - 1) : 0;
}
