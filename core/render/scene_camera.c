/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_camera.c: "camera", "film" and "integrator": where from, onto what, and how much work. */
#include <math.h>
#include <string.h>

#include "core/render/affine.h"
#include "core/render/direct.h"
#include "core/render/scene_read.h"

static mu_dvec3 widen(mu_vec3 v) {
    return mu_d3((double)v.x, (double)v.y, (double)v.z);
}

static _Bool orient(mu_camera *camera, const mu_place *place, mu_vec3 target, mu_vec3 up, mu_error *error) {
    const mu_dvec3 forward = mu_dnormalise(mu_dsub(widen(target), widen(camera->position)));
    const mu_dvec3 upwards = mu_dnormalise(widen(up));
    const mu_dvec3 right = mu_dcross(forward, upwards);
    if (!(mu_dlength(forward) > 0))
        return mu_place_fail(place, error, "position and target are the same point");
    if (!(mu_dlength(upwards) > 0)) return mu_place_fail(place, error, "up is the zero vector");
    if (!(mu_dlength(right) > 1e-6))
        return mu_place_fail(place, error, "up is along the line of sight; it must point aside from it");
    camera->forward = mu_single(forward);
    camera->right = mu_single(mu_dnormalise(right));
    camera->up = mu_single(mu_dcross(mu_dnormalise(right), forward));
    return 1;
}

_Bool mu_read_camera(mu_reader *reader) {
    static const char *const types[] = {"perspective", "orthographic", NULL};
    mu_camera *camera = &reader->scene->camera;
    mu_error *error = reader->error;
    mu_vec3 target = mu_v3(0, 0, 0), up = mu_v3(0, 0, 1);
    size_t type = 0;
    float fov = 35, height = 2;
    const mu_place place = mu_place_member(&reader->root, "camera");
    camera->position = mu_v3(0, -4, 2);
    if (place.value) {
        if (!json_is_object(place.value))
            return mu_place_only(&place, mu_scene_keys(MU_KEYS_PERSPECTIVE), error);
        if (!mu_read_choice(&place, "type", types, &type, error) ||
            !mu_place_only(&place, mu_scene_keys(type ? MU_KEYS_ORTHOGRAPHIC : MU_KEYS_PERSPECTIVE), error) ||
            !mu_read_vector(&place, "position", &camera->position, error) ||
            !mu_read_vector(&place, "target", &target, error) || !mu_read_vector(&place, "up", &up, error) ||
            !mu_read_float(&place, "fov", 1e-3, 179, &fov, error) ||
            !mu_read_float(&place, "height", 1e-9, MU_LARGEST, &height, error))
            return 0;
    }
    camera->kind = type ? MU_ORTHOGRAPHIC : MU_PERSPECTIVE;
    camera->half_height = type ? height / 2 : (float)tan((double)fov * (3.14159265358979323846 / 360));
    return orient(camera, &place, target, up, error);
}

_Bool mu_read_film(mu_reader *reader) {
    static const char *const filters[] = {"box", "gaussian", NULL}, *const pixels[] = {"float", "half", NULL};
    mu_film_settings *film = &reader->scene->film;
    mu_error *error = reader->error;
    size_t filter = 1, half = 1;
    const mu_place place = mu_place_member(&reader->root, "film");
    film->width = 640;
    film->height = 360;
    if (place.value) {
        if (!mu_place_only(&place, mu_scene_keys(MU_KEYS_FILM), error) ||
            !mu_read_count(&place, "width", 1, MU_LONGEST_SIDE, &film->width, error) ||
            !mu_read_count(&place, "height", 1, MU_LONGEST_SIDE, &film->height, error) ||
            !mu_read_choice(&place, "filter", filters, &filter, error) ||
            !mu_read_float(&place, "exposure", -64, 64, &film->exposure, error) ||
            !mu_read_choice(&place, "pixels", pixels, &half, error))
            return 0;
        if ((long long)film->width * film->height > MU_MOST_PIXELS)
            return mu_place_fail(&place, error, "%u x %u pixels are too many; %d is the limit",
                                 (unsigned)film->width, (unsigned)film->height, MU_MOST_PIXELS);
    }
    film->filter = filter ? MU_FILTER_GAUSSIAN : MU_FILTER_BOX;
    film->filter_radius = filter ? 1.5f : 0.5f;
    film->half = half == 1;
    return !place.value || mu_read_float(&place, "radius", 1e-3, 64, &film->filter_radius, error);
}

#define KEY(name, key, title) key,
const char *const mu_integrators[] = {"path", MU_IBL_FOR_TECHNIQUES(KEY) NULL};
static const char *const shifts[] = {"symmetric", "printed", NULL};

void mu_integrator_choose(mu_integrator_settings *integrator, size_t index) {
    integrator->by_image = index > 0, integrator->idle = NULL;
    if (index) integrator->technique = (mu_ibl_technique)(index - 1);
}

