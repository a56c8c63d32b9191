/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* albedo.c: makes the tables of albedo.h, from the very surface that they complete, and draws from their lobe. */
#include "core/bsdf/multiple.h"
#include "core/bsdf/random.h"
#include "core/bsdf/singular.h"

#if MU_REAL_BITS == 24

/* Places per side and cell at which the lobe is integrated, and walks that tell where light leaves. */
enum { WITHIN = 4, WALKS = 2048 };
static const double smallest = 1e-12; /* singular value of L, lest it leave float's range */
static const float least = 1e-7f;     /* what is lost at least: the lobe exists everywhere */

void mu_albedo_direction(const mu_albedo *t, float a, float b, float w[3]) {
    const float half = (float)t->cells / 2, x = a / half - 1, y = b / half - 1;
    const float p[2] = {(x + y) / 2, (x - y) / 2}, s = fminf(fabsf(p[0]) + fabsf(p[1]), 1);
    const float ln_z = t->power * log1pf(-s), z = fmaxf(expf(ln_z), t->horizon);
    const float slope = s > 0 ? -expm1f(fmaxf(ln_z, -100)) / s : t->power;
    const float q[2] = {p[0] * slope, p[1] * slope};
    w[0] = t->from[0] * q[0] + t->from[1] * q[1];
    w[1] = t->from[2] * q[0] + t->from[3] * q[1];
    w[2] = z;
    const float length = hypotf(hypotf(w[0], w[1]), w[2]);
    for (int k = 0; k < 3; k++) w[k] /= length;
}

