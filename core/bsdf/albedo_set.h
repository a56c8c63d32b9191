/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_set.h: all tables of a surface (albedo_set.c), and which of them say what a closure loses: a mean of three at most.
 *
 * Where a microsurface is level, the mean is taken at the place (u, S) that a direction has in the frame of the closure's own
 * M: as slope roughnesses A, B fall, what is lost there tends to a function of neither (reflection at small slopes knows
 * slopes along the azimuth of the view alone, Lambda z / (A w.xy) alone; what is left is of order A²); as they rise, to 1. So
 * few tables serve all M, and the first and last of them what is beyond. The average of such a mean is no mean of averages:
 * ln of it is tabulated too, quadratic between nodes. A tilt has edges of its own: there each table keeps to its own frame.
 *
 * A surface has one table, and, if it may be blurred (compensation_blurs), one for each of some roughnesses from its own least on.
 * For an M of the point (compensation_varies) it has a grid over A and B instead of those (albedo_grid.c), and one of GGX,
 * which is what blurring makes of it. Where no table is near enough, and for all M of the point of what transmits or is not
 * level, what is lost is integrated while shading (albedo_open.c); what M alone decides, averages, is tabulated over all M
 * (albedo_means.c).
 */
#ifndef MU_ALBEDO_SET_H
#define MU_ALBEDO_SET_H

#include "core/bsdf/albedo.h"

/* Nodes along a slope roughness; what is blurred with a tilt has as many at most. */
enum {
    ALBEDO_NODES = 16,
    ALBEDO_SMOOTH_NODES = 8, /* without a table of their own */
    ALBEDO_GRID_NODES = ALBEDO_SMOOTH_NODES + ALBEDO_NODES,
    ALBEDO_BLURS = 24,
    ALBEDO_GRID_TABLES = ALBEDO_NODES * (ALBEDO_NODES + 1) / 2,
    ALBEDO_GRID_AVERAGES = ALBEDO_GRID_NODES * (2 * ALBEDO_GRID_NODES - 1),
    ALBEDO_GRID_MEAN = 3 << 9, /* floats that a table takes as a mean, and at most */
    ALBEDO_GRID_MOST = 1 << 13
};
/* Work that refining the tables of a surface may take (albedo_effort): */
enum { ALBEDO_FACETS = 80000000 };
/* How far a roughness is from one to another, all as log2: linear in A^1.5 / (1 + A^1.5), which follows both limits. */
float mu_albedo_share(float log_a, float from, float to);

/* What is lost by probes of a roughness x, and how many there are; and the nodes, `most` of them, from x to x, whose tables keep
 * interpolation to an error if they can: their number. */
enum { ALBEDO_PROBES = 48 };
typedef struct albedo_probes {
    float (*lost)(const void *context, float x, int probe);
    const void *context;
    int count;
} albedo_probes;
int mu_albedo_place_nodes(const albedo_probes *p, float from, float to, float error, int most, float *nodes);

/* Tables at slope roughnesses i >= j (albedo_grid_node); ln of the averages there and midway between. */
typedef struct albedo_grid {
    const mu_albedo *table;
    const float *log_average; /* of what is reflected: grids know nothing else */
    int count;                /* of nodes, log2 of roughnesses */
    float node[ALBEDO_GRID_NODES];
    /* what lies from a node to the next along both axes is not near enough */
    unsigned char open[ALBEDO_GRID_NODES * (ALBEDO_GRID_NODES - 1) / 2];
} albedo_grid;

/* Averages over all M of the point (albedo_means.c). */
enum {
    ALBEDO_MEANS_ROUGH = 14,
    ALBEDO_MEANS_FEW = 12, /* of what is not both tilted and transmits */
    ALBEDO_MEANS_SHAPES = 8,
    ALBEDO_MEANS_ANGLES = 10,
    ALBEDO_MEANS_GLASS = 8,  /* if azimuths are mirrored at the mean slope, of what transmits */
    ALBEDO_MEANS_EVEN = 6,   /* and of what does not */
    ALBEDO_MEANS_COARSE = 4, /* if they are, and more than 5 % may be off */
    ALBEDO_MEANS_KINDS = 3,  /* ln of the average above, and below; passes above */
    ALBEDO_MEANS_FLOATS = ALBEDO_MEANS_ROUGH * ALBEDO_MEANS_SHAPES * ALBEDO_MEANS_ANGLES * ALBEDO_MEANS_KINDS
};
typedef struct albedo_means {
    const float *value; /* NULL: there are none */
    double root
        [3]; /* the second moments of slopes about 0 are L L^T, L = [root[0] 0; root[1] root[2]], in slope units */
    double mean[2];       /* of slopes, in slope units */
    double axis;          /* from which the angle is measured */
    double middle, wide;  /* of log2 of roughnesses */
    double spread, power; /* k and p: k a^p is lost for what is by the mean slope, where both are small */
    int rows;             /* along a */
    int angles, even;     /* 1: no angle matters; even: mirrored at 0 and pi/2 */
} albedo_means;

