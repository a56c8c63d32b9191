/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_probe_real.h: the probe in one precision. Included twice by musurf_probe.c, with REAL and IN(name).
 */

static int IN(normalised)(const double w[3], REAL out[3]) {
    const double largest = fmax(fabs(w[0]), fmax(fabs(w[1]), fabs(w[2])));
    if (!(largest > 0 && largest <= DBL_MAX) || isnan(w[0] + w[1] + w[2])) return 0;
    REAL length = 0;
    for (int k = 0; k < 3; k++) out[k] = (REAL)(w[k] / largest), length += out[k] * out[k];
    length = (REAL)sqrt((double)length);
    for (int k = 0; k < 3; k++) out[k] /= length;
    return 1;
}

static musurf_result IN(evaluate)(const IN(mu_surface) * surface, const double *footprint, const double wo[3],
                                  const double *wm, const double *wi, musurf_probe_values *out) {
    REAL o[3], m[3], i[3];
    *out = (musurf_probe_values){0};
    if (!IN(normalised)(wo, o) || (wm && !IN(normalised)(wm, m)) || (wi && !IN(normalised)(wi, i)))
        return MUSURF_INVALID;
    IN(mu_closure) closure;
    const int above = IN(mu_bind)(surface, o, NULL, &closure);
    IN(mu_footprint)(&closure, footprint);
    out->delta = closure.is_delta != 0;
    if (o[2] * closure.side >= 0) {
        const IN(mu_masking) view = IN(mu_view)(&closure, o);
        out->Lambda = (double)view.Lambda;
        out->sigma = (double)view.sigma;
    }
    if (wm) {
        const IN(mu_normal_values) normal = IN(mu_normal)(&closure, m);
        out->D = (double)normal.D;
        out->G1 = (double)normal.G1;
        out->Dv = (double)normal.Dv;
    }
    if (wi && above) {
        IN(mu_value) value;
        const IN(mu_pair_values) pair = IN(mu_pair)(&closure, i);
        IN(mu_eval)(&closure, i, &value);
        for (int k = 0; k < 3; k++) out->f[k] = (double)value.f[k], out->F[k] = (double)pair.F[k];
        out->G2 = (double)pair.G2;
        out->pdf = (double)value.pdf;
    }
    return MUSURF_OK;
}

static musurf_result IN(draw)(const IN(mu_surface) * surface, const double *footprint, mu_sampler sampler,
                              const double wo[3], const double u[3], musurf_probe_sample *out) {
    REAL o[3], v[3];
    *out = (musurf_probe_sample){.rejected = 1};
    if (!IN(normalised)(wo, o)) return MUSURF_INVALID;
    for (int k = 0; k < 3; k++) {
        if (!(u[k] >= 0 && u[k] < 1)) return MUSURF_INVALID;
        v[k] = (REAL)u[k];
        if (v[k] >= 1) v[k] = 1 - (REAL)FLT_EPSILON / 2; /* rounded up */
    }
    IN(mu_closure) closure;
    if (!IN(mu_bind)(surface, o, NULL, &closure)) return MUSURF_OK;
    IN(mu_footprint)(&closure, footprint);
    IN(mu_sample) sample;
    IN(mu_sample_with)(&closure, sampler, v, &sample);
    out->rejected = (uint32_t)sample.rejected;
    out->delta = (uint32_t)sample.delta;
    for (int k = 0; k < 3; k++) {
        out->wi[k] = (double)sample.wi[k], out->wm[k] = (double)sample.wm[k];
        out->f[k] = (double)sample.f[k], out->weight[k] = (double)sample.weight[k];
    }
    out->pdf = (double)sample.pdf;
    return MUSURF_OK;
}
