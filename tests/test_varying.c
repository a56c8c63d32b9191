/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_varying.c: parameters in slots. A material whose shape comes from slots is the one of the same constants, whatever
 * of it varies and in whatever order it is composed; what cannot vary is refused by name.
 */
#include "tests/abi_host.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "plugin/musurf_map.h"

enum { CLOSURE = 4096, VIEWS = 200 };

static const musurf_material_type *microfacet(void) {
    for (int t = 0; t < ABI_TYPES; t++)
        if (!strcmp(abi_type(t)->id, "musurf.microfacet")) return abi_type(t);
    fail();
    return NULL;
}

static const musurf_map *map_of(const musurf_material_type *type) {
    const musurf_map *map = type->extension(MUSURF_MAP_ID);
    assert_non_null(map);
    return map;
}

/*
 * M is rounded to float from slots that are floats: its entries are off by 2^-23 of themselves, and |M^-1| |M| < 32 here
 * makes that at most 2^-18 of a slope. |d log D / d log slope| and the masking's are at most 2 gamma < 5 together of those
 * with tails; of Beckmann's it is 2 (tan/alpha)^2, twice the log of how far f is below its peak, which is less than 1e4
 * here. The float shading of both sides, whose plans differ, adds its own 2^-15 or so.
 */
static double bound(double f) {
    return (5 + 2 * log(1e4 / f)) * 0x1p-18 + 0x1p-15;
}

static void same(const char *constant, const char *varying, const float *slots) {
    _Alignas(64) unsigned char a[CLOSURE], b[CLOSURE], c[CLOSURE];
    const musurf_material_type *type = microfacet();
    abi_host host;
    abi_host_start(&host);
    musurf_material *one = abi_material(type, &host.host, constant),
                    *other = abi_material(type, &host.host, varying);
    if (!one || !other) fail_msg("%s | %s: %s", constant, varying, host.text);
    const musurf_plan plan = abi_plan(type, other);
    assert_true(plan.needs & MUSURF_NEEDS_SLOTS);
    const uint32_t floats = plan.slot_floats;
    assert_true(floats > 0 && floats <= 16);
    float m[4], *guarded = abi_guarded(floats * sizeof *guarded); /* reads not beyond what it says */
    memcpy(guarded, slots, floats * sizeof *guarded);
    assert_true(map_of(type)->compose(other, guarded, m));
    for (uint32_t i = 0; i < VIEWS; i++) {
        float wo[3], wi[3];
        musurf_value x, y, z;
        abi_direction(i, wo);
        abi_direction(i + 1000, wi);
        if (wo[2] < 1e-3f || wi[2] < 1e-3f) continue; /* rounding of M turns what grazes */
        assert_true(type->setup(one, wo, NULL, 0, a) != 0);
        assert_true(type->setup(other, wo, guarded, 0, b) != 0);
        assert_true(map_of(type)->setup(other, wo, m, guarded, 0, c) != 0);
        type->eval(a, wi, MUSURF_ALL_LOBES, &x);
        type->eval(b, wi, MUSURF_ALL_LOBES, &y);
        type->eval(c, wi, MUSURF_ALL_LOBES, &z);
        assert_memory_equal(&y, &z, sizeof y);
        if (!(x.f[0] > 1e-30f)) continue; /* nearly nothing: its last bits are missing */
        const double off = fabs((double)y.f[0] / (double)x.f[0] - 1);
        if (!(off <= bound((double)x.f[0])))
            fail_msg("%s: view %u, f is %g for %g, off by %g", varying, i, (double)y.f[0], (double)x.f[0],
                     off);
        assert_true(fabs((double)y.pdf / (double)x.pdf - 1) <= bound((double)x.f[0]));
    }
    abi_guarded_free(guarded, floats * sizeof *guarded);
    type->release(one);
    type->release(other);
    assert_int_equal(host.live, 0);
}

