/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_render.c: `musurf render`: scene in, image out, and what happens when it is interrupted.
 *
 * Everything that can be refused is refused before the first ray: options, places of the outputs, scene,
 * memory, checkpoint.
 */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "core/render/command.h"
#include "core/render/explain.h"
#include "core/render/image.h"
#include "core/render/image_light.h"
#include "core/render/inputs.h"
#include "core/render/output.h"
#include "core/render/render_progress.h"
#include "core/render/render_scene.h"
#include "core/render/scene_digest.h"

/* -------------------------------------------------------------------------------------------------- signals
 */

/* When the first signal came, in tenths of a second of steady time; 0: none yet. */
static volatile sig_atomic_t interrupted;
/* There may be something to save. Before, while files are read and light is prepared, a signal quits at once. */
static volatile sig_atomic_t rendering;

/* A second signal quits at once, but not one that follows on the heels of the first: timeout(1) and terminals
 * with process groups send the same one twice. */
static void interrupt(int number) {
    struct timespec t;
    (void)number;
    clock_gettime(CLOCK_MONOTONIC, &t);
    const int tenths = (int)((t.tv_sec * 10 + t.tv_nsec / 100000000) % 1000000000) + 1;
    if (!rendering) _exit(MU_EXIT_INTERRUPTED);
    if (!interrupted)
        interrupted = tenths;
    else if (tenths - interrupted > 3)
        _exit(MU_EXIT_INTERRUPTED);
}

/* SIGINT and SIGTERM always, also where a shell script's `&` had made them ignored; SIGHUP not under nohup. A
 * limit on the size of files shall be an error of the write, not a death. */
static void catch_signals(void) {
    struct sigaction action = {.sa_handler = interrupt}, old;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (!sigaction(SIGHUP, NULL, &old) && old.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
    signal(SIGXFSZ, SIG_IGN);
}

/* ------------------------------------------------------------------------------------------------------ job
 */

typedef struct mu_job {
    mu_render_options options;
    mu_scene scene;
    mu_geometry *geometry;
    mu_lights *lights;
    mu_film film;
    mu_progress progress;
    char *partial, *resume; /* OUT.partial.exr, OUT.resume */
    char *command;          /* as it goes into the header */
    uint64_t digest;
    _Bool digested, warned;
} mu_job;

/* An error whose warnings go where this render speaks. */
static mu_error new_error(mu_job *job) {
    return (mu_error){.warn = mu_progress_warn, .context = &job->progress};
}

static int complain(mu_job *job, const mu_error *error, int code) {
    mu_progress_clear(&job->progress);
    mu_refuse(&mu_render_usage, "%s", error->text);
    return code;
}

/* OUT.exr with another ending. */
static char *with_ending(const char *output, const char *ending) {
    const size_t stem = strlen(output) - strlen(".exr"), length = strlen(ending);
    char *file = malloc(stem + length + 1);
    if (!file) return NULL;
    memcpy(file, output, stem);
    memcpy(file + stem, ending, length + 1);
    return file;
}

/* The command line so that a shell would read it back: whatever is not plain stands in single quotes. */
static char *command_line(int argc, char **argv) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    size_t room = sizeof "musurf";
    for (int i = 0; i < argc; ++i) room += 4 * strlen(argv[i]) + 3;
    char *text = malloc(room), *to = text;
    if (!text) return NULL;
    to += sprintf(to, "musurf");
    for (int i = 0; i < argc; ++i) {
        const _Bool quoted = !argv[i][0] || argv[i][strspn(argv[i], plain)];
        *to++ = ' ';
        if (quoted) *to++ = '\'';
        for (const char *from = argv[i]; *from; ++from)
            if (*from == '\'')
                to += sprintf(to, "'\\''");
            else
                *to++ = *from;
        if (quoted) *to++ = '\'';
    }
    *to = '\0';
    return text;
}

static uint64_t digest(mu_job *job) {
    if (!job->digested) job->digest = mu_scene_digest(&job->scene, job->scene.integrator.seed);
    job->digested = 1;
    return job->digest;
}

static mu_image_info info(const mu_job *job) {
    uint32_t least, most;
    mu_film_samples(&job->film, &least, &most);
    return (mu_image_info){.scene_file = job->options.scene,
                           .scene_text = job->scene.text,
                           .command = job->command,
                           .version = MUSURF_VERSION,
                           .seed = job->scene.integrator.seed,
                           .samples = least,
                           .seconds = job->film.seconds,
                           .camera = job->scene.camera};
}

