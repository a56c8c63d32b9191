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

/* Which of Smith's G2 a material says it has. */
typedef enum mu_form { MU_FORM_HEIGHT, MU_FORM_SEPARABLE, MU_FORM_DIRECTION } mu_form;

/* Light that meets several facets: lost, made up for by a smooth lobe, or followed (f is an estimate then). */
typedef enum mu_bounces { MU_ONCE, MU_SMOOTH_LOBE, MU_WALKS } mu_bounces;

typedef struct mu_subject {
    const musurf_material_type *type; /* NULL: no shading calls to test */
    const musurf_material *material;
    const musurf_probe *probe;
    musurf_precision precision;
    musurf_sampler sampler; /* what the material's own pdf belongs to; AS_SET: a mixture */
    const char *json;       /* the material's definition on one line, for `musurf eval` */
    mu_form form;
    mu_bounces bounces;
    _Bool jumps; /* D is made of cells */
    double eta; /* n_i/n_o of what it transmits, seen from the side under test; 0: it is opaque */
    _Bool
        below; /* tested from below: every direction is turned over on its way in and out, and all laws stay */
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
 * component; of a reflected wi so that the half-vector moves as far as the rounding of wo and wi can move it. */
mu_answer mu_subject_ask_rounded(const mu_subject *subject, double epsilon, const double wo[3],
                                 const double *wm, const double *wi);

/* The probe, asked from the side under test. */
musurf_result mu_subject_evaluate(const mu_subject *subject, const double wo[3], const double *wm,
                                  const double *wi, musurf_probe_values *out);
musurf_result mu_subject_sample(const mu_subject *subject, musurf_sampler sampler, const double wo[3],
                                const double u[3], musurf_probe_sample *out);

/* Share by which a density may change because the normal is recovered from wi, rounded to epsilon: as a half-vector of
 * length 2 v.m > v.n, or, refracted, of length |eta - 1| and more. */
double mu_subject_blur(const mu_subject *subject, const double view[3], _Bool refracted);

/* Which sampler the material's own pdf belongs to, found out by sampling; false if the probe does not answer. */
_Bool mu_subject_find_sampler(mu_subject *subject);
/* The plane from the material's own samples, for materials of which nothing else is known. */
_Bool mu_subject_find_plane(mu_subject *subject);

#endif
