/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * smith.h: Smith's masking of isotropic distributions that have no closed form: by quadrature in double, and by a table
 * of the material in float.
 */
#ifndef MU_SMITH_H
#define MU_SMITH_H

#include <stdint.h>
#include <string.h>

#include "core/bsdf/real.h"

/* Q(x): the part of the projected area whose squared slope exceeds x. */
typedef double (*mu_survival)(const void *shape, double x);

/* z Lambda at slope tan = r/z, to about `digits` decimal digits (3 to 32; shading takes 9 and 16); smith.c. Q must be
 * negligible nowhere below x = e^(2 end) alone. */
double mu_smith_z_lambda(mu_survival Q, const void *shape, double end, double r, double z, int digits);
/* The trapezoid rule's step for so many digits. */
double mu_smith_step(int digits);

/* The table: a smooth function phi of v = tan²(theta/2) in [0, 1], in slope units of the material (v = 1: the horizon),
 * by polynomials over half octaves of v, and one more piece from 0 to 2^-octaves; smith_table.c. */
enum { SMITH_CELL = 8, SMITH_OCTAVES_MAX = 66 };
typedef double (*mu_smith_phi)(const void *shape, double v);
/* So many octaves that the piece at 0 ends at a quarter of the distance to a singularity at v = -unit²/4. */
int mu_smith_octaves(double unit);
size_t mu_smith_table_bytes(int octaves);
void mu_smith_table_build(float *table, int octaves, mu_smith_phi phi, const void *shape);

/* phi(v); `to_first` is 2^octaves. */
static inline float smith_table_at(const float *table, int32_t octaves, float to_first, float v) {
    v = v < 0x0.ffffffp0f ? v : 0x0.ffffffp0f;
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    const int32_t piece = (int32_t)(bits >> 22) - 2 * (127 - octaves) + 1;
    const uint32_t centred =
        (bits & 0x003fffff) | 0x3f800000; /* mantissa within its half octave: 1 ... 1.5 */
    float mantissa;
    memcpy(&mantissa, &centred, sizeof mantissa);
    const float x = piece > 0 ? 4 * mantissa - 5 : 2 * (v * to_first) - 1;
    const float *c = table + SMITH_CELL * (piece > 0 ? piece : 0);
    const float x2 = x * x, x4 = x2 * x2;
    return ((c[0] + c[1] * x) + (c[2] + c[3] * x) * x2) + ((c[4] + c[5] * x) + (c[6] + c[7] * x) * x2) * x4;
}

/* z Lambda where the table is of Lambda over that of unit GGX; r2 in its units. */
static inline float smith_table_z_lambda(const float *table, int32_t octaves, float to_first, float r2,
                                         float z) {
    const float both = sqrtf(z * z + r2) + z, sum = both > FLT_MIN ? both : FLT_MIN, ggx = r2 / sum;
    const float over = smith_table_at(table, octaves, to_first, ggx / sum);
    return ggx / 2 * (over > 0 ? over : 0);
}

/* The direction at v, and what makes z Lambda there an entry of such a table. */
static inline double smith_table_place(double v, double *r, double *z) {
    *z = (1 - v) / (1 + v), *r = 2 * sqrt(v) / (1 + v);
    return (1 + v) / v;
}

#endif