/* ------------------------------------------------------------------------------------------------ rendering
 */

/* Asked from the first sample on. */
static _Bool stop(void *job) {
    (void)job;
    rendering = 1;
    return interrupted != 0;
}

static void prepare(void *job, uint32_t done, uint32_t count) {
    mu_progress_prepare(&((mu_job *)job)->progress, done, count);
}

static void report(void *job, const mu_render_status *status) {
    mu_progress_report(&((mu_job *)job)->progress, status);
}

/* A checkpoint that cannot be saved is worth a word, not the render. */
static void checkpoint(void *context, const mu_film *film) {
    mu_job *job = context;
    mu_error error = new_error(job);
    if (mu_film_save(film, job->resume, digest(job), &error) || job->warned) return;
    job->warned = 1;
    mu_progress_note(&job->progress, "no checkpoint: %s", error.text);
}

static _Bool load_checkpoint(mu_job *job, uint32_t limit, mu_error *error) {
    uint32_t least, most;
    if (!job->options.resume) {
        if (!access(job->resume, F_OK))
            mu_progress_note(&job->progress,
                             "%s is left over from a render of this output; --resume would go on from it",
                             job->resume);
        return 1;
    }
    if (access(job->resume, F_OK)) {
        mu_progress_note(&job->progress, "there is no %s to go on from; starting from nothing", job->resume);
        return 1;
    }
    if (!mu_film_load(&job->film, job->resume, digest(job), error)) return 0;
    mu_film_samples(&job->film, &least, &most);
    if (most > limit)
        return mu_fail(error, "%s: has %u samples per pixel already, more than the %u asked for", job->resume,
                       most, limit);
    mu_progress_note(&job->progress, "going on from %u samples per pixel", least);
    return 1;
}

/* What is there when the render stops early. */
static int give_partial(mu_job *job) {
    uint32_t least, most;
    mu_error error = new_error(job);
    const mu_image_info head = info(job);
    mu_film_samples(&job->film, &least, &most);
    if (!most) {
        mu_progress_end(&job->progress, "interrupted", NULL, &job->film);
        return MU_EXIT_INTERRUPTED;
    }
    const _Bool image = mu_image_write_exr(job->partial, &job->film, &job->scene.film, &head, &error);
    const _Bool sums = mu_film_save(&job->film, job->resume, digest(job), &error);
    if (!image || !sums) complain(job, &error, 0);
    if (sums) mu_progress_note(&job->progress, "interrupted; --resume goes on from %s", job->resume);
    mu_progress_end(&job->progress, "interrupted", image ? job->partial : NULL, &job->film);
    return MU_EXIT_INTERRUPTED;
}

static int give_image(mu_job *job) {
    mu_error error = new_error(job), other = new_error(job);
    const mu_image_info head = info(job);
    if (!mu_image_write_exr(job->options.output, &job->film, &job->scene.film, &head, &error)) {
        complain(job, &error, 0);
        if (mu_film_save(&job->film, job->resume, digest(job), &other))
            mu_progress_note(&job->progress, "the samples are kept; --resume writes the image from %s",
                             job->resume);
        return MU_EXIT_FAILED;
    }
    const _Bool preview = !job->options.png ||
                          mu_image_write_png(job->options.png, &job->film, &job->scene.film, &head, &error);
    unlink(job->partial);
    unlink(job->resume);
    mu_progress_end(&job->progress, "done", job->options.output, &job->film);
    return preview ? MU_EXIT_OK : complain(job, &error, MU_EXIT_FAILED);
}

static int render(mu_job *job, uint32_t limit) {
    const mu_render_options *options = &job->options;
    mu_error error = new_error(job);
    const mu_render_plan limits = {.threads = options->threads,
                                   .samples = limit,
                                   .seconds = options->seconds,
                                   .noise = options->noise};
    const mu_render_watch watch = {
        .context = job, .prepare = prepare, .stop = stop, .report = report, .checkpoint = checkpoint, .checkpoint_seconds = 60};
    switch (mu_render_scene(&job->film, &job->scene, job->geometry, job->lights, &limits, &watch, &error)) {
    case MU_RENDER_DONE:
        return give_image(job);
    case MU_RENDER_STOPPED:
        return give_partial(job);
    default:
        return complain(job, &error, MU_EXIT_FAILED);
    }
}

