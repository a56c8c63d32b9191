/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_report.h: the verdict on stdout, as a table or as JSON. */
#ifndef MU_CHECK_REPORT_H
#define MU_CHECK_REPORT_H

#include "core/render/check_run.h"

typedef struct mu_check_report {
    const mu_check_settings *settings;
    const mu_tally *tally;
    double significance; /* family-wise */
    double seconds;
    size_t given; /* materials of scenes */
} mu_check_report;

/* Number of laws that fail. */
size_t mu_check_failures(const mu_check_report *report);
void mu_check_print_table(const mu_check_report *report, FILE *out);
_Bool mu_check_print_json(const mu_check_report *report, FILE *out);

#endif
