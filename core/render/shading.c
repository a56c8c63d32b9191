/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* shading.c: the frame, the map M and the closure at a hit. World space in, local frame out (see shading.h).
 */
#include "core/render/shading.h"
#include "core/render/blend.h"
#include "core/render/normal_turn.h"
#include "core/render/varying.h"

enum { TRANSMISSION = MUSURF_GLOSSY_TRANSMISSION | MUSURF_DELTA_TRANSMISSION | MUSURF_DIFFUSE_TRANSMISSION };

mu_frame mu_shading_frame(mu_vec3 n, mu_vec3 t) {
    t = mu_normalise(mu_sub(t, mu_scale(n, mu_dot(n, t))));
    if (!(mu_dot(t, t) > 0.5f)) /* t was along n */
        t = mu_normalise(mu_cross(n, fabsf(n.x) < 0.5f ? mu_v3(1, 0, 0) : mu_v3(0, 1, 0)));
    return (mu_frame){t, mu_cross(n, t), n};
}

/* Numbers of the scene's list, between the vertices of a triangle; 0 where the mesh has none. Equal ones give that exactly. */
static void attributes_at(const mu_scene *scene, const mu_hit *hit, float *out) {
    const mu_object *object = &scene->objects[hit->object];
    if (object->shape != MU_MESH) return;
    const mu_mesh *mesh = &scene->meshes[object->mesh];
    const uint32_t *corner = mesh->indices + 3 * (size_t)hit->primitive;
    for (uint32_t i = 0; i < scene->attribute_count; i++) {
        const float *values = mesh->attributes[i];
        if (!values) continue;
        const double first = (double)values[corner[0]];
        out[i] = (float)(first + (double)hit->corner[0] * ((double)values[corner[1]] - first) +
                         (double)hit->corner[1] * ((double)values[corner[2]] - first));
    }
}

/* What a sample sees at once: its share of the beam. */
static void footprint_of(const mu_hit *hit, mu_vec3 wo, const mu_beam *beam, float out[6]) {
    out[0] = hit->uv[0], out[1] = hit->uv[1];
    for (int i = 2; i < 6; i++) out[i] = INFINITY;
    if (!beam) return;
    mu_footprint_at(hit, mu_scale(wo, -1), beam, out);
    for (int i = 2; i < 6; i++) out[i] *= beam->share; /* the pixel's other samples see the rest */
}

/* Parameters that have sources, into slots; true: they come down to an M, which is put into those of "transform". */
static _Bool values(const mu_scene *scene, const mu_material *material, const mu_hit *hit, mu_vec3 wo,
                    const mu_beam *beam, float *slots) {
    const float share = beam ? beam->share : 1;
    float footprint[6];
    float attributes[MU_ATTRIBUTES] = {0};
    footprint_of(hit, wo, material->varying->pictured ? beam : NULL, footprint);
    if (material->varying->pointwise) attributes_at(scene, hit, attributes);
    mu_varying_at(material->varying, material->compiled, footprint, share * share, attributes, slots, slots + MU_SLOT_TRANSFORM);
    return material->varying->map != NULL;
}

void mu_shading_tension(const mu_hit *hit, _Bool turned, const float transform[4], float m[4]) {
    const float *t = hit->tension;
    const double across = turned ? -1 : 1;
    for (int column = 0; column < 2; column++) {
        const double x = (double)transform[column], y = (double)transform[2 + column];
        m[column] = (float)((double)t[0] * x + across * (double)t[1] * y);
        m[2 + column] = (float)(across * (double)t[2] * x + (double)t[3] * y);
    }
}

