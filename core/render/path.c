/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * path.c: the path tracer. One closure lives at a time, in the thread's scratch; nothing is allocated.
 *
 * An event is what happens where a ray arrived; it leaves behind a shadow ray to be asked, and the next ray.
 * The first events of neighbouring paths are traced as packets, for their rays run alike; after that each
 * path goes its own way.
 *
 * Rectangle lights end a path: they emit and do not scatter. A path of `depth` scattering events is followed
 * by one more ray that may still find light, so that both strategies see the same paths; where no light can
 * be met, that ray is left out.
 */
#include <float.h>
#include <string.h>

#include "core/render/direct.h"
#include "core/render/path.h"

/* How a ray came to be, which decides the weight of the light it finds. */
typedef struct mu_arrival {
    mu_vec3 from;
    float pdf;     /* of its direction, per steradian */
    _Bool certain; /* no light sample could have found the same: camera rays and delta lobes */
} mu_arrival;

/* A path on its way. */
typedef struct mu_walk {
    mu_ray ray; /* the next one */
    mu_arrival arrival;
    mu_cone cone; /* around the ray, where footprints are asked for */
    float throughput[3];
    float
        compressed; /* what refraction did to radiance on the way: the product of 1/eta^2, 1 outside again */
    mu_random random;
    uint32_t event;
    mu_radiance *out;
} mu_walk;

/* Light that arrives if nothing stands between. */
typedef struct mu_shadow {
    mu_ray ray;
    float throughput[3], arriving[3], weight;
    _Bool cast;
} mu_shadow;

/* Draws of one event: 4 for the light, 3 for the BSDF, 1 for roulette. Each event starts at its own
 * dimension, whatever the ones before it used, so that the samples of a pixel stay stratified together. */
enum { CAMERA_DRAWS = 2, LIGHT_DRAWS = 4, EVENT_DRAWS = 8 };

/* Shadow rays end short of the light by this share of the distance, lest float rounding of origin, direction
 * and distance let them meet the light itself. What is nearer to a light than that throws no shadow. */
#define SHORT_OF_LIGHT (1 - 1e-4f)

/* No NaN, infinity or negative value may ever reach the film; whoever sees `refused` above 0 has found a bug.
 */
static void add(mu_radiance *out, const float throughput[3], const float radiance[3], float weight) {
    float rgb[3];
    for (int c = 0; c < 3; c++) {
        rgb[c] = throughput[c] * radiance[c] * weight;
        if (!(rgb[c] >= 0 && rgb[c] <= FLT_MAX)) {
            out->refused++;
            return;
        }
    }
    for (int c = 0; c < 3; c++) out->rgb[c] += rgb[c];
}

/* Candidates of a light sample along each side of the light's square. */
static uint32_t light_cells(const mu_tracer *tracer) {
    const uint32_t n = tracer->scene->integrator.light_cells;
    return n ? n : 1;
}

/* Light found by following the BSDF; light_pdf 0: light sampling never finds it. */
static float weight_found(const mu_tracer *tracer, const mu_path_options *options, const mu_arrival *arrival,
                          float light_pdf) {
    if (arrival->certain || options->strategy == MU_BSDF_ONLY || !(light_pdf > 0)) return 1;
    if (options->strategy == MU_LIGHT_ONLY) return 0;
    const uint32_t n = light_cells(tracer);
    return mu_power_heuristic(arrival->pdf, (float)(n * n) * light_pdf);
}

static void sample_light(const mu_tracer *tracer, const mu_path_options *options, uint32_t choices,
                         const mu_shading *shading, mu_walk *walk, mu_shadow *shadow) {
    float u[4] = {0};
    if (mu_lights_met(tracer->lights)) { /* else they are all points at infinity */
        mu_random_pair(&walk->random, u);
        if (light_cells(tracer) > 1) u[3] = mu_random_one(&walk->random);
    }
    if (choices > 1) u[2] = mu_random_one(&walk->random);
    mu_direct light;
    if (!mu_direct_choose(tracer->lights, shading, light_cells(tracer), u, options->strategy == MU_BOTH,
                          options->strategy == MU_BSDF_ONLY, &light))
        return;
    shadow->weight = light.weight;
    memcpy(shadow->throughput, walk->throughput, sizeof shadow->throughput);
    memcpy(shadow->arriving, light.arriving, sizeof shadow->arriving);
    shadow->ray = mu_geometry_leave(shading->hit, light.direction, light.distance * SHORT_OF_LIGHT);
    shadow->cast = 1;
    walk->out->rays++;
}

