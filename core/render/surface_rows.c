/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_rows.c: each thread takes the next few rows. Threads that cannot be started leave their share to the others. */
#include "core/render/surface_rows.h"

#include <pthread.h>
#include <stdatomic.h>

enum { MOST_THREADS = 256, TAKEN = 4 };

typedef struct mu_rows_job {
    uint32_t count;
    atomic_uint next;
    void (*work)(void *context, uint32_t row);
    void *context;
} mu_rows_job;

static void *take_rows(void *data) {
    mu_rows_job *job = data;
    for (;;) {
        const uint32_t first = atomic_fetch_add(&job->next, TAKEN);
        if (first >= job->count) return NULL;
        for (uint32_t row = first; row < first + TAKEN && row < job->count; row++)
            job->work(job->context, row);
    }
}

void mu_rows(uint32_t count, uint32_t threads, void (*work)(void *context, uint32_t row), void *context) {
    mu_rows_job job = {.count = count, .work = work, .context = context};
    pthread_t started[MOST_THREADS];
    uint32_t more = 0;
    while (more + 1 < threads && more < MOST_THREADS &&
           pthread_create(&started[more], NULL, take_rows, &job) == 0)
        more++;
    take_rows(&job);
    for (uint32_t k = 0; k < more; k++) pthread_join(started[k], NULL);
}
