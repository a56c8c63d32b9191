/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* mirror.c: a surface without microfacets: it reflects, and if it transmits refracts, into one direction each. M times
 * nothing is nothing. */
#include "core/bsdf/distribution.h"

void MU(mirror_sample)(const closure *c, const real u[3], sample *out) {
    const real *wo = c->wo, side = c->side, eta = c->eta;
    *out = (sample){.delta = 1, .pdf = 1, .pdf_reverse = 1, .wm = {0, 0, side}, .eta = 1};
    out->wi[0] = -side * wo[0], out->wi[1] = -side * wo[1], out->wi[2] = side * wo[2];
    real F[3];
    MU(fresnel_eval)(&c->surface->fresnel, eta, wo[2], F);
    if (!c->surface->transmission) {
        for (int k = 0; k < 3; k++) out->weight[k] = F[k];
        return;
    }
    const int reflected = u[2] < F[0];
    out->pdf = out->pdf_reverse = reflected ? F[0] : 1 - F[0];
    const real weight = reflected || c->importance ? 1 : 1 / square(eta);
    for (int k = 0; k < 3; k++) out->weight[k] = weight;
    if (reflected) return;
    const real flat2 = flat_square(wo);
    out->wi[0] = -side * wo[0] / eta, out->wi[1] = -side * wo[1] / eta;
    out->wi[2] = -side * sqrt(larger(square(eta) - flat2, 0)) / eta;
    out->transmitted = 1, out->eta = eta;
}
