/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface.c: the table of distributions, and what musurf.h offers over it. */
#include "core/bsdf/multiple.h"
#include "core/bsdf/tabulated.h"

extern const kernel MU(mu_kernel_ggx), MU(mu_kernel_beckmann), MU(mu_kernel_gtr), MU(mu_kernel_std),
    MU(mu_kernel_sheen), MU(mu_kernel_flat), MU(mu_kernel_tabulated), MU(mu_kernel_gtr_spline);

/* One row per mu_ndf; what has none comes down to another, see choose(). */
static const kernel *const kernels[MU_NDF_COUNT] = {
    [MU_GGX] = &MU(mu_kernel_ggx),
    [MU_BECKMANN] = &MU(mu_kernel_beckmann),
    [MU_GTR] = &MU(mu_kernel_gtr),
    [MU_STD] = &MU(mu_kernel_std),
    [MU_SHEEN] = &MU(mu_kernel_sheen),
    [MU_FLAT] = &MU(mu_kernel_flat),
    [MU_TABULATED] = &MU(mu_kernel_tabulated),
};

/* The distribution that a definition comes down to, with its own alpha and gamma. */
typedef struct plan {
    const kernel *kernel;
    mu_definition definition;
    const char *name;
} plan;

static plan as(const mu_definition *d, mu_ndf ndf, double alpha, double gamma, const char *name) {
    plan p = {kernels[ndf], *d, name ? name : kernels[ndf]->name};
    p.definition.ndf = ndf, p.definition.alpha = alpha, p.definition.gamma = gamma;
    return p;
}

/* Student-t: 2 is GGX, and beyond 1e17 no double tells it from Beckmann. */
static plan choose_std(const mu_definition *d, double alpha, double gamma) {
    if (gamma == 2) return as(d, MU_GGX, alpha, 2, "ggx (std is ggx here)");
    if (gamma > 1e17) return as(d, MU_BECKMANN, alpha, 2, "beckmann (std is beckmann here)");
    return as(d, MU_STD, alpha, gamma, MU_REAL_BITS == 24 ? "std table" : "std quadrature");
}

/* A distribution has no mean slope: that of the histogram is a tilt, which the map applies. alpha is its spread. */
static plan choose_tabulated(const mu_definition *d) {
    double mean[2], covariance[3];
    mu_tabulated_moments(d, mean, covariance);
    plan p = as(d, MU_TABULATED, mu_tabulated_spread(covariance), d->gamma,
                MU_REAL_BITS == 24 ? "tabulated table" : "tabulated sums");
    for (int i = 0; i < 2; i++) p.definition.tilt[i] += mean[i];
    return p;
}

/* GTR by Appendix A. */
static plan spline(const mu_definition *d) {
    plan p = as(d, MU_GTR, d->alpha, d->gamma, "gtr spline (approximate)");
    p.kernel = &MU(mu_kernel_gtr_spline);
    return p;
}

static plan choose(const mu_definition *d) {
    const kernel *const custom = d->MU(custom);
    if (d->ndf == MU_CUSTOM && custom) return (plan){custom, *d, custom->name};
    if (d->ndf == MU_CUSTOM) return as(d, MU_FLAT, 0, 2, "none"); /* not in this precision */
    if (d->ndf == MU_TABULATED) return choose_tabulated(d);
    if (mu_is_mirror(d)) return as(d, MU_FLAT, 0, 2, "mirror");
    switch (d->ndf) {
    case MU_GTR: /* GGX for gamma = 2 and alpha = 1, and GGX of alpha = 1 for gamma = 0 */
        if (d->gamma == 2 || d->alpha == 1) return as(d, MU_GGX, d->alpha, 2, "ggx (gtr is ggx here)");
        /* D differs from gamma = 0 by less than the last place of a double */
        if (d->gamma * (1 - 2 * log(d->alpha)) < 1e-17) return as(d, MU_GGX, 1, 2, "ggx (gtr is ggx here)");
        if (d->smith == MU_SMITH_SPLINE) return spline(d);
        return as(d, MU_GTR, d->alpha, d->gamma, MU_REAL_BITS == 24 ? "gtr table" : "gtr quadrature");
    case MU_STD:
        return choose_std(d, d->alpha, d->gamma);
    case MU_PHONG: /* Student-t of b = (gamma - 1) alpha² = 1 */
        return choose_std(d, mu_slope_width(d), d->exponent / 2 + 2);
    case MU_DISCRETE_GGX:
        return as(d, MU_GGX, d->alpha, 2, "ggx flakes");
    case MU_DISCRETE_BECKMANN:
        return as(d, MU_BECKMANN, d->alpha, 2, "beckmann flakes");
    default:
        return as(d, d->ndf, d->alpha, d->gamma,
                  d->ndf == MU_SHEEN ? MU_REAL_BITS == 24 ? "sheen table" : "sheen quadrature" : NULL);
    }
}

