/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_light.c: see image_light.h. World space, but for what the lobe and its reads are in: the frame of the hit. */
#include "core/render/image_light.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "core/ibl/reads.h"
#include "core/render/albedo_source.h"
#include "core/render/albedo_table.h"
#include "core/render/filtered.h"
#include "core/render/lobes.h"
#include "core/render/path.h"
#include "core/render/surface_rows.h"

/* What an albedo may be off that is integrated at a hit, and calls of its material for it at most. */
#define ENOUGH 1e-4
enum { CALLS = 1 << 13 };
/* Samples of a picture below which it is worth while to count what its materials are met by. */
enum { SMALL = 1 << 18 };

typedef struct lit_material {
    mu_lobe_source source;
    const musurf_slopes *slopes;
    mu_albedo_table albedo;
    mu_ibl_plan plan;
} lit_material;

struct mu_image_light {
    mu_ibl_globe globe;
    float *memory; /* of the globe */
    lit_material *materials;
    uint32_t count, samples; /* of a pixel */
    _Bool means;
};

/* Where a ray arrived; false: black from here. */
static _Bool arrive(const mu_tracer *tracer, const mu_image_light *light, const mu_ray *ray, const mu_hit *hit,
                    mu_shading *shading, mu_ibl_lobe_f *lobe) {
    mu_beam beam;
    if (tracer->footprints) {
        beam = mu_beam_of_pixel(&tracer->scene->camera, &tracer->scene->film, hit->p);
        if (tracer->samples) beam.share = 1 / sqrtf((float)tracer->samples);
    }
    mu_shading_place(shading, tracer->scene, hit, mu_scale(ray->direction, -1), tracer->footprints ? &beam : NULL);
    return shading->wo[2] > 0 && mu_lobe_at(&light->materials[hit->material].source, shading, lobe);
}

/* What of a read is on the side of the surface that it is lit from, where a normal map has turned the frame: paths end in there. A
 * read of slope roughness a reaches by about a to either side. */
static float above(const mu_shading *shading, mu_vec3 direction, float roughness) {
    const float a = roughness * roughness + 1e-3f, share = 0.5f + 0.5f * mu_dot(direction, shading->ng) / a;
    return fminf(fmaxf(share, 0), 1);
}

/* Up to MU_PACKET camera rays; `centres`: not spread by the film's filter. */
static uint32_t look(const mu_tracer *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t count, uint32_t sample,
                     _Bool centres, mu_ray *rays, mu_hit *hits) {
    for (uint32_t i = 0; i < count; i++) {
        mu_random random = mu_random_start(seed, x + i, y, sample);
        float u[2] = {0.5f, 0.5f};
        if (!centres) mu_random_pair(&random, u);
        rays[i] = mu_camera_ray(&tracer->scene->camera, &tracer->scene->film, x + i, y, u);
    }
    return mu_geometry_intersect_packet(tracer->geometry, rays, (1u << count) - 1, hits);
}

/* From the table; or of a closure in `scratch`, as a node of the table is made. */
static void albedo_at(const lit_material *own, mu_shading *shading, const mu_ibl_lobe_f *lobe, void *scratch, float rgb[3]) {
    if (mu_albedo_table_at(&own->albedo, lobe, shading->wo, rgb)) return;
    mu_shading_bind(shading, scratch);
    mu_albedo_bound bound = {shading->type, scratch, own->slopes};
    const mu_ibl_lobe_d wide = {.sigma = {(double)lobe->sigma[0], (double)lobe->sigma[1]},
                                .turn = {(double)lobe->turn[0], (double)lobe->turn[1]},
                                .mean = {(double)lobe->mean[0], (double)lobe->mean[1]}};
    mu_even_source source = mu_albedo_source(&bound, &wide);
    if (own->albedo.drawn) source.lobe = NULL;
    const mu_even_effort effort = {ENOUGH, CALLS};
    mu_even_mean mean = {{0, 0, 0}, 0};
    if (shading->lobes)
        mean = mu_even_light(&source, (const double[3]){(double)shading->wo[0], (double)shading->wo[1], (double)shading->wo[2]}, &effort);
    for (int c = 0; c < 3; c++) rgb[c] = (float)mean.rgb[c];
}

