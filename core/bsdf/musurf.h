/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf.h: reflection and refraction by microfacets whose microsurface is linearly transformed.
 *
 *     mu_definition d = mu_definition_default();          // GGX, alpha 0.3, identity, F = 1
 *     d.ndf = MU_GTR; d.gamma = 1.7;
 *     d.transform[0] = 5;                                 // stretched 5x along x
 *     mu_complaint why;
 *     if (!mu_definition_check(&d, &why)) ...             // why.text says what would be right
 *
 *     size_t bytes = mu_surface_bytes_f(&d);              // your memory: the library allocates nothing
 *     mu_surface_f *s = mu_surface_make_f(&d, memory);
 *     mu_closure_f c;
 *     if (mu_bind_f(s, wo, NULL, &c)) {                   // once per hit
 *         mu_eval_f(&c, wi, &value);
 *         mu_sample_wi_f(&c, u, &sample);
 *     }
 *
 * Every function exists twice, from one source: ..._f computes in float, ..._d in double.
 *
 * Frame: right-handed, +z the macrosurface normal. Directions are unit vectors pointing away from the
 * surface: wo to the viewer, wi to the light, wm the micronormal. Matrices are two rows of a 2x2 map M of
 * tangent-plane positions (Eq. 9: rows [a c], [b d]). Values and densities are per steradian; nothing here
 * includes the cosine of wi unless it says so. Equation numbers are those of Atanasov et al., Microsurface
 * Transformations (2022).
 *
 * Threads: surfaces are immutable once made; everything may be called from any thread. No global state.
 */
#ifndef MUSURF_H
#define MUSURF_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mu_ndf {
    MU_GGX,          /* Trowbridge & Reitz 1975 */
    MU_BECKMANN,     /* Gaussian slopes */
    MU_GTR,          /* generalised Trowbridge-Reitz, Burley 2012, of tail gamma */
    MU_STD,          /* Student-t distribution, Ribardiere et al. 2017, of tail gamma */
    MU_PHONG,        /* D = (n + 2) cos^n / 2 pi */
    MU_SHEEN,        /* Conty & Kulla 2017: D = (2 + 1/alpha) sin^(1/alpha) / 2 pi */
    MU_FLAT,         /* no microfacets: a mirror or a pane */
    MU_TABULATED,    /* a histogram of slopes */
    MU_DISCRETE_GGX, /* finitely many mirror-like flakes whose normals GGX scatters: Jakob et al. 2014 */
    MU_DISCRETE_BECKMANN,
    MU_NDF_COUNT,
    MU_CUSTOM = 1000 /* a distribution that is not of this library: custom_f, custom_d */
} mu_ndf;
typedef enum mu_sampler {
    MU_SAMPLE_VISIBLE, /* visible normals, Eq. (28): the exact one of every distribution */
    MU_SAMPLE_NDF,     /* D cos, Eq. (26) */
    MU_SAMPLE_MIXED, /* Appendix B: D cos, and uniform directions with probability alpha, by the balance heuristic */
    MU_SAMPLE_VISIBLE_UNIFORM, /* visible normals, and 3 of 10 directions uniform: for long tails seen from above */
    MU_SAMPLE_BOUNDED, /* of GGX, not tilted: visible normals but most of those that reflect below the horizon */
    MU_SAMPLE_FOLDED, /* visible normals; what reflects below the horizon is turned up again: no sample is lost */
    MU_SAMPLE_FOLDED_UNIFORM, /* that, and 3 of 10 directions uniform */
    MU_SAMPLER_COUNT
} mu_sampler;
typedef enum mu_smith {
    MU_SMITH_EXACT,
    MU_SMITH_SPLINE, /* of GTR, gamma in [0, 4]: Appendix A, approximate; for comparison. Needs D cos or mixed sampling */
    MU_SMITH_COUNT
} mu_smith;
typedef enum mu_masking_form {
    MU_SEPARABLE,         /* G1(wo) G1(wi) */
    MU_HEIGHT_CORRELATED, /* 1 / (1 + Lambda_o + Lambda_i) */
    MU_DIRECTION_CORRELATED, /* 1 / (1 + max Lambda + (1 - g) min Lambda), g = 1 where both come from one azimuth */
    MU_MASKING_COUNT
} mu_masking_form;
/* What becomes of light that meets the microsurface more than once. */
typedef enum mu_scattering {
    MU_SINGLE, /* it is lost: rough surfaces are too dark */
    MU_COMPENSATED, /* a smooth lobe adds what is missing, from tables of the very surface; M must be the definition's:
                       bound with an M of the point, the surface scatters singly */
    MU_RANDOM_WALK, /* light is followed on the Smith microsurface: exact, but f is an unbiased estimate, noisy */
    MU_SCATTERING_COUNT
} mu_scattering;
typedef enum mu_fresnel_kind {
    MU_FRESNEL_NONE,
    MU_FRESNEL_SCHLICK,
    MU_FRESNEL_DIELECTRIC,
    MU_FRESNEL_CONDUCTOR
} mu_fresnel_kind;

