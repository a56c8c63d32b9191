/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_points.c: compensated multiple scattering under an M of the point where no tables serve: of what transmits, is tilted,
 * a histogram, or steeper than tables reach: albedos are integrated while shading. No light is lost or made; evaluation, sampling,
 * density and exchanged directions agree, in both precisions.
 *
 * The furnace is held to what the definition promises, 4 % at most, to 4 standard errors of the mean weight of single scattering, and to what
 * two halves of the points differ by at which the lobe is integrated.
 */
#include "core/bsdf/albedo_set.h"
#include "tests/lobe_return.h"
#include "tests/scattering_fixture.h"

enum { SIDE = 24, WEIGHTS = 20000, DRAWS = 512 };

/* Slopes of two kinds, skewed, about a mean that is not 0. */
static void fill_histogram(double h[SIDE * SIDE]) {
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double x = (k % SIDE + 0.5) * 3 / SIDE - 1, y = ((double)(k / SIDE) + 0.5) * 2 / SIDE - 1;
        h[k] = exp(-8 * (x - y) * (x - y) - 2 * y * y) + 0.1 * exp(-20 * ((x - 1) * (x - 1) + y * y));
    }
}

enum { GLASS, TILTED_GLASS, HISTOGRAM, STEEP, CASES };
static mu_definition definition_of(int k, const double *histogram) {
    mu_definition d =
        bsdf_definition((mu_ndf[]){MU_BECKMANN, MU_GGX, MU_TABULATED, MU_GGX}[k], 0.4, 2, 1, 0, 0, 1);
    d.histogram = histogram, d.histogram_columns = d.histogram_rows = SIDE;
    d.histogram_bounds[0] = d.histogram_bounds[2] = -1, d.histogram_bounds[1] = 2, d.histogram_bounds[3] = 1;
    if (k == GLASS || k == TILTED_GLASS) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
    if (k == TILTED_GLASS) d.tilt[0] = 0.3, d.tilt[1] = -0.5;
    d.multiple = MU_COMPENSATED, d.compensation_varies = 1;
    /* made in less time: averages of tilted glass; and tables of what is less steep, for what is integrated takes no notice */
    d.compensation_error = (double[]){0.01, 0.4, 0.02, 0.1}[k];
    return d;
}

/* Turned, mirrored, of a condition to 1e4 and a scale of 10^±1.5; or making slopes rougher than tables know. */
static void any_map(uniform *u, int steep, float m[4]) {
    const double scale = steep ? 0.01 + 0.005 * uniform_double(u) : pow(10, 3 * uniform_double(u) - 1.5),
                 stretch = pow(10, (steep ? 0 : 2) * uniform_double(u)), a = scale * stretch,
                 b = copysign(scale / stretch, uniform_double(u) - 0.5), s = 7 * uniform_double(u),
                 t = 7 * uniform_double(u);
    m[0] = (float)(a * cos(s) * cos(t) - b * sin(s) * sin(t));
    m[1] = (float)(-a * cos(s) * sin(t) - b * sin(s) * cos(t));
    m[2] = (float)(a * sin(s) * cos(t) + b * cos(s) * sin(t));
    m[3] = (float)(-a * sin(s) * sin(t) + b * cos(s) * cos(t));
}

static void any_view(uniform *u, int below, float w[3]) {
    double v[3];
    bsdf_direction(0.002 + 0.998 * pow(uniform_double(u), 2), 7 * uniform_double(u), v);
    for (int i = 0; i < 3; i++) w[i] = (float)(below ? -v[i] : v[i]);
}

static void closes(const scene *b, scene *single, uniform *u, const float wo[3], const float m[4]) {
    moments energy = {0};
    double off;
    assert_true(mu_bind_f(single->s, wo, m, &single->c));
    furnace(single, u, WEIGHTS, &energy);
    assert_int_equal(b->c.lobe.count, 0);
    const double E = energy.sum / energy.n,
                 error = sqrt(fmax(energy.squares / energy.n - E * E, 0) / energy.n),
                 back = lobe_return(&b->c, DRAWS, &off), all = E + (double)b->c.lobe.lost * back;
    if (fabs(all - 1) <= fmin(b->d.compensation_error, 0.04) + 4 * error + (double)b->c.lobe.lost * off)
        return;
    print_error("energy %.5f, single %.5f +- %.5f, lost %.5f, back %.5f +- %.5f, M %g %g %g %g, z %g\n", all,
                E, error, (double)b->c.lobe.lost, back, off, (double)m[0], (double)m[1], (double)m[2],
                (double)m[3], (double)wo[2]);
    fail();
}

