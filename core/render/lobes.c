/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* lobes.c: see lobes.h. */
#include "core/render/lobes.h"

#include "core/render/normal_map.h"

#include <math.h>
#include <stddef.h>

static const char *refusal(const mu_material *m, const musurf_slopes *slopes, const musurf_map *map, _Bool varies) {
    if (m->plan.lobes & ~(uint32_t)(MUSURF_GLOSSY_REFLECTION | MUSURF_DELTA_REFLECTION))
        return "does more than reflect off its microsurface";
    if (m->blend) return "is blended of several";
    if (!slopes || (varies && !map)) return "does not tell the slopes of its microsurface";
    return NULL;
}

_Bool mu_lobe_source_make(mu_lobe_source *source, const mu_named_material *named, mu_error *error) {
    static const double still[4] = {1, 0, 0, 1};
    const mu_material *m = &named->material;
    const musurf_slopes *slopes = m->type->extension ? m->type->extension(MUSURF_SLOPES_ID) : NULL;
    const musurf_map *map = m->type->extension ? m->type->extension(MUSURF_MAP_ID) : NULL;
    /* what a normal map might widen takes its M at each hit, even a mirror, which none can */
    const _Bool varies = m->varying || m->tension || m->jacobian.map != MU_JACOBIAN_NONE ||
                         (m->normal_map && m->normal_map->placement.filtered && slopes && map);
    const char *why = refusal(m, slopes, map, varies);
    if (!why && slopes->moments(m->compiled, varies ? still : NULL, &source->moments) != MUSURF_OK)
        why = "has slopes that are not known";
    if (why)
        return mu_fail(error, "material \"%s\" %s: only --integrator path renders it", named->name, why);
    const musurf_moments *s = &source->moments;
    const mu_ibl_slopes own = {{s->mean[0], s->mean[1]}, s->xx, s->xy, s->yy};
    source->map = varies ? map : NULL;
    source->lobe = mu_ibl_lobe_of_f(&own);
    const _Bool told = slopes->size > offsetof(musurf_slopes, tail) && slopes->tail;
    for (size_t i = 0; i < MU_IBL_TAIL; i++)
        source->tail[i] = told ? (float)slopes->tail(m->compiled, mu_ibl_tail_share(i)) : 1;
    return 1;
}

_Bool mu_lobe_at(const mu_lobe_source *source, const mu_shading *shading, mu_ibl_lobe_f *lobe) {
    if (!source->map) {
        *lobe = source->lobe;
        return 1;
    }
    float whole[4];
    const float *m = shading->slots + MU_SLOT_TRANSFORM;
    if (!shading->map) { /* what was pushed is not all of it */
        if (!shading->pushed || !source->map->compose(shading->compiled, shading->pushed, whole)) return 0;
        m = whole;
    }
    const double a = (double)m[0], b = (double)m[1], c = (double)m[2], d = (double)m[3], det = a * d - b * c;
    if (!(det * det > 0 && det * det <= 1e300)) return 0;
    const musurf_moments *s = &source->moments;
    /* M^-T = (d, -c; -b, a) / det, and covariance M^-T S M^-1 */
    const double k = 1 / (det * det), xx = s->xx, xy = s->xy, yy = s->yy;
    const double *mean = s->mean, first = (d * mean[0] - c * mean[1]) / det, second = (a * mean[1] - b * mean[0]) / det;
    const mu_ibl_slopes here = {{first, second},
                                k * (d * (d * xx - c * xy) - c * (d * xy - c * yy)),
                                k * (d * (a * xy - b * xx) - c * (a * yy - b * xy)),
                                k * (a * (a * yy - b * xy) - b * (a * xy - b * xx))};
    *lobe = mu_ibl_lobe_of_f(&here);
    return 1;
}
