/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_open.c: compensation where its tables are open, and the albedo is integrated while shading (core/bsdf/albedo_open.c).
 */
#include "core/bsdf/albedo_set.h"
#include "tests/scattering_fixture.h"

/* In float, either way: f, and over eta² the other way round; pdf, and pdf_reverse. Slopes of 1e-3 along
 * the smoother axis: a direction rounded by 2^-24 moves D by 4 · 2^-24 / 1e-3 = 2.4e-4 of itself, and eight numbers are rounded. */
static void same_both_ways(const scene *b, const mu_sample_f *s, const float wo[3]) {
    mu_closure_f back;
    mu_value_f there, again;
    mu_eval_f(&b->c, s->wi, &there);
    bsdf_near((double)there.f[0], (double)s->f[0], 2e-3);
    bsdf_near((double)there.pdf, (double)s->pdf, 2e-3);
    if (!mu_bind_f(b->s, s->wi, NULL, &back)) return;
    mu_eval_f(&back, wo, &again);
    const double scale = s->transmitted ? 1 / ((double)s->eta * (double)s->eta) : 1;
    bsdf_near((double)again.f[0] * scale, (double)there.f[0], 2e-3);
    bsdf_near((double)again.pdf, (double)there.pdf_reverse, 2e-3);
}

/* Tilted glass under 18:1, whose albedo jumps along curves: tables stay open in part, where it is integrated while shading. From
 * such views, too, all light comes out again, and f and pdf are what samples say. */
static void open_tables_keep_all_light(void **state) {
    (void)state;
    enum { TRIED = 2000, VIEWS = 8 };
    uniform u = {29};
    mu_definition d = bsdf_definition(MU_GGX, 0.1, 2, 100, 30, -20, 0.01);
    d.multiple = MU_COMPENSATED, d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
    d.tilt[0] = 0.36, d.tilt[1] = 0.1;
    scene b;
    make(&b, &d);
    assert_true(mu_surface_tables_open_f(b.s) > 1e-3f);
    int views = 0;
    for (int k = 0; k < TRIED && views < VIEWS; k++) {
        double wo[3];
        moments energy = {0};
        bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wo);
        if (k & 1) wo[2] = -wo[2];
        view(&b, wo);
        if (b.c.lobe.lost != mu_albedo_lost_at(&b.c.lobe, k & 1, b.c.wo)) continue;
        views++;
        for (int i = 0; i < 20; i++) {
            mu_sample_f x;
            sample_once(&b, &u, &x);
            if (!x.rejected)
                same_both_ways(&b, &x, (const float[]){(float)wo[0], (float)wo[1], (float)wo[2]});
        }
        furnace(&b, &u, 2000, &energy);
        holds(&energy, 1, 0.01);
    }
    assert_int_equal(views, VIEWS);
    free(b.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(open_tables_keep_all_light)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
