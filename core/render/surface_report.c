/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_report.c: what was gathered of surfaces as one line of JSON; every estimate has its "..._error" beside it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/render/json_out.h"
#include "core/render/surface_statistics.h"

typedef struct mu_pages {
    const mu_gathering *g;
    double *values, *errors, *scale; /* as many as bins or cells of slopes, whichever are more */
} mu_pages;

static void put_one(mu_json *json, const char *key, const mu_ratios *r, size_t cell) {
    char name[64];
    const mu_ratio e = mu_ratios_get(r, cell);
    snprintf(name, sizeof name, "%s_error", key);
    mu_json_number(json, key, e.value);
    mu_json_number(json, name, e.error);
}

/* Cells first, first + 1, ...; those with a scale are divided by it. */
static void put_many(mu_pages *p, mu_json *json, const char *key, const mu_ratios *r, size_t first,
                     size_t count, const double *scale) {
    char name[64];
    for (size_t k = 0; k < count; k++) {
        const mu_ratio e = mu_ratios_get(r, first + k);
        p->values[k] = e.value / (scale ? scale[k] : 1);
        p->errors[k] = e.error / (scale ? scale[k] : 1);
    }
    snprintf(name, sizeof name, "%s_error", key);
    mu_json_numbers(json, key, p->values, count);
    mu_json_numbers(json, name, p->errors, count);
}

/* Means first; second moments are reported about them: the error is that of the moments about this mean. */
static void put_moments(const mu_gathering *g, mu_json *json) {
    const size_t more = (size_t)g->slope_cells * g->slope_cells;
    double mean[2], mean_error[2], covariance[3], covariance_error[3];
    for (size_t k = 0; k < 2; k++) {
        const mu_ratio e = mu_ratios_get(&g->slopes, more + MU_SLOPE_X + k);
        mean[k] = e.value, mean_error[k] = e.error;
    }
    const double square[3] = {mean[0] * mean[0], mean[0] * mean[1], mean[1] * mean[1]};
    for (size_t k = 0; k < 3; k++) {
        const mu_ratio e = mu_ratios_get(&g->slopes, more + MU_SLOPE_XX + k);
        covariance[k] = e.value - square[k], covariance_error[k] = e.error;
    }
    mu_json_numbers(json, "mean", mean, 2);
    mu_json_numbers(json, "mean_error", mean_error, 2);
    mu_json_numbers(json, "covariance", covariance, 3);
    mu_json_numbers(json, "covariance_error", covariance_error, 3);
}

static void put_slopes(mu_pages *p, mu_json *json) {
    const mu_gathering *g = p->g;
    const size_t k = g->slope_cells;
    const double *b = g->slope_bounds, cell = (b[1] - b[0]) * (b[3] - b[2]) / (double)(k * k);
    for (size_t at = 0; at < k * k; at++) p->scale[at] = cell;
    mu_json_begin(json);
    mu_json_numbers(json, "bounds", b, 4);
    mu_json_number(json, "cells", (double)k);
    put_many(p, json, "density", &g->slopes, 0, k * k, p->scale);
    put_one(json, "outside", &g->slopes, k * k + MU_SLOPE_OUTSIDE);
    put_moments(g, json);
}

static double *solid_angles(mu_pages *p) {
    for (size_t k = 0; k < mu_directions_count(&p->g->bins); k++)
        p->scale[k] = mu_directions_solid_angle(&p->g->bins, k);
    return p->scale;
}

static void put_normals(mu_pages *p, mu_json *json) {
    const mu_gathering *g = p->g;
    const size_t bins = mu_directions_count(&g->bins);
    mu_json_begin(json);
    mu_json_numbers(json, "facets", g->facets, bins);
    put_many(p, json, "D", &g->normals, 0, bins, solid_angles(p));
    double area = 0;
    for (size_t k = 0; k <= bins; k++) area += mu_ratios_get(&g->normals, k).value;
    mu_json_number(json, "area", area);
}

static void put_lamp(const mu_gathering *g, uint32_t lamp, mu_json *json) {
    mu_json_begin(json);
    mu_json_numbers(json, "light", g->lamps[lamp].l, 3);
    mu_json_number(json, "radius", g->lamps[lamp].radius * 180 / 3.14159265358979323846);
}

static void put_reflection(mu_pages *p, const mu_seen *s, int c, mu_json *json, mu_json *inner) {
    const mu_gathering *g = p->g;
    const size_t bins = mu_directions_count(&g->bins);
    static const char *const names[MU_ENDS] = {"escaped", "over_limit", "lost", "absorbed"};
    mu_json_begin(json);
    for (int k = 0; k < MU_ENDS; k++) put_one(json, names[k], &s->ends[c], (size_t)k);
    mu_json_list_begin(json, "orders");
    for (uint32_t k = 0; k < g->bounces; k++) {
        mu_json_begin(inner);
        mu_json_number(inner, "order", k + 1);
        put_one(inner, "albedo", &s->ends[c], MU_ENDS + k);
        put_many(p, inner, "density", &s->directions[c], k * (bins + 1), bins, solid_angles(p));
        mu_json_list_add(json, inner);
    }
    mu_json_list_end(json);
    if (!g->lamp_count) return;
    mu_json_list_begin(json, "lights");
    for (uint32_t k = 0; k < g->lamp_count; k++) {
        if (mu_lamp_below(&g->lamps[k])) continue;
        put_lamp(g, k, inner);
        put_one(inner, "f", &s->lamps[c], 2 * (size_t)k);
        mu_json_number(inner, "f_grouped", mu_gathering_grouped(g, s, k, c));
        put_one(inner, "f_all_orders", &s->lamps[c], 2 * (size_t)k + 1);
        mu_json_list_add(json, inner);
    }
    mu_json_list_end(json);
}

