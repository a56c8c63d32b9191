/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command.h: the subcommands of `musurf`. Each takes its own argv (argv[0] its name), returns an exit code (error.h);
 * results go to stdout, messages and progress to stderr. */
#ifndef MU_COMMAND_H
#define MU_COMMAND_H

int mu_command_eval(int argc, char **argv);
int mu_command_sample(int argc, char **argv);
int mu_command_wedge(int argc, char **argv);
int mu_command_check(int argc, char **argv);
int mu_command_render(int argc, char **argv);
int mu_command_surface(int argc, char **argv);
int mu_command_tension(int argc, char **argv);
int mu_command_ibl(int argc, char **argv);
int mu_command_info(int argc, char **argv);

#endif
