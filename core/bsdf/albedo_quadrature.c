/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_quadrature.c: the directional albedo of single scattering, of any distribution under any map, by quadrature. No
 * random numbers: tables must be smooth. Not in the papers.
 *
 * With p a slope of the distribution's own space, in slope units, V = s M^-1, and m = (mu, 1), mu = V^T (p - tilt), the
 * unnormalised micronormal there, integrating f cos over the light's directions comes to
 *
 *     E(wo) = 1/cos_o  integral of P22(p) max(0, wo.m) [F G2(wo, reflected) + (1 - F) G2(wo, refracted)] dp,
 *
 * the mean of what is in brackets over the area that the view sees, times sigma/cos_o. That is how it is integrated: along an
 * azimuth of slopes p = t (cos, sin), wo.m = up + t across, the area seen between two lengths is a mixture of two integrals
 * that no view and no map changes (albedo_lengths.h), and its share is the variable. So nothing has a scale of its own: whatever is
 * narrow, however unlike slopes along the axes of M or slopes and the horizon are, is a small share of what is seen.
 * Where the tilt hides the slope 0 (up < 0) the mixture is of the slopes that face the viewer at a grazing angle.
 *
 * Along each azimuth the facets that reflect wo upwards lie where cos_o |mu|² - 2 wo.mu - cos_o < 0; those that face it lie on
 * one side of a line, and total reflection begins on a conic: between the roots of these the integrand is smooth, but for
 * its ends, where it may begin as a root does: share = y² (3 - 2 y). Azimuths are cut where rays touch these conics, beyond
 * which edges are none. Shares and azimuths by Kronrod's rules; a stretch is halved while it is off, and of all wedges of azimuths
 * the one that is off the most: what a value costs has a bound.
 */
#include "core/bsdf/albedo_lengths.h"
#include "core/bsdf/albedo_slopes.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/singular.h"
#include "core/bsdf/snell.h"

#if MU_REAL_BITS == 24

/* Wedges at most; facets at most, beyond which nothing is halved any more; and halvings of a stretch. */
enum { WEDGES = 64, FACETS = 1 << 15, DEEPEST = 5 };

/* Kronrod's extensions of Gauss-Legendre by 3 and 5 nodes, on [0, 1] (Kronrod 1965; solved for in 40 digits from Stieltjes's
 * polynomials); the weights of those 3 and 5, and of the rules that interpolate at the others, for a second opinion on what is
 * off; and Gauss's rules of 4 and 2 for what is small. */
enum { AZIMUTHS = 7, EDGES = 5 };
typedef struct node {
    double at, weight, gauss, other;
} node;
static const node kronrod[AZIMUTHS] = {{0.019754365645989858, 0.052328113013233633, 0, 0.098617482295125396},
                                       {0.11270166537925831, 0.13424404493416672, 0.27777777777777778, 0},
                                       {0.2828781253265987, 0.20069870738798111, 0, 0.4013825177048746},
                                       {0.5, 0.22545826932923707, 0.44444444444444444, 0},
                                       {0.7171218746734013, 0.20069870738798111, 0, 0.4013825177048746},
                                       {0.88729833462074169, 0.13424404493416672, 0.27777777777777778, 0},
                                       {0.98024563435401014, 0.052328113013233633, 0, 0.098617482295125396}},
                  longer[] = {{0.0079573199525787678, 0.021291018375540916, 0, 0.040502074780081867},
                              {0.046910077030668004, 0.057616658311236697, 0.11846344252809454, 0},
                              {0.12291663671457539, 0.093400398278246329, 0, 0.18654440355954365},
                              {0.23076534494715845, 0.12052016961432379, 0.23931433524968323, 0},
                              {0.3601847934191084, 0.13642490095627946, 0, 0.27295352166037448},
                              {0.5, 0.14149370892874561, 0.28444444444444444, 0},
                              {0.6398152065808916, 0.13642490095627946, 0, 0.27295352166037448},
                              {0.76923465505284155, 0.12052016961432379, 0.23931433524968323, 0},
                              {0.87708336328542461, 0.093400398278246329, 0, 0.18654440355954365},
                              {0.953089922969332, 0.057616658311236697, 0.11846344252809454, 0},
                              {0.99204268004742123, 0.021291018375540916, 0, 0.040502074780081869}},
                  gauss4[] = {{0.069431844202973712, 0.17392742256872693, 0, 0},
                              {0.33000947820757187, 0.32607257743127307, 0, 0},
                              {0.66999052179242813, 0.32607257743127307, 0, 0},
                              {0.93056815579702629, 0.17392742256872693, 0, 0}},
                  gauss2[] = {{0.21132486540518712, 0.5, 0, 0}, {0.78867513459481288, 0.5, 0, 0}};
