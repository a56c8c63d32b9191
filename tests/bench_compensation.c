/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_compensation.c: how far a white furnace is from closing over compensated surfaces, and what making them takes.
 *
 *     bench_compensation [all | distribution | case ...]      (ggx)
 *     bench_compensation random SEED SECONDS
 *
 * The latter tries what comes: any distribution, M turned, mirrored, of any condition to 1e8, and scale, level or tilted.
 * A row for each distribution and case: the largest |E + what the lobe returns - 1| over views from 1 to 89.9 degrees, what tables say
 * that they are off by (mu_surface_tables_unsure), the share of either side that they leave open (of M per point: the share of these M
 * whose albedos are integrated) and what an albedo takes there, and milliseconds to make them. E is
 * the quadrature of polar_albedo.c, which knows no table, its panels equal to within 1e-4; of histograms, which share their quadrature with
 * tables, of random materials, and of M per point, whose heavy tails that quadrature loses at grazing views (3 % of E of std under 2e7:1, and
 * says 4e-3), it is the mean weight of visible normals instead, and "noise" the standard error of the largest. What the lobe returns is
 * the mean of lost cos / (pi A pdf) over its own draws.
 * Fails where the error is above 1 %, and what is said of the tables; three times the noise allowed. Random seeds are fixed.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/bsdf/albedo_set.h"
#include "tests/lobe_return.h"
#include "tests/polar_albedo.h"
#include "tests/uniform.h"

#define TURN 6.28318530717958648
enum { VIEWS = 30, DRAWS = 1 << 15, MANY = 1 << 20, SAMPLES = 1 << 15, SIDE = 64 };

static const struct family {
    const char *name;
    mu_ndf ndf;
    double alpha, gamma, exponent;
} families[] = {{"ggx", MU_GGX, 0.3, 2, 0},          {"beckmann", MU_BECKMANN, 0.3, 2, 0},
                {"gtr 0.4", MU_GTR, 0.3, 0.4, 0},    {"gtr 1.5", MU_GTR, 0.3, 1.5, 0},
                {"gtr 4", MU_GTR, 0.5, 4, 0},        {"std 1.6", MU_STD, 0.3, 1.6, 0},
                {"phong", MU_PHONG, 0, 0, 20},       {"sheen", MU_SHEEN, 0.4, 0, 0},
                {"tabulated", MU_TABULATED, 0, 0, 0}};

/* Each M is that of the definition, or of points. */
static const struct kind {
    const char *name;
    double map[4], tilt[2];
    int glass, blurs;
    double least, most; /* of M per point: log2 of the roughnesses it makes */
} kinds[] = {{"level", {1, 0, 0, 1}, {0, 0}, 0, 0, 0, 0},
             {"rough", {0.2, 0, 0, 0.2}, {0, 0}, 0, 0, 0, 0},
             {"100:1", {1, 0, 0, 100}, {0, 0}, 0, 0, 0, 0},
             {"rough 100:1", {0.1, 0, 0, 10}, {0, 0}, 0, 0, 0, 0},
             {"10:1", {1, 0, 0, 10}, {0, 0}, 0, 0, 0, 0},
             {"1e4:1", {0.01, 0, 0, 100}, {0, 0}, 0, 0, 0, 0},
             {"1e8:1", {1e-4, 0, 0, 1e4}, {0, 0}, 0, 0, 0, 0},
             {"skew", {1, 2, 0, 1}, {0, 0}, 0, 0, 0, 0},
             {"tilt", {1, 0, 0, 1}, {0.3, 0.2}, 0, 0, 0, 0},
             {"steep tilt", {1, 0, 0, 1}, {3, 2}, 0, 0, 0, 0},
             {"skew, tilt", {1, 2, 0, 1}, {0.3, 0.2}, 0, 0, 0, 0},
             {"glass", {1, 0, 0, 1}, {0, 0}, 1, 0, 0, 0},
             {"skew glass", {1, 2, 0, 1}, {0, 0}, 1, 0, 0, 0},
             {"1e4:1 glass", {0.01, 0, 0, 100}, {0, 0}, 1, 0, 0, 0},
             {"1e8:1 glass", {1e-4, 0, 0, 1e4}, {0, 0}, 1, 0, 0, 0},
             {"smooth glass", {1, 0, 0, 1e4}, {0, 0}, 1, 0, 0, 0},
             {"harsh glass", {1e-4, 0, 0, 1}, {0, 0}, 1, 0, 0, 0},
             {"tilt glass", {1, 0, 0, 1}, {0.3, 0.2}, 1, 0, 0, 0},
             {"fine tilt glass", {6, 0, 0, 6}, {2.5, 1.66}, 1, 0, 0, 0}, /* slopes of 0.05 about 0.5 */
             {"steep tilt glass", {1, 0, 0, 1}, {3, 2}, 1, 0, 0, 0},
             {"blur", {1, 0, 0, 1}, {0, 0}, 0, 1, 0, 0},
             {"skew blur", {1, 2, 0, 1}, {0, 0}, 0, 1, 0, 0},
             {"tilt blur", {1, 0, 0, 1}, {0.3, 0.2}, 0, 1, 0, 0},
             {"glass blur", {1, 0, 0, 1}, {0, 0}, 1, 1, 0, 0},
             {"skew glass blur", {1, 2, 0, 1}, {0, 0}, 1, 1, 0, 0},
             {"tilt glass blur", {1, 0, 0, 1}, {0.3, 0.2}, 1, 1, 0, 0},
             {"points", {1, 0, 0, 1}, {0, 0}, 0, 0, -7, 1},
             {"points beyond", {1, 0, 0, 1}, {0, 0}, 0, 0, -12, 10},
             {"points blur", {1, 0, 0, 1}, {0, 0}, 0, 1, -7, 1},
             {"points tilt", {1, 0, 0, 1}, {0.3, 0.2}, 0, 0, -7, 4},
             {"points tilt beyond", {1, 0, 0, 1}, {0.3, 0.2}, 0, 0, -12, 10},
             {"points steep tilt", {1, 0, 0, 1}, {3, 2}, 0, 0, -12, 4},
             {"points glass", {1, 0, 0, 1}, {0, 0}, 1, 0, -7, 4},
             {"points glass beyond", {1, 0, 0, 1}, {0, 0}, 1, 0, -12, 10},
             {"points glass blur", {1, 0, 0, 1}, {0, 0}, 1, 1, -7, 4},
             {"points tilt glass", {1, 0, 0, 1}, {0.3, 0.2}, 1, 0, -7, 4},
             {"points tilt glass beyond", {1, 0, 0, 1}, {0.3, 0.2}, 1, 0, -12, 10},
             {"points steep tilt glass", {1, 0, 0, 1}, {3, 2}, 1, 0, -12, 4}};

