/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * geometry_hit.c: the frame, texture coordinates and derivatives where a ray met an object, and the bound on
 * the rounding error of that point. World space; computed in double precision from the object's own
 * description.
 *
 * Positions and tangents go with the object's linear map L, normals with its inverse transpose, so the
 * outside stays the outside under mirrors. Outside is where the vertex normals point; without them, where the
 * triangle's corners run counter-clockwise.
 *
 * The error bound, with u = 2^-24 and first-order analysis of what is rounded on the way (distances along
 * ng):
 * - p is rounded to float, and so is the offset origin: u sum |n_i p_i| each;
 * - a world-space vertex v is rounded: u sum |n_i| max |v_i|, and no |v_i| is beyond max |p_i| + E;
 * - Embree's test of a triangle with longest edge E and doubled area A, from an origin at it: the three
 * corners relative to the origin (u E each), edges from those (3 u E), normal (9 u E^2), distance to the
 * plane 13 u E^3 / A;
 * - of an instance, the ray is mapped by a float inverse: 8 u H |L| |L^-1| (|p| + |translation|), with
 * Frobenius norms and Hadamard's ratio H, and the triangle's share is stretched by |L^T n|.
 */
#include <float.h>

#include "core/render/geometry_internal.h"

#define MU_UNIT 0x1p-24 /* half the spacing of floats at 1 */

/* A point of a surface in its object's own space. */
typedef struct mu_local {
    mu_dvec3 p, ng, n, t, dpdu, dpdv; /* not normalised; t zero if there is none */
    double u, v;
    float *tension; /* of the hit */
    double edge;    /* longest edge E of what was tested against; 0: tested against exactly */
    double test;    /* error of the ray's test in units of u, in the space in which it is done */
} mu_local;

static double largest(mu_dvec3 a) {
    return mu_dmax(fabs(a.x), mu_dmax(fabs(a.y), fabs(a.z)));
}

/* E, and 13 E^3 / A of the triangle with these edges, the latter at most a thousandth of E / u: beyond that
 * it is a needle that no ray is tested against reliably. */
static void set_test_error(mu_local *local, mu_dvec3 e1, mu_dvec3 e2) {
    const mu_dvec3 e3 = mu_dsub(e2, e1), cross = mu_dcross(e1, e2);
    const double edge2 = mu_dmax(mu_ddot(e1, e1), mu_dmax(mu_ddot(e2, e2), mu_ddot(e3, e3)));
    const double aspect = 13 * edge2 / mu_dlength(cross), needle = 1e-3 / MU_UNIT;
    local->edge = sqrt(edge2);
    local->test = local->edge * (aspect < needle ? aspect : needle);
}

static void on_rectangle(const mu_object *object, const mu_map *map, const mu_found *found, mu_local *local) {
    const double w = (double)object->size[0], h = (double)object->size[1];
    local->u = (double)found->u;
    local->v = (double)found->v;
    local->p = mu_d3((local->u - 0.5) * w, (local->v - 0.5) * h, 0);
    local->ng = local->n = mu_d3(0, 0, 1);
    local->t = mu_d3(1, 0, 0);
    local->dpdu = mu_d3(w, 0, 0);
    local->dpdv = mu_d3(0, h, 0);
    set_test_error(local, mu_map_vector(map, local->dpdu), mu_map_vector(map, local->dpdv));
}

/* Longitude runs counter-clockwise about +z from +x; at the poles it is taken as 0, so the tangent is +y
 * there. */
static void on_sphere(const mu_object *object, const mu_map *map, const mu_ray *ray, const mu_found *found,
                      mu_local *local) {
    const double pi = 3.14159265358979323846;
    const double t = (double)found->distance;
    const mu_dvec3 world = mu_d3((double)ray->origin.x + t * (double)ray->direction.x - map->translation[0],
                                 (double)ray->origin.y + t * (double)ray->direction.y - map->translation[1],
                                 (double)ray->origin.z + t * (double)ray->direction.z - map->translation[2]);
    const mu_dvec3 n =
        mu_dnormalise(mu_matrix_times(map->inverse, world)); /* distance is rounded: back onto it */
    const double r = (double)object->radius, rho = sqrt(n.x * n.x + n.y * n.y);
    const double cosine = rho > 0 ? n.x / rho : 1, sine = rho > 0 ? n.y / rho : 0;
    const double longitude = atan2(sine, cosine);
    local->u = (longitude < 0 ? longitude + 2 * pi : longitude) / (2 * pi);
    local->v = 0.5 + atan2(n.z, rho) / pi;
    local->p = mu_dscale(n, r);
    local->ng = local->n = n;
    local->t = mu_d3(-sine, cosine, 0);
    local->dpdu = mu_dscale(local->t, 2 * pi * r * rho);
    local->dpdv = mu_dscale(mu_d3(-n.z * cosine, -n.z * sine, rho), pi * r);
    local->edge = local->test = 0;
}

