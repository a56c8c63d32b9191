/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * panel.h: the three panels, as Figures 2, 7, 8 of Cocco et al. 2024 and as `musurf ibl plot` draws them: slopes; micronormals; reflected
 * directions. x to the right, y upwards, -1 to 1 across a panel, which shows `reach` to either side: of slopes, or of the
 * equal-area projection from above in which the horizon is at 1.
 */
#ifndef PAGE_PANEL_H
#define PAGE_PANEL_H

#include <math.h>

#include "core/ibl/ibl.h"

/* Where a direction is. What is straight below is nowhere: far out. */
static inline void page_project_direction(const double w[3], double reach, double xy[2]) {
    const double scale = 1 / sqrt(fmax(1 + w[2], 1e-6)) / reach; /* sqrt(1 - z) over the length of w.xy */
    xy[0] = w[0] * scale, xy[1] = w[1] * scale;
}

static inline void page_project_normal(mu_ibl_space space, double reach, const double wo[3],
                                       const double m[3], double xy[2]) {
    double w[3] = {m[0], m[1], m[2]};
    if (space == MU_IBL_SLOPES) {
        xy[0] = -m[0] / m[2] / reach, xy[1] = -m[1] / m[2] / reach;
        return;
    }
    if (space == MU_IBL_REFLECTED) {
        const double along = m[0] * wo[0] + m[1] * wo[1] + m[2] * wo[2];
        for (int k = 0; k < 3; k++) w[k] = 2 * along * m[k] - wo[k];
    }
    page_project_direction(w, reach, xy);
}

/* The direction at a place; 0 outside the horizon. */
static inline int page_unproject(double x, double y, double reach, double w[3]) {
    x *= reach, y *= reach;
    const double z = 1 - (x * x + y * y);
    if (!(z > 0)) return 0;
    w[0] = x * sqrt(1 + z), w[1] = y * sqrt(1 + z), w[2] = z;
    return 1;
}

#endif
