/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * template.c: a whole plugin to copy. One material, "template.lambert": f = reflectance / pi, ideal diffuse
 * reflection (Lambert 1760), in the local frame of musurf_plugin.h. Nothing of musurf's core is used here.
 *
 * To make your own: copy this file, build it as vendor_material.so exporting musurf_plugin_v1 alone (the rule
 * is in plugin/rules.mk), put it beside `musurf` or into $MUSURF_PLUGIN_PATH, and write "material":
 * "vendor.name" in a scene. Then change, from the top: the parameters, the material, the closure, the five
 * shading functions.
 */
#include "plugin/musurf_plugin.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------ parameters
 * The table is all a host needs for scene files, user interfaces and documentation. Never reuse an id. */

enum { REFLECTANCE = 1 };

static const musurf_param PARAMS[] = {{
    .size = sizeof(musurf_param),
    .id = REFLECTANCE,
    .name = "reflectance",
    .label = "Reflectance",
    .doc =
        "Fraction of the light that is reflected, in linear RGB. Values in slots are clamped to the range.",
    .unit = "",
    .kind = MUSURF_COLOR,
    .flags = MUSURF_MAY_VARY,
    .min = 0,
    .max = 1,
    .soft_min = 0,
    .soft_max = 1,
    .initial = {0.5, 0.5, 0.5},
}};
enum { PARAM_COUNT = sizeof PARAMS / sizeof PARAMS[0] };

/* What compile makes: immutable afterwards, so every thread may read it. */
struct musurf_material {
    float reflectance[3];
    _Bool varies;
    uint32_t slot; /* of reflectance, if it varies */
    void *context; /* who gives the memory back: the host, or free() if NULL */
    void (*release)(void *context, void *memory);
};

/* What setup makes in the host's memory for one hit: all that the shading functions will need, and no more.
 */
typedef struct closure {
    float reflectance[3];
    float cos_o;
} closure;

/* ---------------------------------------------------------------------------------------- compile, release
 * A struct may come from an older or newer header than ours: look no further than its `size` covers. */

#define COVERS(object, field)                                                                                \
    ((object)->size >= offsetof(__typeof__(*(object)), field) + sizeof(object)->field)

__attribute__((format(printf, 3, 4))) static musurf_result refuse(const musurf_host *host, uint32_t param,
                                                                  const char *format, ...) {
    if (host && COVERS(host, message) && host->message) {
        char text[256];
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        host->message(host->context, MUSURF_ERROR, param, text);
    }
    return MUSURF_INVALID;
}

static musurf_result set_reflectance(const musurf_host *host, const musurf_setting *setting,
                                     musurf_material *material) {
    if (setting->source == MUSURF_SLOT) {
        if (setting->slot > UINT32_MAX - 3)
            return refuse(host, REFLECTANCE, "reflectance: slot %u leaves no room for three floats",
                          (unsigned)setting->slot);
        material->varies = 1;
        material->slot = setting->slot;
        return MUSURF_OK;
    }
    if (setting->source != MUSURF_CONSTANT)
        return refuse(host, REFLECTANCE, "reflectance: source %u is neither a constant (0) nor a slot (1)",
                      (unsigned)setting->source);
    if (!COVERS(setting, values) || !setting->values)
        return refuse(host, REFLECTANCE, "reflectance: no values; three numbers in [0, 1] are needed");
    for (int i = 0; i < 3; ++i) {
        const double value = setting->values[i];
        if (!(value >= 0 && value <= 1)) /* NaN lands here too */
            return refuse(host, REFLECTANCE, "reflectance: %g is not in [0, 1]", value);
        material->reflectance[i] = (float)value;
    }
    return MUSURF_OK;
}

