/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_shading.c: the hot functions of "musurf.microfacet". Nothing here allocates, locks or calls the
 * host. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "plugin/musurf_compiled.h"

/* Out of line: a setup without flakes shall not pay for its registers. */
__attribute__((noinline)) static void set_footprint(const parsed *p, const float *slots, int in_float,
                                                    bound *b) {
    double f[6];
    if (p->footprint_from == FOOTPRINT_SLOT && !slots) return;
    for (int i = 0; i < 6; i++)
        f[i] = p->footprint_from == FOOTPRINT_SLOT ? (double)slots[p->footprint_slot + (uint32_t)i]
                                                   : p->footprint[i];
    if (in_float)
        mu_footprint_f(&b->closure.f, f);
    else
        mu_footprint_d(&b->closure.d, f);
}

/* transform: M, NULL: the definition's. */
static inline uint32_t bind(const musurf_material *m, const float wo[3], const float *transform, const float *slots,
                            uint32_t mode, void *closure) {
    bound *b = closure;
    b->material = m;
    if (m->in_float) {
        if (!mu_bind_f(m->in_float, wo, transform, &b->closure.f)) return 0;
        b->closure.f.importance = (mode & MUSURF_IMPORTANCE) != 0;
    } else {
        const double w[3] = {(double)wo[0], (double)wo[1], (double)wo[2]};
        double t[4] = {1, 0, 0, 1};
        for (int i = 0; transform && i < 4; i++) t[i] = (double)transform[i];
        if (!mu_bind_d(m->in_double, w, transform ? t : NULL, &b->closure.d)) return 0;
        b->closure.d.importance = (mode & MUSURF_IMPORTANCE) != 0;
    }
    if (m->parsed.footprint_from) set_footprint(&m->parsed, slots, m->in_float != NULL, b);
    return m->lobes;
}

/* The M of a material of which some of it varies. */
static inline void compose(const musurf_material *m, const float *slots, float transform[4]) {
    if (m->parsed.composed) {
        musurf_varying_compose(&m->parsed.shape, slots, transform);
        return;
    }
    const float *t = slots + m->parsed.slot, *inner = m->inner;
    for (int i = 0; i < 4; i++)
        transform[i] = t[i / 2 * 2] * inner[i % 2] + t[i / 2 * 2 + 1] * inner[2 + i % 2];
}

uint32_t musurf_setup(const musurf_material *m, const float wo[3], const float *slots, uint32_t mode,
                      void *closure) {
    if (!m->parsed.varying) return bind(m, wo, NULL, slots, mode, closure);
    float transform[4];
    if (!slots) return 0;
    compose(m, slots, transform);
    return bind(m, wo, transform, slots, mode, closure);
}

static uint32_t map_compose(const musurf_material *m, const float *slots, float transform[4]) {
    if (!m->parsed.varying) return 0;
    compose(m, slots, transform);
    return 1;
}

const musurf_map musurf_map_table = {sizeof(musurf_map), map_compose, bind};

/* The glossy lobe toward wi, or 0. A mirror has none; a blurred one does. */
static inline uint32_t glossy_lobe(const bound *b, const float wi[3]) {
    const int in_float = b->material->in_float != NULL;
    if (in_float ? b->closure.f.is_delta : b->closure.d.is_delta) return 0;
    const float up = wi[2] * (in_float ? b->closure.f.side : (float)b->closure.d.side);
    if (up > 0) return MUSURF_GLOSSY_REFLECTION;
    return up < 0 && b->material->transmits ? MUSURF_GLOSSY_TRANSMISSION : 0;
}

static float rounded(double x) {
    return x < (double)FLT_MAX ? (float)x : FLT_MAX;
}

static void eval_double(const bound *b, const float wi[3], mu_value_f *out) {
    const double w[3] = {(double)wi[0], (double)wi[1], (double)wi[2]};
    mu_value_d value;
    mu_eval_d(&b->closure.d, w, &value);
    for (int k = 0; k < 3; k++) out->f[k] = rounded(value.f[k]);
    out->pdf = rounded(value.pdf);
    out->pdf_reverse = rounded(value.pdf_reverse);
}

static inline void eval(const bound *b, const float wi[3], uint32_t lobes, musurf_value *out) {
    mu_value_f value;
    const uint32_t lobe = glossy_lobe(b, wi);
    if (!(lobes & lobe)) {
        *out = (musurf_value){.lobes = 0};
        return;
    }
    if (b->material->in_float) {
        mu_eval_f(&b->closure.f, wi, &value);
    } else {
        eval_double(b, wi, &value);
    }
    for (int k = 0; k < 3; k++) out->f[k] = value.f[k] * fabsf(wi[2]);
    out->pdf = value.pdf;
    out->pdf_reverse = value.pdf_reverse;
    out->lobes = lobe;
}