void mu_albedo_draw(const mu_albedo *t, const mu_albedo_side *s, float u0, float u1, float w[3]) {
    const int cells = t->cells;
    int low = 0, high = cells * cells - 1;
    while (low < high) { /* the first cell whose sum is above u0 */
        const int middle = (low + high) / 2;
        if (s->cumulative[middle] > u0) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    const float before = low ? s->cumulative[low - 1] : 0,
                within = (u0 - before) / (s->cumulative[low] - before);
    mu_albedo_direction(t, (float)(low / cells) + fminf(within, 1), (float)(low % cells) + u1, w);
}

/* L from V = s M^-1, s the slope unit: what is rougher than 1 along an axis is bounded. */
static void lay(const surface *s, const mu_definition *d, mu_albedo *t) {
    double largest = 0, m[4];
    for (int i = 0; i < 4; i++) largest = fmax(largest, fabs(d->transform[i]));
    for (int i = 0; i < 4; i++) m[i] = d->transform[i] / largest;
    const double adjoint[4] = {m[3], -m[1], -m[2], m[0]};
    const singular v = singular_of(adjoint);
    const double scale = s->unit / (fabs(product_difference(m[0], m[3], m[1], m[2])) * largest);
    const double wide = fmin(fmax(v.large * scale, smallest), 1),
                 narrow = fmin(fmax(fabs(v.small) * scale, smallest), 1);
    const double other = copysign(narrow / wide, v.small);
    double to[4], from[4];
    singular_matrix(&v, 1, other, to, from);
    for (int i = 0; i < 4; i++) t->to[i] = (float)to[i], t->from[i] = (float)from[i];
    t->det = (float)fabs(other);
    t->power = (float)fmax(log(wide) / log(0.45), 3);
    t->horizon = (float)(1e-7 * wide);
}

static void fill_lost(const surface *s, const mu_definition *d, const mu_albedo *t, float side,
                      mu_albedo_side *out) {
    /* leaves what is level and isotropic before M as it is */
    const int half_turn = s->tilt[0] == 0 && s->tilt[1] == 0 && !(s->general->traits & ANISOTROPIC);
    const int nodes = t->cells + 1, count = nodes * nodes;
    for (int i = 0; i < count; i++) {
        float w[3];
        if (half_turn && i > count / 2) {
            out->lost[i] = out->lost[count - 1 - i];
            continue;
        }
        mu_albedo_direction(t, (float)(i / nodes), (float)(i % nodes), w);
        for (int k = 0; k < 3; k++) w[k] *= side;
        out->lost[i] = fmaxf(1 - MU(albedo_integral)(s, d, w), least);
    }
}

/* The lobe's shares by cell, and its average: of what is interpolated, so that no light is lost or made. */
static void fill_lobe(const mu_albedo *t, mu_albedo_side *out) {
    const int cells = t->cells, count = cells * cells;
    double total = 0, cosines = 0;
    for (int cell = 0; cell < count; cell++) {
        double sum = 0;
        for (int i = 0; i < WITHIN * WITHIN; i++) {
            float w[3];
            mu_albedo_direction(t, (float)(cell / cells) + ((float)(i / WITHIN) + 0.5f) / WITHIN,
                                (float)(cell % cells) + ((float)(i % WITHIN) + 0.5f) / WITHIN, w);
            const albedo_place at = albedo_locate(t, w);
            const double solid = (double)w[2] / (double)at.stretch;
            sum += (double)albedo_lost(t, out, at) * solid;
            cosines += solid;
        }
        out->cumulative[cell] = (float)sum;
        total += sum;
    }
    out->average = (float)(total / cosines);
    double so_far = 0;
    for (int cell = 0; cell < count; cell++) {
        so_far += (double)out->cumulative[cell] / total;
        out->cumulative[cell] = (float)so_far;
    }
    out->cumulative[count - 1] = 1;
}

/* Of what meets two facets or more and leaves, the share that leaves on the upper side, under uniform light from above:
 * walks from cosine-distributed directions. */
static double share_above(const surface *s) {
    multiple with = {0};
    MU(multiple_average)(s, with.average);
    double above = 0, all = 0;
    for (int i = 0; i < WALKS; i++) {
        const float u0 = ((float)i + 0.5f) / WALKS, u1 = (float)fmod(i * 0.61803398874989485, 1);
        const float sine = sqrtf(u0), phi = (float)(2 * PI) * u1;
        const float wo[3] = {sine * cosf(phi), sine * sinf(phi), sqrtf(1 - u0)}, u[3] = {u0, u1, 0.5f};
        closure c;
        walk_end end;
        if (!MU(mu_bind)(s, wo, NULL, &c)) continue;
        MU(walk_trace)(c.kernel, &c, &with, u, &end);
        if (end.bounces < 2 || !(end.i[2] > 0)) continue;
        all++;
        if (!end.transmitted) above++;
    }
    return all > 0 ? above / all : 0.5;
}

/* What the tables are made of: in float's range, where tables do not change any more with the roughness. */
static mu_definition reduced(const mu_definition *d) {
    mu_definition single = *d;
    single.multiple = MU_SINGLE;
    single.sampler = MU_SAMPLE_VISIBLE;
    if (!d->transmission) single.fresnel = MU_FRESNEL_NONE;
    return single;
}

size_t mu_albedo_scratch(const mu_definition *d) {
    const mu_definition single = reduced(d);
    return MU(mu_surface_bytes)(&single);
}

void mu_albedo_make(const mu_definition *d, mu_albedo *t, void *scratch) {
    const mu_definition single = reduced(d);
    const surface *s = MU(mu_surface_make)(&single, scratch);
    lay(s, d, t);
    t->cells = d->compensation_cells;
    const int sides = d->transmission ? 2 : 1, nodes = t->cells + 1;
    for (int i = 0; i < sides; i++) {
        t->side[i].lost = t->values + (size_t)i * albedo_side_values(t->cells);
        t->side[i].cumulative = t->side[i].lost + nodes * nodes;
        fill_lost(s, d, t, i ? -1.0f : 1.0f, &t->side[i]);
        fill_lobe(t, &t->side[i]);
        t->side[i].passes = 0;
    }
    if (!d->transmission) return;
    /* passes average is the same from both sides but for eta², or the surface were not reciprocal */
    const double eta2 = d->dielectric * d->dielectric, above = (double)t->side[0].average,
                 below = (double)t->side[1].average * eta2;
    const double passes = fmin((1 - share_above(s)) * above, fmin(above, below));
    t->side[0].passes = (float)(passes / above);
    t->side[1].passes = (float)(passes / below);
}

#endif
