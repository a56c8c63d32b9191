/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_below.c: visible normals of tilted microsurfaces that lean away from the viewer, who sees their mean plane
 * from below: chi^2 of the samples against D max(0, wo.m) / sigma. Random comparisons: 48.
 *
 * From w = (r, 0, z) of the untilted microsurface, z < 0, slopes s with s.x > c = -z/r are visible, the more often the
 * steeper they are. The cells are quantiles in s.x of what the core's own D says, integrated over s.y and s.x here, by
 * the trapezoidal rule in log radius and angle, where it converges exponentially.
 */
#include "tests/bsdf_fixture.h"
#include "tests/significance.h"

#include <stdlib.h>

static const struct {
    mu_ndf ndf;
    double alpha, gamma, exponent;
} families[] = {{MU_GGX, 0.3, 2, 0},   {MU_BECKMANN, 0.3, 2, 0}, {MU_GTR, 0.2, 0.5, 0},
                {MU_GTR, 0.2, 1.7, 0}, {MU_GTR, 0.1, 4.5, 0},    {MU_STD, 0.3, 1.7, 0},
                {MU_STD, 0.3, 2.5, 0}, {MU_STD, 0.3, 12, 0},     {MU_PHONG, 1, 2, 0},
                {MU_PHONG, 1, 2, 60},  {MU_SHEEN, 0.3, 2, 0},    {MU_SHEEN, 0.05, 2, 0}};
enum { FAMILIES = sizeof families / sizeof families[0], RINGS = 16, WEDGES = 8, SAMPLES = 20000 };

/* Where a slope lies: in rings about the lowest visible one, in units of `size`, and wedges. */
static int cell_of(const double at[2], double size) {
    const double ring = RINGS / 2 + 2 * log(hypot(at[0], at[1]) / size),
                 wedge = (atan2(at[1], at[0]) / TEST_PI + 0.5) * WEDGES;
    const int i = ring < 0 ? 0 : ring >= RINGS ? RINGS - 1 : (int)ring, j = wedge < 0 ? 0 : (int)wedge;
    return i * WEDGES + (j >= WEDGES ? WEDGES - 1 : j);
}

/* The normal of slope `lowest` + r (cos phi along `e`, sin phi across). */
static double normal_at(const double lowest[2], const double e[2], double r, double phi, double m[3]) {
    const double x = r * cos(phi), y = r * sin(phi);
    const double p[2] = {lowest[0] + e[0] * x - e[1] * y, lowest[1] + e[1] * x + e[0] * y};
    m[2] = 1 / sqrt(1 + p[0] * p[0] + p[1] * p[1]);
    m[0] = -p[0] * m[2], m[1] = -p[1] * m[2];
    return m[2] * m[2] * m[2]; /* solid angle per area of slopes */
}

static double chi2_of(const mu_closure_d *c, const double tilt[2], double size, uniform *u) {
    /* visible: wo.m > 0, slopes with p.wo_xy < wo.z; the one on the edge nearest to the mean, and outward from there */
    const double flat = hypot(c->wo[0], c->wo[1]), e[2] = {-c->wo[0] / flat, -c->wo[1] / flat};
    const double off = (tilt[0] * c->wo[0] + tilt[1] * c->wo[1] - c->wo[2]) / flat;
    assert_true(off > 0); /* seen from below */
    const double lowest[2] = {tilt[0] + e[0] * off, tilt[1] + e[1] * off};
    double expected[RINGS * WEDGES] = {0}, seen[RINGS * WEDGES] = {0}, total = 0;
    const double step = 1. / 16;
    for (double s = -24 + step / 2; s < 160; s += step)
        for (int j = 0; j < 24 * WEDGES; j++) {
            const double phi = TEST_PI * ((j + 0.5) / (24 * WEDGES) - 0.5), r = size * exp(s);
            double m[3];
            const double area = normal_at(lowest, e, r, phi, m) * r * r * step * TEST_PI / (24 * WEDGES);
            const double mass = mu_normal_d(c, m).Dv * area, at[2] = {r * cos(phi), r * sin(phi)};
            expected[cell_of(at, size)] += mass, total += mass;
        }
    bsdf_near(total, 1, 2e-3); /* midpoints meet the edges of the half circle; the counts below are coarser */
    for (int n = 0; n < SAMPLES; n++) {
        const double three[3] = {uniform_double(u), uniform_double(u), uniform_double(u)};
        mu_sample_d s;
        mu_sample_with_d(c, MU_SAMPLE_VISIBLE, three, &s);
        if (!(s.wm[2] > 0)) return 0; /* there is a normal */
        const double p[2] = {-s.wm[0] / s.wm[2] - lowest[0], -s.wm[1] / s.wm[2] - lowest[1]};
        const double at[2] = {p[0] * e[0] + p[1] * e[1], p[1] * e[0] - p[0] * e[1]};
        assert_true(at[0] > -1e-9 * (size + off));
        seen[cell_of(at, size)]++;
    }
    double chi2 = 0, freedom = -1, few = 0, few_seen = 0;
    for (int i = 0; i < RINGS * WEDGES; i++) {
        const double n = expected[i] / total * SAMPLES;
        if (n < 8) {
            few += n, few_seen += seen[i];
            continue;
        }
        chi2 += (seen[i] - n) * (seen[i] - n) / n, freedom++;
    }
    if (few >= 8)
        chi2 += (few_seen - few) * (few_seen - few) / few, freedom++;
    else
        assert_true(few_seen < 60);
    return p_of_chi2(chi2, freedom);
}

static void visible_normals_from_below(void **state) {
    (void)state;
    uniform u = {20261126};
    static const double depths[4] = {0.3, 1, 2, 3.5}; /* c in units of the lobe's width */
    for (int i = 0; i < FAMILIES; i++)
        for (int k = 0; k < 4; k++) {
            mu_definition d = mu_definition_default();
            d.ndf = families[i].ndf, d.alpha = families[i].alpha, d.gamma = families[i].gamma;
            d.exponent = families[i].exponent;
            const double width = d.ndf == MU_PHONG   ? sqrt(2 / (d.exponent + 2))
                                 : d.ndf == MU_SHEEN ? sqrt(1 + 0.5 / d.alpha)
                                                     : d.alpha;
            const double cosine = 0.35, azimuth = 0.7 + i;
            double wo[3];
            bsdf_direction(cosine, azimuth, wo);
            const double lean =
                cosine / sqrt(1 - cosine * cosine) + depths[k] * width; /* w.z = -depth width flat */
            d.tilt[0] = lean * cos(azimuth), d.tilt[1] = lean * sin(azimuth);
            bsdf b;
            bsdf_bind_double(&b, &d, wo);
            const double p = chi2_of(&b.d, d.tilt, width / (1 + depths[k]), &u);
            if (!(p > significance_level())) fail_msg("family %d, depth %g: p = %g", i, depths[k], p);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(visible_normals_from_below)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
