/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * numbers.c: what `musurf eval` answers for a material, wo, wi and the micronormal halfway between, and `musurf ibl
 * axis` for its lobe; in double. They go out one after the other, in the order of page_number_names.
 */
#include "scripts/page/numbers.h"

#include <math.h>

const char *page_number_names(void) {
    return "wm 3 Lambda 1 sigma 1 D 1 G1 1 Dv 1 f 3 F 3 G2 1 pdf 1 f_cos 3 slope_sigma 2 angle 1 t 2 far 6 "
           "near 6 tau 2 "
           "far_clamped 6 delta 1 width 1 length 1 zeta 1 radius 1";
}

mu_ibl_settings_d page_settings(const double *query) {
    mu_ibl_settings_d s = mu_ibl_settings_default_d();
    s.k = query[PAGE_K], s.beta = query[PAGE_BETA];
    s.samples = (size_t)query[PAGE_SAMPLES];
    s.shift = (mu_ibl_shift)(int)query[PAGE_SHIFT];
    return s;
}

static double *put(double *out, const double *from, int count) {
    for (int k = 0; k < count; k++) *out++ = from[k];
    return out;
}

static double *put_eval(const page_material *m, const double *wo, const double *wi, double *out) {
    mu_closure_d c;
    mu_value_d value = {{0, 0, 0}, 0, 0};
    mu_pair_values_d pair = {{0, 0, 0}, 0};
    double wm[3], cosines[3];
    const int above = mu_bind_d(m->exact, wo, NULL, &c);
    for (int k = 0; k < 3; k++) wm[k] = wo[k] + wi[k];
    const double length = sqrt(wm[0] * wm[0] + wm[1] * wm[1] + wm[2] * wm[2]);
    for (int k = 0; k < 3; k++) wm[k] = length > 0 ? wm[k] / length : k == 2;
    const mu_masking_d view = mu_view_d(&c, wo);
    const mu_normal_values_d normal = mu_normal_d(&c, wm);
    if (above) pair = mu_pair_d(&c, wi), mu_eval_d(&c, wi, &value);
    for (int k = 0; k < 3; k++) cosines[k] = value.f[k] * wi[2];
    const double each[5] = {view.Lambda, view.sigma, normal.D, normal.G1, normal.Dv};
    out = put(put(out, wm, 3), each, 5);
    out = put(put(out, value.f, 3), pair.F, 3);
    return put(put(put(out, &pair.G2, 1), &value.pdf, 1), cosines, 3);
}

void page_numbers(const page_material *m, const double *query, double *out) {
    const mu_ibl_settings_d settings = page_settings(query);
    mu_ibl_axis_d axis;
    out = put_eval(m, query + PAGE_WO, query + PAGE_WI, out);
    mu_ibl_axis_make_d(&m->lobe_exact, query + PAGE_WO, &settings, &axis);
    out = put(put(out, m->lobe_exact.sigma, 2), &m->angle, 1);
    out = put(put(put(out, axis.t, 2), axis.far[0], 6), axis.near[0], 6);
    out = put(put(out, axis.tau, 2), axis.far_clamped[0], 6);
    const double each[5] = {axis.delta, axis.width, axis.length, axis.zeta, axis.radius};
    put(out, each, 5);
}

void page_samples(const page_material *m, const double *query, double *out) {
    const mu_ibl_settings_d settings = page_settings(query);
    mu_ibl_axis_d axis;
    mu_ibl_axis_make_d(&m->lobe_exact, query + PAGE_WO, &settings, &axis);
    for (size_t j = 0; j < settings.samples; j++)
        mu_ibl_axis_sample_d(&axis, settings.samples, j, out + 3 * j);
}