static int varies(const struct kind *k) {
    return k->most > k->least;
}

static mu_surface_f *make(const mu_definition *d, void **memory) {
    *memory = aligned_alloc(64, (mu_surface_bytes_f(d) + 63) / 64 * 64);
    if (!*memory) exit(1);
    return mu_surface_make_f(d, *memory);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* Slopes of GGX, alpha = 0.3, on [-2, 2]². */
static void fill_histogram(double weights[SIDE * SIDE]) {
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double x = (k % SIDE + 0.5) * 4 / SIDE - 2, y = ((double)(k / SIDE) + 0.5) * 4 / SIDE - 2;
        weights[k] = 1 / pow(0.09 + x * x + y * y, 2);
    }
}

static mu_definition define(const struct family *f, const struct kind *k, const double *histogram) {
    mu_definition d = mu_definition_default();
    d.ndf = f->ndf, d.alpha = f->alpha, d.gamma = f->gamma, d.exponent = f->exponent;
    d.histogram = histogram, d.histogram_columns = d.histogram_rows = SIDE;
    d.histogram_bounds[0] = d.histogram_bounds[2] = -2, d.histogram_bounds[1] = d.histogram_bounds[3] = 2;
    memcpy(d.transform, k->map, sizeof d.transform);
    memcpy(d.tilt, k->tilt, sizeof d.tilt);
    if (k->glass) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
    d.compensation_varies = varies(k), d.compensation_blurs = k->blurs;
    return d;
}

static void direction(double z, double phi, float w[3]) {
    const double r = sqrt((1 - z) * (1 + z));
    w[0] = (float)(r * cos(phi)), w[1] = (float)(r * sin(phi)), w[2] = (float)z;
}

/* E by the mean weight of visible normals, at most 1 each, and its standard error. */
static double mean_weight(mu_closure_f *c, int samples, uniform *random, double *error) {
    double sum = 0, squares = 0;
    c->importance = 1;
    for (int i = 0; i < samples; i++) {
        const float u[3] = {uniform_float(random), uniform_float(random), uniform_float(random)};
        mu_sample_f s;
        mu_sample_wi_f(c, u, &s);
        const double weight = s.rejected ? 0 : (double)s.weight[0];
        sum += weight / samples, squares += weight * weight / samples;
    }
    *error = sqrt(fmax(squares - sum * sum, 0) / samples);
    return sum;
}

