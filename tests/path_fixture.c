/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* path_fixture.c: see path_fixture.h. */
#include "tests/path_fixture.h"

#include <stdlib.h>
#include <string.h>

void fixture_start(path_fixture *f, uint32_t pixels) {
    memset(f, 0, sizeof *f);
    const char *build = getenv("BUILD");
    setenv("MUSURF_PLUGIN_PATH", build ? build : "build", 1);
    f->scene.plugins = mu_plugins_new();
    assert_non_null(f->scene.plugins);
    f->scene.materials = f->materials;
    f->scene.objects = f->objects;
    f->scene.lights = f->lights;
    f->scene.film.width = f->scene.film.height = pixels;
    f->scene.film.filter_radius = 0.5f;
    f->scene.integrator.depth = 1;
    f->scene.integrator.roulette = 1000;
    f->scene.camera.kind = MU_ORTHOGRAPHIC;
    f->scene.camera.half_height = 1;
    fixture_look(f, mu_v3(0, 0, 1), mu_v3(0, 1, 0));
}

void fixture_look(path_fixture *f, mu_vec3 direction, mu_vec3 up) {
    mu_camera *camera = &f->scene.camera;
    camera->position = mu_scale(direction, 10);
    camera->forward = mu_scale(direction, -1);
    camera->right = mu_normalise(mu_cross(camera->forward, up));
    camera->up = mu_cross(camera->right, camera->forward);
}

uint32_t fixture_material(path_fixture *f, const char *json) {
    mu_document document;
    mu_error error = {.text = ""};
    const uint32_t index = f->scene.material_count++;
    assert_true(index < FIXTURE_MOST);
    if (!mu_document_parse(&document, "test", json, strlen(json), 1, &error)) fail_msg("%s", error.text);
    const mu_place root = mu_place_root(&document);
    if (!mu_material_read(&f->materials[index].material, f->scene.plugins, &root, &error))
        fail_msg("%s", error.text);
    mu_document_free(&document);
    return index;
}

static mu_object *add(path_fixture *f, mu_object object) {
    const uint32_t index = f->scene.object_count++;
    assert_true(index < FIXTURE_MOST);
    f->objects[index] = object;
    return &f->objects[index];
}

mu_object *fixture_rectangle(path_fixture *f, float width, float height, mu_affine to_world,
                             uint32_t material) {
    return add(f, (mu_object){.shape = MU_RECTANGLE,
                              .size = {width, height},
                              .to_world = to_world,
                              .material = material,
                              .light = MU_NO_INDEX});
}

mu_object *fixture_sphere(path_fixture *f, float radius, uint32_t material) {
    return add(f, (mu_object){.shape = MU_SPHERE,
                              .radius = radius,
                              .to_world = fixture_turn(0),
                              .material = material,
                              .light = MU_NO_INDEX});
}

mu_light *fixture_light(path_fixture *f, mu_light light) {
    const uint32_t index = f->scene.light_count++;
    assert_true(index < FIXTURE_MOST);
    f->lights[index] = light;
    if (light.kind == MU_RECTANGLE_LIGHT)
        fixture_rectangle(f, light.size[0], light.size[1], light.to_world, MU_NO_INDEX)->light = index;
    return &f->lights[index];
}

void fixture_ready(path_fixture *f) {
    mu_error error = {.text = ""};
    f->geometry = mu_geometry_build(&f->scene, 1, &error);
    if (!f->geometry) fail_msg("%s", error.text);
    f->made = mu_lights_build(&f->scene, &error);
    if (!f->made) fail_msg("%s", error.text);
    f->scratch = aligned_alloc(64, mu_integrator_scratch(&f->scene));
    assert_non_null(f->scratch);
    f->tracer = (mu_tracer){&f->scene, f->geometry, f->made, 0, 0, NULL};
    for (uint32_t i = 0; i < f->scene.material_count; i++)
        f->tracer.footprints |= f->materials[i].material.footprints;
}

void fixture_end(path_fixture *f) {
    free(f->scratch);
    mu_lights_free(f->made);
    mu_geometry_free(f->geometry);
    for (uint32_t i = 0; i < f->scene.material_count; i++) mu_material_free(&f->materials[i].material);
    mu_plugins_free(f->scene.plugins);
}

mu_radiance fixture_sample(const path_fixture *f, const mu_path_options *options, uint64_t seed, uint32_t x,
                           uint32_t y, uint32_t sample) {
    mu_radiance out;
    mu_path_pixel(&f->tracer, options, seed, x, y, sample, f->scratch, &out);
    assert_int_equal(out.refused, 0);
    assert_true(isfinite(out.rgb[0] + out.rgb[1] + out.rgb[2]));
    return out;
}

static double pixel(const path_fixture *f, const mu_path_options *options, uint64_t seed, uint32_t x,
                    uint32_t y, uint32_t samples) {
    double sum = 0;
    for (uint32_t s = 0; s < samples; s++) sum += (double)fixture_sample(f, options, seed, x, y, s).rgb[0];
    return sum / samples;
}

moments fixture_mean(const path_fixture *f, const mu_path_options *options, uint64_t seed, int replicas,
                     uint32_t samples) {
    const uint32_t width = f->scene.film.width, height = f->scene.film.height;
    moments m = {0, 0, 0};
    for (int r = 0; r < replicas; r++) {
        double sum = 0;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) sum += pixel(f, options, seed + (uint64_t)r, x, y, samples);
        accumulate(&m, sum / (width * height));
    }
    return m;
}

void fixture_pixels(const path_fixture *f, uint64_t seed, int replicas, uint32_t samples, moments *out) {
    const uint32_t width = f->scene.film.width, height = f->scene.film.height;
    const mu_path_options options = {0};
    memset(out, 0, (size_t)(width * height) * sizeof *out);
    for (int r = 0; r < replicas; r++)
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                accumulate(&out[y * width + x], pixel(f, &options, seed + (uint64_t)r, x, y, samples));
}

static double variance_of_mean(const moments *m) {
    const double mean = m->sum / m->n;
    return fmax(m->squares / m->n - mean * mean, 0) / (m->n - 1);
}

double p_of_means(const moments *a, const moments *b, double slack) {
    const double off = fmax(fabs(a->sum / a->n - b->sum / b->n) - slack, 0);
    const double variance = variance_of_mean(a) + variance_of_mean(b);
    return variance > 0 ? p_of_z(off / sqrt(variance)) : off > 0 ? 0 : 1;
}

double p_of_pictures(const moments *a, const moments *b, size_t pixels) {
    double chi2 = 0, freedom = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double off = a[i].sum / a[i].n - b[i].sum / b[i].n;
        const double variance = variance_of_mean(&a[i]) + variance_of_mean(&b[i]);
        if (!(variance > 0)) continue; /* black in both, or the caller's other checks fail */
        chi2 += off * off / variance;
        freedom++;
    }
    return freedom > 0 ? p_of_chi2(chi2, freedom) : 0;
}

mu_affine fixture_turn(float angle) {
    const float c = cosf(angle), s = sinf(angle);
    return (mu_affine){{{c, -s, 0, 0}, {s, c, 0, 0}, {0, 0, 1, 0}}};
}