static void put_transmission(mu_pages *p, const mu_seen *s, mu_json *json, mu_json *inner) {
    const mu_gathering *g = p->g;
    static const char *const names[MU_THROUGHS] = {"escaped", "caught", "reflected", "total_reflection"};
    mu_json_begin(json);
    for (int k = 0; k < MU_THROUGHS; k++) put_one(json, names[k], &s->through.ends, (size_t)k);
    mu_json_number(json, "factor", 1 / (g->reflectance.a[0] * g->reflectance.a[0]));
    put_many(p, json, "density", &s->through.directions, 0, mu_directions_count(&g->bins), solid_angles(p));
    if (!g->lamp_count) return;
    mu_json_list_begin(json, "lights");
    for (uint32_t k = 0; k < g->lamp_count; k++) {
        if (!mu_lamp_below(&g->lamps[k])) continue;
        put_lamp(g, k, inner);
        put_one(inner, "f", &s->through.lamps, k);
        mu_json_number(inner, "f_grouped", mu_gathering_grouped(g, s, k, 0));
        mu_json_list_add(json, inner);
    }
    mu_json_list_end(json);
}

static void put_view(mu_pages *p, const mu_seen *s, mu_json *json, mu_json *one, mu_json *inner) {
    const mu_gathering *g = p->g;
    const size_t bins = mu_directions_count(&g->bins);
    mu_json_begin(json);
    mu_json_numbers(json, "view", s->unit, 3);
    put_one(json, "G1_projected", &s->projected, 0);
    put_many(p, json, "facing", &s->facing, 0, bins, NULL);
    put_many(p, json, "G1", &s->masking, 0, bins, NULL);
    put_many(p, json, "Dv", &s->normals, 0, bins, solid_angles(p));
    put_one(json, "projected_area", &s->identity, 0);
    if (g->transmission) {
        put_transmission(p, s, one, inner);
        mu_json_object(json, "transmission", one);
    }
    if (!g->bounces) return;
    mu_json_list_begin(json, "reflection");
    for (int c = 0; c < mu_gathering_channels(g); c++) {
        put_reflection(p, s, c, one, inner);
        mu_json_list_add(json, one);
    }
    mu_json_list_end(json);
}

static void put_head(const mu_gathering *g, mu_json *json) {
    mu_json_number(json, "files", g->file_count);
    mu_json_number(json, "facets", g->total);
    mu_json_number(json, "points", (double)g->side * g->side);
    mu_json_string(json, "tracer", g->tracer->name);
    mu_json_numbers(json, "transform", g->m, 4);
    mu_json_number(json, "rings", g->bins.rings);
    mu_json_number(json, "sectors", g->bins.sectors);
    mu_json_string(json, "units", g->file_count > 1 ? "realisations" : "blocks");
    mu_json_number(json, "unit_count", (double)g->units);
    if (g->file_count == 1) mu_json_number(json, "block", g->block);
    mu_json_numbers(json, "correlation_length", g->correlation, 2);
}

static void put_all(mu_pages *p, mu_json *json, mu_json *one, mu_json *inner, mu_json *innermost) {
    const mu_gathering *g = p->g;
    const size_t bins = mu_directions_count(&g->bins);
    mu_json_begin(json);
    put_head(g, json);
    put_slopes(p, one);
    mu_json_object(json, "slopes", one);
    put_normals(p, one);
    mu_json_object(json, "normals", one);
    mu_json_list_begin(json, "views");
    for (uint32_t k = 0; k < g->view_count; k++) {
        put_view(p, &g->views[k], one, inner, innermost);
        mu_json_list_add(json, one);
    }
    mu_json_list_end(json);
    mu_json_list_begin(json, "pairs");
    for (uint32_t k = 0; k < g->pair_count; k++) {
        const mu_seen_pair *pair = &g->pairs[k];
        mu_json_begin(one);
        mu_json_number(one, "a", pair->a);
        mu_json_number(one, "b", pair->b);
        put_one(one, "G2_facet_mean", &pair->share, 0);
        put_many(p, one, "facing", &pair->facing, 0, bins, NULL);
        put_many(p, one, "G2", &pair->masking, 0, bins, NULL);
        mu_json_list_add(json, one);
    }
    mu_json_list_end(json);
}

_Bool mu_gathering_report(const mu_gathering *g) {
    const size_t bins = mu_directions_count(&g->bins), cells = (size_t)g->slope_cells * g->slope_cells;
    const size_t most = bins > cells ? bins : cells;
    mu_pages pages = {g, malloc(most * sizeof(double)), malloc(most * sizeof(double)),
                      malloc(most * sizeof(double))};
    mu_json json = {0}, one = {0}, inner = {0}, innermost = {0};
    if (pages.values && pages.errors && pages.scale)
        put_all(&pages, &json, &one, &inner, &innermost);
    else
        json.no_memory = 1;
    const _Bool good = mu_json_write(&json, stdout);
    mu_json_free(&json), mu_json_free(&one), mu_json_free(&inner), mu_json_free(&innermost);
    free(pages.values), free(pages.errors), free(pages.scale);
    return good;
}
