/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * flakes.c: where the flakes are, and how many of them a region holds; flakes.h. Compiled once, in double.
 *
 * The flakes are one uniform point, a hash of its cell, in each cell of a lattice over (u, v, p, q). Cells of (u, v) are
 * squares. The unit disk of radius sqrt(p) and angle 2 pi q, on which the normals are uniform, is cut into n rings of
 * equal width, the k-th into 2k + 1 sectors (Beckers and Beckers 2012): n² cells of one area, none long and thin, so that
 * a cone is as cheap at the pole as elsewhere. Normals of a cone of half-angle tau have a disk of radius about tau, and n
 * is 2/tau to 4/tau.
 *
 * A cell of which the region covers a part phi holds a counted flake with probability phi, independently: K is a sum of
 * Bernoulli variables of mean sum phi = N A V, exactly, and variance sum phi (1 - phi), below that of a Poisson process
 * (sum phi), to which it tends for regions smaller than a cell. Cells that are wholly inside are counted unseen.
 *
 * Work is bounded by the number of cells met, WORK. A region that meets more is counted in a lattice of twice the
 * (u, v) side, or of half the rings, t times over until it fits: 4^-t as many, other flakes. With k of them found and e
 * expected, 1 + (k/e - 1) / 2^t has mean 1, and the variance bound 4^-t / e = 1 / E[K] of the flakes it stands for. What
 * is lost there is the shape of the distribution of K, not its mean or spread. Not in the papers, which stop their
 * recursion early and take the mean of what is left: more work, and too small a variance.
 */
#include "core/bsdf/flakes.h"

#include "core/bsdf/real.h"
#include "core/bsdf/splitmix.h"

#if MU_REAL_BITS == 53

static const double WORK = 2048; /* cells, in the mean over the region's offset; a (u, v) cell costs 2 more */
static const double SMOOTH = 1e6; /* flakes: their spread is below 1e-3, and the ratio is 1 */

/* Two uniforms of 32 bits; never 0 or 1. */
static inline double high(uint64_t bits) {
    return ((double)(uint32_t)(bits >> 32) + 0.5) * 0x1p-32;
}
static inline double low(uint64_t bits) {
    return ((double)(uint32_t)bits + 0.5) * 0x1p-32;
}

mu_flakes mu_flakes_make(double density, double cone, uint64_t seed) {
    mu_flakes f = {density > 0 && density <= DBL_MAX ? density : 0, 1, 1, mu_mix(seed + MU_GOLDEN)};
    cone = cone > 1e-6 ? cone : 1e-6;
    while (f.rings < 2 / cone) f.rings *= 2;
    if (f.density > 0) f.side = f.rings / sqrt(f.density);
    return f;
}

/* The half-axes, at least half a flake across: the longer one lengthened, the other moved away from it. */
static void widen(const double footprint[6], double least, double a[2], double b[2]) {
    double la = hypot(footprint[2], footprint[3]);
    const double lb = hypot(footprint[4], footprint[5]);
    const int swap = lb > la;
    for (int i = 0; i < 2; i++) a[i] = footprint[(swap ? 4 : 2) + i], b[i] = footprint[(swap ? 2 : 4) + i];
    if (swap) la = lb;
    const double unit[2] = {la > 0 ? a[0] / la : 1, la > 0 ? a[1] / la : 0};
    if (la < least) a[0] = least * unit[0], a[1] = least * unit[1];
    const double across = unit[0] * b[1] - unit[1] * b[0];
    const double more = fabs(across) < least ? (across < 0 ? -least : least) - across : 0;
    b[0] -= more * unit[1], b[1] += more * unit[0];
}

/* The footprint in units of a (u, v) cell. */
typedef struct area {
    double origin[2], centre[2]; /* the centre is origin + centre, origin whole and centre in [0, 1) */
    double extent[2];            /* of the bounding box, to each side */
    double g[2][2];              /* |g_i . (x - centre)| < 1 inside */
} area;

static area area_make(const double footprint[6], const double a[2], const double b[2], double side) {
    area out;
    for (int i = 0; i < 2; i++) {
        double c = footprint[i] / side;
        if (fabs(c) > 0x1p52) c = fmod(c, 0x1p52); /* a double has no fraction there; repeat */
        out.origin[i] = floor(c), out.centre[i] = c - out.origin[i];
        out.extent[i] = (fabs(a[i]) + fabs(b[i])) / side;
    }
    const double det = (a[0] * b[1] - a[1] * b[0]) / side;
    out.g[0][0] = b[1] / det, out.g[0][1] = -b[0] / det;
    out.g[1][0] = -a[1] / det, out.g[1][1] = a[0] / det;
    return out;
}

/* The box in a lattice of n rings. */
typedef struct kinds {
    double p[2];     /* n² p */
    double q[2];     /* the azimuths from q[0] to q[1], 0 <= q[0] <= 1; all: q[1] = 2 */
    int64_t ring[2]; /* the first and the last that it meets */
} kinds;

static kinds kinds_make(const mu_flake_normals *box, double rings) {
    kinds out;
    for (int i = 0; i < 2; i++) {
        out.p[i] = box->p[i] * rings * rings;
        out.ring[i] = (int64_t)smaller(sqrt(out.p[i]), rings - 1);
    }
    const int all = box->q_width >= 1;
    out.q[0] = all ? 0 : box->q, out.q[1] = all ? 2 : box->q + box->q_width;
    return out;
}

