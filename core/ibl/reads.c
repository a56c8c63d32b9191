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
static inline void along_axis(size_t n, const float wo[3], const float along[2], const float middle[2], const float reach[2],
                              float *restrict x, float *restrict y, float *restrict z) {
    const float forward = along[0] * wo[0] + along[1] * wo[1];
    const float p = reach[0], last = n > 1 ? reach[1] : 0, step = n > 1 ? 2 * last / (float)(n - 1) : 0;
    for (size_t j = 0; j < n; j++) {
        const float q = last - (float)(int)j * step, inverse = 1 / sqrt(p * p + q * q);
        const float lean = (p * middle[0] + q * middle[1]) * inverse, rise = (p * middle[1] - q * middle[0]) * inverse,
                    twice = 2 * (lean * forward + rise * wo[2]);
        x[j] = twice * lean * along[0] - wo[0], y[j] = twice * lean * along[1] - wo[1], z[j] = twice * rise - wo[2];
    }
}

static void major_axis(const mu_ibl_lobe_f *lobe, const float wo[3], const mu_ibl_settings_f *settings, mu_ibl_view *out) {
    mu_ibl_axis_f a;
    const size_t n = settings->samples;
    mu_ibl_axis_make_for_samples_f(lobe, wo, settings, &a);
    along_axis(n, wo, a.along, a.middle, a.reach, out->x, out->y, out->z);
    const float roughness = smaller(sqrt(a.radius), 1), weight = 1 / (float)n;
    for (size_t j = 0; j < n; j++) out->roughness[j] = roughness, out->weight[j] = weight;
    out->count = n;
}

static size_t listed(const mu_ibl_view *view, mu_ibl_read *out) {
    for (size_t j = 0; j < view->count; j++)
        out[j] = (mu_ibl_read){{view->x[j], view->y[j], view->z[j]}, view->roughness[j], view->weight[j]};
    return view->count;
}

size_t mu_ibl_reads_of_phase(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                             mu_ibl_read *out) {
    mu_ibl_view view;
    switch (plan->technique) {
    case MU_IBL_BENT_NORMAL:
        return bent_normal(lobe, wo, out);
    case MU_IBL_MAJOR_AXIS:
        major_axis(lobe, wo, &plan->settings, &view);
        return listed(&view, out);
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

static void major_axes(const mu_ibl_lobe_f *lobe, size_t views, const float (*wo)[MU_IBL_AXES], const mu_ibl_settings_f *settings,
                       mu_ibl_view *out) {
    mu_ibl_axes_f a;
    const size_t n = settings->samples;
    mu_ibl_axes_make_f(lobe, wo, settings, &a);
    for (size_t i = 0; i < views; i++) {
        const float o[3] = {wo[0][i], wo[1][i], wo[2][i]}, along[2] = {a.along[0][i], a.along[1][i]},
                    middle[2] = {a.middle[0][i], a.middle[1][i]}, reach[2] = {a.reach[0][i], a.reach[1][i]};
        along_axis(n, o, along, middle, reach, out[i].x, out[i].y, out[i].z);
        const float roughness = smaller(sqrt(a.radius[i]), 1), weight = 1 / (float)n;
        for (size_t j = 0; j < n; j++) out[i].roughness[j] = roughness, out[i].weight[j] = weight;
        out[i].count = n;
    }
}

static void one_by_one(const mu_ibl_plan *plan, size_t phase, size_t views, const mu_ibl_lobe_f *lobes, size_t stride,
                       const float (*wo)[MU_IBL_AXES], mu_ibl_view *out) {
    for (size_t i = 0; i < views; i++) {
        const float o[3] = {wo[0][i], wo[1][i], wo[2][i]};
        mu_ibl_read each[MU_IBL_READS_MOST];
        if (plan->technique == MU_IBL_MAJOR_AXIS) {
            major_axis(lobes + i * stride, o, &plan->settings, &out[i]);
            continue;
        }
        out[i].count = mu_ibl_reads_of_phase(plan, phase, lobes + i * stride, o, each);
        for (size_t j = 0; j < out[i].count; j++) {
            out[i].x[j] = each[j].direction[0], out[i].y[j] = each[j].direction[1], out[i].z[j] = each[j].direction[2];
            out[i].roughness[j] = each[j].roughness, out[i].weight[j] = each[j].weight;
        }
    }
}

void mu_ibl_reads_of_views(const mu_ibl_plan *plan, const mu_ibl_lobe_f *lobe, size_t views, const float (*wo)[MU_IBL_AXES],
                           mu_ibl_view *out) {
    if (plan->technique == MU_IBL_MAJOR_AXIS)
        major_axes(lobe, views, wo, &plan->settings, out);
    else if (plan->technique == MU_IBL_LOBE)
        mu_ibl_spread_views(plan, 0, views, lobe, 0, wo, out);
    else
        one_by_one(plan, 0, views, lobe, 0, wo, out);
}

void mu_ibl_reads_of_lobes(const mu_ibl_plan *plan, size_t phase, size_t views, const mu_ibl_lobe_f *lobes,
                           const float (*wo)[MU_IBL_AXES], mu_ibl_view *out) {
    if (plan->technique == MU_IBL_LOBE)
        mu_ibl_spread_views(plan, phase, views, lobes, 1, wo, out);
    else
        one_by_one(plan, phase, views, lobes, 1, wo, out);
}

#endif