static void sample_double(const bound *b, const float u[3], mu_sample_f *out) {
    const double v[3] = {(double)u[0], (double)u[1], (double)u[2]};
    mu_sample_d s;
    mu_sample_wi_d(&b->closure.d, v, &s);
    for (int k = 0; k < 3; k++) {
        out->wi[k] = (float)s.wi[k], out->wm[k] = (float)s.wm[k];
        out->weight[k] = rounded(s.weight[k]);
    }
    out->pdf = rounded(s.pdf), out->pdf_reverse = rounded(s.pdf_reverse);
    out->rejected = s.rejected || out->wi[2] == 0; /* rounded onto the horizon */
    out->delta = s.delta, out->transmitted = s.transmitted, out->eta = (float)s.eta;
}

static inline void sample(const bound *b, const float u[3], uint32_t lobes, musurf_sample *out) {
    mu_sample_f s;
    *out = (musurf_sample){.eta = 1};
    if (b->material->in_float) {
        mu_sample_wi_f(&b->closure.f, u, &s);
    } else {
        sample_double(b, u, &s);
    }
    if (s.rejected) return;
    const uint32_t lobe = s.transmitted ? s.delta ? MUSURF_DELTA_TRANSMISSION : MUSURF_GLOSSY_TRANSMISSION
                          : s.delta     ? MUSURF_DELTA_REFLECTION
                                        : MUSURF_GLOSSY_REFLECTION;
    if (!(lobes & lobe)) return; /* rejected: the choice among lobes is not the mask's */
    memcpy(out->wi, s.wi, sizeof s.wi);
    memcpy(out->wm, s.wm, sizeof s.wm);
    memcpy(out->weight, s.weight, sizeof s.weight);
    out->pdf = s.pdf;
    out->pdf_reverse = s.pdf_reverse;
    out->eta = s.eta;
    out->roughness = s.delta ? 0 : b->material->in_float ? b->closure.f.alpha : (float)b->closure.d.alpha;
    out->lobe = lobe;
}

void musurf_eval(const void *closure, const float wi[3], uint32_t lobes, musurf_value *out) {
    eval(closure, wi, lobes, out);
}

void musurf_sample_one(const void *closure, const float u[3], uint32_t lobes, musurf_sample *out) {
    sample(closure, u, lobes, out);
}

float musurf_pdf(const void *closure, const float wi[3], uint32_t lobes) {
    musurf_value value;
    eval(closure, wi, lobes, &value);
    return value.pdf;
}

/* Fresnel at the macrosurface: single scattering loses a little of it to masking. What transmits loses nothing else. */
void musurf_albedo(const void *closure, float rgb[3]) {
    const bound *b = closure;
    if (b->material->parsed.definition.transmission) {
        rgb[0] = rgb[1] = rgb[2] = 1;
    } else if (b->material->in_float) {
        const float *wo = b->closure.f.wo;
        const mu_pair_values_f mirror = mu_pair_f(&b->closure.f, (const float[3]){-wo[0], -wo[1], wo[2]});
        for (int k = 0; k < 3; k++) rgb[k] = mirror.F[k];
    } else {
        const double *wo = b->closure.d.wo;
        const mu_pair_values_d mirror = mu_pair_d(&b->closure.d, (const double[3]){-wo[0], -wo[1], wo[2]});
        for (int k = 0; k < 3; k++) rgb[k] = (float)mirror.F[k];
    }
}

void musurf_blur(void *closure, float alpha) {
    bound *b = closure;
    if (b->material->in_float) {
        mu_blur_f(&b->closure.f, alpha);
    } else {
        mu_blur_d(&b->closure.d, (double)alpha);
    }
}

void musurf_eval_batch(const void *closure, size_t closure_stride, const float *wi, size_t wi_stride,
                       uint32_t lobes, musurf_value *out, size_t out_stride, size_t count) {
    for (size_t i = 0; i < count; i++) {
        eval((const void *)((const char *)closure + i * closure_stride),
             (const void *)((const char *)wi + i * wi_stride), lobes, (void *)((char *)out + i * out_stride));
    }
}

void musurf_sample_batch(const void *closure, size_t closure_stride, const float *u, size_t u_stride,
                         uint32_t lobes, musurf_sample *out, size_t out_stride, size_t count) {
    for (size_t i = 0; i < count; i++) {
        sample((const void *)((const char *)closure + i * closure_stride),
               (const void *)((const char *)u + i * u_stride), lobes, (void *)((char *)out + i * out_stride));
    }
}