static mu_dvec3 blend(const float *values, size_t stride, const uint32_t *corner, const double *weight) {
    mu_dvec3 sum = {0, 0, 0};
    for (int i = 0; i < 3; ++i)
        sum = mu_dadd(sum, mu_dscale(mu_dfloat(values + stride * corner[i]), weight[i]));
    return sum;
}

/* Equal matrices give the same one exactly. Where b is on the other side of t than by the triangle's winding, y has the
 * other sign. */
static void blend_tension(const float *tension, const uint32_t *corner, double u, double v, _Bool turned,
                          float out[4]) {
    const float *m0 = tension + 4 * (size_t)corner[0], *m1 = tension + 4 * (size_t)corner[1],
                *m2 = tension + 4 * (size_t)corner[2];
    for (int k = 0; k < 4; ++k) {
        const double first = (double)m0[k];
        const float m = (float)(first + u * ((double)m1[k] - first) + v * ((double)m2[k] - first));
        out[k] = turned && (k == 1 || k == 2) ? -m : m;
    }
}

static void on_triangle(const mu_mesh *mesh, const mu_map *map, const mu_found *found, mu_local *local) {
    const uint32_t *corner = mesh->indices + 3 * (size_t)found->primitive;
    const double u = (double)found->u, v = (double)found->v;
    const double weight[3] = {1 - u - v, u, v}, equal[3] = {1, 1, 1};
    double outside = 1;
    mu_dvec3 p[3];
    for (int i = 0; i < 3; ++i) p[i] = mu_dfloat(mesh->positions + 3 * (size_t)corner[i]);
    const mu_dvec3 e1 = mu_dsub(p[1], p[0]), e2 = mu_dsub(p[2], p[0]);
    local->p = mu_dadd(p[0], mu_dadd(mu_dscale(e1, u), mu_dscale(e2, v)));
    local->ng = local->n = mu_dcross(e1, e2);
    if (mesh->normals) {
        outside = mu_ddot(blend(mesh->normals, 3, corner, equal), local->ng) < 0 ? -1 : 1;
        local->ng = mu_dscale(local->ng, outside);
        local->n = blend(mesh->normals, 3, corner, weight);
    }
    local->u = local->v = 0;
    local->dpdu = local->dpdv = mu_d3(0, 0, 0);
    if (mesh->uvs) {
        const float *a = mesh->uvs + 2 * (size_t)corner[0], *b = mesh->uvs + 2 * (size_t)corner[1],
                    *c = mesh->uvs + 2 * (size_t)corner[2];
        const double du1 = (double)b[0] - (double)a[0], dv1 = (double)b[1] - (double)a[1];
        const double du2 = (double)c[0] - (double)a[0], dv2 = (double)c[1] - (double)a[1];
        const double area = du1 * dv2 - du2 * dv1;
        local->u = (double)a[0] + u * du1 + v * du2;
        local->v = (double)a[1] + u * dv1 + v * dv2;
        if (area != 0) {
            local->dpdu = mu_dscale(mu_dsub(mu_dscale(e1, dv2), mu_dscale(e2, dv1)), 1 / area);
            local->dpdv = mu_dscale(mu_dsub(mu_dscale(e2, du1), mu_dscale(e1, du2)), 1 / area);
        }
    }
    if (mesh->tension)
        blend_tension(mesh->tension, corner, u, v, (map->determinant < 0) != (outside < 0), local->tension);
    local->t = mesh->tangents ? blend(mesh->tangents, 4, corner, weight) : local->dpdu;
    if (found->instance) /* tested in the mesh's own space */
        set_test_error(local, e1, e2);
    else
        set_test_error(local, mu_map_vector(map, e1), mu_map_vector(map, e2));
}

