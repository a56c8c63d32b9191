/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_parameters.h: the parameters of "musurf.microfacet", and how settings become a definition. */
#ifndef MUSURF_PARAMETERS_H
#define MUSURF_PARAMETERS_H

#include "core/bsdf/musurf.h"
#include "plugin/musurf_plugin.h"
#include "plugin/musurf_varying.h"

/* Ids, as in the table. */
enum {
    NDF = 1,
    ALPHA,
    ROUGHNESS,
    GAMMA,
    TRANSFORM,
    STRETCH,
    FRESNEL,
    SCHLICK,
    DIELECTRIC,
    CONDUCTOR,
    N,
    K,
    SAMPLER_CHOICE,
    EXPONENT,
    ALPHA_X,
    ALPHA_Y,
    ROTATION,
    ANISOTROPY,
    DISNEY,
    CYCLES,
    OPENPBR,
    GLTF,
    COVARIANCE,
    TILT,
    A_MATRIX,
    THETA_X,
    THETA_Y,
    THETA_Z,
    MASKING,
    TRANSMISSION,
    HISTOGRAM,
    FLAKE_DENSITY,
    FLAKE_CONE,
    FLAKE_SEED,
    FOOTPRINT,
    MULTIPLE_SCATTERING,
    SMITH,
    BLURS,
    PARAMETER_END
};
enum { PARAMETER_COUNT = PARAMETER_END - 1 };
extern const musurf_param musurf_parameters[PARAMETER_COUNT];

/* What the settings say. With varying, M is made at each hit: a transform that is read from slots times `inner`, or, where more
 * varies, what `shape` composes. */
typedef struct parsed {
    mu_definition definition; /* definition.transform is `inner` */
    double inner[4];          /* M, rows; varying: stretch, Eq. (31), times anisotropy */
    int sampler_auto;         /* the sampler is to be measured */
    int varying;
    uint32_t slot; /* of transform */
    int composed;  /* more varies than transform */
    musurf_varying shape;
    enum {
        FOOTPRINT_NONE,
        FOOTPRINT_CONSTANT,
        FOOTPRINT_SLOT
    } footprint_from; /* none: or nothing discrete */
    uint32_t footprint_slot;
    double footprint[6];
} parsed;

musurf_result musurf_parse(const musurf_host *host, const musurf_setting *settings, size_t count,
                           parsed *out);

/* 1 if a struct that says its own size reaches to the end of the member. */
#define COVERS(pointer, member) ((pointer)->size >= (char *)(&(pointer)->member + 1) - (char *)(pointer))

#endif
