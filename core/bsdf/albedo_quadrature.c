/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_quadrature.c: the directional albedo of single scattering, of any distribution under any map, by quadrature. No
 * random numbers: tables must be smooth. Not in the papers.
 *
 * With m = (mu, 1) the unnormalised micronormal, mu affine in the slope u of the distribution's own space, and
 * P22 du = D cos_m dm, integrating f cos over the light's directions comes to
 *
 *     E(wo) = 1/cos_o  integral of P22(u) max(0, wo.(mu, 1)) [F G2(wo, reflected) + (1 - F) G2(wo, refracted)] du
 *
 * in polar coordinates of u, by Gauss's rule in azimuth, in the halves that face the viewer and do not (at grazing view the
 * integrand has an edge between), and in t = asinh(length / core), which is linear in the core of a distribution and
 * logarithmic in its tail. Along each azimuth the facets that reflect wo upwards lie where
 * cos_o |mu|² - 2 wo.mu - cos_o < 0; those that face it lie on one side of a line, and total reflection begins on a conic:
 * between the roots of these the integrand is smooth.
 */
#include "core/bsdf/distribution.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/snell.h"

#if MU_REAL_BITS == 24

/* Halvings of a panel of azimuths, at most. */
enum { DEEPEST = 8 };

/* Gauss-Legendre on [0, 1], 8 nodes (Abramowitz and Stegun, table 25.4). */
static const double node[8] = {0.01985507175123188, 0.10166676129318664, 0.2372337950418355,
                               0.4082826787521751,  0.5917173212478249,  0.7627662049581645,
                               0.8983332387068134,  0.9801449282487681};
static const double weight[8] = {0.05061426814518813, 0.11119051722668724, 0.15685332293894364,
                                 0.18134189168918100, 0.18134189168918100, 0.15685332293894364,
                                 0.11119051722668724, 0.05061426814518813};

/* One azimuth of slopes: mu = level + r along. */
typedef struct ray {
    const closure *c;
    double level[2], along[2];
    double panel; /* the widest in t */
} ray;

double MU(albedo_passed)(const closure *c, const double unit[3], double facing) {
    const float normal[3] = {(float)unit[0], (float)unit[1], (float)unit[2]};
    float i[3], F = 1;
    double sum = 0;
    if (c->surface->transmission) {
        F = MU(fresnel_dielectric)(c->eta, fminf((float)facing, 1));
        (void)refract(c->eta, c->wo, normal, (float)facing, i);
        if (F < 1 && i[2] > 0) sum += (double)((1 - F) * c->kernel->shadowing(c, i, 1));
    }
    for (int k = 0; k < 3; k++) i[k] = (float)(2 * facing * unit[k] - (double)c->wo[k]);
    if (i[2] > 0) sum += (double)(F * c->kernel->shadowing(c, i, 0));
    return sum;
}

static double integrand(const ray *l, double r) {
    const closure *c = l->c;
    const double m[3] = {l->level[0] + r * l->along[0], l->level[1] + r * l->along[1], 1};
    const double length2 = m[0] * m[0] + m[1] * m[1] + 1, length = sqrt(length2);
    const double seen = (double)c->wo[0] * m[0] + (double)c->wo[1] * m[1] + (double)c->wo[2];
    if (!(seen > 0)) return 0;
    const double unit[3] = {m[0] / length, m[1] / length, 1 / length};
    const float normal[3] = {(float)unit[0], (float)unit[1], (float)unit[2]};
    return (double)c->kernel->density(c, normal) / (length2 * length2) * (seen / (double)c->wo[2]) *
           MU(albedo_passed)(c, unit, seen / length);
}

/* The integral over r in [from, to], times r dr, panel by panel outwards until they add nothing to *sum. */
static void stretch(const ray *l, double core, double from, double to, double *sum) {
    const double t0 = asinh(from / core), t1 = asinh(to / core);
    if (!(t1 > t0)) return;
    const int panels = (int)ceil((t1 - t0) / l->panel);
    const double width = (t1 - t0) / panels;
    for (int i = 0; i < panels; i++) {
        double part = 0;
        for (int k = 0; k < 8; k++) {
            const double e = exp(t0 + width * (i + node[k])), r = core * (e - 1 / e) / 2;
            part += weight[k] * integrand(l, r) * r * core * (e + 1 / e) / 2;
        }
        *sum += part * width;
        if (part * width <= 1e-5 * *sum) return;
    }
}

