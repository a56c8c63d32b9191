/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * command_surface_read.c: `musurf surface read`, heightfields of others (surface_source.h) in the form that musurf writes
 * (surface_file.h), for programs that read that form only. Heights are rounded to float, relative 2^-24; what that moves
 * at most is told, in cells, and so is everything else that was done to them.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/render/command_surface.h"
#include "core/render/json_out.h"
#include "core/render/output.h"
#include "core/render/surface_file.h"
#include "core/render/surface_source.h"

enum { OUTPUT, SOURCE };

static const mu_option options[] = {
    {"o", "FILE", "the heightfield; written beside and renamed when it is whole"},
    MU_SURFACE_SOURCE_OPTIONS,
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "surface read", "FILE [options] -o FILE",
    "Brings a heightfield of any kind into the form that musurf surface make writes: one-channel float EXR, "
    "cell size 1.\n",
    options,
    MU_SURFACE_SOURCE_HELP
    "With crop the file holds the heights as they are, and commands that read it need --border crop again.\n"
    "out, one line of JSON:\n"
    "  \"file\", \"from\", \"pixels\"    written and read; scanlines and pixels in each of what was read\n"
    "  \"size\", \"repeats\"           cells along x and y of what was written; false with crop\n"
    "  \"border\", \"level\", \"plane\"  as asked for; what level subtracted: the mean height, slopes along "
    "x and y\n"
    "  \"cell\", \"height_scale\"      as asked for\n"
    "  \"filled\"                    holes that --fill closed\n"
    "  \"range\", \"rounded\"          of the heights, in cells; how far rounding to float moved one at "
    "most\n"};

typedef struct mu_asked {
    mu_surface_source source;
    const char *output;
} mu_asked;

static int report(const mu_asked *asked, const mu_surface *surface) {
    double low = INFINITY, high = -INFINITY, rounded = 0;
    for (size_t k = 0; k < mu_cells(&surface->f); k++) {
        const double h = surface->heights[k];
        low = fmin(low, h), high = fmax(high, h), rounded = fmax(rounded, fabs(h - (double)(float)h));
    }
    const uint32_t less = surface->open; /* vertices of an open surface are one more than its cells */
    const double pixels[] = {surface->pixels[0], surface->pixels[1]};
    const double size[] = {surface->f.nx - less, surface->f.ny - less};
    mu_json json = {0};
    mu_json_begin(&json);
    mu_json_string(&json, "file", asked->output);
    mu_json_string(&json, "from", asked->source.file);
    mu_json_numbers(&json, "pixels", pixels, 2);
    mu_json_numbers(&json, "size", size, 2);
    const char *const repeats = surface->open ? "false" : "true";
    mu_json_raw(&json, "repeats", repeats, strlen(repeats));
    mu_json_string(&json, "border", mu_border_names()[asked->source.border]);
    mu_json_string(&json, "level", mu_level_names()[asked->source.level]);
    mu_json_numbers(&json, "plane", surface->plane, 3);
    mu_json_number(&json, "cell", asked->source.cell);
    mu_json_number(&json, "height_scale", asked->source.height_scale);
    mu_json_number(&json, "filled", (double)surface->filled);
    mu_json_number(&json, "range", high - low);
    mu_json_number(&json, "rounded", rounded);
    errno = 0;
    const _Bool good = mu_json_write(&json, stdout);
    if (!good) fprintf(stderr, "musurf surface read: standard output: %s\n", strerror(errno));
    mu_json_free(&json);
    return good ? MU_EXIT_OK : MU_EXIT_FAILED;
}

/* Floats end at 3.4e38, and the reader lets 1e100 pass. */
static _Bool fits(const mu_surface *surface, const char *file, mu_error *error) {
    for (size_t k = 0; k < mu_cells(&surface->f); k++)
        if (!(fabs(surface->heights[k]) < 3e38))
            return mu_fail(error, "%s: has heights of %g cells, too large for a float", file,
                           surface->heights[k]);
    return 1;
}

static _Bool read_option(void *to, const mu_options *at, int met) {
    mu_asked *asked = to;
    if (met >= SOURCE) return mu_surface_source_option(&asked->source, at, met - SOURCE);
    asked->output = at->value;
    return 1;
}

int mu_command_surface_read(int argc, char **argv) {
    mu_asked asked = {.source = mu_surface_source_begin()};
    int code;
    if (!mu_surface_options(&usage, argc, argv, read_option, &asked, &asked.source.file, &code)) return code;
    if (!asked.output) return mu_refuse(&usage, "-o FILE is needed");
    mu_error error = {.text = ""};
    if (!mu_output_check(asked.output, &error)) return mu_refuse(&usage, "%s", error.text);
    mu_surface surface;
    if (!mu_surface_read(&asked.source, &surface, &error)) return mu_refuse(&usage, "%s", error.text);
    char command[1024];
    mu_options_command(argc, argv, sizeof command, command);
    const mu_surface_info info = {.command = command, .open = surface.open};
    const _Bool good = fits(&surface, asked.source.file, &error) &&
                       mu_surface_write(asked.output, &surface.f, &info, &error);
    code = good ? report(&asked, &surface) : mu_refuse(&usage, "%s", error.text);
    mu_surface_free(&surface);
    return code;
}
