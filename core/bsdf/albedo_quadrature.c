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
 * in polar coordinates of u, by Kronrod's rule in azimuth, in quarters that face the viewer or do not (at grazing view the
 * integrand has an edge between), and by Gauss's in t = asinh(length / core), which is linear in the core of a distribution and
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

/* Kronrod's extension of Gauss-Legendre by 5 nodes, on [0, 1] (Kronrod 1965; solved for in 40 digits from Stieltjes's
 * polynomial), and the weights of those 5. */
enum { KRONROD = 11 };
static const struct {
    double at, weight, gauss;
} kronrod[KRONROD] = {
    {0.0079573199525787678, 0.021291018375540916, 0},
    {0.046910077030668004, 0.057616658311236697, 0.11846344252809454},
    {0.12291663671457539, 0.093400398278246329, 0},
    {0.23076534494715845, 0.12052016961432379, 0.23931433524968323},
    {0.3601847934191084, 0.13642490095627946, 0},
    {0.5, 0.14149370892874561, 0.28444444444444444},
    {0.6398152065808916, 0.13642490095627946, 0},
    {0.76923465505284155, 0.12052016961432379, 0.23931433524968323},
    {0.87708336328542461, 0.093400398278246329, 0},
    {0.953089922969332, 0.057616658311236697, 0.11846344252809454},
    {0.99204268004742123, 0.021291018375540916, 0},
};

/* The widest panel in t; and of what is allowed, how much may be left out beyond the last of an azimuth. */
static const double widest = 2.5, left_out = 0.1;

/* One azimuth of slopes: mu = level + r along. */
typedef struct ray {
    const closure *c;
    double level[2], along[2];
    double core;       /* where slopes crowd */
    double negligible; /* of an azimuth */
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
static void stretch(const ray *l, double from, double to, double *sum) {
    const double core = l->core, t0 = asinh(from / core), t1 = asinh(to / core);
    if (!(t1 > t0)) return;
    const int panels = (int)ceil((t1 - t0) / widest);
    const double width = (t1 - t0) / panels;
    for (int i = 0; i < panels; i++) {
        double part = 0;
        for (int k = 0; k < 8; k++) {
            const double e = exp(t0 + width * (i + node[k])), r = core * (e - 1 / e) / 2;
            part += weight[k] * integrand(l, r) * r * core * (e + 1 / e) / 2;
        }
        *sum += part * width;
        if (part * width <= fmax(1e-5 * *sum, l->negligible)) return;
    }
}

/* Roots of a r² + 2 b r + c = 0, ascending; both 0 if there are none. */
static void roots(double a, double b, double c, double r[2]) {
    const double d = b * b - a * c, q = -(b + copysign(sqrt(fmax(d, 0)), b));
    const double x = d > 0 && a != 0 ? q / a : 0, y = d > 0 && q != 0 ? c / q : 0;
    r[0] = fmin(x, y), r[1] = fmax(x, y);
}

/* Its stretches between the places where the integrand has edges. */
static double azimuth(const ray *l) {
    const closure *c = l->c;
    const double o[2] = {(double)c->wo[0], (double)c->wo[1]}, z = (double)c->wo[2], *at = l->level,
                 *by = l->along;
    const double o_by = o[0] * by[0] + o[1] * by[1], seen = o[0] * at[0] + o[1] * at[1] + z;
    const double at2 = at[0] * at[0] + at[1] * at[1], by2 = by[0] * by[0] + by[1] * by[1],
                 at_by = at[0] * by[0] + at[1] * by[1];
    const double most = l->core * 1e18;
    double edge[5], sum = 0;
    roots(z * by2, z * at_by - o_by, z * at2 - 2 * seen + z, edge); /* between: reflected upwards */
    for (int k = 0; k < 2; k++) edge[k] = fmin(fmax(edge[k], 0), most);
    if (!c->surface->transmission) {
        stretch(l, edge[0], edge[1], &sum);
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
        stretch(l, from, next, &sum);
        from = next;
    }
    return sum;
}

/* One panel of azimuths by Kronrod's rule, and by Gauss's, of every other node. */
static double panel(ray *l, const double v[4], double from, double width, double *gauss) {
    double sum = 0;
    *gauss = 0;
    for (int j = 0; j < KRONROD; j++) {
        const double phi = from + width * kronrod[j].at, u[2] = {cos(phi), sin(phi)};
        l->along[0] = v[0] * u[0] + v[2] * u[1], l->along[1] = v[1] * u[0] + v[3] * u[1];
        const double f = azimuth(l) * width;
        sum += kronrod[j].weight * f, *gauss += kronrod[j].gauss * f;
    }
    return sum;
}

/* Halved until both rules agree: anisotropy, tilt and total reflection make some azimuths sharp. */
static double refine(ray *l, const double v[4], double from, double width, double allowed, int deeper) {
    double gauss;
    const double sum = panel(l, v, from, width, &gauss), half = width / 2;
    if (fabs(sum - gauss) <= allowed || !deeper) return sum;
    return refine(l, v, from, half, allowed / 2, deeper - 1) +
           refine(l, v, from + half, half, allowed / 2, deeper - 1);
}

float MU(albedo_integral)(const closure *c, double core, double allowed) {
    if (!(c->wo[2] > 0)) return 1;
    const double z = (double)c->map.view_z, v[4] = {(double)c->map.view[0] / z, (double)c->map.view[1] / z,
                                                    (double)c->map.view[2] / z, (double)c->map.view[3] / z};
    const double t[2] = {(double)c->map.tilt[0], (double)c->map.tilt[1]},
                 det = fabs(v[0] * v[3] - v[1] * v[2]);
    ray l = {.c = c, .core = core};
    l.level[0] = -(v[0] * t[0] + v[2] * t[1]), l.level[1] = -(v[1] * t[0] + v[3] * t[1]);
    const double facing = atan2(v[2] * (double)c->wo[0] + v[3] * (double)c->wo[1],
                                v[0] * (double)c->wo[0] + v[1] * (double)c->wo[1]);
    /* in a map that is a similarity both sides of the plane of incidence are alike */
    const double across = v[0] * v[2] + v[1] * v[3],
                 along = v[0] * v[0] + v[1] * v[1] - v[2] * v[2] - v[3] * v[3];
    const int alike = t[0] == 0 && t[1] == 0 && !(c->kernel->traits & ANISOTROPIC) &&
                      hypot(2 * across, along) <= 1e-6 * det;
    const int quarters = alike ? 2 : 4;
    l.negligible = left_out * allowed / (2 * PI * det);
    double sum = 0;
    for (int k = 0; k < quarters; k++)
        sum += refine(&l, v, facing + PI / 2 * k, PI / 2, allowed / (4 * det), DEEPEST - 1);
    return (float)fmin(sum * (alike ? 2 : 1) * det, 1);
}

#endif