static inline int albedo_grid_node(int i, int j) {
    return i * (i + 1) / 2 + j;
}

/* What it takes to integrate what tables leave open (albedo_open.c): what they were made of, which keeps no more of M than its
 * R(-turn) M, of cosine and sine `turn`. */
typedef struct albedo_open {
    albedo_source source;
    albedo_lengths lengths[2];
    float turn[2];
    albedo_slope slopes[]; /* of a histogram */
} albedo_open;

struct mu_albedo_set {
    int blurs;                         /* there are tables for what is blurred */
    int levels;                        /* 1 + blurs; 0: all is integrated */
    float unsure;                      /* of level[0], and of the grids */
    size_t bytes;                      /* that it takes */
    const albedo_open *open;           /* NULL: nothing is */
    const albedo_open *other;          /* of GGX, for what is blurred under an M of the point; NULL: is not */
    albedo_grid grid, blurred;         /* for an M of the point; else of no tables */
    albedo_means means, blurred_means; /* so */
    unsigned char gap[ALBEDO_BLURS];   /* what lies between level[1 + k] and the next is open */
    float log_blur[ALBEDO_BLURS];      /* log2 of the roughness of level[1 ...] */
    float log_average[2][2 * ALBEDO_BLURS]; /* of both sides: of these, and midway to the next */
    mu_albedo level[1 + ALBEDO_BLURS];
    float values[];
};

/* Memory for the set of a definition, scratch included, and making it there. */
size_t mu_albedo_set_bytes(const mu_definition *d);
void mu_albedo_set_make(const mu_definition *d, mu_albedo_set *out);
/* What there is of the definition's M, which makes V of s M^-1. */
void mu_albedo_set_choose(const mu_albedo_set *set, const double v[4], mu_lobe *out);
/* Of an M of the point, blurred or not. */
void mu_albedo_set_choose_moved(const mu_albedo_set *set, float blur, const double v[4], mu_lobe *out);
/* Blurred to alpha, which makes V of s M^-1. */
void mu_albedo_set_choose_blurred(const mu_albedo_set *set, float blur, const double v[4], mu_lobe *out);

/* Makes the tables of a grid. */
void mu_albedo_grid_make(const albedo_source *source, mu_albedo *table, albedo_room *room, albedo_grid *out);
/* Its tables for V = s M^-1; 0 if they are not near enough. */
int mu_albedo_grid_choose(const albedo_grid *grid, const double v[4], mu_lobe *out);
/* The roughness up to which they are, whatever the other. */
float mu_albedo_grid_reach(const albedo_grid *grid);

/* Makes the averages of what `open` integrates, in `values`, of ALBEDO_MEANS_FLOATS; how many it took. */
size_t mu_albedo_means_make(const albedo_source *source, const albedo_open *open, float *values,
                            albedo_means *out);
/* What is lost on average, above and below, and passes above: by integration. */
void mu_albedo_means_measure(const albedo_means *means, const albedo_open *open, const mu_lobe *l,
                             double mean[ALBEDO_MEANS_KINDS]);
/* The lobe of V = s M^-1, to be integrated. */
void mu_albedo_means_choose(const albedo_means *means, const albedo_open *open, const double v[4],
                            mu_lobe *out);
/* Of a table of averages whose values are not made yet: V at a node, and whether an angle matters there. */
int mu_albedo_means_view(const albedo_means *means, int rough, int shape, int angle, double v[4]);
/* V of a, b and an angle. */
void mu_albedo_means_place(const albedo_means *means, double a, double b, double angle, double v[4]);
/* About what is lost on average. */
double mu_albedo_means_about(const albedo_means *means, const double v[4]);
/* The lobe but for its averages. */
void mu_albedo_means_aim(const albedo_means *means, const albedo_open *open, const double v[4], mu_lobe *out);
static inline size_t albedo_means_node(const albedo_means *m, int rough, int shape, int angle) {
    return ALBEDO_MEANS_KINDS * (size_t)((rough * ALBEDO_MEANS_SHAPES + shape) * m->angles + angle);
}

