/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_draw.c: see check_draw.h. */
#include "core/render/check_draw.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef enum map_kind {
    MAP_NONE,
    MAP_STRETCH, /* the first ggx: the classic anisotropy */
    MAP_GENERAL,
    MAP_SKEW,
    MAP_ROTATION,
    MAP_NEARLY_SINGULAR,
    MAP_MIRROR,
    MAP_LARGE,
    MAP_SMALL,
    MAP_HUGE,
    MAP_TINY,
    MAP_KINDS
} map_kind;

static void product(const double a[4], const double b[4], double out[4]) {
    const double c[4] = {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
                         a[2] * b[1] + a[3] * b[3]};
    memcpy(out, c, sizeof c);
}

static void rotation(double angle, double out[4]) {
    const double r[4] = {cos(angle), -sin(angle), sin(angle), cos(angle)};
    memcpy(out, r, sizeof r);
}

/* Turn, stretch, turn: every map with the given singular values. */
static void with_singular_values(double x, double y, mu_stream *random, double m[4]) {
    double left[4], right[4];
    const double diagonal[4] = {x, 0, 0, y};
    rotation(mu_stream_between(random, 0, 2 * PI), left);
    rotation(mu_stream_between(random, 0, 2 * PI), right);
    product(left, diagonal, m);
    product(m, right, m);
}

static double log_uniform(mu_stream *random, double low, double high) {
    return exp(mu_stream_between(random, log(low), log(high)));
}

static void draw_map(map_kind kind, mu_stream *random, double m[4]) {
    const double a = log_uniform(random, 0.2, 5), b = log_uniform(random, 0.2, 5);
    const double scale = kind == MAP_LARGE ? 1e4 : kind == MAP_SMALL ? 1e-4 : kind == MAP_HUGE ? 1e12 : 1e-12;
    const double none[4] = {1, 0, 0, 1}, stretch[4] = {a, 0, 0, b},
                 skew[4] = {1, mu_stream_between(random, -3, 3), 0, 1};
    switch (kind) {
    case MAP_STRETCH:
        memcpy(m, stretch, sizeof stretch);
        break;
    case MAP_SKEW:
        memcpy(m, skew, sizeof skew);
        break;
    case MAP_ROTATION:
        rotation(mu_stream_between(random, 0, 2 * PI), m);
        break;
    case MAP_GENERAL:
        with_singular_values(a, b, random, m);
        break;
    case MAP_MIRROR:
        with_singular_values(a, -b, random, m);
        break;
    case MAP_NEARLY_SINGULAR:
        with_singular_values(1, log_uniform(random, 1e-8, 1e-3), random, m);
        break;
    case MAP_LARGE:
    case MAP_SMALL:
    case MAP_HUGE:
    case MAP_TINY:
        with_singular_values(scale * a, scale * b, random, m);
        break;
    default:
        memcpy(m, none, sizeof none);
    }
}

/* One of the two pure samplers, whose normals have a density to be held to, if the type has a say in it at all: mixtures
 * of them have none of their own. */
static const char *choice_of_sampler(const musurf_material_type *type, uint64_t index) {
    static const char *const pure[] = {"visible", "ndf"};
    for (uint32_t i = 0; i < type->param_count; i++) {
        const musurf_param *p =
            (const musurf_param *)(const void *)((const char *)type->params + i * type->params[0].size);
        if (strcmp(p->name, "sampler") || p->kind != MUSURF_CHOICE || !p->choices) continue;
        for (size_t k = 0; p->choices[k]; k++)
            if (!strcmp(p->choices[k], pure[index % 2])) return pure[index % 2];
    }
    return NULL;
}

