/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_run.c: see check_run.h. */
#include "core/render/check_run.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#include "core/render/check_draw.h"

typedef struct run {
    const mu_check_settings *settings;
    mu_plugins *plugins;
    const musurf_material_type *type;
    mu_check_material *given;
    size_t jobs, next, done;
    mu_tally *tallies;
    mu_error *error;
    struct timespec start;
    pthread_mutex_t lock; /* of next, done, error, and of reading materials, which may open plugins */
} run;

/* Everything that one material must satisfy by itself, seen from one side. */
static void check_side(const run *r, uint64_t index, const mu_subject *subject, mu_tally *tally) {
    const mu_check_effort *effort = &r->settings->effort;
    mu_check_normalisation(subject, effort, tally);
    for (int k = 0; k < r->settings->views; k++) {
        mu_stream random =
            mu_stream_make(r->settings->seed, index << 8 | (uint64_t)((subject->below ? 48 : 16) + k));
        double view[3];
        /* Fewer views take turns, so that each kind is seen. */
        mu_draw_view(index, r->settings->views < MU_VIEWS ? (int)((index + (uint64_t)k) % MU_VIEWS) : k,
                     &random, view);
        mu_check_visible(subject, effort, view, tally);
        if (subject->bounces == MU_WALKS) {
            mu_check_walk(subject, effort, view, &random, tally);
            continue;
        }
        const mu_reflected scattered = mu_check_scattered(subject, effort, view, tally);
        static const double up[3] = {0, 0, 1};
        const _Bool normals = subject->bounces == MU_ONCE; /* else samplers are not of normals alone */
        if (normals && (subject->sampler == MUSURF_SAMPLE_NDF || k == 0))
            mu_check_sampler(subject, effort, MUSURF_SAMPLE_NDF,
                             subject->sampler == MUSURF_SAMPLE_NDF ? view : up, &scattered, &random, tally);
        if (normals) mu_check_sampler(subject, effort, MUSURF_SAMPLE_VISIBLE, view, &scattered, &random, tally);
        if (subject->sampler == MUSURF_SAMPLE_AS_SET)
            mu_check_sampler(subject, effort, MUSURF_SAMPLE_AS_SET, view, &scattered, &random, tally);
        mu_check_points(subject, effort, view, &random, tally);
        mu_check_shading(subject, effort, view, &random, tally);
    }
}

static void check_alone(const run *r, uint64_t index, const mu_subject *subject, mu_tally *tally) {
    check_side(r, index, subject, tally);
    if (!(subject->eta > 0)) return;
    mu_subject below = *subject;
    below.below = 1, below.eta = 1 / subject->eta;
    check_side(r, index, &below, tally);
}

/* What ties it to other materials. */
static void check_relations(const run *r, uint64_t index, const mu_draw *draw, const mu_subject *subject,
                            const mu_subject *original, const mu_subject *turned, mu_tally *tally) {
    const mu_check_effort *effort = &r->settings->effort;
    const double *m = draw->m, bc = m[1] * m[2];
    const mu_deformation how = {.m = {m[0], m[1], m[2], m[3]},
                                .tilt = {draw->tilt[0], draw->tilt[1]},
                                .more = draw->found,
                                .determinant = fma(m[0], m[3], -bc) + fma(-m[1], m[2], bc)};
    for (int k = 0; k < MU_VIEWS; k++) {
        mu_stream random = mu_stream_make(r->settings->seed, index << 8 | (uint64_t)(32 + k));
        double view[3];
        mu_draw_view(index, k, &random, view);
        mu_check_transform(subject, original, &how, effort, view, &random, tally);
        mu_check_rotation(subject, turned, draw->angle, effort, view, &random, tally);
        if (draw->classic)
            mu_check_classic(subject, draw->alpha / draw->m[0], draw->alpha / draw->m[3], effort, view,
                             &random, tally);
    }
}

