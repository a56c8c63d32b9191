/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_border.c: heights of a file put right (holes, mean, plane) and made periodic; see surface_source.h. */
#include <math.h>
#include <stdlib.h>

#include "core/render/surface_source.h"

/* ------------------------------------------------------------------------------------------------------------- holes */

/* The four neighbours that there are; how many. */
static int neighbours(const mu_heightfield *f, size_t k, size_t out[4]) {
    const size_t i = k / f->ny, j = k % f->ny;
    int count = 0;
    if (i > 0) out[count++] = k - f->ny;
    if (i + 1 < f->nx) out[count++] = k + f->ny;
    if (j > 0) out[count++] = k - 1;
    if (j + 1 < f->ny) out[count++] = k + 1;
    return count;
}

/* Layer by layer from the border, the mean of the neighbours that are known by then. Puts the holes into that order. */
static void guess(const mu_heightfield *f, double *h, size_t *holes, size_t count) {
    for (size_t done = 0; done < count;) {
        size_t layer = done;
        for (size_t k = done; k < count; k++) {
            size_t near[4], known = 0;
            const int all = neighbours(f, holes[k], near);
            for (int n = 0; n < all; n++) known += isfinite(h[near[n]]) != 0;
            if (!known) continue;
            const size_t swapped = holes[layer];
            holes[layer++] = holes[k], holes[k] = swapped;
        }
        for (size_t k = done; k < layer; k++) {
            size_t near[4];
            double sum = 0, known = 0;
            const int all = neighbours(f, holes[k], near);
            for (int n = 0; n < all; n++)
                if (isfinite(h[near[n]])) sum += h[near[n]], known++;
            h[holes[k]] = sum / known;
        }
        done = layer;
    }
}

/* Laplace's equation by over-relaxation, until nothing moves by more than 1e-6 of the extent of the heights. */
static void relax(const mu_heightfield *f, double *h, const size_t *holes, size_t count, double extent) {
    double moved = INFINITY;
    for (int pass = 0; pass < 2000 && moved > 1e-6 * extent; pass++) {
        moved = 0;
        for (size_t k = 0; k < count; k++) {
            size_t near[4];
            double sum = 0;
            const int all = neighbours(f, holes[k], near);
            for (int n = 0; n < all; n++) sum += h[near[n]];
            const double change = 1.8 * (sum / all - h[holes[k]]);
            h[holes[k]] += change;
            moved = fmax(moved, fabs(change));
        }
    }
}

static _Bool close_holes(const mu_surface_source *s, mu_surface *surface, mu_error *error) {
    const mu_heightfield *f = &surface->f;
    double *h = surface->heights;
    size_t count = 0, first = 0;
    double low = INFINITY, high = -INFINITY;
    for (size_t k = mu_cells(f); k-- > 0;)
        if (isfinite(h[k]))
            low = fmin(low, h[k]), high = fmax(high, h[k]);
        else
            count++, first = k;
    if (!count) return 1;
    if (!s->fill || count == mu_cells(f))
        return mu_fail(
            error, "%s: the height at x = %zu, y = %zu is not finite (%zu of %zu heights are not)%s", s->file,
            first / f->ny, first % f->ny, count, mu_cells(f), s->fill ? "" : "; --fill closes holes");
    size_t *holes = malloc(count * sizeof *holes);
    if (!holes) return mu_fail(error, "%s: not enough memory", s->file);
    for (size_t k = 0, at = 0; k < mu_cells(f); k++)
        if (!isfinite(h[k])) h[k] = (double)NAN, holes[at++] = k;
    guess(f, h, holes, count);
    relax(f, h, holes, count, high - low);
    free(holes);
    surface->filled = count;
    mu_warn(error, "%s: %zu heights (%.3g %%) filled in; their facets are smoother than the rest", s->file,
            count, 100.0 * (double)count / (double)mu_cells(f));
    return 1;
}

/* ----------------------------------------------------------------------------------------------------- mean and plane */

static double mean_of(const mu_heightfield *f, const double *h) {
    double sum = 0;
    for (size_t k = 0; k < mu_cells(f); k++) sum += h[k];
    return sum / (double)mu_cells(f);
}

/* On a lattice the fit's three terms are orthogonal: the mean and two slopes by themselves. */
static void level(mu_surface *surface, _Bool plane) {
    const mu_heightfield *f = &surface->f;
    double *h = surface->heights;
    const double mean = mean_of(f, h), ci = 0.5 * (f->nx - 1), cj = 0.5 * (f->ny - 1);
    double top[2] = {0, 0}, bottom[2] = {0, 0};
    for (size_t k = 0; plane && k < mu_cells(f); k++) {
        const double i = (double)(k / f->ny) - ci, j = (double)(k % f->ny) - cj;
        top[0] += i * (h[k] - mean), bottom[0] += i * i;
        top[1] += j * (h[k] - mean), bottom[1] += j * j;
    }
    const double a = plane ? top[0] / bottom[0] : 0, b = plane ? top[1] / bottom[1] : 0;
    surface->plane[0] = mean, surface->plane[1] = a, surface->plane[2] = b;
    for (size_t k = 0; k < mu_cells(f); k++)
        h[k] -= mean + a * ((double)(k / f->ny) - ci) + b * ((double)(k % f->ny) - cj);
}

