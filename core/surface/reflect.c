/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* reflect.c: mirrors, the histogram of where they send light, and Eq. (11f) by sorting them. */
#include "core/surface/reflect.h"

#include <math.h>
#include <string.h>

double mu_facet_mirror(const mu_heightfield *f, const double m[4], const double w[3], uint32_t i, uint32_t j,
                       int upper, double normal[3], double r[3]) {
    double s[2];
    mu_facet_slope(f, i, j, upper, s);
    mu_facet_normal(m, s, normal);
    const double macro =
        normal[2]; /* |det M|: twice the area over the plane, as `normal` is twice the facet's */
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int k = 0; k < 3; k++) normal[k] /= length;
    const double cosine = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
    for (int k = 0; k < 3; k++) r[k] = 2 * cosine * normal[k] - w[k];
    return cosine > 0 ? cosine * length / (2 * macro * w[2] * f->nx * f->ny) : 0;
}

void mu_reflect_row(const mu_caster *caster, const mu_heightfield *f, const double m[4], const double w[3],
                    int upper, uint32_t i, const uint8_t *seen, uint8_t *both) {
    mu_sight sight = {.m = {m[0], m[1], m[2], m[3]}, .u = upper ? 0.75 : 0.25, .v = 0.5, .upper = upper};
    for (uint32_t j = 0; j < f->ny; j++) {
        double normal[3];
        both[j] = seen[j] && mu_facet_mirror(f, m, w, i, j, upper, normal, sight.w) > 0 && sight.w[2] > 0 &&
                  mu_caster_sees(caster, &sight, i, j);
    }
}

double mu_reflection_density(const mu_heightfield *f, const double m[4], const double w[3],
                             const uint8_t *const both[2], const mu_directions *d, double *out) {
    double albedo = 0, normal[3], r[3];
    memset(out, 0, (mu_directions_count(d) + 1) * sizeof *out);
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++)
            for (int upper = 0; upper < 2; upper++) {
                if (!both[upper][(size_t)i * f->ny + j]) continue;
                const double weight = mu_facet_mirror(f, m, w, i, j, upper, normal, r);
                out[mu_directions_bin(d, r)] += weight;
                albedo += weight;
            }
    for (size_t k = 0; k < mu_directions_count(d); k++) out[k] /= mu_directions_projected(d, k);
    return albedo;
}

void mu_group_facets(const mu_heightfield *f, const double m[4], const double w[3],
                     const uint8_t *const both[2], const mu_directions *d, mu_group *groups) {
    double normal[3], r[3];
    memset(groups, 0, (mu_directions_count(d) + 1) * sizeof *groups);
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++)
            for (int upper = 0; upper < 2; upper++) {
                if (!both[upper][(size_t)i * f->ny + j]) continue;
                const double weight = mu_facet_mirror(f, m, w, i, j, upper, normal, r);
                mu_group *group = &groups[mu_directions_bin(d, normal)];
                for (int k = 0; k < 3; k++) group->normal[k] += weight * normal[k];
                group->weight += weight;
            }
}

_Bool mu_group_normal(const mu_group *group, double mean[3]) {
    const double *n = group->normal, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3 && length > 0; k++) mean[k] = n[k] / length;
    return length > 0;
}

double mu_reflect_groups(const mu_group *groups, size_t count, const double w[3],
                         const mu_lighting *lighting) {
    double sum = 0;
    for (size_t k = 0; k < count; k++) {
        double n[3], r[3];
        if (!mu_group_normal(&groups[k], n)) continue;
        const double cosine = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
        for (int c = 0; c < 3; c++) r[c] = 2 * cosine * n[c] - w[c]; /* Eq. (12a) */
        sum += groups[k].weight * lighting->fresnel(lighting->context, cosine) *
               lighting->radiance(lighting->context, r);
    }
    return sum;
}
