/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * refraction.h: transmission through the microsurface of a dielectric (part of transformed.h). f: Walter et al. 2007,
 * "Microfacet models for refraction through rough surfaces", Eq. (21); Golubev 2024, "On microsurface transformations", Eq. (11f),
 * whose printed factor eta_t²/eta_v² is the wrong way round (against its own Eq. 9c). pdf: visible normals, Eq. (27), times the
 * Jacobian of Walter et al., Eq. (17). G2: height-correlated on both sides (Walter et al. 2014, Eq. (7), multiply both G1).
 * Exact under any map and with tilt.
 *
 * The light comes from the other side. Everything is said of i = -wi, turned over to the side of wo (sigma and G2 are those of
 * i). With eta = n_i / n_o and the unnormalised half-vector H of snell.h,
 *     f = (wo.H)(i.H) (1 - F) G2 D(H) / (cos_o cos_i |H|^4),      radiance;  eta² times that is importance
 *     pdf = D(H) (1 - F) (wo.H)(i.H) eta² / (sigma_o |H|^4),      pdf_reverse = D(H) (1 - F) (wo.H)(i.H) / (sigma_i |H|^4)
 * so that f(wo,wi) / n_o² is symmetric (Golubev 2024, Eq. 4c).
 */

static inline void refraction_fill(const closure *c, const real i[3], real d, real flakes, real f[3],
                                   real *pdf, real *reverse) {
    real sigma_i, lambda_i;
    view_of(PLAN_FULL, c, i, &sigma_i, &lambda_i);
    const real scale = c->map.view_z, eta2 = square(c->eta);
    const real radiance =
        d * smaller(scale / larger(unshadowed(PLAN_FULL, c, i, sigma_i, lambda_i, 1), REAL_MIN), saturated);
    const real carried = radiance * (MUTANT(9, !c->importance, c->importance) ? eta2 : 1);
    f[0] = f[1] = f[2] = smaller(carried * flakes, saturated);
    *pdf = smaller(d * eta2 * (scale / larger(c->sigma, REAL_MIN)), saturated);
    *reverse = smaller(d * (scale / larger(sigma_i, REAL_MIN)), saturated);
}

static inline void refraction_eval(const closure *c, const real i[3], value *out) {
    *out = (value){0};
    const refraction r = refraction_between(c->eta, c->wo, i);
    if (!(r.H2 > 0)) return;
    const real F = refraction_fresnel(c->eta, &r);
    const real d =
        smaller(refraction_spread(&r, transformed_density(PLAN_FULL, c, r.H, r.H2)) * (1 - F), saturated);
    refraction_fill(c, i, d, glint(PLAN_FULL, c, r.H, r.H2), out->f, &out->pdf, &out->pdf_reverse);
}

/* wo refracted through the sampled micronormal, whose density is d and for which F says how much is reflected. */
static inline void refraction_sample(const closure *c, const real m[3], real facing, real d, real F,
                                     sample *out) {
    real i[3];
    const real along = refract(c->eta, c->wo, m, facing, i);
    if (!(i[2] > 0)) return;
    const real eta = c->eta;
    for (int k = 0; k < 3; k++) out->wi[k] = -c->side * i[k];
    real sigma_i, lambda_i;
    view_of(PLAN_FULL, c, i, &sigma_i, &lambda_i);
    const real ratio =
        smaller(i[2] * c->sigma / larger(unshadowed(PLAN_FULL, c, i, sigma_i, lambda_i, 1), REAL_MIN), 1);
    const real flakes = eta == 1 ? 1 : glint(PLAN_FULL, c, m, 1);
    const real weight = smaller((c->importance ? ratio : ratio / square(eta)) * flakes, saturated);
    for (int k = 0; k < 3; k++)
        out->weight[k] = weight; /* G2 / G1, over eta² for radiance; 1 - F was the choice */
    out->transmitted = 1, out->rejected = 0, out->eta = eta;
    if (eta == 1 ||
        TRAITS & IS_DELTA) { /* nothing is bent, or there is one normal: a delta lobe that is masked */
        out->delta = 1, out->pdf = out->pdf_reverse = 1 - F;
        return;
    }
    const real facing_i = dot(i, m);
    const real density_i =
        smaller(d * facing * facing_i / larger(along * along, REAL_MIN) * (1 - F), saturated);
    refraction_fill(c, i, density_i, flakes, out->f, &out->pdf, &out->pdf_reverse);
}
