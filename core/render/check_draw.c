/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_draw.c: see check_draw.h. */
#include "core/render/check_draw.h"

#include <math.h>
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

static void print(char *text, size_t size, const char *head, const double *m, const char *tail) {
    if (m)
        snprintf(text, size, "{%s, \"transform\": [[%.17g, %.17g], [%.17g, %.17g]]%s}", head, m[0], m[1],
                 m[2], m[3], tail);
    else
        snprintf(text, size, "{%s%s}", head, tail);
}

static double draw_gamma(uint64_t turn, mu_stream *random) {
    static const double special[] = {0, 1, 2, 3, 4, 1.7, 1 - 1e-7, 1 + 1e-7, 10, 1.5};
    enum { COUNT = sizeof special / sizeof *special };
    return turn % 2 ? mu_stream_between(random, 0, 10) : special[turn / 2 % COUNT];
}

mu_draw mu_draw_material(uint64_t seed, uint64_t index, const musurf_material_type *type) {
    static const char *const names[] = {"gtr", "ggx", "gtr", "beckmann"};
    mu_stream random = mu_stream_make(seed, index << 8);
    mu_draw draw = {.alpha = index % 17 == 5 ? 1 : log_uniform(&random, 1e-3, 1)};
    const char *ndf = names[index % 4];
    const map_kind kind = (map_kind)(index % MAP_KINDS);
    char head[320], tail[160] = "";
    draw.gamma = draw_gamma(index / 2, &random);
    draw_map(kind, &random, draw.m);
    snprintf(head, sizeof head, "\"material\": \"%s\", \"ndf\": \"%s\", \"alpha\": %.17g", type->id, ndf,
             draw.alpha);
    if (!strcmp(ndf, "gtr")) {
        const size_t used = strlen(head);
        snprintf(head + used, sizeof head - used, ", \"gamma\": %.17g", draw.gamma);
        draw.spread = -log(draw.alpha); /* GTR has the scales alpha and 1 */
    }
    if (index % 5 == 3) /* coloured, so that channels cannot be mixed up */
        snprintf(tail, sizeof tail, ", \"fresnel\": {\"schlick\": [%.3f, %.3f, %.3f]}",
                 mu_stream_uniform(&random), mu_stream_uniform(&random), mu_stream_uniform(&random));
    const char *sampler = index % 3 == 2 ? choice_of_sampler(type, index / 3) : NULL;
    if (sampler) {
        const size_t used = strlen(tail);
        snprintf(tail + used, sizeof tail - used, ", \"sampler\": \"%s\"", sampler);
    }
    draw.angle = mu_stream_between(&random, 0, 2 * PI);
    double turn[4], turned[4];
    rotation(draw.angle, turn);
    product(turn, draw.m, turned);
    print(draw.json, sizeof draw.json, head, kind == MAP_NONE ? NULL : draw.m, tail);
    print(draw.original, sizeof draw.original, head, NULL, tail);
    print(draw.turned, sizeof draw.turned, head, turned, tail);
    draw.classic = !strcmp(ndf, "ggx") && (kind == MAP_STRETCH || kind == MAP_NONE);
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