static void add_unshadowed(const mu_walk *walk, const mu_shadow *shadow) {
    add(walk->out, shadow->throughput, shadow->arriving, shadow->weight);
}

/* Follows the BSDF: the next ray, its arrival, and what becomes of the throughput. False: the path ends. */
static _Bool scatter(const mu_tracer *tracer, const mu_shading *shading, mu_walk *walk) {
    float u[3];
    mu_random_pair(&walk->random, u);
    u[2] = mu_random_one(&walk->random);
    musurf_sample sample;
    shading->type->sample(shading->closure, u, MUSURF_ALL_LOBES, &sample);
    if (!sample.lobe) return 0;
    const float *w = sample.weight, *d = sample.wi;
    if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0 && isfinite(w[0] + w[1] + w[2] + d[0] + d[1] + d[2]))) {
        walk->out->refused++;
        return 0;
    }
    if (!(w[0] + w[1] + w[2] > 0)) return 0;
    const mu_vec3 wi = mu_to_world(&shading->frame, mu_v3(sample.wi[0], sample.wi[1], sample.wi[2]));
    if (!mu_shading_agrees(shading, wi, sample.wi[2])) return 0;
    for (int c = 0; c < 3; c++) walk->throughput[c] *= sample.weight[c];
    walk->compressed /= sample.eta * sample.eta;
    walk->arrival = (mu_arrival){shading->hit->p, sample.pdf, (sample.lobe & MUSURF_DELTA_LOBES) != 0};
    walk->ray = mu_geometry_leave(shading->hit, mu_normalise(wi), INFINITY);
    if (tracer->footprints) walk->cone.spread += 2 * sample.roughness;
    return 1;
}

/* Goes on with the probability of the throughput's largest part, which is at most 1 where no energy is made. Inside of
 * glass throughput is smaller by eta^2, which leaving gives back: no reason to end there. */
static _Bool survives(mu_random *random, float throughput[3], float compressed) {
    const float most = fmaxf(throughput[0], fmaxf(throughput[1], throughput[2]));
    const float chance = fminf(most / compressed, 1);
    if (!(mu_random_one(random) < chance)) return 0;
    for (int c = 0; c < 3; c++) throughput[c] /= chance;
    return 1;
}

/* What the walk sees at once where it arrived; its cone goes on from there. */
static mu_beam beam_at(const mu_tracer *tracer, uint32_t event, const mu_hit *hit, mu_walk *walk) {
    const mu_scene *scene = tracer->scene;
    walk->cone.width += walk->cone.spread * hit->distance;
    mu_beam beam = event == 0 ? mu_beam_of_pixel(&scene->camera, &scene->film, hit->p)
                              : mu_beam_of_cone(walk->cone.width, walk->ray.direction);
    if (tracer->samples) beam.share = 1 / sqrtf((float)tracer->samples);
    return beam;
}

/* What happens where the walk's ray arrived: at `hit`, or, if that is NULL, out of the scene. True: walk->ray
 * is to be followed. Either way *shadow may ask for a shadow ray. */
static _Bool arrive(const mu_tracer *tracer, const mu_path_options *options, mu_walk *walk, const mu_hit *hit,
                    void *scratch, mu_shadow *shadow) {
    const mu_scene *scene = tracer->scene;
    const uint32_t event = walk->event++;
    mu_radiance *out = walk->out;
    float radiance[3], light_pdf;
    shadow->cast = 0;
    if (!hit) {
        mu_lights_escaped(tracer->lights, walk->ray.direction, radiance, &light_pdf);
        add(out, walk->throughput, radiance, weight_found(tracer, options, &walk->arrival, light_pdf));
        return 0;
    }
    if (event == 0) {
        out->hit = 1;
        out->normal[0] = hit->frame.n.x;
        out->normal[1] = hit->frame.n.y;
        out->normal[2] = hit->frame.n.z;
    }
    const mu_object *object = &scene->objects[hit->object];
    if (object->light != MU_NO_INDEX) {
        mu_lights_hit(tracer->lights, object->light, walk->arrival.from, walk->ray.direction, hit->distance,
                      radiance, &light_pdf);
        add(out, walk->throughput, radiance, weight_found(tracer, options, &walk->arrival, light_pdf));
        return 0;
    }
    if (event == scene->integrator.depth) return 0;

    mu_shading shading;
    mu_beam beam;
    if (tracer->footprints) beam = beam_at(tracer, event, hit, walk);
    mu_shading_begin(&shading, scene, hit, mu_scale(walk->ray.direction, -1),
                     tracer->footprints ? &beam : NULL, scratch);
    if (!shading.lobes) return 0; /* black, but it did block the light */
    if (event == 0) {
        shading.type->albedo(shading.closure, out->albedo);
        out->normal[0] = shading.frame.n.x;
        out->normal[1] = shading.frame.n.y;
        out->normal[2] = shading.frame.n.z;
    }
    const uint32_t choices = mu_lights_choices(tracer->lights);
    walk->random.dimension = CAMERA_DRAWS + event * EVENT_DRAWS;
    if (choices && (shading.lobes & ~(uint32_t)MUSURF_DELTA_LOBES))
        sample_light(tracer, options, choices, &shading, walk, shadow);
    if (event + 1 == scene->integrator.depth && !mu_lights_met(tracer->lights)) return 0;
    walk->random.dimension = CAMERA_DRAWS + event * EVENT_DRAWS + LIGHT_DRAWS;
    if (!scatter(tracer, &shading, walk)) return 0;
    if (event + 1 >= scene->integrator.roulette &&
        !survives(&walk->random, walk->throughput, walk->compressed))
        return 0;
    walk->out->rays++;
    return 1;
}