/* Does it need what only the full plan has? */
static int needs_full(const mu_definition *d) {
    return d->tilt[0] != 0 || d->tilt[1] != 0 || d->transmission || d->masking != MU_HEIGHT_CORRELATED ||
           mixes(d->sampler) || folds(d->sampler) || d->multiple == MU_COMPENSATED;
}

/* A mirror scatters once. */
static int scatters_once(const plan *p, const mu_definition *d) {
    return d->multiple == MU_SINGLE || p->kernel->traits & IS_DELTA;
}
static size_t multiple_bytes(const plan *p, const mu_definition *d) {
    return scatters_once(p, d) ? 0 : MU(multiple_bytes)(d);
}

size_t MU(mu_surface_bytes)(const mu_definition *definition) {
    const plan p = choose(definition);
    return surface_head_bytes() + multiple_bytes(&p, definition) + p.kernel->table_bytes(&p.definition);
}

surface *MU(mu_surface_make)(const mu_definition *d, void *memory) {
    surface *s = memory;
    const plan p = choose(d);
    /* Appendix B: gtr's own alpha also where it comes down to GGX of another */
    const double mixed = fmin(d->ndf == MU_GTR ? d->alpha : p.definition.alpha, 1);
    *s = (surface){.kernel = p.kernel,
                   .general = p.kernel,
                   .sampler = d->sampler,
                   .masking = d->masking,
                   .transmission = d->transmission,
                   .is_delta = (p.kernel->traits & IS_DELTA) != 0,
                   .compensated = d->multiple == MU_COMPENSATED && !scatters_once(&p, d),
                   .alpha = R(p.definition.alpha),
                   .uniform_share = R(d->sampler == MU_SAMPLE_MIXED ? mixed : 0.3),
                   .unit = 1,
                   .tilt = {p.definition.tilt[0], p.definition.tilt[1]},
                   .name = p.name};
    s->fresnel.kind = d->fresnel;
    const double eta = mu_passes_straight(d) ? 1 : d->dielectric;
    for (int i = 0; i < 3; i++) {
        const mu_fresnel_kind kind = d->fresnel;
        s->fresnel.a[i] = R(kind == MU_FRESNEL_SCHLICK     ? d->schlick[i]
                            : kind == MU_FRESNEL_CONDUCTOR ? d->n[i]
                                                           : eta);
        s->fresnel.b[i] = R(d->k[i]);
    }
    const size_t before = surface_head_bytes() + multiple_bytes(&p, d);
    s->unit = p.kernel->prepare(&s->base, &p.definition, (char *)memory + before);
    if (mu_is_discrete(d)) {
        /* the lattice knows nothing of M: the same flakes lie on the microsurface however M deforms it */
        s->flake_cdf = d->ndf == MU_DISCRETE_GGX ? mu_flake_cdf_ggx : mu_flake_cdf_beckmann;
        s->flake_cone = d->flake_cone;
        s->flakes = mu_flakes_make(d->flake_density, d->flake_cone / s->unit, d->flake_seed);
    }
    if (mu_is_discrete(d) || needs_full(&p.definition)) s->kernel = s->general = p.kernel->plans[PLAN_FULL];
    s->table_bytes = p.kernel->table_bytes(&p.definition);
    if (!scatters_once(&p, d)) {
        if (d->multiple == MU_COMPENSATED) s->kernel = p.kernel->plans[PLAN_COMPENSATED];
        if (d->multiple == MU_COMPENSATED && d->compensation_varies) s->general = s->kernel;
        if (d->multiple == MU_RANDOM_WALK) s->kernel = s->general = p.kernel->plans[PLAN_WALK];
        MU(multiple_make)(s, d);
        s->table_bytes += sizeof(multiple);
        if (s->compensated && !d->compensation_borrows) s->table_bytes += multiple_of(s)->tables->bytes;
    }
    /* What turns or mirrors alone leaves an isotropic microsurface as it is. */
    const double scale = hypot(d->transform[0], d->transform[1]), uniform[4] = {scale, 0, 0, scale};
    const int is_uniform = s->kernel == p.kernel && !(p.kernel->traits & ANISOTROPIC) && scale <= DBL_MAX &&
                           mu_transform_is_similarity(d->transform);
    if (is_uniform) s->kernel = p.kernel->plans[PLAN_UNIFORM];
    MU(map_make)(&s->map, is_uniform ? uniform : d->transform, s->tilt, s->unit);
    return s;
}

