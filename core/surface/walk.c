/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* walk.c: the first step of a walk, and walks written down. */
#include "core/surface/walk.h"

#include <stdlib.h>

_Bool mu_stepper_begin(mu_stepper *s, const double m[4], const double w[3], double u, double v, int upper) {
    static const int32_t corners[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 1}, {0, 1}, {1, 0}}};
    const double most = fmax(fabs(w[0]), fabs(w[1]));
    if (!(most > 0)) return 0;
    *s = (mu_stepper){.e1 = {m[0], m[2]}, .e2 = {m[1], m[3]}, .along = {w[0] / most, w[1] / most}};
    s->from[0] = u * m[0] + v * m[1];
    s->from[1] = u * m[2] + v * m[3];
    s->climb = w[2] / most / (s->along[0] * s->along[0] + s->along[1] * s->along[1]);

    /* Two edges have their ends on either side; the ray leaves by the one that it meets later. */
    const double climb = s->climb;
    s->climb = 1; /* so that `rise` is the distance, whichever way the ray goes */
    mu_stepper best = *s;
    _Bool found = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t *a = corners[upper][k], *b = corners[upper][(k + 1) % 3],
                      *p = corners[upper][(k + 2) % 3];
        double left = mu_stepper_side(s, a), right = mu_stepper_side(s, b);
        if ((left >= 0) == (right >= 0)) continue;
        if (left < 0) {
            const int32_t *const other = a;
            const double number = left;
            a = b, b = other, left = right, right = number;
        }
        mu_stepper here = *s;
        here.edge = (mu_crossing){.left = {a[0], a[1]}, .right = {b[0], b[1]}};
        here.behind[0] = p[0], here.behind[1] = p[1];
        here.left = left, here.right = right;
        mu_stepper_meet(&here);
        if (!found || here.edge.rise > best.edge.rise) best = here;
        found = 1;
    }
    *s = best;
    s->climb = climb;
    s->edge.rise *= climb;
    return found;
}

mu_walk_result mu_walk_make(mu_walk *walk, const double m[4], const double w[3], double u, double v,
                            int upper, double range) {
    mu_stepper s;
    size_t room = 0;
    *walk = (mu_walk){NULL, 0};
    if (!mu_stepper_begin(&s, m, w, u, v, upper)) return MU_WALK_OK;
    for (mu_stepper_next(&s); s.edge.rise <= range; mu_stepper_next(&s)) {
        if (walk->count == room) {
            room = room ? 2 * room : 64;
            mu_crossing *more =
                walk->count < MU_WALK_MOST ? realloc(walk->crossings, room * sizeof *more) : NULL;
            if (!more) {
                const _Bool long_one = walk->count >= MU_WALK_MOST;
                mu_walk_free(walk);
                return long_one ? MU_WALK_TOO_LONG : MU_WALK_NO_MEMORY;
            }
            walk->crossings = more;
        }
        walk->crossings[walk->count++] = s.edge;
    }
    return MU_WALK_OK;
}

void mu_walk_free(mu_walk *walk) {
    free(walk->crossings);
    *walk = (mu_walk){NULL, 0};
}
