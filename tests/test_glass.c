/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_glass.c: spheres of rough glass in a constant environment of radiance 1, against what is known of them apart
 * from the renderer. Random comparisons: 9.
 *
 * - Without roughness nothing is lost: F + (1 - F) = 1, whatever the path. The sphere is invisible.
 * - With the index of air (eta = 1) nothing is bent: a ray through the sphere is masked twice, by G2 / G1 at each side
 *   with both directions on one line: (1 + Lambda) / (1 + 2 Lambda). Exact, by quadrature over the disc.
 * - Rough and with a skewed M: paths of a walker written here, on an analytic sphere in double. It draws directions by the
 *   core's sampler, but weighs them by f and pdf of eval, knows nothing of the renderer's frames, offsets and lights, and
 *   counts a path only where the renderer would: after at most `depth` events.
 */
#include "core/bsdf/musurf.h"
#include "tests/path_fixture.h"
#include <stdio.h>
#include "tests/uniform.h"

#define PI 3.14159265358979323846

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The frame of the unit sphere at n: east, north, out. Its poles are +-z. */
static void frame_at(const double n[3], double t[3], double b[3]) {
    const double flat = hypot(n[0], n[1]);
    t[0] = -n[1] / flat, t[1] = n[0] / flat, t[2] = 0;
    b[0] = n[1] * t[2] - n[2] * t[1], b[1] = n[2] * t[0] - n[0] * t[2], b[2] = n[0] * t[1] - n[1] * t[0];
}

/* What one path from p, on the sphere, toward the viewer at `out` brings back. */
static double walk(const mu_surface_d *surface, const double start[3], const double out[3], int depth,
                   uniform *u) {
    double p[3], d[3], weight = 1;
    for (int k = 0; k < 3; k++) p[k] = start[k], d[k] = out[k];
    for (int event = 0; event < depth; event++) {
        double t[3], b[3];
        frame_at(p, t, b);
        const double wo[3] = {dot(d, t), dot(d, b), dot(d, p)},
                     three[3] = {uniform_double(u), uniform_double(u), uniform_double(u)};
        mu_closure_d c;
        mu_sample_d s;
        mu_value_d v;
        if (!mu_bind_d(surface, wo, NULL, &c)) return 0;
        mu_sample_wi_d(&c, three, &s);
        if (s.rejected) return 0;
        mu_eval_d(&c, s.wi, &v);
        if (!(v.pdf > 0)) return 0;
        weight *= v.f[0] * fabs(s.wi[2]) / v.pdf;
        double wi[3];
        for (int k = 0; k < 3; k++) wi[k] = s.wi[0] * t[k] + s.wi[1] * b[k] + s.wi[2] * p[k];
        if (s.wi[2] > 0) return weight; /* out into the environment */
        const double chord = -2 * dot(p, wi);
        double length = 0;
        for (int k = 0; k < 3; k++) p[k] += chord * wi[k], d[k] = -wi[k], length += p[k] * p[k];
        for (int k = 0; k < 3; k++) p[k] /= sqrt(length);
    }
    return 0; /* still inside */
}

/* From +x over the disc; the environment around it is not counted. */
static moments walker(const mu_definition *d, int depth, int paths, uint64_t seed) {
    _Alignas(64) unsigned char memory[4096];
    assert_true(mu_surface_bytes_d(d) <= sizeof memory);
    const mu_surface_d *surface = mu_surface_make_d(d, memory);
    uniform u = {seed};
    moments m = {0, 0, 0};
    for (int i = 0; i < paths; i++) {
        const double r = sqrt(uniform_double(&u)), phi = 2 * PI * uniform_double(&u);
        const double p[3] = {sqrt(1 - r * r), r * cos(phi), r * sin(phi)}, out[3] = {1, 0, 0};
        accumulate(&m, walk(surface, p, out, depth, &u));
    }
    return m;
}

static moments rendered(const char *json, uint32_t depth, uint32_t roulette, int replicas, uint64_t seed,
                        _Bool two_sided) {
    path_fixture f;
    fixture_start(&f, 8);
    fixture_sphere(&f, 1, fixture_material(&f, json))->two_sided = two_sided;
    fixture_light(&f, (mu_light){.kind = MU_CONSTANT, .scale = {1, 1, 1}});
    fixture_look(&f, mu_v3(1, 0, 0), mu_v3(0, 0, 1));
    f.scene.integrator.depth = depth;
    f.scene.integrator.roulette = roulette;
    fixture_ready(&f);
    const moments m = fixture_mean(&f, &(mu_path_options){0}, seed, replicas, 8);
    fixture_end(&f);
    return m;
}

