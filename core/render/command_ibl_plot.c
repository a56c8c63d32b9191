/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_ibl_plot.c: `musurf ibl plot`, what `musurf ibl axis` answers to one line, as a picture. */
#include "core/render/command_ibl.h"
#include "core/render/ibl_picture.h"
#include "core/render/inputs.h"
#include "core/render/output_stream.h"
#include "core/render/options.h"

static const mu_option options[] = {{"o", "FILE.svg", "the picture (needed)"}, {NULL, NULL, NULL}};

static const mu_usage usage = {
    "ibl plot", "-o FILE.svg [FILE]",
    "Draws a lobe of GGX, its confidence region, its major axis and the samples on it as slopes, as "
    "micronormals and as\n"
    "reflected directions, the last two from above with equal areas. FILE or standard input holds one object "
    "as musurf\n"
    "ibl axis reads it.\n",
    options,
    "Of more than 256 samples 256 are drawn, evenly, and the picture says so.\n"
    "With a roughness of 0, or a view along the horizon, there is no density to draw, only the points.\n"
    "\n"
    "example:\n"
    "  echo '{\"sigma\": [0.3, 0.1], \"angle\": 0.5, \"wo\": [0.8, 0, 0.3]}' | musurf ibl plot -o "
    "lobe.svg\n"};

static _Bool draw(const char *input, const char *output, mu_error *error) {
    mu_document document = {0};
    mu_output_stream stream;
    mu_ibl_question ask;
    _Bool good = mu_output_check(output, error) && mu_input_keep(output, input, error) &&
                 mu_document_read(&document, input, error);
    if (good) {
        const mu_place root = mu_place_root(&document);
        good = mu_ibl_ask(&root, &ask, error);
    }
    if (good && mu_output_stream_open(&stream, output, error)) {
        good = mu_ibl_draw(&ask, stream.file);
        if (good) {
            good = mu_output_stream_commit(&stream, error);
        } else {
            mu_output_stream_discard(&stream);
            mu_fail(error, "%s: not enough memory", output);
        }
    } else {
        good = 0;
    }
    mu_document_free(&document);
    return good;
}

int mu_command_ibl_plot(int argc, char **argv) {
    const char *input = NULL, *output = NULL;
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == 0) {
            output = given.value;
        } else if (met != MU_OPTIONS_OPERAND) {
            return mu_options_exit(met);
        } else if (input) {
            return mu_refuse(&usage, "one FILE at most, but \"%s\" is a second", given.value);
        } else {
            input = given.value;
        }
    }
    if (!output) return mu_refuse(&usage, "-o FILE.svg is needed");
    mu_error error = {.text = ""};
    return draw(input ? input : "-", output, &error) ? MU_EXIT_OK : mu_refuse(&usage, "%s", error.text);
}
