/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* fit_blame.c: what the shares of facets show that no candidate explains: harmonics of the azimuth, all facets or ring
 * by ring, or the steepness alone. */
#include <math.h>
#include <stdio.h>

#include "core/surface/fit.h"

static const double two_pi = 6.28318530717958647693;

typedef struct mu_wave {
    double amplitude, degrees; /* of share(phi) = (1 + amplitude cos m (phi - degrees)) / bins */
} mu_wave;

static mu_wave wave(const double *share, uint32_t bins, int m) {
    double x = 0, y = 0, all = 0;
    for (uint32_t k = 0; k < bins; k++) {
        const double angle = m * two_pi * (k + 0.5) / bins;
        x += share[k] * cos(angle), y += share[k] * sin(angle), all += share[k];
    }
    return (mu_wave){all > 0 ? 2 * hypot(x, y) / all : 0, atan2(y, x) / m * 360 / two_pi};
}

void mu_fit_blame(const mu_fitted *f, double tolerance, char reason[MU_REASON]) {
    const mu_residual *r = &f->residual;
    mu_wave skew = {0, 0}, lobe = {0, 0};
    int lobes = 0;
    for (int ring = 0; ring < MU_JOINT_RINGS; ring++) {
        const mu_wave w = wave(r->joint.share + ring * MU_JOINT_SECTORS, MU_JOINT_SECTORS, 1);
        if (w.amplitude > skew.amplitude) skew = w;
    }
    for (int m = 2; m <= MU_HARMONICS; m++) {
        const mu_wave w = wave(r->azimuth.share, MU_SHARES, m);
        if (w.amplitude > lobe.amplitude) lobe = w, lobes = m;
    }
    const double turn = f->told.rotation * 360 / two_pi;
    const mu_partition *worst = r->steepness.variation > r->azimuth.variation ? &r->steepness : &r->azimuth;
    if (r->joint.variation > worst->variation) worst = &r->joint;
    const int head =
        snprintf(reason, MU_REASON,
                 "no candidate explains the facets: best is %s, which misplaces %.1f %% of them "
                 "(tolerance %.1f %%, scatter %.1f %%); ",
                 f->candidate->name, 100 * worst->variation, 100 * tolerance, 100 * worst->noise);
    char *rest = reason + head;
    const size_t room = MU_REASON - (size_t)head;
    /* A wave of amplitude a misplaces a/pi of the facets; a skew that is met in one ring in five as much of that ring. */
    if (lobe.amplitude > skew.amplitude && lobe.amplitude / 3.14 > r->steepness.variation / 2)
        snprintf(rest, room, "%s: their azimuth has %d lobes, one toward %.0f degrees, of amplitude %.2f",
                 lobes == 2 ? "two-lobed" : "many-lobed", lobes, lobe.degrees + turn, lobe.amplitude);
    else if (skew.amplitude / 3.14 > r->steepness.variation / 2)
        snprintf(rest, room, "skewed: about the same mean, more of some steepness face %.0f degrees, by %.2f",
                 skew.degrees + turn, skew.amplitude);
    else
        snprintf(rest, room,
                 "their steepness is of another kind: the flattest twentieth holds %.1f %%, the middle tenth "
                 "%.1f %%, "
                 "the steepest twentieth %.1f %%",
                 100 * r->steepness.share[0], 100 * (r->steepness.share[9] + r->steepness.share[10]),
                 100 * r->steepness.share[MU_SHARES - 1]);
}