/* E, and its standard error, of a closure that scatters singly. */
static double single_albedo(const struct family *f, mu_closure_f *c, int blurred, int drawn, uniform *random,
                            double *error) {
    *error = 0;
    if (drawn || (f->ndf == MU_TABULATED && !blurred)) return mean_weight(c, SAMPLES, random, error);
    return polar_albedo(c, f->ndf == MU_GTR && !blurred ? f->alpha : 1, 1e-4, error);
}

/* An M that makes slopes of roughness `width` as rough along its axes as the case says; a mirror, maybe. */
static void random_map(uniform *random, double width, const struct kind *of, float m[4]) {
    double rough[2];
    for (int k = 0; k < 2; k++) rough[k] = exp2(of->least + (of->most - of->least) * uniform_double(random));
    const double a = width / rough[0], b = copysign(width / rough[1], uniform_double(random) - 0.5),
                 s = 7 * uniform_double(random), t = 7 * uniform_double(random);
    m[0] = (float)(a * cos(s) * cos(t) - b * sin(s) * sin(t));
    m[1] = (float)(-a * cos(s) * sin(t) - b * sin(s) * cos(t));
    m[2] = (float)(a * sin(s) * cos(t) + b * cos(s) * sin(t));
    m[3] = (float)(-a * sin(s) * sin(t) + b * cos(s) * cos(t));
}

/* 1 if the case is what it should be; `drawn`: E by mean weights, again by many where it seems to be off. */
static int run(const struct family *f, const struct kind *k, const double *histogram, int drawn) {
    mu_definition d = define(f, k, histogram), once = d;
    mu_complaint why;
    d.multiple = MU_COMPENSATED;
    printf("%-10s %-24s ", f->name, k->name);
    if (!mu_definition_check(&d, &why)) {
        printf("refused: %s\n", why.text);
        return 1;
    }
    void *memory[2];
    const double start = now();
    const mu_surface_f *s = make(&d, &memory[0]);
    const double ms = now() - start, width = mu_slope_width(&d);
    const mu_surface_f *single = make(&once, &memory[1]);
    const mu_albedo_set *set = mu_surface_tables_f(s);
    uniform random = {20261126u};
    double worst = 0, noise = 0, back = 0, sides[2] = {0, 0}, integrated = 0, bound = 0, us = 0;
    char where[160] = "";
    const int views = VIEWS * (!varies(k) ? k->blurs ? 8 : 3 : set->grid.table ? 8 : 2);
    for (int i = 0; i < views; i++) {
        const int below = k->glass && i % 2, height = i / (1 + k->glass) % VIEWS;
        float w[3], m[4] = {1, 0, 0, 1};
        direction(cos((1 + 88.9 * height / (VIEWS - 1)) * TURN / 360), TURN * fmod(i * 0.6180339887498949, 1),
                  w);
        if (below) w[0] = -w[0], w[1] = -w[1], w[2] = -w[2];
        const float blur = k->blurs ? (float)exp2(6 * uniform_double(&random) - 5) : 0;
        if (varies(k)) random_map(&random, width, k, m);
        mu_closure_f c, simple;
        if (!mu_bind_f(s, w, varies(k) ? m : NULL, &c)) continue;
        mu_bind_f(single, w, varies(k) ? m : NULL, &simple);
        const struct mu_kernel_f *const before = simple.kernel;
        if (k->blurs) mu_blur_f(&c, blur), mu_blur_f(&simple, blur);
        const double begin = now();
        bound += varies(k), integrated += varies(k) && !c.lobe.count;
        if (k->blurs || varies(k))
            back = lobe_return(&c,
                               !c.lobe.count             ? DRAWS / 16
                               : set->open && !varies(k) ? DRAWS / 8
                                                         : DRAWS,
                               NULL);
        if (varies(k) && !c.lobe.count)
            us += 1e3 * (now() - begin) / (DRAWS / 16) / (1 + k->glass);
        else if (i <= k->glass)
            sides[below] =
                lobe_return(&c, set->open && set->level[0].side[below].open > 0.02f ? DRAWS : MANY, NULL);
        if (!k->blurs && !varies(k)) back = sides[below];
        double error;
        const int widened = simple.kernel != before;
        const double E = single_albedo(f, &simple, widened, drawn || varies(k), &random, &error);
        double off = fabs(E + (double)c.lobe.lost * back - 1);
        if ((drawn || varies(k)) && off > 0.005)
            off = fabs(mean_weight(&simple, 32 * SAMPLES, &random, &error) + (double)c.lobe.lost * back - 1);
        if (off > worst) {
            worst = off, noise = error;
            snprintf(where, sizeof where, "z %.4g blur %.2g E %.3f lost %.3f back %.4f M %.2g %.2g %.2g %.2g",
                     (double)w[2], (double)blur, E, (double)c.lobe.lost, back, (double)m[0], (double)m[1],
                     (double)m[2], (double)m[3]);
        }
    }
    const double unsure = (double)mu_surface_tables_unsure_f(s);
    double open[2] = {0, 0}, microseconds = 0;
    for (int side = 0; side <= k->glass; side++)
        open[side] = varies(k) ? integrated / bound : (double)set->level[0].side[side].open;
    if (varies(k)) microseconds = integrated > 0 ? us / integrated : 0;
    if (set->open && !varies(k)) {
        mu_lobe l;
        mu_albedo_set_choose(set, (const double[4]){0}, &l);
        const double begin = now();
        for (int i = 0; i < 200; i++) {
            float w[3];
            direction((i + 0.5) / 200, 2.4 * i, w);
            mu_albedo_lost_at(&l, i % 2 && k->glass, w);
        }
        microseconds = 5 * (now() - begin);
    }
    const int right = worst <= 0.01 + unsure + 3 * noise;
    printf("%s %.4f noise %.4f unsure %.4f open %.4f %.4f %4.0f us %7.0f ms %8zu bytes   at %s\n",
           right ? "    " : "FAIL", worst, noise, unsure, open[0], open[1], microseconds, ms,
           mu_surface_table_bytes_f(s), where);
    fflush(stdout);
    free(memory[0]), free(memory[1]);
    return right;
}