static musurf_result read_settings(const musurf_host *host, const musurf_setting *settings, size_t count,
                                   musurf_material *material) {
    /* settings[0].size is the stride, and no setting is shorter than its id and source. */
    if (count && (!settings || !COVERS(&settings[0], slot)))
        return refuse(host, MUSURF_NO_PARAM, "settings without a valid size");
    _Bool seen = 0;
    for (size_t i = 0; i < count; ++i) {
        const musurf_setting *setting =
            (const musurf_setting *)(const void *)((const char *)settings + i * settings[0].size);
        if (setting->size != settings[0].size)
            return refuse(host, setting->param, "setting %zu: size %u where the first has %u", i,
                          (unsigned)setting->size, (unsigned)settings[0].size);
        if (setting->param != REFLECTANCE)
            return refuse(host, setting->param, "there is no parameter %u; reflectance is %u",
                          (unsigned)setting->param, (unsigned)REFLECTANCE);
        if (seen) return refuse(host, REFLECTANCE, "reflectance is set twice");
        seen = 1;
        const musurf_result result = set_reflectance(host, setting, material);
        if (result != MUSURF_OK) return result;
    }
    return MUSURF_OK;
}

static musurf_result lambert_compile(const musurf_host *host, const musurf_setting *settings, size_t count,
                                     musurf_material **out) {
    *out = NULL;
    musurf_material made = {.varies = 0};
    for (int i = 0; i < 3; ++i)
        made.reflectance[i] = (float)PARAMS[0].initial[i]; /* the table is the only home of defaults */
    const musurf_result result = read_settings(host, settings, count, &made);
    if (result != MUSURF_OK) return result;

    /* The allocator is a pair: both or neither. */
    const _Bool hosted = host && COVERS(host, release) && host->allocate && host->release;
    musurf_material *material =
        hosted ? host->allocate(host->context, sizeof made, _Alignof(musurf_material)) : malloc(sizeof made);
    if (!material) return MUSURF_NO_MEMORY;
    if (hosted) {
        made.context = host->context;
        made.release = host->release;
    }
    *material = made;
    *out = material;
    return MUSURF_OK;
}

static void lambert_release(musurf_material *material) {
    if (!material) return;
    if (material->release)
        material->release(material->context, material);
    else
        free(material);
}

static void lambert_describe(const musurf_material *material, musurf_plan *plan) {
    const musurf_plan full = {
        .size = plan->size,
        .closure_bytes = sizeof(closure),
        .closure_alignment = _Alignof(closure),
        .lobes = MUSURF_DIFFUSE_REFLECTION,
        .needs = material->varies ? MUSURF_NEEDS_SLOTS : 0u,
        .slot_floats = material->varies ? material->slot + 3 : 0,
        .table_bytes = 0,
        .material_bytes = sizeof(musurf_material),
        .name = material->varies ? "lambert varying" : "lambert constant",
        .left_out = material->varies ? "" : "slots",
    };
    /* Write up to the host's idea of the struct, not a byte further. */
    memcpy(plan, &full, plan->size < sizeof full ? plan->size : sizeof full);
}

/* ------------------------------------------------------------------------------------------------ shading
 * From here on: no allocation, no lock, no I/O, no host. Inputs may be anything finite; answers are too. */

static const float INV_PI = 0.318309886183790671538f;

static uint32_t lambert_setup(const musurf_material *material, const float wo[3], const float *slots,
                              uint32_t mode, void *memory) {
    (void)mode;                 /* radiance and importance scatter alike without refraction */
    if (!(wo[2] > 0)) return 0; /* one-sided: black from below */
    closure *c = memory;
    for (int i = 0; i < 3; ++i) {
        const float value = material->varies ? slots[material->slot + (uint32_t)i] : material->reflectance[i];
        c->reflectance[i] = value > 0 ? (value < 1 ? value : 1) : 0; /* NaN becomes 0 */
    }
    c->cos_o = wo[2];
    return MUSURF_DIFFUSE_REFLECTION;
}

static void lambert_eval(const void *memory, const float wi[3], uint32_t lobes, musurf_value *out) {
    const closure *c = memory;
    *out = (musurf_value){.lobes = 0};
    if (!(lobes & MUSURF_DIFFUSE_REFLECTION) || !(wi[2] > 0)) return;
    for (int i = 0; i < 3; ++i) out->f[i] = c->reflectance[i] * INV_PI * wi[2]; /* times the cosine */
    out->pdf = wi[2] * INV_PI;
    out->pdf_reverse = c->cos_o * INV_PI; /* the same sampler with wo and wi exchanged */
    out->lobes = MUSURF_DIFFUSE_REFLECTION;
}

