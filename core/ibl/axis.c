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

#include <string.h>

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
    const real length = length3(x, y, 1);
    turn_back(l, -x / length, -y / length, out[0]);
    out[1][0] = -out[0][0], out[1][1] = -out[0][1];
    out[0][2] = out[1][2] = 1 / length;
}

/* Appendix C. */
static real shift_of(mu_ibl_shift shift, const clamped *c, real apart) {
    const real first = smaller(larger(c->tau[0], 0), 1), second = smaller(larger(c->tau[1], 0), 1);
    return (shift == MU_IBL_SYMMETRIC ? c->skew : first > 0 ? first : second - 1) * apart;
}

/* Appendix D, and what Eq. (9) needs: where the outermost samples are, from the middle of the ends' angles. The ends' directions are
 * (lean, rise): their middle is along the sum or across the difference, whichever is longer, and these are twice the cosine and
 * the sine of half the angle between. */
static inline void place_samples(const real lean[2], const real rise[2], axis *out) {
    const real sum[2] = {lean[0] + lean[1], rise[0] + rise[1]},
               apart[2] = {lean[0] - lean[1], rise[1] - rise[0]};
    const real twice[2] = {length2(sum[0], sum[1]), length2(apart[0], apart[1])};
    const _Bool near = twice[0] > twice[1];
    const real length = near ? twice[0] : twice[1];
    out->middle[0] = (near ? sum[0] : apart[1]) / length;
    out->middle[1] = (near ? sum[1] : apart[0]) / length;
    /* (1 - zeta) middle + zeta end; 0 at zeta = 1 and ends that are opposite */
    out->reach[0] = larger(1 - out->zeta * (1 - twice[0] / 2), REAL_EPSILON);
    out->reach[1] = out->zeta * (twice[1] / 2);
}

/* An axis while it is made: before Appendix C moves the closest points, which takes angles. The rest is arithmetic, which goes well
 * for several at a time. */
typedef struct begun {
    extremum nearest, farthest;
    clamped c;
    real r[2], o[3], forward, moved[2]; /* moved: sine and cosine of delta */
} begun;

HOT void begin(const lobe *l, const real wo[3], real k, begun *b, axis *out) {
    b->r[0] = smaller(k * l->sigma[0], STEEPEST), b->r[1] = smaller(k * l->sigma[1], STEEPEST);
    b->o[0] = l->turn[0] * wo[0] + l->turn[1] * wo[1], b->o[1] = l->turn[0] * wo[1] - l->turn[1] * wo[0];
    b->o[2] = larger(wo[2], 0);
    extrema_of(b->r, b->o, &b->nearest, &b->farthest);
    const real x = b->r[0] * b->farthest.cosine, y = b->r[1] * b->farthest.sine, steep = length2(x, y);
    /* the axis' plane: the first end's side, to which the micronormal leans against its slope */
    const real side[2] = {steep > 0 ? -x / steep : -b->farthest.cosine,
                          steep > 0 ? -y / steep : -b->farthest.sine};
    turn_back(l, side[0], side[1], out->along);
    b->forward = steep > 0 ? -b->farthest.p / steep : side[0] * b->o[0] + side[1] * b->o[1];
    b->c = clamp_axis(b->forward, b->o[2], steep);
    b->moved[0] = 0, b->moved[1] = 1;
}

/* By an angle from t[1] to t[0]. */
static inline void shift(mu_ibl_shift by, real apart, begun *b, axis *out) {
    out->delta = shift_of(by, &b->c, apart);
    b->moved[0] = sin(out->delta), b->moved[1] = cos(out->delta);
}

/* The same where t is not wanted. Where nothing is cut, delta is 0 whatever the angle. */
static inline void shift_for_samples(mu_ibl_shift by, begun *b, axis *out) {
    const extremum *near = &b->nearest, *far = &b->farthest;
    out->delta = 0;
    if (b->c.skew != 0)
        shift(by,
              atan2(near->sine * far->cosine - near->cosine * far->sine,
                    near->cosine * far->cosine + near->sine * far->sine),
              b, out);
}