__attribute__((format(printf, 3, 4))) static void append(char *text, size_t size, const char *format, ...) {
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

static void print(char *text, size_t size, const char *head, const char *shape, const double *m,
                  const char *tail) {
    snprintf(text, size, "{%s%s", head, shape);
    if (m) append(text, size, ", \"transform\": [[%.17g, %.17g], [%.17g, %.17g]]", m[0], m[1], m[2], m[3]);
    append(text, size, "%s}", tail);
}

static double special_or(const double *special, size_t count, uint64_t turn, mu_stream *random, double low,
                         double high) {
    const double drawn = mu_stream_between(random, low, high);
    return turn % 2 ? drawn : special[turn / 2 % count];
}

/* The distribution: its parameters into `head`, the unit of its slopes into draw->alpha. Coprime in number to the kinds of
 * maps. */
enum { GTR, GGX, STD, BECKMANN, SHEEN, PHONG, ELLIPSOID, FAMILIES };
static void draw_family(int family, uint64_t turn, mu_stream *random, mu_draw *draw, char *head,
                        size_t size) {
    static const double gtr[] = {1.7, 0, 1, 3, 4, 2, 1 - 1e-7, 1 + 1e-7, 10, 1.5},
                        student[] = {2.5, 1.75, 6, 2, 30, 1.9};
    const double alpha = draw->alpha, a = log_uniform(random, 0.5, 2), b = log_uniform(random, 0.5, 2);
    double gamma;
    switch (family) {
    case GTR:
        gamma = special_or(gtr, sizeof gtr / sizeof *gtr, turn, random, 0, 10);
        append(head, size, "\"gtr\", \"alpha\": %.17g, \"gamma\": %.17g", alpha, gamma);
        draw->spread = -log(alpha); /* GTR has the scales alpha and 1 */
        break;
    case STD: /* beyond slope s lies s^(3 - 2 gamma) of the projected area: below e^-32 */
        gamma = special_or(student, sizeof student / sizeof *student, turn, random, 1.7, 8);
        append(head, size, "\"std\", \"alpha\": %.17g, \"gamma\": %.17g", alpha, gamma);
        draw->spread = fmax(0, 32 / (2 * gamma - 3) - 30);
        break;
    case SHEEN:
        draw->alpha = log_uniform(random, 0.05, 1);
        append(head, size, "\"sheen\", \"alpha\": %.17g", draw->alpha);
        break;
    case PHONG:
        gamma = turn % 4 == 1 ? 0 : log_uniform(random, 1, 1e4);
        append(head, size, "\"phong\", \"exponent\": %.17g", gamma);
        draw->alpha = sqrt(2 / (gamma + 2));
        break;
    case ELLIPSOID:
        append(
            head, size,
            "\"ellipsoid\", \"alpha_x\": %.17g, \"alpha_y\": %.17g, \"theta_x\": %.17g, \"theta_y\": %.17g, "
            "\"theta_z\": %.17g",
            alpha * a, alpha * b, mu_stream_between(random, -2, 2) * fmin(alpha, .3),
            mu_stream_between(random, -2, 2) * fmin(alpha, .3), mu_stream_between(random, 0, 2 * PI));
        draw->found = 1;
        break;
    default:
        append(head, size, "\"%s\", \"alpha\": %.17g", family == GGX ? "ggx" : "beckmann", alpha);
    }
}

/* What is done to an isotropic microsurface before "transform": into `shape`, draw->m and draw->tilt. */
static void draw_shape(uint64_t index, mu_stream *random, mu_draw *draw, char *shape, size_t size) {
    const double x = draw->alpha * log_uniform(random, 0.3, 3), y = draw->alpha * log_uniform(random, 0.3, 3),
                 turn = mu_stream_between(random, -PI, PI), azimuth = mu_stream_between(random, 0, 2 * PI),
                 lean = draw->alpha * log_uniform(random, 0.2, 3);
    if (index % 4 == 3) { /* Eq. (29), turned */
        append(shape, size, ", \"alpha_x\": %.17g, \"alpha_y\": %.17g, \"rotation\": %.17g", x, y, turn);
        double left[4], right[4];
        const double diagonal[4] = {draw->alpha / x, 0, 0, draw->alpha / y};
        rotation(turn, left), rotation(-turn, right);
        product(draw->m, left, draw->m);
        product(draw->m, diagonal, draw->m);
        product(draw->m, right, draw->m);
    }
    if (index % 5 == 2 || index % 5 == 4) {
        draw->tilt[0] = lean * cos(azimuth), draw->tilt[1] = lean * sin(azimuth);
        append(shape, size, ", \"tilt\": [%.17g, %.17g]", draw->tilt[0], draw->tilt[1]);
    }
}

/* What light makes of it: F, and the choices that leave the microsurface alone. */
static void draw_rest(uint64_t index, mu_stream *random, const musurf_material_type *type, char *tail,
                      size_t size) {
    static const char *const forms[] = {NULL, "separable", "direction_correlated"};
    const double nine = mu_stream_between(random, 0.08, 0.9), r = mu_stream_uniform(random),
                 g = mu_stream_uniform(random), b = mu_stream_uniform(random);
    if (forms[index % 3]) append(tail, size, ", \"masking\": \"%s\"", forms[index % 3]);
    if (index % 4 == 2) { /* n of 0.41 to 0.92 and 1.08 to 2.5 */
        append(tail, size, ", \"fresnel\": {\"dielectric\": %.17g}, \"transmission\": true",
               exp(index % 8 == 2 ? nine : -nine));
        return;
    }
    if (index % 5 == 3) /* coloured, so that channels cannot be mixed up */
        append(tail, size, ", \"fresnel\": {\"schlick\": [%.3f, %.3f, %.3f]}", r, g, b);
    const char *sampler = index % 5 == 0   ? choice_of_sampler(type, index / 5)
                          : index % 5 == 3 ? choice_of_sampler(type, index / 5 + 2)
                                           : NULL;
    if (sampler) append(tail, size, ", \"sampler\": \"%s\"", sampler);
}

mu_draw mu_draw_material(uint64_t seed, uint64_t index, const musurf_material_type *type) {
    mu_stream random = mu_stream_make(seed, index << 8);
    mu_draw draw = {.alpha = index % 17 == 5 ? 1 : log_uniform(&random, 1e-3, 1)};
    const int family = (int)(index % FAMILIES);
    const map_kind kind = (map_kind)(index % MAP_KINDS);
    char head[512], shape[256] = "", tail[256] = "";
    double transform[4], turn[4], turned[4];
    snprintf(head, sizeof head, "\"material\": \"%s\", \"ndf\": ", type->id);
    draw_family(family, index / FAMILIES, &random, &draw, head, sizeof head);
    draw_map(kind, &random, transform);
    memcpy(draw.m, transform, sizeof transform);
    if (family != ELLIPSOID) draw_shape(index, &random, &draw, shape, sizeof shape);
    draw_rest(index, &random, type, tail, sizeof tail);
    draw.angle = mu_stream_between(&random, 0, 2 * PI);
    rotation(draw.angle, turn);
    product(turn, transform, turned);
    print(draw.json, sizeof draw.json, head, shape, kind == MAP_NONE ? NULL : transform, tail);
    print(draw.original, sizeof draw.original, head, "", NULL, tail);
    print(draw.turned, sizeof draw.turned, head, shape, turned, tail);
    draw.classic = family == GGX && !shape[0] && (kind == MAP_STRETCH || kind == MAP_NONE);
    draw.beyond_float = kind == MAP_HUGE || kind == MAP_TINY;
    return draw;
}

void mu_draw_view(uint64_t index, int k, mu_stream *random, double view[3]) {
    const double degree = PI / 180;
    double theta = mu_stream_between(random, 0, 60) * degree;
    const double phi = mu_stream_between(random, 0, 2 * PI);
    if (k == 0 && index % 6 == 0) theta = 0;
    if (k == 1) theta = mu_stream_between(random, 60, 85) * degree;
    if (k == 2) theta = (index % 2 ? mu_stream_between(random, 85, 89.5) : 89.5) * degree;
    view[0] = sin(theta) * cos(phi);
    view[1] = sin(theta) * sin(phi);
    view[2] = cos(theta);
}
