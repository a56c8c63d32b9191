/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_options.c: the command line of `musurf render`, its help, and what it refuses. */
#include "core/render/render_options.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/output.h"
#include "core/render/render.h"
#include "core/render/scene.h"
#include "core/render/sequence.h"

enum { OUTPUT, INTEGRATOR, READS, SPP, TIME, NOISE, THREADS, SEED, SIZE, FRAME, POSE_TIME, RESUME, PNG, EXPLAIN, PROGRESS, QUIET };

static const mu_option option_list[] = {
    {"o", "OUT.exr", "the image, written when it is complete and whole"},
    {"integrator", "path|split|bent-normal|major-axis|lobe|filtered", "how light is found (default: the scene's, or path)"},
    {"reads", "N|auto", "of the filtered environment, of major-axis, lobe and filtered, 1 to 64 (default: the scene's, or 16,\n"
     "and of lobe 6); auto: of lobe as many as each pixel needs, 1 to 33, of others 16"},
    {"spp", "N", "samples per pixel (default: the scene's)"},
    {"time", "S", "stop before S seconds have passed; at least one sample per pixel is taken"},
    {"noise", "E", "stop when the mean relative standard error of the pixels is E or less"},
    {"threads", "N", "threads (default: one per processor); the image does not depend on it"},
    {"seed", "S", "seed of the random numbers (default: the scene's)"},
    {"size", "WxH", "pixels, instead of the scene's"},
    {"frame", "N", "which of numbered meshes, name_####.ply (default: the first there is)"},
    {"pose-time", "S", "seconds of the animations of poses, instead of the scene's"},
    {"resume", NULL, "go on from OUT.resume; without such a file start from nothing"},
    {"png", "FILE", "an 8-bit sRGB preview as well"},
    {"explain", NULL, "what the scene needs and what is left out, on stdout; without -o that is all"},
    {"progress", "auto|json|none",
     "auto: a bar if stderr is a terminal; json: a line of JSON twice a second"},
    {"quiet", NULL, "nothing on stderr but errors"},
    {NULL, NULL, NULL}};

const mu_usage mu_render_usage = {
    "render", "SCENE -o OUT.exr [OPTIONS]",
    "Renders a scene file by path tracing into an OpenEXR image with albedo, normal, variance and sample\n"
    "count of each pixel; the header holds the scene, this command, the seed and the camera.\n",
    option_list,
    "--time and --noise without --spp are not limited by the scene's samples. Whole passes are made, so "
    "every\n"
    "pixel of a finished image has the same number of samples.\n"
    "\n"
    "--integrator other than path lights microsurfaces that reflect by reads of the light around the scene, filtered in\n"
    "advance for every roughness: one read along the mirrored view (split), one at a bent normal, --reads along the\n"
    "major axis of the lobe, or --reads all over it (lobe: the best of them; filtered: by\n"
    "importance sampling, to compare). There are no shadows, and light is reflected once.\n"
    "\n"
    "--explain prints one JSON object: \"features\" that the scene needs, \"left_out\" (each other feature "
    "and "
    "what\nit would bring), \"materials\" (plan, bytes of closure and tables, lobes, what was left out), "
    "\"meshes\",\n\"lights\" (bytes), \"plugins\" and \"libraries\" (files in the process). `musurf info` "
    "lists "
    "the features.\n"
    "\n"
    "SIGINT, SIGTERM or SIGHUP end the render with exit code 130: OUT.partial.exr holds the image so far, "
    "and\n"
    "OUT.resume the exact sums, from which --resume goes on to the same image as without the interruption.\n"
    "A second signal quits at once. Long renders save OUT.resume every minute. Both files are removed when\n"
    "OUT.exr is written. Whatever happens, an OUT.exr that was there stays until it is replaced as a "
    "whole.\n"};

static _Bool read_number(const mu_options *given, double max, double *out) {
    char *end;
    errno = 0;
    const double value = strtod(given->value, &end);
    if (end == given->value || *end || errno == ERANGE || !(value > 0) || !(value <= max)) {
        mu_refuse(given->usage, "--%s is \"%s\"; a number above 0 and at most %g is needed", given->name,
                  given->value, max);
        return 0;
    }
    *out = value;
    return 1;
}

static _Bool read_time(const mu_options *given, double *out) {
    char *end;
    const double value = strtod(given->value, &end);
    if (end == given->value || *end || !(value >= 0) || !(value <= 1e9)) {
        mu_refuse(given->usage, "--%s is \"%s\"; a number from 0 to 1e9 is needed", given->name, given->value);
        return 0;
    }
    *out = value;
    return 1;
}

