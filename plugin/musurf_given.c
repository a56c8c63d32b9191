/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_given.c: settings, each checked alone against the parameter table. */
#include "plugin/musurf_given.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

musurf_result musurf_fail(const musurf_host *host, musurf_result result, uint32_t param, const char *format,
                          ...) {
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (host && COVERS(host, message) && host->message)
        host->message(host->context, MUSURF_ERROR, param, text);
    return result;
}

static size_t numbers_of(musurf_kind kind) {
    return kind == MUSURF_COLOR       ? 3
           : kind == MUSURF_MATRIX    ? 4
           : kind == MUSURF_VECTOR    ? 2
           : kind == MUSURF_MATRIX3   ? 9
           : kind == MUSURF_CHOICE    ? 0
           : kind == MUSURF_FOOTPRINT ? 6
                                      : 1;
}

static musurf_result check_choice(const given *g, const musurf_param *p, const musurf_setting *s) {
    char known[192] = "";
    if (!COVERS(s, text) || !s->text)
        return musurf_fail(g->host, MUSURF_INVALID, p->id, "takes a word, not numbers");
    for (const char *const *choice = p->choices; *choice; choice++) {
        if (strcmp(*choice, s->text) == 0) return MUSURF_OK;
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", *known ? ", " : "", *choice);
    }
    return musurf_fail(g->host, MUSURF_INVALID, p->id, "\"%.40s\" is not known; it may be one of: %s",
                       s->text, known);
}

static musurf_result check_range(const given *g, const musurf_param *p, const double *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double x = values[i];
        const int low = p->flags & MUSURF_MIN_EXCLUDED ? x > p->min : x >= p->min;
        const int high = p->flags & MUSURF_MAX_EXCLUDED ? x < p->max : x <= p->max;
        if (!(fabs(x) <= DBL_MAX))
            return musurf_fail(g->host, MUSURF_INVALID, p->id, "%g is not a finite number", x);
        if (low && high) continue;
        const char open = p->flags & MUSURF_MIN_EXCLUDED ? '(' : '[',
                   close = p->flags & MUSURF_MAX_EXCLUDED ? ')' : ']';
        if (isinf(p->max))
            return musurf_fail(g->host, MUSURF_INVALID, p->id, "%.9g is out of range: at least %g", x,
                               p->min);
        return musurf_fail(g->host, MUSURF_INVALID, p->id, "%.9g is out of range: %c%g, %g%c", x, open,
                           p->min, p->max, close);
    }
    return MUSURF_OK;
}

/* Columns, rows, four bounds, the cells: what the core will think of them is its own business. */
static musurf_result check_grid(const given *g, const musurf_param *p, const musurf_setting *s) {
    const double most = 65536;
    const size_t count = COVERS(s, count) ? s->count : 0;
    if (count < 6)
        return musurf_fail(g->host, MUSURF_INVALID, p->id,
                           "is a grid of %zu numbers: columns, rows and four bounds come first", count);
    const double columns = s->values[0], rows = s->values[1];
    if (!(columns >= 1 && columns <= most && rows >= 1 && rows <= most && columns == floor(columns) &&
          rows == floor(rows)))
        return musurf_fail(g->host, MUSURF_INVALID, p->id, "cannot have %g columns and %g rows", columns,
                           rows);
    if (columns * rows != (double)(count - 6))
        return musurf_fail(g->host, MUSURF_INVALID, p->id, "of %g columns and %g rows has %zu cells", columns,
                           rows, count - 6);
    for (int i = 2; i < 6; i++)
        if (!(fabs(s->values[i]) <= DBL_MAX))
            return musurf_fail(g->host, MUSURF_INVALID, p->id, "has the bound %g", s->values[i]);
    return check_range(g, p, s->values + 6, count - 6);
}

static musurf_result check_numbers(const given *g, const musurf_param *p, const musurf_setting *s) {
    if (!COVERS(s, values) || !s->values)
        return musurf_fail(g->host, MUSURF_INVALID, p->id, "takes numbers, not a word");
    return p->kind == MUSURF_GRID ? check_grid(g, p, s) : check_range(g, p, s->values, numbers_of(p->kind));
}

musurf_result musurf_gather(given *g, const musurf_setting *settings, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const musurf_setting *s = (const void *)((const char *)settings + i * settings[0].size);
        if (!COVERS(s, param) || s->param < 1 || s->param > PARAMETER_COUNT)
            return musurf_fail(g->host, MUSURF_INVALID, COVERS(s, param) ? s->param : MUSURF_NO_PARAM,
                               "setting %zu is of no known parameter", i);
        const musurf_param *p = &musurf_parameters[s->param - 1];
        if (g->by_id[p->id]) return musurf_fail(g->host, MUSURF_INVALID, p->id, "is set twice");
        g->by_id[p->id] = s;
        musurf_result result = MUSURF_OK;
        if (COVERS(s, source) && s->source == MUSURF_SLOT) {
            if (!(p->flags & MUSURF_MAY_VARY))
                return musurf_fail(g->host, MUSURF_UNSUPPORTED, p->id,
                                   "cannot vary over the surface: a constant is needed");
            if (!COVERS(s, slot) || s->slot > 0xffff)
                return musurf_fail(g->host, MUSURF_INVALID, p->id, "the slot must lie in [0, 65535]");
        } else {
            result = p->kind == MUSURF_CHOICE ? check_choice(g, p, s) : check_numbers(g, p, s);
        }
        if (result != MUSURF_OK) return result;
    }
    return MUSURF_OK;
}

int musurf_varies(const given *g, uint32_t id) {
    const musurf_setting *s = g->by_id[id];
    return s && COVERS(s, source) && s->source == MUSURF_SLOT;
}

static const double *values_of(const given *g, uint32_t id) {
    return g->by_id[id] && !musurf_varies(g, id) ? g->by_id[id]->values : musurf_parameters[id - 1].initial;
}

double musurf_number(const given *g, uint32_t id) {
    return values_of(g, id)[0];
}

void musurf_numbers(const given *g, uint32_t id, size_t count, double *out) {
    memcpy(out, values_of(g, id), count * sizeof *out);
}

int musurf_differs(const given *g, uint32_t id) {
    const musurf_param *p = &musurf_parameters[id - 1];
    const musurf_setting *s = g->by_id[id];
    if (!s || p->flags & MUSURF_NO_DEFAULT || musurf_varies(g, id)) return s != NULL;
    if (p->kind == MUSURF_CHOICE) return strcmp(s->text, p->initial_choice) != 0;
    return memcmp(s->values, p->initial, numbers_of(p->kind) * sizeof *p->initial) != 0;
}

/* Index of the choice; the table's order is that of the core's enumerations. */
int musurf_choice(const given *g, uint32_t id) {
    const musurf_param *p = &musurf_parameters[id - 1];
    const char *text = g->by_id[id] ? g->by_id[id]->text : p->initial_choice;
    int i = 0;
    while (p->choices[i] && strcmp(p->choices[i], text) != 0) i++;
    return i;
}
