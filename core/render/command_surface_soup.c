/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface_soup.c: `musurf surface soup` and `boxes`, surfaces that pencil and paper answer, seen exactly. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/command_surface.h"
#include "core/render/soup_file.h"
#include "core/render/soup_report.h"

static _Bool read_view(mu_soup_question *q, const mu_options *at) {
    if (q->view_count == MU_SOUP_VIEWS) return mu_refuse(at->usage, "more than %d views", MU_SOUP_VIEWS), 0;
    return mu_options_view(at, q->views[q->view_count]) && ++q->view_count;
}

/* ------------------------------------------------------------------------------------------------------- soup */

static const mu_option soup_options[] = {
    {"transform", "A,C,B,D", "M = [a c; b d], row by row (default: 1,0,0,1); moves positions in the plane"},
    {"view", "X,Y,Z", "a direction in the space of the transformed surface, Z > 0; up to 16 of them"},
    {"period", "X,Y,X,Y",
     "two vectors in the plane that repeat the surface, before M (default: the file's, or none)"},
    {NULL, NULL, NULL}};

static const mu_usage soup_usage = {
    "surface soup", "FILE --view X,Y,Z [--view X,Y,Z ...] [--transform A,C,B,D] [--period X,Y,X,Y]",
    "The exact visibility of loose or joined triangles, any that need not be a heightfield: areas cut by "
    "shadows.\n",
    soup_options,
    "FILE is OBJ (v and f lines) or JSON, {\"vertices\": [[x,y,z], ...], \"triangles\": [[i,j,k], ...], "
    "\"period\":\n"
    "[[x,y], [x,y]]}, indices from 0, in double precision; up to 2000 triangles, corners counterclockwise "
    "seen from\n"
    "outside. z is up, x and y the plane of the macrosurface. Without a period the triangles stand "
    "alone.\n" MU_SOUP_OUT};

