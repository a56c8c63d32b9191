/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_wedge.c: `musurf wedge`: one scene many times, each time with other values, on a contact sheet.
 *
 * All cells use the scene's seed, so that what differs between them is the value and not the noise.
 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/render/command.h"
#include "core/render/contact_sheet.h"
#include "core/render/image.h"
#include "core/render/image_light.h"
#include "core/render/inputs.h"
#include "core/render/output.h"
#include "core/render/render_progress.h"
#include "core/render/render_scene.h"
#include "core/render/vary.h"

enum { VARY, OUTPUT, PNG, CELLS, COLUMNS, SPP, SIZE, SEED, THREADS, PROGRESS, QUIET };

static const mu_option options[] = {
    {"vary", "NAME=V:V,...", "what varies, and the values it takes; may be repeated"},
    {"o", "SHEET.exr", "the sheet as an EXR image, linear"},
    {"png", "SHEET.png", "the sheet as an 8-bit sRGB preview"},
    {"cells", "FOLDER", "each cell as an EXR image of its own, numbered in the sheet's order"},
    {"columns", "N", "cells in a row (default: the values of the first name; of one alone: about a square)"},
    {"spp", "N", "samples per pixel (default: the scene's)"},
    {"size", "WxH", "pixels of a cell, instead of the scene's"},
    {"seed", "S", "seed of the random numbers of all cells (default: the scene's)"},
    {"threads", "N", "threads (default: one per processor); the images do not depend on it"},
    {"progress", "auto|json|none", "auto: a bar if stderr is a terminal; json: a line of JSON twice a second"},
    {"quiet", NULL, "nothing on stderr but errors"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "wedge", "SCENE --vary NAME=V:V,NAME=V:V -o SHEET.exr --png SHEET.png [OPTIONS]",
    "Renders a scene once for each combination of values, on a contact sheet whose captions tell them. The first\n"
    "name varies along a row, the second from row to row, a third from block of rows to block of rows.\n",
    options,
    "NAME    a key of the scene's material where only one is or only one gives that key: alpha; MATERIAL.KEY of a\n"
    "        named one: metal.alpha; or $. and a path in the file: $.lights[0].rotation\n"
    "V       a number, JSON ([[1,0],[0,2]]), or a word (beckmann); A..B/N: N numbers from A to B\n"
    "\n"
    "examples:\n"
    "  musurf wedge scenes/first.json --vary gold.alpha=.05:.1:.2:.4,gamma=1:2:3.5 --png sheet.png\n"
    "  musurf wedge scenes/first.json --vary 'gold.stretch=0..0.9/10' --columns 5 -o sheet.exr --cells cells\n"};

typedef struct mu_wedge {
    mu_render_options render; /* of these: scene, output, png, samples, threads, size, seed, quiet, progress */
    mu_variations variations;
    const char *cells;
    uint64_t columns;
    size_t count;
    mu_document document;
    mu_contact_sheet sheet;
    mu_progress progress;
    size_t done; /* cells */
    double seconds;
} mu_wedge;

static volatile sig_atomic_t interrupted;

static void interrupt(int number) {
    (void)number;
    interrupted = 1;
}

static _Bool stop(void *wedge) {
    (void)wedge;
    return interrupted != 0;
}

/* A cell's progress as that of the whole. */
static void report(void *context, const mu_render_status *status) {
    mu_wedge *wedge = context;
    mu_render_status whole = *status;
    whole.seconds += wedge->seconds;
    whole.fraction = ((double)wedge->done + status->fraction) / (double)wedge->count;
    whole.remaining = whole.fraction > 0 ? whole.seconds * (1 / whole.fraction - 1) : -1;
    mu_progress_report(&wedge->progress, &whole);
}

/* Which value of each name the cell takes: the first name varies fastest. */
static void choose(const mu_wedge *wedge, size_t cell, size_t which[MU_VARY_MOST]) {
    for (size_t i = 0; i < wedge->variations.count; ++i) {
        const size_t values = json_array_size(wedge->variations.of[i].values);
        which[i] = cell % values;
        cell /= values;
    }
}

static _Bool read_cell(mu_wedge *wedge, const size_t *which, mu_scene *scene, mu_error *error) {
    const mu_render_options *render = &wedge->render;
    if (!mu_vary_apply(&wedge->variations, which, &wedge->document, error) ||
        !mu_scene_from(scene, &wedge->document, error))
        return 0;
    if (render->width) scene->film.width = render->width, scene->film.height = render->height;
    if (render->seed_given) scene->integrator.seed = render->seed;
    return 1;
}

/* "alpha 0.25", one after another. */
static void describe(const mu_wedge *wedge, const size_t *which, const char *between, char *out, size_t size) {
    out[0] = '\0';
    for (size_t i = 0; i < wedge->variations.count; ++i) {
        const size_t length = strlen(out);
        char caption[128];
        mu_vary_caption(&wedge->variations.of[i], which[i], caption, sizeof caption);
        snprintf(out + length, size - length, "%s%s", i ? between : "", caption);
    }
}

/* To be freed; NULL: no memory. */
static char *cell_file(const mu_wedge *wedge, size_t cell) {
    const size_t room = strlen(wedge->cells) + 32;
    char *const file = malloc(room);
    if (file) snprintf(file, room, "%s/%04zu.exr", wedge->cells, cell + 1);
    return file;
}

static _Bool write_cell(const mu_wedge *wedge, size_t cell, const size_t *which, const mu_scene *scene,
                        const mu_film *film, mu_error *error) {
    char values[512];
    describe(wedge, which, ", ", values, sizeof values);
    char *const file = cell_file(wedge, cell);
    if (!file) return mu_fail(error, "out of memory");
    uint32_t least, most;
    mu_film_samples(film, &least, &most);
    const mu_image_info head = {.scene_file = wedge->render.scene,
                                .scene_text = scene->text,
                                .command = values,
                                .version = MUSURF_VERSION,
                                .seed = scene->integrator.seed,
                                .samples = least,
                                .seconds = film->seconds,
                                .camera = scene->camera};
    const _Bool good = mu_image_write_exr(file, film, &scene->film, &head, error);
    free(file);
    return good;
}

static mu_render_end trace(mu_wedge *wedge, const mu_scene *scene, mu_film *film, mu_error *error) {
    const mu_render_plan limits = {
        .threads = wedge->render.threads,
        .samples = wedge->render.samples ? (uint32_t)wedge->render.samples : scene->integrator.samples};
    const mu_render_watch watch = {.context = wedge, .stop = stop, .report = report};
    mu_geometry *const geometry = mu_geometry_build(scene, limits.threads, error);
    mu_lights *const lights = geometry ? mu_lights_build(scene, error) : NULL;
    const mu_render_end end = lights ? mu_render_scene(film, scene, geometry, lights, &limits, &watch, error)
                                     : MU_RENDER_FAILED;
    mu_lights_free(lights);
    mu_geometry_free(geometry);
    return end;
}

static uint32_t columns_of(const mu_wedge *wedge) {
    size_t columns = (size_t)wedge->columns;
    if (!columns) columns = json_array_size(wedge->variations.of[0].values);
    if (!wedge->columns && wedge->variations.count == 1)
        for (columns = 1; columns * columns < wedge->count;) ++columns;
    return (uint32_t)columns;
}

static void place(mu_wedge *wedge, size_t cell, const size_t *which, const mu_film *film) {
    const uint32_t column = (uint32_t)cell % wedge->sheet.columns, row = (uint32_t)cell / wedge->sheet.columns;
    char caption[256];
    mu_contact_sheet_place(&wedge->sheet, column, row, film);
    for (size_t i = 0; i < wedge->variations.count; ++i) {
        mu_vary_caption(&wedge->variations.of[i], which[i], caption, sizeof caption);
        mu_contact_sheet_write(&wedge->sheet, column, row, (uint32_t)i, caption);
    }
}

static mu_render_end render_cell(mu_wedge *wedge, size_t cell, mu_error *error) {
    size_t which[MU_VARY_MOST];
    mu_scene scene;
    mu_film film = {.width = 0};
    choose(wedge, cell, which);
    if (!read_cell(wedge, which, &scene, error)) return MU_RENDER_FAILED;
    mu_render_end end = MU_RENDER_FAILED;
    if (mu_film_make(&film, scene.film.width, scene.film.height, error))
        end = trace(wedge, &scene, &film, error);
    if (end == MU_RENDER_DONE) {
        place(wedge, cell, which, &film);
        if (wedge->cells && !write_cell(wedge, cell, which, &scene, &film, error)) end = MU_RENDER_FAILED;
        wedge->done = cell + 1;
        wedge->seconds += film.seconds;
    }
    mu_film_free(&film);
    mu_scene_free(&scene);
    return end;
}

static int complain(mu_wedge *wedge, const mu_error *error, int code) {
    mu_progress_clear(&wedge->progress);
    mu_refuse(&usage, "%s", error->text);
    return code;
}

/* Every cell is read before the first is rendered: an error in the last shall not cost the others. */
static _Bool try_all(mu_wedge *wedge, mu_error *error) {
    for (size_t cell = 0; cell < wedge->count; ++cell) {
        size_t which[MU_VARY_MOST];
        mu_scene scene;
        choose(wedge, cell, which);
        if (!read_cell(wedge, which, &scene, error)) return 0;
        const mu_film_settings film = scene.film;
        const _Bool taken = mu_image_light_takes(&scene, error);
        mu_scene_free(&scene);
        if (!taken) return 0;
        char *const file = wedge->cells ? cell_file(wedge, cell) : NULL;
        const char *const outputs[] = {wedge->render.output, wedge->render.png, file};
        const _Bool kept = mu_inputs_keep(&wedge->document, outputs, sizeof outputs / sizeof *outputs, error);
        free(file);
        if (!kept) return 0;
        if (cell && (film.width != wedge->sheet.cell_width || film.height != wedge->sheet.cell_height))
            return mu_fail(error, "cells of a sheet must have one size; --size gives it");
        if (!cell) {
            const uint32_t columns = columns_of(wedge);
            const uint32_t rows = ((uint32_t)wedge->count + columns - 1) / columns;
            if (!mu_contact_sheet_make(&wedge->sheet, columns, rows, film.width, film.height,
                                       (uint32_t)wedge->variations.count, film.exposure, error))
                return 0;
        }
    }
    return 1;
}

static _Bool check_outputs(const mu_wedge *wedge, mu_error *error) {
    const mu_render_options *render = &wedge->render;
    if ((render->output && !mu_output_check(render->output, error)) ||
        (render->png && !mu_output_check(render->png, error)))
        return 0;
    struct stat status;
    return !wedge->cells || !mkdir(wedge->cells, 0777) ||
           (!stat(wedge->cells, &status) && S_ISDIR(status.st_mode)) ||
           mu_fail(error, "%s: is no folder and cannot be made one", wedge->cells);
}

static _Bool write_sheet(mu_wedge *wedge, mu_error *error) {
    const mu_render_options *render = &wedge->render;
    mu_scene scene;
    size_t which[MU_VARY_MOST];
    choose(wedge, 0, which);
    if (!read_cell(wedge, which, &scene, error)) return 0;
    char command[2048] = "musurf wedge";
    for (size_t i = 0; i < wedge->variations.count; ++i) {
        const size_t length = strlen(command);
        snprintf(command + length, sizeof command - length, " %s", wedge->variations.of[i].name);
    }
    const mu_image_info head = {.scene_file = render->scene,
                                .scene_text = scene.text,
                                .command = command,
                                .version = MUSURF_VERSION,
                                .seed = scene.integrator.seed,
                                .samples = 1, /* what the least pixel of the sheet has */
                                .seconds = wedge->seconds,
                                .camera = scene.camera};
    const _Bool good =
        (!render->output || mu_image_write_exr(render->output, &wedge->sheet.film, &scene.film, &head, error)) &&
        (!render->png || mu_image_write_png(render->png, &wedge->sheet.film, &scene.film, &head, error));
    mu_scene_free(&scene);
    return good;
}

static int run(mu_wedge *wedge) {
    mu_error error = {.warn = mu_progress_warn, .context = &wedge->progress};
    wedge->count = 1;
    for (size_t i = 0; i < wedge->variations.count; ++i) {
        wedge->count *= json_array_size(wedge->variations.of[i].values);
        if (wedge->count > MU_VARY_VALUES)
            return mu_refuse(&usage, "these are more than %d cells", MU_VARY_VALUES);
    }
    if (!mu_document_read(&wedge->document, wedge->render.scene, &error) ||
        !mu_vary_bind(&wedge->variations, &wedge->document, &error) || !try_all(wedge, &error) ||
        !check_outputs(wedge, &error))
        return complain(wedge, &error, MU_EXIT_REFUSED);
    for (size_t cell = 0; cell < wedge->count; ++cell) {
        const mu_render_end end = render_cell(wedge, cell, &error);
        if (end == MU_RENDER_FAILED) return complain(wedge, &error, MU_EXIT_FAILED);
        if (end == MU_RENDER_STOPPED) {
            mu_progress_note(&wedge->progress, "interrupted after %zu of %zu cells", wedge->done, wedge->count);
            return MU_EXIT_INTERRUPTED;
        }
    }
    if (!write_sheet(wedge, &error)) return complain(wedge, &error, MU_EXIT_FAILED);
    const mu_film *film = &wedge->sheet.film;
    mu_progress_note(&wedge->progress, "%zu cells of %u x %u, a sheet of %u x %u, %.2f s", wedge->count,
                     wedge->sheet.cell_width, wedge->sheet.cell_height, film->width, film->height, wedge->seconds);
    return MU_EXIT_OK;
}

static _Bool take(mu_wedge *wedge, int met, const mu_options *given) {
    mu_render_options *render = &wedge->render;
    mu_error error = {.text = ""};
    uint64_t threads;
    switch (met) {
    case VARY:
        if (mu_vary_parse(&wedge->variations, given->value, &error)) return 1;
        mu_refuse(&usage, "--vary: %s", error.text);
        return 0;
    case OUTPUT:
        render->output = given->value;
        return 1;
    case PNG:
        render->png = given->value;
        return 1;
    case CELLS:
        wedge->cells = given->value;
        return 1;
    case COLUMNS:
        return mu_options_unsigned(given, 1, MU_VARY_VALUES, &wedge->columns);
    case SPP:
        return mu_options_unsigned(given, 1, MU_MOST_SAMPLES, &render->samples);
    case SIZE:
        return mu_render_size(given, &render->width, &render->height);
    case SEED:
        return render->seed_given = mu_options_unsigned(given, 0, UINT64_MAX, &render->seed);
    case THREADS:
        if (!mu_options_unsigned(given, 1, 1024, &threads)) return 0;
        render->threads = (uint32_t)threads;
        return 1;
    case PROGRESS:
        return mu_render_progress(given, render);
    case QUIET:
        return render->quiet = 1;
    default:
        if (render->scene) {
            mu_refuse(&usage, "one SCENE at a time, but \"%s\" is a second", given->value);
            return 0;
        }
        render->scene = given->value;
        return 1;
    }
}

static _Bool read_options(mu_wedge *wedge, int argc, char **argv, int *code) {
    mu_options given = mu_options_begin(&usage, argc, argv);
    int met;
    *code = MU_EXIT_REFUSED;
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met < 0 && met != MU_OPTIONS_OPERAND) {
            *code = mu_options_exit(met);
            return 0;
        }
        if (!take(wedge, met, &given)) return 0;
    }
    const mu_render_options *render = &wedge->render;
    if (!render->scene)
        mu_refuse(&usage, "which SCENE? See musurf wedge --help");
    else if (!wedge->variations.count)
        mu_refuse(&usage, "nothing varies; --vary alpha=.1:.2:.4 is an example");
    else if (!render->output && !render->png && !wedge->cells)
        mu_refuse(&usage, "no output is named; -o SHEET.exr, --png SHEET.png or --cells FOLDER is needed");
    else if (render->output && render->png && !strcmp(render->output, render->png))
        mu_refuse(&usage, "-o and --png are the same file");
    else if (render->output && !mu_output_ends_in(render->output, ".exr"))
        mu_refuse(&usage, "-o is \"%s\"; it must be a name that ends in .exr", render->output);
    else if (render->png && !mu_output_ends_in(render->png, ".png"))
        mu_refuse(&usage, "--png is \"%s\"; it must be a name that ends in .png", render->png);
    else
        return 1;
    return 0;
}

int mu_command_wedge(int argc, char **argv) {
    mu_wedge wedge = {.render = {.threads = mu_processors()}};
    int code;
    if (read_options(&wedge, argc, argv, &code)) {
        wedge.progress = mu_progress_begin(&wedge.render);
        wedge.progress.command = usage.command;
        struct sigaction action = {.sa_handler = interrupt, .sa_flags = SA_RESTART};
        sigaction(SIGINT, &action, NULL);
        sigaction(SIGTERM, &action, NULL);
        code = run(&wedge);
    }
    mu_contact_sheet_free(&wedge.sheet);
    mu_document_free(&wedge.document);
    mu_vary_free(&wedge.variations);
    return code;
}