/* Hits of a row that are worked out together. */
typedef struct lit_row {
    size_t count;
    uint32_t at[MU_PACKET]; /* in the row */
    mu_ibl_lobe_f lobe[MU_PACKET];
    float wo[3][MU_IBL_AXES];
    mu_shading shading[MU_PACKET];
} lit_row;
_Static_assert(MU_PACKET <= (int)MU_IBL_AXES, "a row's views are worked out at once");

static void look_up(const mu_image_light *light, const mu_shading *shading, _Bool bumpy, const mu_ibl_view *reads, mu_radiance *out) {
    const float last = (float)(light->globe.levels - 1);
    float sum[4] = {0, 0, 0, 0};
    mu_ibl_batch batch;
    batch.count = reads->count;
    for (size_t k = 0; k < reads->count; k++) {
        const mu_vec3 world = mu_to_world(&shading->frame, mu_v3(reads->x[k], reads->y[k], reads->z[k]));
        batch.x[k] = world.x, batch.y[k] = world.y, batch.z[k] = world.z;
        batch.level[k] = reads->roughness[k] * last, batch.weight[k] = reads->weight[k];
        if (bumpy) batch.weight[k] *= above(shading, world, reads->roughness[k]);
    }
    mu_ibl_globe_sum(&light->globe, &batch, sum);
    out->reads = (uint32_t)reads->count;
    for (int c = 0; c < 3; c++) out->rgb[c] = out->albedo[c] * sum[c];
    if (!(isfinite(sum[0] + sum[1] + sum[2]) && sum[0] >= 0 && sum[1] >= 0 && sum[2] >= 0)) {
        out->refused = 1;
        out->rgb[0] = out->rgb[1] = out->rgb[2] = 0;
    }
}

/* All of `row`, of one material, which is empty then. */
static void shade_row(const mu_tracer *tracer, uint32_t material, uint32_t sample, lit_row *row, mu_radiance *out) {
    const mu_image_light *light = tracer->image_light;
    const _Bool bumpy = tracer->scene->materials[material].material.normal_map != NULL;
    mu_ibl_view reads[MU_PACKET];
    mu_ibl_reads_of_lobes(&light->materials[material].plan, sample, row->count, row->lobe, row->wo, reads);
    for (size_t i = 0; i < row->count; i++) look_up(light, &row->shading[i], bumpy, &reads[i], &out[row->at[i]]);
    row->count = 0;
}

void mu_image_light_row(const mu_tracer *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t count, uint32_t sample,
                        void *scratch, mu_radiance *out) {
    const mu_image_light *light = tracer->image_light;
    mu_ray rays[MU_PACKET] = {{.near = 0}};
    mu_hit hits[MU_PACKET];
    lit_row row;
    uint32_t material = 0;
    row.count = 0;
    const uint32_t met = look(tracer, seed, x, y, count, sample, 0, rays, hits);
    for (uint32_t i = 0; i < count; i++) {
        float pdf;
        out[i] = (mu_radiance){.rays = 1, .hit = met >> i & 1};
        if (!out[i].hit) {
            mu_lights_escaped(tracer->lights, rays[i].direction, out[i].rgb, &pdf);
            continue;
        }
        if (row.count && hits[i].material != material) shade_row(tracer, material, sample, &row, out);
        material = hits[i].material;
        mu_shading *const shading = &row.shading[row.count];
        mu_ibl_lobe_f *const lobe = &row.lobe[row.count];
        const _Bool bright = arrive(tracer, light, &rays[i], &hits[i], shading, lobe);
        memcpy(out[i].normal, &shading->frame.n, sizeof out[i].normal);
        if (!bright) continue;
        albedo_at(&light->materials[material], shading, lobe, scratch, out[i].albedo);
        if (!light->means) lobe->mean[0] = lobe->mean[1] = 0;
        for (int k = 0; k < 3; k++) row.wo[k][row.count] = shading->wo[k];
        row.at[row.count++] = i;
    }
    if (row.count) shade_row(tracer, material, sample, &row, out);
}

/* ------------------------------------------------------------------------------------------------ preparation */