struct mu_kernel_f;
struct mu_kernel_d;

typedef struct mu_albedo_set mu_albedo_set; /* tables of a compensated surface */

/* What a surface is. Doubles whatever the precision of shading. */
typedef struct mu_definition {
    mu_ndf ndf;
    double
        alpha; /* slope roughness: >= 0, and <= 1 for GTR; 0 is a mirror. Sheen: its r, > 0. GTR with gamma in [1, 2): 0, or
                     1e-140 and more. The float functions hold widths of slopes (mu_slope_width) of 2^-30 to 2^30 */
    double gamma;        /* the tail: of GTR >= 0, of STD > 3/2; ignored by the others */
    double exponent;     /* of Phong, >= 0; ignored by the others */
    double transform[4]; /* M: the two rows; any finite, non-singular map, mirrors too */
    double tilt
        [2]; /* mean slope (dz/dx, dz/dy) of the microsurface before M; the ellipsoid's theta_x, theta_y */
    mu_sampler sampler;
    mu_masking_form masking;
    /* Of MU_TABULATED, instead of alpha: how often which slope (dz/dx, dz/dy) is met, on a grid over x_min ... x_max, y_min
     * ... y_max, row by row from y_min on, each from x_min on. P22 is constant in each cell; only proportions matter. A
     * normal m has the slope -m.xy / m.z. The mean slope adds to `tilt`. Read while a surface is made, not after. */
    const double *histogram;
    size_t histogram_columns, histogram_rows; /* 1 ... 1024 */
    double histogram_bounds[4];               /* x_min, x_max, y_min, y_max */
    mu_smith smith;
    int transmission; /* also refracts: then Fresnel must be dielectric, and the surface has two sides */
    mu_fresnel_kind fresnel;
    /* MU_CUSTOM: what a file written by distribution.h defines, compiled for float and for double; NULL: not in that
     * precision. It reads alpha, gamma and exponent as it likes. */
    const struct mu_kernel_f *custom_f;
    const struct mu_kernel_d *custom_d;
    double schlick[3]; /* reflectance at normal incidence */
    double dielectric; /* n_below / n_above */
    double n[3], k[3]; /* conductor: real index and extinction, relative to the medium above */
    /* Of the discrete distributions; without a footprint (mu_footprint) they are the smooth ones. Flakes per unit area of
     * the plane of footprints, mostly that of texture coordinates, > 0; and how far from its own normal a flake counts,
     * after M: radians, in (0, pi/2]. */
    double flake_density, flake_cone;
    uint64_t flake_seed;
    mu_scattering multiple;
    unsigned salt; /* of the random walk's hash: another salt, another noise */
    /* Of compensation: what a directional albedo of its tables may be off, 1e-4 ... 0.5: they are refined until it is kept. */
    double compensation_error;
    /* True: an M of the point scatters so, too (mu_bind), any; else singly. Of reflection by what is level, and isotropic before M, tables
     * serve, at slope roughnesses of up to 2 along its axes; beyond, and of all else, albedos are integrated while shading. Takes seconds, of tilted
     * glass up to a minute. */
    int compensation_varies;
    /* True: tables for what mu_blur makes of it, too, which take most of the time there: else a blurred closure scatters
     * singly. Level GGX of compensation_varies has them anyway; what is not level has none under an M of the point. */
    int compensation_blurs;
    /* True: the tables were made with another surface of this very definition (mu_surface_tables), of either precision, which
     * must outlive this one. Its size does not ask which. */
    int compensation_borrows;
    const mu_albedo_set *compensation_tables;
} mu_definition;

mu_definition mu_definition_default(void);

/* What is wrong with a definition. */
typedef struct mu_complaint {
    const char *field; /* member of mu_definition */
    char text[160];    /* one line: the value, and what would be right */
} mu_complaint;

/* 1 if the definition is good; otherwise 0, and why. */
int mu_definition_check(const mu_definition *definition, mu_complaint *why);
/* The least slope at which D of a checked definition bends, before M: alpha, or what stands in its place; 0 is a mirror,
 * infinite what a custom distribution does not tell. */