size_t MU(mu_surface_table_bytes)(const surface *s) {
    return s->table_bytes;
}
real MU(mu_albedo)(const surface *s, const real w[3], real *average) {
    *average = 1;
    if (!s->compensated) return 1;
    mu_lobe lobe;
    float density;
    double v[4];
    for (int k = 0; k < 4; k++) v[k] = (double)(s->map.view[k] / s->map.view_z);
    mu_albedo_set_choose(multiple_of(s)->tables, v, &lobe);
    const int side = s->transmission && w[2] < 0;
    const float turn = w[2] < 0 ? -1.0f : 1.0f,
                up[3] = {turn * (float)w[0], turn * (float)w[1], turn * (float)w[2]};
    *average = 1 - R(lobe.average[side]);
    return 1 - R(lobe_lost(&lobe, side, up, &density));
}
const mu_albedo_set *MU(mu_surface_tables)(const surface *s) {
    return s->compensated ? multiple_of(s)->tables : NULL;
}
real MU(mu_surface_tables_unsure)(const surface *s) {
    return s->compensated ? R(multiple_of(s)->tables->unsure) : 0;
}
real MU(mu_surface_tables_open)(const surface *s) {
    if (!s->compensated) return 0;
    const mu_albedo *t = &multiple_of(s)->tables->level[0];
    if (!multiple_of(s)->tables->levels) return 1;
    return R(s->transmission ? fmaxf(t->side[0].open, t->side[1].open) : t->side[0].open);
}
real MU(mu_surface_tables_reach)(const surface *s) {
    const mu_albedo_set *set = s->compensated ? multiple_of(s)->tables : NULL;
    return set && set->means.value ? R(set->grid.table ? mu_albedo_grid_reach(&set->grid) : 0) : R(INFINITY);
}
const char *MU(mu_surface_name)(const surface *s) {
    return s->name;
}

