/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ibl_prefilter.c: reads, filters (core/ibl/prefilter.h), writes.
 *
 * Level l of N_c is filtered for alpha_lin = l / (N_c - 1), alpha = alpha_lin² (Eq. (3)), and half the size of the one before, as
 * mip maps are. A chain to 1 x 1 would leave no direction in the roughest: N_c counts the levels down to 8 rows or so, and the
 * smaller ones, which a mip map must have, are as rough as the last. The output is its own cache: an attribute says of what
 * bytes and settings it was made.
 */
#include "core/render/ibl_prefilter.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/ibl/prefilter.h"
#include "core/render/exr_write.h"
#include "core/render/image_read.h"
#include "core/render/scene_digest.h"
#include "core/render/surface_rows.h"

enum { LEAST_ROWS = 8 };

/* Some thousand times the sun's radiance; beyond is a broken file (light_environment.c). */
#define BRIGHTEST 1e12f

uint32_t mu_prefilter_levels(uint32_t height) {
    uint32_t levels = 2;
    while (height >> levels >= LEAST_ROWS) levels++;
    return levels;
}

typedef struct level_job {
    const mu_prefilter *job;
    const mu_ibl_pyramid *from;
    mu_ibl_image *to;
    const mu_ibl_tap *tap;
    size_t taps, before, all; /* pixels done before this level, and in all levels */
    atomic_size_t rows;
} level_job;

static void filter_row(void *context, uint32_t row) {
    level_job *j = context;
    mu_ibl_filter_row(j->from, j->taps, j->tap, row, j->to);
    const size_t rows = atomic_fetch_add(&j->rows, 1) + 1;
    if (j->job->progress && rows % 8 == 0)
        j->job->progress(j->job->context, (double)(j->before + rows * j->to->width) / (double)j->all);
}

/* Returns how many pixels were no radiance, and are now 0 or the limit. */
static size_t clean(const mu_ibl_image *image) {
    size_t changed = 0;
    for (size_t i = 0; i < 3 * image->width * image->height; i++) {
        float *c = image->rgb + i;
        if (*c >= 0 && *c <= BRIGHTEST) continue;
        *c = *c > BRIGHTEST ? BRIGHTEST : 0;
        changed++;
    }
    return changed;
}

static _Bool filter_levels(const mu_prefilter *job, const mu_ibl_pyramid *from, mu_ibl_pyramid *to,
                           mu_error *error) {
    mu_ibl_tap *const taps = malloc(job->samples * sizeof *taps);
    if (!taps) return mu_fail(error, "not enough memory");
    const uint32_t rough = mu_prefilter_levels((uint32_t)from->level[0].height);
    level_job j = {.job = job, .from = from, .tap = taps};
    for (size_t l = 1; l < to->levels; l++) j.all += to->level[l].width * to->level[l].height;
    for (size_t i = 0; i < 3 * from->level[0].width * from->level[0].height; i++)
        to->level[0].rgb[i] = from->level[0].rgb[i];
    for (size_t l = 1; l < to->levels; l++) {
        const double linear = fmin((double)l / (rough - 1), 1);
        j.to = &to->level[l];
        j.taps =
            mu_ibl_taps((float)(linear * linear), job->samples, from->level[0].height, from->levels, taps);
        atomic_store(&j.rows, 0);
        mu_rows((uint32_t)j.to->height, job->threads, filter_row, &j);
        j.before += j.to->width * j.to->height;
    }
    free(taps);
    return 1;
}

typedef struct head {
    char key[96];
    const mu_prefilter *job;
    uint32_t levels;
} head;

static exr_result_t put_head(exr_context_t exr, const void *context) {
    const head *h = context;
    exr_result_t code = mu_exr_put_text(exr, "software", "musurf " MUSURF_VERSION);
    code = code ? code : mu_exr_put_text(exr, "musurfKey", h->key);
    code = code ? code : exr_attr_set_int(exr, 0, "musurfLevels", (int32_t)h->levels);
    return code ? code : exr_attr_set_int(exr, 0, "musurfSamples", (int32_t)h->job->samples);
}

static _Bool write_levels(const mu_prefilter *job, const head *h, const mu_ibl_pyramid *levels,
                          mu_error *error) {
    const float *pixels[MU_IBL_LEVELS_MOST];
    for (size_t l = 0; l < levels->levels; l++) pixels[l] = levels->level[l].rgb;
    const mu_exr_mip mip = {.part = "environment",
                            .width = (uint32_t)levels->level[0].width,
                            .height = (uint32_t)levels->level[0].height,
                            .levels = (uint32_t)levels->levels,
                            .pixels = pixels,
                            .head = put_head,
                            .context = h};
    return mu_exr_write_mip(job->output, &mip, error);
}

static _Bool run(const mu_prefilter *job, head *h, const mu_ibl_image *image, mu_error *error) {
    const size_t height = image->height < job->height ? image->height : job->height, width = 2 * height;
    const size_t floats = mu_ibl_pyramid_floats(width, height);
    float *const memory = malloc(2 * floats * sizeof *memory);
    if (!memory) return mu_fail(error, "%s: not enough memory", job->image);
    mu_ibl_pyramid from, to;
    mu_ibl_pyramid_lay(&from, width, height, memory);
    mu_ibl_pyramid_lay(&to, width, height, memory + floats);
    mu_ibl_average(image, &from.level[0]);
    for (size_t l = 1; l < from.levels; l++) mu_ibl_average(&from.level[l - 1], &from.level[l]);
    h->levels = mu_prefilter_levels((uint32_t)height);
    const _Bool good = filter_levels(job, &from, &to, error) && write_levels(job, h, &to, error);
    free(memory);
    return good;
}

/* A cube map becomes a latitude-longitude image whose pixels are half as large as those in the middle of a face. */
static _Bool unfold(mu_ibl_image *image, mu_error *error) {
    const size_t side = image->width;
    mu_ibl_image flat = {6 * side, 3 * side, malloc(3 * 6 * side * 3 * side * sizeof(float))};
    if (!flat.rgb) return mu_fail(error, "not enough memory for a cube map");
    mu_ibl_from_cube(image, &flat);
    free(image->rgb);
    *image = flat;
    return 1;
}

_Bool mu_prefilter_run(const mu_prefilter *job, _Bool *kept, mu_error *error) {
    head h = {.job = job};
    const uint64_t bytes = mu_digest_file(mu_digest_text(0, MUSURF_VERSION), job->image);
    snprintf(h.key, sizeof h.key, "%016llx height %u samples %u", (unsigned long long)bytes, job->height,
             job->samples);
    *kept = mu_exr_has_text(job->output, "musurfKey", h.key);
    if (*kept) return 1;
    int width, height;
    float *const pixels = mu_image_read(job->image, &width, &height, error);
    if (!pixels) return 0;
    mu_ibl_image image = {(size_t)width, (size_t)height, pixels};
    const size_t changed = clean(&image);
    if (changed)
        mu_warn(error, "%s: %zu numbers were negative, not finite or above %g; clamped", job->image, changed,
                (double)BRIGHTEST);
    _Bool good = height >= LEAST_ROWS ||
                 mu_fail(error, "%s: %d rows are too few; %d are needed", job->image, height, LEAST_ROWS);
    if (good && height == 6 * width) good = unfold(&image, error);
    good = good && run(job, &h, &image, error);
    free(image.rgb);
    return good;
}
