/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * cube.c: a cube map as a latitude-longitude image (prefilter.h). Six faces one below the other, as OpenEXR has them
 * (ImfEnvmap.h): +x, -x, +y, -y, +z, -z of a frame whose y is up and whose z is the middle of its latitude-longitude images;
 * here those are z and x, and its x is y. The outermost pixels stand on the edges of a face, so that faces share them.
 */
#include "core/ibl/prefilter.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

enum { FINE = 3 }; /* places along each side of a pixel of the result */

/* Where a face's middle, its right and its lower edge are: axes of the frame here, and their sign. */
static const struct {
    int axis[3];
    float sign[3];
} faces[6] = {{{1, 0, 2}, {1, 1, -1}}, {{1, 0, 2}, {-1, -1, -1}}, {{2, 1, 0}, {1, 1, -1}},
              {{2, 1, 0}, {-1, 1, 1}}, {{0, 1, 2}, {1, -1, -1}},  {{0, 1, 2}, {-1, 1, -1}}};

static void add_face_lookup(const mu_ibl_image *cube, const float w[3], double rgb[3]) {
    size_t face = 0;
    float most = 0;
    for (size_t f = 0; f < 6; f++) {
        const float along = faces[f].sign[0] * w[faces[f].axis[0]];
        if (along > most) most = along, face = f;
    }
    float place[2];
    size_t low[2];
    const size_t side = cube->width;
    for (int k = 0; k < 2; k++) {
        const float p = faces[face].sign[1 + k] * w[faces[face].axis[1 + k]] / most;
        place[k] = larger(0, smaller((p + 1) / 2 * (float)(side - 1), (float)(side - 1)));
        low[k] = (size_t)place[k] + 1 < side ? (size_t)place[k] : side - 2;
        place[k] -= (float)low[k];
    }
    const float *a = cube->rgb + 3 * ((face * side + low[1]) * side + low[0]), *b = a + 3 * side;
    const float s = place[0], t = place[1];
    for (int n = 0; n < 3; n++)
        rgb[n] += (double)((1 - t) * ((1 - s) * a[n] + s * a[3 + n]) + t * ((1 - s) * b[n] + s * b[3 + n]));
}

void mu_ibl_from_cube(const mu_ibl_image *cube, mu_ibl_image *to) {
    for (size_t j = 0; j < to->height; j++)
        for (size_t i = 0; i < to->width; i++) {
            double rgb[3] = {0, 0, 0};
            for (size_t k = 0; k < FINE * FINE; k++) {
                const double y = (double)j + ((double)(k / FINE) + 0.5) / FINE,
                             x = (double)i + ((double)(k % FINE) + 0.5) / FINE;
                const double theta = PI * y / (double)to->height,
                             phi = 2 * PI * (0.5 - x / (double)to->width);
                const float w[3] = {(float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                                    (float)cos(theta)};
                add_face_lookup(cube, w, rgb);
            }
            for (size_t n = 0; n < 3; n++)
                to->rgb[3 * (j * to->width + i) + n] = (float)(rgb[n] / (FINE * FINE));
        }
}

#endif