/* What is a technique's own: the key, and the techniques, as bits of mu_integrators' indices. */
#define INDEX(name, key, title) INDEX_##name,
enum { INDEX_PATH, MU_IBL_FOR_TECHNIQUES(INDEX) };
static const struct {
    const char *key, *names;
    unsigned techniques;
} of_techniques[] = {{"reads", "major-axis, lobe and filtered", 1u << INDEX_MAJOR_AXIS | 1u << INDEX_LOBE | 1u << INDEX_FILTERED},
                     {"k", "major-axis", 1u << INDEX_MAJOR_AXIS},
                     {"beta", "major-axis", 1u << INDEX_MAJOR_AXIS},
                     {"appendix_c", "major-axis", 1u << INDEX_MAJOR_AXIS},
                     {"tails", "lobe", 1u << INDEX_LOBE},
                     {"means", "lobe", 1u << INDEX_LOBE}};

/* Refuses what the technique takes no notice of. The command line may name another: where the scene names none, it is asked later. */
static _Bool touches(const mu_place *integrator, size_t by, const char **idle, mu_error *error) {
    const _Bool named = mu_place_member(integrator, "by").value != NULL;
    for (size_t i = 0; i < sizeof of_techniques / sizeof *of_techniques; i++) {
        const mu_place place = mu_place_member(integrator, of_techniques[i].key);
        if (!place.value || of_techniques[i].techniques >> by & 1) continue;
        if (named)
            return mu_place_fail(&place, error, "is of no effect by \"%s\": it is a setting of %s", mu_integrators[by],
                                 of_techniques[i].names);
        *idle = of_techniques[i].key;
    }
    return 1;
}

/* A number, or "auto". */
static _Bool read_reads(const mu_place *integrator, uint32_t *reads, mu_error *error) {
    const mu_place place = mu_place_member(integrator, "reads");
    const char *text;
    if (!json_is_string(place.value)) return mu_read_count(integrator, "reads", 1, MU_IBL_READS_MOST, reads, error);
    if (!mu_place_string(&place, &text, error)) return 0;
    if (strcmp(text, "auto"))
        return mu_place_fail(&place, error, "is \"%s\"; a whole number from 1 to %d or \"auto\" is needed", text, MU_IBL_READS_MOST);
    *reads = 0;
    return 1;
}

_Bool mu_read_integrator(mu_reader *reader) {
    mu_integrator_settings *integrator = &reader->scene->integrator;
    mu_error *error = reader->error;
    size_t by = 0, shift = 0;
    const mu_place place = mu_place_member(&reader->root, "integrator");
    const mu_ibl_settings_f axis = mu_ibl_settings_default_f();
    *integrator = (mu_integrator_settings){
        .depth = 8, .roulette = 4, .samples = 64, .light_cells = 2, .reads = MU_READS_USUAL, .k = axis.k, .beta = axis.beta, .tails = 1, .means = 1, .seed = 0};
    if (!place.value) return 1;
    if (!mu_place_only(&place, mu_scene_keys(MU_KEYS_INTEGRATOR), error) ||
        !mu_read_count(&place, "samples", 1, 1 << 24, &integrator->samples, error) ||
        !mu_read_count(&place, "depth", 1, 4096, &integrator->depth, error) ||
        !mu_read_count(&place, "roulette", 1, 4096, &integrator->roulette, error) ||
        !read_reads(&place, &integrator->reads, error) ||
        !mu_read_float(&place, "k", 1e-3, 1e3, &integrator->k, error) ||
        !mu_read_float(&place, "beta", 0, 1e3, &integrator->beta, error) ||
        !mu_read_choice(&place, "appendix_c", shifts, &shift, error) ||
        !mu_read_choice(&place, "by", mu_integrators, &by, error))
        return 0;
    integrator->appendix_c = shift ? MU_IBL_PRINTED : MU_IBL_SYMMETRIC;
    mu_integrator_choose(integrator, by);
    if (!touches(&place, by, &integrator->idle, error)) return 0;
    const mu_place tails = mu_place_member(&place, "tails"), means = mu_place_member(&place, "means");
    if ((tails.value && !mu_place_flag(&tails, &integrator->tails, error)) ||
        (means.value && !mu_place_flag(&means, &integrator->means, error)))
        return 0;
    const mu_place seed = mu_place_member(&place, "seed"), lights = mu_place_member(&place, "light_sampling");
    _Bool sampled = 1;
    long long value;
    if (lights.value && !mu_place_flag(&lights, &sampled, error)) return 0;
    integrator->bsdf_only = !sampled;
    uint32_t candidates = integrator->light_cells * integrator->light_cells;
    const mu_place of_light = mu_place_member(&place, "light_candidates");
    if (!mu_read_count(&place, "light_candidates", 1, MU_LIGHT_CELLS * MU_LIGHT_CELLS, &candidates, error))
        return 0;
    integrator->light_cells = (uint32_t)lround(sqrt((double)candidates));
    if (integrator->light_cells * integrator->light_cells != candidates)
        return mu_place_fail(&of_light, error, "is %u; 1, 4, 9 or 16 is needed", candidates);
    if (!seed.value) return 1;
    if (!mu_place_integer(&seed, 0, 1ll << 53, &value, error)) return 0;
    integrator->seed = (uint64_t)value;
    return 1;
}