/* By the shares of an even azimuth's area down to which they serve; what is less is nothing. */
enum { RULES = 4, ROUGH = 2 };
static const struct {
    double least;
    const node *nodes;
    int count;
} rules[RULES] = {{0.25, longer, 11}, {0.05, kronrod, AZIMUTHS}, {0.005, gauss4, 4}, {0, gauss2, 2}};
static const double nothing = 1e-7;
/* By how much more than is allowed of the mean azimuth a stretch may be off: its estimate is Gauss's error, of 3 nodes. */
static const double lenient = 4;
/* The least angle between cuts. */
static const double nearest = 0.03;

/* What light a view sees, area by area, and what of it single scattering passes. */
typedef struct sums {
    double passed, area;
} sums;

typedef struct looking {
    albedo_slopes slopes;
    const albedo_lengths *lengths;
    double o[3];
    double up, flat;            /* wo.m = up + t flat cos of the azimuth, which is measured from `toward` */
    double toward[2], level[2]; /* mu of the slope 0 */
    double share, off;          /* per area of an azimuth; what a stretch may be off, in area */
    int opaque;                 /* what is reflected downwards is all lost */
    int known;                  /* areas are as the lengths say */
    size_t facets;
} looking;

/* Along one azimuth: mu = level + t by; wo.m = up + t across. */
typedef struct ray {
    double u[2], by[2], across;
    length_mix mix;
    double beyond, area; /* of a stretch: the mixture's integral beyond its beginning, and in it */
    int step;            /* of the lengths: where the last was */
} ray;

double MU(albedo_passed)(const closure *c, const double unit[3], double facing) {
    const float normal[3] = {(float)unit[0], (float)unit[1], (float)unit[2]};
    float i[3], F = 1;
    double sum = 0;
    if (c->surface->transmission) {
        F = MU(fresnel_dielectric)(c->eta, fminf((float)facing, 1));
        if (F < 1) {
            (void)refract(c->eta, c->wo, normal, (float)facing, i);
            if (i[2] > 0) sum += (double)((1 - F) * c->kernel->shadowing(c, i, 1));
        }
    }
    for (int k = 0; k < 3; k++) i[k] = (float)(2 * facing * unit[k] - (double)c->wo[k]);
    if (i[2] > 0) sum += (double)(F * c->kernel->shadowing(c, i, 0));
    return sum;
}

/* Either may agree by chance. */
static double off_by(double sum, double gauss, double other) {
    return fmax(fabs(sum - gauss), fabs(sum - other));
}

/* Of a stretch what lies between y0 and y1. */
static sums along(looking *l, ray *r, double y0, double y1, int deeper) {
    const double share = r->area * (y1 - y0) * l->share;
    int k = 0;
    while (k < RULES - 1 && share < rules[k].least) k++;
    const node *const rule = rules[k].nodes;
    const int nodes = rules[k].count, rough = k >= ROUGH;
    sums s = {0, 0};
    double gauss = 0, other = 0;
    const int begin = r->step;
    l->facets += (size_t)nodes;
    for (k = 0; k < nodes; k++) {
        const double y = y0 + (y1 - y0) * rule[k].at;
        double rate, unit[3];
        const double t =
            mu_albedo_length(l->lengths, r->mix, r->beyond - r->area * y * y * (3 - 2 * y), &r->step, &rate);
        const double density =
            albedo_slope_density(&l->slopes, (const double[]){t * r->u[0], t * r->u[1]}, unit);
        const double facing = l->o[0] * unit[0] + l->o[1] * unit[1] + l->o[2] * unit[2];
        if (!(facing > 0)) continue;
        const double area =
            density * t * t * (facing / unit[2]) * rate * r->area * 6 * y * (1 - y) * (y1 - y0);
        const double passed = area * MU(albedo_passed)(l->slopes.c, unit, facing);
        s.area += rule[k].weight * area, s.passed += rule[k].weight * passed;
        gauss += rule[k].gauss * passed, other += rule[k].other * passed;
    }
    if (rough || !deeper || off_by(s.passed, gauss, other) <= l->off || l->facets >= FACETS) return s;
    const double y = (y0 + y1) / 2;
    r->step = begin;
    const sums a = along(l, r, y0, y, deeper - 1), b = along(l, r, y, y1, deeper - 1);
    return (sums){a.passed + b.passed, a.area + b.area};
}

