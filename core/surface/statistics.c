/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* statistics.c: histograms of slopes, normals and visible normals. */
#include "core/surface/statistics.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

void mu_slope_shares(const mu_heightfield *f, int upper, const mu_slope_law *law, uint32_t bins,
                     double *shares) {
    const double one = 1 / ((double)f->nx * f->ny);
    memset(shares, 0, bins * sizeof *shares);
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++) {
            double s[2];
            mu_facet_slope(f, i, j, upper, s);
            const double place = bins * mu_slope_share(law, sqrt(s[0] * s[0] + s[1] * s[1]));
            shares[place < bins - 1 ? (uint32_t)place : bins - 1] += one;
        }
}

double mu_slope_deviation(const mu_heightfield *f, int upper, const mu_slope_law *law, uint32_t bins) {
    double shares[256], sum = 0;
    mu_slope_shares(f, upper, law, bins, shares);
    for (uint32_t k = 0; k < bins; k++) sum += (shares[k] * bins - 1) * (shares[k] * bins - 1);
    return sqrt(sum / bins);
}

size_t mu_directions_count(const mu_directions *d) {
    return (size_t)d->rings * d->sectors;
}

size_t mu_directions_bin(const mu_directions *d, const double w[3]) {
    const double theta = atan2(sqrt(w[0] * w[0] + w[1] * w[1]), w[2]);
    const double phi = atan2(w[1], w[0]), turn = phi < 0 ? phi / (2 * pi) + 1 : phi / (2 * pi);
    const double ring = d->rings * theta / d->theta_most, sector = d->sectors * turn;
    if (!(ring < d->rings)) return mu_directions_count(d);
    return (size_t)ring * d->sectors + (sector < d->sectors ? (size_t)sector : d->sectors - 1);
}

double mu_directions_solid_angle(const mu_directions *d, size_t bin) {
    const double ring = (double)(bin / d->sectors), step = d->theta_most / d->rings;
    /* cos a - cos b without cancellation */
    return 2 * pi / d->sectors * 2 * sin((ring + 0.5) * step) * sin(0.5 * step);
}

double mu_directions_projected(const mu_directions *d, size_t bin) {
    const double ring = (double)(bin / d->sectors), step = d->theta_most / d->rings;
    const double a = sin(ring * step), b = sin((ring + 1) * step);
    return pi / d->sectors * (b - a) * (b + a);
}

static void per_solid_angle(const mu_directions *d, double *out) {
    for (size_t k = 0; k < mu_directions_count(d); k++) out[k] /= mu_directions_solid_angle(d, k);
}

void mu_normal_density(const mu_heightfield *f, const double m[4], const mu_directions *d, double *out) {
    const double one = 1 / (2 * (double)f->nx * f->ny);
    memset(out, 0, (mu_directions_count(d) + 1) * sizeof *out);
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++)
            for (int upper = 0; upper < 2; upper++) {
                double s[2], normal[3];
                mu_facet_slope(f, i, j, upper, s);
                mu_facet_normal(m, s, normal);
                const double area =
                    sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
                out[mu_directions_bin(d, normal)] += one * area / normal[2];
            }
    per_solid_angle(d, out);
}

void mu_visible_density(const mu_heightfield *f, const double m[4], const double w[3],
                        const double *const visible[2], const mu_directions *d, double *out) {
    const double one = 1 / (2 * (double)f->nx * f->ny * fabs(m[0] * m[3] - m[1] * m[2]) * w[2]);
    memset(out, 0, (mu_directions_count(d) + 1) * sizeof *out);
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++)
            for (int upper = 0; upper < 2; upper++) {
                double s[2], normal[3];
                mu_facet_slope(f, i, j, upper, s);
                mu_facet_normal(m, s, normal);
                const double facing = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
                if (facing > 0)
                    out[mu_directions_bin(d, normal)] += one * facing * visible[upper][(size_t)i * f->ny + j];
            }
    per_solid_angle(d, out);
}

void mu_spread_add(mu_spread *spread, double value) {
    spread->count++;
    const double change = value - spread->mean;
    spread->mean += change / spread->count;
    spread->squares += change * (value - spread->mean);
}

double mu_spread_error(const mu_spread *spread) {
    return spread->count > 1 ? sqrt(spread->squares / (spread->count - 1) / spread->count) : (double)NAN;
}