_Bool mu_render_size(const mu_options *given, uint32_t *width, uint32_t *height) {
    const char *text = given->value;
    unsigned long side[2] = {0, 0};
    _Bool good = 1;
    for (int i = 0; i < 2 && good; ++i) {
        char *end;
        good = *text >= '0' && *text <= '9'; /* strtoul would take signs and blanks */
        side[i] = strtoul(text, &end, 10);
        good = good && side[i] >= 1 && side[i] <= MU_LONGEST_SIDE && *end == (i ? '\0' : 'x');
        text = end + 1;
    }
    if (!good) {
        mu_refuse(given->usage, "--size is \"%s\"; WxH is needed, both from 1 to %d", given->value,
                  MU_LONGEST_SIDE);
        return 0;
    }
    if (side[0] * side[1] > MU_MOST_PIXELS) {
        mu_refuse(given->usage, "--size is \"%s\": %lu pixels are too many; %d is the limit", given->value,
                  side[0] * side[1], MU_MOST_PIXELS);
        return 0;
    }
    *width = (uint32_t)side[0];
    *height = (uint32_t)side[1];
    return 1;
}

_Bool mu_render_progress(const mu_options *given, mu_render_options *options) {
    static const char *const kinds[] = {"auto", "json", "none", NULL};
    int kind;
    if (!mu_options_choice(given, kinds, &kind)) return 0;
    options->progress = kind == 0 ? MU_PROGRESS_AUTO : kind == 1 ? MU_PROGRESS_JSON : MU_PROGRESS_NONE;
    return 1;
}

static _Bool take(mu_render_options *options, int met, const mu_options *given) {
    uint64_t threads, frame;
    switch (met) {
    case OUTPUT:
        options->output = given->value;
        return 1;
    case PNG:
        options->png = given->value;
        return 1;
    case INTEGRATOR:
        return mu_options_choice(given, mu_integrators, &options->integrator);
    case READS:
        if (strcmp(given->value, "auto")) return mu_options_unsigned(given, 1, MU_IBL_READS_MOST, &options->reads);
        options->reads = MU_READS_AUTO;
        return 1;
    case SPP:
        return mu_options_unsigned(given, 1, MU_MOST_SAMPLES, &options->samples);
    case TIME:
        return read_number(given, 1e9, &options->seconds);
    case NOISE:
        return read_number(given, 1e6, &options->noise);
    case SIZE:
        return mu_render_size(given, &options->width, &options->height);
    case FRAME:
        if (!mu_options_unsigned(given, 0, MU_LAST_FRAME, &frame)) return 0;
        options->frame = (long long)frame;
        return 1;
    case POSE_TIME:
        return read_time(given, &options->pose_time);
    case RESUME:
        return options->resume = 1;
    case EXPLAIN:
        return options->explain = 1;
    case QUIET:
        return options->quiet = 1;
    case SEED:
        return options->seed_given = mu_options_unsigned(given, 0, UINT64_MAX, &options->seed);
    case THREADS:
        if (!mu_options_unsigned(given, 1, 1024, &threads)) return 0;
        options->threads = (uint32_t)threads;
        return 1;
    case PROGRESS:
        return mu_render_progress(given, options);
    case MU_OPTIONS_OPERAND:
        if (options->scene) {
            mu_refuse(given->usage, "one SCENE at a time, but \"%s\" is a second", given->value);
            return 0;
        }
        options->scene = given->value;
        return 1;
    default:
        return 0;
    }
}

_Bool mu_render_options_read(mu_render_options *options, int argc, char **argv, int *exit) {
    const mu_usage *usage = &mu_render_usage;
    mu_options given = mu_options_begin(usage, argc, argv);
    int met;
    *options = (mu_render_options){.threads = mu_processors(), .frame = MU_NO_FRAME, .pose_time = -1, .integrator = -1};
    *exit = MU_EXIT_REFUSED;
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met < 0 && met != MU_OPTIONS_OPERAND) {
            *exit = mu_options_exit(met);
            return 0;
        }
        if (!take(options, met, &given)) return 0;
    }
    if (!options->scene)
        mu_refuse(usage, "which SCENE? See musurf render --help");
    else if (!options->output && !options->explain)
        mu_refuse(usage, "no output is named; -o OUT.exr is needed");
    else if (options->output && !mu_output_ends_in(options->output, ".exr"))
        mu_refuse(usage, "-o is \"%s\"; it must be a name that ends in .exr (a PNG preview is made by --png)",
                  options->output);
    else if (options->png && !options->output)
        mu_refuse(usage, "--png needs -o OUT.exr as well");
    else if (options->png && !strcmp(options->png, options->output))
        mu_refuse(usage, "-o and --png are the same file");
    else
        *exit = MU_EXIT_OK;
    return *exit == MU_EXIT_OK;
}
