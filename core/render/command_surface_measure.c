/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface_measure.c: `musurf surface measure`, what is seen of a heightfield under M. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/render/command_surface.h"
#include "core/render/json_out.h"
#include "core/render/output.h"
#include "core/render/surface_bits.h"
#include "core/render/surface_measure.h"

enum { TRANSFORM, VIEW, BINS, TRACER, THREADS, SUBSAMPLES, BITS, SOURCE };

static const mu_option options[] = {
    {"transform", "A,C,B,D", "M = [a c; b d], row by row (default: 1,0,0,1)"},
    {"view", "X,Y,Z", "a direction in the space of the transformed surface, Z > 0; up to 64 of them"},
    {"bins", "N|A,B,...",
     "G1 by the facets' slope along the view: N bins of as many facets each, or these edges"},
    {"tracer", "own|embree|povray",
     "own: exact, double precision (default); embree: float; povray: the program POV-Ray, by lights, in a\n"
     "temporary folder ($POVRAY names it; povray on the PATH otherwise)"},
    {"threads", "N", "threads (default: one per processor); the result does not depend on it"},
    {"subsamples", "K", "points per facet for G1_projected and bins: a square, 9 to 225 (default: 9)"},
    {"bits", "FILE.npy",
     "writes what each view sees as a NumPy array of bytes [view][L, U][i][j]: 1 where the facet's one\n"
     "point is seen, 0 where it is not or the facet faces away"},
    MU_SURFACE_SOURCE_OPTIONS,
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "surface measure", "FILE --view X,Y,Z [--view X,Y,Z ...] [--transform A,C,B,D] ...",
    "Counts the facets of a heightfield that directions see, on triangles whose vertices M has moved.\n",
    options,
    MU_SURFACE_SOURCE_HELP
    "out, one line of JSON: {\"views\": [...], \"pairs\": [...]}; each view has\n"
    "  \"view\"           the direction, as a unit vector\n"
    "  \"facets\"         2 nx ny; with --border crop, those of the \"window\" of cells [i0, i1, j0, j1] "
    "that count\n"
    "  \"front_facing\"   facets whose normal is within 90 degrees of the view\n"
    "  \"visible\"        of these, whose point (i + 1/4, j + 1/2) or (i + 3/4, j + 1/2) is seen\n"
    "  \"G1_facet_mean\"  visible / front_facing\n"
    "  \"G1_projected\"   the seen share of K points per facet, facets weighted by their area projected on "
    "the view\n"
    "  \"bins\"           with --bins: slopes \"from\", \"to\", \"facets\", \"visible\", and \"G1\" over the "
    "K points\n"
    "and each pair of views \"a\" and \"b\" (0 is the first)\n"
    "  \"facing_both\", \"both_visible\"   facets that face both; that both see\n"
    "  \"G2\"             both_visible / facing_both\n"
    "\"..._error\" is a standard error from 16 blocks of the surface: how far another surface of its kind "
    "would lie.\n"
    "\"tracer\": what stands behind embree or povray, with its version.\n"};

typedef struct mu_asked {
    mu_measuring s;
    mu_surface_source source;
    const char *bits;
    double edges[MU_MOST_BINS + 1];
} mu_asked;

static _Bool read_bins(mu_asked *asked, const mu_options *at) {
    uint64_t count;
    asked->s.edges = NULL;
    if (!strchr(at->value, ',')) {
        if (!mu_options_unsigned(at, 1, MU_MOST_BINS, &count)) return 0;
        asked->s.bin_count = (uint32_t)count;
        return 1;
    }
    count = mu_options_numbers(at, 2, MU_MOST_BINS + 1, asked->edges);
    if (!count) return 0;
    for (uint64_t k = 1; k < count; k++)
        if (!(asked->edges[k] > asked->edges[k - 1]))
            return mu_refuse(&usage, "--bins is \"%s\"; edges must rise", at->value), 0;
    asked->s.bin_count = (uint32_t)count - 1;
    asked->s.edges = asked->edges;
    return 1;
}

static _Bool read_option(void *to, const mu_options *at, int met) {
    mu_asked *asked = to;
    uint64_t number = 0;
    int choice = 0;
    if (met >= SOURCE) return mu_surface_source_option(&asked->source, at, met - SOURCE);
    switch (met) {
    case TRANSFORM:
        return mu_options_transform(at, asked->s.m);
    case VIEW:
        if (asked->s.view_count == MU_MOST_VIEWS)
            return mu_refuse(&usage, "more than %d views", MU_MOST_VIEWS), 0;
        return mu_options_view(at, asked->s.views[asked->s.view_count].w) && ++asked->s.view_count;
    case BINS:
        return read_bins(asked, at);
    case TRACER:
        if (!mu_options_choice(at, mu_tracer_names(), &choice)) return 0;
        asked->s.tracer = mu_tracer_get(choice);
        return 1;
    case THREADS:
        if (!mu_options_unsigned(at, 1, 256, &number)) return 0;
        asked->s.threads = (uint32_t)number;
        return 1;
    case BITS:
        asked->bits = at->value;
        return 1;
    default:
        if (!mu_options_unsigned(at, 9, 225, &number)) return 0;
        asked->s.side = (uint32_t)(sqrt((double)number) + 0.5);
        return asked->s.side * asked->s.side == number ||
               (mu_refuse(&usage, "--subsamples is %s; it must be a square, 9, 16, 25, ...", at->value), 0);
    }
}