HOT void finish(const settings *s, const begun *b, axis *out) {
    real lean[2], rise[2];
    for (int end = 0; end < 2; end++) {
        const real length = length2(R(1), b->c.cut[end]);
        out->tau[end] = b->c.tau[end], lean[end] = b->c.cut[end] / length, rise[end] = 1 / length;
        for (int i = 0; i < 2; i++) out->far_clamped[end][i] = out->along[i] * lean[end];
        out->far_clamped[end][2] = rise[end];
    }
    out->width = shifted_width(b->r, b->o, &b->nearest, b->moved[0], b->moved[1]);
    /* both reflect within a plane that holds but a part of the view: twice that times the sine of the angle between */
    out->length = 2 * length2(b->forward, b->o[2]) * (lean[0] * rise[1] - rise[0] * lean[1]);
    out->zeta = out->length > 0 ? larger(1 - out->width / out->length, -STEEPEST) : 0;
    out->radius = smaller(larger(out->width / (2 * s->k), s->beta / (2 * (real)s->samples) * out->length),
                          STEEPEST); /* Eq. (10) */
    place_samples(lean, rise, out);
}

void MU(mu_ibl_axis_make)(const lobe *l, const real wo[3], const settings *s, axis *out) {
    begun b;
    begin(l, wo, s->k, &b, out);
    both_normals(l, b.r[0] * b.nearest.cosine, b.r[1] * b.nearest.sine, out->near);
    both_normals(l, b.r[0] * b.farthest.cosine, b.r[1] * b.farthest.sine, out->far);
    out->t[0] = atan2(b.nearest.sine, b.nearest.cosine);
    out->t[1] = atan2(b.farthest.sine, b.farthest.cosine);
    shift(s->shift, out->t[0] - out->t[1], &b, out);
    finish(s, &b, out);
}

void MU(mu_ibl_axis_make_for_samples)(const lobe *l, const real wo[3], const settings *s, axis *out) {
    begun b;
    begin(l, wo, s->k, &b, out);
    shift_for_samples(s->shift, &b, out);
    finish(s, &b, out);
}

/* Several of them, number by number: number k of i is in [k][i]. */
enum { BEGUN = sizeof(begun) / sizeof(real) };
HOT void put(const begun *b, size_t i, real (*out)[MU_IBL_AXES]) {
    real each[BEGUN];
    memcpy(each, b, sizeof *b);
    for (size_t k = 0; k < BEGUN; k++) out[k][i] = each[k];
}
HOT void take(const real (*from)[MU_IBL_AXES], size_t i, begun *b) {
    real each[BEGUN];
    for (size_t k = 0; k < BEGUN; k++) each[k] = from[k][i];
    memcpy(b, each, sizeof *b);
}

/* Loops that compilers take several rounds of at a time: over what is local, without calls or branches, a number of times that is known
 * to them. */
void MU(mu_ibl_axes_make)(const lobe *l, const real (*wo)[MU_IBL_AXES], const settings *s,
                          MU(mu_ibl_axes) * out) {
    real several[BEGUN][MU_IBL_AXES];
    const settings own = *s;
    const lobe of = *l;
    MU(mu_ibl_axes) made;
    axis a;
    begun b;
    for (size_t i = 0; i < MU_IBL_AXES; i++) {
        const real o[3] = {wo[0][i], wo[1][i], wo[2][i]};
        begin(&of, o, own.k, &b, &a);
        put(&b, i, several);
        for (int k = 0; k < 2; k++) made.along[k][i] = a.along[k];
    }
    for (size_t i = 0; i < MU_IBL_AXES; i++) {
        take(several, i, &b);
        if (b.c.skew == 0) continue;
        shift_for_samples(own.shift, &b, &a);
        put(&b, i, several);
    }
    for (size_t i = 0; i < MU_IBL_AXES; i++) {
        take(several, i, &b);
        finish(&own, &b, &a);
        for (int k = 0; k < 2; k++) made.middle[k][i] = a.middle[k], made.reach[k][i] = a.reach[k];
        made.radius[i] = a.radius;
    }
    *out = made;
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