/* As exact as with a constant M (test_bsdf_multiple.c): 1e-6 of floats in either order; single scattering in float has 1e-3 in the
 * core of its lobes (test_bsdf_precision.c), which is all that there is where a density is above 1e3. */
static void pointwise(const scene *b, uniform *u, const float m[4]) {
    float wo[3];
    for (int k = 0; k < 3; k++) wo[k] = b->c.side * b->c.wo[k];
    for (int i = 0; i < 8; i++) {
        mu_sample_f x;
        mu_value_f e, r;
        mu_closure_f back;
        sample_once(b, u, &x);
        if (x.rejected || !(x.pdf < 1e3f) || !mu_bind_f(b->s, x.wi, m, &back)) continue;
        mu_eval_f(&b->c, x.wi, &e);
        mu_eval_f(&back, wo, &r);
        const double scale = x.transmitted ? 1 / (double)(x.eta * x.eta) : 1;
        bsdf_near((double)x.weight[0] * (double)x.pdf, (double)x.f[0] * fabs((double)x.wi[2]), 1e-5);
        bsdf_near((double)e.pdf, (double)x.pdf, 1e-3);
        bsdf_near((double)r.f[0] * scale, (double)e.f[0], 1e-3);
        bsdf_near((double)r.pdf, (double)e.pdf_reverse, 1e-3);
    }
}

/* The lobe in double is that in float: its albedos and averages are float's. */
static void doubles_agree(const scene *b, const mu_surface_d *s, const float wo[3], const float m[4]) {
    double w[3], map[4];
    mu_closure_d c;
    for (int k = 0; k < 3; k++) w[k] = (double)wo[k];
    for (int k = 0; k < 4; k++) map[k] = (double)m[k];
    assert_true(mu_bind_d(s, w, map, &c));
    assert_true(fabs((double)(c.lobe.lost - b->c.lobe.lost)) < 1e-3);
    bsdf_near((double)c.lobe.average[0], (double)b->c.lobe.average[0], 1e-3);
}

/* What is evaluated is what is sampled: the mean of weight |wi.z| by sampling, and of f cos |wi.z| over uniform directions. */
static void evaluation_agrees(scene *b, uniform *u) {
    const int sides = b->d.transmission ? 2 : 1;
    for (int k = 0; k < sides; k++) {
        const float m[4] = {0.6f, 0.3f, -0.5f, 1.1f}, wo[3] = {0.48f, 0.6f, k ? -0.64f : 0.64f};
        moments difference[2] = {{0, 0, 0}, {0, 0, 0}};
        assert_true(mu_bind_f(b->s, wo, m, &b->c));
        for (int i = 0; i < 300; i++) {
            mu_sample_f s;
            double w[3], sampled[2] = {0, 0};
            sample_once(b, u, &s);
            if (!s.rejected) sampled[s.wi[2] < 0] = (double)s.weight[0] * fabs((double)s.wi[2]);
            bsdf_direction(uniform_double(u), 2 * TEST_PI * uniform_double(u), w);
            for (int side = 0; side < sides; side++) {
                const float wi[3] = {(float)w[0], (float)w[1], (float)(side ? -w[2] : w[2])};
                mu_value_f v;
                mu_eval_f(&b->c, wi, &v);
                accumulate(&difference[side], sampled[side] - (double)v.f[0] * w[2] * w[2] * 2 * TEST_PI);
            }
        }
        for (int side = 0; side < sides; side++) agrees(&difference[side], 0, 1e-6, "sampled less evaluated");
    }
}

static void keeps_light_under_any_map(void **state) {
    (void)state;
    static double histogram[SIDE * SIDE];
    fill_histogram(histogram);
    for (int k = 0; k < CASES; k++) {
        uniform u = {1127u + (unsigned)k};
        mu_definition d = definition_of(k, histogram), once = d, borrows = d;
        scene b, single;
        once.multiple = MU_SINGLE;
        make(&b, &d), make(&single, &once);
        borrows.compensation_tables = mu_surface_tables_f(b.s), borrows.compensation_borrows = 1;
        void *memory = aligned_alloc(64, (mu_surface_bytes_d(&borrows) + 63) / 64 * 64);
        const mu_surface_d *in_double = mu_surface_make_d(&borrows, memory);
        assert_true(mu_surface_tables_unsure_f(b.s) == 0);
        assert_true(mu_surface_tables_open_f(b.s) == (k == STEEP ? 0 : 1));
        assert_true(k == STEEP ? mu_surface_tables_reach_f(b.s) >= 2 : mu_surface_tables_reach_f(b.s) == 0);
        for (int i = 0; i < 6; i++) {
            float m[4], wo[3];
            any_map(&u, k == STEEP, m);
            any_view(&u, d.transmission && i % 2, wo);
            assert_true(mu_bind_f(b.s, wo, m, &b.c));
            closes(&b, &single, &u, wo, m);
            pointwise(&b, &u, m);
            doubles_agree(&b, in_double, wo, m);
        }
        if (k == TILTED_GLASS || k == HISTOGRAM) evaluation_agrees(&b, &u);
        free(b.memory), free(single.memory), free(memory);
    }
}

