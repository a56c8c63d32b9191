/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_fit_files.c: a material as a file, and slopes as a table in one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/output.h"
#include "core/render/surface_fit.h"

enum { BINS = 128, LEFT_OUT = 1000 };

_Bool mu_surface_fit_save(const char *file, mu_json *json, mu_error *error) {
    mu_output output;
    if (json->no_memory) return mu_fail(error, "%s: not enough memory", file);
    if (!mu_output_open(&output, file, error)) return 0;
    mu_output_write(&output, json->text, json->length, 0);
    mu_output_write(&output, "}\n", 2, json->length);
    return mu_output_commit(&output, error);
}

static int rising(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Half of a thousandth of a sample lies beyond either pair of bounds; a hundredth of the extent is added. */
static void bounds_of(const double *sample, uint32_t count, double *room, double bounds[4]) {
    for (uint32_t axis = 0; axis < 2; axis++) {
        for (uint32_t k = 0; k < count; k++) room[k] = sample[2 * k + axis];
        qsort(room, count, sizeof *room, rising);
        const double low = room[count / (4 * LEFT_OUT)], high = room[count - 1 - count / (4 * LEFT_OUT)];
        const double wider = fmax(0.01 * (high - low), 1e-6 * fmax(1, fabs(high)));
        bounds[2 * axis] = low - wider, bounds[2 * axis + 1] = high + wider;
    }
}

/* {"bounds": [...], "weights": [[...], ...]}: whole numbers, so few characters. */
static void put_table(mu_json *json, const double *bounds, const double *weights) {
    const size_t room = 200 + (size_t)BINS * BINS * 24;
    char *text = malloc(room);
    if (!text) {
        json->no_memory = 1;
        return;
    }
    size_t at = (size_t)snprintf(text, room, "{\"bounds\": [%.17g, %.17g, %.17g, %.17g], \"weights\": [",
                                 bounds[0], bounds[1], bounds[2], bounds[3]);
    for (int k = 0; k < BINS * BINS; k++)
        at += (size_t)snprintf(text + at, room - at, "%s%.17g%s",
                               k % BINS ? ", "
                               : k      ? ", ["
                                        : "[",
                               weights[k], k % BINS == BINS - 1 ? "]" : "");
    at += (size_t)snprintf(text + at, room - at, "]}");
    mu_json_raw(json, "histogram", text, at);
    free(text);
}

_Bool mu_surface_fit_tabulate(const mu_slopes *s, mu_json *json, double *outside) {
    const uint32_t side = mu_slopes_side(s);
    double *sample = malloc((size_t)2 * MU_SAMPLE * sizeof *sample), *room = malloc(MU_SAMPLE * sizeof *room);
    double *weights = calloc((size_t)BINS * BINS, sizeof *weights), bounds[4], missed = 0;
    const _Bool good = sample && room && weights;
    if (good) {
        bounds_of(sample, mu_cloud_sample(s, sample), room, bounds);
        for (uint32_t i = 0; i < side; i++)
            for (uint32_t j = 0; j < side; j++)
                for (int upper = 0; upper < 2; upper++) {
                    double v[2];
                    mu_slope_at(s, i, j, upper, v);
                    const double x = BINS * (v[0] - bounds[0]) / (bounds[1] - bounds[0]);
                    const double y = BINS * (v[1] - bounds[2]) / (bounds[3] - bounds[2]);
                    if (x >= 0 && x < BINS && y >= 0 && y < BINS)
                        weights[(size_t)y * BINS + (size_t)x]++;
                    else
                        missed++;
                }
        *outside = missed / (2.0 * side * side);
        mu_json_begin(json);
        mu_json_string(json, "material", "musurf.microfacet");
        mu_json_string(json, "ndf", "tabulated");
        put_table(json, bounds, weights);
    }
    free(sample);
    free(room);
    free(weights);
    return good;
}
