/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * light.c: all lights of a scene: which one is drawn, and with what density.
 *
 * A light is chosen with probability half even, half in proportion to the fluence (radiance integrated over
 * directions) that it sends, unoccluded, to the middle of the scene's objects. The even half bounds what a
 * bad guess can cost to a factor of 2; choosing by emitted power alone would starve small lights under a
 * large environment. Lights that give nothing are never chosen.
 *
 * A constant environment is not drawn either: BSDF sampling already is the ideal strategy for it, and a light
 * sample would only add noise (the limit of Karlik et al., "MIS compensation", 2019, for a uniform image).
 * Its pdf is 0.
 */
#include "core/render/light_parts.h"

#include <stdlib.h>
#include <string.h>

struct mu_lights {
    const mu_light *lights; /* the scene's */
    uint32_t count;
    uint32_t around; /* index of the environment, constant or studio; MU_NO_INDEX */
    mu_sky sky;
    mu_rectangle_light *rectangles; /* one for each light; used where it is a rectangle */
    uint32_t choices;               /* how many have a chance above 0 */
    float *choice;                  /* count + 1 bounds; NULL if nothing is to be drawn */
};

/* Whether no ray can meet it. */
static _Bool nowhere(const mu_light *light) {
    return light->kind == MU_DIRECTIONAL || light->kind == MU_POINT;
}

static mu_vec3 middle_of_objects(const mu_scene *scene) {
    mu_vec3 sum = {0, 0, 0};
    uint32_t count = 0;
    for (const mu_object *o = scene->objects; o < scene->objects + scene->object_count; o++) {
        if (o->light != MU_NO_INDEX) continue;
        sum = mu_add(sum, mu_affine_point(&o->to_world, mu_v3(0, 0, 0)));
        count++;
    }
    return count ? mu_scale(sum, 1 / (float)count) : sum;
}

static double fluence(const mu_lights *lights, uint32_t index, mu_vec3 middle) {
    const mu_light *light = &lights->lights[index];
    if (light->kind == MU_DIRECTIONAL) return (double)mu_luminance(light->irradiance);
    if (light->kind == MU_POINT) { /* as if within its cone, where it has one */
        const mu_vec3 to = mu_sub(middle, light->position);
        return (double)mu_luminance(light->irradiance) / fmax((double)mu_dot(to, to), 1e-6);
    }
    if (light->kind == MU_RECTANGLE_LIGHT) {
        const mu_rectangle_light *r = &lights->rectangles[index];
        const mu_vec3 centre = mu_affine_point(&light->to_world, mu_v3(0, 0, 0)), to = mu_sub(middle, centre);
        const double area = (double)r->area; /* over distance^2 + area: its solid angle, but never above 1 */
        return area > 0 ? (double)mu_luminance(r->radiance) * area / ((double)mu_dot(to, to) + area) : 0;
    }
    return light->kind == MU_CONSTANT || !lights->sky.table.height ? 0 : lights->sky.fluence;
}

static _Bool make_choice(mu_lights *lights, mu_vec3 middle, mu_error *error) {
    double sum = 0;
    uint32_t able = 0;
    for (uint32_t i = 0; i < lights->count; i++) {
        sum += fluence(lights, i, middle);
        able += fluence(lights, i, middle) > 0;
    }
    lights->choices = able;
    if (!able) return 1;
    lights->choice = calloc((size_t)lights->count + 1, sizeof *lights->choice);
    if (!lights->choice) return mu_fail(error, "not enough memory for %u lights", lights->count);
    double before = 0;
    for (uint32_t i = 0; i < lights->count; i++) {
        lights->choice[i] = (float)before;
        const double own = fluence(lights, i, middle);
        if (own > 0) before += 0.5 * own / sum + 0.5 / able;
        if (before > 1 - 1e-9) before = 1; /* rounding must leave no gap at the end */
    }
    lights->choice[lights->count] = 1;
    return 1;
}

static _Bool build(mu_lights *lights, const mu_scene *scene, mu_error *error) {
    lights->lights = scene->lights;
    lights->count = scene->light_count;
    lights->around = MU_NO_INDEX;
    lights->rectangles = calloc(scene->light_count ? scene->light_count : 1, sizeof *lights->rectangles);
    if (!lights->rectangles) return mu_fail(error, "not enough memory for %u lights", scene->light_count);
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const mu_light *light = &scene->lights[i];
        if (light->kind == MU_RECTANGLE_LIGHT)
            mu_rectangle_light_make(&lights->rectangles[i], light);
        else if (!nowhere(light))
            lights->around = i;
        mu_error reason = {.text = ""};
        if (light->kind == MU_ENVIRONMENT && !mu_sky_make_environment(&lights->sky, light, &reason))
            return mu_fail(error, "%s%s%s", light->place ? light->place : "", light->place ? ": " : "",
                           reason.text);
        if (light->kind == MU_STUDIO && !mu_sky_make_studio(&lights->sky, light, error)) return 0;
    }
    return make_choice(lights, middle_of_objects(scene), error);
}

