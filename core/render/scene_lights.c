/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * scene_lights.c: "lights". Without the key the studio serves; an empty list is darkness.
 *
 * A rectangle light becomes an object, too, so that rays can hit it.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/render/scene_read.h"

/* In the order of mu_light.kind. */
static const char *const types[] = {"environment", "constant", "studio", "directional", "point", "rectangle", NULL};
static const mu_key_set keys[] = {MU_KEYS_ENVIRONMENT, MU_KEYS_CONSTANT, MU_KEYS_STUDIO, MU_KEYS_DIRECTIONAL,
                                  MU_KEYS_POINT, MU_KEYS_RECTANGLE_LIGHT};

static _Bool read_turn(const mu_place *place, mu_light *light, mu_error *error) {
    float degrees = 0;
    if (!mu_read_float(place, "rotation", -MU_LARGEST, MU_LARGEST, &degrees, error)) return 0;
    light->rotation = (float)(remainder((double)degrees, 360) * (3.14159265358979323846 / 180));
    return mu_read_color(place, "scale", light->scale, error);
}

/* The file must be there; if not, and the scene allows it, the light becomes a studio. */
static _Bool read_image(mu_reader *reader, const mu_place *place, mu_light *light) {
    static const char *const fallbacks[] = {"studio", NULL};
    const mu_place image = mu_place_member(place, "image"), fallback = mu_place_member(place, "fallback");
    const char *name;
    size_t choice;
    if (fallback.value && !mu_place_choice(&fallback, fallbacks, &choice, reader->error)) return 0;
    if (!mu_place_string(&image, &name, reader->error)) return 0;
    light->image = mu_scene_path(reader, name);
    light->place = mu_place_text(&image);
    if (!light->image || !light->place) return mu_fail(reader->error, "not enough memory for the scene");
    if (!access(light->image, R_OK)) return 1;
    if (!fallback.value || errno != ENOENT)
        return mu_place_fail(&image, reader->error, "%.500s: %s", light->image, strerror(errno));
    char text[640];
    snprintf(text, sizeof text, "%.500s is missing; the studio lights the scene instead", light->image);
    mu_scene_warn(reader, &image, text);
    free(light->image);
    light->image = NULL;
    light->kind = MU_STUDIO;
    return 1;
}

static _Bool read_direction(const mu_place *place, mu_light *light, mu_error *error) {
    const mu_place direction = mu_place_member(place, "direction");
    if (!mu_read_vector(place, "direction", &light->direction, error)) return 0;
    const double x = (double)light->direction.x, y = (double)light->direction.y,
                 z = (double)light->direction.z;
    const double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0)) return mu_place_fail(&direction, error, "must not be the zero vector");
    light->direction = mu_v3((float)(x / length), (float)(y / length), (float)(z / length));
    return 1;
}

static _Bool read_point(const mu_place *place, mu_light *light, mu_error *error) {
    float angle = 360, blend = 0;
    light->direction = mu_v3(0, 0, -1);
    if (!mu_read_vector(place, "position", &light->position, error) || !read_direction(place, light, error) ||
        !mu_read_color(place, "intensity", light->irradiance, error) ||
        !mu_read_float(place, "angle", 0, 360, &angle, error) || !mu_read_float(place, "blend", 0, 1, &blend, error))
        return 0;
    const double edge = angle < 360 ? cos((double)angle * (3.14159265358979323846 / 360)) : -1;
    light->cone[0] = (float)edge;
    light->cone[1] = (float)((1 - edge) * (double)blend);
    return 1;
}

static _Bool add_object(mu_reader *reader, const mu_light *light, uint32_t index) {
    mu_scene *scene = reader->scene;
    if (!mu_append((void **)&scene->objects, &scene->object_count, sizeof *scene->objects, reader->error))
        return 0;
    scene->objects[scene->object_count - 1] = (mu_object){.shape = MU_RECTANGLE,
                                                          .size = {light->size[0], light->size[1]},
                                                          .to_world = light->to_world,
                                                          .material = MU_NO_INDEX,
                                                          .light = index};
    return 1;
}

static _Bool read_light(mu_reader *reader, const mu_place *place, mu_light *light, uint32_t index) {
    const mu_place type = mu_place_member(place, "type");
    mu_error *error = reader->error;
    size_t kind;
    if (!json_is_object(place->value)) return mu_place_only(place, mu_scene_keys(MU_KEYS_ENVIRONMENT), error);
    if (!mu_place_choice(&type, types, &kind, error)) return 0;
    *light = (mu_light){.scale = {1, 1, 1}, .irradiance = {1, 1, 1}, .size = {1, 1}};
    light->kind = (__typeof__(light->kind))kind;
    if (!mu_place_only(place, mu_scene_keys(keys[kind]), error)) return 0;
    switch (light->kind) {
    case MU_ENVIRONMENT:
        return read_turn(place, light, error) && read_image(reader, place, light);
    case MU_STUDIO:
        return read_turn(place, light, error);
    case MU_CONSTANT:
        return mu_read_color(place, "radiance", light->scale, error);
    case MU_DIRECTIONAL:
        light->direction = mu_v3(0, 0, 1);
        return read_direction(place, light, error) && mu_read_color(place, "irradiance", light->irradiance, error);
    case MU_POINT:
        return read_point(place, light, error);
    case MU_RECTANGLE_LIGHT:
        return mu_read_floats(place, "size", 2, 1e-9, MU_LARGEST, light->size, error) &&
               mu_read_color(place, "radiance", light->scale, error) &&
               mu_read_transform(place, &light->to_world, error) && add_object(reader, light, index);
    }
    return 0;
}

static _Bool surrounds(const mu_light *light) {
    return light->kind == MU_ENVIRONMENT || light->kind == MU_CONSTANT || light->kind == MU_STUDIO;
}

static _Bool append(mu_reader *reader, const mu_light *light) {
    mu_scene *scene = reader->scene;
    if (!mu_append((void **)&scene->lights, &scene->light_count, sizeof *light, reader->error)) return 0;
    scene->lights[scene->light_count - 1] = *light;
    return 1;
}

_Bool mu_read_lights(mu_reader *reader) {
    const mu_place place = mu_place_member(&reader->root, "lights");
    _Bool surrounded = 0;
    if (!place.value) return append(reader, &(mu_light){.kind = MU_STUDIO, .scale = {1, 1, 1}});
    if (!json_is_array(place.value)) return mu_place_fail(&place, reader->error, "must be a list of lights");
    for (size_t i = 0; i < json_array_size(place.value); ++i) {
        const mu_place element = mu_place_element(&place, i);
        mu_light light = {0};
        if (!read_light(reader, &element, &light, reader->scene->light_count) || !append(reader, &light)) {
            free(light.image);
            free(light.place);
            return 0;
        }
        if (surrounds(&light) && surrounded)
            return mu_place_fail(&element, reader->error,
                                 "the scene is surrounded already; at most one light may be an environment, "
                                 "constant or studio");
        surrounded = surrounded || surrounds(&light);
    }
    return 1;
}
