/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_glass.c: compensated glass keeps all light where it is hardest, within 1 % and 4 standard errors, and says so: its
 * tables are as near as they were asked to be.
 */
#include "tests/scattering_fixture.h"

#include <stdlib.h>

/* Where angles and slopes along either axis are of very different scales, total reflection begins at once for all facets that
 * are seen, or the tilt is four times the roughness; tables know it, and views on either side of where it begins. */
static void hard_glass_keeps_all_light(void **state) {
    (void)state;
    uniform u = {28};
    static const struct {
        mu_ndf ndf;
        double alpha, gamma, m[4], tilt[2];
    } hard[] = {{MU_GGX, 0.3, 2, {0.01, 0, 0, 100}, {0, 0}},
                {MU_STD, 0.3, 1.6, {1e-4, 0, 0, 1}, {0, 0}},
                {MU_GTR, 0.3, 0.4, {1, 0.3, 0, 1e4}, {0, 0}},
                {MU_GGX, 0.12, 2, {1, 0, 0, 1}, {0.45, -0.2}}};
    for (size_t k = 0; k < sizeof hard / sizeof hard[0]; k++) {
        const double *m = hard[k].m;
        mu_definition d = bsdf_definition(hard[k].ndf, hard[k].alpha, hard[k].gamma, m[0], m[1], m[2], m[3]);
        d.multiple = MU_COMPENSATED, d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        d.tilt[0] = hard[k].tilt[0], d.tilt[1] = hard[k].tilt[1];
        scene b;
        make(&b, &d);
        assert_true(mu_surface_tables_unsure_f(b.s) == 0);
        for (int v = 0; v < 10; v++) {
            double wo[3];
            moments energy = {0};
            const double z = v % 4 == 3 ? exp2(-12 * uniform_double(&u)) : uniform_double(&u);
            const double phi = v % 3 == 2 ? 0.7297 + 0.02 * uniform_double(&u) : 7 * uniform_double(&u);
            bsdf_direction(z, phi, wo); /* sin(0.7297) = 1 / 1.5 */
            for (int i = 0; i < 3; i++) wo[i] *= v % 4 ? -1 : 1;
            view(&b, wo);
            furnace(&b, &u, 2500, &energy);
            holds(&energy, 1, 0.01);
        }
        free(b.memory);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(hard_glass_keeps_all_light)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
