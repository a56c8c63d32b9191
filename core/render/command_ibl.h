/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_ibl.h: what the commands `musurf ibl ...` share: a lobe and a view, as a line of JSON asks for them. */
#ifndef MU_COMMAND_IBL_H
#define MU_COMMAND_IBL_H

#include "core/ibl/ibl.h"
#include "core/render/document.h"

int mu_command_ibl_albedo(int argc, char **argv);
int mu_command_ibl_axis(int argc, char **argv);
int mu_command_ibl_plot(int argc, char **argv);
int mu_command_ibl_prefilter(int argc, char **argv);

enum { MU_IBL_SAMPLES_MOST = 65536 };

typedef struct mu_ibl_question {
    mu_ibl_lobe_d lobe;
    double wo[3];
    mu_ibl_settings_d settings;
} mu_ibl_question;

_Bool mu_ibl_ask(const mu_place *place, mu_ibl_question *out, mu_error *error);

#endif
