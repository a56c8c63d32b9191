/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_plugin.h: the contract between a host renderer and a shared object of materials.
 *
 *     void *so = dlopen("musurf_material.so", RTLD_NOW | RTLD_LOCAL);
 *     const musurf_plugin *plugin = ((musurf_plugin_entry)dlsym(so, MUSURF_ENTRY_NAME))();
 *     const musurf_material_type *type = plugin->types[0];
 *
 *     const double alpha = 0.2, m[4] = {5, 0, 0, 1};                  // rows [a c], [b d]: 5x stretch along x
 *     musurf_setting set[2] = {{sizeof set[0], alpha_id, MUSURF_CONSTANT, 0, &alpha, NULL, 0},
 *                              {sizeof set[0], transform_id, MUSURF_CONSTANT, 0, m, NULL, 0}};
 *     musurf_material *material;
 *     if (type->compile(&host, set, 2, &material) != MUSURF_OK) ...    // once; then shared by all threads
 *
 *     musurf_plan plan = {sizeof plan};                               // how large is a closure, what may it do?
 *     type->describe(material, &plan);
 *     unsigned char closure[256];                                     // host memory, plan.closure_bytes used
 *     if (type->setup(material, wo, NULL, 0, closure)) {              // per hit: binds wo
 *         type->sample(closure, u, MUSURF_ALL_LOBES, &sample);        // throughput *= sample.weight
 *         type->eval(closure, wi, MUSURF_ALL_LOBES, &value);          // radiance += value.f * light / pdf
 *     }
 *     type->release(material);
 *
 * CONVENTIONS
 * - Frame: right-handed, local to the hit; +z is the macrosurface normal, +x the tangent. Directions are unit
 *   vectors pointing away from the surface; wo goes to the viewer, wi to the light.
 * - Values and pdfs are per steradian. `f` includes the foreshortening |wi.z|; nothing else in this header does.
 * - Numbers going in cold are double, numbers while shading are float.
 * - Three lifetimes. The plugin: as long as the shared object is loaded. A material: from compile to release,
 *   immutable in between. A closure: plain bytes in host memory, copied or dropped at will, valid as long as its
 *   material and the slots given to setup are.
 * - Threads. [any] callable from any thread at any time, also on the same object. [owner] one thread at a time
 *   per object. There is no init and no deinit; the plugin has no mutable state of its own.
 * - While shading (setup, eval, sample, pdf, albedo, blur and their batches) nothing allocates, locks, does I/O
 *   or calls the host.
 * - Never does a function return NaN or infinity for finite unit directions, nor a negative value.
 *
 * COMPATIBILITY
 * Cold structs start with `size`, set to sizeof by whoever fills them; they only ever grow at the end, and the
 * reader looks no further than size covers. Hot records are frozen for the life of the major version, which is
 * part of the entry point's name. Ids of parameters and lobes are never reused. Anything rare comes by string id.
 */
#ifndef MUSURF_PLUGIN_H
#define MUSURF_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MUSURF_ABI_MAJOR  1
#define MUSURF_ABI_MINOR  0
#define MUSURF_ENTRY_NAME "musurf_plugin_v1"

/* ---------------------------------------------------------------------------------------------- results */

/* Fixed-width so that a compiler's choice of enum size is no part of the ABI. */
typedef int32_t musurf_result;
enum {
    MUSURF_OK = 0,
    MUSURF_INVALID = 1,    /* a setting is out of range or of the wrong kind; the host's message says which */
    MUSURF_NO_MEMORY = 2,  /* the host's allocator, or malloc, returned NULL; nothing leaks */
    MUSURF_UNSUPPORTED = 3 /* legal, but not by this plugin: e.g. a parameter that may not vary */
};

typedef int32_t musurf_severity;
enum { MUSURF_INFO = 0, MUSURF_WARNING = 1, MUSURF_ERROR = 2 };

#define MUSURF_NO_PARAM 0u

/* ------------------------------------------------------------------------------------------------- host */

/* What the host offers while compiling. Everything after `context` may be NULL or beyond `size`. */
typedef struct musurf_host {
    uint32_t size; /* sizeof(musurf_host) as the host was built */
    uint32_t abi_minor;
    void *context; /* handed back in each call */

    /* One line, without a newline. `param` is the id of the parameter it is about, or MUSURF_NO_PARAM.
     * Called on the thread that called the plugin, never while shading. */
    void (*message)(void *context, musurf_severity severity, uint32_t param, const char *text);

    /* Both or neither. `alignment` is a power of two. Used by compile; `release` also by release(), so the
     * pair and its context must outlive the material. */
    void *(*allocate)(void *context, size_t bytes, size_t alignment);
    void (*release)(void *context, void *memory);
} musurf_host;

/* ------------------------------------------------------------------------------------------- parameters */