/* How often the middles of a row's pixels meet each material, and its least and largest sigmas there. */
typedef struct survey {
    const mu_tracer *tracer;
    const mu_image_light *light;
    mu_ibl_lobe_f *low, *high; /* rows of `count` */
    uint64_t *hits;            /* as many; all that are expected, once the rows are together */
    uint32_t pictures;
} survey;

static void widen(mu_ibl_lobe_f *low, mu_ibl_lobe_f *high, const mu_ibl_lobe_f *a, const mu_ibl_lobe_f *b) {
    for (int k = 0; k < 2; k++) {
        low->sigma[k] = fminf(low->sigma[k], a->sigma[k]);
        high->sigma[k] = fmaxf(high->sigma[k], b->sigma[k]);
    }
}

/* [any] */
static void survey_row(void *context, uint32_t y) {
    const survey *s = context;
    const uint32_t width = s->tracer->scene->film.width;
    mu_ibl_lobe_f *low = s->low + (size_t)y * s->light->count, *high = s->high + (size_t)y * s->light->count;
    for (uint32_t m = 0; m < s->light->count; m++)
        low[m] = (mu_ibl_lobe_f){.sigma = {FLT_MAX, FLT_MAX}, .turn = {1, 0}}, high[m] = (mu_ibl_lobe_f){.turn = {1, 0}};
    for (uint32_t x = 0; x < width; x += MU_PACKET) {
        const uint32_t count = width - x < MU_PACKET ? width - x : MU_PACKET;
        mu_ray rays[MU_PACKET] = {{.near = 0}};
        mu_hit hits[MU_PACKET];
        const uint32_t met = look(s->tracer, 0, x, y, count, 0, 1, rays, hits);
        for (uint32_t i = 0; i < count; i++) {
            mu_shading shading;
            mu_ibl_lobe_f lobe;
            const uint32_t m = hits[i].material;
            if (!(met >> i & 1) || !arrive(s->tracer, s->light, &rays[i], &hits[i], &shading, &lobe)) continue;
            s->hits[(size_t)y * s->light->count + m]++;
            if (lobe.sigma[1] > 0) widen(&low[m], &high[m], &lobe, &lobe);
        }
    }
}

/* Of all materials into low[0 ... count - 1], high and hits. Only where some M varies, or the picture is small, is there anything to ask. */
static _Bool survey_picture(survey *s, uint32_t threads, mu_error *error) {
    const uint32_t rows = s->tracer->scene->film.height, count = s->light->count;
    const uint64_t samples = (uint64_t)s->pictures * (s->light->samples ? s->light->samples : 1), all = samples * rows * s->tracer->scene->film.width;
    _Bool asked = all < SMALL;
    for (uint32_t m = 0; m < count; m++) asked = asked || s->light->materials[m].source.map;
    s->low = calloc((size_t)rows * count + 1, sizeof *s->low);
    s->high = calloc((size_t)rows * count + 1, sizeof *s->high);
    s->hits = calloc((size_t)rows * count + 1, sizeof *s->hits);
    if (!s->low || !s->high || !s->hits) return mu_fail(error, "not enough memory");
    if (asked) mu_rows(rows, threads, survey_row, s);
    for (uint32_t m = 0; m < count; m++) {
        const mu_lobe_source *source = &s->light->materials[m].source;
        for (uint32_t y = 1; asked && y < rows; y++) {
            widen(&s->low[m], &s->high[m], &s->low[(size_t)y * count + m], &s->high[(size_t)y * count + m]);
            s->hits[m] += s->hits[(size_t)y * count + m];
        }
        if (!source->map || !(s->low[m].sigma[1] <= s->high[m].sigma[1])) s->low[m] = s->high[m] = source->lobe;
        s->hits[m] = asked ? samples * s->hits[m] : all;
    }
    return 1;
}

