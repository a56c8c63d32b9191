/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_sample.c: `musurf sample`, directions drawn from a material. The same seed gives the same lines on
 * every machine; line i depends on (seed, i) alone, so --n 10 begins as --n 1000 does. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/render/command.h"
#include "core/render/options.h"
#include "core/render/philox.h"
#include "core/render/query.h"

static const mu_option options[] = {
    {"n", "N", "how many samples (default: 1)"},
    {"seed", "S", "seed of the random numbers, 0 to 2^64-1 (default: 0)"},
    {"precision", "float|double", "arithmetic of the sampling (default: double)"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "sample", "[--n N] [--seed S] [--precision float|double] [FILE]",
    "Draws directions from a material. FILE or standard input holds one JSON object; N lines come out.\n",
    options,
    "in:   \"material\"  an object as in a scene file\n"
    "      \"wo\"        [x, y, z] toward the viewer; z is along the surface normal; need not be a unit "
    "vector\n"
    "      \"id\"        anything; it is handed back in each line (optional)\n"
    "out:  \"wi\"        [x, y, z] the sampled direction, or null for a rejected sample (it fell below the "
    "surface);\n"
    "                  then f, pdf and weight are 0; a mean over samples counts it\n"
    "      \"wm\"        [x, y, z] the micronormal it was reflected by\n"
    "      \"f\"         [r, g, b] in 1/sr, without the cosine\n"
    "      \"pdf\"       1/sr\n"
    "      \"weight\"    [r, g, b] f cos / pdf, computed without that quotient\n"
    "      \"delta\"     true where a mirror was sampled: f is 0 and pdf the probability of that mirror, not "
    "a density\n"
    "The uniforms of line i are Philox4x32-10 of key S at counter i, in float precision cut to 24 bits.\n"};

static void put_sample(mu_json *json, const mu_document *document, const musurf_probe_sample *s) {
    mu_json_begin(json);
    mu_query_put_id(json, document->text, document->length, 0);
    if (s->rejected)
        mu_json_raw(json, "wi", "null", 4);
    else
        mu_json_numbers(json, "wi", s->wi, 3);
    mu_json_numbers(json, "wm", s->wm, 3);
    mu_json_numbers(json, "f", s->f, 3);
    mu_json_number(json, "pdf", s->pdf);
    mu_json_numbers(json, "weight", s->weight, 3);
    if (s->delta) mu_json_raw(json, "delta", "true", 4);
}

static _Bool all_finite(const musurf_probe_sample *s) {
    for (int i = 0; i < 3; i++)
        if (!isfinite(s->wi[i]) || !isfinite(s->wm[i]) || !isfinite(s->f[i]) || !isfinite(s->weight[i]))
            return 0;
    return isfinite(s->pdf);
}

typedef struct sampling {
    uint64_t count, seed;
    musurf_precision precision;
} sampling;

/* False with an empty error: standard output failed. */
static _Bool draw(const sampling *how, const mu_document *document, mu_query_cache *cache, mu_json *json,
                  mu_error *error) {
    static const char *const known[] = {"material", "wo", "id", NULL};
    const mu_place root = mu_place_root(document);
    if (!mu_place_only(&root, known, error)) return 0;
    const mu_place material = mu_place_member(&root, "material"), wo_place = mu_place_member(&root, "wo");
    double wo[3];
    mu_probed probed;
    if (!mu_query_direction(&wo_place, wo, error) || !mu_query_material(cache, &material, &probed, error))
        return 0;

    for (uint64_t i = 0; i < how->count; i++) {
        double u[3];
        mu_philox_uniforms(how->seed, i, u);
        /* Rounded to float, the largest double below 1 would be 1. */
        for (int k = 0; how->precision == MUSURF_FLOAT && k < 3; k++) u[k] = floor(u[k] * 0x1p24) * 0x1p-24;
        musurf_probe_sample s = {0};
        const musurf_result result =
            probed.probe->sample(probed.compiled, how->precision, MUSURF_SAMPLE_AS_SET, wo, u, &s);
        if (result != MUSURF_OK) return mu_query_fail(&root, &probed, result, error);
        if (!all_finite(&s))
            return mu_place_fail(&root, error, "%s answered sample %llu with a number that is not finite",
                                 probed.type, (unsigned long long)i);
        put_sample(json, document, &s);
        if (!mu_json_write(json, stdout)) return 0;
    }
    return fflush(stdout) == 0;
}

static int sample_file(const sampling *how, const char *file) {
    mu_error error = {.text = ""};
    mu_document document;
    if (!mu_document_read(&document, file, &error)) return mu_refuse(&usage, "%s", error.text);
    mu_query_cache cache;
    mu_json json = {0};
    int code = MU_EXIT_OK;
    errno = 0;
    if (!mu_query_cache_make(&cache, &error) || !draw(how, &document, &cache, &json, &error)) {
        if (error.text[0]) {
            code = mu_refuse(&usage, "%s", error.text);
        } else {
            fprintf(stderr, "musurf sample: standard output: %s\n", strerror(errno));
            code = MU_EXIT_FAILED;
        }
    }
    mu_json_free(&json);
    mu_query_cache_free(&cache);
    mu_document_free(&document);
    return code;
}

int mu_command_sample(int argc, char **argv) {
    static const char *const precisions[] = {"float", "double", NULL};
    sampling how = {1, 0, MUSURF_DOUBLE};
    const char *file = NULL;
    int met, precision = 1;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) {
            if (file) return mu_refuse(&usage, "one FILE at most, but \"%s\" is a second", given.value);
            file = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else if (!(met == 0   ? mu_options_unsigned(&given, 0, UINT64_C(1) << 53, &how.count)
                     : met == 1 ? mu_options_unsigned(&given, 0, UINT64_MAX, &how.seed)
                                : mu_options_choice(&given, precisions, &precision))) {
            return MU_EXIT_REFUSED;
        }
    }
    how.precision = precision ? MUSURF_DOUBLE : MUSURF_FLOAT;
    return sample_file(&how, file ? file : "-");
}
