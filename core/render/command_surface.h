/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface.h: what the commands `musurf surface ...` share. */
#ifndef MU_COMMAND_SURFACE_H
#define MU_COMMAND_SURFACE_H

#include <stddef.h>

#include "core/render/options.h"

int mu_command_surface_boxes(int argc, char **argv);
int mu_command_surface_make(int argc, char **argv);
int mu_command_surface_measure(int argc, char **argv);
int mu_command_surface_mesh(int argc, char **argv);
int mu_command_surface_read(int argc, char **argv);
int mu_command_surface_soup(int argc, char **argv);
int mu_command_surface_statistics(int argc, char **argv);
int mu_command_surface_fit(int argc, char **argv);

/* The value of the option just met as `least` to `most` finite numbers, commas between; how many, or 0 after a line on
 * stderr. */
size_t mu_options_numbers(const mu_options *options, size_t least, size_t most, double *out);
/* M of --transform, row by row; views of --view, from above, brought to a largest component of 1/2 ... 1 by a power of two,
 * which rounds nothing. False after a line on stderr. */
_Bool mu_options_transform(const mu_options *options, double m[4]);
_Bool mu_options_view(const mu_options *options, double w[3]);
/* Takes in one option of a command's own; false after a line on stderr. `asked` is the command's. */
typedef _Bool mu_option_reader(void *asked, const mu_options *at, int met);
/* The options of a command and its one heightfield FILE, which it needs. True to go on; else *code is what to exit with. */
_Bool mu_surface_options(const mu_usage *usage, int argc, char **argv, mu_option_reader *read, void *asked,
                         const char **file, int *code);
/* "musurf surface ..." as it was called, for files' headers. */
void mu_options_command(int argc, char **argv, size_t size, char *out);

#endif
