/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_masking.c: error against run time of every way to GTR's masking: the quadrature rule by its step, the float table by
 * its length, both cores, and the spline of Appendix A.
 *
 *     bench_masking [--json]
 *
 * The largest error of G1 over alpha log-uniform in [1e-4, 1), gamma uniform in [0, 4] (where the spline exists) and theta
 * from 0 to 89.99 degrees, against the rule at half the step that shading in double takes, which test_reference holds to
 * 25-digit values; and the time of one evaluation, measured in the same run over the same directions.
 */
#define MU_REAL_BITS 53
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "core/bsdf/gtr.h"
#include "core/bsdf/smith.h"
#include "tests/uniform.h"

enum { MATERIALS = 200, VIEWS = 48, REFERENCE_DIGITS = 32, REPEATS = 3, TABLE_MAX = 200 };

typedef struct view {
    double z, r;
} view;
typedef struct material {
    double alpha, gamma, unit; /* of the table */
    double right[VIEWS];       /* G1 */
} material;

static material materials[MATERIALS];
static view views[VIEWS];
static int json;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void print(const char *kind, const char *setting, double set, double error, double ns,
                  double compile_us, double bytes) {
    if (json)
        printf("{\"kind\": \"%s\", \"%s\": %.9g, \"error\": %.6g, \"ns\": %.6g, \"compile_us\": %.6g, "
               "\"bytes\": %.9g}\n",
               kind, setting, set, error, ns, compile_us, bytes);
    else
        printf("%-26s %-8s %7.4g %12.2e %10.1f ns %10.1f us %8.0f bytes\n", kind, setting, set, error, ns,
               compile_us, bytes);
}

static void prepare(void) {
    uniform random = {20260912u};
    for (int i = 0; i < VIEWS; i++) {
        const double theta = 89.99 * i / (VIEWS - 1) * PI / 180;
        const float z = (float)cos(theta), r = (float)sin(theta); /* the same direction for both precisions */
        views[i] = (view){(double)z, (double)r};
    }
    for (int k = 0; k < MATERIALS; k++) {
        material *m = &materials[k];
        m->alpha = pow(10, -4 * (1 - uniform_double(&random))) * (1 - 1e-9);
        m->gamma = 4 * uniform_double(&random);
        m->unit = m->gamma < 1 ? m->alpha : m->alpha / sqrt(fmax(1, mu_gtr_peak(m->alpha, m->gamma)));
        for (int i = 0; i < VIEWS; i++)
            m->right[i] = views[i].z / (views[i].z + mu_gtr_z_lambda(m->alpha, m->gamma, views[i].r,
                                                                     views[i].z, REFERENCE_DIGITS));
    }
}

static double error_of(const material *m, int i, double z_lambda) {
    return fabs(views[i].z / (views[i].z + z_lambda) - m->right[i]);
}

/* The trapezoid rule at the step for so many digits. */
static void rule(int digits) {
    double largest = 0, least = INFINITY;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        const double start = now();
        for (int k = 0; k < MATERIALS; k++)
            for (int i = 0; i < VIEWS; i++) {
                const material *m = &materials[k];
                const double a = mu_gtr_z_lambda(m->alpha, m->gamma, views[i].r, views[i].z, digits);
                largest = fmax(largest, error_of(m, i, a));
            }
        least = fmin(least, now() - start);
    }
    print("quadrature", "step", mu_smith_step(digits), largest, least / (MATERIALS * VIEWS) * 1e9, 0, 0);
}