/* Roots of a r² + 2 b r + c = 0, ascending; both 0 if there are none. */
static void roots(double a, double b, double c, double r[2]) {
    const double d = b * b - a * c, q = -(b + copysign(sqrt(d > 0 ? d : 0), b));
    const double x = d > 0 && a != 0 ? q / a : 0, y = d > 0 && q != 0 ? c / q : 0;
    r[0] = x < y ? x : y, r[1] = x < y ? y : x;
}

/* Where the integrand has edges along a ray: their number. */
static int edges_of(const looking *l, const ray *r, double edge[EDGES]) {
    const closure *c = l->slopes.c;
    const double z = l->o[2], *at = l->level, *by = r->by;
    const double at2 = at[0] * at[0] + at[1] * at[1], by2 = by[0] * by[0] + by[1] * by[1],
                 at_by = at[0] * by[0] + at[1] * by[1];
    /* between: reflected upwards */
    roots(z * by2, z * at_by - r->across, z * at2 - 2 * l->up + z, edge);
    const double eta = (double)c->eta, k2 = 1 - eta * eta;
    if (!c->surface->transmission || !(k2 > 0)) return 2;
    /* (wo.m)² = (1 - eta²) |m|²: total reflection begins */
    roots(r->across * r->across - k2 * by2, l->up * r->across - k2 * at_by, l->up * l->up - k2 * (1 + at2),
          edge + 2);
    return 4;
}

/* What the area between two lengths is more than that of the mixture: below 0 where slopes turn away. */
static double behind(const looking *l, const ray *r, double from, double to) {
    const length_mix reach = {0, r->across};
    int step;
    return r->across < 0 ? mu_albedo_beyond(l->lengths, reach, from, &step) -
                               mu_albedo_beyond(l->lengths, reach, to, &step)
                         : 0;
}

static sums azimuth(looking *l, double phi) {
    const double x = cos(phi), y = sin(phi), *v = l->slopes.v;
    ray r = {.u = {l->toward[0] * x - l->toward[1] * y, l->toward[1] * x + l->toward[0] * y},
             .across = l->flat * x};
    r.by[0] = v[0] * r.u[0] + v[2] * r.u[1], r.by[1] = v[1] * r.u[0] + v[3] * r.u[1];
    sums s = {0, 0};
    if (l->up <= 0 && r.across <= 0) return s;
    const double line = r.across != 0 ? -l->up / r.across : 0; /* it faces wo on one side of this */
    double edge[EDGES], from = l->up < 0 ? line : 0;
    const double to = r.across < 0 ? line : INFINITY;
    int edges = edges_of(l, &r, edge);
    edge[edges++] = to;
    r.mix = (length_mix){fmax(l->up, 0), l->up < 0 ? l->flat : fmax(r.across, 0)};
    r.beyond = mu_albedo_beyond(l->lengths, r.mix, from, &r.step);
    for (int i = 0; i < edges && from < to;
         i++) { /* the nearest edge beyond `from`, as often as there are any */
        double next = to;
        int step;
        for (int k = 0; k < edges; k++)
            if (edge[k] > from && edge[k] < next) next = edge[k];
        const double beyond = mu_albedo_beyond(l->lengths, r.mix, next, &step);
        const int dark = l->opaque && !(from >= edge[0] && next <= edge[1]);
        r.area = r.beyond - beyond;
        sums part = {0, 0};
        if (r.area * l->share > nothing && !(dark && l->known)) part = along(l, &r, 0, 1, DEEPEST);
        if (l->known) { /* what is passed, of an area that is better known */
            const double area = r.area + behind(l, &r, from, next);
            part.passed *= part.area > 0 ? fmin(fmax(area / part.area, 0.9), 1.1) : 1, part.area = area;
        }
        s.passed += part.passed, s.area += part.area;
        from = next, r.beyond = beyond, r.step = step;
    }
    return s;
}

