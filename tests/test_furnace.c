/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_furnace.c: the renderer's white furnace. A sphere with F = 1 under a skewed M in a constant
 * environment loses exactly the energy that single scattering loses: the image's mean is predicted by
 * quadrature of f cos, in double, through the probe, which shares neither the sampler nor the integrator.
 * Random comparisons: 3 x 3.
 *
 * Seen along the pole axis, the viewer stands in the meridian plane: wo = (0, sin, cos) in the sphere's
 * frames. Seen from +x over the equator, at longitude l and latitude b, wo = (-sin l, -sin b cos l, cos b cos
 * l).
 */
#include "plugin/musurf_probe.h"
#include "tests/path_fixture.h"

#include <stdio.h>

#define PI 3.14159265358979323846

static const double skew[4] = {1, 2, 0, 1}; /* rows [a c], [b d] of (a, b, c, d) = (1, 0, 2, 1) */

typedef struct furnace_subject {
    const char *name, *json;
    double alpha; /* scale of the slopes: only places the nodes */
} furnace_subject;

static const furnace_subject subjects[] = {
    {"ggx",
     "{\"material\": \"musurf.microfacet\", \"ndf\": \"ggx\", \"alpha\": 0.4, \"fresnel\": \"none\", "
     "\"transform\": [[1, 2], [0, 1]]}",
     0.4},
    {"beckmann",
     "{\"material\": \"musurf.microfacet\", \"ndf\": \"beckmann\", \"alpha\": 0.5, \"fresnel\": \"none\", "
     "\"transform\": [[1, 2], [0, 1]]}",
     0.5},
    {"gtr",
     "{\"material\": \"musurf.microfacet\", \"ndf\": \"gtr\", \"alpha\": 0.3, \"gamma\": 1.7, \"fresnel\": "
     "\"none\", \"transform\": [[1, 2], [0, 1]]}",
     0.3},
};

/* Gauss-Legendre on [0, 1], 8 nodes (Abramowitz and Stegun, table 25.4). */
static const double node[8] = {0.01985507175123188, 0.10166676129318664, 0.2372337950418355,
                               0.4082826787521751,  0.5917173212478249,  0.7627662049581645,
                               0.8983332387068134,  0.9801449282487681};
static const double weight[8] = {0.05061426814518813, 0.11119051722668724, 0.15685332293894364,
                                 0.18134189168918100, 0.18134189168918100, 0.15685332293894364,
                                 0.11119051722668724, 0.05061426814518813};

/* Directional albedo, integrated over the slopes (s of the original, M^-T s of the transformed surface) of
 * the micronormals that reflect wo = (o, z) upwards: z |s_m|^2 + 2 s_m.o < z, so up to a known distance r
 * along each azimuth. r = alpha tan psi; Gauss's rule in psi, in panels, and the trapezoidal rule in azimuth.
 * The integrand is smooth within, tails and horizon included, so both converge fast. */
static double albedo(const mu_material *material, const musurf_probe *probe, double alpha, const double wo[3],
                     int panels) {
    const double det = skew[0] * skew[3] - skew[1] * skew[2];
    const int azimuths = 32 * panels;
    double sum = 0;
    for (int j = 0; j < azimuths; j++) {
        const double phi = 2 * PI * (j + 0.5) / azimuths, s[2] = {alpha * cos(phi), alpha * sin(phi)};
        const double slope[2] = {(skew[3] * s[0] - skew[2] * s[1]) / det,
                                 (skew[0] * s[1] - skew[1] * s[0]) / det};
        const double along = slope[0] * wo[0] + slope[1] * wo[1],
                     squared = slope[0] * slope[0] + slope[1] * slope[1];
        const double reach = wo[2] / (along + sqrt(along * along + wo[2] * wo[2] * squared));
        const double most = atan(reach);
        for (int i = 0; i < 8 * panels; i++) {
            const double psi = most * (node[i % 8] + i / 8) / panels, r = tan(psi);
            const double cosine = 1 / sqrt(1 + r * r * squared);
            const double wm[3] = {-r * slope[0] * cosine, -r * slope[1] * cosine, cosine};
            const double k = wo[0] * wm[0] + wo[1] * wm[1] + wo[2] * wm[2];
            const double wi[3] = {2 * k * wm[0] - wo[0], 2 * k * wm[1] - wo[1], 2 * k * wm[2] - wo[2]};
            if (wi[2] <= 0) continue; /* rounding at the very edge */
            musurf_probe_values values;
            assert_int_equal(probe->evaluate(material->compiled, MUSURF_DOUBLE, wo, NULL, wi, &values),
                             MUSURF_OK);
            /* d omega_i = 4 k d omega_m, d omega_m = cos^3 d^2 s_m, d^2 s_m = alpha^2 / |det| r dr dphi */
            sum += weight[i % 8] * most / panels * values.f[0] * wi[2] * 4 * k * cosine * cosine * cosine *
                   r * (1 + r * r);
        }
    }
    return sum * alpha * alpha / fabs(det) * 2 * PI / azimuths;
}

