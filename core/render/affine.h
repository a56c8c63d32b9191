/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* affine.h: an affine map in double precision, with its inverse: what must be exact where a ray meets a
 * surface. */
#ifndef MU_AFFINE_H
#define MU_AFFINE_H

#include "core/render/vector.h"

typedef struct mu_dvec3 {
    double x, y, z;
} mu_dvec3;

typedef struct mu_map {
    double linear[3][3], translation[3];
    double inverse[3][3]; /* of linear */
    double determinant;   /* negative: a mirror */
    _Bool identity;       /* of linear: nothing is multiplied */
    double condition;     /* |linear| |inverse| times Hadamard's ratio, Frobenius norms; 3 if a rotation */
} mu_map;

static inline mu_dvec3 mu_d3(double x, double y, double z) {
    return (mu_dvec3){x, y, z};
}
static inline mu_dvec3 mu_dfloat(const float v[3]) {
    return (mu_dvec3){(double)v[0], (double)v[1], (double)v[2]};
}
static inline mu_dvec3 mu_dadd(mu_dvec3 a, mu_dvec3 b) {
    return (mu_dvec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline mu_dvec3 mu_dsub(mu_dvec3 a, mu_dvec3 b) {
    return (mu_dvec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline mu_dvec3 mu_dscale(mu_dvec3 a, double s) {
    return (mu_dvec3){a.x * s, a.y * s, a.z * s};
}
static inline double mu_ddot(mu_dvec3 a, mu_dvec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline mu_dvec3 mu_dcross(mu_dvec3 a, mu_dvec3 b) {
    return (mu_dvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double mu_dlength(mu_dvec3 a) {
    return sqrt(mu_ddot(a, a));
}
/* The zero vector stays zero. */
static inline mu_dvec3 mu_dnormalise(mu_dvec3 a) {
    const double length = mu_dlength(a);
    return length > 0 ? mu_dscale(a, 1 / length) : a;
}
static inline mu_vec3 mu_single(mu_dvec3 a) {
    return (mu_vec3){(float)a.x, (float)a.y, (float)a.z};
}

static inline mu_dvec3 mu_matrix_times(const double (*m)[3], mu_dvec3 v) {
    return (mu_dvec3){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                      m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                      m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}
static inline mu_dvec3 mu_transpose_times(const double (*m)[3], mu_dvec3 v) {
    return (mu_dvec3){m[0][0] * v.x + m[1][0] * v.y + m[2][0] * v.z,
                      m[0][1] * v.x + m[1][1] * v.y + m[2][1] * v.z,
                      m[0][2] * v.x + m[1][2] * v.y + m[2][2] * v.z};
}
static inline double mu_dmax(double a, double b) { /* one instruction where fmax is a call */
    return a > b ? a : b;
}
/* Differences of points, and normals, which go with the inverse transpose. */
static inline mu_dvec3 mu_map_vector(const mu_map *map, mu_dvec3 v) {
    return map->identity ? v : mu_matrix_times(map->linear, v);
}
static inline mu_dvec3 mu_map_normal(const mu_map *map, mu_dvec3 n) {
    return map->identity ? n : mu_transpose_times(map->inverse, n);
}
static inline mu_dvec3 mu_map_point(const mu_map *map, mu_dvec3 p) {
    return mu_dadd(mu_map_vector(map, p),
                   (mu_dvec3){map->translation[0], map->translation[1], map->translation[2]});
}

/* A unit vector orthogonal to the unit vector n, continuous except around -z. */
mu_dvec3 mu_orthogonal(mu_dvec3 n);
/* False if the linear part is singular to double precision; the map is then unusable. */
_Bool mu_map_make(mu_map *map, const mu_affine *affine);

#endif
