/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface.c: `musurf surface ...`, explicit microsurfaces. */
#include "core/render/command_surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/command.h"
#include "core/render/error.h"
#include "core/render/subcommand.h"

static const mu_option no_options[] = {{NULL, NULL, NULL}};
static const mu_usage usage = {
    "surface", "boxes|fit|make|measure|mesh|read|soup|statistics ...",
    "Explicit microsurfaces: periodic heightfields that follow a distribution, and what is seen of them.\n",
    no_options,
    "  boxes       the exact visibility of square waves and boxes; see musurf surface boxes --help\n"
    "  fit         the distribution and the map M that explain it best; see musurf surface fit --help\n"
    "  make        a heightfield with the slopes of a distribution; see musurf surface make --help\n"
    "  measure     facets facing, visible, G1 and G2 under a linear map; see musurf surface measure --help\n"
    "  mesh        its triangles under a linear map as a POV-Ray, PLY or OBJ file; see musurf surface mesh "
    "--help\n"
    "  read        anybody's heightfield, brought into the form that make writes; see musurf surface read "
    "--help\n"
    "  soup        the exact visibility of triangles from a file; see musurf surface soup --help\n"
    "  statistics  slopes, normals, masking, visible normals, reflections; see musurf surface statistics "
    "--help\n"
    "\n"
    "A heightfield that musurf makes is a one-channel float EXR, nx scanlines of ny pixels, periodic, cell "
    "size 1:\n"
    "scanline i is x, pixel j in it is y. Others are read, too; see musurf surface measure --help. Each cell "
    "splits\n"
    "along (i+1,j)-(i,j+1) into L = (i,j),(i+1,j),(i,j+1) and U = (i+1,j+1),(i,j+1),(i+1,j).\n"};

size_t mu_options_numbers(const mu_options *options, size_t least, size_t most, double *out) {
    const char *at = options->value;
    size_t count = 0;
    for (;;) {
        char *end;
        const double value = strtod(at, &end);
        const _Bool spaced = *at == ' ' || *at == '\t' || *at == '\n';
        if (end == at || spaced || !isfinite(value) || count == most) break;
        out[count++] = value;
        if (!*end && count >= least) return count;
        if (*end != ',') break;
        at = end + 1;
    }
    if (least == 1 && most == 1)
        mu_refuse(options->usage, "--%s is \"%s\"; a number is needed", options->name, options->value);
    else if (least == most)
        mu_refuse(options->usage, "--%s is \"%s\"; %zu numbers with commas between are needed", options->name,
                  options->value, least);
    else
        mu_refuse(options->usage, "--%s is \"%s\"; %zu to %zu numbers with commas between are needed",
                  options->name, options->value, least, most);
    return 0;
}

_Bool mu_options_transform(const mu_options *options, double m[4]) {
    if (!mu_options_numbers(options, 4, 4, m)) return 0;
    const double det = m[0] * m[3] - m[1] * m[2];
    const double size = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3];
    if (isfinite(size) && fabs(det) > 1e-14 * size) return 1; /* condition below 1e14: half an ulp is seen */
    mu_refuse(options->usage, "--%s is \"%s\", which is singular", options->name, options->value);
    return 0;
}

_Bool mu_options_view(const mu_options *options, double w[3]) {
    if (!mu_options_numbers(options, 3, 3, w)) return 0;
    const char *const name = options->name, *const value = options->value;
    if (!(w[2] > 0))
        return mu_refuse(options->usage, "--%s is \"%s\"; it must look from above, z > 0", name, value), 0;
    int exponent;
    frexp(fmax(fabs(w[0]), fmax(fabs(w[1]), w[2])), &exponent);
    for (int k = 0; k < 3; k++) w[k] = ldexp(w[k], -exponent);
    return w[2] > 0 ||
           (mu_refuse(options->usage, "--%s is \"%s\", which is all but horizontal", name, value), 0);
}

_Bool mu_surface_options(const mu_usage *of, int argc, char **argv, mu_option_reader *read, void *asked,
                         const char **file, int *code) {
    int met;
    mu_options given = mu_options_begin(of, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) {
            if (*file) return *code = mu_refuse(of, "one FILE, but \"%s\" is a second", given.value), 0;
            *file = given.value;
        } else if (met < 0) {
            return *code = mu_options_exit(met), 0;
        } else if (!read(asked, &given, met)) {
            return *code = MU_EXIT_REFUSED, 0;
        }
    }
    if (!*file) return *code = mu_refuse(of, "a heightfield FILE is needed"), 0;
    return 1;
}

void mu_options_command(int argc, char **argv, size_t size, char *out) {
    snprintf(out, size, "musurf surface");
    for (int k = 0; k < argc; k++) {
        const size_t length = strlen(out);
        snprintf(out + length, size - length, " %s", argv[k]);
    }
}

int mu_command_surface(int argc, char **argv) {
    static const mu_subcommand list[] = {{"boxes", mu_command_surface_boxes},
                                         {"fit", mu_command_surface_fit},
                                         {"make", mu_command_surface_make},
                                         {"measure", mu_command_surface_measure},
                                         {"mesh", mu_command_surface_mesh},
                                         {"read", mu_command_surface_read},
                                         {"soup", mu_command_surface_soup},
                                         {"statistics", mu_command_surface_statistics},
                                         {NULL, NULL}};
    return mu_run_subcommand(&usage, list, argc, argv);
}