static void smooth_glass_is_invisible(void **state) {
    (void)state;
    const char *pane =
        "{\"material\": \"musurf.microfacet\", \"ndf\": \"flat\", \"fresnel\": {\"dielectric\": 1.5}, "
        "\"transmission\": true}";
    /* what is still inside after 64 events: total reflection never happens to what came in through a sphere */
    const moments plain = rendered(pane, 64, 1000, 200, 1, 0), sided = rendered(pane, 64, 1000, 200, 500, 1);
    agrees(&plain, 1, 1e-5, "pane");
    agrees(&sided, 1, 1e-5, "pane, two_sided");
    const moments roulette = rendered(pane, 64, 2, 2000, 1000, 0);
    agrees(&roulette, 1, 1e-5, "pane, roulette");
}

/* Masking of a ray straight through, seen from +x: at the entry (y, z) = r (cos, sin), and where it leaves. */
static double straight(const mu_definition *d) {
    _Alignas(64) unsigned char memory[4096];
    const mu_surface_d *surface = mu_surface_make_d(d, memory);
    double sum = 0;
    const int rings = 400, spokes = 400; /* midpoints of equal areas: 1e-5, below the picture's noise */
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < spokes; j++) {
            const double r = sqrt((i + 0.5) / rings), phi = 2 * PI * (j + 0.5) / spokes, x = sqrt(1 - r * r);
            double product = 1;
            for (int side = 1; side >= -1; side -= 2) {
                const double p[3] = {side * x, r * cos(phi), r * sin(phi)};
                double t[3], b[3];
                frame_at(p, t, b);
                const double w[3] = {t[0], b[0], p[0]}, up[3] = {side * w[0], side * w[1], side * w[2]};
                mu_closure_d c;
                assert_true(mu_bind_d(surface, up, NULL, &c));
                const double Lambda = mu_view_d(&c, up).Lambda;
                product *= (1 + Lambda) / (1 + 2 * Lambda);
            }
            sum += product / (rings * spokes);
        }
    return sum;
}

static void the_index_of_air_bends_nothing(void **state) {
    (void)state;
    mu_definition d = mu_definition_default();
    d.alpha = 0.4, d.fresnel = MU_FRESNEL_DIELECTRIC, d.dielectric = 1, d.transmission = 1;
    d.transform[1] = 2;
    const char *json = "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"alpha\": 0.4, "
                       "\"transform\": [[1, 2], [0, 1]], "
                       "\"fresnel\": {\"dielectric\": 1}, \"transmission\": true}";
    const double expected = straight(&d);
    print_message("eta = 1 passes %.5f\n", expected);
    assert_true(expected < 0.95);
    const moments m = rendered(json, 4, 1000, 1000, 20000, 0);
    agrees(&m, PI / 4 * expected + 1 - PI / 4, 2e-5, "eta = 1");
}

static void rough_glass_follows_the_walker(void **state) {
    (void)state;
    static const struct {
        mu_ndf ndf;
        double alpha, tilt;
        const char *json;
    } glass[] = {
        {MU_GGX, 0.3, 0, "\"ndf\": \"ggx\", \"alpha\": 0.3"},
        {MU_BECKMANN, 0.4, 0.2, "\"ndf\": \"beckmann\", \"alpha\": 0.4, \"tilt\": [0.2, 0]"},
    };
    static const int depths[] = {1, 2, 8};
    for (uint64_t i = 0; i < 2; i++) {
        mu_definition d = mu_definition_default();
        d.ndf = glass[i].ndf, d.alpha = glass[i].alpha, d.tilt[0] = glass[i].tilt;
        d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1, d.transform[1] = 2;
        char json[256];
        snprintf(json, sizeof json,
                 "{\"material\": \"musurf.microfacet\", %s, \"transform\": [[1, 2], [0, 1]], "
                 "\"fresnel\": {\"dielectric\": 1.5}, \"transmission\": true}",
                 glass[i].json);
        for (uint64_t k = 0; k < 3; k++) {
            const moments w = walker(&d, depths[k], 400000, 77 + 3 * i + k);
            const double truth = w.sum / w.n, noise = sqrt(fmax(w.squares / w.n - truth * truth, 0) / w.n);
            moments m = rendered(json, (uint32_t)depths[k], 1000, 1000, 100000 * (3 * i + k + 1), k == 2);
            const double mean = (m.sum / m.n - (1 - PI / 4)) / (PI / 4);
            const double own = sqrt(fmax(m.squares / m.n - pow(m.sum / m.n, 2), 0) / (m.n - 1)) / (PI / 4);
            const double z = (mean - truth) / hypot(noise, own);
            print_message("%s, depth %d: rendered %.5f, walker %.5f, z = %.2f\n", glass[i].json, depths[k],
                          mean, truth, z);
            assert_true(truth < 1 && p_of_z(z) > significance_level());
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(smooth_glass_is_invisible),
                                       cmocka_unit_test(the_index_of_air_bends_nothing),
                                       cmocka_unit_test(rough_glass_follows_the_walker)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
