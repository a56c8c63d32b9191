/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_slopes.c: the extension "musurf.slopes/1". Moments before M are found once, when a material is compiled: a
 * histogram's take a search. */
#include "plugin/musurf_slopes.h"

#include "plugin/musurf_compiled.h"

void musurf_find_moments(musurf_material *m) {
    mu_definition still = m->parsed.definition;
    still.transform[0] = still.transform[3] = 1, still.transform[1] = still.transform[2] = 0;
    m->has_moments = mu_ibl_slopes_of(&still, &m->moments);
}

static musurf_result moments(const musurf_material *material, const double *m, musurf_moments *out) {
    *out = (musurf_moments){.xx = 0};
    if (!material->has_moments || (!m && material->parsed.varying)) return MUSURF_UNSUPPORTED;
    const mu_ibl_slopes s =
        mu_ibl_slopes_under(&material->moments, m ? m : material->parsed.definition.transform);
    *out = (musurf_moments){{s.mean[0], s.mean[1]}, s.xx, s.xy, s.yy};
    return MUSURF_OK;
}

static double tail(const musurf_material *material, double share) {
    return mu_ibl_tail_of(&material->parsed.definition, share);
}

static uint32_t albedo(const void *closure, double allowed, double rgb[3]) {
    const bound *b = closure;
    const musurf_material *m = b->material;
    if (m->in_float ? mu_ibl_albedo_of_cells_f(&b->closure.f, allowed, rgb) : mu_ibl_albedo_of_cells_d(&b->closure.d, allowed, rgb)) return 1;
    if (!m->has_moments) return 0;
    return (uint32_t)(m->in_float ? mu_ibl_albedo_of_walks_f(&b->closure.f, &m->moments, allowed, rgb)
                                  : mu_ibl_albedo_of_walks_d(&b->closure.d, &m->moments, allowed, rgb));
}

const musurf_slopes musurf_slopes_table = {sizeof(musurf_slopes), moments, tail, albedo};
