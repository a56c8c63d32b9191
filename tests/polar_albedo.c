/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * polar_albedo.c: the directional albedo of single scattering by another quadrature than the library's (albedo_quadrature.c), to hold
 * that one to: over the world's slopes mu instead of shares of what is seen, with no table, no sigma, and no sum to divide by.
 *
 *     E(wo) = 1/cos_o  integral of P22(u) max(0, wo.(mu, 1)) [F G2(wo, reflected) + (1 - F) G2(wo, refracted)] du
 *
 * in polar coordinates about the mean slope that M and the tilt make. Slopes are spread over A and B along the axes of M; those
 * that reflect wo upwards over a disk, between its chords. What is the lesser along an axis is 1 in y, in whose azimuths
 * the integrand is spread evenly. What is refracted is of all slopes, so where disk and slopes differ it has an integral of its
 * own. Azimuths by Kronrod's rule of 11 nodes, in quarters that face the viewer or do not; lengths by it, too, in t =
 * asinh(length / core). Along each azimuth edges are where they are in albedo_quadrature.c.
 *
 * The wedge of azimuths that is off the most is halved next. Slow: ten times the library's, and more.
 */
#define MU_REAL_BITS 24
#include "tests/polar_albedo.h"

#include "core/bsdf/distribution.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/singular.h"
#include "core/bsdf/snell.h"

/* Wedges at most; panels of lengths at most, beyond which nothing is halved any more; and halvings of one of them. */
enum { WEDGES = 256, PANELS = 1 << 15, DEEPEST = 8 };
enum { REFLECTED = 1, REFRACTED = 2 };

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
    double core;    /* where slopes crowd */
    double allowed; /* of an azimuth */
    int ways;       /* of light */
    size_t work;    /* panels of lengths so far */
} ray;

static double passed(const closure *c, const double unit[3], double facing, int ways) {
    const float normal[3] = {(float)unit[0], (float)unit[1], (float)unit[2]};
    float i[3], F = 1;
    double sum = 0;
    if (c->surface->transmission) {
        F = MU(fresnel_dielectric)(c->eta, fminf((float)facing, 1));
        if (F < 1 && ways & REFRACTED) {
            (void)refract(c->eta, c->wo, normal, (float)facing, i);
            if (i[2] > 0) sum += (double)((1 - F) * c->kernel->shadowing(c, i, 1));
        }
    }
    if (!(ways & REFLECTED)) return sum;
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
           passed(c, unit, seen / length, l->ways);
}

/* A panel of t = asinh(r / core), halved until both rules agree: a steep tail that begins far from the center needs that. */
static double lengths(ray *l, double from, double width, int deeper) {
    double sum = 0, gauss = 0;
    for (int k = 0; k < KRONROD; k++) {
        const double e = exp(from + width * kronrod[k].at), r = l->core * (e - 1 / e) / 2;
        const double f = integrand(l, r) * r * l->core * (e + 1 / e) / 2 * width;
        sum += kronrod[k].weight * f, gauss += kronrod[k].gauss * f;
    }
    if (++l->work >= PANELS || !deeper || fabs(sum - gauss) <= l->allowed) return sum;
    return lengths(l, from, width / 2, deeper - 1) + lengths(l, from + width / 2, width / 2, deeper - 1);
}

/* The integral over r in [from, to], times r dr, panel by panel outwards until, past the largest, they add nothing to *sum. */
static void stretch(ray *l, double from, double to, double *sum) {
    const double t0 = asinh(from / l->core), t1 = asinh(to / l->core);
    if (!(t1 > t0)) return;
    const int panels = (int)ceil((t1 - t0) / widest);
    const double width = (t1 - t0) / panels;
    double before = 0;
    for (int i = 0; i < panels; i++) {
        const double part = lengths(l, t0 + width * i, width, DEEPEST);
        *sum += part;
        if (part < before && part <= fmax(1e-5 * *sum, left_out * l->allowed)) return;
        before = part;
    }
}

/* Roots of a r² + 2 b r + c = 0, ascending; both 0 if there are none. */
static void roots(double a, double b, double c, double r[2]) {
    const double d = b * b - a * c, q = -(b + copysign(sqrt(fmax(d, 0)), b));
    const double x = d > 0 && a != 0 ? q / a : 0, y = d > 0 && q != 0 ? c / q : 0;
    r[0] = fmin(x, y), r[1] = fmax(x, y);
}

