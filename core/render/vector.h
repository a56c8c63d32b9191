/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* vector.h: three floats, an orthonormal frame and an affine map; world space, right-handed. */
#ifndef MU_VECTOR_H
#define MU_VECTOR_H

#include <math.h>

typedef struct mu_vec3 {
    float x, y, z;
} mu_vec3;

/* Rows of the 3x4 matrix [linear | translation]. */
typedef struct mu_affine {
    float row[3][4];
} mu_affine;

/* Right-handed: b = n x t. */
typedef struct mu_frame {
    mu_vec3 t, b, n;
} mu_frame;

static inline mu_vec3 mu_v3(float x, float y, float z) {
    return (mu_vec3){x, y, z};
}
static inline mu_vec3 mu_add(mu_vec3 a, mu_vec3 b) {
    return (mu_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline mu_vec3 mu_sub(mu_vec3 a, mu_vec3 b) {
    return (mu_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline mu_vec3 mu_mul(mu_vec3 a, mu_vec3 b) {
    return (mu_vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}
static inline mu_vec3 mu_scale(mu_vec3 a, float s) {
    return (mu_vec3){a.x * s, a.y * s, a.z * s};
}
static inline float mu_dot(mu_vec3 a, mu_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline mu_vec3 mu_cross(mu_vec3 a, mu_vec3 b) {
    return (mu_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float mu_length(mu_vec3 a) {
    return sqrtf(mu_dot(a, a));
}
/* The zero vector stays zero. */
static inline mu_vec3 mu_normalise(mu_vec3 a) {
    const float length = mu_length(a);
    return length > 0 ? mu_scale(a, 1 / length) : a;
}
static inline mu_vec3 mu_to_local(const mu_frame *f, mu_vec3 w) {
    return (mu_vec3){mu_dot(w, f->t), mu_dot(w, f->b), mu_dot(w, f->n)};
}
static inline mu_vec3 mu_to_world(const mu_frame *f, mu_vec3 w) {
    return mu_add(mu_add(mu_scale(f->t, w.x), mu_scale(f->b, w.y)), mu_scale(f->n, w.z));
}
static inline mu_vec3 mu_affine_point(const mu_affine *a, mu_vec3 p) {
    const float(*r)[4] = a->row;
    return (mu_vec3){r[0][0] * p.x + r[0][1] * p.y + r[0][2] * p.z + r[0][3],
                     r[1][0] * p.x + r[1][1] * p.y + r[1][2] * p.z + r[1][3],
                     r[2][0] * p.x + r[2][1] * p.y + r[2][2] * p.z + r[2][3]};
}
static inline mu_vec3 mu_affine_vector(const mu_affine *a, mu_vec3 v) {
    const float(*r)[4] = a->row;
    return (mu_vec3){r[0][0] * v.x + r[0][1] * v.y + r[0][2] * v.z,
                     r[1][0] * v.x + r[1][1] * v.y + r[1][2] * v.z,
                     r[2][0] * v.x + r[2][1] * v.y + r[2][2] * v.z};
}

#endif
