/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_parameters.c: the one home of name, kind, range, default, unit and documentation of every parameter.
 * Ids are never reused. Eq. (31) is that of Atanasov et al., Microsurface Transformations (2022).
 */
#include <math.h>

#include "plugin/musurf_parameters.h"

static const char *const ndf_choices[] = {
    "ggx",          "beckmann",          "gtr", "std", "phong", "sheen", "flat", "ellipsoid", "tabulated",
    "discrete_ggx", "discrete_beckmann", NULL};
static const char *const anisotropy_choices[] = {"none", "disney",     "cycles", "openpbr",
                                                 "gltf", "covariance", NULL};
static const char *const masking_choices[] = {"separable", "height_correlated", "direction_correlated", NULL};
static const char *const fresnel_choices[] = {"none", "schlick", "dielectric", "conductor", NULL};
static const char *const conductor_choices[] = {"Ag", "Al", "Au", "Cr", "Cu", "custom", NULL};
static const char *const smith_choices[] = {"exact", "spline", NULL};
static const char *const sampler_choices[] = {
    "visible", "ndf", "mixed", "visible_uniform", "bounded", "folded", "folded_uniform", "auto", NULL};
static const char *const multiple_choices[] = {"none", "compensated", "random_walk", NULL};

#define HEAD(id, name, label)    sizeof(musurf_param), id, name, label
#define NUMBERS                  NULL, NULL
#define CHOICE(initial, choices) "", MUSURF_CHOICE, 0, 0, 0, 0, 0, {0}, initial, choices
#define VALUES(unit, kind, flags, min, max, soft_min, soft_max, ...)                                         \
    unit, kind, flags, min, max, soft_min, soft_max, {__VA_ARGS__}, NUMBERS
#define SCALAR(unit, ...) VALUES(unit, MUSURF_NUMBER, __VA_ARGS__)

