/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_material.c: the shared object's one type, "musurf.microfacet": microfacet reflection and refraction whose
 * microsurface is linearly transformed. Compile, describe, release, and the table that a host receives.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/bsdf/padded.h"
#include "plugin/musurf_compiled.h"
#include "plugin/musurf_given.h"

/* One that no M moves. */
static int is_plain_mirror(const mu_definition *d) {
    return mu_is_mirror(d) && d->tilt[0] == 0 && d->tilt[1] == 0;
}

/* The spread of the slopes, which is their unit, lies between a cell's and the whole of it. */
static int histogram_in_float(const parsed *p) {
    const mu_definition *d = &p->definition;
    const double *b = d->histogram_bounds, x = b[1] - b[0], y = b[3] - b[2];
    const double least = hypot(x / (double)d->histogram_columns, y / (double)d->histogram_rows) / 4,
                 most = hypot(fmax(fabs(b[0]), fabs(b[1])) + fabs(d->tilt[0]),
                              fmax(fabs(b[2]), fabs(b[3])) + fabs(d->tilt[1]));
    const double scale = sqrt(mu_transform_determinant(d->transform));
    return least >= 0x1p-30 && most <= 0x1p30 && most < 0x1p30 * least &&
           (p->varying || (scale > 0x1p-60 && scale < 0x1p60));
}

/* Float shading holds slope widths down to here (a large gamma narrows gtr) and constant M up to this scale;
 * beyond, D overflows, or the table would. */
static int float_suffices(const parsed *p) {
    const mu_definition *d = &p->definition;
    if (d->ndf == MU_TABULATED) return histogram_in_float(p);
    const double width = mu_is_mirror(d) ? 1 : mu_slope_width(d); /* of one, the tilt is all */
    const double tilt = hypot(d->tilt[0], d->tilt[1]) / width;
    const double scale = sqrt(mu_transform_determinant(d->transform));
    return is_plain_mirror(d) || (tilt < 0x1p30 && width >= 0x1p-30 && width <= 0x1p30 &&
                                  (p->varying || (scale > 0x1p-60 && scale < 0x1p60)));
}

static const char *transform_class(const parsed *p) {
    const double *m = p->definition.transform;
    if (p->varying) return "varying";
    if (mu_transform_is_similarity(m)) return fabs(m[0]) == 1 && m[1] == 0 ? "identity" : "uniform";
    return m[1] != 0 || m[2] != 0 ? "general" : "diagonal";
}

/* Does shading depend on the tangent? */
static int anisotropic(const parsed *p) {
    const mu_definition *d = &p->definition;
    if (is_plain_mirror(d)) return 0;
    return p->varying || d->ndf == MU_TABULATED || mu_is_discrete(d) || d->tilt[0] != 0 || d->tilt[1] != 0 ||
           !mu_transform_is_similarity(d->transform);
}

static void append(char *text, size_t size, const char *more) {
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s", length ? ", " : "", more);
}

/* From this share on integrating albedos, of some 100 microseconds, takes as long on average as all else. */
static const float slow = 1e-3f;

static void name_plan(musurf_material *m, const char *surface) {
    const parsed *p = &m->parsed;
    const int mirror = is_plain_mirror(&p->definition);
    snprintf(m->name, sizeof m->name, "%s%s%s%s%s", surface, mirror ? "" : ", ",
             mirror ? "" : transform_class(p), mirror ? "" : " transform",
             m->in_float ? "" : ", double precision");
    char more[64];
    if (m->unsure > 0) {
        snprintf(more, sizeof more, "albedo within %.2g", (double)m->unsure);
        append(m->name, sizeof m->name, more);
    }
    if (m->reach < INFINITY) {
        snprintf(more, sizeof more, "albedo integrated");
        if (m->reach > 0)
            snprintf(more, sizeof more, "albedo integrated beyond a slope roughness of %.2g",
                     (double)m->reach);
        append(m->name, sizeof m->name, more);
    } else if (m->open > slow) {
        snprintf(more, sizeof more, "albedo integrated for %.2g %% of directions", 100 * (double)m->open);
        append(m->name, sizeof m->name, more);
    }
    if (p->definition.multiple == MU_RANDOM_WALK && p->definition.fresnel != MU_FRESNEL_NONE && !p->definition.transmission && !mirror)
        append(m->name, sizeof m->name, "even light by walks, within 1e-3 where slopes are below 1");
    if (p->definition.fresnel == MU_FRESNEL_NONE) append(m->left_out, sizeof m->left_out, "fresnel");
    if (!p->definition.transmission) append(m->left_out, sizeof m->left_out, "refraction");
    if (p->definition.tilt[0] == 0 && p->definition.tilt[1] == 0 && p->definition.ndf != MU_TABULATED)
        append(m->left_out, sizeof m->left_out, "tilt");
    if (!mu_is_discrete(&p->definition)) append(m->left_out, sizeof m->left_out, "flakes");
    if (!(m->needs & MUSURF_NEEDS_SLOTS)) append(m->left_out, sizeof m->left_out, "slots");
    if (!m->table_bytes) append(m->left_out, sizeof m->left_out, "tables");
    if (m->in_float) append(m->left_out, sizeof m->left_out, "double precision");
    if (!mirror && !anisotropic(p)) append(m->left_out, sizeof m->left_out, "matrices");
    if (!(m->needs & MUSURF_NEEDS_TANGENT)) append(m->left_out, sizeof m->left_out, "tangents");
}

