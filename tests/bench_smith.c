/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_smith.c: error against run time of Smith's masking: what the float forms lose, and what they save.
 *
 * For each distribution the G1 of the float core (GTR: its table) is compared with the double core (GTR:
 * exponentially convergent quadrature, itself held to 25-digit references by test_reference) over alpha
 * log-uniform in [1e-4, 1], gamma in [0, 10], theta from 0 to 89.99 degrees; both are timed on the same
 * directions.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "core/bsdf/musurf.h"
#include "tests/uniform.h"

enum { MATERIALS = 400, VIEWS = 256 };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct result {
    double error, alpha, gamma, theta; /* the largest error of G1, and where */
    double compile, ns_float, ns_double;
} result;

static int measure(mu_ndf ndf, uint64_t seed, result *out) {
    uniform random = {seed};
    static float vf[VIEWS][3];
    static double vd[VIEWS][3];
    double theta[VIEWS], seconds[3] = {0};
    for (int i = 0; i < VIEWS; i++) {
        theta[i] = 89.99 * i / (VIEWS - 1);
        const double t = theta[i] * 3.14159265358979323846 / 180;
        const float z = (float)cos(t), x = (float)sin(t);
        vf[i][0] = x, vf[i][2] = z; /* the same direction for both: the float one, exactly */
        vd[i][0] = x, vd[i][2] = z;
    }
    const float upf[3] = {0, 0, 1};
    const double upd[3] = {0, 0, 1};
    *out = (result){0};
    for (int k = 0; k < MATERIALS; k++) {
        mu_definition d = mu_definition_default();
        d.ndf = ndf;
        d.alpha = pow(10, -4 * uniform_double(&random));
        d.gamma = 10 * uniform_double(&random);
        void *mf = malloc(mu_surface_bytes_f(&d)), *md = malloc(mu_surface_bytes_d(&d));
        if (!mf || !md) return 0;
        double start = now();
        mu_surface_f *sf = mu_surface_make_f(&d, mf);
        seconds[0] += now() - start;
        mu_surface_d *sd = mu_surface_make_d(&d, md);
        mu_closure_f cf;
        mu_closure_d cd;
        if (!mu_bind_f(sf, upf, NULL, &cf) || !mu_bind_d(sd, upd, NULL, &cd)) return 0;
        float gf[VIEWS];
        double gd[VIEWS];
        start = now();
        for (int i = 0; i < VIEWS; i++) gf[i] = mu_view_f(&cf, vf[i]).sigma;
        seconds[1] += now() - start;
        start = now();
        for (int i = 0; i < VIEWS; i++) gd[i] = mu_view_d(&cd, vd[i]).sigma;
        seconds[2] += now() - start;
        for (int i = 0; i < VIEWS; i++) {
            const double error =
                fabs((double)vf[i][2] / (double)gf[i] - vd[i][2] / gd[i]); /* G1 = cos / sigma */
            if (error >= out->error) *out = (result){error, d.alpha, d.gamma, theta[i], 0, 0, 0};
        }
        free(mf);
        free(md);
    }
    out->compile = seconds[0] / MATERIALS * 1e6;
    out->ns_float = seconds[1] / (MATERIALS * VIEWS) * 1e9;
    out->ns_double = seconds[2] / (MATERIALS * VIEWS) * 1e9;
    return 1;
}

int main(void) {
    static const char *const names[] = {"GGX", "Beckmann", "GTR"};
    static const mu_ndf ndfs[] = {MU_GGX, MU_BECKMANN, MU_GTR};
    printf("Smith's masking, float against double, %d materials x %d views\n", MATERIALS, VIEWS);
    printf("%-10s %14s %12s %12s %14s   worst at\n", "", "max |dG1|", "float ns", "double ns", "compile us");
    for (int i = 0; i < 3; i++) {
        result r;
        if (!measure(ndfs[i], 20260911u + (uint64_t)i, &r)) return 1;
        printf("%-10s %14.2e %12.1f %12.1f %14.1f   alpha %.4g", names[i], r.error, r.ns_float, r.ns_double,
               r.compile, r.alpha);
        if (ndfs[i] == MU_GTR) printf(", gamma %.4g", r.gamma);
        printf(", theta %.4g\n", r.theta);
    }
    return 0;
}