void mu_shading_jacobian(const mu_material *material, const mu_hit *hit, const mu_frame *frame,
                         const float transform[4], float m[4]) {
    const double p00 = (double)mu_dot(hit->dpdu, frame->t), p01 = (double)mu_dot(hit->dpdv, frame->t);
    const double p10 = (double)mu_dot(hit->dpdu, frame->b), p11 = (double)mu_dot(hit->dpdv, frame->b);
    const double determinant = p00 * p11 - p01 * p10;
    /* P J P^-1 = 1 + P (J - 1) P^-1, which is 1 exactly where J is */
    double k[4];
    mu_jacobian_at(&material->jacobian, (double)hit->uv[0], (double)hit->uv[1], k);
    for (int i = 0; i < 4; i++) k[i] /= determinant;
    const double a00 = p00 * k[0] + p01 * k[2], a01 = p00 * k[1] + p01 * k[3];
    const double a10 = p10 * k[0] + p11 * k[2], a11 = p10 * k[1] + p11 * k[3];
    const double j00 = 1 + (a00 * p11 - a01 * p10), j01 = a01 * p00 - a00 * p01;
    const double j10 = a10 * p11 - a11 * p10, j11 = 1 + (a11 * p00 - a10 * p01);
    const float t[4] = {transform[0], transform[1], transform[2], transform[3]};
    for (int column = 0; column < 2; column++) {
        m[column] = (float)(j00 * (double)t[column] + j01 * (double)t[2 + column]);
        m[2 + column] = (float)(j10 * (double)t[column] + j11 * (double)t[2 + column]);
    }
    if (isfinite(m[0]) && isfinite(m[1]) && isfinite(m[2]) && isfinite(m[3])) return;
    for (int i = 0; i < 4; i++) m[i] = t[i];
}

void mu_shading_place(mu_shading *shading, const mu_scene *scene, const mu_hit *hit, mu_vec3 wo, const mu_beam *beam) {
    const mu_material *material = &scene->materials[hit->material].material;
    shading->hit = hit;
    shading->frame = hit->frame;
    shading->ng = hit->ng;
    shading->type = material->type;
    _Bool front = mu_dot(wo, hit->ng) > 0, turned = 0;
    /* what transmits has an inside: turned over, light would enter the glass where it leaves it */
    const _Bool opaque = !(material->plan.lobes & TRANSMISSION);
    if (!front && opaque && scene->objects[hit->object].two_sided) {
        shading->ng = mu_scale(shading->ng, -1);
        shading->frame.n = mu_scale(shading->frame.n, -1);
        shading->frame.b = mu_scale(shading->frame.b, -1);
        front = turned = 1;
    }
    mu_vec3 local = mu_to_local(&shading->frame, wo);
    if ((local.z > 0) != front) {
        shading->frame = mu_shading_frame(shading->ng, shading->frame.t);
        local = mu_to_local(&shading->frame, wo);
    }
    const float *slots = NULL;
    const float *transform = material->transform;
    float *const m = shading->slots + MU_SLOT_TRANSFORM;
    if (material->varying) {
        if (values(scene, material, hit, wo, beam, shading->slots)) transform = m;
        slots = shading->slots;
    }
    if (material->tension) {
        mu_shading_tension(hit, turned, transform, m);
        transform = m;
        slots = shading->slots;
    }
    if (material->normal_map && transform != m) { /* it may be widened in there */
        for (int i = 0; i < 4; i++) m[i] = transform[i];
        transform = m;
        slots = shading->slots;
    }
    if (material->jacobian.map != MU_JACOBIAN_NONE) {
        mu_shading_jacobian(material, hit, &shading->frame, transform, m);
        slots = shading->slots;
    }
    if (material->footprints) {
        float *const footprint = shading->slots + MU_SLOT_FOOTPRINT;
        for (int i = 0; i < 6; i++) footprint[i] = INFINITY;
        if (beam) mu_footprint_at(hit, mu_scale(wo, -1), beam, footprint);
        slots = shading->slots;
    }
    shading->wo[0] = local.x, shading->wo[1] = local.y, shading->wo[2] = local.z;
    shading->pushed = slots;
    shading->map = material->varying ? material->varying->map : NULL;
    shading->compiled = material->compiled;
    if (material->blend) {
        float footprint[6], attributes[MU_ATTRIBUTES] = {0};
        footprint_of(hit, wo, beam, footprint);
        attributes_at(scene, hit, attributes);
        shading->compiled = mu_blend_at(material->blend, footprint, attributes);
    }
    if (material->normal_map) mu_normal_turn(shading, material, beam, wo, turned);
}

void mu_shading_bind(mu_shading *shading, void *closure) {
    shading->closure = closure;
    shading->lobes = shading->map ? shading->map->setup(shading->compiled, shading->wo, shading->slots + MU_SLOT_TRANSFORM,
                                                        shading->pushed, 0, closure)
                                  : shading->type->setup(shading->compiled, shading->wo, shading->pushed, 0, closure);
}

void mu_shading_begin(mu_shading *shading, const mu_scene *scene, const mu_hit *hit, mu_vec3 wo,
                      const mu_beam *beam, void *closure) {
    mu_shading_place(shading, scene, hit, wo, beam);
    mu_shading_bind(shading, closure);
}
