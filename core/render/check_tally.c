/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_tally.c: keeping the worst; see check_tally.h. */
#include "core/render/check_tally.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name, *title;
    const char *kind;
} laws[MU_LAW_COUNT] = {
#define MU_LAW_ENTRY(name, title, kind) {#name, title, #kind},
    MU_LAWS(MU_LAW_ENTRY)
#undef MU_LAW_ENTRY
};

_Bool mu_law_is_statistical(mu_law law) {
    return *laws[law].kind == 'P';
}
const char *mu_law_title(mu_law law) {
    return laws[law].title;
}
const char *mu_law_name(mu_law law) {
    return laws[law].name;
}

void mu_tally_init(mu_tally *tally) {
    memset(tally, 0, sizeof *tally);
    for (mu_law law = 0; law < MU_LAW_COUNT; law++)
        if (mu_law_is_statistical(law)) tally->row[law].worst = 2; /* above every p */
}

static void print_direction(FILE *out, const mu_subject *subject, const char *name, const double *w) {
    const double side = subject->below ? -1 : 1;
    if (w) fprintf(out, ", \"%s\": [%.17g, %.17g, %.17g]", name, side * w[0], side * w[1], side * w[2]);
}

static void describe(char text[], size_t size, mu_case at) {
    FILE *out = fmemopen(text, size, "w");
    if (!out) return;
    fprintf(out, "{\"material\": %s", at.subject->json);
    print_direction(out, at.subject, "wo", at.wo);
    print_direction(out, at.subject, "wm", at.wm);
    print_direction(out, at.subject, "wi", at.wi);
    fputc('}', out);
    fclose(out);
}

void mu_tally_error(mu_tally *tally, mu_law law, double error, double tolerance, mu_case at) {
    mu_tally_row *row = &tally->row[law];
    double ratio = fabs(error) / tolerance;
    if (isnan(ratio)) ratio = error == 0 ? 0 : INFINITY;
    if (!row->count++ || ratio > row->worst) {
        row->worst = ratio;
        row->error = error;
        row->tolerance = tolerance;
        describe(row->where, sizeof row->where, at);
    }
}

void mu_tally_equal(mu_tally *tally, mu_law law, double a, double b, double accuracy, double slack,
                    mu_case at) {
    const double size = fmax(fabs(a), fabs(b)), error = (a - b) / size, tolerance = accuracy + slack / size;
    if (a == 0 && b == 0)
        mu_tally_error(tally, law, 0, accuracy, at);
    else if (!isfinite(a) || !isfinite(b))
        mu_tally_error(tally, law, NAN, accuracy, at);
    else if (slack > 0.1 * fabs(b))
        mu_tally_unresolved(tally, law, at);
    else
        mu_tally_error(tally, law, error, tolerance, at);
}

void mu_tally_p(mu_tally *tally, mu_law law, double p, mu_case at) {
    mu_tally_row *row = &tally->row[law];
    row->count++;
    if (isnan(p)) p = 0;
    if (p < row->worst) {
        row->worst = p;
        describe(row->where, sizeof row->where, at);
    }
}

void mu_tally_unresolved(mu_tally *tally, mu_law law, mu_case at) {
    mu_tally_row *row = &tally->row[law];
    if (!row->unresolved++) describe(row->unresolved_at, sizeof row->unresolved_at, at);
}

void mu_tally_add(mu_tally *sum, const mu_tally *tally) {
    for (mu_law law = 0; law < MU_LAW_COUNT; law++) {
        mu_tally_row *to = &sum->row[law];
        const mu_tally_row *from = &tally->row[law];
        const _Bool worse =
            mu_law_is_statistical(law) ? from->worst < to->worst : !to->count || from->worst > to->worst;
        if (from->count && worse) {
            to->worst = from->worst;
            to->error = from->error;
            to->tolerance = from->tolerance;
            memcpy(to->where, from->where, sizeof to->where);
        }
        if (!to->unresolved && from->unresolved)
            memcpy(to->unresolved_at, from->unresolved_at, sizeof to->where);
        to->count += from->count;
        to->unresolved += from->unresolved;
    }
}

size_t mu_tally_tests(const mu_tally *tally) {
    size_t tests = 0;
    for (mu_law law = 0; law < MU_LAW_COUNT; law++)
        if (mu_law_is_statistical(law)) tests += tally->row[law].count;
    return tests;
}

_Bool mu_tally_passes(const mu_tally *tally, mu_law law, double level) {
    const mu_tally_row *row = &tally->row[law];
    return mu_law_is_statistical(law) ? row->worst >= level : row->worst <= 1;
}
