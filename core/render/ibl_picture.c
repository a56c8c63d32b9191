/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ibl_picture.c: three panels as Figures 2, 7, 8 and 12 of Cocco et al. 2024: slopes, micronormals, reflected directions.
 *
 * x grows to the right, y upwards. Slopes are drawn as far as 1.6 times the region's longer half-axis. Directions are drawn by
 * Lambert's equal-area projection from above: at sqrt(1 - z) from the middle, so that the horizon is a circle and what is below
 * it lies outside. In each panel: the density of GGX in steps of a sixteenth of its root (white 0, dark its largest), the
 * boundary, the axis between the farthest points (thin) and what of it is above the horizon (thick), farthest, closest and
 * shifted closest points, samples; in the last the samples' radius, too.
 */
#include "core/render/ibl_picture.h"

#include <math.h>
#include <stdlib.h>

enum { SHOWN = 256 };
enum { SIDE = 360, MARGIN = 24, HEAD = 46, FOOT = 64, GRID = 120, LEVELS = 16, CURVE = 256, DISC = 32 };
static const double pi = 3.14159265358979323846;

typedef struct picture {
    const mu_ibl_question *ask;
    mu_ibl_axis_d axis;
    mu_ibl_space space;
    double reach; /* what the panel shows of slopes, to either side */
    FILE *out;
} picture;

/* In units of half a panel, y up. */
static void project(const picture *p, const double m[3], double xy[2]) {
    double w[3] = {m[0], m[1], m[2]};
    if (p->space == MU_IBL_SLOPES) {
        xy[0] = -m[0] / m[2] / p->reach, xy[1] = -m[1] / m[2] / p->reach;
        return;
    }
    if (p->space == MU_IBL_REFLECTED) {
        const double *o = p->ask->wo, along = m[0] * o[0] + m[1] * o[1] + m[2] * o[2];
        for (int k = 0; k < 3; k++) w[k] = 2 * along * m[k] - o[k];
    }
    const double scale = 1 / sqrt(fmax(1 + w[2], 1e-6)) / p->reach; /* sqrt(1 - z) over the length of w.xy */
    xy[0] = w[0] * scale, xy[1] = w[1] * scale;
}

/* What a place of the panel shows, as mu_ibl_density wants it. */
static void unproject(const picture *p, double x, double y, double *point) {
    x *= p->reach, y *= p->reach;
    point[0] = x, point[1] = y;
    if (p->space == MU_IBL_SLOPES) return;
    const double z = 1 - (x * x + y * y), scale = sqrt(fmax(1 + z, 0));
    point[0] *= scale, point[1] *= scale, point[2] = z;
}

static double right(double x) {
    return SIDE / 2. * (1 + x);
}
static double down(double y) {
    return SIDE / 2. * (1 - y);
}

/* Runs of cells of one step, a path for each step: lighter ones first, each over all that is as dense or denser. */
static _Bool draw_density(const picture *p) {
    const size_t size = p->space == MU_IBL_SLOPES ? 2 : 3, cells = (size_t)GRID * GRID;
    double *const points = malloc(cells * (size + 1) * sizeof *points), *const density =
                                                                            points + size * cells;
    if (!points) return 0;
    for (size_t i = 0; i < cells; i++)
        unproject(p, 2 * ((double)(i % GRID) + 0.5) / GRID - 1, 1 - 2 * ((double)(i / GRID) + 0.5) / GRID,
                  points + size * i);
    const int good = mu_ibl_density(&p->ask->lobe, p->ask->wo, p->space, cells, points, density);
    double most = 0;
    for (size_t i = 0; good && i < cells; i++) most = fmax(most, density[i]);
    for (int step = 1; most > 0 && step <= LEVELS; step++) {
        const double floor = most * pow((step - 0.5) / LEVELS, 2), grey = 255 - 165. * step / LEVELS;
        fprintf(p->out, "<path fill=\"rgb(%.0f,%.0f,%.0f)\" d=\"", grey, grey, grey + 10);
        for (size_t row = 0; row < GRID; row++)
            for (size_t first = 0, last; first < GRID; first = last + 1) {
                for (last = first; last < GRID && density[row * GRID + last] >= floor;) last++;
                if (last > first)
                    fprintf(p->out, "M%zu %zuh%zuv%dh-%zuz", first * (SIDE / GRID), row * (SIDE / GRID),
                            (last - first) * (SIDE / GRID), SIDE / GRID, (last - first) * (SIDE / GRID));
            }
        fputs("\"/>\n", p->out);
    }
    free(points);
    return 1;
}