/* ------------------------------------------------------------------------------------------------------------- borders */

/* Facets across the border of a periodic surface are like all others; if they are three times as steep, it hardly is one. */
static void check_seam(const mu_surface_source *s, const mu_heightfield *f, const mu_error *error) {
    for (int axis = 0; axis < 2; axis++) {
        const uint32_t along = axis ? f->ny : f->nx;
        double inside = 0, across = 0;
        for (uint32_t i = 0; i < f->nx; i++)
            for (uint32_t j = 0; j < f->ny; j++) {
                const double step = mu_height(f, i + !axis, j + (axis == 1)) - mu_height(f, i, j);
                *((axis ? j : i) + 1 == along ? &across : &inside) += step * step;
            }
        if (along > 2 && across * (along - 1) > 9 * inside) {
            mu_warn(error,
                    "%s: heights do not go on across the border (steps are %.3g times as high there); "
                    "--border crop, mirror or blend is meant for such a surface",
                    s->file, sqrt(across * (along - 1) / inside));
            return;
        }
    }
}

/* The same row or column of the even extension. */
static uint32_t folded(uint32_t i, uint32_t n) {
    return i < n ? i : 2 * (n - 1) - i;
}

static _Bool mirror(mu_surface *s) {
    const mu_heightfield old = s->f;
    const uint32_t nx = 2 * (old.nx - 1), ny = 2 * (old.ny - 1);
    double *h = malloc((size_t)nx * ny * sizeof *h);
    if (!h) return 0;
    for (uint32_t i = 0; i < nx; i++)
        for (uint32_t j = 0; j < ny; j++)
            h[(size_t)i * ny + j] = old.h[(size_t)folded(i, old.nx) * old.ny + folded(j, old.ny)];
    free(s->heights);
    s->heights = h;
    s->f = (mu_heightfield){h, nx, ny};
    return 1;
}

/* Line i of n: itself with `weight`, and the line that far before the end with the rest of the square. */
static double weight(uint32_t i, uint32_t strip) {
    return i < strip ? sin(1.57079632679489661923 * i / strip) : 1;
}

/* In place: rows, then columns, shorter by the strip. */
static void blend(mu_surface *s) {
    const mu_heightfield old = s->f;
    const uint32_t strip[2] = {old.nx / 8, old.ny / 8}, nx = old.nx - strip[0], ny = old.ny - strip[1];
    double *h = s->heights;
    const double mean = mean_of(&old, h);
    for (size_t k = 0; k < mu_cells(&old); k++) h[k] -= mean;
    for (uint32_t i = 0; i < strip[0]; i++)
        for (uint32_t j = 0; j < old.ny; j++) {
            double *at = h + (size_t)i * old.ny + j;
            *at =
                weight(i, strip[0]) * *at + weight(strip[0] - i, strip[0]) * h[(size_t)(nx + i) * old.ny + j];
        }
    for (uint32_t i = 0; i < nx; i++)
        for (uint32_t j = 0; j < ny; j++) {
            const double *row = h + (size_t)i * old.ny;
            const double other = j < strip[1] ? weight(strip[1] - j, strip[1]) * row[ny + j] : 0;
            h[(size_t)i * ny + j] = mean + weight(j, strip[1]) * row[j] + other;
        }
    s->f = (mu_heightfield){h, nx, ny};
}

_Bool mu_surface_prepare(const mu_surface_source *s, _Bool doubt_border, mu_surface *surface,
                         mu_error *error) {
    if (!close_holes(s, surface, error)) return 0;
    if (s->level != MU_LEVEL_NONE) level(surface, s->level == MU_LEVEL_PLANE);
    const uint32_t least = surface->f.nx < surface->f.ny ? surface->f.nx : surface->f.ny;
    const uint32_t most = surface->f.nx > surface->f.ny ? surface->f.nx : surface->f.ny;
    switch (s->border) {
    case MU_BORDER_CROP:
        surface->open = 1;
        return 1;
    case MU_BORDER_MIRROR:
        if (2 * (most - 1) > MU_SURFACE_MOST)
            return mu_fail(error, "%s: its mirror image would have more than %d cells a side", s->file,
                           MU_SURFACE_MOST);
        return mirror(surface) || mu_fail(error, "%s: not enough memory", s->file);
    case MU_BORDER_BLEND:
        if (least < 16) return mu_fail(error, "%s: --border blend needs at least 16 pixels a side", s->file);
        blend(surface);
        return 1;
    default:
        if (doubt_border) check_seam(s, &surface->f, error);
        return 1;
    }
}
