/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tension_picture.c: a deformation over its texture, as SVG.
 *
 * In every triangle, or an even choice of MU_ELLIPSES_MOST of them, stands the ellipse that M makes of the circle
 * inscribed there; red where the area grew, blue where it shrank, full at a factor of 2. The tangent is +u, its left side
 * +v (-v where the texture is mirrored), v grows upwards. All ellipses are shrunk alike if the median one would be
 * longer than its circle.
 */
#include <math.h>
#include <stdlib.h>

#include "core/render/tension_files.h"
#include "core/tension/stretch.h"

enum { MU_ELLIPSES_MOST = 4000, MU_TRIANGLES_MOST = 20000, SIZE = 1000, MARGIN = 20, LEGEND = 40 };

/* The triangle in the texture; false if it has no place there. */
static _Bool triangle_uv(const mu_deformation *d, uint32_t triangle, double uv[6]) {
    const double *uvs = d->deformed.uv;
    for (size_t k = 0; uvs && k < 6; k++) {
        uv[k] = uvs[2 * (size_t)d->corner[3 * (size_t)triangle + k / 2] + k % 2];
        if (!isfinite(uv[k])) return 0;
    }
    return uvs != NULL;
}

_Bool mu_tension_can_draw(const mu_deformation *d, mu_error *error) {
    double uv[6];
    for (uint32_t t = 0; t < d->triangles; t++)
        if (triangle_uv(d, t, uv)) return 1;
    return mu_fail(error, "%s: no texture coordinates to draw a picture over", d->deformed.file);
}

typedef struct mu_view {
    double low[2], scale, shrink;
    uint32_t height;
} mu_view;

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_stretch(const mu_deformation *d) {
    double most[MU_ELLIPSES_MOST];
    const uint32_t step = (d->triangles - 1) / MU_ELLIPSES_MOST + 1;
    size_t count = 0;
    for (uint32_t t = 0; t < d->triangles; t += step)
        most[count++] = mu_stretch_axes_of(d->tension->face + 4 * (size_t)t).most;
    qsort(most, count, sizeof *most, compare);
    return most[count / 2];
}

static mu_view make_view(const mu_deformation *d) {
    double uv[6], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t t = 0; t < d->triangles; t++)
        for (int k = 0; k < 6 && triangle_uv(d, t, uv); k++)
            low[k % 2] = fmin(low[k % 2], uv[k]), high[k % 2] = fmax(high[k % 2], uv[k]);
    const double extent = fmax(fmax(high[0] - low[0], high[1] - low[1]), 1e-30);
    mu_view view = {{low[0], low[1]}, SIZE / extent, 1 / fmax(1, median_stretch(d)), 0};
    view.height = (uint32_t)ceil((high[1] - low[1]) * view.scale);
    return view;
}

static void to_picture(const mu_view *view, const double uv[2], double xy[2]) {
    xy[0] = MARGIN + (uv[0] - view->low[0]) * view->scale;
    xy[1] = MARGIN + view->height - (uv[1] - view->low[1]) * view->scale;
}

static void draw_triangles(const mu_deformation *d, const mu_view *view, FILE *out) {
    const uint32_t step = (d->triangles - 1) / MU_TRIANGLES_MOST + 1;
    fputs("<path fill=\"none\" stroke=\"#bbb\" stroke-width=\"0.5\" d=\"", out);
    for (uint32_t t = 0; t < d->triangles; t += step) {
        double uv[6], xy[2];
        if (!triangle_uv(d, t, uv)) continue;
        for (int k = 0; k < 3; k++) {
            to_picture(view, uv + 2 * k, xy);
            fprintf(out, "%c%.2f %.2f", k ? 'L' : 'M', xy[0], xy[1]);
        }
        putc('Z', out);
    }
    fputs("\"/>\n", out);
}

static void draw_ellipse(const mu_view *view, const double uv[6], const mu_stretch_axes *axes, FILE *out) {
    const double du1 = uv[2] - uv[0], dv1 = uv[3] - uv[1], du2 = uv[4] - uv[0], dv2 = uv[5] - uv[1];
    const double area = du1 * dv2 - du2 * dv1;
    const double around = hypot(du1, dv1) + hypot(du2, dv2) + hypot(du2 - du1, dv2 - dv1);
    if (!(fabs(area) > 0)) return;
    const double radius = fabs(area) / around * view->scale * view->shrink;
    const double centre[2] = {(uv[0] + uv[2] + uv[4]) / 3, (uv[1] + uv[3] + uv[5]) / 3};
    const double turn = axes->deformed * 180 / acos(-1.0) * (area > 0 ? -1 : 1); /* SVG's y points down */
    const double tone = fmax(-1, fmin(1, log2(axes->area)));
    const int faded = (int)lrint(230 * (1 - fabs(tone)));
    double xy[2];
    to_picture(view, centre, xy);
    fprintf(out,
            "<ellipse cx=\"%.2f\" cy=\"%.2f\" rx=\"%.3f\" ry=\"%.3f\" transform=\"rotate(%.3f %.2f %.2f)\" "
            "fill=\"rgb(%d,%d,%d)\"/>\n",
            xy[0], xy[1], radius * axes->most, radius * axes->least, turn, xy[0], xy[1],
            tone > 0 ? 230 : faded, faded, tone > 0 ? faded : 230);
}

void mu_tension_draw(const mu_deformation *d, FILE *out) {
    const mu_view view = make_view(d);
    const uint32_t step = (d->triangles - 1) / MU_ELLIPSES_MOST + 1;
    double most = 0, least = INFINITY;
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%u\" font-family=\"sans-serif\" "
            "font-size=\"14\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            SIZE + 2 * MARGIN, view.height + 2 * MARGIN + LEGEND);
    draw_triangles(d, &view, out);
    fputs("<g stroke=\"black\" stroke-width=\"0.5\">\n", out);
    for (uint32_t t = 0; t < d->triangles; t++) {
        const mu_stretch_axes axes = mu_stretch_axes_of(d->tension->face + 4 * (size_t)t);
        double uv[6];
        most = fmax(most, axes.most), least = fmin(least, axes.least);
        if (t % step == 0 && triangle_uv(d, t, uv)) draw_ellipse(&view, uv, &axes, out);
    }
    fprintf(
        out,
        "</g>\n<text x=\"%d\" y=\"%u\">stretch %.3g to %.3g; circles become these ellipses, drawn at %.3g of "
        "their size; red: area grows, blue: it shrinks</text>\n</svg>\n",
        MARGIN, view.height + 2 * MARGIN + LEGEND / 2, least, most, view.shrink);
}