static _Bool parse(run *r, mu_check_material *material, const char *json, const mu_draw *draw,
                   const double *m) {
    static const double level[2] = {0, 0};
    mu_error error = {.text = ""};
    pthread_mutex_lock(&r->lock);
    _Bool good = mu_check_material_parse(material, r->plugins, json, r->settings->precision, &error);
    mu_plane *plane = &material->subject.plane;
    if (good && m &&
        !(draw->found ? mu_subject_find_plane(&material->subject)
                      : mu_plane_from_transform(plane, m, m == draw->m ? draw->tilt : level, draw->alpha,
                                                draw->spread))) {
        mu_check_material_free(material);
        good = mu_fail(&error, "%s: no coordinates for this transform", json);
    }
    if (!good) mu_fail(r->error, "%s", error.text);
    pthread_mutex_unlock(&r->lock);
    return good;
}

static void check_random(run *r, uint64_t index, mu_tally *tally) {
    const mu_draw draw = mu_draw_material(r->settings->seed, index, r->type);
    static const double identity[4] = {1, 0, 0, 1};
    mu_check_material subject, original, turned;
    if (!parse(r, &subject, draw.json, &draw, draw.m)) return;
    if (draw.beyond_float)
        subject.subject.type = NULL; /* the shading calls are float: nothing to compare with */
    check_alone(r, index, &subject.subject, tally);
    if (parse(r, &original, draw.original, &draw, identity)) {
        if (parse(r, &turned, draw.turned, &draw, NULL)) {
            check_relations(r, index, &draw, &subject.subject, &original.subject, &turned.subject, tally);
            mu_check_material_free(&turned);
        }
        mu_check_material_free(&original);
    }
    mu_check_material_free(&subject);
}

static void show_progress(run *r) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double seconds =
        (double)(now.tv_sec - r->start.tv_sec) + 1e-9 * (double)(now.tv_nsec - r->start.tv_nsec);
    fprintf(stderr, "\rchecking %zu/%zu, %.0f s left \033[K", r->done, r->jobs,
            seconds * (double)(r->jobs - r->done) / (double)r->done);
    if (r->done == r->jobs) fprintf(stderr, "\r\033[K");
}

static void *work(void *context) {
    run *r = context;
    for (;;) {
        pthread_mutex_lock(&r->lock);
        const size_t job = r->error->text[0] ? r->jobs : r->next;
        if (job < r->jobs) r->next++;
        pthread_mutex_unlock(&r->lock);
        if (job >= r->jobs) return NULL;
        mu_tally_init(&r->tallies[job]);
        if (job < r->settings->materials)
            check_random(r, job, &r->tallies[job]);
        else
            check_alone(r, job, &r->given[job - r->settings->materials].subject, &r->tallies[job]);
        pthread_mutex_lock(&r->lock);
        r->done++;
        if (r->settings->show_progress) show_progress(r);
        pthread_mutex_unlock(&r->lock);
    }
}

_Bool mu_check_run(const mu_check_settings *settings, mu_plugins *plugins, const char *type_id,
                   mu_check_material *given, size_t given_count, mu_tally *tally, mu_error *error) {
    run r = {.settings = settings,
             .plugins = plugins,
             .given = given,
             .jobs = settings->materials + given_count,
             .error = error,
             .lock = PTHREAD_MUTEX_INITIALIZER};
    clock_gettime(CLOCK_MONOTONIC, &r.start);
    if (settings->materials && !(r.type = mu_plugins_type(plugins, type_id, error))) return 0;
    if (r.type && !(r.type->extension && r.type->extension(MUSURF_PROBE_ID)))
        return mu_fail(error, "%s does not offer %s, which is needed to look into it", type_id,
                       MUSURF_PROBE_ID);
    if (r.jobs == 0) return 1;
    pthread_t *threads = calloc(settings->threads, sizeof *threads);
    r.tallies = calloc(r.jobs, sizeof *r.tallies);
    if (threads && r.tallies) {
        uint32_t started = 0;
        while (started + 1 < settings->threads && pthread_create(&threads[started], NULL, work, &r) == 0)
            started++;
        work(&r);
        for (uint32_t i = 0; i < started; i++) pthread_join(threads[i], NULL);
        for (size_t job = 0; job < r.jobs && !error->text[0]; job++) mu_tally_add(tally, &r.tallies[job]);
    } else {
        mu_fail(error, "not enough memory");
    }
    free(threads);
    free(r.tallies);
    return !error->text[0];
}
