/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_parameters.h: the parameters of "musurf.microfacet", and how settings become a definition. */
#ifndef MUSURF_PARAMETERS_H
#define MUSURF_PARAMETERS_H

#include "core/bsdf/musurf.h"
#include "plugin/musurf_plugin.h"

enum { PARAMETER_COUNT = 13 };
extern const musurf_param musurf_parameters[PARAMETER_COUNT];

/* What the settings say. M is transform times diag(stretch); with varying, transform is read from slots at
 * each hit. */
typedef struct parsed {
    mu_definition definition; /* definition.transform is M, or diag(stretch) if varying */
    double stretch[2];        /* the diagonal of M_s, Eq. (31) */
    int varying;
    uint32_t slot;
} parsed;

musurf_result musurf_parse(const musurf_host *host, const musurf_setting *settings, size_t count,
                           parsed *out);

/* 1 if a struct that says its own size reaches to the end of the member. */
#define COVERS(pointer, member) ((pointer)->size >= (char *)(&(pointer)->member + 1) - (char *)(pointer))

#endif