int mu_command_surface_soup(int argc, char **argv) {
    enum { TRANSFORM, VIEW, PERIOD };
    mu_soup_question q = {.m = {1, 0, 0, 1}};
    const char *file = NULL;
    double period[4] = {0};
    mu_error error = {.text = ""};
    int met;
    mu_options given = mu_options_begin(&soup_usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        _Bool good = 1;
        if (met == MU_OPTIONS_OPERAND) {
            if (file) return mu_refuse(&soup_usage, "one FILE, but \"%s\" is a second", given.value);
            file = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else {
            good = met == TRANSFORM ? mu_options_transform(&given, q.m)
                   : met == VIEW    ? read_view(&q, &given)
                                    : mu_options_numbers(&given, 4, 4, period) == 4;
            if (good && met == PERIOD &&
                !(fabs(period[0] * period[3] - period[1] * period[2]) >
                  1e-14 * hypot(period[0], period[1]) * hypot(period[2], period[3])))
                return mu_refuse(&soup_usage, "--period is \"%s\"; the two vectors span no area",
                                 given.value);
        }
        if (!good) return MU_EXIT_REFUSED;
    }
    if (!file) return mu_refuse(&soup_usage, "a FILE of triangles is needed");
    if (!q.view_count) return mu_refuse(&soup_usage, "at least one --view is needed");
    const _Bool good = mu_soup_read(file, &q.soup, &error);
    if (period[0] != 0 || period[1] != 0) memcpy(q.soup.period, period, sizeof period);
    q.periodic = q.soup.period[0][0] != 0 || q.soup.period[0][1] != 0;
    const int code = good ? mu_soup_answer(&q, &soup_usage) : mu_refuse(&soup_usage, "%s", error.text);
    free(q.soup.triangles);
    return code;
}

/* ------------------------------------------------------------------------------------------------------ boxes */

enum { SHAPE, PERIOD, DEPTH, WIDTH, HEIGHT, SLANT, TURN_OVER, TRANSFORM, VIEW };
enum { WAVE, BOX };

static const char *const wave_parts[MU_WAVE_TRIANGLES] = {"ground", "ground", "rising side",  "rising side",
                                                          "top",    "top",    "falling side", "falling side"};
static const char *const box_parts[MU_BOX_TRIANGLES] = {
    "top",        "top",        "side y low",  "side y low",  "side y high", "side y high",
    "side x low", "side x low", "side x high", "side x high", "ground",      "ground",
    "ground",     "ground",     "ground",      "ground"};

static const mu_option box_options[] = {
    {"shape", "wave|box",
     "ridges along y, the same for all y (default); or parallelepipeds on a square lattice"},
    {"period", "P", "from one to the next (default: 2)"},
    {"depth", "D",
     "of a wave: the piece along y that is repeated (default: 1); matters to nothing but areas"},
    {"width", "W", "of ridge or box, below P (default: 1)"},
    {"height", "H", "(default: 1)"},
    {"slant", "SX[,SY]", "how far the top is moved: sides hang over; SY of boxes alone (default: 0)"},
    {"turn-over", NULL, "heights change their sign: boxes become pits"},
    {"transform", "A,C,B,D", "M = [a c; b d], row by row (default: 1,0,0,1)"},
    {"view", "X,Y,Z", "a direction in the space of the transformed surface, Z > 0; up to 16 of them"},
    {NULL, NULL, NULL}};

static const mu_usage box_usage = {
    "surface boxes", "--view X,Y,Z [--view X,Y,Z ...] [--shape wave|box] [--period P] [--width W] ...",
    "The exact visibility of square waves and boxes, slanted, turned upside down, under any M.\n",
    box_options,
    "Ground lies at z = 0 from x = W on, the ridge's foot from 0 to W; a box's foot has its corner at the "
    "origin.\n"
    "\"part\" names a facet as it stands before it is turned over: ground, top, ...; a box's sides by their "
    "place.\n"
    "A square wave with W = P/2 is the example of On Microsurface Transformations, below Eq. (12c): as views "
    "sink, G1 of\n"
    "the level facets tends to 1/2 for each of two opposite views, their G2 to 1/2 and not to G1 G1 = "
    "1/4.\n" MU_SOUP_OUT};

typedef struct mu_shape {
    mu_soup_question q;
    int shape;
    double period, depth, width, height, slant[2];
    _Bool turn_over, has_depth, has_second_slant;
} mu_shape;

static _Bool read_box_option(mu_shape *s, const mu_options *at, int met) {
    static const char *const shapes[] = {"wave", "box", NULL};
    double *const size[] = {
        [PERIOD] = &s->period, [DEPTH] = &s->depth, [WIDTH] = &s->width, [HEIGHT] = &s->height};
    size_t count;
    switch (met) {
    case SHAPE:
        return mu_options_choice(at, shapes, &s->shape);
    case SLANT:
        count = mu_options_numbers(at, 1, 2, s->slant);
        s->has_second_slant = count == 2;
        return count > 0;
    case TURN_OVER:
        s->turn_over = 1;
        return 1;
    case TRANSFORM:
        return mu_options_transform(at, s->q.m);
    case VIEW:
        return read_view(&s->q, at);
    default:
        s->has_depth = s->has_depth || met == DEPTH;
        if (!mu_options_numbers(at, 1, 1, size[met])) return 0;
        return *size[met] > 0 ||
               (mu_refuse(&box_usage, "--%s is %s; it must be above 0", at->name, at->value), 0);
    }
}

int mu_command_surface_boxes(int argc, char **argv) {
    mu_shape s = {.q = {.m = {1, 0, 0, 1}, .periodic = 1}, .period = 2, .depth = 1, .width = 1, .height = 1};
    mu_triangle room[MU_BOX_TRIANGLES > MU_WAVE_TRIANGLES ? MU_BOX_TRIANGLES : MU_WAVE_TRIANGLES];
    int met;
    mu_options given = mu_options_begin(&box_usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) return mu_refuse(&box_usage, "\"%s\" is no option", given.value);
        if (met < 0) return mu_options_exit(met);
        if (!read_box_option(&s, &given, met)) return MU_EXIT_REFUSED;
    }
    if (!(s.width < s.period))
        return mu_refuse(&box_usage, "--width is %g; it must be below the period, %g", s.width, s.period);
    if (s.shape == BOX && s.has_depth) return mu_refuse(&box_usage, "a box has no --depth");
    if (s.shape == WAVE && s.has_second_slant)
        return mu_refuse(&box_usage, "--slant of a wave is one number");
    if (!s.q.view_count) return mu_refuse(&box_usage, "at least one --view is needed");
    if (s.shape == WAVE)
        mu_soup_wave(&s.q.soup, room, s.period, s.depth, s.width, s.height, s.slant[0]);
    else
        mu_soup_box(&s.q.soup, room, s.period, s.width, s.height, s.slant);
    s.q.parts = s.shape == WAVE ? wave_parts : box_parts;
    if (s.turn_over) mu_soup_turn_over(&s.q.soup);
    return mu_soup_answer(&s.q, &box_usage);
}
