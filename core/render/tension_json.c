/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* tension_json.c: the tension of a deformation as JSON, numbers with 17 digits, written as it goes. */
#include <inttypes.h>
#include <math.h>

#include "core/render/sequence.h"
#include "core/render/tension_files.h"
#include "core/tension/stretch.h"

const double *mu_tension_vertex(const mu_tension *tension, uint32_t vertex) {
    static const double one[4] = {1, 0, 0, 1};
    const uint32_t point = tension->vertex[vertex];
    return point == UINT32_MAX ? one : tension->point[point].m;
}

_Bool mu_tension_is_further(const mu_tension *tension, uint32_t point) {
    return tension->vertex[tension->point[point].vertex] != point;
}

static void put_matrix(FILE *out, const double m[4]) {
    fprintf(out, "[%.17g, %.17g, %.17g, %.17g]", m[0] + 0.0, m[1] + 0.0, m[2] + 0.0, m[3] + 0.0); /* no -0 */
}

static void put_summary(const mu_deformation *d, FILE *out) {
    const mu_tension *t = d->tension;
    const mu_tension_counts *c = &t->counts;
    double most = 0, least = INFINITY, largest = 0, smallest = INFINITY;
    uint32_t seams = 0;
    for (uint32_t i = 0; i < d->triangles; i++) {
        const mu_stretch_axes axes = mu_stretch_axes_of(t->face + 4 * (size_t)i);
        most = fmax(most, axes.most), least = fmin(least, axes.least);
        largest = fmax(largest, axes.area), smallest = fmin(smallest, axes.area);
    }
    for (uint32_t p = 0; p < t->points; p++) seams += mu_tension_is_further(t, p);
    fprintf(out,
            "{\"faces\": %" PRIu32 ", \"triangles\": %" PRIu32 ", \"vertices\": %" PRIu32
            ", \"seams\": %" PRIu32 ", \"stretch\": [%.17g, %.17g], \"area\": [%.17g, %.17g]",
            d->rest.faces, d->triangles, d->rest.vertices, seams, least, most, smallest, largest);
    fprintf(out,
            ", \"rest_flat\": %" PRIu32 ", \"deformed_flat\": %" PRIu32 ", \"uv_none\": %" PRIu32
            ", \"uv_flat\": %" PRIu32 ", \"uv_once\": %" PRIu32 ", \"uv_changed\": %" PRIu32
            ", \"uv_mirrored\": %" PRIu32 ", \"inverted\": %" PRIu32 ", \"points_without\": %" PRIu32 "}",
            c->rest_flat, c->deformed_flat, c->uv_none, c->uv_flat, c->uv_once, c->uv_changed, c->uv_mirrored,
            c->inverted, c->points_without);
}

/* Further charts: the vertex, the texture coordinates that tell it from the others, and M. */
static void put_seams(const mu_deformation *d, FILE *out) {
    const mu_tension *t = d->tension;
    const char *between = "";
    const mu_polygons *mesh = d->deformed.uv ? &d->deformed : &d->rest;
    for (uint32_t p = 0; p < t->points; p++) {
        if (!mu_tension_is_further(t, p)) continue;
        const uint32_t *corner = d->corner + 3 * (size_t)t->point[p].triangle;
        size_t k = 0;
        while (t->corner[3 * (size_t)t->point[p].triangle + k] != p) k++;
        const double *uv = mesh->uv ? mesh->uv + 2 * (size_t)corner[k] : NULL;
        fprintf(out, "%s{\"vertex\": %" PRIu32 ", \"uv\": ", between, d->rest.vertex[corner[k]]);
        if (uv && isfinite(uv[0]))
            fprintf(out, "[%.17g, %.17g]", uv[0], uv[1]);
        else
            fputs("null", out);
        fputs(", \"m\": ", out);
        put_matrix(out, t->point[p].m);
        putc('}', out);
        between = ", ";
    }
}

void mu_tension_write_json(const mu_deformation *d, long long frame, _Bool all, FILE *out) {
    putc('{', out);
    if (frame != MU_NO_FRAME) fprintf(out, "\"frame\": %lld, ", frame);
    fputs("\"summary\": ", out);
    put_summary(d, out);
    if (all) {
        fputs(", \"faces\": [", out);
        for (uint32_t f = 0; f < d->rest.faces; f++) {
            if (f) fputs(", ", out);
            put_matrix(out, d->face + 4 * (size_t)f);
        }
        fputs("], \"vertices\": [", out);
        for (uint32_t v = 0; v < d->rest.vertices; v++) {
            if (v) fputs(", ", out);
            put_matrix(out, mu_tension_vertex(d->tension, v));
        }
        fputs("], \"seams\": [", out);
        put_seams(d, out);
        putc(']', out);
    }
    fputs("}\n", out);
}
