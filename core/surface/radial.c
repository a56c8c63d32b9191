/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* radial.c: tables of ln P22 and of the share above, from D of the library's own distributions. */
#include "core/surface/radial.h"

static const double two_pi = 6.28318530717958647693;

static mu_definition plain(const mu_definition *given) {
    mu_definition d = mu_definition_default();
    d.ndf = given->ndf;
    d.alpha = given->alpha;
    d.gamma = given->gamma;
    d.exponent = given->exponent;
    return d;
}

size_t mu_radial_bytes(const mu_definition *definition) {
    const mu_definition d = plain(definition);
    return mu_surface_bytes_d(&d);
}

static double node(int k) {
    return mu_radial_first + k * mu_radial_step;
}

/* ln P22 at the nodes. */
static void ask(mu_radial *out, const mu_closure_d *c) {
    int good = MU_RADIAL;
    for (int k = 0; k < MU_RADIAL; k++) {
        const double r = exp(node(k)), cosine = 1 / sqrt(1 + r * r), normal[3] = {-r * cosine, 0, cosine};
        const double d = mu_normal_d(c, normal).D;
        out->value[k] = d > 1e-280 ? log(d) + 4 * log(cosine) : -INFINITY;
        if (k > 1 && d <= 1e-280 && good == MU_RADIAL && out->value[k - 1] > -INFINITY) good = k;
    }
    if (good == MU_RADIAL) return;
    const double a = exp(2 * node(good - 2)), b = exp(2 * node(good - 1));
    const double per = (out->value[good - 1] - out->value[good - 2]) / (b - a), from = out->value[good - 1];
    for (int k = good; k < MU_RADIAL; k++) out->value[k] = from + per * (exp(2 * node(k)) - b);
}

/* A density that vanishes at 0 may be too small for a double there: a power goes on. */
static _Bool mend(double *v) {
    int first = 0;
    while (first < MU_RADIAL - 1 && v[first] == -INFINITY) first++;
    if (first > MU_RADIAL - 3) return 0;
    for (int k = first - 1; k >= 0; k--) v[k] = 2 * v[k + 1] - v[k + 2];
    return 1;
}

static void derive(mu_radial *out) {
    const double *v = out->value, h = mu_radial_step;
    const int last = MU_RADIAL - 1;
    for (int k = 2; k < last - 1; k++)
        out->slope[k] = (8 * (v[k + 1] - v[k - 1]) - (v[k + 2] - v[k - 2])) / (12 * h);
    out->slope[1] = (v[2] - v[0]) / (2 * h);
    out->slope[last - 1] = (v[last] - v[last - 2]) / (2 * h);
    out->slope[0] = (-3 * v[0] + 4 * v[1] - v[2]) / (2 * h);
    out->slope[last] = (3 * v[last] - 4 * v[last - 1] + v[last - 2]) / (2 * h);
}

/* Facets per unit of ln r. */
static double per_ln(double ln_p, double x) {
    return two_pi * exp(2 * x + ln_p);
}

static void integrate(mu_radial *out) {
    const int last = MU_RADIAL - 1;
    const double power = -2 - out->slope[last]; /* r^2 P22 falls as r^-power beyond the last node */
    out->above[last] = power > 0 ? per_ln(out->value[last], node(last)) / power : 0;
    for (int k = last - 1; k >= 0; k--) {
        const mu_radial_place middle = mu_radial_find(node(k) + mu_radial_step / 2);
        out->above[k] =
            out->above[k + 1] + mu_radial_step / 6 *
                                    (per_ln(out->value[k], node(k)) + per_ln(out->value[k + 1], node(k + 1)) +
                                     4 * per_ln(mu_radial_value(out, &middle), node(k) + mu_radial_step / 2));
    }
}

_Bool mu_radial_make(mu_radial *out, const mu_definition *definition, void *memory) {
    const mu_definition d = plain(definition);
    const double up[3] = {0, 0, 1};
    mu_complaint why;
    mu_closure_d c;
    if (!memory || !mu_definition_check(&d, &why)) return 0;
    const mu_surface_d *surface = mu_surface_make_d(&d, memory);
    if (!mu_bind_d(surface, up, NULL, &c)) return 0;
    ask(out, &c);
    if (!mend(out->value)) return 0;
    derive(out);
    integrate(out);
    return 1;
}

double mu_radial_above(const mu_radial *table, double x) {
    const double *a = table->above, h = mu_radial_step;
    const double place = (x - mu_radial_first) / h;
    if (!(place > 0)) return a[0];
    if (place >= MU_RADIAL - 1) {
        const double power = fmax(-2 - table->slope[MU_RADIAL - 1], 0);
        return a[MU_RADIAL - 1] * exp(-power * (x - node(MU_RADIAL - 1)));
    }
    const int k = (int)place;
    const double t = place - k, u = 1 - t;
    return u * u * (1 + 2 * t) * a[k] + t * t * (1 + 2 * u) * a[k + 1] -
           h * t * u * (u * per_ln(table->value[k], node(k)) - t * per_ln(table->value[k + 1], node(k + 1)));
}
