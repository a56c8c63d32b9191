/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * wavefront.c: hits are gathered a block at a time from the host's columns into records, bound, shaded by the plugin's
 * batch functions, and scattered again. Blocks are dealt out to threads, which live as long as the call: a wavefront of a
 * host has some hundred thousand hits, next to which starting a thread is free.
 */
#include "plugin/mitsuba/wavefront.h"

#include <pthread.h>
#include <stdatomic.h>

enum { BLOCK = 64, MOST_THREADS = 256, BYTES = 8 * MUSURF_WAVEFRONT_CLOSURE };

/* One call, shared by its threads. */
typedef struct work {
    const musurf_wavefront *w;
    const musurf_column *in; /* wi, or u */
    const musurf_wavefront_values *values;
    const musurf_wavefront_samples *samples;
    atomic_size_t next; /* the first hit that nobody has taken */
} work;

/* The hits of a block that are shaded: their number in the wavefront, and what the batch functions take. */
typedef struct block {
    size_t hit[BLOCK], count;
    float in[BLOCK][3];
    _Alignas(64) unsigned char closures[BYTES];
} block;

static inline float at(musurf_column column, size_t i) {
    return column.data[i * column.step];
}

static inline void gather(const musurf_column from[3], size_t i, float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = at(from[k], i);
}

static size_t stride_of(const musurf_wavefront *w) {
    const size_t a = w->closure_alignment ? w->closure_alignment : 1;
    return (w->closure_bytes + a - 1) / a * a;
}

static void blank_value(const musurf_wavefront_values *out, size_t i) {
    for (int k = 0; k < 3; k++) out->f[k][i] = 0;
    out->pdf[i] = 0;
}

static void blank_sample(const musurf_wavefront_samples *out, size_t i) {
    for (int k = 0; k < 3; k++) out->wi[k][i] = k == 2, out->weight[k][i] = 0;
    out->pdf[i] = 0, out->eta[i] = 1, out->lobe[i] = 0;
}

/* Binds what can be seen of the hits [begin, end); blanks the answers of the rest. */
static void bind(const work *job, size_t begin, size_t end, block *b) {
    const musurf_wavefront *w = job->w;
    const size_t stride = stride_of(w);
    float slots[MUSURF_WAVEFRONT_SLOTS];
    b->count = 0;
    for (size_t i = begin; i < end; i++) {
        _Bool there = !w->active || w->active[i * w->active_step];
        if (there) {
            float wo[3];
            gather(w->wo, i, wo);
            for (uint32_t s = 0; w->slots && s < w->slot_floats; s++) slots[s] = at(w->slots[s], i);
            there = w->type->setup(w->material, wo, w->slots ? slots : NULL, w->mode,
                                   b->closures + b->count * stride) != 0;
        }
        if (there) {
            gather(job->in, i, b->in[b->count]);
            b->hit[b->count++] = i;
        } else if (job->values) {
            blank_value(job->values, i);
        } else {
            blank_sample(job->samples, i);
        }
    }
}

static void eval_block(const work *job, const block *b) {
    musurf_value values[BLOCK];
    job->w->type->eval_batch(b->closures, stride_of(job->w), b->in[0], sizeof b->in[0], job->w->lobes, values,
                             sizeof values[0], b->count);
    for (size_t j = 0; j < b->count; j++) {
        const size_t i = b->hit[j];
        for (int k = 0; k < 3; k++) job->values->f[k][i] = values[j].f[k];
        job->values->pdf[i] = values[j].pdf;
    }
}

static void sample_block(const work *job, const block *b) {
    musurf_sample samples[BLOCK];
    const musurf_wavefront_samples *out = job->samples;
    job->w->type->sample_batch(b->closures, stride_of(job->w), b->in[0], sizeof b->in[0], job->w->lobes,
                               samples, sizeof samples[0], b->count);
    for (size_t j = 0; j < b->count; j++) {
        const size_t i = b->hit[j];
        const musurf_sample *s = samples + j;
        if (!s->lobe) {
            blank_sample(out, i);
            continue;
        }
        for (int k = 0; k < 3; k++) out->wi[k][i] = s->wi[k], out->weight[k][i] = s->weight[k];
        out->pdf[i] = s->pdf, out->eta[i] = s->eta, out->lobe[i] = s->lobe;
    }
}

static void *shade(void *argument) {
    work *job = argument;
    const size_t stride = stride_of(job->w), room = stride ? BYTES / stride : BLOCK,
                 step = room < BLOCK ? room : BLOCK;
    block b;
    for (;;) {
        const size_t begin = atomic_fetch_add(&job->next, step), count = job->w->count;
        if (begin >= count) return NULL;
        bind(job, begin, count - begin < step ? count : begin + step, &b);
        if (b.count == 0) continue;
        if (job->values)
            eval_block(job, &b);
        else
            sample_block(job, &b);
    }
}

/* A thread that cannot be had leaves its share to the others. */
static void run(work *job) {
    enum { WORTH_A_THREAD = 4096 }; /* hits, of some 50 ns each: several times what starting one takes */
    pthread_t threads[MOST_THREADS];
    const size_t most = job->w->count / WORTH_A_THREAD;
    size_t wanted = job->w->threads ? job->w->threads - 1 : 0, started = 0;
    if (wanted > most) wanted = most;
    if (wanted > MOST_THREADS) wanted = MOST_THREADS;
    while (started < wanted && pthread_create(&threads[started], NULL, shade, job) == 0) started++;
    shade(job);
    while (started) pthread_join(threads[--started], NULL);
}

uint32_t musurf_wavefront_closure_limit(void) {
    return MUSURF_WAVEFRONT_CLOSURE;
}

uint32_t musurf_wavefront_slot_limit(void) {
    return MUSURF_WAVEFRONT_SLOTS;
}

void musurf_wavefront_eval(const musurf_wavefront *w, const musurf_column wi[3],
                           const musurf_wavefront_values *out) {
    work job = {.w = w, .in = wi, .values = out};
    run(&job);
}

void musurf_wavefront_sample(const musurf_wavefront *w, const musurf_column u[3],
                             const musurf_wavefront_samples *out) {
    work job = {.w = w, .in = u, .samples = out};
    run(&job);
}
