/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_ibl_albedo.c: `musurf ibl albedo`, the other factor of the split integral (Section 3): how much of even light a
 * material reflects toward a view, Fresnel included. Of any material that can be looked into, under its M.
 *
 * The mean weight of its own sampler, which is that integral: BATCHES times an additive lattice, each shifted at random, so that
 * the batches' spread tells the standard error. The first two numbers, which move the normal, step by powers of the root of
 * x³ = x + 1 (Roberts 2018), the third by the root of 2.
 */
#include <math.h>
#include <stdlib.h>

#include "core/render/answers.h"
#include "core/render/command_ibl.h"
#include "core/render/philox.h"
#include "core/render/query.h"
#include "core/render/surface_rows.h"

enum { ROWS, COLUMNS, SAMPLES, SEED, BATCHES = 16 };

static const mu_option options[] = {
    {"rows", "N", "cosines of the view, at (j + 1/2) / N, 1 to 1024 (default: 16)"},
    {"columns", "N", "azimuths of the view, at 2 pi i / N, 1 to 1024 (default: 8)"},
    {"samples", "N", "per view, 16 to 16777216, in 16 batches (default: 4096)"},
    {"seed", "S", "of the batches' shifts (default: 0)"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "ibl albedo", "[OPTIONS] [FILE]",
    "Tables of directional albedo: the share of even light that a material reflects toward each view, as r, "
    "g, b. Each\n"
    "line of FILE or standard input is a JSON object; each gets one line in answer. Empty lines are passed "
    "over.\n",
    options,
    "in:   \"material\"   an object as in a scene file\n"
    "      \"id\"         anything; it is handed back (optional)\n"
    "out:  \"cosines\"    of the views to the normal, of each row\n"
    "      \"azimuths\"   of the views, radians counter-clockwise from x, of each column\n"
    "      \"albedo\"     [rows of [r, g, b] for each column, one after the other]\n"
    "      \"deviation\"  the largest standard error among them\n"
    "What passes to the other side is not counted. A view takes some 0.005 s of a core, 0.08 s where tails are long.\n"
    "A line that cannot be answered gets {\"id\", \"error\"}; the others go on, and the exit code is 1.\n"
    "\n"
    "example:\n"
    "  echo '{\"material\": {\"material\": \"musurf.microfacet\", \"alpha\": 0.5}}' | musurf ibl albedo "
    "--columns 1\n"};

typedef struct tables {
    uint64_t rows, columns, samples, seed;
    mu_query_cache cache;
    double *albedo, *deviation; /* 3 of each view; 1 of each */
    mu_probed probed;
    musurf_result *result; /* of each row */
} tables;

/* [any] */
static void fill_row(void *context, uint32_t row) {
    static const double step[3] = {0.7548776662466927, 0.5698402909980532, 0.4142135623730950};
    tables *t = context;
    const uint64_t each = t->samples / BATCHES;
    const double z = ((double)row + 0.5) / (double)t->rows, flat = sqrt((1 - z) * (1 + z));
    for (uint64_t column = 0; column < t->columns; column++) {
        const double phi = 2 * 3.14159265358979323846 * (double)column / (double)t->columns;
        const double wo[3] = {flat * cos(phi), flat * sin(phi), z};
        const size_t view = (size_t)(row * t->columns + column);
        double mean[3] = {0, 0, 0}, square[3] = {0, 0, 0};
        for (uint64_t b = 0; b < BATCHES; b++) {
            double shift[3], sum[3] = {0, 0, 0};
            mu_philox_uniforms(t->seed, view * BATCHES + b, shift);
            for (uint64_t i = 0; i < each; i++) {
                double u[3];
                for (int k = 0; k < 3; k++) {
                    const double place = shift[k] + (double)i * step[k];
                    u[k] = fmin(place - floor(place), 1 - 0x1p-53);
                }
                musurf_probe_sample s = {0};
                const musurf_result result = t->probed.probe->sample(t->probed.compiled, MUSURF_DOUBLE,
                                                                     MUSURF_SAMPLE_AS_SET, wo, u, &s);
                if (result != MUSURF_OK) {
                    t->result[row] = result;
                    return;
                }
                for (int c = 0; c < 3 && s.wi[2] > 0; c++) sum[c] += s.weight[c];
            }
            for (int c = 0; c < 3; c++) {
                const double here = sum[c] / (double)each, before = here - mean[c]; /* Welford */
                mean[c] += before / (double)(b + 1);
                square[c] += before * (here - mean[c]);
            }
        }
        for (int c = 0; c < 3; c++) {
            t->albedo[3 * view + (size_t)c] = mean[c];
            t->deviation[view] = fmax(t->deviation[view], sqrt(square[c] / (BATCHES * (BATCHES - 1))));
        }
    }
}

static _Bool answer(void *context, const mu_document *line, mu_json *json, mu_error *error) {
    static const char *const known[] = {"material", "id", NULL};
    tables *t = context;
    const mu_place root = mu_place_root(line);
    if (!mu_place_only(&root, known, error)) return 0;
    const mu_place material = mu_place_member(&root, "material");
    if (!mu_query_material(&t->cache, &material, &t->probed, error)) return 0;
    const size_t views = (size_t)(t->rows * t->columns);
    for (size_t i = 0; i < views; i++) t->deviation[i] = 0;
    for (size_t i = 0; i < t->rows; i++) t->result[i] = MUSURF_OK;
    mu_rows((uint32_t)t->rows, mu_processors(), fill_row, t);
    for (size_t i = 0; i < t->rows; i++)
        if (t->result[i] != MUSURF_OK) return mu_query_fail(&root, &t->probed, t->result[i], error);
    double most = 0;
    for (size_t i = 0; i < views; i++) most = fmax(most, t->deviation[i]);
    for (size_t i = 0; i < 3 * views; i++)
        if (!isfinite(t->albedo[i])) return mu_place_fail(&material, error, "reflects what is no number");

    mu_json_begin(json);
    mu_query_put_id(json, line->text, line->length, 0);
    for (size_t i = 0; i < t->rows; i++) t->deviation[i] = ((double)i + 0.5) / (double)t->rows;
    mu_json_numbers(json, "cosines", t->deviation, (size_t)t->rows);
    for (size_t i = 0; i < t->columns; i++)
        t->deviation[i] = 2 * 3.14159265358979323846 * (double)i / (double)t->columns;
    mu_json_numbers(json, "azimuths", t->deviation, (size_t)t->columns);
    mu_json_vectors(json, "albedo", t->albedo, views, 3);
    mu_json_number(json, "deviation", most);
    return 1;
}

static int answer_file(tables *t, const char *input) {
    const size_t views = (size_t)(t->rows * t->columns);
    mu_error error = {.text = ""};
    t->albedo = malloc(3 * views * sizeof(double));
    t->deviation = malloc(views * sizeof(double));
    t->result = malloc((size_t)t->rows * sizeof *t->result);
    int code;
    if (!t->albedo || !t->deviation || !t->result)
        code = mu_refuse(&usage, "not enough memory");
    else if (!mu_query_cache_make(&t->cache, &error))
        code = mu_refuse(&usage, "%s", error.text);
    else
        code = mu_answer_file(&usage, input, answer, t);
    mu_query_cache_free(&t->cache);
    free(t->albedo), free(t->deviation), free(t->result);
    return code;
}

int mu_command_ibl_albedo(int argc, char **argv) {
    tables t = {.rows = 16, .columns = 8, .samples = 4096};
    const char *input = NULL;
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) {
            if (input) return mu_refuse(&usage, "one FILE at most, but \"%s\" is a second", given.value);
            input = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else if (!(met == ROWS      ? mu_options_unsigned(&given, 1, 1024, &t.rows)
                     : met == COLUMNS ? mu_options_unsigned(&given, 1, 1024, &t.columns)
                     : met == SAMPLES ? mu_options_unsigned(&given, BATCHES, 1 << 24, &t.samples)
                                      : mu_options_unsigned(&given, 0, UINT64_MAX, &t.seed))) {
            return MU_EXIT_REFUSED;
        }
    }
    return answer_file(&t, input ? input : "-");
}
