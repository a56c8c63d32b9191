/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_tests.h: the groups of comparisons that `musurf check` makes of one material. Each writes into the
 * tally of its thread. In all, `view` is a unit vector with z > 0.
 */
#ifndef MU_CHECK_TESTS_H
#define MU_CHECK_TESTS_H

#include <stdint.h>

#include "core/render/check_random.h"
#include "core/render/check_tally.h"

typedef struct mu_check_effort {
    double target;          /* error wanted of an integral that should be 1, in double; float stops at 1e-4 */
    size_t panels;          /* of adaptive quadrature */
    size_t samples;         /* of each sampler and view */
    size_t shading_samples; /* the same, of the shading calls, which are faster */
    size_t cells;           /* of each chi^2 */
    size_t points;          /* compared pointwise per view */
} mu_check_effort;

/* What the sphere of wi holds, by quadrature. Transmitted f counts as importance, eta^2 f, which is conserved. */
typedef struct mu_reflected {
    double pdf;    /* integral of pdf */
    double albedo; /* integral of f |cos| */
    double square; /* integral of (f cos)^2 / pdf: the second moment of the weight */
    double error;  /* of pdf and albedo, quadrature and rounding */
    _Bool resolved;
} mu_reflected;

/* Eq. (3). */
void mu_check_normalisation(const mu_subject *subject, const mu_check_effort *effort, mu_tally *tally);
/* Eq. (2), sigma, Dv. */
void mu_check_visible(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                      mu_tally *tally);
mu_reflected mu_check_scattered(const mu_subject *subject, const mu_check_effort *effort,
                                const double view[3], mu_tally *tally);

/* chi^2 of one sampler's normals; of the material's own sampler also its directions, rejections and weights, and its
 * shading calls. AS_SET is for mixtures, whose normals have no density of their own. */
void mu_check_sampler(const mu_subject *subject, const mu_check_effort *effort, musurf_sampler sampler,
                      const double view[3], const mu_reflected *scattered, mu_stream *random,
                      mu_tally *tally);

/* Averages, of materials whose f is an estimate. */
void mu_check_walk(const mu_subject *subject, const mu_check_effort *effort, const double view[3], mu_stream *random,
                   mu_tally *tally);

/* Identities between the quantities at sampled directions. */
void mu_check_points(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                     mu_stream *random, mu_tally *tally);

/* The float shading calls against the probe. */
void mu_check_shading(const mu_subject *subject, const mu_check_effort *effort, const double view[3],
                      mu_stream *random, mu_tally *tally);

/* How a material was made from its original: the position map (x, y, z) -> (M (x, y), z + tilt.(x, y)). */
typedef struct mu_deformation {
    double m[4]; /* rows */
    double tilt[2];
    double determinant; /* of M, signed */
    _Bool more;         /* the original is not isotropic itself: what its azimuths are, it alone knows */
} mu_deformation;
void mu_check_transform(const mu_subject *subject, const mu_subject *original, const mu_deformation *how,
                        const mu_check_effort *effort, const double view[3], mu_stream *random,
                        mu_tally *tally);
/* `turned` is the subject with M turned by `angle` about the normal. */
void mu_check_rotation(const mu_subject *subject, const mu_subject *turned, double angle,
                       const mu_check_effort *effort, const double view[3], mu_stream *random,
                       mu_tally *tally);
/* GGX with the textbook's roughness along x and y. */
void mu_check_classic(const mu_subject *subject, double alpha_x, double alpha_y,
                      const mu_check_effort *effort, const double view[3], mu_stream *random,
                      mu_tally *tally);

#endif
