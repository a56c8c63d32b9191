/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_povray.c: POV-Ray as a tracer, by lights in place of eyes (the dual method).
 *
 * A point is seen from a direction if and only if a parallel light there reaches it. A camera looks straight down on one
 * period, whose sides M has moved, so that the pixels of a 2 s nx x s ny image are the points (k + 1/2)/(2 s),
 * (l + 1/2)/s of all cells: the points that are asked for. Three lights, red, green and blue, answer for three views at
 * once; the finish returns a light's whole colour whatever the angle, so that values are 0 or 255.
 *
 * The scene (povray_scene.h) bakes M into vertices. One image answers for all points of three views; it is made when the
 * first of them is asked for.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/povray_run.h"
#include "core/render/povray_scene.h"
#include "core/render/surface_tracer.h"

/* Kinds of images: of one point per triangle, and of side^2. */
enum { AT_ONCE = MU_POVRAY_LIGHTS, MOST_GROUPS = (MU_PLAN_VIEWS + AT_ONCE - 1) / AT_ONCE, KINDS = 2 };

typedef struct surface {
    mu_heightfield f;
    double m[4];
    mu_plan plan;
    double (*views)[3];
    /* Of each three views and each kind: [l][k], bit c: light c reaches the point. NULL: not made yet. */
    uint8_t *lit[MOST_GROUPS][KINDS];
} surface;

typedef struct view {
    const uint8_t *lit;
    uint32_t nx, ny, fine, column, row, shift;
} view;

static void close_povray(void *data) {
    surface *s = data;
    if (!s) return;
    for (int g = 0; g < MOST_GROUPS; g++)
        for (int k = 0; k < KINDS; k++) free(s->lit[g][k]);
    free(s->views);
    free(s);
}

static void *open_povray(const mu_heightfield *f, const double m[4], const mu_plan *plan, mu_error *error) {
    surface *s = calloc(1, sizeof *s);
    double(*views)[3] = malloc(plan->count * sizeof *views);
    if (!s || !views) {
        free(s);
        free(views);
        mu_fail(error, "not enough memory");
        return NULL;
    }
    *s = (surface){.f = *f, .plan = *plan, .views = views};
    memcpy(s->m, m, sizeof s->m);
    memcpy(views, plan->views, plan->count * sizeof *views);
    return s;
}

/* The image's bytes, three a pixel from the highest y down, to bits from the lowest y up. */
static _Bool read_bits(FILE *image, uint32_t width, uint32_t height, uint8_t *lit, mu_error *error) {
    unsigned char *line = malloc((size_t)width * 3);
    _Bool good = line || mu_fail(error, "not enough memory");
    for (uint32_t r = 0; good && r < height; r++) {
        uint8_t *out = lit + (size_t)(height - 1 - r) * width;
        unsigned between = 0;
        good = fread(line, 3, width, image) == width || mu_fail(error, "POV-Ray's image is truncated");
        for (size_t k = 0; good && k < width; k++) {
            out[k] = 0;
            for (size_t c = 0; c < 3; c++) {
                between |= line[3 * k + c] != 0 && line[3 * k + c] != 255;
                out[k] |= (uint8_t)((line[3 * k + c] == 255) << c);
            }
        }
        if (good && between) good = mu_fail(error, "POV-Ray's image holds values between dark and lit");
    }
    free(line);
    return good;
}

static _Bool render(surface *s, uint32_t group, int kind, uint32_t fine, mu_error *error) {
    const uint32_t width = 2 * s->f.nx * fine, height = s->f.ny * fine;
    const uint32_t left = s->plan.count - AT_ONCE * group;
    const mu_povray_surface scene = {.f = s->f,
                                     .m = {s->m[0], s->m[1], s->m[2], s->m[3]},
                                     .views = (const double(*)[3])(s->views + AT_ONCE * group),
                                     .count = left < AT_ONCE ? left : AT_ONCE};
    uint8_t *lit = malloc((size_t)width * height);
    mu_povray run;
    if (!lit) return mu_fail(error, "not enough memory for an image of %u x %u", width, height);
    FILE *image = NULL;
    if (mu_povray_begin(&run, error)) {
        FILE *out = mu_povray_scene(&run, error);
        if (out && mu_povray_write(&scene, out, error))
            image = mu_povray_render(&run, out, width, height, s->plan.threads, error);
        else if (out)
            fclose(out);
    }
    const _Bool good = image && read_bits(image, width, height, lit, error);
    if (image) fclose(image);
    mu_povray_end(&run);
    if (good) s->lit[group][kind] = lit;
    if (!good) free(lit);
    return good;
}

static void *look(void *data, const mu_sight *sight, mu_error *error) {
    surface *s = data;
    uint32_t index = 0;
    while (memcmp(s->views[index], sight->w, sizeof sight->w)) index++; /* the plan names them all */
    const double middle[2] = {sight->upper ? 0.75 : 0.25, 0.5};
    const _Bool one = s->plan.side % 2 == 0 && sight->u == middle[0] && sight->v == middle[1];
    const uint32_t fine = one ? 1 : s->plan.side;
    uint8_t **const lit = &s->lit[index / AT_ONCE][one];
    if (!*lit && !render(s, index / AT_ONCE, one, fine, error)) return NULL;
    view *v = malloc(sizeof *v);
    if (!v) {
        mu_fail(error, "not enough memory");
        return NULL;
    }
    *v = (view){.lit = *lit,
                .nx = s->f.nx,
                .ny = s->f.ny,
                .fine = fine,
                .column = (uint32_t)(sight->u * 2 * fine),
                .row = (uint32_t)(sight->v * fine),
                .shift = index % AT_ONCE};
    return v;
}

static void look_away(void *data) {
    free(data);
}

static void row(const void *data, uint32_t i, uint8_t *visible) {
    const view *v = data;
    const size_t width = (size_t)2 * v->nx * v->fine;
    for (uint32_t j = 0; j < v->ny; j++)
        visible[j] =
            v->lit[((size_t)j * v->fine + v->row) * width + (size_t)i * 2 * v->fine + v->column] >> v->shift &
            1;
}

const mu_tracer mu_tracer_povray = {"povray", mu_povray_version, open_povray, close_povray,
                                    look,     look_away,         row};
