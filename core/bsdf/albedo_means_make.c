/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_means_make.c: fills the averages of albedo_means.h: at each node the mean of what is lost, by the quadrature that shading
 * integrates it by (albedo_open.c), so that both agree; over directions by the points of a lattice. Not in the papers.
 *
 * Half of them lie evenly over u and S of a lobe, which knows slopes in their own units, half by the cosine, and q is the density of both
 * together (the balance heuristic, Veach & Guibas 1995):
 *     A = sum of lost cos/(pi q)  /  sum of cos/(pi q).
 * What is lost evenly is right at once. u (an azimuth), and S (a cosine squared) are 3 t² - 2 t³ of t in a quadrant: what is summed begins and
 * ends at 0 along both, and Fibonacci lattices know what is smooth and periodic best (Sloan & Joe 1994, "Lattice Methods for Multiple
 * Integration").
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/tabulated.h"

#if MU_REAL_BITS == 24

/* How many points there may be; of those, how many for an error of 1 %: of all four quadrants, and of one that is like the others;
 * of four from below, where total reflection begins on a curve, the next more. One of
 * so many slopes of a histogram is taken, and a quadrature may be off so many times what it may while shading: a mean hardly is. */
enum { FIRST = 1, LAST = 7, MANY = 5, FEWER = 4, SPARSE = 8, LENIENT = 4, MEANS_WALKS = 256 };
static const int fibonacci[LAST + 1] = {13, 21, 34, 55, 89, 144, 233, 377};

static double lost_toward(const albedo_open *open, const mu_lobe *l, int side, const float w[3], int which) {
    albedo_source source = open->source;
    albedo_effort effort = {0, 0};
    closure single;
    source.effort = &effort, source.begin = which % SPARSE, source.stride = SPARSE;
    source.allowed *= LENIENT;
    if (!mu_albedo_bind_at(open, l, side, w, &single)) return 1;
    return (double)mu_albedo_lost(&source, &single);
}

static double folded(double t, double *stretch) {
    *stretch = 6 * t * (1 - t);
    return t * t * (3 - 2 * t);
}

static double average_of(const albedo_open *open, const mu_lobe *l, int side, int even) {
    const int usual = (even ? FEWER : MANY) + (side && !even),
              more = usual - (int)lround(log2(open->source.error / 0.01)),
              at = more < FIRST  ? FIRST
                   : more > LAST ? LAST
                                 : more;
    const mu_albedo square = lobe_square(l);
    const int points = fibonacci[at], step = fibonacci[at - 1], quadrants = even ? 1 : 4;
    double lost = 0, all = 0;
    for (int n = 0; n < points; n++) {
        float w[3];
        double by_u, by_s;
        const double x = quadrants * (n + 0.5) / points, y = (n * step % points + 0.5) / points;
        const int quadrant = (int)x;
        const double u = folded(x - quadrant, &by_u), s = folded(y, &by_s);
        for (int way = 0; way < 2; way++) {
            if (way) {
                const double phi = PI / 2 * (u + quadrant), r = sqrt(s);
                w[0] = (float)(r * cos(phi)), w[1] = (float)(r * sin(phi)), w[2] = (float)sqrt(1 - s);
            } else {
                mu_albedo_direction(&square, &square.side[0], &l->frame, quadrant, (float)u, (float)s, w);
            }
            const double weight = by_u * by_s * (double)(w[2] / lobe_blind_density(l, w));
            lost += weight * lost_toward(open, l, side, w, n), all += weight;
        }
    }
    return fmax(lost / all, 1e-12);
}

void mu_albedo_means_measure(const albedo_means *m, const albedo_open *open, const mu_lobe *l,
                             double mean[ALBEDO_MEANS_KINDS]) {
    const int sides = open->source.surface->transmission ? 2 : 1, even = m->angles == 1;
    for (int side = 0; side < 2; side++) mean[side] = side < sides ? average_of(open, l, side, even) : 1;
    mean[2] = 0;
    if (sides == 1) return;
    albedo_source there = open->source;
    there.transform = l->transform;
    mean[2] = 1 - mu_albedo_share_above(&there, MEANS_WALKS);
}

/* Of the slopes of a surface, in slope units: what M widens. */
static void find_root(const albedo_source *source, albedo_means *out) {
    const surface *const s = source->surface;
    const double x = s->tilt[0] / s->unit, y = s->tilt[1] / s->unit;
    double xx = 1, xy = 0, yy = 1;
    if (source->slopes) { /* twice the covariance: as steep as GGX of roughness 1 */
        const float *const r = s->base.shape + TABULATED_ROOT;
        xx = 2 * (double)(r[0] * r[0]), xy = 2 * (double)(r[0] * r[1]),
        yy = 2 * (double)(r[1] * r[1] + r[2] * r[2]);
    }
    xx += x * x, xy += x * y, yy += y * y;
    out->mean[0] = x, out->mean[1] = y;
    out->root[0] = sqrt(xx), out->root[1] = xy / out->root[0];
    out->root[2] = sqrt(fmax(yy - out->root[1] * out->root[1], 1e-12 * yy));
    /* L^-1 of the mean */
    const double along = x / out->root[0];
    out->axis = x != 0 || y != 0 ? atan2((y - out->root[1] * along) / out->root[2], along) : 0;
    out->even = !(s->kernel->traits & ANISOTROPIC);
    out->angles = !out->even             ? ALBEDO_MEANS_ANGLES
                  : !(x != 0 || y != 0)  ? 1
                  : source->error > 0.05 ? ALBEDO_MEANS_COARSE
                  : s->transmission      ? ALBEDO_MEANS_GLASS
                                         : ALBEDO_MEANS_EVEN;
}

/* By what is lost of smooth slopes where their mean lies along a, and, of two a, where it lies along a far smaller b: c (mean + k a^p). */
static void find_spread(const albedo_open *open, albedo_means *m) {
    static const double rough[3] = {0x1p-7, 0x1p-7, 0x1p-9};
    double lost[3], mean[3], part[3];
    m->spread = 1, m->power = 2;
    if (!(m->mean[0] != 0 || m->mean[1] != 0)) return;
    for (int k = 0; k < 3; k++) {
        double v[4];
        mu_lobe l;
        mu_albedo_means_place(m, rough[k], rough[k] / 512, k ? PI / 2 : 0, v);
        mu_albedo_means_aim(m, open, v, &l);
        lost[k] = average_of(open, &l, 0, 0);
        mean[k] = hypot(v[0] * m->mean[0] + v[2] * m->mean[1], v[1] * m->mean[0] + v[3] * m->mean[1]);
    }
    const double c = (lost[0] - lost[1]) / (mean[0] - mean[1]);
    for (int k = 1; k < 3; k++) part[k] = lost[k] / c - mean[k];
    if (!(c > 0 && part[1] > part[2] && part[2] > 0)) return;
    m->power = fmin(fmax(log(part[1] / part[2]) / log(rough[1] / rough[2]), 1), 2);
    m->spread = fmin(fmax(part[1] / pow(rough[1], m->power), 0.1), 10);
}

size_t mu_albedo_means_make(const albedo_source *source, const albedo_open *open, float *values,
                            albedo_means *out) {
    const int is_gtr = source->definition->ndf == MU_GTR;
    /* gtr of gamma < 1 is measured in slopes of 1, but crowds at alpha too */
    const double core = is_gtr ? fmin(1, (double)source->surface->alpha / source->surface->unit) : 1;
    *out = (albedo_means){.value = values, .middle = -log2(core) / 2, .wide = 2 - log2(core) / 4};
    find_root(source, out), find_spread(open, out);
    /* what of it is refracted turns with angles in the world up to slopes of some hundred */
    out->rows = out->angles > 1 && source->surface->transmission ? ALBEDO_MEANS_ROUGH : ALBEDO_MEANS_FEW;
    if (out->rows > ALBEDO_MEANS_FEW) out->middle++;
    for (int i = 0; i < out->rows; i++)
        for (int j = 0; j < ALBEDO_MEANS_SHAPES; j++)
            for (int k = 0; k < out->angles; k++) {
                double v[4];
                mu_lobe l;
                float *const at = values + albedo_means_node(out, i, j, k);
                if (!mu_albedo_means_view(out, i, j, k, v) && k > 0) {
                    for (int kind = 0; kind < ALBEDO_MEANS_KINDS; kind++)
                        at[kind] = at[kind - ALBEDO_MEANS_KINDS];
                    continue;
                }
                double mean[ALBEDO_MEANS_KINDS];
                mu_albedo_means_aim(out, open, v, &l);
                mu_albedo_means_measure(out, open, &l, mean);
                for (int side = 0; side < 2; side++)
                    at[side] = (float)log(mean[side] / mu_albedo_means_about(out, v));
                at[2] = (float)mean[2];
            }
    return (size_t)(ALBEDO_MEANS_KINDS * out->rows * ALBEDO_MEANS_SHAPES * out->angles);
}

#endif
