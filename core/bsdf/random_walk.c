/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * random_walk.c: the BSDF of walk.c. What meets one facet and is reflected is known exactly; the rest is estimated by one
 * walk per evaluation.
 *
 * f is an unbiased estimate. Its random numbers are a hash of (wo, wi) and of the definition's salt: eval is a
 * deterministic but noisy function of its directions, whose integrals over directions converge to the truth, and whose
 * mean over salts is the true f at one pair of directions. f and its reverse differ by noise alone.
 * pdf is that of single scattering (7 of 8) and of a cosine lobe (1 of 8, on both sides of what transmits): not the
 * density of walks, which nobody knows, but one function of the directions; multiple importance sampling with it is
 * unbiased, since its weights of all strategies add up to 1. `sample` walks; its weight is what is left of the light, its f
 * weight pdf / cos.
 * Transmission with the walk's own masking: heights of both sides exclude each other, G2 = B(1 + Lambda_o, 1 + Lambda_i)
 * (Heitz et al. 2016), not the 1 / (1 + Lambda_o + Lambda_i) of refraction.h.
 * A walk ends after WALK_BOUNCES facets at most; what light is left then is lost.
 */
#include "core/bsdf/multiple.h"

static const double cosine_share = 0.125;

static void mix_pdf(const closure *c, real cos_i, real *pdf, real *reverse) {
    const real share = R(cosine_share), lobe = share * R(INV_PI) * (c->surface->transmission ? R(0.5) : 1);
    *pdf = (1 - share) * *pdf + lobe * cos_i;
    *reverse = (1 - share) * *reverse + lobe * c->wo[2];
}

/* Masking by facets and cliffs over masking by facets alone, of a tilted surface. */
static real cliff_masking(const kernel *full, const closure *c, const real i[3]) {
    const map *m = &c->map;
    if (m->tilt[0] == 0 && m->tilt[1] == 0) return 1;
    const real *w[2] = {c->wo, i};
    real Lambda[2], mean[2];
    map_mean(m, mean);
    for (int k = 0; k < 2; k++) { /* sigma = cos (1 + Lambda) */
        real sigma, lambda;
        full->view(c, w[k], &sigma, &lambda);
        const real cliffs = larger(mean[0] * w[k][0] + mean[1] * w[k][1], 0);
        Lambda[k] = larger(lambda + cliffs, 0) / (m->view_z * larger(w[k][2], REAL_MIN));
    }
    const real masked = full->shadowing(c, i, 0) * (1 + Lambda[0] + Lambda[1]);
    return masked > 0 ? 1 / masked : 0;
}

static int passes_straight(const closure *c) {
    return c->surface->transmission && c->eta == 1;
}

void MU(walk_eval)(const kernel *full, const closure *c, const real wi[3], value *out) {
    real i[3];
    const int transmitted = closure_turn(c, wi, i);
    full->eval(c, wi, out);
    if (!(i[2] > 0) || passes_straight(c) || (transmitted && !c->surface->transmission)) return;
    real more[3];
    const real once = transmitted ? 0 : cliff_masking(full, c, i),
               radiance = closure_transport(c, transmitted);
    MU(walk_estimate)(full, c, multiple_of(c->surface), wi, transmitted ? 1 : MUTANT(17, 1, 2), WALK_BOUNCES, more);
    for (int k = 0; k < 3; k++) out->f[k] = smaller(out->f[k] * once + more[k] * radiance, REAL_MAX);
    mix_pdf(c, i[2], &out->pdf, &out->pdf_reverse);
}

/* Nothing is bent or reflected where the index does not change: straight through. */
static void sample_straight(const closure *c, sample *out) {
    *out = (sample){.delta = 1, .transmitted = 1, .pdf = 1, .pdf_reverse = 1, .weight = {1, 1, 1}, .eta = 1};
    for (int k = 0; k < 3; k++) out->wi[k] = -c->side * c->wo[k], out->wm[k] = k < 2 ? 0 : c->side;
}

void MU(walk_sample)(const kernel *full, const closure *c, mu_sampler sampler, const real u[3], sample *out) {
    (void)sampler; /* the walk is one */
    if (passes_straight(c)) {
        sample_straight(c, out);
        return;
    }
    *out = (sample){.rejected = 1, .eta = 1};
    walk_end end;
    MU(walk_trace)(full, c, multiple_of(c->surface), u, &end);
    for (int k = 0; k < 3; k++) out->wm[k] = c->side * end.m[k];
    if (!(end.i[2] > 0)) return;
    const real turn = end.transmitted ? -c->side : c->side, radiance = closure_transport(c, end.transmitted);
    value v;
    for (int k = 0; k < 3; k++) out->wi[k] = turn * end.i[k];
    full->eval(c, out->wi, &v);
    mix_pdf(c, end.i[2], &v.pdf, &v.pdf_reverse);
    for (int k = 0; k < 3; k++) {
        out->weight[k] = end.weight[k] * radiance;
        out->f[k] = smaller(out->weight[k] * (v.pdf / end.i[2]), REAL_MAX);
    }
    out->pdf = v.pdf, out->pdf_reverse = v.pdf_reverse;
    out->transmitted = end.transmitted, out->eta = end.transmitted ? c->eta : 1;
    out->rejected = 0;
}
