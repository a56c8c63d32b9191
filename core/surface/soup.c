/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * soup.c: exact visibility by cutting polygons.
 *
 * Everything happens in the triangle's own coordinates: p = p0 + b e1 + c e2 + t w, with w the direction, so (b, c) is
 * where p falls on the triangle's plane along w and t how far before it p stands. The triangle is (0,0) (1,0) (0,1), its
 * area 1/2, whatever the direction.
 */
#include "core/surface/soup.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 16, PIECES = 512 };

typedef struct polygon { /* convex, counterclockwise */
    double p[CORNERS][2];
    int count;
} polygon;

typedef struct pieces {
    polygon list[PIECES];
    int count;
} pieces;

static double area(const polygon *q) {
    double sum = 0;
    for (int k = 0; k < q->count; k++) {
        const double *a = q->p[k], *b = q->p[(k + 1) % q->count];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum / 2;
}

/* The part of q where side(x) = n . x - offset >= 0. False if it has too many corners. */
static _Bool cut(const polygon *q, const double n[2], double offset, polygon *out) {
    out->count = 0;
    for (int k = 0; k < q->count; k++) {
        const double *a = q->p[k], *b = q->p[(k + 1) % q->count];
        const double sa = n[0] * a[0] + n[1] * a[1] - offset, sb = n[0] * b[0] + n[1] * b[1] - offset;
        if (out->count + 2 > CORNERS) return 0;
        if (sa >= 0) memcpy(out->p[out->count++], a, sizeof out->p[0]);
        if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
            const double t = sa / (sa - sb);
            out->p[out->count][0] = a[0] + t * (b[0] - a[0]);
            out->p[out->count++][1] = a[1] + t * (b[1] - a[1]);
        }
    }
    return 1;
}

/* Slivers that rounding leaves at shared edges: all that fit into PIECES together are below 1e-11 of the triangle. */
static const double sliver = 1e-14;

/* Whether they share an area; *good becomes false if there are too many corners. */
static _Bool overlap(const polygon *piece, const polygon *shadow, _Bool *good) {
    polygon rest = *piece;
    for (int e = 0; e < shadow->count && rest.count >= 3; e++) {
        const double *a = shadow->p[e], *b = shadow->p[(e + 1) % shadow->count];
        const double inward[2] = {a[1] - b[1], b[0] - a[0]};
        polygon inside;
        if (!cut(&rest, inward, inward[0] * a[0] + inward[1] * a[1], &inside)) {
            *good = 0;
            return 0;
        }
        rest = inside;
    }
    return rest.count >= 3 && area(&rest) > sliver;
}

/* Takes the shadow away from every piece that it falls on: what lies outside one of its edges after the other is kept. */
static _Bool subtract(pieces *all, const polygon *shadow) {
    const int before = all->count;
    int kept = 0;
    pieces *const list = all;
    for (int k = 0; k < before; k++) {
        polygon rest = list->list[k];
        _Bool first = 1, good = 1;            /* the first part that is kept may take the old piece's place */
        if (!overlap(&rest, shadow, &good)) { /* not to be cut into parts for nothing */
            if (!good) return 0;
            list->list[kept++] = rest;
            continue;
        }
        for (int e = 0; e < shadow->count && rest.count >= 3; e++) {
            const double *a = shadow->p[e], *b = shadow->p[(e + 1) % shadow->count];
            const double inward[2] = {a[1] - b[1], b[0] - a[0]}, outward[2] = {-inward[0], -inward[1]};
            const double offset = inward[0] * a[0] + inward[1] * a[1];
            polygon outside, inside;
            if (!cut(&rest, outward, -offset, &outside) || !cut(&rest, inward, offset, &inside)) return 0;
            if (outside.count >= 3 && area(&outside) > sliver) {
                if (first) {
                    list->list[kept++] = outside;
                    first = 0;
                } else if (list->count < PIECES) {
                    list->list[list->count++] = outside;
                } else {
                    return 0;
                }
            }
            rest = inside;
        }
    }
    /* New pieces were put at the end; close the gap between those kept and them. */
    memmove(&list->list[kept], &list->list[before], (size_t)(list->count - before) * sizeof list->list[0]);
    list->count = kept + list->count - before;
    return 1;
}

typedef struct frame {
    double origin[3], b[3], c[3], t[3]; /* rows: (p - origin) . b, . c, . t */
} frame;

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* False if the triangle turns away from w. */
static _Bool make_frame(frame *f, const mu_triangle *triangle, const double w[3]) {
    double e1[3], e2[3];
    for (int k = 0; k < 3; k++) {
        f->origin[k] = triangle->p[0][k];
        e1[k] = triangle->p[1][k] - triangle->p[0][k];
        e2[k] = triangle->p[2][k] - triangle->p[0][k];
    }
    cross(e1, e2, f->t);
    const double facing = dot(f->t, w);
    if (!(facing > 0)) return 0;
    cross(e2, w, f->b);
    cross(w, e1, f->c);
    for (int k = 0; k < 3; k++) f->b[k] /= facing, f->c[k] /= facing, f->t[k] /= facing;
    return 1;
}

/* Corners that all but coincide become one: the edge between them has no direction worth cutting along. */
static void join(polygon *q) {
    int count = 0;
    for (int k = 0; k < q->count; k++) {
        const double *a = q->p[k], *b = q->p[(k + 1) % q->count];
        const double near = 1e-12 * (1 + fabs(a[0]) + fabs(a[1]));
        if (fabs(a[0] - b[0]) > near || fabs(a[1] - b[1]) > near) memmove(q->p[count++], a, sizeof q->p[0]);
    }
    q->count = count;
}