/* Refining ends somewhere: at what it left, if that is more than was meant, or at what is slow. */
static void warn_of_tables(const musurf_host *host, const musurf_material *m) {
    char text[192];
    if (!host || !COVERS(host, message) || !host->message) return;
    if (m->reach <= 0) {
        snprintf(
            text, sizeof text,
            "compensation has no tables for an M of the point here: shading integrates all albedos, at 20 to "
            "250 microseconds each; random_walk needs none");
        host->message(host->context, MUSURF_WARNING, MULTIPLE_SCATTERING, text);
    } else if (m->open > slow) {
        snprintf(text, sizeof text,
                 "tables of compensation leave %.2g %% of all directions open: shading integrates albedos "
                 "there, at 20 to 250 microseconds each; random_walk needs none",
                 100 * (double)m->open);
        host->message(host->context, MUSURF_WARNING, MULTIPLE_SCATTERING, text);
    }
    if (!(m->unsure > 0)) return;
    snprintf(text, sizeof text,
             "tables of compensation are off by up to %.2g of an albedo here, where %.2g is meant: "
             "random_walk needs none",
             (double)m->unsure, m->parsed.definition.compensation_error);
    host->message(host->context, MUSURF_WARNING, MULTIPLE_SCATTERING, text);
}

/* Why the directions of this material are drawn as they are. */
static void name_sampler(musurf_material *m, double noise) {
    const mu_definition *d = &m->parsed.definition;
    const char *name = musurf_parameters[SAMPLER_CHOICE - 1].choices[d->sampler];
    const size_t size = sizeof m->sampler;
    if (mu_is_mirror(d))
        snprintf(m->sampler, size, "none: a mirror");
    else if (d->multiple == MU_RANDOM_WALK)
        snprintf(m->sampler, size, "walk: on the microsurface");
    else if (!m->parsed.sampler_auto)
        snprintf(m->sampler, size, "%s: as set, or by default", name);
    else if (isnan(noise))
        snprintf(m->sampler, size, "%s: no other serves this material", name);
    else
        snprintf(m->sampler, size, "%s: least noise measured, %.2f of visible's variance in a white furnace",
                 name, noise);
}

static void *obtain(const musurf_host *host, size_t bytes) {
    if (host && COVERS(host, release) && host->allocate)
        return host->allocate(host->context, bytes, MU_ALIGNMENT);
    return aligned_alloc(MU_ALIGNMENT, bytes);
}

static musurf_result compile(const musurf_host *host, const musurf_setting *settings, size_t count,
                             musurf_material **out) {
    parsed p;
    *out = NULL;
    const musurf_result result = musurf_parse(host, settings, count, &p);
    if (result != MUSURF_OK) return result;

    const int in_float = float_suffices(&p);
    const size_t head = padded(sizeof(musurf_material)),
                 double_bytes = padded(mu_surface_bytes_d(&p.definition));
    mu_definition borrows = p.definition; /* float shading takes the tables of double's */
    borrows.compensation_borrows = 1;
    const size_t bytes = head + double_bytes + (in_float ? padded(mu_surface_bytes_f(&borrows)) : 0);
    musurf_material *m = obtain(host, bytes);
    if (!m) return MUSURF_NO_MEMORY;
    memset(m, 0, sizeof *m);
    double noise = NAN;
    if (p.sampler_auto && !mu_is_mirror(&p.definition) && p.definition.multiple != MU_RANDOM_WALK)
        p.definition.sampler = musurf_choose_sampler(
            &p.definition, in_float, (char *)m + head + (in_float ? double_bytes : 0), &noise);
    m->parsed = p;
    if (host && COVERS(host, release) && host->allocate) {
        m->release = host->release;
        m->context = host->context;
    }
    m->in_double = mu_surface_make_d(&p.definition, (char *)m + head);
    p.definition.compensation_tables = mu_surface_tables_d(m->in_double),
    p.definition.compensation_borrows = 1;
    if (in_float) m->in_float = mu_surface_make_f(&p.definition, (char *)m + head + double_bytes);
    musurf_find_moments(m);
    m->parsed.definition.histogram = NULL; /* the host's */
    for (int i = 0; i < 4; i++) m->inner[i] = (float)p.inner[i];
    const int mirror = mu_is_mirror(&p.definition);
    m->lobes = mirror ? MUSURF_DELTA_REFLECTION : MUSURF_GLOSSY_REFLECTION;
    m->transmits = p.definition.transmission != 0;
    if (m->transmits) {
        if (!mirror) m->lobes |= MUSURF_GLOSSY_TRANSMISSION;
        if (mirror || mu_passes_straight(&p.definition)) m->lobes |= MUSURF_DELTA_TRANSMISSION;
    }
    m->needs = (anisotropic(&p) ? (uint32_t)MUSURF_NEEDS_TANGENT : 0) |
               (p.varying || p.footprint_from == FOOTPRINT_SLOT ? (uint32_t)MUSURF_NEEDS_SLOTS : 0) |
               (mu_is_discrete(&p.definition) && p.footprint_from != FOOTPRINT_CONSTANT
                    ? (uint32_t)MUSURF_NEEDS_FOOTPRINT
                    : 0);
    m->bytes = (uint32_t)bytes;
    const mu_albedo_set *tables = p.definition.compensation_tables; /* one for both precisions */
    m->table_bytes = (uint32_t)(in_float ? mu_surface_table_bytes_f(m->in_float) : 0);
    if (tables) m->table_bytes += (uint32_t)(mu_surface_table_bytes_d(m->in_double));
    const size_t plain = in_float ? offsetof(mu_closure_f, footprint) : offsetof(mu_closure_d, footprint),
                 whole = in_float ? sizeof(mu_closure_f) : sizeof(mu_closure_d);
    m->closure_bytes =
        (uint32_t)(offsetof(bound, closure) +
                   (p.footprint_from || p.definition.multiple == MU_COMPENSATED ? whole : plain));
    m->unsure = (float)mu_surface_tables_unsure_d(m->in_double);
    m->open = (float)mu_surface_tables_open_d(m->in_double);
    m->reach = (float)mu_surface_tables_reach_d(m->in_double);
    warn_of_tables(host, m);
    name_sampler(m, noise);
    name_plan(m, in_float ? mu_surface_name_f(m->in_float) : mu_surface_name_d(m->in_double));
    *out = m;
    return MUSURF_OK;
}

