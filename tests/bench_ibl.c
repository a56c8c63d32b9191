/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_ibl.c: what a picture costs that is lit by a filtered environment (core/render/image_light.h), by technique.
 *
 *     bench_ibl [--json] [--images] [--rounds N] [--samples N] [SCENE...]
 *
 * The scenes differ in "integrator" and "lights" alone: geometry and tables are made of the first, the light of the first of those that follow
 * one another with the same, and each scene's picture is made with its own integrator in turn. A cost is processor time of one thread for the whole frame (camera rays, what they meet, shading,
 * the film's sums) over samples and pixels; the median of N rounds, in each of which every scene has its turn. "rays" is
 * the frame without shading: hits are left black. --images leaves SCENE.exr beside each. Without scenes: a sphere that fills most
 * of a studio, by every technique of `musurf render` that is not path, 16 reads; exit 1 if the major axis then takes more than
 * GOAL times the bent normal's time.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/render/document.h"
#include "core/render/features.h"
#include "core/render/image.h"
#include "core/render/image_light.h"
#include "core/render/options.h"
#include "core/render/path.h"
#include "core/render/render.h"

#define GOAL 2.5
/* Rounds and scenes at most; pictures that a light is made for: so many that there are tables, as of long renders. */
enum { MOST_ROUNDS = 101, MOST_SCENES = 256, MANY = 1 << 16 };

typedef struct bench {
    uint32_t rounds, samples;
    _Bool json, images;
    mu_tracer tracer;
    uint64_t reads, hits; /* of the last frame; one thread */
} bench;

typedef struct entry {
    const char *file;
    mu_scene scene;
    double ns[MOST_ROUNDS], median;
    double rays;  /* median of a frame without shading, under the same light */
    double reads; /* per hit */
} entry;

