/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * program.c: a user's program around a distribution of its own (exponential.c). Holds it to the laws that no distribution
 * may break, under a skewed M with a tilt: int D cos = 1, int D max(0, wo.m) = sigma, int pdf + rejected = 1, weight pdf =
 * f cos. Prints what it found; exit 1 if a law is broken.
 */
#include <math.h>
#include <musurf/musurf.h>
#include <stdio.h>
#include <stdlib.h>

extern const struct mu_kernel_f mu_kernel_exponential_f;
extern const struct mu_kernel_d mu_kernel_exponential_d;

enum { STEPS = 400, SAMPLES = 20000 };
static const double pi = 3.14159265358979323846;
static int broken;

static void law(const char *name, double got, double wanted, double tolerance) {
    const int good = fabs(got - wanted) <= tolerance;
    printf("%-34s %.6f, should be %.6f within %.1e%s\n", name, got, wanted, tolerance, good ? "" : "  BROKEN");
    broken |= !good;
}

int main(void) {
    mu_definition d = mu_definition_default();
    d.ndf = MU_CUSTOM, d.alpha = 0.3;
    d.custom_f = &mu_kernel_exponential_f, d.custom_d = &mu_kernel_exponential_d;
    d.transform[1] = 2;
    d.tilt[0] = 0.1;
    mu_complaint why;
    if (!mu_definition_check(&d, &why)) {
        fprintf(stderr, "%s: %s\n", why.field, why.text);
        return 2;
    }
    mu_surface_d *s = mu_surface_make_d(&d, aligned_alloc(64, (mu_surface_bytes_d(&d) + 63) / 64 * 64));
    mu_surface_f *f = mu_surface_make_f(&d, aligned_alloc(64, (mu_surface_bytes_f(&d) + 63) / 64 * 64));
    const double wo[3] = {0.6, 0, 0.8};
    const float wo_f[3] = {0.6f, 0, 0.8f};
    mu_closure_d c;
    mu_closure_f cf;
    if (!mu_bind_d(s, wo, NULL, &c) || !mu_bind_f(f, wo_f, NULL, &cf)) return 2;

    /* midpoints in slope angle and azimuth: periodic in one, smooth in the other */
    double area = 0, shown = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            const double theta = pi / 2 * (i + 0.5) / STEPS, phi = 2 * pi * (j + 0.5) / STEPS;
            const double m[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
            const double weight = mu_normal_d(&c, m).D * sin(theta) * (pi / 2 / STEPS) * (2 * pi / STEPS);
            area += weight * m[2];
            shown += weight * fmax(0, m[0] * wo[0] + m[1] * wo[1] + m[2] * wo[2]);
        }
    law("integral of D cos", area, 1, 1e-4); /* midpoint rule: (pi/2/400)² times curvatures of some units */
    law("integral of D max(0, wo.m)", shown, mu_view_d(&c, wo).sigma, 1e-4);
    law("sigma in float", (double)mu_view_f(&cf, wo_f).sigma, mu_view_d(&c, wo).sigma, 1e-6);

    unsigned long long state = 20260726;
    double mean[3] = {0}, worst = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double u[3];
        for (int k = 0; k < 3; k++) {
            state = state * 6364136223846793005ull + 1442695040888963407ull;
            u[k] = (double)(state >> 11) * 0x1p-53;
        }
        mu_sample_d sample;
        mu_value_d value;
        mu_sample_wi_d(&c, u, &sample);
        for (int k = 0; k < 3; k++) mean[k] += sample.wm[k] / SAMPLES;
        if (sample.rejected) continue;
        mu_eval_d(&c, sample.wi, &value);
        worst = fmax(worst, fabs(sample.weight[0] * sample.pdf / (value.f[0] * sample.wi[2]) - 1));
    }
    law("weight pdf / f cos - 1, at worst", worst, 0, 1e-9);

    /* the mean visible normal, by the same quadrature */
    double expected = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            const double theta = pi / 2 * (i + 0.5) / STEPS, phi = 2 * pi * (j + 0.5) / STEPS;
            const double m[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
            expected += mu_normal_d(&c, m).Dv * m[0] * sin(theta) * (pi / 2 / STEPS) * (2 * pi / STEPS);
        }
    law("mean x of visible normals", mean[0], expected, 4 / sqrt(SAMPLES)); /* |x| <= 1: 4 standard errors at most */
    return broken;
}
