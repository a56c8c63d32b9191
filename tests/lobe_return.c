/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* lobe_return.c: the mean of lobe_return.h, at the points of a sequence that fills the square evenly (Roberts 2018). */
#include "tests/lobe_return.h"

#include <math.h>

#include "core/bsdf/albedo_set.h"

double lobe_return(const mu_closure_f *c, int draws, double *off) {
    const mu_lobe *l = &c->lobe;
    const int from = c->side<0, sides = l->passes[from]> 0 ? 2 : 1;
    double halves[2] = {0, 0}, u0 = 0.5, u1 = 0.5;
    for (int side = 0; side < sides; side++) {
        const int to = from ^ side;
        const double share = (double)(side ? l->passes[from] : 1 - l->passes[from]);
        for (int i = 0; i < draws; i++) {
            float w[3], density;
            u0 = fmod(u0 + 0.7548776662466927, 1), u1 = fmod(u1 + 0.5698402909980532, 1);
            lobe_draw(l, to, (float)fmin(u0, 0.9999999), (float)u1, w);
            const double lost = (double)lobe_lost(l, to, w, &density),
                         length = sqrt((double)(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
            if (density > 0)
                halves[2 * i >= draws] += share * lost * (double)w[2] / length /
                                          (3.14159265358979324 * (double)l->average[to] * (double)density) /
                                          draws;
        }
    }
    if (off) *off = 2 * fabs(halves[0] - halves[1]);
    return halves[0] + halves[1];
}
