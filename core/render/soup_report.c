/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* soup_report.c: asks for every facet, view and pair, and adds up. */
#include "core/render/soup_report.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/error.h"
#include "core/render/json_out.h"

enum { PAIRS = MU_SOUP_VIEWS * (MU_SOUP_VIEWS - 1) / 2, COLUMNS = MU_SOUP_VIEWS + PAIRS };

typedef struct mu_facet_answer {
    double area, normal[3]; /* a unit vector */
    double facing[MU_SOUP_VIEWS];
    double share[COLUMNS]; /* G1 of views, G2 of pairs */
} mu_facet_answer;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Far beyond what stands or casts shadows: copies one period on are out of reach of all views. */
static void stand_alone(mu_soup_question *q) {
    double low[3], high[3], far = 0;
    for (int c = 0; c < 3; c++) low[c] = INFINITY, high[c] = -INFINITY;
    for (size_t k = 0; k < q->soup.count; k++)
        for (int corner = 0; corner < 3; corner++)
            for (int c = 0; c < 3; c++) {
                low[c] = fmin(low[c], q->soup.triangles[k].p[corner][c]);
                high[c] = fmax(high[c], q->soup.triangles[k].p[corner][c]);
            }
    for (uint32_t k = 0; k < q->view_count; k++) {
        const double *w = q->views[k];
        far = fmax(far, (high[2] - low[2]) / w[2] * hypot(w[0], w[1]));
    }
    const double period = 4 * (far + (high[0] - low[0]) + (high[1] - low[1]));
    q->soup.period[0][0] = q->soup.period[1][1] = period;
    q->soup.period[0][1] = q->soup.period[1][0] = 0;
}

/* False if a facet is cut into more pieces than are kept. */
static _Bool ask(const mu_soup_question *q, size_t k, mu_facet_answer *out) {
    uint32_t column = q->view_count;
    mu_soup_normal(&q->soup, k, out->normal);
    out->area = sqrt(dot(out->normal, out->normal));
    for (int c = 0; c < 3; c++) out->normal[c] /= out->area;
    for (uint32_t a = 0; a < q->view_count; a++) {
        out->facing[a] = out->area * dot(out->normal, q->views[a]);
        if ((out->share[a] = mu_soup_visible(&q->soup, k, &q->views[a], 1)) < 0) return 0;
        for (uint32_t b = a + 1; b < q->view_count; b++, column++) {
            double both[2][3];
            memcpy(both[0], q->views[a], sizeof both[0]);
            memcpy(both[1], q->views[b], sizeof both[1]);
            out->share[column] = mu_soup_visible(&q->soup, k, (const double(*)[3])both, 2);
            if (out->share[column] < 0) return 0;
        }
    }
    return 1;
}

static void put_shares(mu_json *json, const mu_soup_question *q, const double *share) {
    const uint32_t v = q->view_count;
    mu_json_numbers(json, "G1", share, v);
    mu_json_numbers(json, "G2", share + v, v * (v - 1) / 2);
}

static double macro_area(const mu_soup_question *q) {
    const double(*e)[2] = q->soup.period;
    return q->periodic ? fabs(e[0][0] * e[1][1] - e[0][1] * e[1][0]) : (double)NAN;
}

static void put_facets(mu_json *json, mu_json *one, const mu_soup_question *q, const mu_facet_answer *f) {
    mu_json_list_begin(json, "facets");
    for (size_t k = 0; k < q->soup.count; k++) {
        mu_json_begin(one);
        mu_json_number(one, "triangle", (double)k);
        if (q->parts) mu_json_string(one, "part", q->parts[k]);
        mu_json_number(one, "area", f[k].area);
        mu_json_numbers(one, "normal", f[k].normal, 3);
        put_shares(one, q, f[k].share);
        mu_json_list_add(json, one);
    }
    mu_json_list_end(json);
}

/* Their normals differ by rounding at most. */
static _Bool same_normal(const mu_facet_answer *a, const mu_facet_answer *b) {
    for (int c = 0; c < 3; c++)
        if (!(fabs(a->normal[c] - b->normal[c]) < 1e-12)) return 0;
    return 1;
}