static void put_estimate(mu_json *json, const char *key, mu_estimate e) {
    char name[64];
    snprintf(name, sizeof name, "%s_error", key);
    mu_json_number(json, key, e.value);
    mu_json_number(json, name, e.error);
}

static void put_view(const mu_measuring *s, const mu_view *view, mu_json *json, mu_json *inner) {
    const double length = sqrt(view->w[0] * view->w[0] + view->w[1] * view->w[1] + view->w[2] * view->w[2]);
    const double w[3] = {view->w[0] / length, view->w[1] / length, view->w[2] / length};
    const mu_window c = view->window;
    const double window[4] = {c.i0, c.i1, c.j0, c.j1};
    mu_json_begin(json);
    mu_json_numbers(json, "view", w, 3);
    mu_json_number(json, "facets", 2.0 * (c.i1 - c.i0) * (c.j1 - c.j0));
    if (s->open) mu_json_numbers(json, "window", window, 4);
    mu_json_number(json, "front_facing", (double)view->front_facing);
    mu_json_number(json, "visible", (double)view->visible);
    put_estimate(json, "G1_facet_mean", view->facet_mean);
    put_estimate(json, "G1_projected", view->projected);
    if (!s->bin_count) return;
    mu_json_list_begin(json, "bins");
    for (uint32_t k = 0; k < s->bin_count; k++) {
        mu_json_begin(inner);
        mu_json_number(inner, "from", view->bins[k].from);
        mu_json_number(inner, "to", view->bins[k].to);
        mu_json_number(inner, "facets", (double)view->bins[k].facets);
        mu_json_number(inner, "visible", (double)view->bins[k].visible);
        put_estimate(inner, "G1", view->bins[k].g1);
        mu_json_list_add(json, inner);
    }
    mu_json_list_end(json);
}

static _Bool report(const mu_measuring *s) {
    mu_json all = {0}, one = {0}, inner = {0};
    mu_json_begin(&all);
    mu_json_list_begin(&all, "views");
    for (uint32_t k = 0; k < s->view_count; k++) {
        put_view(s, &s->views[k], &one, &inner);
        mu_json_list_add(&all, &one);
    }
    mu_json_list_end(&all);
    mu_json_list_begin(&all, "pairs");
    for (uint32_t a = 0; a < s->view_count; a++)
        for (uint32_t b = a + 1; b < s->view_count; b++) {
            mu_pair pair = {.a = a, .b = b};
            mu_measure_pair(s, &pair);
            mu_json_begin(&one);
            mu_json_number(&one, "a", a);
            mu_json_number(&one, "b", b);
            mu_json_number(&one, "facing_both", (double)pair.facing_both);
            mu_json_number(&one, "both_visible", (double)pair.both_visible);
            put_estimate(&one, "G2", pair.g2);
            mu_json_list_add(&all, &one);
        }
    mu_json_list_end(&all);
    if (s->version[0]) mu_json_string(&all, "tracer", s->version);
    const _Bool good = mu_json_write(&all, stdout);
    mu_json_free(&all);
    mu_json_free(&one);
    mu_json_free(&inner);
    return good;
}

static void show(void *context, uint32_t done, uint32_t all) {
    (void)context;
    fprintf(stderr, "\r%3.0f %%\033[K", 100.0 * done / all);
}

static int measure(mu_asked *asked) {
    mu_measuring *const s = &asked->s;
    mu_error error = {.text = ""};
    if (asked->bits && !mu_output_check(asked->bits, &error)) return mu_refuse(&usage, "%s", error.text);
    mu_surface surface;
    const _Bool read = mu_surface_read(&asked->source, &surface, &error);
    const _Bool terminal = isatty(STDERR_FILENO);
    int code = MU_EXIT_OK;
    s->f = surface.f, s->open = surface.open;
    if (terminal) s->progress = show;
    const _Bool good =
        read && mu_measure(s, &error) && (!asked->bits || mu_surface_bits(asked->bits, s, &error));
    if (terminal) fprintf(stderr, "\r\033[K");
    errno = 0;
    if (!good && !error.text[0]) {
        code = MU_EXIT_INTERRUPTED;
    } else if (!good) {
        code = mu_refuse(&usage, "%s", error.text);
    } else if (!report(s)) {
        fprintf(stderr, "musurf surface measure: standard output: %s\n", strerror(errno));
        code = MU_EXIT_FAILED;
    }
    mu_measure_free(s);
    mu_surface_free(&surface);
    return code;
}

int mu_command_surface_measure(int argc, char **argv) {
    mu_asked asked = {
        .source = mu_surface_source_begin(),
        .s = {.m = {1, 0, 0, 1}, .tracer = &mu_tracer_own, .side = 3, .threads = mu_processors()}};
    int code;
    if (!mu_surface_options(&usage, argc, argv, read_option, &asked, &asked.source.file, &code)) return code;
    if (!asked.s.view_count) return mu_refuse(&usage, "at least one --view is needed");
    return measure(&asked);
}