mu_lights *mu_lights_build(const mu_scene *scene, mu_error *error) {
    mu_lights *lights = calloc(1, sizeof *lights);
    if (!lights) {
        mu_fail(error, "not enough memory for the lights");
        return NULL;
    }
    if (build(lights, scene, error)) return lights;
    mu_lights_free(lights);
    return NULL;
}

void mu_lights_free(mu_lights *lights) {
    if (!lights) return;
    mu_sky_free(&lights->sky);
    free(lights->rectangles);
    free(lights->choice);
    free(lights);
}

static float chance(const mu_lights *lights, uint32_t index) {
    return lights->choice ? lights->choice[index + 1] - lights->choice[index] : 0;
}

uint32_t mu_lights_choices(const mu_lights *lights) {
    return lights->choices;
}

_Bool mu_lights_met(const mu_lights *lights) {
    for (uint32_t i = 0; i < lights->count; i++)
        if (!nowhere(&lights->lights[i])) return 1;
    return 0;
}

size_t mu_lights_table_bytes(const mu_lights *lights) {
    const size_t width = lights->sky.table.width, height = lights->sky.table.height;
    if (!height) return 0;
    return (height + 1 + height * (width + 1)) * sizeof(float) + height * sizeof(mu_sphere_row);
}

size_t mu_lights_image_bytes(const mu_lights *lights) {
    if (!lights->sky.pixels) return 0;
    return 3 * sizeof(float) * (size_t)lights->sky.width * (size_t)lights->sky.height;
}

uint32_t mu_lights_rows(const mu_lights *lights) {
    if (lights->around == MU_NO_INDEX || lights->lights[lights->around].kind == MU_CONSTANT) return 0;
    /* the studio's narrowest edges are 0.04 wide: a dozen pixels */
    return lights->sky.width ? (uint32_t)lights->sky.height : 2 * MU_STUDIO_HEIGHT;
}

void mu_lights_sample(const mu_lights *lights, mu_vec3 p, const float u[3], mu_light_sample *out) {
    *out = (mu_light_sample){.direction = {0, 0, 1}, .distance = INFINITY};
    if (!lights->choice) return;
    float unused;
    const uint32_t index = mu_cdf_find(lights->choice, 0, lights->count - 1, u[2], &unused);
    const mu_light *light = &lights->lights[index];
    const float chosen = chance(lights, index);
    switch (light->kind) {
    case MU_RECTANGLE_LIGHT:
        mu_rectangle_light_sample(&lights->rectangles[index], p, u, &out->direction, &out->distance,
                                  &out->pdf);
        memcpy(out->radiance, lights->rectangles[index].radiance, sizeof out->radiance);
        break;
    case MU_DIRECTIONAL:
        out->direction = light->direction;
        memcpy(out->radiance, light->irradiance, sizeof out->radiance);
        out->pdf = 1;
        out->delta = 1;
        break;
    case MU_POINT:
        mu_point_light_sample(light, p, out);
        break;
    case MU_ENVIRONMENT:
    case MU_STUDIO:
        mu_sky_sample(&lights->sky, u, &out->direction, out->radiance, &out->pdf);
        break;
    case MU_CONSTANT:
        break;
    }
    out->pdf *= chosen;
}

void mu_lights_escaped(const mu_lights *lights, mu_vec3 direction, float radiance[3], float *pdf) {
    memset(radiance, 0, 3 * sizeof *radiance);
    *pdf = 0;
    if (lights->around == MU_NO_INDEX) return;
    const mu_light *light = &lights->lights[lights->around];
    if (light->kind == MU_CONSTANT) {
        memcpy(radiance, light->scale, 3 * sizeof *radiance);
        return;
    }
    mu_sky_escaped(&lights->sky, direction, radiance, pdf);
    *pdf *= chance(lights, lights->around);
}

void mu_lights_hit(const mu_lights *lights, uint32_t light, mu_vec3 p, mu_vec3 direction, float distance,
                   float radiance[3], float *pdf) {
    const mu_rectangle_light *rectangle = &lights->rectangles[light];
    memset(radiance, 0, 3 * sizeof *radiance);
    *pdf = 0;
    if (!(mu_dot(direction, rectangle->normal) < 0)) return;
    memcpy(radiance, rectangle->radiance, sizeof rectangle->radiance);
    *pdf = chance(lights, light) * mu_rectangle_light_pdf(rectangle, p, direction, distance);
}