typedef uint32_t musurf_kind;
enum {
    MUSURF_NUMBER = 1,  /* one double */
    MUSURF_COLOR = 2,   /* three doubles: linear RGB */
    MUSURF_MATRIX = 3,  /* four doubles: the two rows of a 2x2 map of tangent-plane positions */
    MUSURF_CHOICE = 4,  /* text: one of `choices` */
    MUSURF_FLAG = 5,    /* one double: 0 or 1 */
    MUSURF_VECTOR = 6,  /* two doubles: x and y in the tangent plane */
    MUSURF_MATRIX3 = 7, /* nine doubles: the three rows of a 3x3 matrix */
    MUSURF_GRID = 8, /* columns, rows, x_min, x_max, y_min, y_max, and a number per cell, row by row from (x_min,
                      * y_min) on; the parameter's range is that of the cells. The setting's `count` tells how many */
    MUSURF_FOOTPRINT = 9 /* six doubles, (u, v) of a centre and of two half-axes: the parallelogram of texture
                          * coordinates that is seen at once; not finite: all there is */
};

enum {
    MUSURF_MAY_VARY = 1u << 0,     /* accepts MUSURF_SLOT: a value per hit */
    MUSURF_MIN_EXCLUDED = 1u << 1, /* the range is open at min */
    MUSURF_MAX_EXCLUDED = 1u << 2, /* the range is open at max */
    MUSURF_NO_DEFAULT = 1u << 3    /* absent unless set: `initial` says nothing */
};

/*
 * The one home of a parameter's name, kind, range, default, unit and documentation: scene files, `musurf info`
 * and host user interfaces are made from this table. A dot in a name nests: "fresnel.schlick" is the color that
 * goes with the choice "schlick" of the choice parameter "fresnel". A choice parameter "sampler" that offers "auto" picks
 * what draws directions with the least noise: a host that renders should set it where the user leaves it open.
 */
typedef struct musurf_param {
    uint32_t size;
    uint32_t id; /* never reused, never 0 */
    const char *name;
    const char *label; /* for user interfaces */
    const char *doc;   /* one sentence or two */
    const char *unit;  /* "" if none */
    musurf_kind kind;
    uint32_t flags;
    double min, max;           /* of each number; infinite if unbounded */
    double soft_min, soft_max; /* what a slider should span */
    double initial[4];         /* the default */
    const char *initial_choice;
    const char *const *choices; /* NULL-terminated; NULL unless MUSURF_CHOICE */
} musurf_param;

typedef uint32_t musurf_source;
enum {
    MUSURF_CONSTANT = 0, /* values or text below */
    MUSURF_SLOT = 1      /* varies: floats at slots[slot], handed to setup at each hit */
};

/* One parameter's value. Parameters that are not set keep their default. */
typedef struct musurf_setting {
    uint32_t size;
    uint32_t param;
    musurf_source source;
    uint32_t slot;        /* index of the first float; the kind tells how many follow */
    const double *values; /* read during compile only */
    const char *text;     /* read during compile only */
    size_t count;         /* doubles in `values`; may be 0 but for MUSURF_GRID, whose kind does not tell */
} musurf_setting;

/* ----------------------------------------------------------------------------------------------- lobes */

enum {
    MUSURF_GLOSSY_REFLECTION = 1u << 0,
    MUSURF_DELTA_REFLECTION = 1u << 1,
    MUSURF_GLOSSY_TRANSMISSION = 1u << 2,
    MUSURF_DELTA_TRANSMISSION = 1u << 3,
    MUSURF_DIFFUSE_REFLECTION = 1u << 4,
    MUSURF_DIFFUSE_TRANSMISSION = 1u << 5
};
#define MUSURF_ALL_LOBES   0xffffffffu
#define MUSURF_DELTA_LOBES (MUSURF_DELTA_REFLECTION | MUSURF_DELTA_TRANSMISSION)

/* setup's mode bits */
enum {
    MUSURF_IMPORTANCE = 1u << 0 /* wo is on the light's path: transport importance instead of radiance */
};

/* ----------------------------------------------------------------------------------------- hot records */

/* What eval answers. Delta lobes contribute nothing here. Frozen. */
typedef struct musurf_value {
    float f[3];        /* BSDF times |wi.z| */
    float pdf;         /* density of sampling wi, given wo */
    float pdf_reverse; /* density of sampling wo, given wi */
    uint32_t lobes;    /* those that contributed; 0: f and pdf are 0 */
} musurf_value;

/* What sample answers. A rejected sample has lobe 0, weight 0, pdf 0; it counts as a sample. Frozen. */
typedef struct musurf_sample {
    float wi[3];
    float wm[3];     /* the micronormal that made it; the half-vector, unrounded */
    float weight[3]; /* f |wi.z| / pdf, analytic: never recomputed as a quotient */
    float pdf;       /* of a delta lobe: its discrete probability, and f is weight times it */
    float pdf_reverse;
    float eta;       /* n_transmitted / n_incident along this path; 1 for reflection */
    float roughness; /* slope roughness alpha of the sampled lobe: 0 for a delta lobe, 1 for diffuse */
    uint32_t lobe;   /* exactly one bit, or 0 when rejected */
} musurf_sample;