/* The frame in which a table of a lobe is read. */
static inline const mu_albedo_frame *lobe_frame(const mu_lobe *l, const mu_albedo *t) {
    return t->quadrants == 1 ? &l->frame : &t->frame;
}

/* A closure of single scattering toward w, on a side; 0 if it sees nothing. */
int mu_albedo_bind_at(const albedo_open *open, const mu_lobe *l, int side, const float w[3], mu_closure_f *c);
/* What is lost there, by integration: lobe_lost where a patch is open. */
float mu_albedo_lost_at(const mu_lobe *l, int side, const float w[3]);

/* The average of a lobe, by integration. */
static inline double lobe_average(const mu_lobe *l, int side) {
    double sum = 0;
    for (int k = 0; k < l->count; k++)
        sum += (double)l->share[k] *
               mu_albedo_average(l->level[k], lobe_frame(l, l->level[k]), &l->level[k]->side[side]);
    return sum;
}

/* So many directions are drawn by their cosine alone: within a cell E may be anything, and so might weights be. Without tables
 * half are, and the others evenly over u and S, which bounds weights at the horizon of what is smooth. */
static const float lobe_even = 0.125f, lobe_blind = 0.5f;
/* Has u and S of a lobe's own frame, S a logarithm. */
static inline mu_albedo lobe_square(const mu_lobe *l) {
    return (mu_albedo){
        .frame = l->frame, .quadrants = 1, .columns = ALBEDO_COLUMNS, .side = {{.worldly = 1}}};
}
static inline float lobe_blind_density(const mu_lobe *l, const float w[3]) {
    const mu_albedo t = lobe_square(l);
    return fminf((1 - lobe_blind) / 4 * albedo_root(&t, &t.side[0], &l->frame, w).stretch, 0x1p+126f) +
           lobe_blind * 0.31830989f * w[2];
}

/* What is lost toward w, on a side, as tables say it, and the density of lobe_draw, 1/sr; `open`: it is not near enough. */
static inline float lobe_told(const mu_lobe *l, int side, const float w[3], float *density, int *open) {
    float lost = 0;
    *density = 0, *open = l->open;
    if (!l->count) {
        *density = lobe_blind_density(l, w), *open = 1;
        return 1;
    }
    for (int k = 0; k < l->count; k++) {
        const mu_albedo *t = l->level[k];
        const albedo_place at = albedo_locate(t, &t->side[side], lobe_frame(l, t), w);
        lost += l->share[k] * albedo_lost(&t->side[side], at);
        *density += l->share[k] * albedo_density(t, &t->side[side], at);
        *open |= t->side[side].patch[at.patch].open;
    }
    *density = (1 - lobe_even) * *density + lobe_even * 0.31830989f * w[2];
    return lost;
}

/* And what is lost indeed. */
static inline float lobe_lost(const mu_lobe *l, int side, const float w[3], float *density) {
    int open;
    const float told = lobe_told(l, side, w, density, &open);
    return open ? mu_albedo_lost_at(l, side, w) : told;
}

static inline void lobe_draw(const mu_lobe *l, int side, float u0, float u1, float w[3]) {
    const float even = l->count ? lobe_even : lobe_blind;
    if (u0 < even) { /* by the cosine */
        const float r = sqrtf(u0 / even), phi = 6.2831853f * u1;
        w[0] = r * cosf(phi), w[1] = r * sinf(phi), w[2] = sqrtf(fmaxf(1 - u0 / even, 1e-14f));
        return;
    }
    u0 = fminf((u0 - even) / (1 - even), 0x0.ffffffp0f);
    if (!l->count) {
        const mu_albedo square = lobe_square(l);
        const int quadrant = (int)(4 * u0);
        mu_albedo_direction(&square, &square.side[0], &l->frame, quadrant, 4 * u0 - (float)quadrant, u1, w);
        return;
    }
    int k = 0;
    while (k < l->count - 1 && u0 >= l->share[k]) u0 -= l->share[k++];
    const mu_albedo *t = l->level[k];
    mu_albedo_draw(t, lobe_frame(l, t), &t->side[side], fminf(fmaxf(u0 / l->share[k], 0), 0x0.ffffffp0f), u1,
                   w);
}

#endif
