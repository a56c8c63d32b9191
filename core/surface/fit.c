/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* fit.c: fits every candidate, ranks them, and says whether the best explains the surface. */
#include "core/surface/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/surface/minimise.h"

/* Of the mean score per facet, whose standard error is of order 1/sqrt(independent facets): a hundredth of it at 10^6. */
static const double still = 1e-5;

typedef struct mu_work {
    mu_fit *fit;
    const mu_slopes *s;
    mu_cloud cloud;
    mu_likelihood l;
    const mu_point_set *set; /* of the fit that runs */
    double (*scores)[MU_MOST_PARAMETERS];
} mu_work;

static double ask(void *context, const double *x, double *gradient) {
    mu_work *w = context;
    const size_t n = (size_t)mu_candidate_parameters(w->l.candidate);
    double all[MU_MOST_PARAMETERS] = {0}, g[MU_MOST_PARAMETERS];
    memcpy(all, x, n * sizeof *all);
    const double value = mu_likelihood_at(&w->l, w->set, all, g);
    memcpy(gradient, g, n * sizeof *g);
    return value;
}

static double search(mu_work *w, int set, double *parameters, _Bool *converged) {
    w->set = &w->cloud.sets[set];
    return mu_minimise(ask, w, mu_candidate_parameters(w->l.candidate), parameters, still, converged);
}

/* The best of its starts. */
static double fit_all(mu_work *w, mu_fitted *f) {
    const double *m = w->cloud.shape, alpha = sqrt(m[0] * m[3] - m[1] * m[2]);
    double best = INFINITY, start[MU_MOST_PARAMETERS];
    for (int k = 0; mu_candidate_start(f->candidate, k, alpha, start); k++) {
        _Bool converged;
        const double value = search(w, MU_FOLDS, start, &converged);
        if (!(value < best)) continue;
        best = value;
        f->converged = converged;
        memcpy(f->parameters, start, sizeof start);
    }
    return best;
}

/* False if nothing came of it. */
static _Bool fit_one(mu_work *w, mu_fitted *f) {
    double halves[MU_FOLDS][MU_MOST_PARAMETERS], gradient[MU_MOST_PARAMETERS];
    const double facets = w->cloud.sets[MU_FOLDS].facets;
    _Bool converged;
    w->l.candidate = f->candidate;
    w->l.scores = NULL;
    const double value = fit_all(w, f);
    if (!isfinite(value)) return 0;
    f->likelihood = -value * facets;
    f->at_end = mu_candidate_at_end(f->candidate, f->parameters);
    mu_candidate_tell(f->candidate, &w->cloud, f->parameters, &f->told);
    f->held_out = 0;
    for (int fold = 0; fold < MU_FOLDS; fold++) {
        memcpy(halves[fold], f->parameters, sizeof halves[fold]);
        search(w, fold, halves[fold], &converged);
        const mu_point_set *other = &w->cloud.sets[1 - fold];
        f->held_out -= mu_likelihood_at(&w->l, other, halves[fold], gradient) * (other->facets / facets);
    }
    w->l.scores = w->scores;
    const _Bool sure = mu_fit_errors(f, &w->l, w->fit->blocks);
    w->l.scores = NULL;
    return mu_fit_residual(f, (const double(*)[MU_MOST_PARAMETERS])halves, &w->cloud, w->s, w->fit->blocks,
                           &w->l) &&
           sure;
}

static _Bool explains(const mu_fit *fit, const mu_fitted *f) {
    const mu_partition *const all[] = {&f->residual.steepness, &f->residual.azimuth, &f->residual.joint};
    for (int k = 0; k < 3; k++)
        if (!(all[k]->variation <= fit->tolerance + 2 * all[k]->noise)) return 0;
    return 1;
}

static int better(const void *a, const void *b) {
    const double x = ((const mu_fitted *)a)->criterion, y = ((const mu_fitted *)b)->criterion;
    return (x > y) - (x < y);
}

