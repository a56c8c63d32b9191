/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * compensated.c: single scattering and a smooth lobe that makes up for what it loses, after Kelemen & Szirmay-Kalos 2001
 * and Kulla & Conty 2017, for any distribution under any map, with tilt, on both sides of what transmits.
 *
 * With lost(w) = 1 - E(w) as albedo.h interpolates it, and A its cosine-weighted average over the side that wi is on,
 *     f_ms = (1 - passes) lost(wo) lost(wi) / (pi A) F_ms        reflected
 *     f_ms = passes lost(wo) lost(wi) / (pi A)       transmitted, importance; over eta², eta = n_i/n_o, radiance
 * which is reciprocal and returns all that single scattering loses when F_ms = 1. F_ms = F²E / (1 - F (1 - E)) of averages
 * over the hemisphere: light that met two facets or more (Kulla & Conty 2017; F² by Hill 2018). `passes` is as
 * walks on this very surface end (albedo.c).
 *
 * Sampled by one of both lobes, as likely as each sends light on; pdf is that of the mixture. Where the surface is bound
 * with an M of the point, and was not made for that (compensation_varies), scattering is single.
 */
#include "core/bsdf/multiple.h"

/* The lobe toward wi, and the densities by which both lobes are drawn. */
typedef struct lobe {
    real f[3];          /* importance, if transmitted */
    real chosen, pdf;   /* the probability of this lobe, and its density of wi */
    real back, reverse; /* the same from wi to wo */
} lobe;

static int below(const closure *c) {
    return c->side < 0;
}

/* How likely it is drawn, from a direction that loses `lost`. */
static real chance(const closure *c, real lost) {
    if (c->surface->transmission) return lost;
    const real *F = multiple_of(c->surface)->average;
    const real often = lost * R(c->lobe.repeated[0] + c->lobe.repeated[1] + c->lobe.repeated[2]),
               once = (1 - lost) * (F[0] + F[1] + F[2]);
    return often > 0 ? often / (often + once) : 0;
}

void MU(compensated_bind)(closure *c, real blur, int moved) {
    mu_lobe *l = &c->lobe;
    const mu_albedo_set *set = multiple_of(c->surface)->tables;
    double v[4];
    for (int k = 0; k < 4; k++) v[k] = (double)(c->map.view[k] / c->map.view_z);
    if (moved && set->means.value)
        mu_albedo_set_choose_moved(set, (float)blur, v, l);
    else if (blur > 0)
        mu_albedo_set_choose_blurred(set, (float)blur, v, l);
    else
        mu_albedo_set_choose(set, v, l);
    if (c->surface->transmission) { /* reciprocity: passes average is the same from both sides but for eta² */
        const float eta2 = (float)square(c->surface->fresnel.a[0]), above = l->average[0],
                    below = l->average[1] * eta2, passes = fminf(l->passes[0] * above, below);
        l->passes[0] = passes / above, l->passes[1] = passes / below;
    }
    /* of what is so rough that hardly anything leaves at once, 1 - E is rounded to 1 */
    const float w[3] = {(float)c->wo[0], (float)c->wo[1], (float)c->wo[2]},
                E = fmaxf(1 - l->average[0], FLT_EPSILON / 2);
    l->lost = w[2] > 0 ? lobe_lost(l, below(c), w, &l->density) : 0;
    for (int k = 0; k < 3; k++) { /* Kulla & Conty 2017, with Hill's second F (2018) */
        const float F = (float)multiple_of(c->surface)->average[k];
        l->repeated[k] = c->surface->transmission ? 1 : F * F * E / (1 - F + F * E);
    }
}

/* i: seen from the side it is on, i.z > 0. */
static lobe lobe_toward(const closure *c, const real i[3], int transmitted) {
    const mu_lobe *t = &c->lobe;
    const int from = below(c), to = from ^ transmitted;
    const float w[3] = {(float)i[0], (float)i[1], (float)i[2]};
    float density;
    const real lost = R(lobe_lost(t, to, w, &density));
    const real share = R(transmitted ? t->passes[from] : 1 - t->passes[from]),
               share_back = R(transmitted ? t->passes[to] : 1 - t->passes[to]);
    lobe l = {.chosen = chance(c, R(t->lost)),
              .back = chance(c, lost),
              .pdf = share * R(density),
              .reverse = share_back * R(t->density)};
    for (int k = 0; k < 3; k++)
        l.f[k] = share * R(t->lost) * (lost / R(t->average[to])) * R(INV_PI) * R(t->repeated[k]);
    return l;
}

