/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_surface.c: rays per second and core of the tracers of surfaces, one point per facet of a 1024^2 surface.
 *
 * A ray is a point of a facet that faces the view. Goals: the exact caster answers one view of the 2.1 million facets in
 * under 2 s of one core, at 2.4e6 rays a second (three times POV-Ray: bench_tracers.py measures both in one run). Exits with
 * 1 where one is missed.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "core/render/surface_fft.h"
#include "core/render/surface_tracer.h"

enum { N = 1024, VIEWS = 3 };

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static mu_generator *make(mu_slope_law law) {
    const mu_recipe recipe = {law, N, 8, 1, 0.9999};
    mu_generator *g = mu_generator_make(&recipe);
    mu_fft *fft = mu_fft_make(N);
    if (!g || !fft) exit(1);
    const mu_spectral spectral = mu_fft_spectral(fft);
    mu_generator_start(g, &spectral);
    for (int pass = 0; pass < 15; pass++) mu_generator_pass(g, &spectral);
    mu_fft_free(fft);
    return g;
}

/* Seconds for both families of facets; rays and points seen are counted. */
static double look(const mu_tracer *tracer, void *surface, const mu_heightfield *f, const double w[3],
                   double *rays, double *seen) {
    static uint8_t row[N];
    mu_error error = {.text = ""};
    double used = 0;
    *rays = *seen = 0;
    for (int upper = 0; upper < 2; upper++) {
        const mu_sight s = {
            .m = {1, 0, 0, 1}, .w = {w[0], w[1], w[2]}, .u = upper ? 0.75 : 0.25, .v = 0.5, .upper = upper};
        const double start = seconds();
        void *at = tracer->look(surface, &s, &error);
        if (!at) exit(1);
        for (uint32_t i = 0; i < N; i++) {
            tracer->row(at, i, row);
            for (uint32_t j = 0; j < N; j++) *seen += row[j];
        }
        used += seconds() - start;
        tracer->look_away(at);
        for (uint32_t i = 0; i < N; i++)
            for (uint32_t j = 0; j < N; j++) {
                double slope[2];
                mu_facet_slope(f, i, j, upper, slope);
                *rays += mu_facet_facing(s.m, slope, w) > 0;
            }
    }
    return used;
}

int main(void) {
    static const mu_slope_law laws[] = {{MU_SLOPE_BECKMANN, 0.3, 0, 0}, {MU_SLOPE_GGX, 0.3, 0, 0}};
    static const double degrees[VIEWS] = {60, 75, 85};
    int missed = 0;
    printf("surface 1024^2   theta   own: s, Mray/s    embree: s, Mray/s    bits that differ in number\n");
    for (int k = 0; k < 2; k++) {
        mu_generator *g = make(laws[k]);
        const mu_heightfield f = mu_generator_surface(g);
        const double identity[4] = {1, 0, 0, 1};
        const mu_plan plan = {NULL, 0, 1, 1};
        mu_error error = {.text = ""};
        const mu_tracer *tracers[2] = {&mu_tracer_own, &mu_tracer_embree};
        void *surfaces[2];
        for (int t = 0; t < 2; t++)
            if (!(surfaces[t] = tracers[t]->open(&f, identity, &plan, &error))) return 1;
        for (int v = 0; v < VIEWS; v++) {
            const double theta = degrees[v] * 3.14159265358979323846 / 180;
            const double w[3] = {sin(theta) * 0.8, sin(theta) * 0.6, cos(theta)};
            double used[2], rays, seen[2];
            for (int t = 0; t < 2; t++) used[t] = look(tracers[t], surfaces[t], &f, w, &rays, &seen[t]);
            const _Bool good = used[0] < 2 && rays / used[0] > 3 * 7.9e5;
            printf("%-15s  %5.0f   %6.3f  %6.2f      %6.3f  %6.2f       %.0f%s\n",
                   mu_slope_names()[laws[k].kind], degrees[v], used[0], 1e-6 * rays / used[0], used[1],
                   1e-6 * rays / used[1], fabs(seen[0] - seen[1]), good ? "" : "   MISSED");
            missed += !good;
        }
        for (int t = 0; t < 2; t++) tracers[t]->close(surfaces[t]);
        mu_generator_free(g);
    }
    return missed > 0;
}