static double error_bound(const mu_map *map, const mu_local *local, const mu_found *found, mu_dvec3 p,
                          mu_dvec3 ng) {
    double bound = 2 * (fabs(ng.x * p.x) + fabs(ng.y * p.y) + fabs(ng.z * p.z));
    double test = local->test;
    if (found->instance) {
        const double *t = map->translation;
        bound += 8 * map->condition * (mu_dlength(p) + mu_dlength(mu_d3(t[0], t[1], t[2])));
        test *= mu_dlength(mu_transpose_times(map->linear, ng));
    } else if (local->edge > 0)
        bound += (fabs(ng.x) + fabs(ng.y) + fabs(ng.z)) * (largest(p) + local->edge);
    return MU_UNIT * (bound + test) + (double)FLT_MIN;
}

static float finite_or_zero(double value) {
    return fabs(value) < (double)FLT_MAX ? (float)value : 0;
}

static mu_vec3 derivative(const mu_map *map, mu_dvec3 d) {
    const mu_dvec3 world = mu_map_vector(map, d);
    return mu_v3(finite_or_zero(world.x), finite_or_zero(world.y), finite_or_zero(world.z));
}

/* Every 1 / lines of u and v there is a line, `width` wide, half of the outermost ones outside the unit
 * square. */
static _Bool on_grid(const mu_grid *grid, double u, double v) {
    const double lines = (double)grid->lines, half = 0.5 * (double)grid->width * lines;
    return fabs(u * lines - nearbyint(u * lines)) < half || fabs(v * lines - nearbyint(v * lines)) < half;
}

void mu_hit_fill(const struct mu_geometry *geometry, const mu_ray *ray, const mu_found *found, mu_hit *hit) {
    const mu_object *object = &geometry->scene->objects[found->object];
    const mu_map *map = &geometry->maps[found->object];
    mu_local local; /* each shape fills the rest of it */
    local.tension = hit->tension;
    if (object->shape == MU_RECTANGLE)
        on_rectangle(object, map, found, &local);
    else if (object->shape == MU_SPHERE)
        on_sphere(object, map, ray, found, &local);
    else
        on_triangle(&geometry->scene->meshes[object->mesh], map, found, &local);

    const mu_dvec3 p = mu_map_point(map, local.p);
    const mu_dvec3 ng = mu_dnormalise(mu_map_normal(map, local.ng));
    mu_dvec3 n = mu_dnormalise(mu_map_normal(map, local.n));
    if (!(mu_ddot(n, ng) > 0)) n = ng; /* normals so bent that they point through their own triangle */
    const mu_dvec3 along = mu_map_vector(map, local.t);
    mu_dvec3 t = mu_dsub(along, mu_dscale(n, mu_ddot(along, n)));
    t = mu_dlength(t) > 1e-6 * mu_dlength(along) ? mu_dnormalise(t) : mu_orthogonal(n);

    hit->p = mu_single(p);
    hit->ng = mu_single(ng);
    hit->frame = (mu_frame){mu_single(t), mu_single(mu_dcross(n, t)), mu_single(n)};
    hit->uv[0] = (float)local.u;
    hit->uv[1] = (float)local.v;
    hit->dpdu = derivative(map, local.dpdu);
    hit->dpdv = derivative(map, local.dpdv);
    hit->primitive = found->primitive;
    hit->corner[0] = found->u, hit->corner[1] = found->v;
    hit->distance = found->distance;
    hit->error = (float)error_bound(map, &local, found, p, ng);
    hit->object = found->object;
    hit->material = object->grid.lines && on_grid(&object->grid, local.u, local.v) ? object->grid.material
                                                                                   : object->material;
}

mu_ray mu_geometry_leave(const mu_hit *hit, mu_vec3 direction, float far) {
    const float side = mu_dot(direction, hit->ng) < 0 ? -hit->error : hit->error;
    return (mu_ray){mu_add(hit->p, mu_scale(hit->ng, side)), direction, 0, far};
}