static void release(musurf_material *material) {
    if (!material) return;
    if (material->release) {
        material->release(material->context, material);
    } else {
        free(material);
    }
}

static uint32_t slot_floats(const parsed *p) {
    const uint32_t map = p->composed  ? musurf_varying_slots(&p->shape)
                         : p->varying ? p->slot + 4
                                      : 0,
                   footprint = p->footprint_from == FOOTPRINT_SLOT ? p->footprint_slot + 6 : 0;
    return map > footprint ? map : footprint;
}

static void describe(const musurf_material *m, musurf_plan *plan) {
    const musurf_plan full = {
        .size = plan->size,
        .closure_bytes = m->closure_bytes,
        .closure_alignment = _Alignof(bound),
        /* a blurred mirror is glossy */
        .lobes = m->lobes | (m->lobes & MUSURF_DELTA_REFLECTION ? (uint32_t)MUSURF_GLOSSY_REFLECTION : 0) |
                 (m->lobes & MUSURF_DELTA_TRANSMISSION ? (uint32_t)MUSURF_GLOSSY_TRANSMISSION : 0),
        .needs = m->needs,
        .slot_floats = slot_floats(&m->parsed),
        .table_bytes = m->table_bytes,
        .material_bytes = m->bytes,
        .name = m->name,
        .left_out = m->left_out,
        .sampler = m->sampler,
    };
    memcpy(plan, &full, plan->size < sizeof full ? plan->size : sizeof full);
}

static const void *extension(const char *id) {
    if (strcmp(id, MUSURF_MAP_ID) == 0) return &musurf_map_table;
    if (strcmp(id, MUSURF_SLOPES_ID) == 0) return &musurf_slopes_table;
    return strcmp(id, MUSURF_PROBE_ID) == 0 ? &musurf_probe_table : NULL;
}

static const musurf_material_type microfacet = {
    .size = sizeof(musurf_material_type),
    .param_count = PARAMETER_COUNT,
    .id = "musurf.microfacet",
    .label = "Transformed microfacets",
    .doc = "Reflection and refraction by microfacets with exact Smith masking whose microsurface is deformed "
           "by any "
           "linear map of the tangent plane.",
    .params = musurf_parameters,
    .compile = compile,
    .release = release,
    .describe = describe,
    .setup = musurf_setup,
    .eval = musurf_eval,
    .sample = musurf_sample_one,
    .pdf = musurf_pdf,
    .albedo = musurf_albedo,
    .blur = musurf_blur,
    .eval_batch = musurf_eval_batch,
    .sample_batch = musurf_sample_batch,
    .extension = extension,
};

static const musurf_material_type *const types[] = {&microfacet};
static const musurf_plugin plugin = {
    .size = sizeof(musurf_plugin),
    .abi_minor = MUSURF_ABI_MINOR,
    .name = "musurf",
    .version = MUSURF_VERSION,
    .license = "MIT",
    .type_count = 1,
    .types = types,
};

const musurf_plugin *musurf_plugin_v1(void);
const musurf_plugin *musurf_plugin_v1(void) {
    return &plugin;
}