/* A line through `count` micronormals, of any length, that `at` gives for 0 ... 1. */
static void draw_line(const picture *p, const char *style, int count,
                      void (*at)(const picture *, double, double[3])) {
    fprintf(p->out, "<path fill=\"none\" %s d=\"", style);
    for (int i = 0; i <= count; i++) {
        double m[3], xy[2];
        at(p, (double)i / count, m);
        const double length = hypot(hypot(m[0], m[1]), m[2]);
        for (int k = 0; k < 3; k++) m[k] /= length;
        project(p, m, xy);
        fprintf(p->out, "%c%.2f %.2f", i ? 'L' : 'M', right(xy[0]), down(xy[1]));
    }
    fputs("\"/>\n", p->out);
}

static void boundary_normal(const picture *p, double t, double m[3]) {
    const mu_ibl_lobe_d *l = &p->ask->lobe;
    const double x = p->ask->settings.k * l->sigma[0] * cos(t), y = p->ask->settings.k * l->sigma[1] * sin(t);
    m[0] = -(l->turn[0] * x - l->turn[1] * y), m[1] = -(l->turn[1] * x + l->turn[0] * y), m[2] = 1;
}
static void boundary_at(const picture *p, double share, double m[3]) {
    boundary_normal(p, 2 * pi * share, m);
}
static void axis_at(const picture *p, double share, double m[3]) {
    for (int k = 0; k < 3; k++) m[k] = (1 - share) * p->axis.far[0][k] + share * p->axis.far[1][k];
}
static void clamped_at(const picture *p, double share, double m[3]) {
    for (int k = 0; k < 3; k++)
        m[k] = (1 - share) * p->axis.far_clamped[0][k] + share * p->axis.far_clamped[1][k];
}

static void draw_point(const picture *p, const double m[3], double radius, const char *style) {
    double xy[2];
    const double length = hypot(hypot(m[0], m[1]), m[2]),
                 unit[3] = {m[0] / length, m[1] / length, m[2] / length};
    project(p, unit, xy);
    fprintf(p->out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" %s/>\n", right(xy[0]), down(xy[1]), radius,
            style);
}

/* The directions a chord r_s away from the reflection at m. */
static void draw_disc(const picture *p, const double m[3]) {
    const double *o = p->ask->wo, along = m[0] * o[0] + m[1] * o[1] + m[2] * o[2];
    const double chord = fmin(p->axis.radius, 2), cosine = 1 - chord * chord / 2,
                 sine = sqrt(fmax(0, 1 - cosine * cosine));
    double w[3], a[3], b[3];
    for (int k = 0; k < 3; k++) w[k] = 2 * along * m[k] - o[k];
    const double flat = hypot(w[0], w[1]), c = flat > 1e-9 ? w[0] / flat : 1,
                 s = flat > 1e-9 ? w[1] / flat : 0;
    a[0] = -s, a[1] = c, a[2] = 0;
    b[0] = -w[2] * c, b[1] = -w[2] * s, b[2] = flat;
    fputs("<path fill=\"none\" stroke=\"#27c\" stroke-width=\"0.6\" d=\"", p->out);
    for (int i = 0; i < DISC; i++) {
        const double phi = 2 * pi * i / DISC;
        double v[3], xy[2];
        for (int k = 0; k < 3; k++) v[k] = cosine * w[k] + sine * (cos(phi) * a[k] + sin(phi) * b[k]);
        const double scale = 1 / sqrt(fmax(1 + v[2], 1e-6)) / p->reach;
        xy[0] = v[0] * scale, xy[1] = v[1] * scale;
        fprintf(p->out, "%c%.2f %.2f", i ? 'L' : 'M', right(xy[0]), down(xy[1]));
    }
    fputs("z\"/>\n", p->out);
}

/* How many samples are drawn: more are no longer told apart. */
static size_t shown(const mu_ibl_settings_d *settings) {
    return settings->samples < SHOWN ? settings->samples : SHOWN;
}

