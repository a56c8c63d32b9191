/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * shading.h: a hit made ready for its material: which side is up, the local frame, the closure.
 *
 * Conventions. The geometric normal decides which side is seen. A two-sided surface seen from behind turns
 * its frame over about the tangent (n and b change sign), unless its material transmits: then behind is inside, which
 * the material sees by the sign of wo.z. Where an interpolated normal faces away from a
 * viewer who sees the front, the geometric normal takes its place, so that silhouettes have no black rim. A
 * direction counts only if the shading frame and the geometric normal agree on its side: nothing leaks
 * through, nothing is lit from behind. A normal map turns the frame last of all (normal_turn.h).
 */
#ifndef MU_SHADING_H
#define MU_SHADING_H

#include "core/render/footprint.h"
#include "plugin/musurf_map.h"

typedef struct mu_shading {
    const mu_hit *hit;
    mu_frame frame; /* the material's: world from local */
    mu_vec3 ng;     /* turned over with the frame */
    float wo[3];    /* in that frame */
    const musurf_material_type *type;
    const musurf_material *compiled;
    const musurf_map *map; /* of a material whose values come down to an M, which is in `slots`; else NULL */
    const float *pushed;   /* `slots`, or NULL: the material needs none */
    void *closure;
    uint32_t lobes; /* that can be non-zero; 0: black from here */
    float slots
        [MU_SLOTS]; /* M of this point, where the material's map varies; its footprint, where that is wanted */
} mu_shading;

/* [any] `shading` and `closure` are valid as long as each other and `hit`. wo: unit, toward the viewer. beam: what is seen
 * at once (footprint.h); NULL: from afar. */
void mu_shading_begin(mu_shading *shading, const mu_scene *scene, const mu_hit *hit, mu_vec3 wo,
                      const mu_beam *beam, void *closure);

/* The same without the closure: `closure` and `lobes` are not set. Not to be moved. */
void mu_shading_place(mu_shading *shading, const mu_scene *scene, const mu_hit *hit, mu_vec3 wo, const mu_beam *beam);

/* And that alone, of a place. */
void mu_shading_bind(mu_shading *shading, void *closure);

/* n, a unit vector, and a tangent as near to t as can be. */
mu_frame mu_shading_frame(mu_vec3 n, mu_vec3 t);

/* What comes of the material's constant `transform` where M varies: first that, then the tension T of the mesh, then the
 * Jacobian of the map: M = P J P^-1 T transform, P = [dpdu dpdv] in the frame (t, b) of the deformed surface. At rest P is
 * T^-1 P, so this is the tension of a microsurface made by the map at rest: T (P_rest J P_rest^-1 transform).
 * Rows [m00 m01], [m10 m11]. */

/* T transform. `turned`: seen from behind, b is -b. */
void mu_shading_tension(const mu_hit *hit, _Bool turned, const float transform[4], float m[4]);

/* P J P^-1 transform; without usable UVs, or where J is not finite, transform. `m` may be `transform`. */
void mu_shading_jacobian(const mu_material *material, const mu_hit *hit, const mu_frame *frame,
                         const float transform[4], float m[4]);

/* Whether shading frame and geometry agree on which side `world` = `local` points to. */
static inline _Bool mu_shading_agrees(const mu_shading *shading, mu_vec3 world, float local_z) {
    return mu_dot(world, shading->ng) * local_z > 0;
}

#endif
