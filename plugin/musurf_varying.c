/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_varying.c: which parts of the shape come from slots, and the M that they make. Shading is in float, M is made in
 * double: products of four factors, and once a hit. */
#include "plugin/musurf_varying.h"

#include <math.h>

#include "plugin/musurf_given.h"

/* Whose alpha is a scale of slopes, so that a uniform M does what another alpha does; it would scale a tilt, too. */
static int alpha_is_a_scale(const mu_definition *d) {
    const mu_ndf ndf = d->ndf;
    if (d->tilt[0] != 0 || d->tilt[1] != 0) return 0;
    return ndf == MU_GGX || ndf == MU_BECKMANN || ndf == MU_STD || ndf == MU_DISCRETE_GGX ||
           ndf == MU_DISCRETE_BECKMANN;
}

static musurf_varying_number number_of(const given *g, uint32_t id) {
    musurf_varying_number out = {.value = musurf_number(g, id)};
    if (musurf_varies(g, id)) out.varies = 1, out.slot = g->by_id[id]->slot;
    return out;
}

static musurf_varying_number alpha_of(const given *g, const mu_definition *d) {
    const uint32_t id = g->by_id[ROUGHNESS] ? ROUGHNESS : ALPHA;
    musurf_varying_number out = number_of(g, id);
    out.value = d->alpha, out.squared = id == ROUGHNESS;
    return out;
}

static musurf_result refuse(const given *g, uint32_t id, const char *why) {
    return musurf_fail(g->host, MUSURF_UNSUPPORTED, id, "cannot vary here: %s", why);
}

/* What M cannot do. */
static musurf_result check(const given *g, const mu_definition *d, int ellipsoid, int system) {
    const uint32_t rough = g->by_id[ROUGHNESS] ? ROUGHNESS : ALPHA;
    if (ellipsoid)
        for (uint32_t id = ALPHA; id <= ALPHA_Y; id++)
            if ((id == ALPHA || id == ROUGHNESS || id >= ALPHA_X) && musurf_varies(g, id))
                return refuse(g, id, "an ellipsoid's axes are constant, transform and stretch may vary");
    if (!alpha_is_a_scale(d)) {
        if (musurf_varies(g, rough))
            return refuse(g, rough,
                          "of ggx, beckmann, std and the discrete ones, without tilt, alpha is a scale of "
                          "slopes, here it "
                          "also changes the shape; alpha_x and alpha_y may vary beside a constant alpha");
        const uint32_t along = musurf_varies(g, ALPHA_X) ? ALPHA_X : ALPHA_Y;
        if (musurf_varies(g, along) && d->ndf != MU_PHONG && !g->by_id[rough])
            return refuse(g, along,
                          "the shape depends on alpha, too, which has to be set, constant, beside it");
    }
    if (musurf_varies(g, rough) && (system == GLTF || system == COVARIANCE))
        return refuse(g, rough, "the anisotropy beside it is one of a constant alpha");
    return MUSURF_OK;
}

/* Of alpha_x: itself, or what it is by default. */
static musurf_varying_number along_of(const given *g, const mu_definition *d, uint32_t id, uint32_t other) {
    if (g->by_id[id]) return number_of(g, id);
    if (g->by_id[ALPHA] || g->by_id[ROUGHNESS]) return alpha_of(g, d);
    return number_of(g, other);
}

musurf_result musurf_varying_parse(const given *g, const mu_definition *d, int ellipsoid, const double own[4],
                                   musurf_varying *out) {
    int system = 0;
    for (uint32_t id = DISNEY; id <= COVARIANCE; id++)
        if (g->by_id[id]) system = (int)id;
    const musurf_result result = check(g, d, ellipsoid, system);
    if (result != MUSURF_OK) return result;
    *out = (musurf_varying){.along = !ellipsoid && (g->by_id[ALPHA_X] || g->by_id[ALPHA_Y]),
                            .stretch = number_of(g, STRETCH)};
    out->transform_varies = musurf_varies(g, TRANSFORM);
    if (out->transform_varies) out->transform_slot = g->by_id[TRANSFORM]->slot;
    musurf_numbers(g, TRANSFORM, 4, out->transform);
    for (int i = 0; i < 4; i++) out->own[i] = own[i];
    out->base = d->ndf == MU_PHONG ? mu_slope_width(d) : d->alpha;
    if (ellipsoid) return MUSURF_OK;
    out->alpha = alpha_of(g, d);
    out->rotation = number_of(g, ROTATION);
    if (out->along) out->x = along_of(g, d, ALPHA_X, ALPHA_Y), out->y = along_of(g, d, ALPHA_Y, ALPHA_X);
    return MUSURF_OK;
}

uint32_t musurf_varying_slots(const musurf_varying *v) {
    const musurf_varying_number *const numbers[] = {&v->stretch, &v->rotation, &v->alpha, &v->x, &v->y};
    uint32_t most = v->transform_varies ? v->transform_slot + 4 : 0;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (numbers[i]->varies && numbers[i]->slot + 1 > most) most = numbers[i]->slot + 1;
    return most;
}

static double at(const musurf_varying_number *n, const float *slots) {
    if (!n->varies) return n->value;
    const double value = (double)slots[n->slot];
    return n->squared ? value * value : value;
}

static double rough(const musurf_varying_number *n, const float *slots) {
    return fmin(fmax(at(n, slots), 1e-6), 1e6);
}

/* out = a b, rows. */
static void multiply(const double a[4], const double b[4], double out[4]) {
    for (int i = 0; i < 4; i++) out[i] = a[i / 2 * 2] * b[i % 2] + a[i / 2 * 2 + 1] * b[2 + i % 2];
}

/* R A R^T */
static void turn(double angle, double a[4]) {
    const double c = cos(angle), s = sin(angle), r[4] = {c, -s, s, c}, back[4] = {c, s, -s, c};
    double half[4];
    multiply(r, a, half);
    multiply(half, back, a);
}

void musurf_varying_compose(const musurf_varying *v, const float *slots, float m[4]) {
    double own[4] = {v->own[0], v->own[1], v->own[2], v->own[3]}, half[4], whole[4], transform[4];
    if (v->along) {
        own[0] = v->base / rough(&v->x, slots), own[3] = v->base / rough(&v->y, slots);
        own[1] = own[2] = 0;
    } else if (v->alpha.varies) {
        const double scale = v->base / rough(&v->alpha, slots);
        for (int i = 0; i < 4; i++) own[i] *= scale;
    }
    /* of what does not vary, `own` is turned already */
    if (v->rotation.varies || (v->along && v->rotation.value != 0)) turn(at(&v->rotation, slots), own);
    const double s = fmin(fmax(at(&v->stretch, slots), -1 + 1e-6), 1 - 1e-6),
                 q = s >= 0 ? 1 - s : 1 / (1 + s);
    for (int i = 0; i < 4; i++) half[i] = i < 2 ? own[i] / q : own[i] * q; /* Eq. (31) */
    for (int i = 0; i < 4; i++)
        transform[i] = v->transform_varies ? (double)slots[v->transform_slot + (uint32_t)i] : v->transform[i];
    multiply(transform, half, whole);
    for (int i = 0; i < 4; i++) m[i] = (float)whole[i];
}
