/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_check.c: `musurf check`: the numerical validation of seed 000, section 4.3, for users: random
 * distributions under random M, and the materials of given scenes, in float or double.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "core/render/check_draw.h"
#include "core/render/check_report.h"
#include "core/render/check_scene.h"
#include "core/render/command.h"
#include "core/render/options.h"

enum { MATERIALS, SEED, PRECISION, SIGNIFICANCE, QUICK, JSON, THREADS, SAMPLES, TYPE };

static const mu_option options[] = {
    {"n", "N", "random materials (default: 22; 11 with --quick)"},
    {"seed", "S", "seed of everything random, 0 to 2^63-1 (default: 1)"},
    {"precision", "float|double", "arithmetic that is checked (default: double)"},
    {"significance", "P", "probability that the whole run fails by chance (default: 0.01)"},
    {"quick", NULL, "fewer materials, views and samples"},
    {"json", NULL, "the result as JSON instead of a table"},
    {"threads", "N", "threads (default: one per processor); the result does not depend on it"},
    {"samples", "N",
     "samples per chi^2 test (default: 20000; 10000 with --quick),\nfive times as many of the float shading "
     "calls"},
    {"type", "ID", "material type of the random materials (default: musurf.microfacet)"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "check", "[OPTIONS] [SCENE...]",
    "Checks materials numerically: random distributions under random linear maps (also nearly singular, "
    "mirrored\n"
    "and scaled by 1e-12 to 1e12), and all constant materials of the given scenes.\n"
    "Normalisation of D, G1 and the visible normals by adaptive quadrature, samplers by chi^2, pdf and "
    "weight\n"
    "against f, reciprocity, the transformation laws, and the float shading calls that renderers use.\n",
    options,
    "Each line of the table is a law: how often it was tested, the worst error with its tolerance, or the "
    "smallest\n"
    "p-value with the level it must exceed. The worst cases follow as lines for `musurf eval`. Exit code 1 "
    "if a law\n"
    "fails.\n"};

typedef struct check_options {
    mu_check_settings settings;
    double significance;
    const char *type;
    _Bool quick, json, materials_given, samples_given;
} check_options;

static _Bool read_significance(const mu_options *given, double *out) {
    char *end;
    errno = 0;
    *out = strtod(given->value, &end);
    if (end != given->value && !*end && !errno && *out > 0 && *out < 1) return 1;
    mu_refuse(&usage, "--significance is \"%s\"; a number above 0 and below 1 is needed", given->value);
    return 0;
}

static _Bool take(check_options *o, int met, const mu_options *given) {
    static const char *const precisions[] = {"float", "double", NULL};
    uint64_t number = 0;
    int choice = 1;
    switch (met) {
    case MATERIALS:
        o->materials_given = mu_options_unsigned(given, 0, 100000, &number);
        o->settings.materials = (size_t)number;
        return o->materials_given;
    case SEED:
        return mu_options_unsigned(given, 0, INT64_MAX, &o->settings.seed);
    case PRECISION:
        if (!mu_options_choice(given, precisions, &choice)) return 0;
        o->settings.precision = choice ? MUSURF_DOUBLE : MUSURF_FLOAT;
        return 1;
    case SIGNIFICANCE:
        return read_significance(given, &o->significance);
    case QUICK:
        return o->quick = 1;
    case JSON:
        return o->json = 1;
    case SAMPLES:
        o->samples_given = mu_options_unsigned(given, 1000, 1000000000, &number);
        o->settings.effort.samples = (size_t)number;
        return o->samples_given;
    case TYPE:
        o->type = given->value;
        return 1;
    default:
        if (!mu_options_unsigned(given, 1, 1024, &number)) return 0;
        o->settings.threads = (uint32_t)number;
        return 1;
    }
}

static void complete(check_options *o) {
    mu_check_settings *s = &o->settings;
    if (!o->materials_given) s->materials = o->quick ? 11 : 22;
    if (!o->samples_given) s->effort.samples = o->quick ? 10000 : 20000;
    s->effort.shading_samples = 5 * s->effort.samples;
    s->effort.target = o->quick ? 1e-7 : 1e-8;
    s->effort.panels = o->quick ? 500 : 1500;
    s->effort.cells = o->quick ? 200 : 400;
    s->effort.points = o->quick ? 8 : 16;
    s->views = o->quick ? 1 : 2;
    s->show_progress = isatty(STDERR_FILENO) == 1;
}

static int run(const check_options *o, mu_plugins *plugins, const mu_check_materials *all) {
    mu_error error = {.text = ""};
    struct timespec start, end;
    mu_tally *tally = malloc(sizeof *tally);
    if (!tally) return mu_refuse(&usage, "not enough memory");
    mu_tally_init(tally);
    clock_gettime(CLOCK_MONOTONIC, &start);
    int code = MU_EXIT_OK;
    if (mu_check_run(&o->settings, plugins, o->type, all->items, all->count, tally, &error)) {
        clock_gettime(CLOCK_MONOTONIC, &end);
        const double seconds =
            (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
        const mu_check_report report = {&o->settings, tally, o->significance, seconds, all->count};
        if (!o->json)
            mu_check_print_table(&report, stdout);
        else if (!mu_check_print_json(&report, stdout))
            code = MU_EXIT_FAILED;
        if (mu_check_failures(&report)) code = MU_EXIT_FAILED;
    } else {
        code = mu_refuse(&usage, "%s", error.text);
    }
    free(tally);
    return code;
}

int mu_command_check(int argc, char **argv) {
    check_options o = {.settings = {.seed = 1, .threads = mu_processors(), .precision = MUSURF_DOUBLE},
                       .significance = 0.01,
                       .type = "musurf.microfacet"};
    mu_options given = mu_options_begin(&usage, argc, argv);
    const char **scenes = calloc((size_t)argc + 1, sizeof *scenes);
    mu_check_materials all = {NULL, 0};
    mu_plugins *plugins = mu_plugins_new();
    size_t scene_count = 0;
    int code = MU_EXIT_OK, met;
    while (scenes && code == MU_EXIT_OK && (met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) {
            scenes[scene_count++] = given.value;
        } else if (met < 0) {
            code = mu_options_exit(met);
            if (met == MU_OPTIONS_HELP) goto out;
        } else if (!take(&o, met, &given)) {
            code = MU_EXIT_REFUSED;
        }
    }
    mu_error error = {.text = ""};
    if (!scenes || !plugins) mu_fail(&error, "not enough memory");
    for (size_t i = 0; code == MU_EXIT_OK && i < scene_count && !error.text[0]; i++)
        mu_check_collect(&all, plugins, scenes[i], o.settings.precision, &error);
    complete(&o);
    if (code == MU_EXIT_OK)
        code = error.text[0] ? mu_refuse(&usage, "%s", error.text) : run(&o, plugins, &all);
out:
    mu_check_materials_free(&all);
    free(scenes);
    mu_plugins_free(plugins);
    return code;
}