/* Is it asked for? A name, or none at all of its sort. */
static int asked(const char *name, const char *const *names, int count, int of_families) {
    int others = 0;
    for (int i = 0; i < count; i++) {
        int is_family = 0;
        if (strcmp(names[i], name) == 0) return 1;
        for (size_t k = 0; k < sizeof families / sizeof families[0]; k++)
            is_family |= strcmp(names[i], families[k].name) == 0;
        others += is_family == of_families;
    }
    return !others;
}

/* Seven in ten are glass, six in ten level; rotations, a scale of 10^±2.5, a condition to 1e8, a slope of 0.03 to 1.2. */
static struct kind random_kind(uniform *u) {
    struct kind k = {.name = "random", .glass = uniform_double(u) < 0.7};
    const double log_cond = 8 * uniform_double(u), scale = pow(10, 5 * uniform_double(u) - 2.5),
                 a = TURN * uniform_double(u), b = TURN * uniform_double(u),
                 x = scale * pow(10, log_cond / 2),
                 y = copysign(scale * pow(10, -log_cond / 2), uniform_double(u) - 0.5);
    k.map[0] = cos(a) * x * cos(b) - sin(a) * y * sin(b),
    k.map[1] = -cos(a) * x * sin(b) - sin(a) * y * cos(b);
    k.map[2] = sin(a) * x * cos(b) + cos(a) * y * sin(b),
    k.map[3] = -sin(a) * x * sin(b) + cos(a) * y * cos(b);
    const double slope = uniform_double(u) < 0.6 ? 0 : 0.03 * pow(10, 1.6 * uniform_double(u)),
                 toward = TURN * uniform_double(u);
    k.tilt[0] = slope * cos(toward), k.tilt[1] = slope * sin(toward);
    printf("%-6s cond %.1e scale %.1e tilt %.2f  ", k.glass ? "glass" : "opaque", pow(10, log_cond), scale,
           slope);
    return k;
}

/* How many failed. */
static int try_random(unsigned seed, double seconds, const double *histogram) {
    uniform u = {seed};
    int failed = 0;
    for (const double start = now(); now() - start < 1e3 * seconds;) {
        const struct family *f =
            &families[(size_t)(uniform_double(&u) * (sizeof families / sizeof families[0]))];
        const struct kind k = random_kind(&u);
        failed += !run(f, &k, histogram, 1);
    }
    return failed;
}

int main(int argc, char **argv) {
    static double histogram[SIDE * SIDE];
    const char *const *names = (const char *const *)argv + 1;
    static const char *const ggx[] = {"ggx"};
    const int all = argc > 1 && strcmp(argv[1], "all") == 0;
    int count = all ? 0 : argc - 1, failed = 0;
    if (argc == 1) names = ggx, count = 1;
    fill_histogram(histogram);
    if (argc == 4 && strcmp(argv[1], "random") == 0)
        return try_random((unsigned)atoi(argv[2]), atof(argv[3]), histogram) != 0;
    for (size_t f = 0; f < sizeof families / sizeof families[0]; f++)
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
            if (asked(families[f].name, names, count, 1) && asked(kinds[k].name, names, count, 0))
                failed |= !run(&families[f], &kinds[k], histogram, 0);
    return failed;
}