static real mix(real chosen, real pdf, real single) {
    return smaller(MUTANT(16, 0, chosen * pdf) + (1 - chosen) * single, REAL_MAX);
}

void MU(compensated_eval)(const kernel *full, const closure *c, const real wi[3], value *out) {
    real i[3];
    full->eval(c, wi, out);
    const int transmitted = closure_turn(c, wi, i);
    if (!(i[2] > 0) || (transmitted && !c->surface->transmission)) return;
    const lobe l = lobe_toward(c, i, transmitted);
    for (int k = 0; k < 3; k++)
        out->f[k] = smaller(out->f[k] + l.f[k] * closure_transport(c, transmitted), REAL_MAX);
    out->pdf = mix(l.chosen, l.pdf, out->pdf);
    out->pdf_reverse = mix(l.back, l.reverse, out->pdf_reverse);
}

/* A direction of the smooth lobe, with what single scattering sends there too. */
static void sample_lobe(const kernel *full, const closure *c, const real u[3], sample *out) {
    const int transmitted = u[2] < R(c->lobe.passes[below(c)]);
    float w[3];
    lobe_draw(&c->lobe, below(c) ^ transmitted, (float)u[0], (float)u[1], w);
    const real unit = 1 / sqrt(square(R(w[0])) + square(R(w[1])) + square(R(w[2])));
    const real turn = transmitted ? -c->side * unit : c->side * unit;
    for (int k = 0; k < 3; k++) out->wi[k] = turn * R(w[k]), out->wm[k] = k < 2 ? 0 : c->side;
    value v;
    MU(compensated_eval)(full, c, out->wi, &v);
    if (!(v.pdf > 0)) return;
    for (int k = 0; k < 3; k++)
        out->f[k] = v.f[k], out->weight[k] = smaller(v.f[k] * (fabs(out->wi[2]) / v.pdf), REAL_MAX);
    out->pdf = v.pdf, out->pdf_reverse = v.pdf_reverse;
    out->transmitted = transmitted, out->eta = transmitted ? c->eta : 1;
    out->rejected = 0;
}

void MU(compensated_sample)(const kernel *full, const closure *c, mu_sampler sampler, const real u[3],
                            sample *out) {
    const real chosen = chance(c, R(c->lobe.lost));
    real moved[3] = {u[0], u[1], u[2]};
    if (u[2] < chosen) {
        *out = (sample){.rejected = 1, .eta = 1};
        moved[2] = u[2] / chosen;
        sample_lobe(full, c, moved, out);
        return;
    }
    moved[2] = smaller((u[2] - chosen) / (1 - chosen), 1 - R(0.5) * REAL_EPSILON);
    full->sample(c, sampler, moved, out);
    if (out->rejected) return;
    if (out->delta) {
        out->pdf *= 1 - chosen, out->pdf_reverse *= 1 - chosen;
        for (int k = 0; k < 3; k++) out->weight[k] /= 1 - chosen;
        return;
    }
    real i[3];
    const int transmitted = closure_turn(c, out->wi, i);
    const lobe l = lobe_toward(c, i, transmitted);
    const real pdf = larger(mix(chosen, l.pdf, out->pdf), REAL_MIN), single = out->pdf / pdf;
    for (int k = 0; k < 3; k++) {
        const real f = l.f[k] * closure_transport(c, transmitted);
        out->f[k] = smaller(out->f[k] + f, REAL_MAX);
        out->weight[k] = out->weight[k] * single + f * (i[2] / pdf);
    }
    out->pdf = pdf;
    out->pdf_reverse = mix(l.back, l.reverse, out->pdf_reverse);
}
