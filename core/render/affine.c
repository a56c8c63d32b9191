/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * affine.c: inverting an affine map in double precision.
 *
 * The map is called singular when |det| is below 1e-9 of the product of its columns' lengths (Hadamard's
 * bound): its entries are floats, each rounded by up to 6e-8 of itself, so nearer to singular the direction
 * of the normal would be rounding noise.
 */
#include "core/render/affine.h"

#define MU_SINGULAR 1e-9

mu_dvec3 mu_orthogonal(mu_dvec3 n) {
    /* Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017), first vector of the basis. */
    const double sign = copysign(1, n.z);
    const double a = -1 / (sign + n.z);
    return (mu_dvec3){1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

_Bool mu_map_make(mu_map *map, const mu_affine *affine) {
    mu_dvec3 column[3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) map->linear[i][j] = (double)affine->row[i][j];
        map->translation[i] = (double)affine->row[i][3];
    }
    map->identity = 1;
    for (int i = 0; i < 9; ++i)
        if (map->linear[i / 3][i % 3] != (i % 4 == 0 ? 1 : 0)) map->identity = 0;
    for (int j = 0; j < 3; ++j) column[j] = mu_d3(map->linear[0][j], map->linear[1][j], map->linear[2][j]);
    const mu_dvec3 cross[3] = {mu_dcross(column[1], column[2]), mu_dcross(column[2], column[0]),
                               mu_dcross(column[0], column[1])};
    const double determinant = mu_ddot(column[0], cross[0]);
    const double largest = mu_dlength(column[0]) * mu_dlength(column[1]) * mu_dlength(column[2]);
    map->determinant = determinant;
    if (!(fabs(determinant) > MU_SINGULAR * largest)) return 0;
    double squares = 0, inverse_squares = 0;
    for (int i = 0; i < 3; ++i) {
        squares += mu_ddot(column[i], column[i]);
        inverse_squares += mu_ddot(cross[i], cross[i]) / (determinant * determinant);
        map->inverse[i][0] = cross[i].x / determinant;
        map->inverse[i][1] = cross[i].y / determinant;
        map->inverse[i][2] = cross[i].z / determinant;
    }
    map->condition = sqrt(squares * inverse_squares) * largest / fabs(determinant);
    return 1;
}