/* One measure of how many facets count as one: that of the likeliest candidate. */
static void rank(mu_fit *fit) {
    const mu_fitted *likeliest = fit->fitted;
    for (int k = 1; k < fit->count; k++)
        if (fit->fitted[k].likelihood > likeliest->likelihood) likeliest = &fit->fitted[k];
    const double alike = fmax(likeliest->alike, 1);
    fit->effective = fit->facets / alike;
    for (int k = 0; k < fit->count; k++) {
        mu_fitted *f = &fit->fitted[k];
        f->criterion =
            -2 * f->likelihood / alike + mu_candidate_parameters(f->candidate) * log(fit->effective);
        f->explains = explains(fit, f);
    }
    qsort(fit->fitted, (size_t)fit->count, sizeof *fit->fitted, better);
}

/* Blocks of at least 12 correlation lengths, down to 6 a side, then of 4. */
static uint32_t choose_blocks(const mu_slopes *s, double correlation) {
    static const uint32_t sides[] = {MU_PATCHES, 12, 8, 6};
    const double side = mu_slopes_side(s);
    for (int k = 0; k < 4; k++)
        if (side / sides[k] >= 12 * correlation) return sides[k];
    return side / 6 >= 4 * correlation ? 6 : 0;
}

static void work(mu_work *w) {
    mu_fit *fit = w->fit;
    const double side = mu_slopes_side(w->s);
    fit->correlation = w->cloud.correlation;
    fit->blocks = choose_blocks(w->s, fit->correlation);
    if (!fit->blocks) {
        fit->verdict = MU_FIT_REFUSED;
        snprintf(fit->reason, sizeof fit->reason,
                 "too few independent facets: they are alike over %.1f cells, and 6 x 6 blocks of 4 such "
                 "lengths need "
                 "%.0f cells a side, not %.0f",
                 fit->correlation, ceil(24 * fit->correlation), side);
        return;
    }
    w->scores = malloc((MU_BINS + 1) * sizeof *w->scores);
    w->l.cloud = &w->cloud;
    if (!w->scores || !mu_cloud_fill(&w->cloud, w->s)) {
        fit->verdict = MU_FIT_NO_MEMORY;
        return;
    }
    for (int k = 0; k < MU_CANDIDATES; k++) {
        mu_fitted *f = &fit->fitted[fit->count];
        *f = (mu_fitted){.candidate = mu_candidate_get(k)};
        if (fit_one(w, f)) fit->count++;
    }
    if (!fit->count) {
        fit->verdict = MU_FIT_REFUSED;
        snprintf(fit->reason, sizeof fit->reason, "no candidate could be fitted at all");
        return;
    }
    rank(fit);
    fit->verdict = fit->fitted[0].explains ? MU_FIT_EXPLAINED : MU_FIT_REFUSED;
    if (fit->verdict == MU_FIT_REFUSED) mu_fit_blame(&fit->fitted[0], fit->tolerance, fit->reason);
}

void mu_fit_slopes(mu_fit *fit, const mu_slopes *s) {
    mu_work w = {.fit = fit, .s = s};
    double *sample = malloc((size_t)2 * MU_SAMPLE * sizeof *sample);
    const double side = mu_slopes_side(s);
    fit->facets = 2 * side * side;
    fit->count = 0;
    fit->verdict = MU_FIT_EXPLAINED;
    fit->reason[0] = 0;
    fit->step = 0;
    fit->effective = fit->correlation = NAN;
    fit->blocks = 0;
    const uint32_t count = sample ? mu_cloud_sample(s, sample) : 0;
    if (!sample) {
        fit->verdict = MU_FIT_NO_MEMORY;
    } else if (mu_fit_examine(fit, s, sample, count)) {
        if (mu_cloud_pilot(&w.cloud, s, fit->keep, sample, count)) {
            work(&w);
        } else {
            fit->verdict = MU_FIT_REFUSED;
            snprintf(
                fit->reason, sizeof fit->reason,
                "slopes lie on a line, as those of a grating or of ridges: no invertible M spreads them");
        }
    }
    free(sample);
    free(w.scores);
    free(w.l.memory);
    mu_cloud_free(&w.cloud);
}
