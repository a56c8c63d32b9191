/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * sphere.c: a sphere of the material, seen from afar, row by row.
 *
 * World space: +z up; the viewer stands toward -y, sees x to the right and z upwards. The sphere's tangent points east,
 * along its parallels, as that of the renderer's spheres: brushed around. Light comes from all around (surroundings.h),
 * turned about +z, through the reads of core/ibl; or by random directions of the material's own sampler, whose mean is
 * the truth; or from one parallel lamp, by the exact BRDF.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ibl/lattice.h"
#include "core/ibl/reads.h"
#include "scripts/page/albedo.h"
#include "scripts/page/numbers.h"
#include "scripts/page/surroundings.h"
#include "scripts/page/tone.h"

#define RADIUS 0.88f /* of half the picture */

/* The numbers of a view of it. */
enum { SIZE, TECHNIQUE, TURN, EXPOSURE, LAMP_X, LAMP_Y, LAMP_Z, NUMBERS };
/* After those of core/ibl. */
enum { SAMPLED = MU_IBL_TECHNIQUES, LAMP };

struct page_sphere {
    const page_material *material;
    const page_surroundings *around;
    page_albedo albedo;
    mu_ibl_plan plan;
    int size, technique;
    float turn[2], exposure, lamp[3];
    page_tone tone;
};

/* A point of the sphere: normal, east, north; and toward the viewer in that frame. */
typedef struct spot {
    float n[3], t[3], b[3], wo[3];
} spot;

#define TITLE(name, key, title) title,
const char *page_technique_name(int technique) {
    static const char *const names[] = {
        MU_IBL_FOR_TECHNIQUES(TITLE) /* those of core/ibl come first */
            [SAMPLED] = "sampled",
        [LAMP] = "lamp",
        [LAMP + 1] = NULL,
    };
    return names[technique];
}

page_sphere *page_sphere_new(void) {
    page_sphere *s = calloc(1, sizeof *s);
    if (s) page_tone_make(&s->tone);
    return s;
}

void page_sphere_set(page_sphere *s, const page_material *material, const page_surroundings *around,
                     const double *query, const double *numbers, int samples) {
    const mu_ibl_settings_d settings = page_settings(query);
    s->material = material, s->around = around;
    s->size = (int)numbers[SIZE], s->technique = (int)numbers[TECHNIQUE];
    const mu_ibl_settings_f in_float = {
        (float)settings.k, (float)settings.beta,
        settings.samples < MU_IBL_READS_MOST ? settings.samples : MU_IBL_READS_MOST, settings.shift};
    /* until there are samples, and without light around: the major axis */
    mu_ibl_plan_make(s->technique < SAMPLED ? (mu_ibl_technique)s->technique : MU_IBL_MAJOR_AXIS, &in_float,
                     &s->plan);
    float tail[MU_IBL_TAIL];
    for (size_t i = 0; i < MU_IBL_TAIL; i++)
        tail[i] = (float)mu_ibl_tail_of(&material->definition, mu_ibl_tail_share(i));
    mu_ibl_plan_tail(&s->plan, tail);
    s->turn[0] = (float)cos(numbers[TURN]), s->turn[1] = (float)sin(numbers[TURN]);
    s->exposure = (float)numbers[EXPOSURE];
    for (int k = 0; k < 3; k++) s->lamp[k] = (float)numbers[LAMP_X + k];
    if (samples) page_albedo_make(&s->albedo, material, samples);
}

/* Into the frame of the surroundings, which were turned. */
static inline void turn_back(const page_sphere *s, const float w[3], float out[3]) {
    out[0] = s->turn[0] * w[0] + s->turn[1] * w[1];
    out[1] = s->turn[0] * w[1] - s->turn[1] * w[0];
    out[2] = w[2];
}

static inline void to_world(const spot *p, const float w[3], float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = w[0] * p->t[k] + w[1] * p->b[k] + w[2] * p->n[k];
}

/* At x, y of the unit disc, and at -x, -y. */
static inline void spots_at(float x, float y, spot both[2]) {
    const float square = x * x + y * y;
    if (square > 0.9999f) x *= 0.99995f / sqrtf(square), y *= 0.99995f / sqrtf(square);
    const float front = sqrtf(1 - x * x - y * y), flat = sqrtf(x * x + front * front), inverse = 1 / flat;
    const float cosine = front * inverse, sine = x * inverse;
    both[0] =
        (spot){{x, -front, y}, {cosine, sine, 0}, {-y * sine, y * cosine, flat}, {-sine, -y * cosine, front}};
    both[1] = (spot){
        {-x, -front, -y}, {cosine, -sine, 0}, {-y * sine, -y * cosine, flat}, {sine, y * cosine, front}};
}

