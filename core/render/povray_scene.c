/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* povray_scene.c: see povray_scene.h. */
#include "core/render/povray_scene.h"

#include <math.h>

enum { PATCH = 64, MOST_TILES = 4096 }; /* cells a side; periods */

static const double farthest = 1e7; /* POV-Ray looks no farther than this */

typedef struct mu_layout {
    double scale, middle; /* of heights */
    int32_t tiles[2][2];  /* periods, least and most */
    uint32_t patches[2];
} mu_layout;

/* How many of the lattice's units a ray along w passes per unit of its own length: |M^-1 w_xy| / |w|. */
static double passed(const double m[4], const double w[3]) {
    const double det = m[0] * m[3] - m[1] * m[2];
    const double x = m[3] * w[0] - m[1] * w[1], y = m[0] * w[1] - m[2] * w[0];
    return hypot(x, y) / (fabs(det) * sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
}

/* The periods over which rays from the middle one pass while they rise from the lowest height to the highest. */
static _Bool lay_out(const mu_povray_surface *s, mu_layout *out, double *range, mu_error *error) {
    double low = s->f.h[0], high = s->f.h[0];
    for (size_t k = 0; k < mu_cells(&s->f); k++) low = fmin(low, s->f.h[k]), high = fmax(high, s->f.h[k]);
    *range = high - low;
    const double *m = s->m, det = m[0] * m[3] - m[1] * m[2], n[2] = {s->f.nx, s->f.ny};
    double least[2] = {0, 0}, most[2] = {0, 0}, scale = 1;
    for (uint32_t v = 0; v < s->count; v++) {
        const double *w = s->views[v], rise = *range / w[2];
        scale = fmax(scale, passed(m, w));
        const double reach[2] = {rise * (m[3] * w[0] - m[1] * w[1]) / det,
                                 rise * (m[0] * w[1] - m[2] * w[0]) / det};
        for (int k = 0; k < 2; k++) {
            least[k] = fmin(least[k], floor((reach[k] - 1) / n[k]));
            most[k] = fmax(most[k], floor((n[k] + reach[k] + 1) / n[k]));
        }
    }
    const double tiles = (most[0] - least[0] + 1) * (most[1] - least[1] + 1);
    if (!(tiles <= MOST_TILES))
        return mu_fail(error, "the views reach over %.0f periods; POV-Ray is given %d at most", tiles,
                       MOST_TILES);
    *out =
        (mu_layout){.scale = scale,
                    .middle = 0.5 * (low + high),
                    .tiles = {{(int32_t)least[0], (int32_t)most[0]}, {(int32_t)least[1], (int32_t)most[1]}},
                    .patches = {(s->f.nx + PATCH - 1) / PATCH, (s->f.ny + PATCH - 1) / PATCH}};
    return 1;
}

static void place(const mu_povray_surface *s, const mu_layout *l, double i, double j, double out[2]) {
    out[0] = l->scale * (s->m[0] * i + s->m[1] * j);
    out[1] = l->scale * (s->m[2] * i + s->m[3] * j);
}

/* Cells [i, i1) x [j, j1), around the point (i, j) of the lattice. */
static void put_patch(const mu_povray_surface *s, const mu_layout *l, uint32_t i0, uint32_t j0, FILE *out) {
    const uint32_t i1 = i0 + PATCH < s->f.nx ? i0 + PATCH : s->f.nx,
                   j1 = j0 + PATCH < s->f.ny ? j0 + PATCH : s->f.ny;
    const uint32_t rows = i1 - i0 + 1, columns = j1 - j0 + 1;
    fprintf(out, "mesh2 { vertex_vectors { %u", rows * columns);
    for (uint32_t i = i0; i <= i1; i++)
        for (uint32_t j = j0; j <= j1; j++) {
            double p[2];
            place(s, l, (double)i - i0 - PATCH / 2, (double)j - j0 - PATCH / 2, p);
            fprintf(out, ",\n<%.9g,%.9g,%.9g>", (double)(float)p[0], (double)(float)p[1],
                    (double)(float)(l->scale * (mu_height(&s->f, i, j) - l->middle)));
        }
    fprintf(out, " }\nface_indices { %u", 2 * (rows - 1) * (columns - 1));
    for (uint32_t i = 0; i + 1 < rows; i++)
        for (uint32_t j = 0; j + 1 < columns; j++) {
            const uint32_t p00 = i * columns + j, p10 = p00 + columns;
            fprintf(out, ",\n<%u,%u,%u>,<%u,%u,%u>", p00, p10, p00 + 1, p10 + 1, p00 + 1, p10);
        }
    fprintf(out, " } texture { T } }\n");
}

static void put_patches(const mu_povray_surface *s, const mu_layout *l, FILE *out) {
    for (uint32_t a = 0; a < l->patches[0]; a++)
        for (uint32_t b = 0; b < l->patches[1]; b++) {
            fprintf(out, "#declare P%u = ", a * l->patches[1] + b);
            put_patch(s, l, a * PATCH, b * PATCH, out);
        }
    for (int32_t a = l->tiles[0][0]; a <= l->tiles[0][1]; a++)
        for (int32_t b = l->tiles[1][0]; b <= l->tiles[1][1]; b++)
            for (uint32_t k = 0; k < l->patches[0] * l->patches[1]; k++) {
                const uint32_t i = k / l->patches[1] * PATCH + PATCH / 2,
                               j = k % l->patches[1] * PATCH + PATCH / 2;
                double shift[2];
                place(s, l, (double)a * s->f.nx + i, (double)b * s->f.ny + j, shift);
                fprintf(out, "object { P%u translate <%.17g,%.17g,0> }\n", k, shift[0], shift[1]);
            }
}

/* Half the diagonal of all periods, roughly, and what it is of POV-Ray's reach. */
static _Bool far_away(const mu_povray_surface *s, const mu_layout *l, double range, double *far,
                      mu_error *error) {
    double p[2], q[2];
    const double i = (double)(l->tiles[0][1] - l->tiles[0][0] + 1) * s->f.nx,
                 j = (double)(l->tiles[1][1] - l->tiles[1][0] + 1) * s->f.ny;
    place(s, l, i, 0, p);
    place(s, l, 0, j, q);
    const double extent = hypot(p[0], p[1]) + hypot(q[0], q[1]) + l->scale * range;
    *far = fmax(1e5, 2 * extent);
    return extent < farthest / 2 ||
           mu_fail(error, "the surface is %.2g times as wide as its narrowest cell; POV-Ray can take %.2g",
                   extent, farthest / 2);
}

/* Turned so that what M stretches most lies along x, an isometry: POV-Ray's boxes are upright, and many times slower around
 * long thin things that are aslant. The angle is that of the long axis of M M^T. */
static void turn(const mu_povray_surface *s, double views[MU_POVRAY_LIGHTS][3], mu_povray_surface *out) {
    const double *m = s->m;
    const double angle =
        0.5 * atan2(2 * (m[0] * m[2] + m[1] * m[3]), m[0] * m[0] + m[1] * m[1] - m[2] * m[2] - m[3] * m[3]);
    const double c = cos(angle), d = sin(angle);
    *out = (mu_povray_surface){
        .f = s->f,
        .m = {c * m[0] + d * m[2], c * m[1] + d * m[3], c * m[2] - d * m[0], c * m[3] - d * m[1]},
        .views = (const double(*)[3])views,
        .count = s->count};
    for (uint32_t k = 0; k < s->count; k++) {
        const double *w = s->views[k];
        views[k][0] = c * w[0] + d * w[1];
        views[k][1] = c * w[1] - d * w[0];
        views[k][2] = w[2];
    }
}

_Bool mu_povray_write(const mu_povray_surface *given, FILE *out, mu_error *error) {
    static const char *const colours[MU_POVRAY_LIGHTS] = {"<1,0,0>", "<0,1,0>", "<0,0,1>"};
    mu_layout l = {.scale = 1};
    double range, far, right[2], up[2], views[MU_POVRAY_LIGHTS][3];
    mu_povray_surface turned;
    turn(given, views, &turned);
    const mu_povray_surface *const s = &turned;
    if (!lay_out(s, &l, &range, error) || !far_away(s, &l, range, &far, error)) return 0;
    place(s, &l, s->f.nx, 0, right);
    place(s, &l, 0, s->f.ny, up);
    const double x = 0.5 * (right[0] + up[0]), y = 0.5 * (right[1] + up[1]);
    fprintf(out,
            "#version 3.7;\nglobal_settings { assumed_gamma 1 ambient_light rgb 0 max_trace_level 1 }\n");
    fprintf(out,
            "camera { orthographic location <%.17g,%.17g,%.17g> direction <0,0,-1> right <%.17g,%.17g,0> up "
            "<%.17g,%.17g,0> }\n",
            x, y, l.scale * range + 10, right[0], right[1], up[0], up[1]);
    for (uint32_t v = 0; v < s->count; v++) {
        const double *w = s->views[v], length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        fprintf(out, "light_source { <%.17g,%.17g,%.17g> color rgb %s parallel point_at <%.17g,%.17g,0> }\n",
                x + far * w[0] / length, y + far * w[1] / length, far * w[2] / length, colours[v], x, y);
    }
    fprintf(out, "#declare T = texture { pigment { color rgb 1 } finish { ambient 0 emission 0 diffuse 1 "
                 "brilliance 0 } }\n");
    put_patches(s, &l, out);
    return 1;
}