/* A wedge of azimuths by Kronrod's rule, and what Gauss's, of every other node, is off it. */
typedef struct wedge {
    double from, width, off;
    sums sum;
} wedge;

static wedge integrate(looking *l, double from, double width) {
    wedge w = {.from = from, .width = width};
    double gauss = 0, other = 0;
    for (int j = 0; j < AZIMUTHS; j++) {
        const sums f = azimuth(l, from + width * kronrod[j].at);
        w.sum.passed += kronrod[j].weight * width * f.passed,
            w.sum.area += kronrod[j].weight * width * f.area;
        gauss += kronrod[j].gauss * width * f.passed, other += kronrod[j].other * width * f.passed;
    }
    w.off = off_by(w.sum.passed, gauss, other);
    return w;
}

/* Azimuths to cut at, ascending. */
enum { CUTS = 24 };
typedef struct cuts {
    double at[CUTS];
    int count;
} cuts;

/* Unless one is there already. */
static void add_cut(cuts *c, double at) {
    int k = c->count;
    if (c->count == CUTS || !(at > c->at[0] && at < c->at[c->count - 1])) return;
    while (k > 0 && c->at[k - 1] > at) k--;
    if (at - c->at[k - 1] < nearest || c->at[k] - at < nearest) return;
    for (int i = c->count++; i > k; i--) c->at[i] = c->at[i - 1];
    c->at[k] = at;
}

/* Both senses of the lines of azimuth where q[0] cos² + 2 q[1] cos sin + q[2] sin² = 0. */
static void cut_lines(cuts *c, const double q[3]) {
    const double d = q[1] * q[1] - q[0] * q[2];
    if (!(d > 0)) return;
    for (int k = 0; k < 2; k++) {
        const double at = atan2(-q[1] + (k ? 1 : -1) * sqrt(d), q[2]);
        for (int turn = -1; turn <= 1; turn++) add_cut(c, at + PI * turn);
    }
}

/* Where rays touch the conic a r² + 2 b r + c = 0, of a by `form`, b linear, and c a constant: b² = a c. */
static void cut_tangents(cuts *cut, const double form[3], const double b[2], double c) {
    cut_lines(cut, (const double[]){b[0] * b[0] - c * form[0], b[0] * b[1] - c * form[1],
                                    b[1] * b[1] - c * form[2]});
}

/* Quarters that face the viewer or do not (at grazing view the integrand has an edge between), of what faces at all; of a map
 * that is a similarity one side of the plane of incidence, for both are alike; where slopes stay small in the world, of one that
 * is far from it; and where edges begin and end: rays that touch the conics of `edges_of`, or meet total reflection at infinity. */
