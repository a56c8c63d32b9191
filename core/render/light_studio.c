/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * light_studio.c: a photographer's studio without any file: soft boxes and strips before a smooth dark room.
 *
 * Metal shows what it reflects: broad boxes give it body, narrow bright strips the crisp lines that
 * anisotropy stretches, and the dark between them its contrast. Each box is a rectangle in the plane tangent
 * to the unit sphere at its middle (gnomonic), with edges that fade smoothly, a little brighter inside, as
 * real ones are. Scaled so that a white plate lying in it comes out just short of white. Radiance, +z up,
 * azimuths counter-clockwise from +x; positive everywhere.
 */
#include "core/render/light_parts.h"

#include <string.h>

/* Of the plane at distance 1: half extents along azimuth and elevation, and the width of the fading edge. */
typedef struct mu_soft_box {
    mu_vec3 middle, right, up; /* orthonormal: right is towards rising azimuth */
    float half[2], edge;
    float least; /* cosine to the middle, below that of the farthest corner */
    float radiance[3];
} mu_soft_box;

/* middle = (cos e cos a, cos e sin a, sin e), right = (-sin a, cos a, 0), up = middle x right. */
static const mu_soft_box boxes[] = {
    /* key: large, warm, a = 50 degrees, e = 48 degrees */
    {{0.43010886f, 0.51258378f, 0.74314483f},
     {-0.76604444f, 0.64278761f, 0},
     {-0.47768429f, -0.56928196f, 0.66913061f},
     {0.50f, 0.32f},
     0.10f,
     0.80f,
     {3.0f, 2.87f, 2.67f}},
    /* fill: wide, dim, cool, a = 165, e = 22 */
    {{-0.89559083f, 0.23997284f, 0.37460659f},
     {-0.25881905f, -0.96592583f, 0},
     {0.36184218f, -0.09695532f, 0.92718385f},
     {0.55f, 0.38f},
     0.18f,
     0.73f,
     {0.5f, 0.57f, 0.67f}},
    /* strip: tall, narrow and bright, a = -70, e = 25 */
    {{0.30997552f, -0.85165074f, 0.42261826f},
     {0.93969262f, 0.34202014f, 0},
     {-0.14454396f, 0.39713126f, 0.90630779f},
     {0.09f, 0.75f},
     0.05f,
     0.77f,
     {5.0f, 5.0f, 5.2f}},
    /* second strip, behind, a = -125, e = 35 */
    {{-0.46984631f, -0.67101007f, 0.57357644f},
     {0.81915204f, -0.57357644f, 0},
     {0.32898993f, 0.46984631f, 0.81915204f},
     {0.06f, 0.60f},
     0.04f,
     0.83f,
     {3.6f, 3.45f, 3.25f}},
    /* overhead: broad, a = 0, e = 85 */
    {{0.08715574f, 0, 0.99619470f},
     {0, 1, 0},
     {-0.99619470f, 0, 0.08715574f},
     {0.45f, 0.28f},
     0.15f,
     0.80f,
     {1.2f, 1.23f, 1.3f}},
};

/* 0 below -width, 1 above 0, with continuous slope. */
static float fade(float inside, float width) {
    const float t = fminf(fmaxf(1 + inside / width, 0), 1);
    return t * t * (3 - 2 * t);
}

void mu_studio_radiance(mu_vec3 direction, float radiance[3]) {
    static const float floor_colour[3] = {0.03f, 0.028f, 0.026f}, horizon[3] = {0.16f, 0.165f, 0.175f},
                       ceiling[3] = {0.05f, 0.055f, 0.065f};
    /* A glow along the horizon, falling off faster into the floor, continuous with its slope at z = 0. */
    const float z = direction.z, glow = z < 0 ? expf(-24 * z * z) : expf(-5 * z * z);
    for (int c = 0; c < 3; c++) {
        const float far = z < 0 ? floor_colour[c] : ceiling[c];
        radiance[c] = far + (horizon[c] - far) * glow;
    }
    for (const mu_soft_box *box = boxes; box < boxes + sizeof boxes / sizeof boxes[0]; box++) {
        const float ahead = mu_dot(direction, box->middle);
        if (ahead <= box->least) continue;
        const float x = mu_dot(direction, box->right) / ahead, y = mu_dot(direction, box->up) / ahead;
        const float cover =
            fade(box->half[0] - fabsf(x), box->edge) * fade(box->half[1] - fabsf(y), box->edge);
        const float falloff =
            1 - 0.35f *
                    fminf(x * x / (box->half[0] * box->half[0]) + y * y / (box->half[1] * box->half[1]), 2) /
                    2;
        for (int c = 0; c < 3; c++) radiance[c] += cover * falloff * box->radiance[c];
    }
}

/* 2 x 2 points in each cell: the table only guides the drawing, and every start pays for it. */
void mu_studio_means(const float scale[3], float *luminance) {
    enum { FINE = 2, COLUMNS = MU_STUDIO_WIDTH * FINE, ROWS = MU_STUDIO_HEIGHT * FINE };
    float across[COLUMNS][2];
    for (int i = 0; i < COLUMNS; i++) {
        const float phi = MU_PI_F * (1 - 2 * ((float)i + 0.5f) / COLUMNS);
        across[i][0] = cosf(phi);
        across[i][1] = sinf(phi);
    }
    memset(luminance, 0, sizeof *luminance * MU_STUDIO_WIDTH * MU_STUDIO_HEIGHT);
    for (int j = 0; j < ROWS; j++) {
        const float theta = MU_PI_F * ((float)j + 0.5f) / ROWS, sine = sinf(theta), cosine = cosf(theta);
        for (int i = 0; i < COLUMNS; i++) {
            float rgb[3];
            mu_studio_radiance(mu_v3(sine * across[i][0], sine * across[i][1], cosine), rgb);
            for (int c = 0; c < 3; c++) rgb[c] *= scale[c];
            luminance[j / FINE * MU_STUDIO_WIDTH + i / FINE] += mu_luminance(rgb) / (FINE * FINE);
        }
    }
}
