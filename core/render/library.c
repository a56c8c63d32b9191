/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* library.c: musurf_render.h: what `musurf render` does, without files, terminal and signals. */
#include "core/render/musurf_render.h"

#include <stdlib.h>
#include <string.h>

#include "core/render/document.h"
#include "core/render/info.h"
#include "core/render/options.h"
#include "core/render/render_scene.h"

enum { MOST_THREADS = 1024 }; /* as for `musurf render`: each pass starts them anew */

typedef struct mu_run {
    musurf_render_request asked;
    mu_document document;
    mu_scene scene;
    mu_geometry *geometry;
    mu_lights *lights;
    mu_film film;
} mu_run;

typedef struct mu_ear {
    void *context;
    void (*message)(void *context, int32_t severity, const char *text);
} mu_ear;

static void warn(void *context, const char *text) {
    const mu_ear *ear = context;
    if (ear->message) ear->message(ear->context, MUSURF_RENDER_WARNING, text);
}

static void complain(const mu_ear *ear, const mu_error *error) {
    if (ear->message)
        ear->message(ear->context, MUSURF_RENDER_ERROR, error->text[0] ? error->text : "not enough memory");
}

/* ------------------------------------------------------------------------------------------------ watching */

static _Bool stop(void *context) {
    const musurf_render_request *r = &((const mu_run *)context)->asked;
    return r->stop && r->stop(r->context);
}

static void progress(void *context, const mu_render_status *status) {
    const musurf_render_request *r = &((const mu_run *)context)->asked;
    if (r->progress) r->progress(r->context, status->fraction, status->remaining, status->samples);
}

static void fill(const mu_run *run) {
    const musurf_render_request *r = &run->asked;
    for (size_t i = 0; i < r->count; i++) {
        const mu_pixel *pixel = &run->film.pixels[i];
        double rgb[3];
        mu_pixel_rgb(pixel, rgb);
        for (size_t k = 0; k < 3; k++) {
            r->pixels[4 * i + k] = (float)rgb[k];
            if (r->albedo) r->albedo[3 * i + k] = pixel->albedo[k];
            if (r->normal) r->normal[3 * i + k] = pixel->normal[k];
        }
        r->pixels[4 * i + 3] = pixel->samples ? (float)((double)pixel->hits / pixel->samples) : 0;
    }
}

static void picture(void *context, const mu_film *film) {
    const mu_run *run = context;
    (void)film;
    fill(run);
    run->asked.picture(run->asked.context);
}

/* ----------------------------------------------------------------------------------------------- rendering */

static _Bool prepare(mu_run *run, mu_error *error) {
    const musurf_render_request *r = &run->asked;
    if (!r->scene || !r->name || !r->pixels)
        return mu_fail(error, "the host gave no scene, no name or no buffer");
    if (!mu_document_parse(&run->document, r->name, r->scene, strlen(r->scene), 1, error)) return 0;
    const _Bool good = mu_scene_from(&run->scene, &run->document, error);
    mu_document_free(&run->document);
    if (!good) return 0;
    const mu_film_settings *film = &run->scene.film;
    if ((size_t)film->width * film->height != r->count)
        return mu_fail(error, "%s: the film has %u x %u pixels, but the host's buffer %zu", r->name,
                       film->width, film->height, r->count);
    if (!mu_film_make(&run->film, film->width, film->height, error)) return 0;
    run->geometry = mu_geometry_build(&run->scene, r->threads, error);
    if (run->geometry) run->lights = mu_lights_build(&run->scene, error);
    return run->lights != NULL;
}

static mu_render_end render(mu_run *run, mu_error *error) {
    const musurf_render_request *r = &run->asked;
    const mu_render_watch watch = {.context = run,
                                   .stop = stop,
                                   .report = progress,
                                   .checkpoint = r->picture ? picture : NULL,
                                   .checkpoint_seconds = r->interval > 0 ? r->interval : 1};
    if (!prepare(run, error)) return MU_RENDER_FAILED;
    const mu_render_plan limits = {.threads = r->threads,
                                   .samples = run->scene.integrator.samples,
                                   .noise = r->noise > 0 ? r->noise : 0};
    const mu_render_end end =
        mu_render_scene(&run->film, &run->scene, run->geometry, run->lights, &limits, &watch, error);
    if (end != MU_RENDER_FAILED) fill(run);
    return end;
}

uint32_t musurf_render_version(void) {
    return MUSURF_RENDER_MAJOR * 1000;
}

int32_t musurf_render_run(const musurf_render_request *request) {
    mu_run run = {.geometry = NULL};
    /* What a caller of another version does not know is absent. */
    memcpy(&run.asked, request, request->size < sizeof run.asked ? request->size : sizeof run.asked);
    if (!run.asked.threads) run.asked.threads = mu_processors();
    if (run.asked.threads > MOST_THREADS) run.asked.threads = MOST_THREADS;
    mu_ear ear = {run.asked.context, run.asked.message};
    mu_error error = {.warn = warn, .context = &ear};
    const mu_render_end end = render(&run, &error);
    if (end == MU_RENDER_FAILED) complain(&ear, &error);
    mu_lights_free(run.lights);
    mu_geometry_free(run.geometry);
    mu_scene_free(&run.scene);
    mu_film_free(&run.film);
    return end == MU_RENDER_DONE      ? MUSURF_RENDER_DONE
           : end == MU_RENDER_STOPPED ? MUSURF_RENDER_STOPPED
                                      : MUSURF_RENDER_FAILED;
}

char *musurf_render_parameters(const char *material, void *context,
                               void (*message)(void *context, int32_t severity, const char *text)) {
    mu_ear ear = {context, message};
    mu_error error = {.warn = warn, .context = &ear};
    mu_plugins *plugins = mu_plugins_new();
    const musurf_material_type *type = plugins ? mu_plugins_type(plugins, material, &error) : NULL;
    json_t *table = type ? json_pack("{s:s, s:s, s:s, s:o}", "id", type->id, "label", type->label, "doc",
                                     type->doc, "parameters", mu_info_params(type))
                         : NULL;
    char *text = table ? json_dumps(table, JSON_COMPACT) : NULL;
    json_decref(table);
    mu_plugins_free(plugins);
    if (!text) complain(&ear, &error);
    return text;
}

void musurf_render_free(char *text) {
    free(text);
}