/* The names of the files, and whether they can be written. */
static int name_files(mu_job *job, int argc, char **argv) {
    const mu_render_options *options = &job->options;
    mu_error error = new_error(job);
    job->partial = with_ending(options->output, ".partial.exr");
    job->resume = with_ending(options->output, ".resume");
    job->command = command_line(argc, argv);
    if (!job->partial || !job->resume || !job->command) {
        mu_fail(&error, "not enough memory");
        return complain(job, &error, MU_EXIT_FAILED);
    }
    const _Bool writable =
        mu_output_check(options->output, &error) && (!options->png || mu_output_check(options->png, &error));
    return writable ? MU_EXIT_OK : complain(job, &error, MU_EXIT_REFUSED);
}

/* No output may replace, and none that is removed in the end be, what the scene is made of. */
static _Bool keep_inputs(const mu_job *job, mu_error *error) {
    const char *const outputs[] = {job->options.output, job->options.png, job->partial, job->resume};
    const size_t count = sizeof outputs / sizeof *outputs;
    const mu_scene *scene = &job->scene;
    mu_document document;
    for (size_t i = 0; i < count; ++i)
        for (uint32_t k = 0; k < scene->mesh_count; ++k) /* of sequences the file that the frame stands for */
            if (mu_is_same_file(outputs[i], scene->meshes[k].file))
                return mu_fail(error, "%s: would replace %s, of which the scene is made", outputs[i],
                               scene->meshes[k].file);
    if (!mu_document_parse(&document, job->options.scene, scene->text, strlen(scene->text), 1, error)) return 0;
    const _Bool good = mu_inputs_keep(&document, outputs, count, error);
    mu_document_free(&document);
    return good;
}

/* The scene with what the command line changes about it. */
static _Bool read_scene(mu_job *job, mu_error *error) {
    const mu_render_options *options = &job->options;
    const mu_moment moment = {options->frame, options->pose_time};
    if (!mu_scene_read_at(&job->scene, options->scene, &moment, error)) return 0;
    if (options->width) {
        job->scene.film.width = options->width;
        job->scene.film.height = options->height;
    }
    if (options->integrator >= 0) mu_integrator_choose(&job->scene.integrator, (size_t)options->integrator);
    if (options->reads) job->scene.integrator.reads = options->reads == MU_READS_AUTO ? 0 : (uint32_t)options->reads;
    if (options->seed_given) job->scene.integrator.seed = options->seed;
    return 1;
}

static int run(mu_job *job, int argc, char **argv) {
    const mu_render_options *options = &job->options;
    mu_error error = new_error(job);
    const int named = options->output ? name_files(job, argc, argv) : MU_EXIT_OK;
    if (named != MU_EXIT_OK) return named;
    if (!read_scene(job, &error) ||
        (options->output && !(keep_inputs(job, &error) && mu_image_light_takes(&job->scene, &error))))
        return complain(job, &error, MU_EXIT_REFUSED);

    const uint32_t limit = options->samples                             ? (uint32_t)options->samples
                           : options->seconds > 0 || options->noise > 0 ? MU_MOST_SAMPLES
                                                                        : job->scene.integrator.samples;
    const mu_film_settings *film = &job->scene.film;
    if (options->output && (!mu_film_make(&job->film, film->width, film->height, &error) ||
                            !load_checkpoint(job, limit, &error)))
        return complain(job, &error, MU_EXIT_REFUSED);
    job->geometry = mu_geometry_build(&job->scene, options->threads, &error);
    if (job->geometry) job->lights = mu_lights_build(&job->scene, &error);
    if (!job->lights) return complain(job, &error, MU_EXIT_REFUSED);
    if (options->explain && !mu_explain(&job->scene, job->lights, stdout, &error))
        return complain(job, &error, MU_EXIT_FAILED);
    return options->output ? render(job, limit) : MU_EXIT_OK;
}

int mu_command_render(int argc, char **argv) {
    mu_job job = {.geometry = NULL};
    int code;
    if (!mu_render_options_read(&job.options, argc, argv, &code)) return code;
    job.progress = mu_progress_begin(&job.options);
    catch_signals();
    code = run(&job, argc, argv);
    mu_lights_free(job.lights);
    mu_geometry_free(job.geometry);
    mu_scene_free(&job.scene);
    mu_film_free(&job.film);
    free(job.partial);
    free(job.resume);
    free(job.command);
    return code;
}
