/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * reflection.h: f = F D G2 / (4 cos_o cos_i) (Cook & Torrance 1982; Walter et al. 2007, Eq. (20)) with its two pdfs: the density of
 * normals, Eq. (27) or D cos, over 4 wo.wm (Walter et al. 2007, Eq. (14) and (38)). Part of transformed.h. i is the light's direction as
 * seen from the side of wo: i.z > 0.
 */

/* The densities of the reflected direction by the surface's sampler: D / 4 and all that shadowing shares are at hand.
 * Returns the one that its normals alone would have. */
static inline real reflection_pdf(plan_kind plan, const closure *c, mu_sampler sampler, real quarter_d,
                                  real over_cos_oh, const real i[3], real sigma_i, real choice, real *pdf,
                                  real *reverse) {
    const real scale = c->map.view_z;
    if (MUTANT(5, 1, draws_all(sampler))) {
        *pdf = *reverse = smaller(quarter_d * smaller(over_cos_oh, saturated) * choice, saturated);
    } else {
        const real shown_o = c->sigma - bounded_less(c, sampler, c->wo),
                   shown_i = sigma_i - bounded_less(c, sampler, i);
        *pdf = smaller(quarter_d * (scale / larger(shown_o, REAL_MIN)) * choice, saturated);
        *reverse = smaller(quarter_d * (scale / larger(shown_i, REAL_MIN)) * choice, saturated);
    }
    const real own = *pdf;
    if (plan == PLAN_FULL && folds(sampler)) {
        *pdf = smaller(*pdf + MUTANT(14, 0, folded_density(plan, c, c->wo, i, c->sigma)), saturated);
        *reverse = smaller(*reverse + folded_density(plan, c, i, c->wo, sigma_i), saturated);
    }
    if (plan == PLAN_FULL && mixes(sampler)) { /* Appendix B: the balance heuristic */
        const real share = c->surface->uniform_share, uniform = share * R(INV_PI / 2);
        *pdf = (1 - share) * *pdf + uniform;
        *reverse = (1 - share) * *reverse + uniform;
    }
    return own;
}

HOT void reflection_eval(plan_kind plan, const closure *c, mu_sampler sampler, const real i[3], value *out) {
    *out = (value){0};
    if (!(i[2] > 0)) return;
    real h[3] = {c->wo[0] + i[0], c->wo[1] + i[1], c->wo[2] + i[2]};
    real h2 = dot(h, h);
    if (h2 < R(0.25)) h2 = sharpen(c->wo, i, h, h2);
    const real sum2 = h2;
    for (int k = 0; h2 < R(1e-24) && k < 32; k++) { /* i = -wo but for rounding: h² must not underflow */
        for (int j = 0; j < 3; j++) h[j] *= R(0x1p60);
        h2 = dot(h, h);
    }
    const real quarter_d = transformed_density(plan, c, h, h2) / 4;
    real sigma_i, lambda_i;
    view_of(plan, c, i, &sigma_i, &lambda_i);
    const real scale = c->map.view_z;
    real f =
        smaller(quarter_d * smaller(scale / larger(unshadowed(plan, c, i, sigma_i, lambda_i, 0), REAL_MIN),
                                    saturated),
                saturated);
    if (plan == PLAN_FULL) f = smaller(f * glint(plan, c, h, h2), saturated);
    real F[3];
    fresnel_of(c, sqrt(sum2) / 2, F); /* wo.wm = |h| / 2 */
    for (int k = 0; k < 3; k++) out->f[k] = F[k] * f;
    const real choice = plan == PLAN_FULL && c->surface->transmission ? MUTANT(13, 1, F[0]) : 1;
    reflection_pdf(plan, c, sampler, quarter_d, h[2] / (sqrt(h2) * sqrt(sum2) / 2), i, sigma_i, choice,
                   &out->pdf, &out->pdf_reverse);
}
