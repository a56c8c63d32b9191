/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * sphere_table.c: builds and inverts the cumulative distributions of sphere_table.h.
 *
 * The probability of a cell is by definition the difference of the stored bounds, so the pdf is that of the
 * sampler, not of what the bounds were rounded from.
 */
#include "core/render/sphere_table.h"

#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* The least share of a positive cell in its row, and of a positive row in the whole. Bounds near 1 are spaced
 * by 2^-24, so four of those keep the share from being rounded away; thousands of them together are still
 * below 1 %. */
#define LEAST_SHARE 0x1p-22

static _Bool allocate(mu_distribution *distribution, uint32_t count) {
    distribution->count = count;
    distribution->buckets = count / 2 + 1;
    distribution->bounds = calloc((size_t)count + 1, sizeof *distribution->bounds);
    distribution->guide = calloc((size_t)distribution->buckets + 1, sizeof *distribution->guide);
    return distribution->bounds && distribution->guide;
}

static void release(mu_distribution *distribution) {
    free(distribution->bounds);
    free(distribution->guide);
}

/* Bounds from shares, whose sum is above 0. Accumulated in double, rounded once. */
static void fill(mu_distribution *distribution, const double *shares, double sum) {
    float *bounds = distribution->bounds;
    const uint32_t count = distribution->count, buckets = distribution->buckets;
    double raised = 0, total = 0;
    for (uint32_t i = 0; i < count; i++) raised += shares[i] > 0 ? fmax(shares[i], sum * LEAST_SHARE) : 0;
    for (uint32_t i = 0; i < count; i++) {
        bounds[i] = (float)(total / raised);
        total += shares[i] > 0 ? fmax(shares[i], sum * LEAST_SHARE) : 0;
    }
    bounds[count] = 1;
    /* Empty cells at the end begin at the total, which must not fall short of 1. */
    for (uint32_t i = count; i-- > 0 && !(shares[i] > 0);) bounds[i] = 1;
    for (uint32_t k = 0, cell = 0; k <= buckets; k++) {
        while (cell + 1 < count && (double)bounds[cell + 1] * buckets <= k) cell++;
        distribution->guide[k] = cell;
    }
}

/* The cell with bounds[cell] <= u < bounds[cell + 1], which is never empty, and the place in it. */
static uint32_t find(const mu_distribution *distribution, float u, float *within) {
    const float *bounds = distribution->bounds;
    const uint32_t *guide = distribution->guide, buckets = distribution->buckets;
    uint32_t bucket = (uint32_t)(u * (float)buckets);
    if (bounds[guide[bucket]] > u)
        bucket--; /* the product was rounded up, to the next bucket or past the last */
    const uint32_t first = guide[bucket], last = guide[bucket < buckets ? bucket + 1 : bucket];
    return mu_cdf_find(bounds, first, last, u, within);
}

static float share(const mu_distribution *distribution, uint32_t cell) {
    return distribution->bounds[cell + 1] - distribution->bounds[cell];
}

/* Whether a row is measured from the +z pole; so is the one across the equator, if there is one. */
static _Bool in_north(uint32_t row, uint32_t height) {
    return row < (height + 1) / 2;
}

static mu_sphere_row row_of(uint32_t row, uint32_t width, uint32_t height) {
    const uint32_t from_its_pole = in_north(row, height) ? row : height - 1 - row;
    /* 1 - cos theta = 2 sin^2(theta / 2), without cancellation at the pole. */
    const double a = sin(PI * from_its_pole / (2.0 * height)),
                 b = sin(PI * (from_its_pole + 1) / (2.0 * height));
    const double span = 2 * (b - a) * (b + a);
    return (mu_sphere_row){(float)(2 * a * a), (float)span, (float)(width / (2 * PI * span))};
}

static _Bool build(mu_sphere_table *table, const float *radiance, double *shares, double *row_shares) {
    double sum = 0;
    for (uint32_t row = 0; row < table->height; row++) {
        double row_sum = 0;
        for (size_t i = 0; i < table->width; i++)
            row_sum += shares[i] = (double)radiance[row * (size_t)table->width + i];
        table->rows[row] = row_of(row, table->width, table->height);
        row_shares[row] = row_sum * (double)table->rows[row].span;
        sum += row_shares[row];
        if (!allocate(&table->across[row], table->width)) return 0;
        if (row_sum > 0) fill(&table->across[row], shares, row_sum);
    }
    if (!allocate(&table->down, table->height)) return 0;
    if (sum > 0)
        fill(&table->down, row_shares, sum);
    else
        mu_sphere_table_free(table);
    return 1;
}

_Bool mu_sphere_table_make(mu_sphere_table *table, uint32_t width, uint32_t height, const float *radiance,
                           mu_error *error) {
    *table = (mu_sphere_table){.width = width, .height = height};
    table->across = calloc(height, sizeof *table->across);
    table->rows = calloc(height, sizeof *table->rows);
    double *shares = calloc(width, sizeof *shares), *row_shares = calloc(height, sizeof *row_shares);
    const _Bool made =
        table->across && table->rows && shares && row_shares && build(table, radiance, shares, row_shares);
    free(shares);
    free(row_shares);
    if (made) return 1;
    mu_sphere_table_free(table);
    return mu_fail(error, "not enough memory for the sampling table of an environment of %u x %u", width,
                   height);
}

void mu_sphere_table_free(mu_sphere_table *table) {
    for (uint32_t row = 0; table->across && row < table->height; row++) release(&table->across[row]);
    release(&table->down);
    free(table->across);
    free(table->rows);
    memset(table, 0, sizeof *table);
}

static float density(const mu_sphere_table *table, uint32_t row, uint32_t column) {
    return share(&table->down, row) * share(&table->across[row], column) * table->rows[row].inverse_cell;
}

void mu_sphere_table_sample(const mu_sphere_table *table, const float u[2], mu_sphere_point *out) {
    if (!table->height) {
        *out = (mu_sphere_point){.pdf = 0, .direction = {0, 0, 1}};
        return;
    }
    float along, below;
    const uint32_t row = find(&table->down, u[1], &below);
    const uint32_t column = find(&table->across[row], u[0], &along);
    const mu_sphere_row *ring = &table->rows[row];
    const _Bool north = in_north(row, table->height);
    const float from_pole = ring->from_pole + ring->span * (north ? below : 1 - below);
    const float theta = 2 * asinf(sqrtf(fminf(from_pole / 2, 1)));
    const float sine = sqrtf(fmaxf(from_pole * (2 - from_pole), 0));
    out->u = ((float)column + along) / (float)table->width;
    out->v = (north ? theta : (float)PI - theta) * (float)(1 / PI);
    const float phi = (float)PI * (1 - 2 * out->u);
    out->direction = mu_v3(sine * cosf(phi), sine * sinf(phi), north ? 1 - from_pole : from_pole - 1);
    out->pdf = density(table, row, column);
}

static uint32_t cell_of(float place, uint32_t count) {
    const uint32_t cell = (uint32_t)(place * (float)count);
    return cell < count ? cell : count - 1;
}

float mu_sphere_table_pdf(const mu_sphere_table *table, float u, float v) {
    if (!table->height) return 0;
    return density(table, cell_of(v, table->height), cell_of(u, table->width));
}

void mu_sphere_table_locate(mu_vec3 direction, float *u, float *v) {
    const float phi = atan2f(direction.y, direction.x);
    const float theta = atan2f(hypotf(direction.x, direction.y), direction.z);
    *u = fminf(fmaxf(0.5f - phi * (float)(0.5 / PI), 0), 1);
    *v = fminf(fmaxf(theta * (float)(1 / PI), 0), 1);
}
