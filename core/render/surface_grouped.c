/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_grouped.c: the light of a lamp, and Eq. (11f) of sorted facets, which ask for it once a group. */
#include <math.h>

#include "core/render/surface_statistics.h"
#include "core/surface/refract.h"

double mu_lamp_radiance(const mu_lamp *lamp, const double w[3]) {
    const double pi = 3.14159265358979323846;
    double chord = 0; /* 2 sin of half the angle between: no cancellation for narrow lamps */
    for (int k = 0; k < 3; k++) chord += (w[k] - lamp->l[k]) * (w[k] - lamp->l[k]);
    const double most = 2 * sin(lamp->radius / 2), sine = sin(lamp->radius);
    return chord <= most * most ? 1 / (pi * sine * sine * fabs(lamp->l[2])) : 0;
}

typedef struct mu_grouped {
    const mu_gathering *g;
    const mu_lamp *lamp;
    int channel;
} mu_grouped;

static double fresnel_of(void *context, double cosine) {
    const mu_grouped *at = context;
    return mu_reflectance_at(&at->g->reflectance, at->channel, fmin(cosine, 1));
}

static double radiance_of(void *context, const double w[3]) {
    return mu_lamp_radiance(((const mu_grouped *)context)->lamp, w);
}

double mu_gathering_grouped(const mu_gathering *g, const mu_seen *seen, uint32_t lamp, int channel) {
    mu_grouped at = {g, &g->lamps[lamp], channel};
    const mu_lighting lighting = {fresnel_of, radiance_of, &at};
    const size_t count = mu_directions_count(&g->finer) + 1;
    double light = 0;
    for (size_t k = 0; k < g->units; k++) light += seen->identity.top[k];
    return (mu_lamp_below(&g->lamps[lamp])
                ? mu_refract_groups(seen->through.groups, count, seen->unit, g->reflectance.a[0], &lighting)
                : mu_reflect_groups(seen->groups, count, seen->unit, &lighting)) /
           light;
}