static float lambert_pdf(const void *memory, const float wi[3], uint32_t lobes) {
    (void)memory;
    return (lobes & MUSURF_DIFFUSE_REFLECTION) && wi[2] > 0 ? wi[2] * INV_PI : 0;
}

/* Cosine-distributed: a uniform point of the disc, lifted to the hemisphere (Malley's method). */
static void lambert_sample(const void *memory, const float u[3], uint32_t lobes, musurf_sample *out) {
    const closure *c = memory;
    *out = (musurf_sample){.lobe = 0};
    if (!(lobes & MUSURF_DIFFUSE_REFLECTION)) return;
    const float radius = sqrtf(u[0]), phi = 6.28318530717958647692f * u[1];
    const float wi[3] = {radius * cosf(phi), radius * sinf(phi), sqrtf(1 - u[0])};
    const float wm[3] = {0, 0, 1}; /* a diffuse facet is the macrosurface */
    for (int i = 0; i < 3; ++i) {
        out->wi[i] = wi[i];
        out->wm[i] = wm[i];
        out->weight[i] = c->reflectance[i]; /* f cos / pdf, with the cosine and pi cancelled on paper */
    }
    out->pdf = wi[2] * INV_PI;
    out->pdf_reverse = c->cos_o * INV_PI;
    out->eta = 1;
    out->roughness = 1;
    out->lobe = MUSURF_DIFFUSE_REFLECTION;
}

static void lambert_albedo(const void *memory, float rgb[3]) {
    memcpy(rgb, ((const closure *)memory)->reflectance, 3 * sizeof *rgb); /* exact */
}

static void lambert_blur(void *memory, float alpha) {
    (void)memory;
    (void)alpha; /* nothing is rougher than diffuse */
}

/* Batches: a stride of 0 repeats one element. A plugin with nothing better to do loops over the scalar call.
 */
static void lambert_eval_batch(const void *closures, size_t closure_stride, const float *wi, size_t wi_stride,
                               uint32_t lobes, musurf_value *out, size_t out_stride, size_t count) {
    for (size_t i = 0; i < count; ++i)
        lambert_eval((const char *)closures + i * closure_stride,
                     (const float *)(const void *)((const char *)wi + i * wi_stride), lobes,
                     (musurf_value *)(void *)((char *)out + i * out_stride));
}

static void lambert_sample_batch(const void *closures, size_t closure_stride, const float *u, size_t u_stride,
                                 uint32_t lobes, musurf_sample *out, size_t out_stride, size_t count) {
    for (size_t i = 0; i < count; ++i)
        lambert_sample((const char *)closures + i * closure_stride,
                       (const float *)(const void *)((const char *)u + i * u_stride), lobes,
                       (musurf_sample *)(void *)((char *)out + i * out_stride));
}

static const void *lambert_extension(const char *id) {
    (void)id;
    return NULL; /* none: the contract is whole without them */
}

/* -------------------------------------------------------------------------------------------------- entry */

static const musurf_material_type LAMBERT = {
    .size = sizeof(musurf_material_type),
    .param_count = PARAM_COUNT,
    .id = "template.lambert",
    .label = "Lambert",
    .doc = "Ideal diffuse reflection: the same radiance in every direction.",
    .params = PARAMS,
    .compile = lambert_compile,
    .release = lambert_release,
    .describe = lambert_describe,
    .setup = lambert_setup,
    .eval = lambert_eval,
    .sample = lambert_sample,
    .pdf = lambert_pdf,
    .albedo = lambert_albedo,
    .blur = lambert_blur,
    .eval_batch = lambert_eval_batch,
    .sample_batch = lambert_sample_batch,
    .extension = lambert_extension,
};

/* The only symbol that leaves the shared object; no init, no mutable state behind it. */
const musurf_plugin *musurf_plugin_v1(void);

const musurf_plugin *musurf_plugin_v1(void) {
    static const musurf_material_type *const types[] = {&LAMBERT};
    static const musurf_plugin plugin = {
        .size = sizeof(musurf_plugin),
        .abi_minor = MUSURF_ABI_MINOR,
        .name = "musurf template",
        .version = MUSURF_VERSION,
        .license = "MIT",
        .type_count = sizeof types / sizeof types[0],
        .types = types,
    };
    return &plugin;
}
