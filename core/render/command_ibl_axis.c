/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_ibl_axis.c: `musurf ibl axis`, JSON Lines in, JSON Lines out: what core/ibl makes of a lobe and a view, in double. */
#include <stdlib.h>

#include "core/render/answers.h"
#include "core/render/command_ibl.h"
#include "core/render/query.h"

static const mu_option options[] = {{NULL, NULL, NULL}};

static const mu_usage usage = {
    "ibl axis", "[FILE]",
    "The major axis of a lobe and samples along it. Each line of FILE or standard input is a JSON object; "
    "each gets one\n"
    "line in answer, in the same order. Empty lines are passed over.\n",
    options,
    "Micronormals are unit vectors in the frame of wo, z along the surface normal; a micronormal m has the "
    "slope\n"
    "-m.xy / m.z and reflects wo to 2 (m.wo) m - wo. The confidence region's boundary has the slopes\n"
    "k sigma[0] cos(t) U + k sigma[1] sin(t) V. Lengths are chords between reflected directions.\n"
    "in:   \"sigma\"       [sU, sV] standard deviations of the slope along U and V (alpha / sqrt(2) of GGX), "
    "at least 0\n"
    "      \"wo\"          [x, y, z] toward the viewer, z at least 0; need not be a unit vector\n"
    "      \"angle\"       from the x axis to U, radians, counter-clockwise (default: 0)\n"
    "      \"k\"           size of the confidence region, above 0 (default: 1)\n"
    "      \"N\"           samples, 1 to 65536 (default: 16)\n"
    "      \"beta\"        how far neighbouring samples overlap, at least 0 (default: 2.3)\n"
    "      \"appendix_c\"  \"symmetric\" or \"printed\": how the closest points move where the axis is cut; "
    "they\n"
    "                    differ where both ends are (default: \"symmetric\")\n"
    "      \"id\"          anything; it is handed back (optional)\n"
    "out:  \"t\"           [t0, t1] of the closest and the farthest point, in (-pi/2, pi/2]; [pi/2, 0] where "
    "all points\n"
    "                    are equally far\n"
    "      \"far\"         [2 micronormals] of the boundary at t1 and t1 + pi\n"
    "      \"near\"        [2 micronormals] of the boundary at t0 and t0 + pi\n"
    "      \"tau\"         [tau0, tau1]: where from far[0] (0) to far[1] (1) the axis reflects to the "
    "horizon; 0 or 1\n"
    "                    for an end that nothing would cut, however long\n"
    "      \"far_clamped\" [2 micronormals] the axis' ends above the horizon\n"
    "      \"delta\"       by how much t of the closest points is shifted\n"
    "      \"width\"       between the shifted closest points\n"
    "      \"length\"      between the clamped ends\n"
    "      \"zeta\"        (length - width) / length, which draws in the samples; 0 where length is 0\n"
    "      \"radius\"      of a sample: the environment is filtered for alpha = radius\n"
    "      \"samples\"     [N micronormals]\n"
    "A line that cannot be answered gets {\"id\", \"error\"}; the others go on, and the exit code is 1.\n"
    "\n"
    "example:\n"
    "  echo '{\"sigma\": [0.3, 0.1], \"wo\": [0.6, 0, 0.8], \"N\": 4}' | musurf ibl axis\n"};

static _Bool answer(void *context, const mu_document *line, mu_json *json, mu_error *error) {
    double *const samples = context;
    const mu_place root = mu_place_root(line);
    mu_ibl_question ask;
    if (!mu_ibl_ask(&root, &ask, error)) return 0;
    mu_ibl_axis_d axis;
    mu_ibl_axis_make_d(&ask.lobe, ask.wo, &ask.settings, &axis);
    for (size_t j = 0; j < ask.settings.samples; j++)
        mu_ibl_axis_sample_d(&axis, ask.settings.samples, j, samples + 3 * j);

    mu_json_begin(json);
    mu_query_put_id(json, line->text, line->length, 0);
    mu_json_numbers(json, "t", axis.t, 2);
    mu_json_vectors(json, "far", axis.far[0], 2, 3);
    mu_json_vectors(json, "near", axis.near[0], 2, 3);
    mu_json_numbers(json, "tau", axis.tau, 2);
    mu_json_vectors(json, "far_clamped", axis.far_clamped[0], 2, 3);
    mu_json_number(json, "delta", axis.delta);
    mu_json_number(json, "width", axis.width);
    mu_json_number(json, "length", axis.length);
    mu_json_number(json, "zeta", axis.zeta);
    mu_json_number(json, "radius", axis.radius);
    mu_json_vectors(json, "samples", samples, ask.settings.samples, 3);
    return 1;
}

int mu_command_ibl_axis(int argc, char **argv) {
    const char *input = NULL;
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met != MU_OPTIONS_OPERAND) return mu_options_exit(met);
        if (input) return mu_refuse(&usage, "one FILE at most, but \"%s\" is a second", given.value);
        input = given.value;
    }
    double *const samples = malloc(3 * MU_IBL_SAMPLES_MOST * sizeof *samples);
    if (!samples) return mu_refuse(&usage, "not enough memory");
    const int code = mu_answer_file(&usage, input ? input : "-", answer, samples);
    free(samples);
    return code;
}