/* The flakes of one (u, v) cell, whose corner is at x from the footprint's centre; within: wholly in the footprint. */
static int64_t count_cell(const area *at, const kinds *box, int within, const double x[2], uint64_t seed) {
    const double g00 = at->g[0][0], g01 = at->g[0][1], g10 = at->g[1][0], g11 = at->g[1][1];
    const double s0 = g00 * x[0] + g01 * x[1], t0 = g10 * x[0] + g11 * x[1];
    int64_t count = 0;
    for (int64_t k = box->ring[0]; k <= box->ring[1]; k++) {
        const int64_t sectors = 2 * k + 1;
        const double p0 = (double)(k * k), dp = (double)sectors, q0 = box->q[0] * dp, q1 = box->q[1] * dp;
        const int whole_ring = p0 >= box->p[0] && p0 + dp <= box->p[1];
        /* q1 may reach into the first sector again, where both ends cut */
        const int64_t first = (int64_t)q0, last = (int64_t)q1,
                      end = last - first < sectors ? last : first + 2 * k;
        for (int64_t turn = first; turn <= end; turn++) {
            const uint64_t state =
                seed + 2 * MU_GOLDEN * (uint64_t)(k * k + (turn < sectors ? turn : turn - sectors));
            if (!within) {
                const uint64_t bits = mu_mix(state);
                const double u = high(bits), v = low(bits), s = s0 + (g00 * u + g01 * v),
                             t = t0 + (g10 * u + g11 * v);
                if (!((s >= -1) & (s < 1) & (t >= -1) & (t < 1))) continue;
            }
            if (whole_ring && turn > first && turn < last) {
                count++;
            } else {
                const uint64_t bits = mu_mix(state + MU_GOLDEN);
                const double p = p0 + dp * high(bits), q = (double)turn + low(bits);
                count += (p >= box->p[0]) & (p < box->p[1]) & (((q >= q0) & (q < q1)) | (q + dp < q1));
            }
        }
    }
    return count;
}

static int64_t count_cells(const area *at, const kinds *box, uint64_t seed) {
    int64_t count = 0;
    for (double j = floor(at->centre[1] - at->extent[1]); j <= at->centre[1] + at->extent[1]; j++) {
        /* what each pair of sides leaves of this row: |g0 x| < 1 + |g1|/2 around the middle of the row */
        double from = at->centre[0] - at->extent[0], to = at->centre[0] + at->extent[0];
        double x[2] = {0, j - at->centre[1]};
        for (int i = 0; i < 2; i++)
            if (at->g[i][0] != 0) {
                const double middle = at->centre[0] - at->g[i][1] * (x[1] + 0.5) / at->g[i][0];
                const double reach = (1 + fabs(at->g[i][1]) / 2) / fabs(at->g[i][0]);
                from = larger(middle - reach, from), to = smaller(middle + reach, to); /* NaN: stays */
            }
        const uint64_t row = mu_mix(seed + (uint64_t)(int64_t)(at->origin[1] + j));
        for (double i = floor(from); i <= to; i++) {
            x[0] = i - at->centre[0];
            double reach = 0, nearest = 0; /* the cell's largest and least |g . x|, 1 at the sides */
            for (int k = 0; k < 2; k++) {
                const double g0 = at->g[k][0], g1 = at->g[k][1], half = (fabs(g0) + fabs(g1)) / 2;
                const double middle = fabs(g0 * (x[0] + 0.5) + g1 * (x[1] + 0.5));
                reach = larger(reach, middle + half), nearest = larger(nearest, middle - half);
            }
            if (nearest > 1) continue;
            const uint64_t cell = mu_mix(row + MU_GOLDEN * (uint64_t)(int64_t)(at->origin[0] + i));
            count += count_cell(at, box, reach < 1, x, cell);
        }
    }
    return count;
}

mu_flake_tally mu_flake_count(const mu_flakes *flakes, const double footprint[6],
                              const mu_flake_normals *box) {
    const mu_flake_tally smooth = {1, 1, 0};
    if (!(flakes->density > 0)) return smooth;
    double a[2], b[2];
    widen(footprint, 0.5 / sqrt(flakes->density), a, b);
    const double size = 4 * fabs(a[0] * b[1] - a[1] * b[0]),
                 around = 2 * (fabs(a[0]) + fabs(a[1]) + fabs(b[0]) + fabs(b[1]));
    mu_flake_tally tally = {0, flakes->density * size * (box->p[1] - box->p[0]) * box->q_width, 0};
    if (!(tally.expected > 0 && tally.expected < SMOOTH && box->q >= 0 && fabs(footprint[0]) <= DBL_MAX &&
          fabs(footprint[1]) <= DBL_MAX))
        return smooth;

    double side = flakes->side, rings = flakes->rings;
    const double outer = sqrt(box->p[1]), width = outer - sqrt(box->p[0]);
    for (;; tally.thinning++, tally.expected /= 4) {
        const double positions = size / side / side + around / side + 1;
        const double normals = (width * rings + 1) * smaller(2 * outer * rings * box->q_width + 1, 2 * rings);
        if (positions * (normals + 2) <= WORK) break;
        if (positions > normals || rings < 2)
            side *= 2;
        else
            rings /= 2;
    }
    const area at = area_make(footprint, a, b, side);
    const kinds in = kinds_make(box, rings);
    tally.count = (double)count_cells(
        &at, &in, mu_mix(flakes->seed + MU_GOLDEN * (uint64_t)tally.thinning + (uint64_t)rings));
    return tally;
}

double mu_flake_ratio(const mu_flakes *flakes, const double footprint[6], const mu_flake_normals *box) {
    const mu_flake_tally tally = mu_flake_count(flakes, footprint, box);
    return 1 + ldexp(tally.count / tally.expected - 1, -tally.thinning);
}

#endif