static void put_normals(mu_json *json, mu_json *one, const mu_soup_question *q, const mu_facet_answer *f) {
    const uint32_t columns = q->view_count * (q->view_count + 1) / 2;
    mu_json_list_begin(json, "normals");
    for (size_t k = 0; k < q->soup.count; k++) {
        double area = 0, share[COLUMNS] = {0};
        size_t first = 0;
        while (!same_normal(&f[first], &f[k])) first++;
        if (first < k) continue;
        for (size_t other = k; other < q->soup.count; other++) {
            if (!same_normal(&f[other], &f[k])) continue;
            area += f[other].area;
            for (uint32_t c = 0; c < columns; c++) share[c] += f[other].area * f[other].share[c];
        }
        for (uint32_t c = 0; c < columns; c++) share[c] /= area;
        mu_json_begin(one);
        mu_json_numbers(one, "normal", f[k].normal, 3);
        mu_json_number(one, "area", area);
        mu_json_number(one, "D", area / macro_area(q));
        put_shares(one, q, share);
        mu_json_list_add(json, one);
    }
    mu_json_list_end(json);
}

static void put_views(mu_json *json, mu_json *one, const mu_soup_question *q, const mu_facet_answer *f) {
    mu_json_list_begin(json, "views");
    for (uint32_t v = 0; v < q->view_count; v++) {
        const double *w = q->views[v], length = sqrt(dot(w, w));
        const double unit[3] = {w[0] / length, w[1] / length, w[2] / length};
        double area = 0, seen = 0, projected = 0, seen_projected = 0;
        for (size_t k = 0; k < q->soup.count; k++) {
            if (!(f[k].facing[v] > 0)) continue;
            area += f[k].area, seen += f[k].area * f[k].share[v];
            projected += f[k].facing[v], seen_projected += f[k].facing[v] * f[k].share[v];
        }
        mu_json_begin(one);
        mu_json_numbers(one, "view", unit, 3);
        mu_json_number(one, "G1", seen / area);
        mu_json_number(one, "G1_projected", seen_projected / projected);
        mu_json_number(one, "projected_area", seen_projected / (w[2] * macro_area(q)));
        mu_json_list_add(json, one);
    }
    mu_json_list_end(json);
}

static void put_pairs(mu_json *json, mu_json *one, const mu_soup_question *q, const mu_facet_answer *f) {
    uint32_t column = q->view_count;
    mu_json_list_begin(json, "pairs");
    for (uint32_t a = 0; a < q->view_count; a++)
        for (uint32_t b = a + 1; b < q->view_count; b++, column++) {
            double area = 0, seen = 0;
            for (size_t k = 0; k < q->soup.count; k++)
                if (f[k].facing[a] > 0 && f[k].facing[b] > 0)
                    area += f[k].area, seen += f[k].area * f[k].share[column];
            mu_json_begin(one);
            mu_json_number(one, "a", a);
            mu_json_number(one, "b", b);
            mu_json_number(one, "G2", seen / area);
            mu_json_list_add(json, one);
        }
    mu_json_list_end(json);
}

static _Bool write_answer(const mu_soup_question *q, const mu_facet_answer *f) {
    mu_json json = {0}, one = {0};
    mu_json_begin(&json);
    mu_json_numbers(&json, "transform", q->m, 4);
    if (q->periodic) mu_json_numbers(&json, "period", &q->soup.period[0][0], 4);
    put_facets(&json, &one, q, f);
    put_normals(&json, &one, q, f);
    put_views(&json, &one, q, f);
    put_pairs(&json, &one, q, f);
    const _Bool good = mu_json_write(&json, stdout);
    mu_json_free(&json), mu_json_free(&one);
    return good;
}

int mu_soup_answer(mu_soup_question *q, const mu_usage *usage) {
    mu_facet_answer *f = calloc(q->soup.count, sizeof *f);
    int code = MU_EXIT_OK;
    mu_soup_transform(&q->soup, q->m);
    if (!q->periodic) stand_alone(q);
    for (size_t k = 0; f && k < q->soup.count && code == MU_EXIT_OK; k++)
        if (!ask(q, k, &f[k]))
            code = mu_refuse(usage, "triangle %zu is cut into too many pieces by the shadows on it", k);
    if (!f) code = mu_refuse(usage, "not enough memory for %zu triangles", q->soup.count);
    errno = 0;
    if (code == MU_EXIT_OK && !write_answer(q, f)) {
        fprintf(stderr, "musurf %s: standard output: %s\n", usage->command, strerror(errno));
        code = MU_EXIT_FAILED;
    }
    free(f);
    return code;
}