double mu_slope_width(const mu_definition *definition);
int mu_is_mirror(const mu_definition *definition);
/* Does the index of a dielectric that transmits differ from 1 by less than float tells? Then nothing is bent, in float and in
 * double: what passes is a delta lobe, though the microsurface masks it. */
int mu_passes_straight(const mu_definition *definition);
/* Are there flakes to be told apart? */
int mu_is_discrete(const mu_definition *definition);
/* |det M| by a fused product difference, within [DBL_MIN, DBL_MAX]; 0 for a singular map, also for one so near to it
 * (|det| < 1e-30 max²) that no direction survives, and for one that is not finite. */
double mu_transform_determinant(const double transform[4]);
/* 1 if M turns, mirrors and scales alike in all directions: to an isotropic microsurface, a scale. */
int mu_transform_is_similarity(const double transform[4]);

/* The ellipsoid distribution of Walter et al. 2014 (revised 2016), Eq. (1), by its A (three rows): it is GGX of alpha 1 under the transform and
 * the tilt written here (the family is closed under M: D_A under M is D of A M^-1). 0 if A is singular or not finite. */
int mu_ellipsoid(const double A[9], double transform[4], double tilt[2]);
/* The same under a further map M, and of mean slope `tilt` (in: what adds to its own before M acts; out: what is left to give
 * GGX). A product with what mu_ellipsoid writes is the same surface, but loses more digits where M is ill-conditioned. */
int mu_ellipsoid_under(const double A[9], const double M[4], double transform[4], double tilt[2]);
/* A = S R, their Eq. (2) and (3): roughness along the axes, then rotations in radians. */
void mu_ellipsoid_matrix(const double alpha[2], const double theta[3], double A[9]);

/* Anisotropy of others: from another system's parameters to the M under which GGX (and Beckmann) of slope roughness
 * `alpha` is exactly that system's anisotropic distribution. alpha = roughness^2 in all of them. Where no alpha is
 * asked for, M is the same for every alpha.
 *   Axes: +x the tangent (Disney's X, Cycles' T, the tangent of OpenPBR and glTF), +y the bitangent n x t.
 * `rotation` turns them counter-clockwise about +z, in radians, any finite number: the tangent points to (cos, sin)
 * then.
 *   A highlight is elongated along the axis of larger slope roughness; the grooves that cause it run across.
 *   Each returns 1 if its parameters are in range; otherwise 0, and m is not to be used. */

/* Slope roughness along the axes: M = R diag(alpha/alpha_x, alpha/alpha_y) R^T, Eq. (29) and a rotation R. Positive
 * and finite, or all three 0 (a mirror). Highlight along x where alpha_x > alpha_y. */
int mu_transform_alphas(double alpha, double alpha_x, double alpha_y, double rotation, double m[4]);

/* s of Eq. (31), in (-1, 1): s > 0 stretches the microsurface 1/(1-s) times along x and squeezes it as much along
 * y, alpha_x = alpha (1-s), alpha_y = alpha/(1-s); s < 0 the other way round. Highlight along y for s > 0. The
 * paper turns the frame instead: rotation 0. (The s = 5/2 of its Figure 8 is outside its own range.) */
int mu_transform_stretch(double s, double rotation, double m[4]);

/* `anisotropic` in [0, 1] of Burley 2012, "Physically-Based Shading at Disney", addenda, and BRDF Explorer's
 * disney.brdf: aspect = sqrt(1 - 0.9 anisotropic), alpha_x = alpha/aspect, alpha_y = alpha aspect. Highlight along
 * x. (disney.brdf keeps both from falling below 0.001; here they may.)
 *   Blender's Principled BSDF is the same (4.3, Cycles' kernel/svm/closure.h, CLOSURE_BSDF_PRINCIPLED_ID): rotation
 * = 2 pi times its Anisotropic Rotation. */
int mu_transform_disney(double anisotropic, double rotation, double m[4]);

/* Anisotropy in [-1, 1] of Cycles' Anisotropic BSDF, since Blender 4.0 the Glossy BSDF (4.3, kernel/svm/closure.h,
 * CLOSURE_BSDF_MICROFACET_GGX_ID): clamped to [-0.99, 0.99] as there; then alpha_x = alpha (1-a), alpha_y =
 * alpha/(1-a) for a >= 0, alpha_x = alpha/(1+a), alpha_y = alpha (1+a) for a < 0, which is Eq. (31) with s = a.
 * Highlight ACROSS the tangent, along y, for a > 0: opposite to Principled. rotation = 2 pi times its Rotation.
 * (Cycles takes |a| <= 1e-4 for 0; this does not.) */
