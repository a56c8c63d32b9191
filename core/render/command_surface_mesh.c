/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface_mesh.c: `musurf surface mesh`, the baked triangles of a heightfield as a file. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/render/command_surface.h"
#include "core/render/json_out.h"
#include "core/render/output_stream.h"
#include "core/render/surface_mesh.h"
#include "core/render/surface_source.h"

enum { TRANSFORM, TILES, FORMAT, OUTPUT, SOURCE, MOST_TILES = 1024 };

static const mu_option options[] = {
    {"transform", "A,C,B,D", "M = [a c; b d], row by row (default: 1,0,0,1)"},
    {"tiles", "K", "K further periods on each side, (2K+1)^2 in all, 0 to 1024 (default: 0)"},
    {"format", "pov|ply|obj", "format (default: by the ending of the output's name)"},
    {"o", "FILE", "the mesh file; written beside and renamed when it is whole"},
    MU_SURFACE_SOURCE_OPTIONS,
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "surface mesh", "FILE [--transform A,C,B,D] [--tiles K] [--format pov|ply|obj] -o FILE",
    "Writes the triangles of a heightfield, vertices moved by M: (M (i, j), height).\n", options,
    MU_SURFACE_SOURCE_HELP
    "Each cell splits along (i+1,j)-(i,j+1) into L = (i,j),(i+1,j),(i,j+1) and U = "
    "(i+1,j+1),(i,j+1),(i+1,j); L comes\n"
    "first, cells follow scanline by scanline. Corners run counter-clockwise seen from above, under a "
    "mirror, too.\n"
    "Numbers come back as the same doubles. Heights are in cells.\n"
    "  pov   mesh2 of one period, for #include inside object { }; K > 0: a union of it and its translated "
    "copies\n"
    "  ply   binary little-endian, double vertices, all periods\n"
    "  obj   text, all periods\n"
    "out, one line of JSON: \"file\", \"format\", \"vertices\", \"triangles\" (of all periods)\n"};

typedef struct mu_asked {
    mu_surface_mesh mesh;
    mu_surface_source source;
    const char *output;
    int format; /* -1: by the ending */
} mu_asked;

static _Bool read_option(void *to, const mu_options *at, int met) {
    mu_asked *asked = to;
    uint64_t number = 0;
    if (met >= SOURCE) return mu_surface_source_option(&asked->source, at, met - SOURCE);
    switch (met) {
    case TRANSFORM:
        return mu_options_transform(at, asked->mesh.m);
    case TILES:
        if (!mu_options_unsigned(at, 0, MOST_TILES, &number)) return 0;
        asked->mesh.tiles = (uint32_t)number;
        return 1;
    case FORMAT:
        return mu_options_choice(at, mu_mesh_formats(), &asked->format);
    default:
        asked->output = at->value;
        return 1;
    }
}

static _Bool choose_format(mu_asked *asked) {
    const char *const ending = strrchr(asked->output, '.');
    for (int k = 0; asked->format < 0 && ending && mu_mesh_formats()[k]; k++)
        if (!strcmp(ending + 1, mu_mesh_formats()[k])) asked->format = k;
    if (asked->format < 0 && ending && !strcmp(ending, ".inc")) asked->format = MU_MESH_POV;
    if (asked->format < 0)
        return mu_refuse(&usage, "%s: no ending that names a format; --format pov, ply or obj is needed",
                         asked->output),
               0;
    asked->mesh.format = (mu_mesh_format)asked->format;
    return 1;
}

static void show(void *context, uint64_t done, uint64_t all) {
    (void)context;
    if (done % 16 == 0) fprintf(stderr, "\r%3.0f %%\033[K", 100.0 * (double)done / (double)all);
}

static _Bool write_mesh(mu_asked *asked, mu_error *error) {
    const uint64_t vertices = mu_surface_mesh_vertices(&asked->mesh);
    if (asked->mesh.format != MU_MESH_POV && vertices > INT32_MAX)
        return mu_fail(error, "%s: %llu vertices are more than its format can number (2^31 - 1)",
                       asked->output, (unsigned long long)vertices);
    if (asked->mesh.open && asked->mesh.tiles)
        return mu_fail(error, "--tiles: a surface with --border crop does not repeat");
    mu_output_stream stream;
    if (!mu_output_stream_open(&stream, asked->output, error)) return 0;
    const _Bool terminal = isatty(STDERR_FILENO);
    if (terminal) asked->mesh.progress = show;
    mu_surface_mesh_write(&asked->mesh, stream.file);
    if (terminal) fprintf(stderr, "\r\033[K");
    return mu_output_stream_commit(&stream, error);
}

static int report(const mu_asked *asked) {
    mu_json json = {0};
    mu_json_begin(&json);
    mu_json_string(&json, "file", asked->output);
    mu_json_string(&json, "format", mu_mesh_formats()[asked->mesh.format]);
    mu_json_number(&json, "vertices", (double)mu_surface_mesh_vertices(&asked->mesh));
    mu_json_number(&json, "triangles", (double)mu_surface_mesh_triangles(&asked->mesh));
    errno = 0;
    const _Bool good = mu_json_write(&json, stdout);
    if (!good) fprintf(stderr, "musurf surface mesh: standard output: %s\n", strerror(errno));
    mu_json_free(&json);
    return good ? MU_EXIT_OK : MU_EXIT_FAILED;
}

int mu_command_surface_mesh(int argc, char **argv) {
    mu_asked asked = {.source = mu_surface_source_begin(), .mesh = {.m = {1, 0, 0, 1}}, .format = -1};
    int code;
    if (!mu_surface_options(&usage, argc, argv, read_option, &asked, &asked.source.file, &code)) return code;
    if (!asked.output) return mu_refuse(&usage, "-o FILE is needed");
    mu_error error = {.text = ""};
    if (!choose_format(&asked)) return MU_EXIT_REFUSED;
    if (!mu_output_check(asked.output, &error)) return mu_refuse(&usage, "%s", error.text);
    mu_surface surface;
    if (!mu_surface_read(&asked.source, &surface, &error)) return mu_refuse(&usage, "%s", error.text);
    asked.mesh.f = surface.f, asked.mesh.open = surface.open;
    const _Bool good = write_mesh(&asked, &error);
    mu_surface_free(&surface);
    return good ? report(&asked) : mu_refuse(&usage, "%s", error.text);
}
