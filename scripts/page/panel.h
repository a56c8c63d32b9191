/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * panel.h: the three panels, as Figures 2, 7, 8 of Cocco et al. 2024 and as `musurf ibl plot` draws them: slopes;
 * micronormals; reflected directions. x to the right, y upwards, -1 to 1 across a panel. Its frame says what of the
 * plane it shows: how far to either side of which x, y. The plane is that of slopes, or the equal-area projection from
 * above in which the horizon is at 1.
 */
#ifndef PAGE_PANEL_H
#define PAGE_PANEL_H

#include <math.h>

#include "core/ibl/ibl.h"

enum { PAGE_REACH, PAGE_X, PAGE_Y, PAGE_FRAME_NUMBERS };

static inline void page_place(double x, double y, const double *frame, double xy[2]) {
    xy[0] = (x - frame[PAGE_X]) / frame[PAGE_REACH], xy[1] = (y - frame[PAGE_Y]) / frame[PAGE_REACH];
}

/* Where a direction is. What is straight below is nowhere: far out. */
static inline void page_project_direction(const double w[3], const double *frame, double xy[2]) {
    const double scale = 1 / sqrt(fmax(1 + w[2], 1e-6)); /* sqrt(1 - z) over the length of w.xy */
    page_place(w[0] * scale, w[1] * scale, frame, xy);
}

static inline void page_project_normal(mu_ibl_space space, const double *frame, const double wo[3],
                                       const double m[3], double xy[2]) {
    double w[3] = {m[0], m[1], m[2]};
    if (space == MU_IBL_SLOPES) {
        page_place(-m[0] / m[2], -m[1] / m[2], frame, xy);
        return;
    }
    if (space == MU_IBL_REFLECTED) {
        const double along = m[0] * wo[0] + m[1] * wo[1] + m[2] * wo[2];
        for (int k = 0; k < 3; k++) w[k] = 2 * along * m[k] - wo[k];
    }
    page_project_direction(w, frame, xy);
}

/* The direction at a place of the disc; 0 outside the horizon. */
static inline int page_unproject(double x, double y, double w[3]) {
    const double z = 1 - (x * x + y * y);
    if (!(z > 0)) return 0;
    w[0] = x * sqrt(1 + z), w[1] = y * sqrt(1 + z), w[2] = z;
    return 1;
}

#endif