int MU(mu_bind)(const surface *s, const real wo[3], const real transform[4], closure *c) {
    c->surface = s;
    c->kernel = s->kernel;
    c->alpha = s->alpha;
    c->map = s->map;
    c->importance = c->has_footprint = 0;
    if (transform) {
        const double m[4] = {(double)transform[0], (double)transform[1], (double)transform[2],
                             (double)transform[3]};
        if (!MU(map_make)(&c->map, m, s->tilt, s->unit)) return 0;
        c->kernel = s->general;
    }
    c->is_delta = s->is_delta;
    c->side = s->transmission && wo[2] < 0 ? R(-1) : R(1);
    c->eta = c->side < 0 ? 1 / s->fresnel.a[0] : s->fresnel.a[0]; /* of a dielectric */
    for (int i = 0; i < 3; i++) c->wo[i] = c->side * wo[i];
    c->sigma = c->lambda = c->least2 = 0;
    if (s->sampler == MU_SAMPLE_BOUNDED) c->least2 = square(smaller(map_least(&c->map), 1));
    if (c->wo[2] >= 0) c->kernel->view(c, c->wo, &c->sigma, &c->lambda);
    if (s->compensated && c->kernel == c->kernel->plans[PLAN_COMPENSATED])
        MU(compensated_bind)(c, 0, transform != NULL);
    return c->wo[2] > 0;
}

void MU(mu_footprint)(closure *c, const double footprint[6]) {
    if (!c->surface->flake_cdf) return;
    c->has_footprint = footprint != NULL;
    for (int i = 0; footprint && i < 6; i++) c->footprint[i] = footprint[i];
}

static int is_gtr_kernel(const kernel *k) {
    return k->plans[PLAN_GENERAL] == kernels[MU_GTR] || k->plans[PLAN_GENERAL] == &MU(mu_kernel_gtr_spline);
}

void MU(mu_blur)(closure *c, real alpha) {
    if (!(alpha > 0)) return;
    const surface *s = c->surface;
    const kernel *const ggx = kernels[MU_GGX];
    int same = PLAN_FULL; /* GGX of the same plan; M is no multiple of 1 any more */
    while (same < PLAN_COUNT && c->kernel != c->kernel->plans[same]) same++;
    if (c->is_delta) { /* takes the roughness alone, about its own slope: M times nothing is nothing */
        real mean[2];
        map_mean(&c->map, mean);
        const double identity[4] = {1, 0, 0, 1}, z = (double)c->map.view_z,
                     tilt[2] = {(double)mean[0] / z, (double)mean[1] / z};
        MU(map_make)(&c->map, identity, tilt, (double)alpha);
    } else {
        /* gtr of gamma < 1 is measured in slopes of 1, but alpha is what there is of a lobe */
        const int is_gtr = is_gtr_kernel(c->kernel);
        const double roughness = is_gtr ? fmin(1, (double)s->alpha / s->unit) : 1;
        map wide = c->map;
        if (c->kernel->plans[PLAN_GENERAL] == kernels[MU_TABULATED]) {
            const real *root = s->base.shape + TABULATED_ROOT;
            MU(map_stand_for)(&wide, (const double[]){(double)root[0], (double)root[1], (double)root[2]});
        }
        if (!MU(map_widen)(&wide, roughness, (double)alpha)) return;
        c->map = wide;
    }
    if (same == PLAN_COMPENSATED && !multiple_of(s)->tables->blurs) same = PLAN_FULL; /* scatters singly */
    c->kernel = ggx->plans[same < PLAN_COUNT ? same : PLAN_GENERAL];
    c->alpha = larger(c->alpha, alpha);
    c->has_footprint = c->is_delta = 0;
    if (s->sampler == MU_SAMPLE_BOUNDED) c->least2 = square(smaller(map_least(&c->map), 1));
    c->kernel->view(c, c->wo, &c->sigma, &c->lambda);
    if (s->compensated && c->kernel == c->kernel->plans[PLAN_COMPENSATED]) MU(compensated_bind)(c, alpha, 1);
}

void MU(mu_eval)(const closure *c, const real wi[3], value *out) {
    c->kernel->eval(c, wi, out);
}

void MU(mu_sample_with)(const closure *c, mu_sampler sampler, const real u[3], sample *out) {
    c->kernel->sample(c, sampler, u, out);
}

void MU(mu_sample_wi)(const closure *c, const real u[3], sample *out) {
    MU(mu_sample_with)(c, c->surface->sampler, u, out);
}