/* Roots of a r² + 2 b r + c = 0, ascending; both 0 if there are none. */
static void roots(double a, double b, double c, double r[2]) {
    const double d = b * b - a * c, q = -(b + copysign(sqrt(fmax(d, 0)), b));
    const double x = d > 0 && a != 0 ? q / a : 0, y = d > 0 && q != 0 ? c / q : 0;
    r[0] = fmin(x, y), r[1] = fmax(x, y);
}

/* Its stretches between the places where the integrand has edges. */
static double azimuth(const ray *l, double core) {
    const closure *c = l->c;
    const double o[2] = {(double)c->wo[0], (double)c->wo[1]}, z = (double)c->wo[2], *at = l->level,
                 *by = l->along;
    const double o_by = o[0] * by[0] + o[1] * by[1], seen = o[0] * at[0] + o[1] * at[1] + z;
    const double at2 = at[0] * at[0] + at[1] * at[1], by2 = by[0] * by[0] + by[1] * by[1],
                 at_by = at[0] * by[0] + at[1] * by[1];
    const double most = core * 1e18;
    double edge[5], sum = 0;
    roots(z * by2, z * at_by - o_by, z * at2 - 2 * seen + z, edge); /* between: reflected upwards */
    for (int k = 0; k < 2; k++) edge[k] = fmin(fmax(edge[k], 0), most);
    if (!c->surface->transmission) {
        stretch(l, core, edge[0], edge[1], &sum);
        return sum;
    }
    /* seen + r o.along > 0: faces wo */
    const double line = o_by != 0 ? fmin(fmax(-seen / o_by, 0), most) : 0;
    double from = o_by > 0 ? line : 0;
    const double to = o_by < 0 ? line : most;
    /* (seen + r o.along)² = (1 - eta²) |m|²: total reflection begins */
    const double eta = (double)c->eta, k2 = fmax(1 - eta * eta, 0);
    roots(o_by * o_by - k2 * by2, seen * o_by - k2 * at_by, seen * seen - k2 * (1 + at2), edge + 2);
    edge[4] = to;
    for (int i = 0; i < 5; i++) { /* the nearest edge beyond `from`, five times */
        double next = to;
        for (int k = 0; k < 5; k++)
            if (edge[k] > from && edge[k] < next) next = edge[k];
        stretch(l, core, from, next, &sum);
        from = next;
    }
    return sum;
}

/* One panel of azimuths by 8 nodes. */
static double panel(ray *l, const double v[4], double core, double from, double width) {
    double sum = 0;
    for (int j = 0; j < 8; j++) {
        const double phi = from + width * node[j], u[2] = {cos(phi), sin(phi)};
        l->along[0] = v[0] * u[0] + v[2] * u[1], l->along[1] = v[1] * u[0] + v[3] * u[1];
        sum += weight[j] * azimuth(l, core);
    }
    return sum * width;
}

/* Halved until both halves agree with the whole: anisotropy, tilt and total reflection make some azimuths sharp. */
static double refine(ray *l, const double v[4], double core, double from, double width, double whole,
                     double allowed, int deeper) {
    const double half = width / 2, low = panel(l, v, core, from, half),
                 high = panel(l, v, core, from + half, half);
    if (fabs(low + high - whole) <= allowed || !deeper) return low + high;
    return refine(l, v, core, from, half, low, allowed / 2, deeper - 1) +
           refine(l, v, core, from + half, half, high, allowed / 2, deeper - 1);
}

float MU(albedo_integral)(const closure *c, double core, double allowed) {
    if (!(c->wo[2] > 0)) return 1;
    const double z = (double)c->map.view_z, v[4] = {(double)c->map.view[0] / z, (double)c->map.view[1] / z,
                                                    (double)c->map.view[2] / z, (double)c->map.view[3] / z};
    const double t[2] = {(double)c->map.tilt[0], (double)c->map.tilt[1]},
                 det = fabs(v[0] * v[3] - v[1] * v[2]);
    ray l = {.c = c, .panel = 2.5};
    l.level[0] = -(v[0] * t[0] + v[2] * t[1]), l.level[1] = -(v[1] * t[0] + v[3] * t[1]);
    const double facing = atan2(v[2] * (double)c->wo[0] + v[3] * (double)c->wo[1],
                                v[0] * (double)c->wo[0] + v[1] * (double)c->wo[1]);
    double sum = 0;
    for (int half = 0; half < 2; half++) {
        const double from = facing + PI * (half - 0.5), whole = panel(&l, v, core, from, PI);
        sum += refine(&l, v, core, from, PI, whole, allowed / (2 * det), DEEPEST);
    }
    return (float)fmin(sum * det, 1);
}

#endif