/* Its stretches between the places where the integrand has edges. */
static double azimuth(ray *l) {
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
    if (!(l->ways & REFRACTED) && !c->surface->transmission) {
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

/* A wedge of azimuths by Kronrod's rule, and what Gauss's, of every other node, is off it. */
typedef struct wedge {
    double from, width, sum, off;
} wedge;

static wedge integrate(ray *l, const double v[4], double from, double width) {
    double sum = 0, gauss = 0;
    for (int j = 0; j < KRONROD; j++) {
        const double phi = from + width * kronrod[j].at, u[2] = {cos(phi), sin(phi)};
        l->along[0] = v[0] * u[0] + v[2] * u[1], l->along[1] = v[1] * u[0] + v[3] * u[1];
        const double f = azimuth(l) * width;
        sum += kronrod[j].weight * f, gauss += kronrod[j].gauss * f;
    }
    return (wedge){from, width, sum, fabs(sum - gauss)};
}

/* Halves the wedge that is off the most until all of them are off by no more than is allowed, or there are too many: tilt and
 * total reflection make some azimuths sharp. */
static double refine(ray *l, const double v[4], double facing, int quarters, double allowed, double *off) {
    wedge w[WEDGES];
    for (int k = 0; k < quarters; k++) w[k] = integrate(l, v, facing + PI / 2 * k, PI / 2);
    for (int count = quarters;; count++) {
        double sum = 0;
        int worst = 0;
        *off = 0;
        for (int k = 0; k < count; k++) {
            sum += w[k].sum, *off += w[k].off;
            if (w[k].off > w[worst].off) worst = k;
        }
        if (*off <= allowed || count == WEDGES || l->work >= PANELS) return sum;
        const double from = w[worst].from, half = w[worst].width / 2;
        w[worst] = integrate(l, v, from, half);
        w[count] = integrate(l, v, from + half, half);
    }
}

/* What is 1 in y along both axes, of rows `axis`. */
static void spread(const singular *s, const double axis[4], const float wo[3], double out[2]) {
    const double rough[2] = {s->large, fabs(s->small)}, z = (double)wo[2];
    double along[2], reach[2];
    for (int k = 0; k < 2; k++) {
        along[k] = fabs(axis[2 * k] * (double)wo[0] + axis[2 * k + 1] * (double)wo[1]) / z;
        reach[k] = fmin(rough[k], 1 + 2 * along[k]);
    }
    for (int k = 0; k < 2; k++) out[k] = fmin(rough[k], 1 + 2 * along[k] + sqrt(2 * reach[!k] * along[!k]));
}

/* Of some ways of light, `e` of which is 1 in y along the axes. */
static double integrate_ways(ray *l, const singular *s, const double e[2], double core, double allowed,
                             double *off) {
    const closure *c = l->c;
    const double t[2] = {(double)c->map.tilt[0], (double)c->map.tilt[1]};
    const double a = e[0] / s->large, b = e[1] / fabs(s->small);
    double v[4], center[4], unused[4];
    singular_matrix(s, e[0], copysign(e[1], s->small), v, unused);
    singular_matrix(s, e[0] * a, e[1] * copysign(b, s->small), center, unused);
    l->core = fmin(core / fmax(a, b), 1);
    l->level[0] = -(center[0] * t[0] + center[2] * t[1]),
    l->level[1] = -(center[1] * t[0] + center[3] * t[1]);
    const double det = e[0] * e[1], facing = atan2(v[2] * (double)c->wo[0] + v[3] * (double)c->wo[1],
                                                   v[0] * (double)c->wo[0] + v[1] * (double)c->wo[1]);
    /* in a map that is a similarity both sides of the plane of incidence are alike */
    const int alike = t[0] == 0 && t[1] == 0 && !(c->kernel->traits & ANISOTROPIC) &&
                      s->large <= (1 + 1e-6) * fabs(s->small) && e[0] <= (1 + 1e-6) * e[1];
    const int twice = alike ? 2 : 1;
    l->allowed = allowed / (2 * PI * det), l->work = 0;
    const double sum = refine(l, v, facing, alike ? 2 : 4, allowed / (twice * det), off);
    *off *= det * twice;
    return sum * twice * det;
}

double polar_albedo(const closure *c, double core, double allowed, double *off) {
    if (!(c->wo[2] > 0)) return 1;
    const double z = (double)c->map.view_z, v[4] = {(double)c->map.view[0] / z, (double)c->map.view[1] / z,
                                                    (double)c->map.view[2] / z, (double)c->map.view[3] / z};
    const singular s = singular_of(v);
    const double turn = (s.sum - s.difference) / 2; /* R(right): wo along the axes of M */
    const double axis[4] = {cos(turn), -sin(turn), sin(turn), cos(turn)};
    double e[2], other;
    spread(&s, axis, c->wo, e);
    const double rough[2] = {s.large, fabs(s.small)};
    ray l = {.c = c, .ways = REFLECTED};
    if (!c->surface->transmission || (e[0] >= rough[0] && e[1] >= rough[1])) {
        l.ways |= c->surface->transmission ? REFRACTED : 0;
        return fmin(integrate_ways(&l, &s, e, core, allowed, off), 1);
    }
    const double reflected = integrate_ways(&l, &s, e, core, allowed / 2, &other);
    l.ways = REFRACTED;
    const double refracted = integrate_ways(&l, &s, rough, core, allowed / 2, off);
    *off += other;
    return fmin(reflected + refracted, 1);
}
