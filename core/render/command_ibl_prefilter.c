/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_ibl_prefilter.c: `musurf ibl prefilter`, an environment for every roughness. */
#include <stdatomic.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "core/render/command_ibl.h"
#include "core/render/ibl_prefilter.h"
#include "core/render/inputs.h"
#include "core/render/json_out.h"
#include "core/render/options.h"
#include "core/render/output.h"

enum { OUTPUT, SAMPLES, HEIGHT, THREADS, PROGRESS };

static const mu_option options[] = {
    {"o", "OUT.exr", "the chain (needed)"},
    {"samples", "N", "directions per pixel, 16 to 65536 (default: 256)"},
    {"height", "N", "rows of level 0, 8 to 4096; no more than the image has (default: 512)"},
    {"threads", "N", "1 to 256 (default: one for each processor)"},
    {"progress", "auto|json|none", "auto: a bar if stderr is a terminal; json: a line of JSON twice a second"},
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

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

enum { AUTO, JSON, NONE };

typedef struct teller {
    double start;
    int how;
    atomic_llong last; /* when a line was written, in milliseconds from the start */
} teller;

/* From any thread: every line is one call of stdio, which locks. */
static void show(void *context, double fraction) {
    teller *t = context;
    const double seconds = now() - t->start, remaining = fraction > 0 ? seconds * (1 - fraction) / fraction : -1;
    const long long at = (long long)(1000 * seconds), step = t->how == JSON ? 500 : 100;
    long long last = atomic_load(&t->last);
    if (at - last < step || !atomic_compare_exchange_strong(&t->last, &last, at)) return;
    if (t->how == JSON) {
        fprintf(stderr, "{\"event\": \"progress\", \"fraction\": %.6f, \"seconds\": %.3f, \"remaining\": %.3f}\n", fraction, seconds, remaining);
        return;
    }
    char bar[41];
    for (int i = 0; i < 40; i++) bar[i] = i < (int)(40 * fraction) ? '#' : '.';
    bar[40] = 0;
    fprintf(stderr, "\r[%s] %3.0f %%  eta %.0f s\033[K", bar, 100 * fraction, remaining);
}

static void warn(void *context, const char *text) {
    const teller *t = context;
    if (t->how != JSON) {
        fprintf(stderr, "musurf: warning: %s\n", text);
        return;
    }
    mu_json json = {.text = NULL};
    mu_json_begin(&json);
    mu_json_string(&json, "event", "warning");
    mu_json_string(&json, "text", text);
    mu_json_write(&json, stderr);
    mu_json_free(&json);
}

static void tell_end(const teller *t, const mu_prefilter *job, _Bool kept) {
    const double seconds = now() - t->start;
    if (t->how == JSON) {
        mu_json json = {.text = NULL};
        mu_json_begin(&json);
        mu_json_string(&json, "event", kept ? "kept" : "done");
        mu_json_string(&json, "file", job->output);
        mu_json_number(&json, "samples", job->samples);
        mu_json_number(&json, "seconds", seconds);
        mu_json_write(&json, stderr);
        mu_json_free(&json);
    } else if (kept) {
        fprintf(stderr, "%s: is that of %s already\n", job->output, job->image);
    } else {
        fprintf(stderr, "%s: %u samples, %.2f s\n", job->output, job->samples, seconds);
    }
}

static int answer(mu_prefilter *job, int progress) {
    teller t = {.start = now(), .how = progress, .last = -1000};
    mu_error error = {.warn = warn, .context = &t};
    const _Bool bar = progress == AUTO && isatty(STDERR_FILENO);
    _Bool kept = 0;
    job->context = &t;
    if (bar || progress == JSON) job->progress = show;
    const _Bool good = mu_output_check(job->output, &error) && mu_input_keep(job->output, job->image, &error) &&
                       mu_prefilter_run(job, &kept, &error);
    if (bar) fputs("\r\033[K", stderr);
    if (!good) return mu_refuse(&usage, "%s", error.text);
    tell_end(&t, job, kept);
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
    static const char *const kinds[] = {"auto", "json", "none", NULL};
    int met, progress = AUTO;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        uint64_t count;
        if (met == OUTPUT) {
            job.output = given.value;
        } else if (met == PROGRESS) {
            if (!mu_options_choice(&given, kinds, &progress)) return MU_EXIT_REFUSED;
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
    if (!mu_output_ends_in(job.output, ".exr"))
        return mu_refuse(&usage, "-o is \"%s\"; it must be a name that ends in .exr", job.output);
    return answer(&job, progress);
}
