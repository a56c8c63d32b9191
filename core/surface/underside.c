/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* underside.c: the point reflection of underside.h, of vertices, points and directions. */
#include "core/surface/underside.h"

#include <stdlib.h>

void mu_underside_heights(const mu_heightfield *f, double *out) {
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++) out[(size_t)i * f->ny + j] = -mu_height(f, f->nx - i, f->ny - j);
}

mu_caster *mu_underside_caster(const mu_heightfield *f) {
    double *heights = malloc(mu_cells(f) * sizeof *heights);
    if (!heights) return NULL;
    mu_underside_heights(f, heights);
    mu_caster *caster = mu_caster_make(&(mu_heightfield){heights, f->nx, f->ny});
    free(heights);
    return caster;
}

/* Cell (i, j) spans to (i + 1, j + 1); its image begins at the latter's, -(i + 1, j + 1). */
mu_spot mu_underside_spot(const mu_heightfield *f, const mu_spot *spot) {
    return (mu_spot){f->nx - 1 - spot->i, f->ny - 1 - spot->j, !spot->upper, 1 - spot->u, 1 - spot->v};
}

_Bool mu_underside_sees(const mu_caster *underside, const mu_heightfield *f, const double m[4],
                        const mu_spot *spot, const double t[3]) {
    if (!(t[2] < 0)) return 0;
    const mu_spot image = mu_underside_spot(f, spot);
    const mu_sight sight = {.m = {m[0], m[1], m[2], m[3]},
                            .w = {-t[0], -t[1], -t[2]},
                            .u = image.u,
                            .v = image.v,
                            .upper = image.upper};
    return mu_caster_sees(underside, &sight, image.i, image.j);
}
