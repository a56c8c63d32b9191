/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_ibl_prefilter.c: `musurf ibl prefilter`, an environment for every roughness. */
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "core/render/command_ibl.h"
#include "core/render/ibl_prefilter.h"
#include "core/render/options.h"
#include "core/render/output.h"

enum { OUTPUT, SAMPLES, HEIGHT, THREADS };

static const mu_option options[] = {
    {"o", "OUT.exr", "the chain (needed)"},
    {"samples", "N", "directions per pixel, 16 to 65536 (default: 256)"},
    {"height", "N", "rows of level 0, 8 to 4096; no more than the image has (default: 512)"},
    {"threads", "N", "1 to 256 (default: one for each processor)"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "ibl prefilter", "ENV -o OUT.exr [OPTIONS]",
    "Blurs a latitude-longitude environment or a cube map (any image that OpenImageIO reads; +z up, middle "
    "column towards "
    "+x) by GGX\n"
    "lobes of rising roughness, by filtered importance sampling, into a mip-mapped, tiled OpenEXR file.\n",
    options,
    "Level l holds the radiance around each direction, weighted by the lobe of alpha = (l / (n - 1))^2 seen "
    "along its\n"
    "own mirrored view, cosine included. n is the attribute musurfLevels, the levels down to 8 rows or so; "
    "those beyond\n"
    "are as rough as the last. Level 0 is the environment itself, averaged to its size.\n"
    "An image six times as high as wide is a cube map, its faces in OpenEXR's order and directions.\n"
    "A file that is there already and was made of the same bytes with the same settings is left as it is.\n"};

/* On a terminal alone, where any thread may write the one short line. */
static void show(void *context, double fraction) {
    (void)context;
    char bar[41];
    for (int i = 0; i < 40; i++) bar[i] = i < (int)(40 * fraction) ? '#' : '.';
    bar[40] = 0;
    fprintf(stderr, "\r[%s] %3.0f %%\033[K", bar, 100 * fraction);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int answer(mu_prefilter *job) {
    mu_error error = {.text = ""};
    const _Bool terminal = isatty(STDERR_FILENO);
    const double start = now();
    _Bool kept = 0;
    if (terminal) job->progress = show;
    const _Bool good = mu_output_check(job->output, &error) && mu_prefilter_run(job, &kept, &error);
    if (terminal) fputs("\r\033[K", stderr);
    if (!good) return mu_refuse(&usage, "%s", error.text);
    if (kept)
        fprintf(stderr, "%s: is that of %s already\n", job->output, job->image);
    else
        fprintf(stderr, "%s: %u samples, %.2f s\n", job->output, job->samples, now() - start);
    return MU_EXIT_OK;
}

int mu_command_ibl_prefilter(int argc, char **argv) {
    mu_prefilter job = {.samples = 256, .height = 512, .threads = mu_processors()};
    const struct {
        uint64_t least, most;
        uint32_t *out;
    } number[] = {[SAMPLES] = {16, 65536, &job.samples},
                  [HEIGHT] = {8, 4096, &job.height},
                  [THREADS] = {1, 256, &job.threads}};
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        uint64_t count;
        if (met == OUTPUT) {
            job.output = given.value;
        } else if (met == MU_OPTIONS_OPERAND) {
            if (job.image) return mu_refuse(&usage, "one image, but \"%s\" is a second", given.value);
            job.image = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else if (!mu_options_unsigned(&given, number[met].least, number[met].most, &count)) {
            return MU_EXIT_REFUSED;
        } else {
            *number[met].out = (uint32_t)count;
        }
    }
    if (!job.image || !job.output) return mu_refuse(&usage, "an image ENV and -o OUT.exr are needed");
    return answer(&job);
}