/* What of the other triangle, moved in the plane, stands before the frame's plane, projected; fewer than 3: nothing. */
static void shadow_of(const frame *f, const mu_triangle *other, const double move[2], polygon *out) {
    double q[3][3];
    out->count = 0;
    for (int k = 0; k < 3; k++) {
        const double d[3] = {other->p[k][0] + move[0] - f->origin[0], other->p[k][1] + move[1] - f->origin[1],
                             other->p[k][2] - f->origin[2]};
        q[k][0] = dot(d, f->b);
        q[k][1] = dot(d, f->c);
        q[k][2] = dot(d, f->t);
    }
    for (int k = 0; k < 3; k++) {
        const double *a = q[k], *b = q[(k + 1) % 3];
        if (a[2] >= 0) memcpy(out->p[out->count++], a, sizeof out->p[0]);
        if ((a[2] > 0 && b[2] < 0) || (a[2] < 0 && b[2] > 0)) {
            const double s = a[2] / (a[2] - b[2]);
            out->p[out->count][0] = a[0] + s * (b[0] - a[0]);
            out->p[out->count++][1] = a[1] + s * (b[1] - a[1]);
        }
    }
    join(out);
    const double size = out->count >= 3 ? area(out) : 0;
    if (size < 0) { /* seen from behind: turn it round */
        for (int k = 0; k < out->count / 2; k++) {
            double swap[2];
            memcpy(swap, out->p[k], sizeof swap);
            memcpy(out->p[k], out->p[out->count - 1 - k], sizeof swap);
            memcpy(out->p[out->count - 1 - k], swap, sizeof swap);
        }
    }
    if (fabs(size) < sliver) out->count = 0; /* edge-on, or in the plane itself only along an edge */
}

static _Bool apart(const polygon *q) { /* from the triangle 0 <= b, 0 <= c, b + c <= 1 */
    _Bool left = 1, below = 1, beyond = 1;
    for (int k = 0; k < q->count; k++) {
        left = left && q->p[k][0] <= 0;
        below = below && q->p[k][1] <= 0;
        beyond = beyond && q->p[k][0] + q->p[k][1] >= 1;
    }
    return left || below || beyond;
}

/* Extremes of all corners: low[3], high[3]. */
static void bounds(const mu_soup *soup, double low[3], double high[3]) {
    for (int c = 0; c < 3; c++) low[c] = INFINITY, high[c] = -INFINITY;
    for (size_t k = 0; k < soup->count; k++)
        for (int corner = 0; corner < 3; corner++)
            for (int c = 0; c < 3; c++) {
                low[c] = fmin(low[c], soup->triangles[k].p[corner][c]);
                high[c] = fmax(high[c], soup->triangles[k].p[corner][c]);
            }
}

/* The periods that a ray from the first one along w may meet: range[0...3] least and largest of either vector. */
static void reach(const mu_soup *soup, const double w[3], double range[4]) {
    double low[3], high[3];
    bounds(soup, low, high);
    const double(*e)[2] = soup->period;
    const double det = e[0][0] * e[1][1] - e[0][1] * e[1][0], t = (high[2] - low[2]) / w[2];
    range[0] = range[2] = INFINITY, range[1] = range[3] = -INFINITY;
    for (int corner = 0; corner < 8;
         corner++) { /* from anywhere to anywhere, at the start and at the end of the ray */
        const double x = (corner & 1 ? 1 : -1) * (high[0] - low[0]) + (corner & 4 ? t * w[0] : 0);
        const double y = (corner & 2 ? 1 : -1) * (high[1] - low[1]) + (corner & 4 ? t * w[1] : 0);
        const double a = (x * e[1][1] - y * e[1][0]) / det, b = (e[0][0] * y - e[0][1] * x) / det;
        range[0] = fmin(range[0], floor(a)), range[1] = fmax(range[1], ceil(a));
        range[2] = fmin(range[2], floor(b)), range[3] = fmax(range[3], ceil(b));
    }
}

double mu_soup_visible(const mu_soup *soup, size_t index, const double (*w)[3], size_t directions) {
    pieces all = {.count = 1};
    all.list[0] = (polygon){.p = {{0, 0}, {1, 0}, {0, 1}}, .count = 3};
    for (size_t d = 0; d < directions; d++) {
        frame f;
        double range[4];
        if (!make_frame(&f, &soup->triangles[index], w[d])) return 0;
        reach(soup, w[d], range);
        for (double a = range[0]; a <= range[1]; a++)
            for (double b = range[2]; b <= range[3]; b++)
                for (size_t k = 0; k < soup->count && all.count; k++) {
                    if (k == index && a == 0 && b == 0) continue;
                    const double move[2] = {a * soup->period[0][0] + b * soup->period[1][0],
                                            a * soup->period[0][1] + b * soup->period[1][1]};
                    polygon shadow;
                    shadow_of(&f, &soup->triangles[k], move, &shadow);
                    if (shadow.count < 3 || apart(&shadow)) continue;
                    if (!subtract(&all, &shadow)) return -1;
                }
    }
    double sum = 0;
    for (int k = 0; k < all.count; k++) sum += area(&all.list[k]);
    return 2 * sum;
}
