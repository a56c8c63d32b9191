/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* double_ggx.c: see double_ggx.h. */
#include "tests/double_ggx.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise(double w[3]) {
    const double length = sqrt(dot(w, w));
    for (int c = 0; c < 3; c++) w[c] /= length;
}

static double lambda(const double_ggx *g, const double w[3]) {
    const double x = g->ax * w[0], y = g->ay * w[1];
    return (sqrt(1 + (x * x + y * y) / (w[2] * w[2])) - 1) / 2;
}

static double density(const double_ggx *g, const double m[3]) {
    const double x = m[0] / g->ax, y = m[1] / g->ay, s = x * x + y * y + m[2] * m[2];
    return m[2] > 0 ? g->mass / (PI * g->ax * g->ay * s * s) : 0;
}

static double visible(const double_ggx *g, const double wo[3], const double m[3]) {
    return fmax(0, dot(wo, m)) * density(g, m) / (wo[2] * (1 + lambda(g, wo)));
}

static double pdf_of_normal(const double_ggx *g, const double wo[3], const double m[3]) {
    return (g->pdf_of_ndf != 0 ? density(g, m) * m[2] : visible(g, wo, m)) / (4 * dot(wo, m));
}

static musurf_result evaluate(const musurf_material *material, musurf_precision precision, const double wo[3],
                              const double *wm, const double *wi, musurf_probe_values *out) {
    const double_ggx *g = (const double_ggx *)(const void *)material;
    (void)precision;
    memset(out, 0, sizeof *out);
    out->Lambda = lambda(g, wo);
    out->sigma = wo[2] * (1 + out->Lambda);
    if (wm) {
        out->D = density(g, wm);
        out->G1 = dot(wo, wm) > 0 ? 1 / (1 + out->Lambda) : 0;
        out->Dv = visible(g, wo, wm);
    }
    if (wi && wi[2] > 0) {
        double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
        normalise(h);
        out->G2 = 1 / (1 + out->Lambda + lambda(g, wi));
        for (int c = 0; c < 3; c++) {
            out->F[c] = 1;
            out->f[c] = density(g, h) * out->G2 / (4 * wo[2] * wi[2]);
        }
        out->pdf = pdf_of_normal(g, wo, h);
    }
    return MUSURF_OK;
}

static void sample_visible(double ax, double ay, const double wo[3], const double u[3], double m[3]) {
    double v[3] = {ax * wo[0], ay * wo[1], wo[2]};
    normalise(v);
    double t1[3] = {1, 0, 0};
    if (hypot(v[0], v[1]) > 0) {
        t1[0] = -v[1];
        t1[1] = v[0];
        normalise(t1);
    }
    const double t2[3] = {v[1] * t1[2] - v[2] * t1[1], v[2] * t1[0] - v[0] * t1[2],
                          v[0] * t1[1] - v[1] * t1[0]};
    const double r = sqrt(u[0]), phi = 2 * PI * u[1], p1 = r * cos(phi), s = (1 + v[2]) / 2;
    const double p2 = (1 - s) * sqrt(1 - p1 * p1) + s * r * sin(phi),
                 p3 = sqrt(fmax(0, 1 - p1 * p1 - p2 * p2));
    for (int c = 0; c < 3; c++) m[c] = p1 * t1[c] + p2 * t2[c] + p3 * v[c];
    m[0] *= ax;
    m[1] *= ay;
    m[2] = fmax(1e-300, m[2]);
    normalise(m);
}

static musurf_result sample(const musurf_material *material, musurf_precision precision,
                            musurf_sampler sampler, const double wo[3], const double u[3],
                            musurf_probe_sample *out) {
    const double_ggx *g = (const double_ggx *)(const void *)material;
    (void)precision;
    memset(out, 0, sizeof *out);
    double *m = out->wm;
    if (sampler == MUSURF_SAMPLE_NDF) {
        const double r = sqrt(u[0] / (1 - u[0])), phi = 2 * PI * u[1];
        m[0] = g->ax * r * cos(phi);
        m[1] = g->ay * r * sin(phi);
        m[2] = 1;
        normalise(m);
    } else {
        sample_visible(g->ax * (1 + g->sampler_bias), g->ay, wo, u, m);
    }
    const double facing = dot(wo, m);
    for (int c = 0; c < 3; c++) out->wi[c] = 2 * facing * m[c] - wo[c];
    out->rejected = !(facing > 0 && out->wi[2] > 0);
    if (out->rejected) return MUSURF_OK;
    const double lo = lambda(g, wo), g2 = 1 / (1 + lo + lambda(g, out->wi));
    out->pdf = pdf_of_normal(g, wo, m);
    for (int c = 0; c < 3; c++) {
        out->f[c] = density(g, m) * g2 / (4 * wo[2] * out->wi[2]);
        out->weight[c] = g2 * (1 + lo);
    }
    return MUSURF_OK;
}

mu_subject double_ggx_subject(const double_ggx *ggx) {
    static const musurf_probe probe = {.size = sizeof probe, .evaluate = evaluate, .sample = sample};
    mu_subject subject = {.material = (const musurf_material *)(const void *)ggx,
                          .probe = &probe,
                          .precision = MUSURF_DOUBLE,
                          .sampler = MUSURF_SAMPLE_VISIBLE,
                          .json = "{\"material\": \"test.double_ggx\"}"};
    const double m[4] = {1, 0, 0, ggx->ax / ggx->ay};
    mu_plane_from_transform(&subject.plane, m, NULL, ggx->ax, 0);
    return subject;
}
