/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * reads.h: techniques of image-based lighting, side by side. Each is a rule that turns a lobe and a view into a few reads of an
 * environment filtered in advance: where to look, how blurred, with what weight. In float; frame of wo, as ibl.h.
 *
 * The radiance seen is the directional albedo times the sum of the reads: weights are 1 in all, so that in even light every
 * technique gives the albedo.
 */
#ifndef MU_IBL_READS_H
#define MU_IBL_READS_H

#include "core/ibl/ibl.h"

enum { MU_IBL_READS_MOST = 64 };

typedef struct mu_ibl_read {
    float direction[3];
    float roughness; /* alpha_lin, 0 to 1: that times levels - 1 is the level, Eq. (3) */
    float weight;
} mu_ibl_read;

/* MU_IBL_SPLIT: the split integral (Karis 2013): one read, along the mirrored view, of the isotropic lobe whose roughness is
 *     the mean of both, the paper's h1.
 * MU_IBL_BENT_NORMAL: Revie 2011 as Lagarde and Golubev 2018 have it: one read, mirrored at a normal that is bent across the
 *     grain, and sharper than h1.
 * MU_IBL_MAJOR_AXIS: N reads along the axis, all alike, Eq. (5).
 * MU_IBL_LOBE: N reads all over the lobe, each as wide as the lobe is across where it stands (spread.h).
 * MU_IBL_FILTERED: n x n reads, the largest square up to N, by filtered importance sampling (importance.h).
 * The one list of them, with their names in scenes and for people. */
#define MU_IBL_FOR_TECHNIQUES(X)               \
    X(SPLIT, "split", "split integral")        \
    X(BENT_NORMAL, "bent-normal", "bent normal") \
    X(MAJOR_AXIS, "major-axis", "major axis")  \
    X(LOBE, "lobe", "whole lobe")              \
    X(FILTERED, "filtered", "filtered importance")
#define MU_IBL_TECHNIQUE_(name, key, title) MU_IBL_##name,
typedef enum mu_ibl_technique { MU_IBL_FOR_TECHNIQUES(MU_IBL_TECHNIQUE_) MU_IBL_TECHNIQUES } mu_ibl_technique;
#undef MU_IBL_TECHNIQUE_

/* The shape of a distribution beside GGX's: that many times as far from the mean is the slope within which a share of all are, at
 * MU_IBL_TAIL shares from 0 to nearly 1; GGX of the same Sigma is 1 throughout. */
enum { MU_IBL_TAIL = 33 };
double mu_ibl_tail_share(size_t i);
/* Samples of a pixel look between each other's reads: phases, a power of two of them at most. */
enum { MU_IBL_PHASES = 16 };
/* How many reads are chosen at most, where their number is. */
enum { MU_IBL_READS_CHOSEN = 33 };
/* How many of MU_IBL_LOBE where nobody says: a frame takes no longer than with the usual 16 along the axis, measured (`make ibl`, `make bench`). */
enum { MU_IBL_READS_OF_LOBE = 6 };

/* Where the reads of MU_IBL_FILTERED stand, for any lobe (importance.c). */
typedef struct mu_ibl_grid {
    float across[MU_IBL_READS_MOST], along[MU_IBL_READS_MOST], weight[MU_IBL_READS_MOST];
} mu_ibl_grid;

/* What is decided once per material. */
typedef struct mu_ibl_plan {
    mu_ibl_technique technique;
    mu_ibl_settings_f settings;
    int tailed; /* of MU_IBL_LOBE, as what follows */
    float tail[MU_IBL_TAIL];
    float logarithm; /* of the number of reads */
    size_t phases;
    float shared; /* 1 over the phases that look between each other's reads */
    float shift[MU_IBL_PHASES]; /* of a phase's reads, in their distance */
    mu_ibl_grid grid;           /* of MU_IBL_FILTERED */
} mu_ibl_plan;

/* samples from 1 to MU_IBL_READS_MOST; of MU_IBL_LOBE 0 as well: as many as the lobe needs, which changes without a
 * jump. For GGX; and for another shape: its MU_IBL_TAIL numbers. */
void mu_ibl_plan_make(mu_ibl_technique technique, const mu_ibl_settings_f *settings, mu_ibl_plan *plan);
void mu_ibl_plan_tail(mu_ibl_plan *plan, const float *tail);
/* For pictures that are means of so many samples of a pixel, which look between each other's reads. Otherwise 1. */
void mu_ibl_plan_phases(mu_ibl_plan *plan, size_t samples);

/* How many there are, at most MU_IBL_READS_MOST: 1, settings.samples, or what was chosen. wo.z > 0. */
size_t mu_ibl_reads(const mu_ibl_plan *plan, const mu_ibl_lobe_f *lobe, const float wo[3], mu_ibl_read *out);
/* The reads of a view, as arrays; and of up to MU_IBL_AXES views of one lobe at a time. What is left of `wo` must be views, too. */
typedef struct mu_ibl_view {
    size_t count;
    float x[MU_IBL_READS_MOST], y[MU_IBL_READS_MOST], z[MU_IBL_READS_MOST]; /* direction */
    float roughness[MU_IBL_READS_MOST], weight[MU_IBL_READS_MOST];
} mu_ibl_view;
void mu_ibl_reads_of_views(const mu_ibl_plan *plan, const mu_ibl_lobe_f *lobe, size_t views, const float (*wo)[MU_IBL_AXES],
                           mu_ibl_view *out);
/* The same of lobes of their own, lobes[i] of view i, and of sample `phase` of a pixel. */
void mu_ibl_reads_of_lobes(const mu_ibl_plan *plan, size_t phase, size_t views, const mu_ibl_lobe_f *lobes,
                           const float (*wo)[MU_IBL_AXES], mu_ibl_view *out);
/* Of any number: those of sample `phase` of a pixel. */
size_t mu_ibl_reads_of_phase(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                             mu_ibl_read *out);

#endif