static _Bool draw_panel(picture *p, mu_ibl_space space, const char *title) {
    static const double up[3] = {0, 0, 1};
    const mu_ibl_settings_d *s = &p->ask->settings;
    const mu_ibl_axis_d *a = &p->axis;
    const double longest = s->k * fmax(p->ask->lobe.sigma[0], p->ask->lobe.sigma[1]);
    p->space = space;
    p->reach = space == MU_IBL_SLOPES ? 1.6 * fmax(longest, 1e-12) : 1.15;
    fprintf(p->out,
            "<svg x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\">\n<rect width=\"%d\" height=\"%d\" "
            "fill=\"white\"/>\n",
            MARGIN + (int)space * (SIDE + MARGIN), HEAD, SIDE, SIDE, SIDE, SIDE);
    if (!draw_density(p)) return 0;
    if (space != MU_IBL_SLOPES)
        fprintf(p->out,
                "<circle cx=\"%d\" cy=\"%d\" r=\"%.2f\" fill=\"none\" stroke=\"#888\" stroke-dasharray=\"4 "
                "3\"/>\n",
                SIDE / 2, SIDE / 2, SIDE / 2 / p->reach);
    draw_line(p, "stroke=\"#f80\" stroke-width=\"1.5\"", CURVE, boundary_at);
    draw_line(p, "stroke=\"#f80\" stroke-width=\"1\" stroke-dasharray=\"2 3\"", CURVE / 4, axis_at);
    draw_line(p, "stroke=\"#d50\" stroke-width=\"2.5\"", CURVE / 4, clamped_at);
    for (size_t i = 0, n = shown(s); i < n; i++) { /* evenly, both ends among them */
        double m[3];
        mu_ibl_axis_sample_d(a, s->samples, n < s->samples ? i * (s->samples - 1) / (n - 1) : i, m);
        if (space == MU_IBL_REFLECTED) draw_disc(p, m);
        draw_point(p, m, 2.2, "fill=\"#27c\"");
    }
    for (int end = 0; end < 2; end++) {
        double shifted[3];
        boundary_normal(p, a->t[0] + (end ? pi - a->delta : a->delta), shifted);
        draw_point(p, a->far[end], 4, "fill=\"#d50\"");
        draw_point(p, a->near[end], 4, "fill=\"#094\"");
        draw_point(p, shifted, 5, "fill=\"none\" stroke=\"#094\" stroke-width=\"1.5\"");
    }
    draw_point(p, up, 3.5, "fill=\"white\" stroke=\"black\"");
    fprintf(p->out, "<rect width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#bbb\"/>\n</svg>\n", SIDE, SIDE);
    fprintf(p->out, "<text x=\"%d\" y=\"%d\" font-size=\"15\">%s</text>\n",
            MARGIN + (int)space * (SIDE + MARGIN), HEAD - 8, title);
    return 1;
}

_Bool mu_ibl_draw(const mu_ibl_question *ask, FILE *out) {
    picture p = {.ask = ask, .out = out};
    const int width = 3 * SIDE + 4 * MARGIN, height = HEAD + SIDE + FOOT;
    mu_ibl_axis_make_d(&ask->lobe, ask->wo, &ask->settings, &p.axis);
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
            "font-family=\"sans-serif\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#f6f6f6\"/>\n",
            width, height, width, height);
    if (!draw_panel(&p, MU_IBL_SLOPES, "slopes: P22") ||
        !draw_panel(&p, MU_IBL_NORMALS, "micronormals: D cos") ||
        !draw_panel(&p, MU_IBL_REFLECTED, "reflected directions: f cos"))
        return 0;
    char some[48] = "";
    if (shown(&ask->settings) < ask->settings.samples) snprintf(some, sizeof some, " (%zu of them drawn)", shown(&ask->settings));
    fprintf(out,
            "<text x=\"%d\" y=\"%d\" font-size=\"13\">sigma %.4g, %.4g at %.4g rad; wo %.3f, %.3f, %.3f; t "
            "%.4f, %.4f; "
            "tau %.4g, %.4g; delta %.4g; width %.4g, length %.4g, zeta %.4g, radius %.4g; N %zu%s</text>\n",
            MARGIN, HEAD + SIDE + 24, ask->lobe.sigma[0], ask->lobe.sigma[1],
            atan2(ask->lobe.turn[1], ask->lobe.turn[0]), ask->wo[0], ask->wo[1], ask->wo[2], p.axis.t[0],
            p.axis.t[1], p.axis.tau[0], p.axis.tau[1], p.axis.delta, p.axis.width, p.axis.length, p.axis.zeta,
            p.axis.radius, ask->settings.samples, some);
    fprintf(out,
            "<text x=\"%d\" y=\"%d\" font-size=\"13\" fill=\"#555\">orange: boundary, axis (thick above the "
            "horizon); red: farthest; green: closest, shifted (rings); "
            "blue: samples, their radius; white: normal, mirrored view; dashed: horizon</text>\n</svg>\n",
            MARGIN, HEAD + SIDE + 46);
    return 1;
}
