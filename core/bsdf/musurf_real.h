/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_real.h: the part of musurf.h that exists once per precision. Included by it alone, twice. */

/* A linear map, prepared (linear_map.c). With s the common slope unit that a distribution asked for:
 *   normals     u = (normal m_xy, normal_z m_z)   is M^T m / s up to a scale chosen so that D_M(m) = D(u);
 *   directions  w = (view v_xy, view_z v_z)       is M^-1 v scaled by view_z;
 * and with a tilt t, in slope units, u_xy += t u_z and w_z -= t w_xy. */
typedef struct MU_SUFFIX(mu_map) {
    MU_REAL normal[4], normal_z;
    MU_REAL view[4], view_z;
    MU_REAL tilt[2];
} MU_SUFFIX(mu_map);

typedef struct MU_SUFFIX(mu_kernel) MU_SUFFIX(mu_kernel);
typedef struct MU_SUFFIX(mu_surface) MU_SUFFIX(mu_surface);

/* A surface seen from wo. Plain bytes: copy and drop it at will while its surface lives. */
typedef struct MU_SUFFIX(mu_closure) {
    const MU_SUFFIX(mu_surface) * surface;
    const MU_SUFFIX(mu_kernel) * kernel;
    MU_SUFFIX(mu_map) map;
    MU_REAL wo[3];         /* turned over if it came from below: all is as seen from wo.z > 0 */
    MU_REAL sigma, lambda; /* view_z times the projected area sigma_M(wo), and times cos Lambda */
    MU_REAL alpha;
    MU_REAL least2; /* of bounded sampling: the square of the smaller slope roughness, at most 1; else 0 */
    MU_REAL side;   /* +1, or -1: wo was below, and all directions in and out are turned over */
    MU_REAL eta;    /* of a dielectric: n_transmitted / n_incident, seen from wo */
    int importance; /* set it after mu_bind: importance is transported, not radiance. Matters to refraction only */
    int is_delta;      /* a mirror or a pane: eval answers 0 */
    int has_footprint; /* set by mu_footprint; what follows is only touched if the surface is a discrete one */
    double footprint[6];
    mu_lobe lobe; /* of a compensated surface alone */
} MU_SUFFIX(mu_closure);

typedef struct MU_SUFFIX(mu_value) {
    MU_REAL f[3]; /* BSDF with F or 1 - F, without the cosine */
    MU_REAL pdf;  /* of sampling wi given wo; of a surface that transmits, with the choice F or 1 - F */
    MU_REAL pdf_reverse;
} MU_SUFFIX(mu_value);

typedef struct MU_SUFFIX(mu_sample) {
    MU_REAL wi[3], wm[3];
    MU_REAL f[3];
    MU_REAL weight[3]; /* f cos(wi) / pdf = F G2 / G1, analytic */
    MU_REAL pdf, pdf_reverse;
    int rejected; /* wi fell below the horizon: all else but wm is 0 */
    int delta;    /* a mirror or a pane: f is 0 and pdf is the probability of this one direction */
    int transmitted;
    MU_REAL eta; /* n_transmitted / n_incident along this path; 1 for reflection */
} MU_SUFFIX(mu_sample);

/* Quantities of one direction, of a micronormal, of a pair. */
typedef struct MU_SUFFIX(mu_masking) {
    MU_REAL Lambda, sigma;
} MU_SUFFIX(mu_masking);
typedef struct MU_SUFFIX(mu_normal_values) {
    MU_REAL D, G1, Dv;
} MU_SUFFIX(mu_normal_values);
typedef struct MU_SUFFIX(mu_pair_values) {
    MU_REAL F[3], G2;
} MU_SUFFIX(mu_pair_values);

/* Memory for a surface of a checked definition (aligned to 16), and the surface in it. The memory must not
 * move. */
