/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_quadrature.c: globally adaptive tensor Gauss-Kronrod cubature; see check_quadrature.h.
 *
 * Nodes and weights: zeros of the Legendre and Stieltjes polynomials, computed with 40 digits (tests hold
 * them to exactness for polynomials).
 */
#include "core/render/check_quadrature.h"

#include <math.h>
#include <stdlib.h>

#define MAX_NODES 15

/* Non-negative half of a symmetric rule on [-1,1]; gauss is 0 at nodes of the Kronrod rule alone. */
typedef struct half_rule {
    size_t count;
    double node[8], kronrod[8], gauss[8];
} half_rule;

static const half_rule half_rules[] = {
    [MU_KRONROD_7] = {4,
                      {0, 0.4342437493468025580021, 0.7745966692414833770359, 0.9604912687080202834235},
                      {0.4509165386584741423451, 0.4013974147759622229051, 0.2684880898683334407286,
                       0.1046562260264672651938},
                      {0.8888888888888888888889, 0, 0.5555555555555555555556, 0}},
    [MU_KRONROD_15] = {8,
                       {0, 0.2077849550078984676007, 0.4058451513773971669066, 0.5860872354676911302941,
                        0.7415311855993944398639, 0.8648644233597690727897, 0.9491079123427585245262,
                        0.9914553711208126392069},
                       {0.209482141084727828013, 0.2044329400752988924142, 0.1903505780647854099133,
                        0.1690047266392679028266, 0.1406532597155259187452, 0.1047900103222501838399,
                        0.0630920926299785532907, 0.02293532201052922496373},
                       {0.4179591836734693877551, 0, 0.3818300505051189449504, 0, 0.2797053914892766679015, 0,
                        0.1294849661688696932706, 0}},
};

typedef struct full_rule {
    size_t count;
    double node[MAX_NODES], kronrod[MAX_NODES], gauss[MAX_NODES];
} full_rule;

static full_rule unfold(mu_rule which) {
    const half_rule *half = &half_rules[which];
    full_rule full = {.count = 2 * half->count - 1};
    for (size_t i = 0; i < half->count; i++) {
        const size_t right = half->count - 1 + i, left = half->count - 1 - i;
        full.node[right] = half->node[i];
        full.node[left] = -half->node[i];
        full.kronrod[left] = full.kronrod[right] = half->kronrod[i];
        full.gauss[left] = full.gauss[right] = half->gauss[i];
    }
    return full;
}

typedef struct panel {
    double low[2], high[2];
    double value[MU_PARTS], error[MU_PARTS];
    double urgency; /* largest error in units of its target */
    int axis;       /* to halve */
} panel;

static void measure(const mu_quadrature *q, const full_rule *rule, panel *p) {
    double across[2][MU_PARTS] = {{0}}; /* Gauss in one direction, Kronrod in the other */
    double value[MU_PARTS] = {0};
    const double cx = (p->low[0] + p->high[0]) / 2, hx = (p->high[0] - p->low[0]) / 2;
    const double cy = (p->low[1] + p->high[1]) / 2, hy = (p->high[1] - p->low[1]) / 2;
    for (size_t i = 0; i < rule->count; i++)
        for (size_t j = 0; j < rule->count; j++) {
            double f[MU_PARTS] = {0};
            q->integrand(q->context, cx + hx * rule->node[i], cy + hy * rule->node[j], f);
            for (size_t k = 0; k < q->parts; k++) {
                value[k] += rule->kronrod[i] * rule->kronrod[j] * f[k];
                across[0][k] += rule->gauss[i] * rule->kronrod[j] * f[k];
                across[1][k] += rule->kronrod[i] * rule->gauss[j] * f[k];
            }
        }
    double worst[2] = {0, 0};
    p->urgency = 0;
    for (size_t k = 0; k < q->parts; k++) {
        const double e0 = 4 * fabs(value[k] - across[0][k]) * hx * hy;
        const double e1 = 4 * fabs(value[k] - across[1][k]) * hx * hy;
        p->value[k] = value[k] * hx * hy;
        p->error[k] = e0 + e1;
        if (!(q->target[k] > 0)) continue;
        worst[0] = fmax(worst[0], e0 / q->target[k]);
        worst[1] = fmax(worst[1], e1 / q->target[k]);
        p->urgency = fmax(p->urgency, (e0 + e1) / q->target[k]);
    }
    p->axis = worst[1] > worst[0];
}

/* The heap's root is the most urgent panel. */
static void sift_down(panel *heap, size_t count, size_t at) {
    for (;;) {
        size_t top = at;
        for (size_t child = 2 * at + 1; child <= 2 * at + 2; child++)
            if (child < count && heap[child].urgency > heap[top].urgency) top = child;
        if (top == at) return;
        const panel swap = heap[at];
        heap[at] = heap[top];
        heap[top] = swap;
        at = top;
    }
}

static void sift_up(panel *heap, size_t at) {
    while (at && heap[at].urgency > heap[(at - 1) / 2].urgency) {
        const panel swap = heap[at];
        heap[at] = heap[(at - 1) / 2];
        heap[(at - 1) / 2] = swap;
        at = (at - 1) / 2;
    }
}

static void sum_up(const mu_quadrature *q, const panel *heap, mu_integral *out) {
    out->resolved = 1;
    for (size_t k = 0; k < q->parts; k++) {
        out->value[k] = out->error[k] = 0;
        for (size_t i = 0; i < out->panels; i++) {
            out->value[k] += heap[i].value[k];
            out->error[k] += heap[i].error[k];
        }
        if (q->target[k] > 0 && !(out->error[k] <= q->target[k])) out->resolved = 0;
    }
}

mu_integral mu_integrate(const mu_quadrature *q, const double x[2], size_t columns, const double y[2],
                         size_t rows) {
    const full_rule rule = unfold(q->rule);
    const size_t limit = q->panel_limit > columns * rows ? q->panel_limit : columns * rows;
    mu_integral out = {.panels = 0};
    panel *heap = malloc(limit * sizeof *heap);
    if (!heap) return out;
    for (size_t i = 0; i < columns; i++)
        for (size_t j = 0; j < rows; j++) {
            panel *p = &heap[out.panels];
            for (size_t end = 0; end < 2; end++) {
                (end ? p->high : p->low)[0] = x[0] + (x[1] - x[0]) * (double)(i + end) / (double)columns;
                (end ? p->high : p->low)[1] = y[0] + (y[1] - y[0]) * (double)(j + end) / (double)rows;
            }
            measure(q, &rule, p);
            sift_up(heap, out.panels++);
        }
    /* Summing anew after each halving would be quadratic in the panels: every few suffices. */
    for (sum_up(q, heap, &out); !out.resolved && out.panels < limit; sum_up(q, heap, &out))
        for (size_t n = out.panels / 8 + 1; n && out.panels < limit; n--) {
            panel *first = &heap[0], *second = &heap[out.panels];
            *second = *first;
            const double middle = (first->low[first->axis] + first->high[first->axis]) / 2;
            second->low[first->axis] = first->high[first->axis] = middle;
            measure(q, &rule, first);
            measure(q, &rule, second);
            sift_down(heap, out.panels, 0);
            sift_up(heap, out.panels++);
        }
    free(heap);
    return out;
}
