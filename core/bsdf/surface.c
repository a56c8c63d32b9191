/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface.c: the table of distributions, and what musurf.h offers over it. */
#include "core/bsdf/distribution.h"

extern const kernel MU(mu_kernel_ggx), MU(mu_kernel_beckmann), MU(mu_kernel_gtr);

/* One row per mu_ndf. */
static const kernel *const kernels[MU_NDF_COUNT] = {
    [MU_GGX] = &MU(mu_kernel_ggx),
    [MU_BECKMANN] = &MU(mu_kernel_beckmann),
    [MU_GTR] = &MU(mu_kernel_gtr),
};

/* What a definition comes down to: GTR is GGX for gamma = 2 and alpha = 1, and GGX of alpha = 1 for gamma =
 * 0. */
typedef struct plan {
    const kernel *kernel;
    double alpha, gamma;
    const char *name;
} plan;

static plan choose(const mu_definition *d) {
    if (d->alpha == 0) return (plan){NULL, 0, 0, "mirror"};
    if (d->ndf == MU_GTR) {
        if (d->gamma == 2 || d->alpha == 1)
            return (plan){kernels[MU_GGX], d->alpha, 2, "ggx (gtr is ggx here)"};
        /* D differs from gamma = 0 by less than the last place of a double */
        if (d->gamma * (1 - 2 * log(d->alpha)) < 1e-17)
            return (plan){kernels[MU_GGX], 1, 2, "ggx (gtr is ggx here)"};
        return (plan){kernels[MU_GTR], d->alpha, d->gamma,
                      MU_REAL_BITS == 24 ? "gtr table" : "gtr quadrature"};
    }
    return (plan){kernels[d->ndf], d->alpha, d->gamma, kernels[d->ndf]->name};
}

static size_t header_bytes(void) {
    return (sizeof(surface) + 63) / 64 * 64;
}

size_t MU(mu_surface_bytes)(const mu_definition *definition) {
    const plan p = choose(definition);
    return header_bytes() + (p.kernel ? p.kernel->table_bytes(p.alpha, p.gamma) : 0);
}

surface *MU(mu_surface_make)(const mu_definition *d, void *memory) {
    surface *s = memory;
    const plan p = choose(d);
    *s = (surface){.kernel = p.kernel,
                   .general = p.kernel,
                   .sampler = d->sampler,
                   .alpha = R(p.alpha),
                   .unit = 1,
                   .name = p.name};
    s->fresnel.kind = d->fresnel;
    for (int i = 0; i < 3; i++) {
        const mu_fresnel_kind kind = d->fresnel;
        s->fresnel.a[i] = R(kind == MU_FRESNEL_SCHLICK     ? d->schlick[i]
                            : kind == MU_FRESNEL_CONDUCTOR ? d->n[i]
                                                           : d->dielectric);
        s->fresnel.b[i] = R(d->k[i]);
    }
    if (p.kernel) {
        s->table_bytes = p.kernel->table_bytes(p.alpha, p.gamma);
        s->unit = p.kernel->prepare(&s->base, p.alpha, p.gamma, (char *)memory + header_bytes());
    }
    /* The distributions are isotropic: what turns or mirrors alone leaves them as they are. */
    const double scale = hypot(d->transform[0], d->transform[1]), uniform[4] = {scale, 0, 0, scale};
    const int is_uniform = p.kernel && scale <= DBL_MAX && mu_transform_is_similarity(d->transform);
    if (is_uniform) s->kernel = p.kernel->uniform;
    MU(map_make)(&s->map, is_uniform ? uniform : d->transform, s->unit);
    return s;
}

size_t MU(mu_surface_table_bytes)(const surface *s) {
    return s->table_bytes;
}
const char *MU(mu_surface_name)(const surface *s) {
    return s->name;
}

int MU(mu_bind)(const surface *s, const real wo[3], const real transform[4], closure *c) {
    c->surface = s;
    c->kernel = s->kernel;
    c->alpha = s->alpha;
    c->map = s->map;
    if (transform) {
        const double m[4] = {(double)transform[0], (double)transform[1], (double)transform[2],
                             (double)transform[3]};
        if (!MU(map_make)(&c->map, m, s->unit)) return 0;
        c->kernel = s->general;
    }
    for (int i = 0; i < 3; i++) c->wo[i] = wo[i];
    c->sigma = !(wo[2] >= 0) ? 0 : c->kernel ? c->kernel->sigma(c, wo) : wo[2];
    return wo[2] > 0;
}

void MU(mu_blur)(closure *c, real alpha) {
    if (!(alpha > 0)) return;
    if (!c->kernel) { /* a mirror takes the roughness alone: M times nothing is nothing */
        const double identity[4] = {1, 0, 0, 1};
        MU(map_make)(&c->map, identity, (double)alpha);
    } else {
        /* gtr of gamma < 1 is measured in slopes of 1, but alpha is what there is of a lobe */
        const surface *s = c->surface;
        const double roughness = c->kernel == kernels[MU_GGX] ? 1 : fmin(1, (double)s->alpha / s->unit);
        if (!MU(map_widen)(&c->map, roughness, (double)alpha)) return;
    }
    c->kernel = kernels[MU_GGX];
    c->alpha = larger(c->alpha, alpha);
    c->sigma = c->kernel->sigma(c, c->wo);
}

void MU(mu_eval)(const closure *c, const real wi[3], value *out) {
    if (c->kernel) {
        c->kernel->eval(c, wi, out);
    } else {
        *out = (value){0};
    }
}

static void sample_mirror(const closure *c, sample *out) {
    *out = (sample){.delta = 1, .pdf = 1, .pdf_reverse = 1, .wm = {0, 0, 1}};
    out->wi[0] = -c->wo[0], out->wi[1] = -c->wo[1], out->wi[2] = c->wo[2];
    MU(fresnel_eval)(&c->surface->fresnel, c->wo[2], out->weight);
}

void MU(mu_sample_with)(const closure *c, mu_sampler sampler, const real u[3], sample *out) {
    if (c->kernel) {
        c->kernel->sample(c, sampler, u, out);
    } else {
        sample_mirror(c, out);
    }
}

void MU(mu_sample_wi)(const closure *c, const real u[3], sample *out) {
    MU(mu_sample_with)(c, c->surface->sampler, u, out);
}