size_t MU_SUFFIX(mu_surface_bytes)(const mu_definition *definition);
MU_SUFFIX(mu_surface) * MU_SUFFIX(mu_surface_make)(const mu_definition *definition, void *memory);
/* The tables of a compensated surface, for another one of the same definition; NULL if it has none. */
const mu_albedo_set *MU_SUFFIX(mu_surface_tables)(const MU_SUFFIX(mu_surface) * surface);
/* The most that an albedo in them was found to be off, where refining had to end above compensation_error: else 0. */
MU_REAL MU_SUFFIX(mu_surface_tables_unsure)(const MU_SUFFIX(mu_surface) * surface);
/* The share of what leaves a side, by the cosine, for which they have no value that is near enough, of the worse side: there the
 * albedo is integrated while shading, in 20 to 250 microseconds. */
MU_REAL MU_SUFFIX(mu_surface_tables_open)(const MU_SUFFIX(mu_surface) * surface);
/* Of an M of the point (compensation_varies) they have values up to this slope roughness along both axes, and beyond it albedos are
 * integrated so: 0 if there are none; infinite if no such M is meant. */
MU_REAL MU_SUFFIX(mu_surface_tables_reach)(const MU_SUFFIX(mu_surface) * surface);
size_t MU_SUFFIX(mu_surface_table_bytes)(const MU_SUFFIX(mu_surface) * surface);
/* What the definition came down to: "ggx", "gtr table", "mirror", ... */
const char *MU_SUFFIX(mu_surface_name)(const MU_SUFFIX(mu_surface) * surface);

/* Binds wo (and, unless NULL, an M of this point in place of the definition's). 0: black from here (wo on the
 * horizon, or below it and nothing is transmitted; M singular or not finite): eval and sample must not be called;
 * mu_view and mu_normal may, if M is good. */
int MU_SUFFIX(mu_bind)(const MU_SUFFIX(mu_surface) * surface, const MU_REAL wo[3], const MU_REAL transform[4],
                       MU_SUFFIX(mu_closure) * closure);
/* The part of the surface that is seen at once, of which a discrete distribution counts the flakes: u, v of its centre
 * and of the two half-axes of a parallelogram. Set it after mu_bind; NULL, or one that is not finite, is all of the
 * plane, where infinitely many flakes are the smooth surface. Other surfaces take no notice. f and weight change, pdfs
 * do not. */
void MU_SUFFIX(mu_footprint)(MU_SUFFIX(mu_closure) * closure, const double footprint[6]);
/* Raises the slope roughness in every direction to at least alpha; a narrower lobe becomes GGX, without flakes. */
void MU_SUFFIX(mu_blur)(MU_SUFFIX(mu_closure) * closure, MU_REAL alpha);

/* Zero on the horizon, on the other side if nothing is transmitted, and for a mirror. Never negative, never NaN; saturates at the largest
 * number. */
void MU_SUFFIX(mu_eval)(const MU_SUFFIX(mu_closure) * closure, const MU_REAL wi[3],
                        MU_SUFFIX(mu_value) * out);
/* u: three uniforms in [0,1). The first two move the normal, the third chooses among alternatives. */
void MU_SUFFIX(mu_sample_wi)(const MU_SUFFIX(mu_closure) * closure, const MU_REAL u[3],
                             MU_SUFFIX(mu_sample) * out);
/* The same with a sampler other than the definition's. */
void MU_SUFFIX(mu_sample_with)(const MU_SUFFIX(mu_closure) * closure, mu_sampler sampler, const MU_REAL u[3],
                               MU_SUFFIX(mu_sample) * out);

/* Directional albedo for F = 1 (with transmission: of both sides) of single scattering toward w, on the side of w, from the
 * tables of a compensated surface, and its cosine-weighted average over that side; 1 where there are no tables. */
MU_REAL MU_SUFFIX(mu_albedo)(const MU_SUFFIX(mu_surface) * surface, const MU_REAL w[3], MU_REAL *average);

MU_SUFFIX(mu_masking) MU_SUFFIX(mu_view)(const MU_SUFFIX(mu_closure) * closure, const MU_REAL w[3]);
MU_SUFFIX(mu_normal_values) MU_SUFFIX(mu_normal)(const MU_SUFFIX(mu_closure) * closure, const MU_REAL wm[3]);
MU_SUFFIX(mu_pair_values) MU_SUFFIX(mu_pair)(const MU_SUFFIX(mu_closure) * closure, const MU_REAL wi[3]);
