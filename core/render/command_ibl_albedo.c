/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_ibl_albedo.c: `musurf ibl albedo`, the other factor of the split integral (Section 3): how much of even light a
 * material reflects toward a view, Fresnel included. Of any material that can be looked into, under its M.
 *
 * By even_light.c, along the lobe and by the material's own samples, whichever does better: BATCHES lattices of either kind, each
 * shifted at random, so that their spread tells the standard error.
 */
#include <math.h>
#include <stdlib.h>

#include "core/render/answers.h"
#include "core/render/command_ibl.h"
#include "core/render/even_light.h"
#include "core/render/query.h"
#include "core/render/surface_rows.h"

enum { ROWS, COLUMNS, SAMPLES, SEED, BATCHES = 16 };

static const mu_option options[] = {
    {"rows", "N", "cosines of the view, at (j + 1/2) / N, 1 to 1024 (default: 16)"},
    {"columns", "N", "azimuths of the view, at 2 pi i / N, 1 to 1024 (default: 8)"},
    {"samples", "N", "per view, 16 to 16777216, in 16 batches, half of them of its own sampler (default: 4096)"},
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
    "What passes to the other side is not counted.\n"
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
    _Bool has_lobe;
    mu_ibl_lobe_d lobe;
    musurf_result *result; /* of each row */
} tables;

/* What even_light.h asks of a probe seen from wo. */
typedef struct asked {
    const mu_probed *probed;
    double wo[3];
    musurf_result result; /* the first that was not good */
} asked;

static void toward(void *context, const double wi[3], double rgb[EVEN_PARTS]) {
    asked *a = context;
    musurf_probe_values v = {0};
    const musurf_result result = a->probed->probe->evaluate(a->probed->compiled, MUSURF_DOUBLE, a->wo, NULL, wi, &v);
    if (a->result == MUSURF_OK) a->result = result;
    for (int c = 0; c < 3; c++) rgb[c] = v.f[c] * wi[2];
}

static void drawn(void *context, const double u[3], double rgb[3]) {
    asked *a = context;
    musurf_probe_sample s = {0};
    const musurf_result result = a->probed->probe->sample(a->probed->compiled, MUSURF_DOUBLE, MUSURF_SAMPLE_AS_SET, a->wo, u, &s);
    if (a->result == MUSURF_OK) a->result = result;
    for (int c = 0; c < 3; c++) rgb[c] = s.wi[2] > 0 ? s.weight[c] : 0;
}

/* [any] */
static void fill_row(void *context, uint32_t row) {
    tables *t = context;
    const double z = ((double)row + 0.5) / (double)t->rows, flat = sqrt((1 - z) * (1 + z));
    for (uint64_t column = 0; column < t->columns; column++) {
        const double phi = 2 * 3.14159265358979323846 * (double)column / (double)t->columns;
        const size_t view = (size_t)(row * t->columns + column);
        asked a = {&t->probed, {flat * cos(phi), flat * sin(phi), z}, MUSURF_OK};
        const mu_even_source source = {&a, toward, drawn, .lobe = t->has_lobe ? &t->lobe : NULL};
        const size_t each = t->samples >= 2 * BATCHES ? (size_t)t->samples / (2 * BATCHES) : 1;
        const mu_even_mean mean = mu_even_light_shifted(&source, a.wo, BATCHES, each, t->seed, view);
        for (int c = 0; c < 3; c++) t->albedo[3 * view + (size_t)c] = mean.rgb[c];
        t->deviation[view] = mean.error;
        if (a.result != MUSURF_OK) t->result[row] = a.result;
    }
}

/* Where its light comes from, if it has no delta lobe. */
static void find_lobe(tables *t) {
    const mu_probed *p = &t->probed;
    musurf_moments m;
    t->has_lobe = !(p->lobes & MUSURF_DELTA_LOBES) && p->slopes && p->slopes->moments(p->compiled, NULL, &m) == MUSURF_OK;
    if (t->has_lobe) t->lobe = mu_ibl_lobe_of_d(&(mu_ibl_slopes){{m.mean[0], m.mean[1]}, m.xx, m.xy, m.yy});
}

static _Bool answer(void *context, const mu_document *line, mu_json *json, mu_error *error) {
    static const char *const known[] = {"material", "id", NULL};
    tables *t = context;
    const mu_place root = mu_place_root(line);
    if (!mu_place_only(&root, known, error)) return 0;
    const mu_place material = mu_place_member(&root, "material");
    if (!mu_query_material(&t->cache, &material, &t->probed, error)) return 0;
    const size_t views = (size_t)(t->rows * t->columns);
    find_lobe(t);
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