/* What is drawn has the density that is told: the mean of cos / pdf over draws that lie within bounds is the integral of cos between
 * these, pi (to² - from²) / 8 of an eighth of a turn; of lobes about axes of any condition. */
static void lobes_have_their_density(void **state) {
    (void)state;
    uniform u = {1131};
    static double histogram[SIDE * SIDE];
    mu_definition d = definition_of(GLASS, histogram);
    const double bounds[] = {0, 0.01, 0.1, 0.5, 1};
    scene b;
    d.compensation_error = 0.2; /* a density knows no averages */
    make(&b, &d);
    for (int k = 0; k < 4; k++) {
        float m[4], wo[3];
        moments inside[4][8] = {0};
        any_map(&u, 0, m), any_view(&u, 0, wo);
        assert_true(mu_bind_f(b.s, wo, m, &b.c));
        for (int n = 0; n < 10000; n++) {
            float w[3];
            lobe_draw(&b.c.lobe, 0, uniform_float(&u), uniform_float(&u), w);
            const double phi = atan2((double)w[1], (double)w[0]) / TEST_PI * 4 + 4,
                         value = (double)(w[2] / lobe_blind_density(&b.c.lobe, w));
            for (int i = 0; i < 4; i++)
                for (int j = 0; j < 8; j++)
                    accumulate(&inside[i][j], (double)w[2] >= bounds[i] && (double)w[2] < bounds[i + 1] &&
                                                      j == (int)fmin(phi, 7)
                                                  ? value
                                                  : 0);
        }
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 8; j++)
                agrees(&inside[i][j], TEST_PI / 8 * (bounds[i + 1] * bounds[i + 1] - bounds[i] * bounds[i]),
                       1e-6, "the integral of cos");
    }
    free(b.memory);
}

/* Stands for what a tilted surface loses: a part that grows with the mean slope, and one with how slopes are spread, 1.1 times
 * what was measured of this one. */
static double like_lost(const albedo_means *m, const double v[4]) {
    const double x = v[0] * m->mean[0] + v[2] * m->mean[1], y = v[1] * m->mean[0] + v[3] * m->mean[1],
                 both = 0.4 * hypot(x, y) +
                        1.1 * 0.4 * m->spread * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
    return both / (1 + both);
}

/* Averages are read near enough between the nodes of their table, also where they have a cusp: where the mean slope lies along an
 * axis that is far smoother than the other. 1 %: what is promised. */
static void averages_know_where_the_mean_lies(void **state) {
    (void)state;
    static float values[ALBEDO_MEANS_FLOATS];
    uniform u = {1133};
    mu_definition d = bsdf_definition(MU_GGX, 0.4, 2, 1, 0, 0, 1);
    scene b;
    d.tilt[0] = 0.3, d.tilt[1] = -0.5, d.multiple = MU_COMPENSATED, d.compensation_varies = 1;
    d.compensation_error = 0.4;
    make(&b, &d);
    const mu_albedo_set *set = mu_surface_tables_f(b.s);
    albedo_means m = set->means;
    m.value = values, m.angles = ALBEDO_MEANS_EVEN;
    for (int i = 0; i < m.rows; i++)
        for (int j = 0; j < ALBEDO_MEANS_SHAPES; j++)
            for (int k = 0; k < m.angles; k++) {
                double v[4];
                mu_albedo_means_view(&m, i, j, k, v);
                values[albedo_means_node(&m, i, j, k)] =
                    (float)log(like_lost(&m, v) / mu_albedo_means_about(&m, v));
            }
    const double along = atan2(m.mean[1], m.mean[0]);
    for (int n = 0; n < 400; n++) { /* V = diag(large, small) R: azimuths near the mean's are narrow */
        const double large = exp2(8 * uniform_double(&u) - 8), small = large * exp2(-8 * uniform_double(&u)),
                     by = along + pow(small / large, uniform_double(&u)) * (n % 2 ? 1 : -1), c = cos(by),
                     s = sin(by), v[4] = {-large * s, small * c, large * c, small * s};
        mu_lobe l;
        mu_albedo_means_choose(&m, set->open, v, &l);
        bsdf_near((double)l.average[0], like_lost(&m, v), 0.01);
    }
    free(b.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(keeps_light_under_any_map),
                                       cmocka_unit_test(averages_know_where_the_mean_lies),
                                       cmocka_unit_test(lobes_have_their_density)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