/* Reads in the frame of `p`, times `turned` along the surface: +1, or -1 for the opposite spot. */
static void look(const page_sphere *s, const spot *p, const mu_ibl_view *reads, float turned,
                 const float albedo[4], float rgb[4]) {
    mu_ibl_batch batch;
    float x[3], y[3], z[3]; /* the frame's axes there */
    const float last = (float)(s->around->globe.levels - 1);
    const size_t count = batch.count = reads->count;
    turn_back(s, p->t, x), turn_back(s, p->b, y), turn_back(s, p->n, z);
    for (int k = 0; k < 3; k++) x[k] *= turned, y[k] *= turned;
    for (size_t i = 0; i < count; i++) {
        const float dx = reads->x[i], dy = reads->y[i], dz = reads->z[i];
        batch.x[i] = dx * x[0] + dy * y[0] + dz * z[0];
        batch.y[i] = dx * x[1] + dy * y[1] + dz * z[1];
        batch.z[i] = dx * x[2] + dy * y[2] + dz * z[2];
        batch.level[i] = reads->roughness[i] * last, batch.weight[i] = reads->weight[i];
    }
    mu_ibl_globe_sum(&s->around->globe, &batch, rgb);
    for (int k = 0; k < 4; k++) rgb[k] *= albedo[k];
}

/* Pairs of opposite spots: seen in their frames the view is turned by half about the normal, and so are, of a lobe that
 * half a turn leaves as it is, the reads. */
static void by_reads(const page_sphere *s, size_t pairs, spot (*both)[2], float (*rgb)[2][4]) {
    mu_ibl_view reads[MU_IBL_AXES];
    float wo[3][MU_IBL_AXES], albedo[MU_IBL_AXES][4];
    for (size_t i = 0; i < MU_IBL_AXES; i++)
        for (int k = 0; k < 3; k++) wo[k][i] = both[i < pairs ? i : 0][0].wo[k];
    mu_ibl_reads_of_views(&s->plan, &s->material->lobe, pairs, wo, reads);
    page_albedo_at(&s->albedo, &s->material->lobe, wo, albedo);
    for (size_t i = 0; i < pairs; i++)
        for (int k = 0; k < 2; k++) look(s, &both[i][k], &reads[i], k ? -1 : 1, albedo[i], rgb[i][k]);
}

static void by_lamp(const page_sphere *s, const spot *p, float rgb[4]) {
    mu_closure_f c;
    mu_value_f value;
    float wi[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        wi[0] += s->lamp[k] * p->t[k], wi[1] += s->lamp[k] * p->b[k], wi[2] += s->lamp[k] * p->n[k];
    if (!(wi[2] > 0) || !mu_bind_f(s->material->shaded, p->wo, NULL, &c)) return;
    mu_eval_f(&c, wi, &value);
    for (int k = 0; k < 3; k++) rgb[k] = 3.14159265f * value.f[k] * wi[2];
}

/* Uniform in [0, 1), of pixel and pass: a lattice, shifted by a hash (Wellons' lowbias32). */
static void numbers_of(uint32_t pixel, uint32_t pass, float u[3]) {
    double shift[3], place[3];
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t h = pixel * 3 + k;
        h = (h ^ h >> 16) * 0x7feb352du, h = (h ^ h >> 15) * 0x846ca68bu, h ^= h >> 16;
        shift[k] = h * 0x1p-32;
    }
    mu_ibl_lattice(shift, pass + 1, place);
    for (int k = 0; k < 3; k++) u[k] = (float)place[k];
}

static void by_sampling(const page_sphere *s, const spot *p, uint32_t pixel, uint32_t pass, float rgb[4]) {
    mu_closure_f c;
    mu_sample_f sample;
    float u[3], world[3], w[3];
    if (!mu_bind_f(s->material->shaded, p->wo, NULL, &c)) return;
    numbers_of(pixel, pass, u);
    mu_sample_wi_f(&c, u, &sample);
    if (sample.rejected) return;
    to_world(p, sample.wi, world);
    turn_back(s, world, w);
    mu_ibl_globe_add(&s->around->globe, w, 0, 1, rgb);
    for (int k = 0; k < 3; k++) rgb[k] *= sample.weight[k];
}