int mu_transform_cycles(double anisotropy, double rotation, double m[4]);

/* specular_roughness_anisotropy (or coat_roughness_anisotropy) a in [0, 1) of OpenPBR 1.1, "Microfacet model":
 * alpha_x = alpha sqrt(2/(1 + (1-a)^2)), alpha_y = (1-a) alpha_x, so that alpha_x^2 + alpha_y^2 = 2 alpha^2.
 * Highlight along x; `rotation` is that of geometry_tangent. OpenPBR allows a = 1, where alpha_y = 0: no M does
 * that. */
int mu_transform_openpbr(double anisotropy, double rotation, double m[4]);

/* anisotropyStrength in [0, 1] and anisotropyRotation of glTF 2.0's KHR_materials_anisotropy (ratified),
 * "Anisotropy": alpha_x = mix(alpha, 1, strength^2), alpha_y = alpha, in (0, 1] (or 0 with strength 0). Highlight
 * along x. Where a texture says (r, g, b), `strength` is that times b and `rotation` that plus atan2(2g-1, 2r-1). */
int mu_transform_gltf(double alpha, double strength, double rotation, double m[4]);

/* The covariance [xx xy; xy yy], symmetric and positive definite, of the slopes (dz/dx, dz/dy): Sigma of Cocco et
 * al. 2024, "Anisotropic specular image-based lighting based on BRDF major axis sampling", section 4.1, with its
 * sigma = alpha/sqrt(2): Sigma = alpha^2/2 (M M^T)^-1, alpha > 0, M symmetric. The true covariance for Beckmann; a
 * way to write alpha^2/2 for GGX, whose own is infinite. Highlight along the eigenvector of the larger eigenvalue.
 * Squares cost digits: Sigma of condition k knows its smaller eigenvalue to no more than k units in the last place. */
int mu_transform_covariance(double alpha, double xx, double xy, double yy, double rotation, double m[4]);

/* And back: the slope roughnesses of a surface of isotropic roughness alpha under M, by singular value
 * decomposition. A rotation or a mirror on the right of M moves no isotropic surface and is dropped. Always alpha_x
 * >= alpha_y (highlight along x), rotation in (-pi/2, pi/2], and 0 where M is isotropic to within rounding.
 * mu_transform_alphas takes the result to an M' with M' M'^T = M M^T. 0 if M is singular or not finite. */
typedef struct mu_anisotropy {
    double alpha_x, alpha_y, rotation;
} mu_anisotropy;
int mu_transform_anisotropy(const double transform[4], double alpha, mu_anisotropy *out);

/* n and k of a metal at three wavelengths, by chemical symbol; 0 if it is not known. The names,
 * NULL-terminated. */
int mu_metal(const char *symbol, double n[3], double k[3]);
extern const char *const mu_metal_names[];

/* L of albedo.h and its inverse, |det L|, b/a, B/A (but for what is round, at most), and -ln(B/A); max(A, 1), min(B, 1), and ln
 * of their quotient. */
typedef struct mu_albedo_frame {
    float to[4], from[4], det, k, ratio, log;
    float steep, smooth, span;
} mu_albedo_frame;
/* The tables that say what a closure of a compensated surface loses (albedo_set.h), in order to be mixed. */
typedef struct mu_lobe {
    const struct mu_albedo *level[4];
    float share[4];
    mu_albedo_frame frame; /* the closure's */
    const mu_albedo_set *set;
    float blur; /* of mu_blur; or 0 */
    int open;   /* between two tables that are too far apart */
    int moved;  /* its M is R(turn) `transform`, cosine and sine of `turn`, and none of the definition's */
    float transform[4], turn[2]; /* where it is integrated */
    float average[2], passes[2];
    float lost, density; /* of wo: the lobe's own density of it */
    float repeated[3];   /* what F leaves of light that was reflected twice or more */
    int count;           /* 0: no table says how it lies; it is integrated */
} mu_lobe;

#define MU_REAL       float
#define MU_SUFFIX(id) id##_f
#include "musurf_real.h"
#undef MU_REAL
#undef MU_SUFFIX
#define MU_REAL       double
#define MU_SUFFIX(id) id##_d
#include "musurf_real.h"
#undef MU_REAL
#undef MU_SUFFIX

#ifdef __cplusplus
}
#endif
#endif