const musurf_param musurf_parameters[PARAMETER_COUNT] = {
    {HEAD(1, "ndf", "Distribution"),
     "Distribution of microfacet normals: ggx, beckmann; gtr and std (Student-t), whose tail is gamma; "
     "phong, by its exponent; sheen (cloth), whose alpha is its r; ellipsoid, which may be tilted; flat: a "
     "mirror or a pane; tabulated: any slopes, by histogram; discrete_ggx and discrete_beckmann: flakes.",
     CHOICE("ggx", ndf_choices)},
    {HEAD(2, "alpha", "Slope roughness"),
     "Slope roughness of the untransformed microsurface; 0 is a mirror. At most 1 for gtr. Set this or "
     "roughness. It may vary (1e-6 and more) for ggx, beckmann, std and the discrete ones without tilt.",
     SCALAR("", MUSURF_MAY_VARY, 0, INFINITY, 0, 1, 0.3)},
    {HEAD(3, "roughness", "Roughness"), "Perceptual roughness: alpha is its square. Set this or alpha.",
     SCALAR("", MUSURF_MAY_VARY, 0, INFINITY, 0, 1, 0.54772255750516612)},
    {HEAD(4, "gamma", "Tail"),
     "Tail of gtr (0 is the longest, 1 Berry's; then alpha is 0 or at least 1e-140) and of std (above 1.5): "
     "2 equals "
     "ggx, larger is shorter. An error with other distributions.",
     SCALAR("", 0, 0, INFINITY, 0, 10, 2)},
    {HEAD(5, "transform", "Transform"),
     "Linear map M of tangent-plane positions that deforms the microsurface: rows [a c], [b d]; any "
     "invertible map, of condition up to 1e30.",
     VALUES("", MUSURF_MATRIX, MUSURF_MAY_VARY, -INFINITY, INFINITY, -5, 5, 1, 0, 0, 1)},
    {HEAD(6, "stretch", "Stretch"),
     "Area-preserving stretch s of the microsurface: diag(1/(1-s), 1-s) for s >= 0, diag(1+s, 1/(1+s)) "
     "below; applied after anisotropy and before transform.",
     SCALAR("", MUSURF_MAY_VARY | MUSURF_MIN_EXCLUDED | MUSURF_MAX_EXCLUDED, -1, 1, -0.9, 0.9, 0)},
    {HEAD(7, "fresnel", "Fresnel"),
     "Reflectance of a facet: none (all light is reflected), schlick, dielectric or conductor.",
     CHOICE("none", fresnel_choices)},
    {HEAD(8, "fresnel.schlick", "Reflectance"),
     "Schlick's approximation from this reflectance at normal incidence.",
     VALUES("", MUSURF_COLOR, 0, 0, 1, 0, 1, 0.9, 0.9, 0.9)},
    {HEAD(9, "fresnel.dielectric", "Refractive index"),
     "Ratio of refractive indices, below over above the surface.", SCALAR("", 0, 0.001, 1000, 1, 3, 1.5)},
    {HEAD(10, "fresnel.conductor", "Metal"), "A measured metal by its symbol, or custom: n and k as set.",
     CHOICE("Ag", conductor_choices)},
    {HEAD(11, "fresnel.conductor.n", "n"),
     "Real refractive index of a custom conductor, relative to the outside.",
     VALUES("", MUSURF_COLOR, MUSURF_MIN_EXCLUDED, 0, 1000, 0, 5, 0.06, 0.06, 0.05)},
    {HEAD(12, "fresnel.conductor.k", "k"),
     "Extinction coefficient of a custom conductor, relative to the outside.",
     VALUES("", MUSURF_COLOR, 0, 0, 1000, 0, 10, 4.152, 3.586, 2.869)},
    {HEAD(13, "sampler", "Sampler"),
     "How directions are drawn: visible normals (exact for every distribution); folded, visible normals "
     "whose reflections "
     "below the horizon are turned up again, less noisy; D cos, or that mixed with uniform directions with "
     "probability "
     "alpha (Appendix B), for comparison; visible_uniform and folded_uniform with 3 of 10 directions "
     "uniform, for long "
     "tails; bounded, of ggx without tilt: visible normals but most that reflect below the horizon; auto "
     "measures which "
     "has the lowest variance.",
     CHOICE("visible", sampler_choices)},
    {HEAD(14, "exponent", "Exponent"),
     "Exponent n of phong: D = (n + 2) cos^n / 2 pi. An error with other distributions.",
     SCALAR("", 0, 0, INFINITY, 0, 1000, 10)},
    {HEAD(15, "alpha_x", "Slope roughness along x"),
     "Slope roughness along the tangent, before rotation; with alpha_y it makes any distribution "
     "anisotropic. alpha is then sqrt(alpha_x alpha_y) unless set.",
     SCALAR("", MUSURF_MAY_VARY | MUSURF_NO_DEFAULT, 0, INFINITY, 0, 1, 0.3)},
    {HEAD(16, "alpha_y", "Slope roughness along y"), "Slope roughness across the tangent, before rotation.",
     SCALAR("", MUSURF_MAY_VARY | MUSURF_NO_DEFAULT, 0, INFINITY, 0, 1, 0.3)},
    {HEAD(17, "rotation", "Rotation"),
     "Turns the axes of alpha_x, alpha_y or anisotropy counter-clockwise about the normal.",
     SCALAR("radians", MUSURF_MAY_VARY, -INFINITY, INFINITY, -3.14159265358979, 3.14159265358979, 0)},
    {HEAD(18, "anisotropy", "Anisotropy"),
     "Anisotropy by the convention of another system; a value is given by its name.",
     CHOICE("none", anisotropy_choices)},
    {HEAD(19, "anisotropy.disney", "Disney anisotropic"),
     "anisotropic of Burley 2012 and Blender's Principled: aspect = sqrt(1 - 0.9 anisotropic); highlight "
     "along the tangent.",
     SCALAR("", 0, 0, 1, 0, 1, 0)},
    {HEAD(20, "anisotropy.cycles", "Cycles anisotropy"),
     "Anisotropy of Cycles' Glossy BSDF; above 0 the highlight lies across the tangent.",
     SCALAR("", 0, -1, 1, -1, 1, 0)},
    {HEAD(21, "anisotropy.openpbr", "OpenPBR anisotropy"),
     "specular_roughness_anisotropy of OpenPBR 1.1; highlight along the tangent.",
     SCALAR("", MUSURF_MAX_EXCLUDED, 0, 1, 0, 0.99, 0)},
    {HEAD(22, "anisotropy.gltf", "glTF strength"),
     "anisotropyStrength of KHR_materials_anisotropy, whose anisotropyRotation is rotation; highlight along "
     "the tangent.",
     SCALAR("", 0, 0, 1, 0, 1, 0)},
    {HEAD(23, "anisotropy.covariance", "Slope covariance"),
     "Covariance of the slopes, [[xx, xy], [xy, yy]], with alpha²/2 for an isotropic surface.",
     VALUES("", MUSURF_MATRIX, 0, -INFINITY, INFINITY, -1, 1, 0.045, 0, 0, 0.045)},
    {HEAD(24, "tilt", "Mean slope"),
     "Mean slope (dz/dx, dz/dy) of the microsurface, mirrors too, before stretch and transform.",
     VALUES("", MUSURF_VECTOR, 0, -INFINITY, INFINITY, -1, 1, 0, 0)},
    {HEAD(25, "A", "Ellipsoid matrix"),
     "The ellipsoid distribution's A, three rows: D = 1 / (pi |det A| |A n| |A^-T m|^4).",
     VALUES("", MUSURF_MATRIX3, MUSURF_NO_DEFAULT, -INFINITY, INFINITY, -1, 1, 0)},
    {HEAD(26, "theta_x", "Theta x"), "Rotation of the ellipsoid about x: tilts toward y; A = S Rx Ry Rz.",
     SCALAR("radians", 0, -INFINITY, INFINITY, -1, 1, 0)},
    {HEAD(27, "theta_y", "Theta y"), "Rotation of the ellipsoid about y: tilts along x; A = S Rx Ry Rz.",
     SCALAR("radians", 0, -INFINITY, INFINITY, -1, 1, 0)},
    {HEAD(28, "theta_z", "Theta z"),
     "Rotation of the ellipsoid about the normal: turns the axes; A = S Rx Ry Rz.",
     SCALAR("radians", 0, -INFINITY, INFINITY, -1, 1, 0)},
    {HEAD(29, "masking", "Shadowing-masking"),
     "Form of Smith's shadowing-masking: separable, height_correlated, or direction_correlated (also by the "
     "azimuth between the directions).",
     CHOICE("height_correlated", masking_choices)},
    {HEAD(30, "transmission", "Transmission"),
     "Also refracts what a facet does not reflect: a rough dielectric seen from both sides. Needs fresnel "
     "dielectric.",
     VALUES("", MUSURF_FLAG, 0, 0, 1, 0, 1, 0)},
    {HEAD(31, "histogram", "Histogram"),
     "Of tabulated: how often each slope (dz/dx, dz/dy) is met, in cells between bounds; only proportions "
     "count. Its mean slope adds to tilt.",
     VALUES("", MUSURF_GRID, MUSURF_NO_DEFAULT, 0, INFINITY, 0, 1, 0)},
    {HEAD(32, "flakes.density", "Flake density"),
     "Of the discrete distributions: mirror-like flakes per unit area of texture coordinates.",
     SCALAR("", MUSURF_MIN_EXCLUDED, 0, INFINITY, 1, 1e6, 1e6)},
    {HEAD(33, "flakes.cone", "Flake cone"),
     "A flake reflects into the cone of this half-angle around its normal, after transform: its own "
     "roughness, or half the width of the lights.",
     SCALAR("radians", MUSURF_MIN_EXCLUDED, 0, 1.5707963267948966, 0.001, 0.2, 0.02)},
    {HEAD(34, "flakes.seed", "Flake seed"), "Which flakes: a whole number.",
     SCALAR("", 0, 0, 9007199254740992, 0, 100, 0)},
    {HEAD(35, "footprint", "Footprint"),
     "The part of the texture plane whose flakes are counted: centre and the two half-axes of a "
     "parallelogram. A renderer sets it at each hit, to a pixel's; without one there are so many flakes that "
     "the surface is smooth.",
     VALUES("", MUSURF_FOOTPRINT, MUSURF_MAY_VARY | MUSURF_NO_DEFAULT, -INFINITY, INFINITY, -1, 1, 0)},
    {HEAD(36, "multiple_scattering", "Multiple scattering"),
     "Light that meets several facets: none (it is lost), compensated (a smooth lobe adds what is missing, "
     "from tables made at compile time, which takes seconds where transform varies; then they serve "
     "reflection by "
     "what is level, at slope roughnesses of up to 2, and shading integrates all else), or random_walk "
     "(followed on the "
     "microsurface: the reference, but noisy).",
     CHOICE("none", multiple_choices)},
    {HEAD(37, "smith", "Smith masking"),
     "Smith's masking of gtr: exact, or spline, the approximation of Appendix A for gamma up to 4, for "
     "comparison. The spline is sampled by mixed unless sampler says ndf.",
     CHOICE("exact", smith_choices)},
    {HEAD(38, "blurs", "Is blurred"),
     "The host blurs its closures (path regularisation): compensated makes tables for that, too, which takes "
     "up to ten times as "
     "long. Without them a blurred closure scatters singly, as if multiple_scattering were none; so it does "
     "where transform "
     "varies and the microsurface is tilted, or a histogram.",
     VALUES("", MUSURF_FLAG, 0, 0, 1, 0, 1, 0)},
};
