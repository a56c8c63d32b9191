/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_subject.h: a material under test, seen only through the probe and the shading calls of the plugin's
 * ABI, and how far rounding alone may move what it answers.
 */
#ifndef MU_CHECK_SUBJECT_H
#define MU_CHECK_SUBJECT_H

#include "core/render/check_plane.h"
#include "plugin/musurf_probe.h"

typedef struct mu_subject {
    const musurf_material_type *type; /* NULL: no shading calls to test */
    const musurf_material *material;
    const musurf_probe *probe;
    musurf_precision precision;
    musurf_sampler sampler; /* what the material's own pdf belongs to */
    const char *json;       /* the material's definition on one line, for `musurf eval` */
    mu_plane plane;
} mu_subject;

/* Half the distance from 1 to the next number. */
double mu_subject_epsilon(const mu_subject *subject);
/* What the library promises beyond the rounding of inputs: relative 1e-12 in double, 1e-4 in float; four
 * times that, for products and quotients of up to four such values. */
double mu_subject_accuracy(const mu_subject *subject);

/* The quantities that are compared, in one array. */
enum { MU_AT_SIGMA, MU_AT_D, MU_AT_G1, MU_AT_DV, MU_AT_F, MU_AT_G2, MU_AT_PDF, MU_AT_COUNT };

typedef struct mu_answer {
    double value[MU_AT_COUNT];
    double slack[MU_AT_COUNT]; /* how far the value moves when the directions are rounded differently */
    _Bool ok;                  /* the probe answered, with finite numbers that are not negative */
} mu_answer;

/* wm and wi may be NULL. MU_AT_F is the BSDF of the middle channel. */
mu_answer mu_subject_ask(const mu_subject *subject, const double wo[3], const double *wm, const double *wi);
/* The same with slack: the largest change under 8 perturbations of the directions, by 4 epsilon in every
 * component; of wi so that the half-vector moves as far as the rounding of wo and wi can move it. */
mu_answer mu_subject_ask_rounded(const mu_subject *subject, double epsilon, const double wo[3],
                                 const double *wm, const double *wi);

/* Which sampler the material's own pdf belongs to, found out by sampling; false if it is neither. */
_Bool mu_subject_find_sampler(mu_subject *subject);
/* The plane from the material's own samples, for materials of which nothing else is known. */
_Bool mu_subject_find_plane(mu_subject *subject);

#endif
