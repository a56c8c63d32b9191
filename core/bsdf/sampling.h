/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * sampling.h: draws a micronormal of the transformed microsurface, and the direction it sends wo into (part of
 * transformed.h).
 */

/* A micronormal, seen from `from` by samplers of visible normals: n in the distribution's own space; m in the surface's, of unit length. D_M comes from n itself, not from
 * M^T m: exact however near to singular M is. 0 if there is none. */
static inline int draw_normal(plan_kind plan, const closure *c, const real from[3], mu_sampler sampler,
                              const real u[3], real m[3], real *d) {
    real n[3];
    if (!draws_all(sampler)) {
        real w[3];
        map_view(plan, &c->map, from, w);
        if (TRAITS & IS_UNIT_GGX && sampler == MU_SAMPLE_BOUNDED)
            cap_visible_bounded(w, 1 - bound_of(c, from), u[0], u[1], n);
        else
            sample_visible(&c->surface->base, w, u, n); /* Eq. (28) */
    } else {
        sample_slope(&c->surface->base, u, n); /* Eq. (25) */
    }
    map_normal_back(plan, &c->map, n, m); /* Eq. (26) */
    const real length = sqrt(dot(m, m));
    if (!(length > 0)) return 0;
    for (int k = 0; k < 3; k++) m[k] /= length;
    const real stretch = length / (c->map.view_z * c->map.normal_z);
    *d = smaller(density(&c->surface->base, n, stretch * stretch), saturated);
    return 1;
}

/* A direction that no micronormal of its own has led to: all as eval has it. */
static inline void foreign_sample(const closure *c, mu_sampler sampler, const real i[3], sample *out) {
    value v;
    real m[3], length2 = 0;
    for (int k = 0; k < 3; k++) m[k] = c->wo[k] + i[k], length2 += m[k] * m[k];
    reflection_eval(PLAN_FULL, c, sampler, i, &v);
    if (!(v.pdf > 0)) return;
    for (int k = 0; k < 3; k++) {
        out->wi[k] = i[k], out->wm[k] = m[k] / sqrt(length2);
        out->f[k] = v.f[k], out->weight[k] = smaller(v.f[k] * (i[2] / v.pdf), saturated);
    }
    out->pdf = v.pdf, out->pdf_reverse = v.pdf_reverse, out->rejected = 0;
}

/* A direction of the uniform hemisphere, for the samplers that mix it in. */
static inline void uniform_sample(const closure *c, mu_sampler sampler, const real u[3], sample *out) {
    const real z = 1 - u[0], r = sqrt(u[0] * (2 - u[0])), phi = R(2 * PI) * u[1];
    foreign_sample(c, sampler, (const real[3]){r * cos(phi), r * sin(phi), z}, out);
}

static inline void reflection_sample(plan_kind plan, const closure *c, mu_sampler sampler, const real m[3],
                                     real cosine, real d, const real F[3], sample *out) {
    real i[3];
    for (int k = 0; k < 3; k++) i[k] = 2 * cosine * m[k] - c->wo[k];
    const int folded = plan == PLAN_FULL && folds(sampler);
    if (!(i[2] > 0) && !(folded && i[2] < 0)) return;
    const real unit = R(1) / sqrt(dot(i, i));
    for (int k = 0; k < 3; k++) i[k] *= unit, out->wi[k] = plan == PLAN_FULL ? c->side * i[k] : i[k];
    if (folded && i[2] < 0) {
        i[2] = -i[2];
        foreign_sample(c, sampler, i, out);
        return;
    }

    real sigma_i, lambda_i;
    view_of(plan, c, i, &sigma_i, &lambda_i);
    const real scale = c->map.view_z, open = larger(unshadowed(plan, c, i, sigma_i, lambda_i, 0), REAL_MIN);
    const real shown = c->sigma - bounded_less(c, sampler, c->wo);
    const real ratio = smaller(i[2] / open * MUTANT(8, c->wo[2] * scale, shown), 1);
    real f = smaller(d / 4 * smaller(scale / open, saturated), saturated);
    const real choice = plan == PLAN_FULL && c->surface->transmission ? F[0] : 1;
    if (TRAITS & IS_DELTA) {
        const real once = smaller(i[2] * shown / open, 1); /* exactly 1 where nothing is masked */
        for (int k = 0; k < 3; k++) out->weight[k] = choice < 1 ? once : F[k] * once;
        out->pdf = out->pdf_reverse = choice;
        out->delta = 1, out->rejected = 0;
        return;
    }
    const real own = reflection_pdf(plan, c, sampler, d / 4, m[2] / cosine, i, sigma_i, choice, &out->pdf,
                                    &out->pdf_reverse);
    real weight = ratio; /* F G2 / G1 */
    if (draws_all(sampler))
        weight = smaller(i[2] / open * scale * (cosine / larger(m[2], REAL_MIN)), saturated);
    if (folded || (plan == PLAN_FULL && mixes(sampler))) /* its own density over that of all ways */
        weight *= own / larger(out->pdf, REAL_MIN);
    if (plan == PLAN_FULL) {
        const real flakes = glint(plan, c, m, 1);
        f = smaller(f * flakes, saturated), weight = smaller(weight * flakes, saturated);
    }
    for (int k = 0; k < 3; k++) {
        out->f[k] = F[k] * f;
        out->weight[k] = choice < 1 ? weight : F[k] * weight; /* F was the choice */
    }
    out->rejected = 0;
}

static inline void sample_of(plan_kind plan, const closure *c, mu_sampler sampler, const real u[3],
                             sample *out) {
    *out = (sample){.rejected = 1, .eta = 1};
    if (TRAITS & IS_DELTA) sampler = MU_SAMPLE_VISIBLE; /* there is one normal to draw */
    real moved[3] = {u[0], u[1], u[2]}, m[3], d;
    if (plan == PLAN_FULL && mixes(sampler)) {
        const real share = c->surface->uniform_share;
        if (u[2] < share) {
            uniform_sample(c, sampler, u, out);
            return;
        }
        moved[2] = (u[2] - share) / (1 - share);
    }
    if (!draw_normal(plan, c, c->wo, sampler, moved, m, &d)) return;
    for (int k = 0; k < 3; k++) out->wm[k] = plan == PLAN_FULL ? c->side * m[k] : m[k];
    const real cosine = dot(m, c->wo);
    if (!(cosine > 0)) return;
    real F[3];
    fresnel_of(c, cosine, F);
    if (plan == PLAN_FULL && c->surface->transmission) {
        real choice = moved[2];
        if (TRAITS & PICKS) { /* u[2] is spent: a number of another stream than sample_visible's, whichever */
            random_stream more = random_start(u);
            more.state ^= 0x5bf0363546a83dull;
            choice = random_next(&more);
        }
        if (choice >= F[0]) {
            refraction_sample(c, m, cosine, d, F[0], out);
            return;
        }
    }
    reflection_sample(plan, c, sampler, m, cosine, d, F, out);
}