/* ----------------------------------------------------------------------------------------------- types */

typedef struct musurf_material musurf_material; /* opaque: the plugin's */

enum {
    MUSURF_NEEDS_TANGENT = 1u << 0, /* shading depends on the tangent: give it a continuous one */
    MUSURF_NEEDS_SLOTS = 1u << 1,   /* setup reads slots */
    /* Details of the surface are told apart at the scale of a pixel. Compile again with the parameter of kind
     * MUSURF_FOOTPRINT in a slot, and hand over the pixel's at each hit; without, or where setup's slots are NULL, the
     * surface looks as from afar. Not set where a constant footprint is. */
    MUSURF_NEEDS_FOOTPRINT = 1u << 2
};

/* What compile decided. The host fills in `size`, the plugin the rest up to it. */
typedef struct musurf_plan {
    uint32_t size;
    uint32_t closure_bytes;
    uint32_t closure_alignment; /* at most 64 */
    uint32_t lobes;             /* all that may ever be returned */
    uint32_t needs;
    uint32_t slot_floats; /* how many floats of `slots` setup may read */
    uint32_t table_bytes; /* tables built for this material */
    uint32_t material_bytes;
    const char *name;     /* the chosen plan, for people and tests: "gtr general-transform table" */
    const char *left_out; /* what this material did not need, comma-separated; lives with the material */
    const char *sampler;  /* what draws its directions, and why; lives with the material. May be NULL */
} musurf_plan;

typedef struct musurf_material_type {
    uint32_t size;
    uint32_t param_count;
    const char *id; /* "vendor.name"; the types of a vendor live in vendor_material.so */
    const char *label;
    const char *doc;
    const musurf_param *params; /* an array with stride params[0].size */

    /* [any] Checks and prepares a material. On failure *out is NULL and the host's message said why. Settings
     * form an array with stride settings[0].size; a parameter set twice is an error. */
    musurf_result (*compile)(const musurf_host *host, const musurf_setting *settings, size_t count,
                             musurf_material **out);
    /* [owner] NULL is fine. No closure of it may be used afterwards. */
    void (*release)(musurf_material *material);
    /* [any] */
    void (*describe)(const musurf_material *material, musurf_plan *plan);

    /* [any] Binds wo, and the slots of this hit, into `closure`. Returns the lobes that can be non-zero; 0 means
     * that the surface is black from here and the closure must not be used. */
    uint32_t (*setup)(const musurf_material *material, const float wo[3], const float *slots, uint32_t mode,
                      void *closure);
    /* [any] f, pdf and reverse pdf in one call: they share nearly all their work. */
    void (*eval)(const void *closure, const float wi[3], uint32_t lobes, musurf_value *out);
    /* [any] u: independent uniforms in [0,1). u[0], u[1] move the direction, u[2] chooses among alternatives. */
    void (*sample)(const void *closure, const float u[3], uint32_t lobes, musurf_sample *out);
    /* [any] The pdf of eval alone. */
    float (*pdf)(const void *closure, const float wi[3], uint32_t lobes);
    /* [any] An estimate in [0,1] of the directional albedo, for guiding and denoising; no guarantee. */
    void (*albedo)(const void *closure, float rgb[3]);
    /* [any] Raises the closure's slope roughness to at least `alpha`: what path regularisation wants. A material may ask to be
     * told at compile that it will be (parameter "blurs" of musurf.microfacet), and be darker without. */
    void (*blur)(void *closure, float alpha);

    /* [any] Batches: element i of a stream lies i*stride bytes behind its base; stride 0 repeats one element.
     * The results are the same bits as those of the scalar calls. */
    void (*eval_batch)(const void *closure, size_t closure_stride, const float *wi, size_t wi_stride,
                       uint32_t lobes, musurf_value *out, size_t out_stride, size_t count);
    void (*sample_batch)(const void *closure, size_t closure_stride, const float *u, size_t u_stride,
                         uint32_t lobes, musurf_sample *out, size_t out_stride, size_t count);

    /* [any] A rare capability by id and revision ("musurf.probe/1"), or NULL. */
    const void *(*extension)(const char *id);
} musurf_material_type;

/* ----------------------------------------------------------------------------------------------- entry */

typedef struct musurf_plugin {
    uint32_t size;
    uint32_t abi_minor;
    const char *name;
    const char *version;
    const char *license;
    size_t type_count;
    const musurf_material_type *const *types;
} musurf_plugin;

/* [any] The one exported symbol, named MUSURF_ENTRY_NAME. Returns a constant; never NULL. */
typedef const musurf_plugin *(*musurf_plugin_entry)(void);

#ifdef __cplusplus
}
#endif
#endif /* MUSURF_PLUGIN_H */