static void stop(const char *what) {
    fprintf(stderr, "bench_ibl: %s\n", what);
    exit(2);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------------ frames */

static void shade(const void *context, uint64_t seed, uint32_t x, uint32_t y, uint32_t count, uint32_t sample, void *scratch,
                  mu_radiance *out) {
    bench *b = (bench *)context;
    mu_image_light_row(&b->tracer, seed, x, y, count, sample, scratch, out);
    for (uint32_t i = 0; i < count; i++) b->reads += out[i].reads, b->hits += out[i].hit;
}

/* As mu_image_light_row, but for what it does at hits. */
static void only_rays(const void *context, uint64_t seed, uint32_t x, uint32_t y, uint32_t count, uint32_t sample,
                      void *scratch, mu_radiance *out) {
    const bench *b = context;
    (void)scratch;
    mu_ray rays[MU_PACKET] = {{.near = 0}};
    mu_hit hits[MU_PACKET];
    for (uint32_t i = 0; i < count; i++) {
        mu_random random = mu_random_start(seed, x + i, y, sample);
        float u[2];
        mu_random_pair(&random, u);
        rays[i] = mu_camera_ray(&b->tracer.scene->camera, &b->tracer.scene->film, x + i, y, u);
    }
    const uint32_t met = mu_geometry_intersect_packet(b->tracer.geometry, rays, (1u << count) - 1, hits);
    for (uint32_t i = 0; i < count; i++) {
        float pdf;
        out[i] = (mu_radiance){.rays = 1, .hit = met >> i & 1};
        if (!out[i].hit) mu_lights_escaped(b->tracer.lights, rays[i].direction, out[i].rgb, &pdf);
    }
}

/* Nanoseconds a pixel and sample. */
static double frame(bench *b, mu_film *film, mu_sample_function sample) {
    mu_error error = {.text = ""};
    const mu_film_settings *settings = &b->tracer.scene->film;
    const mu_render_plan plan = {.sample = sample, .context = b, .scratch = mu_integrator_scratch(b->tracer.scene), .seed = 1, .threads = 1, .samples = b->samples};
    const mu_render_watch watch = {.report = NULL};
    b->reads = b->hits = 0;
    mu_film_free(film);
    if (!mu_film_make(film, settings->width, settings->height, &error)) stop(error.text);
    const double start = now();
    if (mu_render(film, &plan, &watch, &error) != MU_RENDER_DONE) stop(error.text);
    return (now() - start) / ((double)settings->width * settings->height * b->samples);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of values[i] / by[i]; by NULL: 1. */
static double median(const double *values, const double *by, uint32_t count) {
    double sorted[MOST_ROUNDS];
    for (uint32_t i = 0; i < count; i++) sorted[i] = by ? values[i] / by[i] : values[i];
    qsort(sorted, count, sizeof *sorted, ascending);
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

static void write_image(const entry *e, const mu_film *film) {
    char file[4096];
    mu_error error = {.text = ""};
    const mu_image_info info = {.scene_file = e->file, .scene_text = e->scene.text, .command = "bench_ibl", .version = MUSURF_VERSION,
                                .seed = 1, .samples = film->pixels->samples, .seconds = film->seconds, .camera = e->scene.camera};
    if (snprintf(file, sizeof file, "%s.exr", e->file) >= (int)sizeof file) stop("a name is too long");
    if (!mu_image_write_exr(file, film, &e->scene.film, &info, &error)) stop(error.text);
}

/* Of entries under one light. */
static void measure(bench *b, mu_image_light *light, entry *entries, size_t count) {
    static double rays[MOST_ROUNDS];
    mu_film film = {0};
    for (uint32_t r = 0; r < b->rounds; r++) {
        rays[r] = frame(b, &film, only_rays);
        for (size_t k = 0; k < count; k++) {
            entry *e = &entries[k];
            mu_image_light_choose(light, &e->scene.integrator);
            e->ns[r] = frame(b, &film, shade);
            e->reads = b->hits ? (double)b->reads / (double)b->hits : 0;
            if (b->images && !r) write_image(e, &film);
        }
    }
    for (size_t k = 0; k < count; k++)
        entries[k].median = median(entries[k].ns, NULL, b->rounds), entries[k].rays = median(rays, NULL, b->rounds);
    mu_film_free(&film);
}

static _Bool same_light(const mu_scene *a, const mu_scene *b) {
    if (a->light_count != 1 || b->light_count != 1) stop("a scene for this has one light");
    const mu_light *x = a->lights, *y = b->lights;
    return x->kind == y->kind && x->rotation == y->rotation && !memcmp(x->scale, y->scale, sizeof x->scale) &&
           (x->image && y->image ? !strcmp(x->image, y->image) : x->image == y->image);
}

static void measure_all(bench *b, mu_image_light *light, entry *entries, size_t count) {
    for (size_t first = 0, last; first < count; first = last) {
        mu_error error = {.text = ""};
        mu_lights *lights = NULL;
        for (last = first + 1; last < count && same_light(&entries[first].scene, &entries[last].scene);) last++;
        if (first && (!(lights = mu_lights_build(&entries[first].scene, &error)) ||
                      !mu_image_light_relight(light, b->tracer.lights = lights, mu_processors(), &error)))
            stop(error.text);
        measure(b, light, entries + first, last - first);
        mu_lights_free(lights);
    }
}

/* ------------------------------------------------------------------------------------------------------ scenes */

static size_t read_scenes(entry *entries, char **files, int count) {
    if (count > MOST_SCENES) stop("too many scenes");
    for (int k = 0; k < count; k++) {
        mu_error error = {.text = ""};
        entries[k].file = files[k];
        if (!mu_scene_read(&entries[k].scene, files[k], &error)) stop(error.text);
        if (!entries[k].scene.integrator.by_image) stop("path is no technique of image-based lighting");
    }
    return (size_t)count;
}

/* One for each technique of a built-in scene. */
static size_t own_scenes(entry *entries) {
    size_t count = 0;
    for (; mu_integrators[1 + count]; count++) {
        char text[1024];
        mu_document document;
        mu_error error = {.text = ""};
        snprintf(text, sizeof text,
                 "{\"camera\": {\"type\": \"orthographic\", \"position\": [0, -4, 1], \"height\": 1.8},\n"
                 "\"film\": {\"width\": 256, \"height\": 256, \"filter\": \"box\"}, \"integrator\": {\"by\": \"%s\"},\n"
                 "\"objects\": [{\"shape\": \"sphere\", \"radius\": 1, \"material\": {\"material\": \"musurf.microfacet\",\n"
                 "\"alpha_x\": 0.288, \"alpha_y\": 0.032}}], \"lights\": [{\"type\": \"studio\"}]}\n",
                 mu_integrators[1 + count]);
        entries[count].file = mu_integrators[1 + count];
        if (!mu_document_parse(&document, "bench", text, strlen(text), 1, &error) ||
            !mu_scene_from(&entries[count].scene, &document, &error))
            stop(error.text);
        mu_document_free(&document);
    }
    return count;
}

static const entry *of(const entry *entries, size_t count, mu_ibl_technique technique) {
    for (size_t k = 0; k < count; k++)
        if (entries[k].scene.integrator.technique == technique) return &entries[k];
    return NULL;
}

static void print_json(const bench *b, const entry *e) {
    printf("{\"scene\": \"%s\", \"ns\": %.4f, \"shading_ns\": %.4f, \"rays_ns\": %.4f, \"reads\": %.6f, \"rounds\": [", e->file, e->median,
           e->median - e->rays, e->rays, e->reads);
    for (uint32_t r = 0; r < b->rounds; r++) printf("%s%.4f", r ? ", " : "", e->ns[r]);
    puts("]}");
}

/* Exit code. Ratios are those of the same round. */
static int report(const bench *b, const entry *entries, size_t count, _Bool judged) {
    const entry *const bent = of(entries, count, MU_IBL_BENT_NORMAL), *const axis = of(entries, count, MU_IBL_MAJOR_AXIS);
    if (!b->json)
        printf("image-based lighting, processor ns a pixel and sample, median of %u; rays and what they meet: %.1f\n%-24s%8s%10s%12s%8s\n",
               b->rounds, entries->rays, "", "frame", "shading", "bent = 1", "reads");
    for (size_t k = 0; k < count; k++) {
        const entry *const e = &entries[k];
        if (b->json)
            print_json(b, e);
        else
            printf("%-24s%8.1f%10.1f%12.2f%8.2f\n", e->file, e->median, e->median - e->rays, bent ? median(e->ns, bent->ns, b->rounds) : 0,
                   e->reads);
    }
    if (!judged) return 0;
    const double ratio = median(axis->ns, bent->ns, b->rounds);
    if (!b->json) printf("major-axis over bent-normal: %.2f (goal: at most %.1f)\n", ratio, GOAL);
    return ratio <= GOAL ? 0 : 1;
}

static uint32_t number(const char *text, long most) {
    char *end;
    const long value = text ? strtol(text, &end, 10) : 0;
    if (value < 1 || value > most || *end) stop("a number is missing, or out of range");
    return (uint32_t)value;
}

int main(int argc, char **argv) {
    static entry entries[MOST_SCENES];
    bench b = {.rounds = 15, .samples = 4};
    int at = 1;
    for (; at < argc && argv[at][0] == '-'; at++) {
        if (!strcmp(argv[at], "--json"))
            b.json = 1;
        else if (!strcmp(argv[at], "--images"))
            b.images = 1;
        else if (!strcmp(argv[at], "--rounds"))
            b.rounds = number(argv[++at], MOST_ROUNDS);
        else if (!strcmp(argv[at], "--samples"))
            b.samples = number(argv[++at], 4096);
        else
            stop("[--json] [--images] [--rounds N] [--samples N] SCENE...");
    }
    const char *const build = getenv("BUILD");
    setenv("MUSURF_PLUGIN_PATH", build ? build : "build", 0);
    const size_t count = at < argc ? read_scenes(entries, argv + at, argc - at) : own_scenes(entries);
    const mu_scene *const scene = &entries->scene;
    mu_error error = {.text = ""};
    mu_geometry *const geometry = mu_geometry_build(scene, 1, &error);
    mu_lights *const lights = geometry ? mu_lights_build(scene, &error) : NULL;
    if (!lights) stop(error.text);
    b.tracer = (mu_tracer){.scene = scene, .geometry = geometry, .lights = lights, .samples = b.samples,
                           .footprints = (mu_features_of(scene) & (MU_FEATURE_FOOTPRINTS | MU_FEATURE_TEXTURES)) != 0};
    mu_image_light *const light = mu_image_light_make(&b.tracer, MANY, mu_processors(), NULL, &error);
    if (!light) stop(error.text);
    b.tracer.image_light = light;
    measure_all(&b, light, entries, count);
    const int code = report(&b, entries, count, at >= argc);
    mu_image_light_free(light);
    mu_lights_free(lights);
    mu_geometry_free(geometry);
    for (size_t k = 0; k < count; k++) mu_scene_free(&entries[k].scene);
    return code;
}