static _Bool make_materials(mu_image_light *light, const mu_tracer *tracer, uint32_t pictures, uint32_t threads,
                            const mu_render_watch *watch, mu_error *error) {
    const mu_scene *scene = tracer->scene;
    light->count = scene->material_count;
    light->materials = calloc((size_t)light->count + 1, sizeof *light->materials);
    if (!light->materials) return mu_fail(error, "not enough memory");
    for (uint32_t m = 0; m < light->count; m++)
        if (!mu_lobe_source_make(&light->materials[m].source, &scene->materials[m], error)) return 0;
    survey s = {.tracer = tracer, .light = light, .pictures = pictures};
    _Bool good = survey_picture(&s, threads, error);
    for (uint32_t m = 0; good && m < light->count; m++) {
        lit_material *own = &light->materials[m];
        if (watch && watch->prepare) watch->prepare(watch->context, m, light->count);
        const musurf_material_type *type = scene->materials[m].material.type;
        own->slopes = type->extension ? type->extension(MUSURF_SLOPES_ID) : NULL;
        good = mu_albedo_table_make(&own->albedo, &scene->materials[m].material, own->source.map, &own->source.moments,
                                    &s.low[m], &s.high[m], s.hits[m], threads, error);
    }
    free(s.low);
    free(s.high);
    free(s.hits);
    return good;
}

_Bool mu_image_light_takes(const mu_scene *scene, mu_error *error) {
    mu_lobe_source source;
    if (scene->integrator.idle)
        return mu_fail(error, "$.integrator.%s is of no effect on paths: \"by\" or --integrator must name a technique that has it",
                       scene->integrator.idle);
    for (uint32_t i = 0; scene->integrator.by_image && i < scene->light_count; i++)
        if (scene->lights[i].kind == MU_DIRECTIONAL || scene->lights[i].kind == MU_POINT || scene->lights[i].kind == MU_RECTANGLE_LIGHT)
            return mu_fail(error, "light %u is no light around the scene: only --integrator path renders it", i);
    for (uint32_t m = 0; scene->integrator.by_image && m < scene->material_count; m++)
        if (!mu_lobe_source_make(&source, &scene->materials[m], error)) return 0;
    return 1;
}

static size_t reads_of(const mu_integrator_settings *settings) {
    const _Bool lobe = settings->technique == MU_IBL_LOBE;
    if (settings->reads == MU_READS_USUAL && lobe) return MU_IBL_READS_OF_LOBE;
    if (settings->reads == MU_READS_USUAL || (!settings->reads && !lobe)) return mu_ibl_settings_default_f().samples;
    return settings->reads;
}

void mu_image_light_choose(mu_image_light *light, const mu_integrator_settings *settings) {
    const size_t reads = reads_of(settings);
    light->means = settings->means;
    const mu_ibl_settings_f own = {settings->k, settings->beta, reads, settings->appendix_c};
    for (uint32_t m = 0; m < light->count; m++) {
        lit_material *material = &light->materials[m];
        mu_ibl_plan_make(settings->technique, &own, &material->plan);
        mu_ibl_plan_phases(&material->plan, light->samples);
        if (settings->tails) mu_ibl_plan_tail(&material->plan, material->source.tail);
    }
}

mu_image_light *mu_image_light_make(const mu_tracer *tracer, uint32_t pictures, uint32_t threads,
                                    const mu_render_watch *watch, mu_error *error) {
    mu_image_light *light = calloc(1, sizeof *light);
    if (!light) {
        mu_fail(error, "not enough memory");
        return NULL;
    }
    light->samples = tracer->samples;
    if (mu_image_light_takes(tracer->scene, error) && make_materials(light, tracer, pictures, threads, watch, error) &&
        (light->memory = mu_filtered_make(&light->globe, tracer->lights, threads, error))) {
        mu_image_light_choose(light, &tracer->scene->integrator);
        return light;
    }
    mu_image_light_free(light);
    return NULL;
}

_Bool mu_image_light_relight(mu_image_light *light, const mu_lights *lights, uint32_t threads, mu_error *error) {
    free(light->memory);
    return (light->memory = mu_filtered_make(&light->globe, lights, threads, error)) != NULL;
}

void mu_image_light_free(mu_image_light *light) {
    if (!light) return;
    for (uint32_t m = 0; light->materials && m < light->count; m++) mu_albedo_table_free(&light->materials[m].albedo);
    free(light->materials);
    free(light->memory);
    free(light);
}
