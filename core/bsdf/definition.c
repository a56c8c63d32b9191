/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* definition.c: what a surface may be, and what to say when it may not. */
#include "core/bsdf/real.h"
#include "core/bsdf/tabulated.h"
#include <stdio.h>

#if MU_REAL_BITS == 53

mu_definition mu_definition_default(void) {
    return (mu_definition){
        .ndf = MU_GGX,
        .alpha = 0.3,
        .gamma = 2,
        .exponent = 10,
        .transform = {1, 0, 0, 1},
        .masking = MU_HEIGHT_CORRELATED,
        .schlick = {1, 1, 1},
        .dielectric = 1.5,
        .n = {0.06, 0.06, 0.05},
        .k = {4.152, 3.586, 2.869},
        .flake_density = 1e6,
        .flake_cone = 0.02,
        .compensation_error = 0.01,
    };
}

static int complain(mu_complaint *why, const char *field, double x, const char *right) {
    why->field = field;
    snprintf(why->text, sizeof why->text, "%.9g is out of range: %s", x, right);
    return 0;
}

static int refuse(mu_complaint *why, const char *field, const char *text) {
    why->field = field;
    snprintf(why->text, sizeof why->text, "%s", text);
    return 0;
}

static int check_fresnel(const mu_definition *d, mu_complaint *why) {
    for (int i = 0; i < 3; i++) {
        if (d->fresnel == MU_FRESNEL_SCHLICK && !(d->schlick[i] >= 0 && d->schlick[i] <= 1))
            return complain(why, "schlick", d->schlick[i], "a reflectance lies in [0, 1]");
        if (d->fresnel != MU_FRESNEL_CONDUCTOR) continue;
        if (!(d->n[i] > 0 && d->n[i] <= 1000))
            return complain(why, "n", d->n[i], "an index of refraction lies in (0, 1000]");
        if (!(d->k[i] >= 0 && d->k[i] <= 1000))
            return complain(why, "k", d->k[i], "an extinction lies in [0, 1000]");
    }
    if (d->fresnel == MU_FRESNEL_DIELECTRIC && !(d->dielectric >= 1e-3 && d->dielectric <= 1e3))
        return complain(why, "dielectric", d->dielectric, "n_below/n_above lies in [0.001, 1000]");
    return 1;
}

static int check_transmission(const mu_definition *d, mu_complaint *why) {
    if (!d->transmission) return 1;
    if (d->fresnel != MU_FRESNEL_DIELECTRIC)
        return refuse(why, "transmission",
                      "true needs a dielectric: fresnel says how much passes, and how far it bends");
    if (d->sampler != MU_SAMPLE_VISIBLE)
        return refuse(why, "transmission",
                      "true needs the visible sampler: the others know reflection alone");
    return 1;
}

static int check_histogram(const mu_definition *d, mu_complaint *why) {
    const size_t sides[2] = {d->histogram_columns, d->histogram_rows};
    const double *b = d->histogram_bounds;
    if (!d->histogram) return refuse(why, "histogram", "tabulated needs a histogram of slopes");
    for (int i = 0; i < 2; i++) {
        const double low = b[2 * i], high = b[2 * i + 1];
        if (!(sides[i] >= 1 && sides[i] <= TABULATED_MOST))
            return complain(why, "histogram", (double)sides[i], "a side has from 1 to 1024 cells");
        if (!(fabs(low) <= 1e30 && fabs(high) <= 1e30 && high > low))
            return complain(why, "histogram", high,
                            "bounds are at most 1e30, and the upper one is the larger");
        /* else not even a double could tell the cells apart */
        if (!((high - low) / (double)sides[i] >= fmax(1e-30, 1e-12 * fmax(fabs(low), fabs(high)))))
            return complain(why, "histogram", (high - low) / (double)sides[i],
                            "a cell is at least 1e-30 wide, and 1e-12 of the largest slope");
    }
    double largest = 0;
    for (size_t i = 0; i < sides[0] * sides[1]; i++) {
        if (!(d->histogram[i] >= 0 && d->histogram[i] <= DBL_MAX))
            return complain(why, "histogram", d->histogram[i], "a weight is finite and at least 0");
        largest = fmax(largest, d->histogram[i]);
    }
    return largest > 0 ? 1 : refuse(why, "histogram", "all weights are 0: one at least must be larger");
}