/* Pixels of a row that are worked out together, and their opposites. */
typedef struct span {
    size_t count;
    int column[MU_IBL_AXES];
    float cover[MU_IBL_AXES]; /* of the pixel by the sphere */
    spot both[MU_IBL_AXES][2];
    float front[MU_IBL_AXES][2][4];
} span;

static void shade(const page_sphere *s, int row, int pass, int sampled, span *p) {
    if (s->technique < SAMPLED || (s->technique == SAMPLED && !sampled)) {
        by_reads(s, p->count, p->both, p->front);
        return;
    }
    for (size_t i = 0; i < p->count; i++) {
        const int pixel[2] = {row * s->size + p->column[i], (s->size - row) * s->size - 1 - p->column[i]};
        for (int k = 0; k < 2; k++)
            if (s->technique == LAMP)
                by_lamp(s, &p->both[i][k], p->front[i][k]);
            else
                by_sampling(s, &p->both[i][k], (uint32_t)pixel[k], (uint32_t)pass, p->front[i][k]);
    }
}

/* `last`: the last pixel of both rows. */
static void put_bytes(const page_sphere *s, const span *p, int last, uint32_t *rgba) {
    int place[MU_IBL_AXES][2][4];
    page_tone_places(s->exposure, sizeof place / sizeof(int), p->front[0][0], place[0][0]);
    for (size_t i = 0; i < p->count; i++) {
        rgba[p->column[i]] = page_tone_bytes(&s->tone, place[i][0], p->cover[i]);
        rgba[last - p->column[i]] = page_tone_bytes(&s->tone, place[i][1], p->cover[i]);
    }
}

static void put_linear(const span *p, int last, float *linear) {
    for (size_t i = 0; i < p->count; i++) {
        memcpy(linear + 3 * p->column[i], p->front[i][0], 3 * sizeof(float));
        memcpy(linear + 3 * (last - p->column[i]), p->front[i][1], 3 * sizeof(float));
    }
}

static void add_up(span *p, int last, int pass, float *sums) {
    for (size_t i = 0; i < p->count; i++)
        for (int side = 0; side < 2; side++) {
            float *const sum = sums + 3 * (side ? last - p->column[i] : p->column[i]), *const radiance =
                                                                                           p->front[i][side];
            for (int k = 0; k < 3; k++) radiance[k] = (sum[k] += radiance[k]) / (float)(pass + 1);
        }
}

void page_sphere_rows(const page_sphere *s, int row, int pass, float *sums, float *linear, uint32_t *rgba) {
    const float half = (float)s->size / 2, y = (half - ((float)row + 0.5f)) / half;
    const int last = 2 * s->size - 1; /* of both rows */
    for (int column = 0; column < s->size;) {
        span p = {.count = 0};
        for (; column < s->size && p.count < MU_IBL_AXES; column++) {
            const float x = (((float)column + 0.5f) - half) / half,
                        inside = half * (RADIUS - sqrtf(x * x + y * y));
            if (inside > -0.5f) {
                p.column[p.count] = column, p.cover[p.count] = inside < 0.5f ? inside + 0.5f : 1;
                spots_at(x / RADIUS, y / RADIUS, p.both[p.count++]);
                continue;
            }
            if (linear)
                memset(linear + 3 * column, 0, 3 * sizeof(float)),
                    memset(linear + 3 * (last - column), 0, 3 * sizeof(float));
            else
                rgba[column] = rgba[last - column] = 0;
        }
        if (!p.count) continue;
        shade(s, row, pass, sums != NULL, &p);
        if (s->technique == SAMPLED && sums) add_up(&p, last, pass, sums);
        if (linear)
            put_linear(&p, last, linear);
        else
            put_bytes(s, &p, last, rgba);
    }
}

void page_backdrop(const page_sphere *s, int size, uint32_t *rgba) {
    const float last = (float)(s->around->globe.levels - 1), bright = s->technique == LAMP ? 0 : 1;
    for (int i = 0; i < size * size; i++) {
        const float x = (2 * (float)(i % size) + 1) / (float)size - 1,
                    z = 1 - (2 * (float)(i / size) + 1) / (float)size;
        const float world[3] = {x, 1.6f, z};
        float w[3], rgb[4] = {0, 0, 0, 0};
        int place[3];
        turn_back(s, world, w);
        mu_ibl_globe_add(&s->around->globe, w, 0.4f * last, bright, rgb);
        page_tone_places(s->exposure, 3, rgb, place);
        rgba[i] = page_tone_bytes(&s->tone, place, 1);
    }
}