/* From where the walk stands to its end, ray by ray. */
static void follow(const mu_tracer *tracer, const mu_path_options *options, mu_walk *walk, void *scratch) {
    for (_Bool goes_on = 1; goes_on;) {
        mu_hit hit;
        mu_shadow shadow;
        const _Bool met = mu_geometry_intersect(tracer->geometry, &walk->ray, &hit);
        goes_on = arrive(tracer, options, walk, met ? &hit : NULL, scratch, &shadow);
        if (shadow.cast && !mu_geometry_occluded(tracer->geometry, &shadow.ray))
            add_unshadowed(walk, &shadow);
    }
}

static mu_walk start(const mu_tracer *tracer, const mu_path_options *options, uint64_t seed, uint32_t x,
                     uint32_t y, uint32_t sample, mu_radiance *out) {
    *out = (mu_radiance){.rays = 1};
    mu_walk walk = {
        .random = mu_random_start(seed, x, y, sample), .throughput = {1, 1, 1}, .compressed = 1, .out = out};
    walk.random.independent = options->independent;
    float u[2];
    mu_random_pair(&walk.random, u);
    walk.ray = mu_camera_ray(&tracer->scene->camera, &tracer->scene->film, x, y, u);
    walk.arrival = (mu_arrival){walk.ray.origin, 0, 1};
    if (tracer->footprints) walk.cone = mu_cone_of_pixel(&tracer->scene->camera, &tracer->scene->film);
    return walk;
}

void mu_path_pixel(const mu_tracer *tracer, const mu_path_options *options, uint64_t seed, uint32_t x,
                   uint32_t y, uint32_t sample, void *scratch, mu_radiance *out) {
    mu_walk walk = start(tracer, options, seed, x, y, sample, out);
    follow(tracer, options, &walk, scratch);
}

void mu_path_row(const mu_tracer *tracer, const mu_path_options *options, uint64_t seed, uint32_t x,
                 uint32_t y, uint32_t count, uint32_t sample, void *scratch, mu_radiance *out) {
    mu_walk walks[MU_PACKET];
    mu_ray rays[MU_PACKET] = {{.near = 0}};
    mu_hit hits[MU_PACKET];
    mu_shadow shadows[MU_PACKET];
    for (uint32_t i = 0; i < count; i++) {
        walks[i] = start(tracer, options, seed, x + i, y, sample, &out[i]);
        rays[i] = walks[i].ray;
    }
    const uint32_t met = mu_geometry_intersect_packet(tracer->geometry, rays, (1u << count) - 1, hits);
    uint32_t goes_on = 0, cast = 0;
    for (uint32_t i = 0; i < count; i++) {
        const mu_hit *hit = met >> i & 1 ? &hits[i] : NULL;
        if (arrive(tracer, options, &walks[i], hit, scratch, &shadows[i])) goes_on |= 1u << i;
        if (!shadows[i].cast) continue;
        rays[i] = shadows[i].ray;
        cast |= 1u << i;
    }
    const uint32_t dark = cast ? mu_geometry_occluded_packet(tracer->geometry, rays, cast) : 0;
    for (uint32_t i = 0; i < count; i++) {
        if (cast >> i & ~(dark >> i) & 1) add_unshadowed(&walks[i], &shadows[i]);
        if (goes_on >> i & 1) follow(tracer, options, &walks[i], scratch);
    }
}
