/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* ibl_real.h: the part of ibl.h that exists once per precision. Included by it alone, twice. */

/* How much of even light a bound histogram reflects, F included, to `allowed` (cells.c). 0: it is none, or scatters more than once. */
int MU_SUFFIX(mu_ibl_albedo_of_cells)(const MU_SUFFIX(mu_closure) * closure, double allowed, double rgb[3]);
/* The same of a bound random walk's surface that does not transmit, to a standard error of `allowed` if it can be had (walks.c).
 * `still`: its slopes before M. 0: it is none, or nearly a mirror. */
int MU_SUFFIX(mu_ibl_albedo_of_walks)(const MU_SUFFIX(mu_closure) * closure, const mu_ibl_slopes *still, double allowed, double rgb[3]);

/* Sigma by its axes: standard deviations of the slope along U = (turn[0], turn[1]) and along V, a quarter turn on; and the mean
 * slope, of which the axis and its closed forms know nothing. */
typedef struct MU_SUFFIX(mu_ibl_lobe) {
    MU_REAL sigma[2];
    MU_REAL turn[2]; /* cosine and sine of the angle from x to U */
    MU_REAL mean[2];
} MU_SUFFIX(mu_ibl_lobe);

typedef struct MU_SUFFIX(mu_ibl_settings) {
    MU_REAL k;      /* > 0: the confidence region's half-axes are k sigma, Eq. (6) */
    MU_REAL beta;   /* >= 0: how far neighbouring samples overlap, Eq. (10) */
    size_t samples; /* N >= 1 */
    mu_ibl_shift shift;
} MU_SUFFIX(mu_ibl_settings);

typedef struct MU_SUFFIX(mu_ibl_axis) {
    /* Eq. (6) and (7): parameters of the boundary's closest (0) and farthest (1) points to the mirrored view, in (-pi/2,
     * pi/2]; the points themselves, at t and at t + pi, as micronormals. Where all are equally far: pi/2 and 0. */
    MU_REAL t[2];
    MU_REAL near[2][3], far[2][3];
    /* Appendix B: where between far[0] (0) and far[1] (1) the axis meets the horizon, not clamped to [0, 1]; an end that
     * nothing cuts, whatever the length of the axis, has 0 or 1. Eq. (8): the ends above the horizon, as micronormals. */
    MU_REAL tau[2];
    MU_REAL far_clamped[2][3];
    MU_REAL delta;  /* Appendix C: by how much the closest points move, in t */
    MU_REAL width;  /* Delta': between the moved closest points, in reflected space */
    MU_REAL length; /* between the clamped ends, in reflected space */
    MU_REAL zeta;   /* Appendix D: 1 - width / length, negative if wider than long; 0 without length */
    MU_REAL radius; /* r_s of Eq. (10), a chord */
    /* For mu_ibl_axis_sample. The axis lies in the plane of z and `along`, which points to far[0]; `middle` is the sine
     * and cosine of its middle's angle to z, `reach` twice the cosine and sine, by some factor, of the angle from there
     * to the outermost samples. */
    MU_REAL along[2], middle[2], reach[2];
} MU_SUFFIX(mu_ibl_axis);

/* k = 1, beta = 2.3, 16 samples, symmetric. */
MU_SUFFIX(mu_ibl_settings) MU_SUFFIX(mu_ibl_settings_default)(void);

/* Sigma's axes, and the mean. */
MU_SUFFIX(mu_ibl_lobe) MU_SUFFIX(mu_ibl_lobe_of)(const mu_ibl_slopes *slopes);

/* wo.z >= 0. */
void MU_SUFFIX(mu_ibl_axis_make)(const MU_SUFFIX(mu_ibl_lobe) * lobe, const MU_REAL wo[3],
                                 const MU_SUFFIX(mu_ibl_settings) * settings, MU_SUFFIX(mu_ibl_axis) * out);
/* The same, but t, `near` and `far` are not for use: all that samples and their radius need. */
void MU_SUFFIX(mu_ibl_axis_make_for_samples)(const MU_SUFFIX(mu_ibl_lobe) * lobe, const MU_REAL wo[3],
                                             const MU_SUFFIX(mu_ibl_settings) * settings,
                                             MU_SUFFIX(mu_ibl_axis) * out);
/* The same of MU_IBL_AXES views of one lobe, number by number: several are worked out at a time. */
typedef struct MU_SUFFIX(mu_ibl_axes) {
    MU_REAL along[2][MU_IBL_AXES], middle[2][MU_IBL_AXES], reach[2][MU_IBL_AXES], radius[MU_IBL_AXES];
} MU_SUFFIX(mu_ibl_axes);
void MU_SUFFIX(mu_ibl_axes_make)(const MU_SUFFIX(mu_ibl_lobe) * lobe, const MU_REAL (*wo)[MU_IBL_AXES],
                                 const MU_SUFFIX(mu_ibl_settings) * settings, MU_SUFFIX(mu_ibl_axes) * out);
/* Many at once. Strides count lobes and numbers; a stride of 0 repeats the one. */
void MU_SUFFIX(mu_ibl_axis_batch)(size_t count, const MU_SUFFIX(mu_ibl_lobe) * lobes, size_t lobe_stride,
                                  const MU_REAL *wo, size_t wo_stride,
                                  const MU_SUFFIX(mu_ibl_settings) * settings, MU_SUFFIX(mu_ibl_axis) * out);

/* Eq. (9): the micronormal of sample j of N; of a single one, the middle of the axis. */
void MU_SUFFIX(mu_ibl_axis_sample)(const MU_SUFFIX(mu_ibl_axis) * axis, size_t samples, size_t j,
                                   MU_REAL micronormal[3]);

/* Eq. (3) with alpha_lin = sqrt(r_s): the level, 0 ... levels - 1, of an environment filtered in that many. */
MU_REAL MU_SUFFIX(mu_ibl_level)(MU_REAL radius, size_t levels);
