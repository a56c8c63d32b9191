/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_eval.c: `musurf eval`, JSON Lines in, JSON Lines out. Local frame: z is the macrosurface normal,
 * directions point away from the surface. D, Dv, f and pdf are per steradian; f holds no cosine.
 */
#include <math.h>

#include "core/render/answers.h"
#include "core/render/command.h"
#include "core/render/query.h"

static const mu_option options[] = {
    {"precision", "float|double", "arithmetic of the evaluation (default: double)"}, {NULL, NULL, NULL}};

static const mu_usage usage = {
    "eval", "[--precision float|double] [FILE]",
    "Evaluates materials at given directions. Each line of FILE or standard input is a JSON object; each "
    "gets one\n"
    "line in answer, in the same order. Empty lines are passed over.\n",
    options,
    "in:   \"material\"  an object as in a scene file: {\"material\": \"musurf.microfacet\", \"ndf\": "
    "\"ggx\", ...}\n"
    "      \"wo\"        [x, y, z] toward the viewer; z is along the surface normal; need not be a unit "
    "vector\n"
    "      \"wm\"        [x, y, z] a micronormal (optional)\n"
    "      \"wi\"        [x, y, z] toward the light (optional)\n"
    "      \"id\"        anything; it is handed back (optional)\n"
    "out:  always    \"Lambda\" (null where it is infinite), \"sigma\": of wo\n"
    "      with wm   \"D\" [1/sr], \"G1\", \"Dv\" [1/sr]\n"
    "      with wi   \"f\" [r,g,b] in 1/sr without the cosine, \"F\" [r,g,b], \"G2\", \"pdf\" [1/sr] of "
    "sampling wi given wo\n"
    "      mirrors   \"delta\": true; f and pdf are 0\n"
    "A line that cannot be answered gets {\"id\", \"error\"}; the others go on, and the exit code is 1.\n"
    "\n"
    "example:\n"
    "  echo '{\"material\": {\"material\": \"musurf.microfacet\"}, \"wo\": [0, 0, 1], \"wi\": [1, 0, 1]}' | "
    "musurf eval\n"};

typedef struct evaluation {
    mu_query_cache cache;
    musurf_precision precision;
} evaluation;

/* The first quantity that JSON cannot say, or NULL; Lambda alone may be infinite. */
static const char *not_finite(const musurf_probe_values *v) {
    const struct {
        const char *name;
        double value;
    } each[] = {{"sigma", v->sigma}, {"D", v->D},     {"G1", v->G1},  {"Dv", v->Dv},
                {"G2", v->G2},       {"pdf", v->pdf}, {"f", v->f[0]}, {"f", v->f[1]},
                {"f", v->f[2]},      {"F", v->F[0]},  {"F", v->F[1]}, {"F", v->F[2]}};
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++)
        if (!isfinite(each[i].value)) return each[i].name;
    return isnan(v->Lambda) ? "Lambda" : NULL;
}

static _Bool answer(void *context, const mu_document *document, mu_json *json, mu_error *error) {
    evaluation *const e = context;
    static const char *const known[] = {"material", "wo", "wm", "wi", "id", NULL};
    const mu_place root = mu_place_root(document);
    if (!mu_place_only(&root, known, error)) return 0;
    const mu_place material = mu_place_member(&root, "material"), wo_place = mu_place_member(&root, "wo"),
                   wm_place = mu_place_member(&root, "wm"), wi_place = mu_place_member(&root, "wi");

    double wo[3], wm[3], wi[3];
    mu_probed probed;
    if (!mu_query_direction(&wo_place, wo, error)) return 0;
    if (wm_place.value && !mu_query_direction(&wm_place, wm, error)) return 0;
    if (wi_place.value && !mu_query_direction(&wi_place, wi, error)) return 0;
    if (!mu_query_material(&e->cache, &material, &probed, error)) return 0;

    musurf_probe_values v = {0};
    const musurf_result result = probed.probe->evaluate(
        probed.compiled, e->precision, wo, wm_place.value ? wm : NULL, wi_place.value ? wi : NULL, &v);
    if (result != MUSURF_OK) return mu_query_fail(&root, &probed, result, error);
    const char *const beyond = not_finite(&v);
    if (beyond)
        return mu_place_fail(&root, error, "%s has no finite %s for this material and these directions",
                             probed.type, beyond);

    mu_json_begin(json);
    mu_query_put_id(json, document->text, document->length, 0);
    mu_json_number(json, "Lambda", v.Lambda);
    mu_json_number(json, "sigma", v.sigma);
    if (wm_place.value) {
        mu_json_number(json, "D", v.D);
        mu_json_number(json, "G1", v.G1);
        mu_json_number(json, "Dv", v.Dv);
    }
    if (wi_place.value) {
        mu_json_numbers(json, "f", v.f, 3);
        mu_json_numbers(json, "F", v.F, 3);
        mu_json_number(json, "G2", v.G2);
        mu_json_number(json, "pdf", v.pdf);
    }
    if (v.delta) mu_json_raw(json, "delta", "true", 4);
    return 1;
}

int mu_command_eval(int argc, char **argv) {
    static const char *const precisions[] = {"float", "double", NULL};
    int precision = 1, met;
    const char *input = "-";
    mu_options given = mu_options_begin(&usage, argc, argv);
    for (_Bool named = 0; (met = mu_options_next(&given)) != MU_OPTIONS_END;) {
        if (met == MU_OPTIONS_OPERAND) {
            if (named) return mu_refuse(&usage, "one FILE at most, but \"%s\" is a second", given.value);
            named = 1;
            input = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else if (!mu_options_choice(&given, precisions, &precision)) {
            return MU_EXIT_REFUSED;
        }
    }

    evaluation e = {.precision = precision ? MUSURF_DOUBLE : MUSURF_FLOAT};
    mu_error error = {.text = ""};
    const int code = mu_query_cache_make(&e.cache, &error) ? mu_answer_file(&usage, input, answer, &e)
                                                           : mu_refuse(&usage, "%s", error.text);
    mu_query_cache_free(&e.cache);
    return code;
}