static void test_each_part_alone_and_together(void **state) {
    (void)state;
    /* alpha, roughness, alpha_x, alpha_y, rotation, stretch, transform */
    const float slots[16] = {0.25f, 0.5f, 0.125f, 0.5f, 0.75f, 0.375f, 1, 2, -0.5f, 1.5f};
    static const char *const ndfs[] = {"ggx", "beckmann", "std gamma=2.5"};
    for (size_t k = 0; k < sizeof ndfs / sizeof *ndfs; k++) {
        char one[512], other[512];
#define PAIR(a, b)                                                                                           \
    snprintf(one, sizeof one, "ndf=%s %s", ndfs[k], a),                                                      \
        snprintf(other, sizeof other, "ndf=%s %s", ndfs[k], b), same(one, other, slots)
        PAIR("alpha=0.25", "alpha=@0");
        PAIR("roughness=0.5", "roughness=@1");
        PAIR("alpha=0.25 transform=1,2,-0.5,1.5", "alpha=@0 transform=@6");
        PAIR("alpha_x=0.125 alpha_y=0.5", "alpha_x=@2 alpha_y=@3");
        PAIR("alpha_x=0.125 alpha_y=0.5 rotation=0.75", "alpha_x=@2 alpha_y=0.5 rotation=0.75");
        PAIR("alpha_x=0.125 alpha=0.25", "alpha_x=0.125 alpha=@0");
        PAIR("alpha_x=0.125 roughness=0.5", "alpha_x=@2 roughness=@1");
        PAIR("alpha_x=0.125", "alpha_x=@2");
        PAIR("alpha=0.25 stretch=0.375", "alpha=0.25 stretch=@5");
        PAIR("alpha_x=0.125 alpha_y=0.5 rotation=0.75 stretch=0.375 transform=1,2,-0.5,1.5",
             "alpha_x=@2 alpha_y=@3 rotation=@4 stretch=@5 transform=@6");
        PAIR("alpha_x=0.125 alpha_y=0.5 rotation=0.75 stretch=0.375 transform=1,2,-0.5,1.5",
             "alpha_x=0.125 alpha_y=0.5 rotation=@4 stretch=0.375 transform=1,2,-0.5,1.5");
        PAIR("alpha_x=0.125 alpha_y=0.5 rotation=0.75 stretch=0.375 transform=1,2,-0.5,1.5",
             "alpha_x=0.125 alpha_y=0.5 rotation=0.75 stretch=@5 transform=1,2,-0.5,1.5");
        PAIR("alpha=0.25 anisotropy=disney anisotropy.disney=0.8 rotation=0.75",
             "alpha=@0 anisotropy=disney anisotropy.disney=0.8 rotation=@4");
        PAIR("alpha=0.25 anisotropy=disney anisotropy.disney=0.8 rotation=0.75",
             "alpha=@0 anisotropy=disney anisotropy.disney=0.8 rotation=0.75");
#undef PAIR
    }
    same("ndf=gtr alpha=0.3 gamma=1.7 alpha_x=0.125 rotation=0.75",
         "ndf=gtr alpha=0.3 gamma=1.7 alpha_x=@2 rotation=@4", slots);
    same("ndf=phong exponent=20 alpha_x=0.125 alpha_y=0.5", "ndf=phong exponent=20 alpha_x=@2 alpha_y=@3",
         slots);
    same("ndf=sheen alpha=0.4 stretch=0.375", "ndf=sheen alpha=0.4 stretch=@5", slots);
    same("ndf=ellipsoid alpha_x=0.2 alpha_y=0.4 theta_x=0.2 theta_z=0.4 stretch=0.375",
         "ndf=ellipsoid alpha_x=0.2 alpha_y=0.4 theta_x=0.2 theta_z=0.4 stretch=@5", slots);
    same("ndf=beckmann alpha=0.25 tilt=0.2,-0.1 stretch=0.375",
         "ndf=beckmann alpha=0.25 tilt=0.2,-0.1 stretch=@5", slots);
    same("ndf=ggx alpha=0.3 alpha_x=0.125 tilt=0.2,-0.1 rotation=0.75",
         "ndf=ggx alpha=0.3 alpha_x=@2 tilt=0.2,-0.1 rotation=@4", slots);
}

static void test_what_cannot_vary(void **state) {
    (void)state;
    static const struct {
        const char *words, *param, *says;
    } wrong[] = {
        {"ndf=gtr gamma=@0", "gamma", "a constant is needed"},
        {"ndf=gtr alpha=@0", "alpha", "also changes the shape"},
        {"ndf=sheen roughness=@0", "roughness", "also changes the shape"},
        {"ndf=ggx alpha=@0 tilt=0.1,0", "alpha", "without tilt"},
        {"ndf=gtr alpha_x=@0", "alpha_x", "has to be set, constant"},
        {"ndf=ellipsoid alpha_x=@0", "alpha_x", "an ellipsoid's axes are constant"},
        {"ndf=ggx alpha=@0 anisotropy=gltf anisotropy.gltf=0.5", "alpha", "constant alpha"},
        {"ndf=flat alpha=@0", "alpha", "\"flat\" has none"},
        {"ndf=phong exponent=@0", "exponent", "a constant is needed"},
        {"fresnel=schlick fresnel.schlick=@0", "fresnel.schlick", "a constant is needed"},
        {"ndf=ggx alpha=@0 roughness=0.2", "roughness", "not both"},
    };
    const musurf_material_type *type = microfacet();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        abi_host host;
        abi_host_start(&host);
        assert_null(abi_material(type, &host.host, wrong[i].words));
        assert_int_equal(host.messages, 1);
        if (!strstr(host.text, wrong[i].says)) fail_msg("%s: %s", wrong[i].words, host.text);
        assert_string_equal(type->params[host.param - 1].name, wrong[i].param);
    }
}

/* Whatever a slot holds, answers are finite and not negative. */
static void test_no_slot_breaks_it(void **state) {
    (void)state;
    static const float odd[] = {0, -1, 1e-30f, 1e30f, 1, -0.9999999f, INFINITY, -INFINITY, NAN};
    enum { ODD = sizeof odd / sizeof *odd };
    const musurf_material_type *type = microfacet();
    musurf_material *m =
        abi_material(type, NULL, "ndf=ggx alpha_x=@0 alpha_y=@1 rotation=@2 stretch=@3 transform=@4");
    _Alignas(64) unsigned char closure[CLOSURE];
    assert_non_null(m);
    for (uint32_t i = 0; i < 4000; i++) {
        float slots[8] = {0.3f, 0.2f, 0.5f, 0.1f, 1, 0.5f, 0, 2}, wo[3], wi[3], u[3];
        slots[i % 8] = odd[i / 8 % ODD], slots[i / 72 % 8] = odd[i / 576 % ODD];
        abi_direction(i, wo), abi_direction(i + 5000, wi), abi_uniforms(i, u);
        if (!type->setup(m, wo, slots, 0, closure)) continue;
        musurf_value value;
        musurf_sample sample;
        type->eval(closure, wi, MUSURF_ALL_LOBES, &value);
        type->sample(closure, u, MUSURF_ALL_LOBES, &sample);
        assert_true(value.f[0] >= 0 && isfinite(value.f[0]) && value.pdf >= 0 && isfinite(value.pdf));
        assert_true(sample.weight[0] >= 0 && isfinite(sample.weight[0]) && sample.pdf >= 0 &&
                    isfinite(sample.pdf));
    }
    type->release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_part_alone_and_together),
        cmocka_unit_test(test_what_cannot_vary),
        cmocka_unit_test(test_no_slot_breaks_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
