/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* reads.c: see reads.h. In float; compiled once. */
#include "core/ibl/importance.h"
#include "core/ibl/spread.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

static void mirror(const float m[3], const float wo[3], float out[3]) {
    const float twice = 2 * dot(m, wo);
    for (int k = 0; k < 3; k++) out[k] = twice * m[k] - wo[k];
}

/* h1: alpha_lin of the mean of both roughnesses. */
static float mean_roughness(const mu_ibl_lobe_f *lobe) {
    return smaller(sqrt((lobe->sigma[0] + lobe->sigma[1]) * (float)0.70710678118654752), 1);
}

static size_t split(const mu_ibl_lobe_f *lobe, const float wo[3], mu_ibl_read *out) {
    *out = (mu_ibl_read){{-wo[0], -wo[1], wo[2]}, mean_roughness(lobe), 1};
    return 1;
}

/* The grain runs along V, the smoother axis. The normal across it and nearest to the view is wo less its part along the grain;
 * the true normal gives way to it by the anisotropy, less where the surface is smooth. */
static size_t bent_normal(const mu_ibl_lobe_f *lobe, const float wo[3], mu_ibl_read *out) {
    const float sum = lobe->sigma[0] + lobe->sigma[1], rough = mean_roughness(lobe);
    const float anisotropy = sum > 0 ? (lobe->sigma[0] - lobe->sigma[1]) / sum : 0;
    const float grain[3] = {-lobe->turn[1], lobe->turn[0], 0}, along = dot(grain, wo);
    const float stretch = anisotropy * smaller(1.5f * sqrt(rough), 1);
    float normal[3];
    for (int k = 0; k < 3; k++)
        normal[k] = stretch * (wo[k] - along * grain[k]) + (k == 2 ? 1 - stretch : 0);
    const float length = sqrt(dot(normal, normal));
    if (!(length > 0)) return split(lobe, wo, out); /* fully bent, and seen along the grain */
    for (int k = 0; k < 3; k++) normal[k] /= length;
    mirror(normal, wo, out->direction);
    out->roughness = rough * smaller(1.2f - anisotropy, 1);
    out->weight = 1;
    return 1;
}

/* mu_ibl_axis_sample and a mirror, many at once: all micronormals lie in the plane of z and `along`. */
static size_t major_axis(const mu_ibl_lobe_f *lobe, const float wo[3], const mu_ibl_settings_f *settings,
                         mu_ibl_read *out) {
    mu_ibl_axis_f axis;
    mu_ibl_axis_make_for_samples_f(lobe, wo, settings, &axis);
    const size_t n = settings->samples;
    const float forward = axis.along[0] * wo[0] + axis.along[1] * wo[1];
    const float p = axis.reach[0], last = n > 1 ? axis.reach[1] : 0, step = n > 1 ? 2 * last / (float)(n - 1) : 0;
    float lean[MU_IBL_READS_MOST], rise[MU_IBL_READS_MOST]; /* each times twice the cosine to wo */
    for (size_t j = 0; j < n; j++) {
        const float q = last - (float)(int)j * step, inverse = 1 / sqrt(p * p + q * q);
        const float x = (p * axis.middle[0] + q * axis.middle[1]) * inverse,
                    z = (p * axis.middle[1] - q * axis.middle[0]) * inverse, twice = 2 * (x * forward + z * wo[2]);
        lean[j] = twice * x, rise[j] = twice * z;
    }
    const float roughness = smaller(sqrt(axis.radius), 1), weight = 1 / (float)n;
    for (size_t j = 0; j < n; j++)
        out[j] = (mu_ibl_read){{lean[j] * axis.along[0] - wo[0], lean[j] * axis.along[1] - wo[1], rise[j] - wo[2]},
                               roughness,
                               weight};
    return n;
}

size_t mu_ibl_reads_of_phase(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                             mu_ibl_read *out) {
    switch (plan->technique) {
    case MU_IBL_BENT_NORMAL:
        return bent_normal(lobe, wo, out);
    case MU_IBL_MAJOR_AXIS:
        return major_axis(lobe, wo, &plan->settings, out);
    case MU_IBL_LOBE:
        return mu_ibl_spread_reads(plan, phase, lobe, wo, out);
    case MU_IBL_FILTERED:
        return mu_ibl_importance_reads(&plan->grid, plan->settings.samples, lobe, wo, out);
    default:
        return split(lobe, wo, out);
    }
}

size_t mu_ibl_reads(const mu_ibl_plan *plan, const mu_ibl_lobe_f *lobe, const float wo[3], mu_ibl_read *out) {
    return mu_ibl_reads_of_phase(plan, 0, lobe, wo, out);
}

#endif