/* The float table, longer or shorter by so many octaves than shading takes. */
static void table(int more) {
    double largest = 0, seconds = 0, build = 0, bytes = 0;
    static float cells[SMITH_CELL * (1 + 2 * TABLE_MAX)];
    for (int k = 0; k < MATERIALS; k++) {
        const material *m = &materials[k];
        const int octaves = (int)fmax(1, mu_smith_octaves(m->unit) + more);
        double start = now();
        mu_gtr_table_build(cells, octaves, m->alpha, m->gamma, m->unit);
        build += now() - start;
        bytes += (double)mu_smith_table_bytes(octaves) / MATERIALS;
        float a[VIEWS];
        double least = INFINITY;
        for (int repeat = 0; repeat < REPEATS; repeat++) {
            start = now();
            for (int i = 0; i < VIEWS; i++) { /* as gtr.c does it in float */
                const float z = (float)views[i].z, r = (float)(views[i].r * m->unit), r2 = r * r;
                const float sum = sqrtf(z * z + r2) + z, ggx = r2 / sum;
                a[i] = ggx / 2 * smith_table_at(cells, octaves, (float)ldexp(1, octaves), ggx / sum);
            }
            least = fmin(least, now() - start);
        }
        seconds += least;
        for (int i = 0; i < VIEWS; i++) largest = fmax(largest, error_of(m, i, fmax((double)a[i], 0)));
    }
    print("table", "octaves", more, largest, seconds / (MATERIALS * VIEWS) * 1e9, build / MATERIALS * 1e6,
          bytes);
}

/* One precision of one masking through musurf.h; everything a host would pay for. */
#define CORE(suffix, real_type)                                                                              \
    static void core_##suffix(mu_smith smith, const char *kind) {                                            \
        double largest = 0, seconds = 0, build = 0, bytes = 0;                                               \
        for (int k = 0; k < MATERIALS; k++) {                                                                \
            mu_definition d = mu_definition_default();                                                       \
            d.ndf = MU_GTR, d.alpha = materials[k].alpha, d.gamma = materials[k].gamma;                      \
            d.smith = smith, d.sampler = MU_SAMPLE_NDF;                                                      \
            void *memory = malloc(mu_surface_bytes_##suffix(&d));                                            \
            if (!memory) exit(1);                                                                            \
            double start = now(), least = INFINITY;                                                          \
            mu_surface_##suffix *s = mu_surface_make_##suffix(&d, memory);                                   \
            build += now() - start;                                                                          \
            bytes += (double)mu_surface_table_bytes_##suffix(s) / MATERIALS;                                 \
            const real_type up[3] = {0, 0, 1};                                                               \
            mu_closure_##suffix c;                                                                           \
            if (!mu_bind_##suffix(s, up, NULL, &c)) exit(1);                                                 \
            double sigma[VIEWS];                                                                             \
            for (int repeat = 0; repeat < REPEATS; repeat++) {                                               \
                start = now();                                                                               \
                for (int i = 0; i < VIEWS; i++) {                                                            \
                    const real_type w[3] = {(real_type)views[i].r, 0, (real_type)views[i].z};                \
                    sigma[i] = (double)mu_view_##suffix(&c, w).sigma;                                        \
                }                                                                                            \
                least = fmin(least, now() - start);                                                          \
            }                                                                                                \
            seconds += least;                                                                                \
            for (int i = 0; i < VIEWS; i++)                                                                  \
                largest = fmax(largest, fabs(views[i].z / sigma[i] - materials[k].right[i]));                \
            free(memory);                                                                                    \
        }                                                                                                    \
        print(kind, "bits", (int)sizeof(real_type) * 8, largest, seconds / (MATERIALS * VIEWS) * 1e9,        \
              build / MATERIALS * 1e6, bytes);                                                               \
    }
CORE(f, float)
CORE(d, double)

int main(int argc, char **argv) {
    json = argc > 1 && strcmp(argv[1], "--json") == 0;
    prepare();
    if (!json)
        printf(
            "masking of GTR, %d materials x %d views: largest error of G1, time of one value, compile time\n",
            MATERIALS, VIEWS);
    for (int digits = 3; digits <= 16; digits++) rule(digits);
    for (int more = -8; more <= 2; more++) table(more);
    core_f(MU_SMITH_EXACT, "exact");
    core_d(MU_SMITH_EXACT, "exact");
    core_f(MU_SMITH_SPLINE, "spline (approximate)");
    core_d(MU_SMITH_SPLINE, "spline (approximate)");
    return 0;
}