static int check_multiple(const mu_definition *d, mu_complaint *why) {
    if (d->multiple == MU_COMPENSATED && !(d->compensation_error >= 1e-4 && d->compensation_error <= 0.5))
        return complain(why, "compensation_error", d->compensation_error,
                        "an albedo is off by 0.0001 to 0.5");
    const char *right = NULL;
    if (d->multiple != MU_SINGLE && mu_is_mirror(d) && (d->tilt[0] != 0 || d->tilt[1] != 0)) {
        right = "a tilted mirror scatters singly: what it loses has no table, and no walk of one normal ends";
    } else if (d->multiple == MU_RANDOM_WALK && d->masking != MU_HEIGHT_CORRELATED) {
        right = "a random walk needs height-correlated masking: that is the walk's own";
    } else if (d->multiple == MU_RANDOM_WALK &&
               (d->ndf == MU_DISCRETE_GGX || d->ndf == MU_DISCRETE_BECKMANN)) {
        right = "a random walk knows no flakes: compensated does";
    } else if (d->multiple == MU_RANDOM_WALK && d->sampler != MU_SAMPLE_VISIBLE) {
        right = "a random walk needs the visible sampler: it meets visible normals";
    } else if (d->multiple == MU_COMPENSATED && d->ndf == MU_CUSTOM && !d->custom_f) {
        right = "compensated needs custom_f: its tables are made in float";
    }
    return right ? refuse(why, "multiple", right) : 1;
}

/* Members that the library uses as indices. */
static int check_choices(const mu_definition *d, mu_complaint *why) {
    const struct {
        const char *field;
        int value, count;
    } choices[] = {{"ndf", (int)d->ndf, d->ndf == MU_CUSTOM ? MU_CUSTOM + 1 : MU_NDF_COUNT},
                   {"sampler", (int)d->sampler, MU_SAMPLER_COUNT},
                   {"masking", (int)d->masking, MU_MASKING_COUNT},
                   {"smith", (int)d->smith, MU_SMITH_COUNT},
                   {"multiple", (int)d->multiple, MU_SCATTERING_COUNT},
                   {"fresnel", (int)d->fresnel, MU_FRESNEL_CONDUCTOR + 1}};
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++)
        if (choices[i].value < 0 || choices[i].value >= choices[i].count)
            return complain(why, choices[i].field, choices[i].value, "is none of its enumeration");
    return 1;
}

/* The squared tilt, in units of the slope roughness, is a number. */
static int check_tilt(const mu_definition *d, mu_complaint *why) {
    const double width = mu_slope_width(d);
    const double unit =
        width == 0 || (d->ndf == MU_GTR && d->gamma < 1) ? 1 : width; /* flat.c, gtr_shape.h */
    for (int i = 0; i < 2; i++) {
        if (!(fabs(d->tilt[i]) <= DBL_MAX))
            return complain(why, "tilt", d->tilt[i], "a mean slope is finite");
        if (fabs(d->tilt[i]) > 1e140 * unit)
            return complain(
                why, "tilt", d->tilt[i],
                "a mean slope is at most 1e140 times the slope roughness (a mirror's: 1e140), or 0");
    }
    return 1;
}

/* Appendix A is of GTR, between its integers. Its masking does not normalise the visible normals that it would draw. */
static int check_smith(const mu_definition *d, mu_complaint *why) {
    if (d->smith != MU_SMITH_SPLINE) return 1;
    if (d->ndf == MU_GTR && d->gamma > 4)
        return complain(why, "gamma", d->gamma,
                        "the spline of Appendix A ends at 4, where smith must be exact");
    const int samples = d->sampler == MU_SAMPLE_NDF || d->sampler == MU_SAMPLE_MIXED;
    if (d->ndf == MU_GTR && d->multiple == MU_SINGLE && samples && !d->transmission) return 1;
    return refuse(why, "smith",
                  d->multiple != MU_SINGLE ? "spline knows single scattering alone"
                  : d->transmission        ? "spline knows reflection alone"
                  : d->ndf != MU_GTR
                      ? "spline approximates gtr alone: the masking of this distribution is exact"
                      : "spline needs the sampler ndf or mixed: visible normals are those of exact masking");
}

