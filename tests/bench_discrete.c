/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_discrete.c: what an evaluation of discrete_ggx costs by the number of flakes in the footprint, through the plugin,
 * processor time, in microseconds: setup with the footprint of a hit, then one eval. Half-vectors are drawn by the visible
 * normals, as a path meets them. The counts are means over 2000 footprints and directions.
 */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "tests/abi_host.h"

enum { HITS = 2000, ROUNDS = 5 };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static float slots[HITS][6], wo[HITS][3], wi[HITS][3];

/* Microseconds of the fastest round. */
static double time_of(const musurf_material_type *type, const musurf_material *material) {
    _Alignas(64) static unsigned char closure[512];
    double best = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
        const double start = now();
        for (int i = 0; i < HITS; i++) {
            musurf_value value;
            if (!type->setup(material, wo[i], slots[i], 0, closure)) continue;
            type->eval(closure, wi[i], MUSURF_ALL_LOBES, &value);
        }
        best = fmin(best, (now() - start) / HITS * 1e6);
    }
    return best;
}

/* Directions that D of alpha 0.3 makes likely. */
static void draw(const musurf_material_type *type) {
    _Alignas(64) unsigned char closure[512];
    musurf_material *smooth = abi_material(type, NULL, "ndf=ggx alpha=0.3");
    for (uint32_t i = 0, n = 0; i < HITS; n++) {
        musurf_sample sample;
        float u[3];
        abi_direction(n, wo[i]), abi_uniforms(n + 5000, u);
        if (!type->setup(smooth, wo[i], NULL, 0, closure)) continue;
        type->sample(closure, u, MUSURF_ALL_LOBES, &sample);
        if (!sample.lobe) continue;
        for (int k = 0; k < 3; k++) wi[i][k] = sample.wi[k];
        i++;
    }
    type->release(smooth);
}

int main(void) {
    const musurf_material_type *type = abi_type(1);
    static const char *const words[] = {
        "ndf=discrete_ggx alpha=0.3 flakes.density=1e6 flakes.cone=0.01 footprint=@0",
        "ndf=discrete_ggx alpha=0.3 flakes.density=1e6 flakes.cone=0.03 footprint=@0",
        "ndf=discrete_ggx alpha=0.3 flakes.density=1e6 flakes.cone=0.1 footprint=@0"};
    static const double cones[] = {0.01, 0.03, 0.1};
    draw(type);
    printf("setup and eval of discrete_ggx, alpha 0.3, in microseconds of the processor\n");
    printf("%-24s %10s %10s %10s\n%-24s", "flakes in the footprint", "cone", "cone", "cone", "");
    for (int m = 0; m < 3; m++) printf(" %10g", cones[m]);
    printf("\n");
    for (double flakes = 1; flakes < 1e9; flakes *= 10) {
        const float half = (float)(sqrt(flakes / 1e6) / 2);
        for (uint32_t i = 0; i < HITS; i++) {
            float u[3];
            abi_uniforms(i, u);
            const float c = half * cosf(6.2831853f * u[2]), s = half * sinf(6.2831853f * u[2]);
            const float footprint[6] = {10 * u[0], 10 * u[1], c, s, -s, c};
            for (int k = 0; k < 6; k++) slots[i][k] = footprint[k];
        }
        printf("%-24g", flakes);
        for (int m = 0; m < 3; m++) {
            musurf_material *material = abi_material(type, NULL, words[m]);
            printf(" %10.2f", time_of(type, material));
            type->release(material);
        }
        printf("\n");
    }
    return 0;
}