/* Mean over the disc that the sphere fills, seen along the pole: 2 mu dmu, in two panels. */
static double mean_from_pole(const mu_material *material, const musurf_probe *probe, double alpha,
                             int panels) {
    double sum = 0;
    for (int i = 0; i < 16; i++) {
        const double mu = (node[i % 8] + i / 8) / 2, wo[3] = {0, sqrt(1 - mu * mu), mu};
        sum += weight[i % 8] / 2 * 2 * mu * albedo(material, probe, alpha, wo, panels);
    }
    return sum;
}

/* From +x: cos b cos l cos b db dl / pi; (l, b) and (-l, -b) turn wo half about the normal, which M does not
 * see. */
static double mean_from_equator(const mu_material *material, const musurf_probe *probe, double alpha,
                                int panels) {
    double sum = 0;
    for (int i = 0; i < 16; i++)
        for (int j = 0; j < 8; j++) {
            const double l = PI / 2 * (node[i % 8] + i / 8 - 1), b = PI / 2 * node[j];
            const double wo[3] = {-sin(l), -sin(b) * cos(l), cos(b) * cos(l)};
            sum += weight[i % 8] * weight[j] * PI / 2 * PI / 2 * 2 * cos(b) * cos(l) * cos(b) / PI *
                   albedo(material, probe, alpha, wo, panels);
        }
    return sum;
}

/* Where the sphere is seen from, and how finely its mean is predicted: what doubling the nodes changes bounds
 * what is left. A sphere does not see itself, so longer paths change nothing. */
typedef struct furnace_view {
    mu_vec3 from, up;
    double (*mean)(const mu_material *, const musurf_probe *, double, int);
    int panels;
} furnace_view;

static void furnace(const furnace_subject *subject, const furnace_view *view, const uint32_t *depths,
                    int count, uint64_t seed) {
    path_fixture f;
    fixture_start(&f, 8);
    const uint32_t index = fixture_material(&f, subject->json);
    fixture_sphere(&f, 1, index);
    fixture_light(&f, (mu_light){.kind = MU_CONSTANT, .scale = {1, 1, 1}});
    fixture_look(&f, view->from, view->up);
    fixture_ready(&f);
    const mu_material *material = &f.materials[index].material;
    const musurf_probe *probe = material->type->extension(MUSURF_PROBE_ID);
    assert_non_null(probe);
    const double coarse = view->mean(material, probe, subject->alpha, view->panels);
    const double fine = view->mean(material, probe, subject->alpha, 2 * view->panels),
                 slack = fabs(fine - coarse);
    print_message("%s loses %.5f of the sphere's light, +- %.1e\n", subject->name, 1 - fine, slack);
    assert_true(slack < 3e-4 && fine < 0.9); /* or nothing would be tested */
    for (int i = 0; i < count; i++) {
        f.scene.integrator.depth = depths[i];
        const moments m = fixture_mean(&f, &(mu_path_options){0}, seed + 600000 * (uint64_t)i, 2000, 8);
        /* Around the sphere's disc, pi / 4 of the picture, the environment is seen. */
        agrees(&m, PI / 4 * fine + 1 - PI / 4, PI / 4 * slack, "    mean");
    }
    fixture_end(&f);
}

static void test_from_the_pole(void **state) {
    (void)state;
    const furnace_view view = {{0, 0, 1}, {0, 1, 0}, mean_from_pole, 2};
    const uint32_t depths[2] = {1, 8};
    for (uint64_t i = 0; i < 3; i++) furnace(&subjects[i], &view, depths, 2, 100000 * (i + 1));
}

static void test_from_the_equator(void **state) {
    (void)state;
    const furnace_view view = {{1, 0, 0}, {0, 0, 1}, mean_from_equator, 1};
    const uint32_t depths[1] = {1};
    for (uint64_t i = 0; i < 3; i++) furnace(&subjects[i], &view, depths, 1, 100000 * (i + 4));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_from_the_pole),
        cmocka_unit_test(test_from_the_equator),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
