/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_report.c: see check_report.h. */
#include "core/render/check_report.h"

#include <jansson.h>

#include "core/render/check_probability.h"

static double level(const mu_check_report *report) {
    return mu_sidak(report->significance, mu_tally_tests(report->tally));
}

static _Bool passes(const mu_check_report *report, mu_law law) {
    return mu_tally_passes(report->tally, law, level(report));
}

size_t mu_check_failures(const mu_check_report *report) {
    size_t failures = 0;
    for (mu_law law = 0; law < MU_LAW_COUNT; law++)
        if (report->tally->row[law].count && !passes(report, law)) failures++;
    return failures;
}

static const char *verdict(const mu_check_report *report, mu_law law) {
    if (!report->tally->row[law].count) return "not tested";
    return passes(report, law) ? "ok" : "FAILED";
}

static const char *precision(const mu_check_report *report) {
    return report->settings->precision == MUSURF_FLOAT ? "float" : "double";
}

static void print_row(const mu_check_report *report, mu_law law, FILE *out) {
    const mu_tally_row *row = &report->tally->row[law];
    fprintf(out, "%-52s %8zu ", mu_law_title(law), row->count);
    if (!row->count)
        fprintf(out, "%22s", "");
    else if (mu_law_is_statistical(law))
        fprintf(out, "p %9.2e  > %7.1e", row->worst, level(report));
    else
        fprintf(out, "%11.2e  < %7.1e", row->error, row->tolerance);
    fprintf(out, "  %s", verdict(report, law));
    if (row->unresolved) fprintf(out, ", %zu beyond reach", row->unresolved);
    fputc('\n', out);
}

void mu_check_print_table(const mu_check_report *report, FILE *out) {
    const mu_check_settings *s = report->settings;
    fprintf(out, "%zu random materials, %zu given; %s; seed %llu; %.1f s\n\n", s->materials, report->given,
            precision(report), (unsigned long long)s->seed, report->seconds);
    fprintf(out, "%-52s %8s  %9s  %9s  %s\n", "law", "tests", "worst", "tolerance", "verdict");
    _Bool unresolved = 0;
    for (mu_law law = 0; law < MU_LAW_COUNT; law++) {
        print_row(report, law, out);
        unresolved = unresolved || report->tally->row[law].unresolved;
    }
    fprintf(out, "\n%zu p-values; family-wise significance %g, so each must exceed %.2e (Sidak)\n",
            mu_tally_tests(report->tally), report->significance, level(report));
    fprintf(out, "\nworst cases (`musurf eval` takes these lines)\n");
    for (mu_law law = 0; law < MU_LAW_COUNT; law++)
        if (report->tally->row[law].count && (!mu_law_is_statistical(law) || !passes(report, law)))
            fprintf(out, "%s\n%s\n", mu_law_title(law), report->tally->row[law].where);
    if (unresolved)
        fprintf(out, "\nbeyond reach: rounding of the directions alone, or quadrature, leaves more doubt "
                     "than the test may; "
                     "the first of each\n");
    for (mu_law law = 0; law < MU_LAW_COUNT; law++)
        if (report->tally->row[law].unresolved)
            fprintf(out, "%s\n%s\n", mu_law_title(law), report->tally->row[law].unresolved_at);
    const size_t failures = mu_check_failures(report);
    if (failures)
        fprintf(out, "\n%zu laws FAILED\n", failures);
    else
        fprintf(out, "\nall laws hold\n");
}

/* A line for `musurf eval` is JSON itself; one that was cut for its length is given as text. */
static json_t *line(const char *text) {
    json_t *value = json_loads(text, 0, NULL);
    return value ? value : json_string(text);
}

_Bool mu_check_print_json(const mu_check_report *report, FILE *out) {
    const mu_check_settings *s = report->settings;
    const size_t failures = mu_check_failures(report);
    json_t *laws = json_array();
    for (mu_law law = 0; law < MU_LAW_COUNT; law++) {
        const mu_tally_row *row = &report->tally->row[law];
        json_t *entry = json_pack("{s:s, s:s, s:I, s:I, s:s}", "law", mu_law_name(law), "title",
                                  mu_law_title(law), "tests", (json_int_t)row->count, "beyond_reach",
                                  (json_int_t)row->unresolved, "verdict", verdict(report, law));
        if (row->count) {
            if (mu_law_is_statistical(law)) {
                json_object_set_new(entry, "p", json_real(row->worst));
                json_object_set_new(entry, "level", json_real(level(report)));
            } else { /* jansson makes NULL of numbers that are not finite, which sets nothing */
                json_object_set_new(entry, "error", json_real(row->error));
                json_object_set_new(entry, "tolerance", json_real(row->tolerance));
            }
            json_object_set_new(entry, "worst", line(row->where));
        }
        if (row->unresolved) json_object_set_new(entry, "first_beyond_reach", line(row->unresolved_at));
        json_array_append_new(laws, entry);
    }
    json_t *root =
        json_pack("{s:b, s:I, s:I, s:I, s:s, s:s, s:f, s:f, s:I, s:f, s:o}", "passed", failures == 0,
                  "failures", (json_int_t)failures, "random_materials", (json_int_t)s->materials,
                  "given_materials", (json_int_t)report->given, "precision", precision(report), "version",
                  MUSURF_VERSION, "significance", report->significance, "level", level(report), "p_values",
                  (json_int_t)mu_tally_tests(report->tally), "seconds", report->seconds, "laws", laws);
    if (root) json_object_set_new(root, "seed", json_integer((json_int_t)s->seed));
    const _Bool written = root && json_dumpf(root, out, JSON_REAL_PRECISION(17) | JSON_INDENT(1)) == 0;
    fputc('\n', out);
    json_decref(root);
    return written;
}
