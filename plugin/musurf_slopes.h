/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_slopes.h: the extension "musurf.slopes/1", for hosts that light by images filtered in advance.
 *
 * A lobe's shape in a few numbers: the mean of the microsurface's slopes (dz/dx, dz/dy), and the covariance that stands for
 * their distribution: of GGX, which has none, that of alpha²/2; of any other, that of the GGX whose ellipse holds as many
 * slopes. Both average linearly over a surface. Under a map M they go with M^-T: mean M^-T mean, covariance M^-T S M^-1.
 */
#ifndef MUSURF_SLOPES_H
#define MUSURF_SLOPES_H

#include "musurf_plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MUSURF_SLOPES_ID "musurf.slopes/1"

typedef struct musurf_moments {
    double mean[2];
    double xx, xy, yy; /* all 0: a mirror */
} musurf_moments;

typedef struct musurf_slopes {
    uint32_t size;
    /* [any] Under the whole M `m` (rows: what musurf_map.h's compose gives); NULL: the material's own, of one whose M is
     * constant. MUSURF_UNSUPPORTED: not known. */
    musurf_result (*moments)(const musurf_material *material, const double *m, musurf_moments *out);
    /* [any] Read only if `size` says it is there. Before M: the distance from the mean within which that share of the slopes
     * are, over that of the GGX of the same covariance; 1 where that is not known. */
    double (*tail)(const musurf_material *material, double share);
    /* [any] Read only if `size` says it is there. Of a bound closure of the type, whose f jumps or is noise: how much of even light it
     * reflects, to `allowed`. 0: not known otherwise than by f and samples. */
    uint32_t (*albedo)(const void *closure, double allowed, double rgb[3]);
} musurf_slopes;

#ifdef __cplusplus
}
#endif
#endif /* MUSURF_SLOPES_H */