static void cut_azimuths(const looking *l, cuts *out) {
    const albedo_slopes *const s = &l->slopes;
    const singular v = singular_of(s->v);
    const int even = s->tilt[0] == 0 && s->tilt[1] == 0 && !(s->c->kernel->traits & ANISOTROPIC),
              alike = even && v.large <= (1 + 1e-6) * fabs(v.small);
    out->count = 0;
    for (int k = alike ? 0 : l->up < 0 ? -1 : -2; k <= (l->up < 0 ? 1 : 2); k++)
        out->at[out->count++] = PI / 2 * k;
    if (v.large > 8 * fabs(v.small)) {
        const double low = (v.sum + v.difference) / 2 + PI / 2 - atan2(l->toward[1], l->toward[0]);
        for (int turn = -1; turn <= 1; turn++) add_cut(out, remainder(low, PI) + PI * turn);
    }
    /* |V^T u|² and V level of an azimuth u, its axes toward the viewer and across */
    const double *const t = l->toward,
                        x[2] = {s->v[0] * t[0] + s->v[2] * t[1], s->v[1] * t[0] + s->v[3] * t[1]},
                        y[2] = {s->v[2] * t[0] - s->v[0] * t[1], s->v[3] * t[0] - s->v[1] * t[1]};
    const double by2[3] = {x[0] * x[0] + x[1] * x[1], x[0] * y[0] + x[1] * y[1], y[0] * y[0] + y[1] * y[1]},
                 at_by[2] = {x[0] * l->level[0] + x[1] * l->level[1],
                             y[0] * l->level[0] + y[1] * l->level[1]},
                 at2 = l->level[0] * l->level[0] + l->level[1] * l->level[1], z = l->o[2];
    cut_tangents(out, (const double[]){z * by2[0], z * by2[1], z * by2[2]},
                 (const double[]){z * at_by[0] - l->flat, z * at_by[1]}, z * at2 - 2 * l->up + z);
    const double eta = (double)s->c->eta, k2 = 1 - eta * eta;
    if (!s->c->surface->transmission || !(k2 > 0)) return;
    const double form[3] = {l->flat * l->flat - k2 * by2[0], -k2 * by2[1], -k2 * by2[2]};
    cut_tangents(out, form, (const double[]){l->up * l->flat - k2 * at_by[0], -k2 * at_by[1]},
                 l->up * l->up - k2 * (1 + at2));
    cut_lines(out, form);
}

/* E: halves the wedge that is off the most until all of them are off by no more than is allowed, or there are too many. */
static double refine(looking *l, const cuts *cut, double scale, double allowed, double *off) {
    wedge w[WEDGES];
    for (int k = 0; k + 1 < cut->count; k++) w[k] = integrate(l, cut->at[k], cut->at[k + 1] - cut->at[k]);
    for (int count = cut->count - 1;; count++) {
        sums sum = {0, 0};
        int worst = 0;
        *off = 0;
        for (int k = 0; k < count; k++) {
            sum.passed += w[k].sum.passed, sum.area += w[k].sum.area, *off += w[k].off;
            if (w[k].off > w[worst].off) worst = k;
        }
        const double over = sum.area > 0 ? scale / sum.area : 0;
        *off *= over;
        if (*off <= allowed || count == WEDGES || l->facets >= FACETS) return sum.passed * over;
        const double from = w[worst].from, half = w[worst].width / 2;
        w[worst] = integrate(l, from, half);
        w[count] = integrate(l, from + half, half);
    }
}

float MU(albedo_integral)(const closure *c, const albedo_lengths *lengths, double allowed,
                          albedo_effort *effort) {
    if (!(c->wo[2] > 0)) return 1;
    looking l = {.slopes = albedo_slopes_of(c), .lengths = lengths};
    const double *const v = l.slopes.v, *const t = l.slopes.tilt;
    for (int k = 0; k < 3; k++) l.o[k] = (double)c->wo[k];
    for (int k = 0; k < 2; k++) l.level[k] = -(v[k] * t[0] + v[2 + k] * t[1]);
    const double across[2] = {v[0] * l.o[0] + v[1] * l.o[1], v[2] * l.o[0] + v[3] * l.o[1]},
                 sigma = (double)c->sigma / (double)c->map.view_z;
    l.flat = hypot(across[0], across[1]), l.up = l.o[2] - across[0] * t[0] - across[1] * t[1];
    for (int k = 0; k < 2; k++) l.toward[k] = l.flat > 0 ? across[k] / l.flat : 1 - k;
    if (!(sigma > 0)) return 0;
    const double scale = sigma / l.o[2];
    l.opaque = !c->surface->transmission, l.known = !(c->kernel->traits & ANISOTROPIC) && l.up >= 0;
    l.share = 2 * PI / sigma, l.off = lenient * allowed / (l.share * scale);
    double off;
    cuts cut;
    cut_azimuths(&l, &cut);
    const double E = refine(&l, &cut, scale, allowed, &off);
    if (effort) effort->facets += l.facets, effort->off = fmax(effort->off, off - allowed);
    return (float)fmin(E, 1);
}

#endif
