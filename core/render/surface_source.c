/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_source.c: options, the choice of a reader, and units. */
#include "core/render/surface_source.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/render/command_surface.h"
#include "core/render/image_read.h"

enum { CHANNEL, CELL, HEIGHT_SCALE, BORDER, LEVEL, FILL };

const char *const *mu_border_names(void) {
    static const char *const names[] = {"periodic", "crop", "mirror", "blend", NULL};
    return names;
}

const char *const *mu_level_names(void) {
    static const char *const names[] = {"none", "mean", "plane", NULL};
    return names;
}

mu_surface_source mu_surface_source_begin(void) {
    return (mu_surface_source){.cell = 1, .height_scale = 1};
}

_Bool mu_surface_source_option(mu_surface_source *s, const mu_options *at, int index) {
    int choice = 0;
    switch (index) {
    case CHANNEL:
        s->channel = at->value;
        return 1;
    case CELL:
        if (!mu_options_numbers(at, 1, 1, &s->cell)) return 0;
        return s->cell > 0 || (mu_refuse(at->usage, "--cell is %s; it must be above 0", at->value), 0);
    case HEIGHT_SCALE:
        if (!mu_options_numbers(at, 1, 1, &s->height_scale)) return 0;
        return s->height_scale != 0 || (mu_refuse(at->usage, "--height-scale is 0"), 0);
    case BORDER:
        if (!mu_options_choice(at, mu_border_names(), &choice)) return 0;
        s->border = (mu_border)choice;
        s->border_given = 1;
        return 1;
    case LEVEL:
        if (!mu_options_choice(at, mu_level_names(), &choice)) return 0;
        s->level = (mu_level)choice;
        return 1;
    default:
        s->fill = 1;
        return 1;
    }
}

static double *widen(float *from, size_t count) {
    double *to = from ? malloc(count * sizeof *to) : NULL;
    for (size_t k = 0; to && k < count; k++) to[k] = (double)from[k];
    free(from);
    return to;
}

/* OpenEXR: a magic number, then flags: 0x200 tiled, 0x800 deep, 0x1000 several parts. */
static _Bool plain_exr(const unsigned char head[8]) {
    static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
    return !memcmp(head, magic, sizeof magic) && !(head[5] & 0x1a);
}

static double *read_values(const mu_surface_source *s, int *width, int *height, _Bool *exr, mu_error *error) {
    struct stat status;
    unsigned char head[8] = {0};
    FILE *stream = NULL;
    if (stat(s->file, &status) || (S_ISREG(status.st_mode) && !(stream = fopen(s->file, "rbe")))) {
        mu_fail(error, "%s: cannot be opened: %s", s->file, strerror(errno));
        return NULL;
    }
    if (!S_ISREG(status.st_mode)) {
        mu_fail(error, "%s: is not a regular file", s->file);
        return NULL;
    }
    const size_t got = fread(head, 1, sizeof head, stream);
    fclose(stream);
    double *values;
    *exr = got == sizeof head && plain_exr(head);
    if (*exr) {
        float *plane = mu_image_read_plane(s->file, s->channel, width, height, error);
        if (!plane) return NULL;
        values = widen(plane, (size_t)*width * (size_t)*height);
        if (!values) mu_fail(error, "%s: not enough memory", s->file);
    } else if (got > 2 && head[0] == 'P' && (head[1] == '5' || head[1] == '2')) {
        values = mu_pgm_read(s->file, width, height, error);
    } else {
        values = mu_image_read_raw(s->file, s->channel, width, height, error);
    }
    return values;
}

_Bool mu_surface_read(const mu_surface_source *s, mu_surface *out, mu_error *error) {
    int width = 0, height = 0;
    _Bool exr = 0; /* what musurf writes is periodic */
    *out = (mu_surface){.heights = read_values(s, &width, &height, &exr, error)};
    if (!out->heights) return 0;
    out->f = (mu_heightfield){out->heights, (uint32_t)height, (uint32_t)width};
    out->pixels[0] = out->f.nx, out->pixels[1] = out->f.ny;
    _Bool good = (width >= MU_SURFACE_LEAST && height >= MU_SURFACE_LEAST && width <= MU_SURFACE_MOST &&
                  height <= MU_SURFACE_MOST) ||
                 mu_fail(error, "%s: is %d x %d; a heightfield has %d to %d pixels a side", s->file, width,
                         height, MU_SURFACE_LEAST, MU_SURFACE_MOST);
    for (size_t k = 0; good && k < mu_cells(&out->f); k++) {
        double *h = &out->heights[k];
        if (!isfinite(*h)) continue; /* a hole */
        *h = *h * s->height_scale / s->cell;
        if (!isfinite(*h) || fabs(*h) > 1e100)
            good = mu_fail(error, "%s: --height-scale and --cell make heights that are too large", s->file);
    }
    if (good) good = mu_surface_prepare(s, !exr && !s->border_given, out, error);
    if (!good) mu_surface_free(out);
    return good;
}

void mu_surface_free(mu_surface *surface) {
    free(surface->heights);
    *surface = (mu_surface){.open = 0};
}

mu_window mu_surface_window(const mu_heightfield *f, _Bool open, const double m[4], const double w[3]) {
    if (!open) return (mu_window){0, f->nx, 0, f->ny};
    double low = f->h[0], high = f->h[0];
    for (size_t k = 0; k < mu_cells(f); k++) low = fmin(low, f->h[k]), high = fmax(high, f->h[k]);
    /* How far a ray goes while it rises from the lowest to the highest: M^-1 w_xy, in cells. */
    const double det = m[0] * m[3] - m[1] * m[2], rise = (high - low) / w[2];
    const double reach[2] = {rise * (m[3] * w[0] - m[1] * w[1]) / det,
                             rise * (m[0] * w[1] - m[2] * w[0]) / det};
    const uint32_t cells[2] = {f->nx - 1, f->ny - 1};
    uint32_t range[2][2] = {{0, 0}, {0, 0}};
    for (int k = 0; k < 2; k++) {
        const double first = ceil(fmax(0, -reach[k])), last = floor(cells[k] - fmax(0, reach[k]));
        if (first < last) range[k][0] = (uint32_t)first, range[k][1] = (uint32_t)last;
    }
    return (mu_window){range[0][0], range[0][1], range[1][0], range[1][1]};
}
