/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * path.c: the path tracer. One closure lives at a time, in the thread's scratch; nothing is allocated.
 *
 * Rectangle lights end a path: they emit and do not scatter. A path of `depth` scattering events is followed
 * by one more ray that may still find light, so that both strategies see the same paths; where no light can
 * be met, that ray is left out.
 */
#include <float.h>

#include "core/render/path.h"
#include "core/render/shading.h"

/* How a ray came to be, which decides the weight of the light it finds. */
typedef struct mu_arrival {
    mu_vec3 from;
    float pdf;     /* of its direction, per steradian */
    _Bool certain; /* no light sample could have found the same: camera rays and delta lobes */
} mu_arrival;

/* Draws of one event: 3 for the light, 3 for the BSDF, 1 for roulette. Each event starts at its own
 * dimension, whatever the ones before it used, so that the samples of a pixel stay stratified together. */
enum { CAMERA_DRAWS = 2, EVENT_DRAWS = 7 };

/* Shadow rays end short of the light by this share of the distance, lest float rounding of origin, direction
 * and distance let them meet the light itself. What is nearer to a light than that throws no shadow. */
#define SHORT_OF_LIGHT (1 - 1e-4f)

/* own^2 / (own^2 + other^2), without overflow */
static float power_heuristic(float own, float other) {
    if (!(own > 0)) return 0;
    const float ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

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

/* Light found by following the BSDF; light_pdf 0: light sampling never finds it. */
static float weight_found(const mu_path_options *options, const mu_arrival *arrival, float light_pdf) {
    if (arrival->certain || options->strategy == MU_BSDF_ONLY || !(light_pdf > 0)) return 1;
    return options->strategy == MU_LIGHT_ONLY ? 0 : power_heuristic(arrival->pdf, light_pdf);
}

static void sample_light(const mu_tracer *tracer, const mu_path_options *options, uint32_t choices,
                         const mu_shading *shading, const float throughput[3], mu_random *random,
                         mu_radiance *out) {
    float u[3];
    mu_random_pair(random, u);
    u[2] = choices > 1 ? mu_random_one(random) : 0;
    mu_light_sample light;
    mu_lights_sample(tracer->lights, shading->hit->p, u, &light);
    if (!(light.pdf > 0) || (options->strategy == MU_BSDF_ONLY && !light.delta)) return;
    const mu_vec3 local = mu_to_local(&shading->frame, light.direction);
    if (!mu_shading_agrees(shading, light.direction, local.z)) return;
    const float wi[3] = {local.x, local.y, local.z};
    musurf_value value;
    shading->type->eval(shading->closure, wi, MUSURF_ALL_LOBES, &value);
    if (!value.lobes) return;
    float weight = 1 / light.pdf;
    if (!light.delta && options->strategy == MU_BOTH) weight *= power_heuristic(light.pdf, value.pdf);
    float arriving[3];
    for (int c = 0; c < 3; c++) arriving[c] = value.f[c] * light.radiance[c];
    out->rays++;
    const mu_ray shadow = mu_geometry_leave(shading->hit, light.direction, light.distance * SHORT_OF_LIGHT);
    if (!mu_geometry_occluded(tracer->geometry, &shadow)) add(out, throughput, arriving, weight);
}

/* Follows the BSDF: the next ray, its arrival, and what becomes of the throughput. False: the path ends. */
static _Bool scatter(const mu_shading *shading, mu_random *random, float throughput[3], mu_ray *ray,
                     mu_arrival *arrival, mu_radiance *out) {
    float u[3];
    mu_random_pair(random, u);
    u[2] = mu_random_one(random);
    musurf_sample sample;
    shading->type->sample(shading->closure, u, MUSURF_ALL_LOBES, &sample);
    if (!sample.lobe) return 0;
    const float *w = sample.weight, *d = sample.wi;
    if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0 && isfinite(w[0] + w[1] + w[2] + d[0] + d[1] + d[2]))) {
        out->refused++;
        return 0;
    }
    if (!(w[0] + w[1] + w[2] > 0)) return 0;
    const mu_vec3 wi = mu_to_world(&shading->frame, mu_v3(sample.wi[0], sample.wi[1], sample.wi[2]));
    if (!mu_shading_agrees(shading, wi, sample.wi[2])) return 0;
    for (int c = 0; c < 3; c++) throughput[c] *= sample.weight[c];
    *arrival = (mu_arrival){shading->hit->p, sample.pdf, (sample.lobe & MUSURF_DELTA_LOBES) != 0};
    *ray = mu_geometry_leave(shading->hit, mu_normalise(wi), INFINITY);
    return 1;
}

/* Goes on with the probability of the throughput's largest part, which is at most 1 where no energy is made.
 */
static _Bool survives(mu_random *random, float throughput[3]) {
    const float most = fmaxf(throughput[0], fmaxf(throughput[1], throughput[2]));
    const float chance = fminf(most, 1);
    if (!(mu_random_one(random) < chance)) return 0;
    for (int c = 0; c < 3; c++) throughput[c] /= chance;
    return 1;
}

void mu_path_trace(const mu_tracer *tracer, const mu_path_options *options, mu_ray ray, mu_random *random,
                   void *scratch, mu_radiance *out) {
    const mu_scene *scene = tracer->scene;
    const uint32_t choices = mu_lights_choices(tracer->lights);
    const _Bool met = mu_lights_met(tracer->lights);
    float throughput[3] = {1, 1, 1}, radiance[3], light_pdf;
    mu_arrival arrival = {ray.origin, 0, 1};
    for (uint32_t event = 0;; event++) {
        mu_hit hit;
        out->rays++;
        if (!mu_geometry_intersect(tracer->geometry, &ray, &hit)) {
            mu_lights_escaped(tracer->lights, ray.direction, radiance, &light_pdf);
            add(out, throughput, radiance, weight_found(options, &arrival, light_pdf));
            return;
        }
        if (event == 0) {
            out->hit = 1;
            out->normal[0] = hit.frame.n.x;
            out->normal[1] = hit.frame.n.y;
            out->normal[2] = hit.frame.n.z;
        }
        const mu_object *object = &scene->objects[hit.object];
        if (object->light != MU_NO_INDEX) {
            mu_lights_hit(tracer->lights, object->light, arrival.from, ray.direction, hit.distance, radiance,
                          &light_pdf);
            add(out, throughput, radiance, weight_found(options, &arrival, light_pdf));
            return;
        }
        if (event == scene->integrator.depth) return;

        mu_shading shading;
        mu_shading_begin(&shading, scene, &hit, mu_scale(ray.direction, -1), scratch);
        if (!shading.lobes) return; /* black, but it did block the light */
        if (event == 0) {
            shading.type->albedo(shading.closure, out->albedo);
            out->normal[0] = shading.frame.n.x;
            out->normal[1] = shading.frame.n.y;
            out->normal[2] = shading.frame.n.z;
        }
        random->dimension = CAMERA_DRAWS + event * EVENT_DRAWS;
        if (choices && (shading.lobes & ~(uint32_t)MUSURF_DELTA_LOBES))
            sample_light(tracer, options, choices, &shading, throughput, random, out);
        if (event + 1 == scene->integrator.depth && !met) return;
        random->dimension = CAMERA_DRAWS + event * EVENT_DRAWS + 3;
        if (!scatter(&shading, random, throughput, &ray, &arrival, out)) return;
        if (event + 1 >= scene->integrator.roulette && !survives(random, throughput)) return;
    }
}
