/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface_make.c: `musurf surface make`, a heightfield whose slopes follow a distribution. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/render/command_surface.h"
#include "core/render/json_out.h"
#include "core/render/output.h"
#include "core/render/surface_fft.h"
#include "core/render/surface_file.h"
#include "core/render/surface_source.h"
#include "core/surface/statistics.h"

enum { NDF, ALPHA, GAMMA, EXPONENT, SIZE, SEED, CORRELATION, CLIP, PASSES, OUTPUT, OPTION_COUNT };

static const mu_option options[] = {
    {"ndf", "NAME", "beckmann, ggx, gtr, std, phong or sheen, as in a material"},
    {"alpha", "A", "slope roughness; of all but phong"},
    {"gamma", "G", "tail of gtr (>= 0) and std (> 3/2)"},
    {"exponent", "E", "of phong"},
    {"size", "N", "cells a side, even, 8 to 16384 (default: 512)"},
    {"seed", "S", "0 to 2^64-1 (default: 0)"},
    {"correlation", "L", "correlation length in cells: exp(-r^2/L^2) (default: 8)"},
    {"clip", "Q", "no slope is above this quantile of the distribution (default: 0.9999)"},
    {"passes", "P", "passes of fitting, 1 to 1000 (default: 30)"},
    {"o", "FILE", "the EXR file; written beside and renamed when it is whole"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "surface make", "--ndf NAME [--alpha A] [--gamma G] [--size N] [--seed S] ... -o FILE",
    "Makes a periodic heightfield whose facets follow a slope distribution. The same seed makes the same "
    "surface.\n",
    options,
    "A Gaussian field is fitted to the distribution by passes that give the k-th flattest facet of each "
    "family the\n"
    "k-th quantile and project these slopes back to heights. One line of JSON tells how well that went:\n"
    "  \"deviation\"  relative rms deviation of the masses of 20 bins of equal mass, of the facets L and of "
    "U\n"
    "  \"steepest\"   the steepest slope; \"limit\" is the quantile --clip\n"
    "  \"range\"      highest less lowest height, in cells\n"};

typedef struct mu_making {
    mu_recipe recipe;
    uint32_t passes;
    const char *file;
    _Bool given[OPTION_COUNT];
} mu_making;

static _Bool read_number(const mu_options *at, double *out) {
    return mu_options_numbers(at, 1, 1, out) == 1;
}

static _Bool read_option(mu_making *making, const mu_options *at, int met) {
    uint64_t whole = 0;
    int choice = 0;
    mu_recipe *r = &making->recipe;
    making->given[met] = 1;
    switch (met) {
    case NDF:
        if (!mu_options_choice(at, mu_slope_names(), &choice)) return 0;
        r->law.kind = (mu_slope_kind)choice;
        return 1;
    case ALPHA:
        return read_number(at, &r->law.alpha);
    case GAMMA:
        return read_number(at, &r->law.gamma);
    case EXPONENT:
        return read_number(at, &r->law.exponent);
    case SIZE:
        if (!mu_options_unsigned(at, 8, MU_SURFACE_MOST, &whole)) return 0;
        r->n = (uint32_t)whole;
        return whole % 2 == 0 || (mu_refuse(&usage, "--size is %u; it must be even", r->n), 0);
    case SEED:
        return mu_options_unsigned(at, 0, UINT64_MAX, &r->seed);
    case CORRELATION:
        if (!read_number(at, &r->correlation)) return 0;
        return r->correlation > 0 ||
               (mu_refuse(&usage, "--correlation is %g; it must be above 0", r->correlation), 0);
    case CLIP:
        if (!read_number(at, &r->clip)) return 0;
        return (r->clip > 0 && r->clip < 1) ||
               (mu_refuse(&usage, "--clip is %g; it must lie between 0 and 1", r->clip), 0);
    case PASSES:
        if (!mu_options_unsigned(at, 1, 1000, &whole)) return 0;
        making->passes = (uint32_t)whole;
        return 1;
    default:
        making->file = at->value;
        return 1;
    }
}

/* The parameters that the law has, all of them and no others. */
static _Bool check(const mu_making *making) {
    const mu_slope_law *law = &making->recipe.law;
    if (!making->given[NDF]) return mu_refuse(&usage, "--ndf is needed"), 0;
    if (!making->file) return mu_refuse(&usage, "-o FILE is needed"), 0;
    const char *const name = mu_slope_names()[law->kind];
    const _Bool wanted[] = {law->kind != MU_SLOPE_PHONG,
                            law->kind == MU_SLOPE_GTR || law->kind == MU_SLOPE_STD,
                            law->kind == MU_SLOPE_PHONG};
    for (int k = 0; k < 3; k++) {
        if (wanted[k] && !making->given[ALPHA + k])
            return mu_refuse(&usage, "%s needs --%s", name, options[ALPHA + k].name), 0;
        if (!wanted[k] && making->given[ALPHA + k])
            return mu_refuse(&usage, "%s has no --%s", name, options[ALPHA + k].name), 0;
    }
    const char *const trouble = mu_slope_trouble(law);
    if (trouble) return mu_refuse(&usage, "%s: %s", name, trouble), 0;
    if (making->recipe.correlation > making->recipe.n / 4.0)
        return mu_refuse(
                   &usage,
                   "--correlation is %g; at most a quarter of the size %u leaves room for a distribution",
                   making->recipe.correlation, making->recipe.n),
               0;
    return 1;
}

static void show(_Bool terminal, uint32_t pass, uint32_t passes) {
    if (terminal) fprintf(stderr, pass < passes ? "\rpass %u of %u\033[K" : "\r\033[K", pass + 1, passes);
}

/* Passes go on, up to twice as many, while a slope is above the limit. */
static _Bool fit(const mu_making *making, mu_generator *g, const mu_spectral *fft, uint32_t *done) {
    const _Bool terminal = isatty(STDERR_FILENO);
    if (!mu_generator_start(g, fft)) return 0;
    for (*done = 0; *done < making->passes || (mu_generator_steepest(g) > 1 && *done < 2 * making->passes);
         ++*done) {
        show(terminal, *done, making->passes > *done ? making->passes : 2 * making->passes);
        if (!mu_generator_pass(g, fft)) return 0;
    }
    show(terminal, *done, *done);
    return 1;
}

static void report(const mu_making *making, const mu_surface_info *info, const mu_heightfield *f) {
    double low = f->h[0], high = f->h[0];
    for (size_t k = 0; k < mu_cells(f); k++) low = fmin(low, f->h[k]), high = fmax(high, f->h[k]);
    mu_json json = {0};
    mu_json_begin(&json);
    mu_json_string(&json, "file", making->file);
    mu_json_string(&json, "ndf", mu_slope_names()[making->recipe.law.kind]);
    mu_json_number(&json, "size", f->nx);
    mu_json_number(&json, "passes", info->passes);
    mu_json_numbers(&json, "deviation", info->deviation, 2);
    mu_json_number(&json, "steepest", info->steepest);
    mu_json_number(&json, "limit", mu_slope_quantile(&making->recipe.law, making->recipe.clip));
    mu_json_number(&json, "range", high - low);
    mu_json_write(&json, stdout);
    mu_json_free(&json);
}

static int make(const mu_making *making, const char *command) {
    mu_error error = {.text = ""};
    if (!mu_output_check(making->file, &error)) return mu_refuse(&usage, "%s", error.text);
    mu_generator *g = mu_generator_make(&making->recipe);
    mu_fft *fft = mu_fft_make(making->recipe.n);
    int code = MU_EXIT_REFUSED;
    mu_surface_info info = {.recipe = &making->recipe, .command = command};
    const mu_spectral spectral = mu_fft_spectral(fft);
    if (!g || !fft || !fit(making, g, &spectral, &info.passes)) {
        mu_refuse(&usage, "not enough memory for a surface of size %u", making->recipe.n);
    } else {
        const mu_heightfield f = mu_generator_surface(g);
        for (int k = 0; k < 2; k++) info.deviation[k] = mu_slope_deviation(&f, k, &making->recipe.law, 20);
        info.steepest =
            mu_generator_steepest(g) * mu_slope_quantile(&making->recipe.law, making->recipe.clip);
        if (mu_surface_write(making->file, &f, &info, &error)) {
            report(making, &info, &f);
            code = MU_EXIT_OK;
        } else {
            mu_refuse(&usage, "%s", error.text);
        }
    }
    mu_fft_free(fft);
    mu_generator_free(g);
    return code;
}

int mu_command_surface_make(int argc, char **argv) {
    mu_making making = {.recipe = {.n = 512, .correlation = 8, .clip = 0.9999}, .passes = 30};
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) return mu_refuse(&usage, "\"%s\" is no option", given.value);
        if (met < 0) return mu_options_exit(met);
        if (!read_option(&making, &given, met)) return MU_EXIT_REFUSED;
    }
    if (!check(&making)) return MU_EXIT_REFUSED;
    char command[1024];
    mu_options_command(argc, argv, sizeof command, command);
    return make(&making, command);
}