static int check_sampler(const mu_definition *d, mu_complaint *why) {
    if (d->sampler != MU_SAMPLE_BOUNDED) return 1;
    if (d->ndf != MU_GGX) return refuse(why, "sampler", "bounded is known of ggx alone");
    if (d->tilt[0] != 0 || d->tilt[1] != 0)
        return refuse(why, "sampler", "bounded needs a microsurface without tilt");
    return 1;
}

/* Of GTR with gamma in [1, 2), whose tail has weight at slopes near 1 however small alpha is (as 1 / ln alpha): is alpha so small,
 * against M too, that map_make cannot hold slopes in units of it? It can down to 2^-500; the rest is for an M of the point. */
static int vanishes(const mu_definition *d) {
    const double scale = sqrt(mu_transform_determinant(d->transform));
    return d->gamma >= 1 && d->gamma < 2 && d->alpha > 0 && d->alpha < 1e-140 * fmax(scale, 1);
}

int mu_definition_check(const mu_definition *d, mu_complaint *why) {
    if (!check_choices(d, why)) return 0;
    if (d->ndf == MU_TABULATED && !check_histogram(d, why)) return 0;
    if (!(d->alpha >= 0 && d->alpha <= DBL_MAX))
        return complain(why, "alpha", d->alpha, "a slope roughness is finite and at least 0");
    if (d->ndf == MU_CUSTOM && !d->custom_f && !d->custom_d)
        return refuse(why, "custom_f", "custom_f or custom_d is needed where ndf is MU_CUSTOM");
    if (d->ndf == MU_GTR && d->alpha > 1)
        return complain(why, "alpha", d->alpha, "gtr is defined for alpha in [0, 1]");
    if (d->ndf == MU_GTR && !(d->gamma >= 0 && d->gamma <= DBL_MAX))
        return complain(why, "gamma", d->gamma, "gtr is defined for finite gamma of at least 0");
    if (d->ndf == MU_GTR && vanishes(d))
        return complain(why, "alpha", d->alpha,
                        "gtr of gamma in [1, 2) needs 0, or at least 1e-140 times the scale of M, or 1e-140");
    if (d->ndf == MU_STD && !(d->gamma > 1.5 && d->gamma <= DBL_MAX))
        return complain(why, "gamma", d->gamma, "std is defined for finite gamma above 1.5");
    if (d->ndf == MU_SHEEN && d->alpha == 0)
        return complain(why, "alpha", 0, "sheen is defined for alpha above 0");
    if (d->ndf == MU_PHONG && !(d->exponent >= 0 && d->exponent <= DBL_MAX))
        return complain(why, "exponent", d->exponent, "phong is defined for finite exponents of at least 0");
    if (d->ndf == MU_DISCRETE_GGX || d->ndf == MU_DISCRETE_BECKMANN) {
        if (!(d->flake_density > 0 && d->flake_density <= DBL_MAX))
            return complain(why, "flake_density", d->flake_density, "finite, and above 0");
        if (!(d->flake_cone > 0 && d->flake_cone <= PI / 2))
            return complain(why, "flake_cone", d->flake_cone, "an angle in (0, pi/2]");
    }
    if (!check_tilt(d, why)) return 0;
    if (mu_transform_determinant(d->transform) == 0) {
        const double *m = d->transform;
        why->field = "transform";
        snprintf(why->text, sizeof why->text,
                 "[[%.9g, %.9g], [%.9g, %.9g]] is singular or not finite: M must be invertible, its "
                 "condition at most 1e30",
                 m[0], m[1], m[2], m[3]);
        return 0;
    }
    return check_fresnel(d, why) && check_smith(d, why) && check_transmission(d, why) &&
           check_multiple(d, why) && check_sampler(d, why);
}

#endif
