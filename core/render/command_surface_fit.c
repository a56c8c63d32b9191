/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface_fit.c: `musurf surface fit`, the material that a heightfield is. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/command_surface.h"
#include "core/render/output.h"
#include "core/render/surface_source.h"
#include "core/render/surface_fit.h"

enum { TRANSFORM, OPEN, KEEP, TOLERANCE, TABULATED, OUTPUT, SOURCE };

static const mu_option options[] = {
    {"transform", "A,C,B,D", "fit the surface under M = [a c; b d], row by row (default: 1,0,0,1)"},
    {"open", NULL,
     "the surface does not repeat: no facets across its last row and column (as --border crop)"},
    {"keep", "Q",
     "share of facets, around their mean slope, whose slopes matter; of the steepest rest only the\n"
     "number does, for tails are clipped by makers and instruments (default: 0.999)"},
    {"tolerance", "T", "share of facets that a fit may misplace beyond what scatter does (default: 0.02)"},
    {"tabulated", "FILE", "also write the slopes as a material of ndf tabulated, whatever the verdict"},
    {"o", "FILE", "write the material, if one explains the surface"},
    MU_SURFACE_SOURCE_OPTIONS,
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "surface fit", "FILE [--transform A,C,B,D] [--open] [-o material.json] ...",
    "Finds the distribution and the map M that explain the facets of a heightfield best, or says why none "
    "does.\n",
    options,
    MU_SURFACE_SOURCE_HELP
    "Of a map that is no square, a square part is used.\n"
    "Candidates are ggx, beckmann, gtr, std, phong and sheen under every symmetric M of det M = 1 with every "
    "mean\n"
    "slope, and gtr under M of any scale; an ellipsoid is ggx. They are fitted by maximum likelihood. Errors "
    "are\n"
    "standard errors from the scatter over blocks of the surface, for neighbouring facets are alike.\n"
    "out, one line of JSON:\n"
    "  \"verdict\"   explained, flat (all heights are equal), or refused, and then \"reason\"\n"
    "  \"material\"  to paste into a scene; \"tilt\" is the mean slope before M\n"
    "  \"effective_facets\"  how many independent facets tell as much; \"correlation\": to 1/e, in cells\n"
    "  \"candidates\", best first:\n"
    "    \"behind\"     Bayesian criterion, likelihoods taken per effective facet, less the best one's: 10 "
    "is much\n"
    "    \"held_out\"   ln likelihood per facet of the half that was not used\n"
    "    \"values\", \"errors\"  alpha_x >= alpha_y, slope roughness along rotation and across; M: xx, xy, "
    "yy\n"
    "    \"isotropic\", \"level\"  the probability of as much anisotropy, or mean slope, by chance\n"
    "    \"residual\"   facets of the half not used, in bins of equal mass of the fit: by steepness, by "
    "azimuth from\n"
    "                 alpha_x's axis, by both; relative \"rms\", total \"variation\", and what \"scatter\" "
    "makes of it\n"
    "A candidate explains the surface if no variation is above T and twice the scatter. Exit code 1: "
    "refused.\n"};

typedef struct mu_asked {
    mu_fit fit;
    double m[4];
    _Bool open;
    mu_surface_source source;
    const char *output, *tabulated;
} mu_asked;

static _Bool read_share(const mu_options *at, double *out) {
    if (mu_options_numbers(at, 1, 1, out) != 1) return 0;
    return (*out > 0 && *out <= 1) ||
           (mu_refuse(&usage, "--%s is %g; it must lie between 0 and 1", at->name, *out), 0);
}

static _Bool read_option(void *to, const mu_options *at, int met) {
    mu_asked *asked = to;
    if (met >= SOURCE) return mu_surface_source_option(&asked->source, at, met - SOURCE);
    switch (met) {
    case TRANSFORM:
        return mu_options_transform(at, asked->m);
    case OPEN:
        return asked->open = 1;
    case KEEP:
        if (!read_share(at, &asked->fit.keep)) return 0;
        return asked->fit.keep >= 0.5 ||
               (mu_refuse(&usage, "--keep is %g; half of the facets must matter", asked->fit.keep), 0);
    case TOLERANCE:
        return read_share(at, &asked->fit.tolerance);
    case TABULATED:
        asked->tabulated = at->value;
        return 1;
    default:
        asked->output = at->value;
        return 1;
    }
}

static int complain(const mu_error *error) {
    return mu_refuse(&usage, "%s", error->text);
}

static int answer(mu_asked *asked, const mu_slopes *s) {
    mu_error error = {.text = ""};
    mu_json json = {0};
    double outside = 0;
    int code = MU_EXIT_OK;
    mu_fit_slopes(&asked->fit, s);
    if (asked->fit.verdict == MU_FIT_NO_MEMORY)
        return mu_refuse(&usage, "%s: not enough memory", asked->source.file);
    const _Bool found = asked->fit.verdict != MU_FIT_REFUSED;
    if (asked->tabulated) {
        if (!mu_surface_fit_tabulate(s, &json, &outside))
            mu_fail(&error, "%s: not enough memory", asked->tabulated), code = MU_EXIT_REFUSED;
        else if (!mu_surface_fit_save(asked->tabulated, &json, &error))
            code = MU_EXIT_REFUSED;
    }
    if (code == MU_EXIT_OK && asked->output && found) {
        mu_surface_fit_material(&asked->fit, &json);
        if (!mu_surface_fit_save(asked->output, &json, &error)) code = MU_EXIT_REFUSED;
    }
    mu_json_free(&json);
    if (code != MU_EXIT_OK) return complain(&error);
    errno = 0;
    if (!mu_surface_fit_report(&asked->fit, asked->source.file, asked->tabulated, outside, stdout)) {
        fprintf(stderr, "musurf surface fit: standard output: %s\n", strerror(errno));
        return MU_EXIT_FAILED;
    }
    if (found) return MU_EXIT_OK;
    fprintf(stderr, "musurf surface fit: %s: %s\n", asked->source.file, asked->fit.reason);
    return MU_EXIT_FAILED;
}

static int fit(mu_asked *asked) {
    mu_error error = {.text = ""};
    mu_slopes s = {.open = 0};
    const char *const files[] = {asked->output, asked->tabulated};
    for (int k = 0; k < 2; k++)
        if (files[k] && !mu_output_check(files[k], &error)) return complain(&error);
    mu_surface surface;
    if (asked->open && !asked->source.border_given) asked->source.border = MU_BORDER_CROP;
    if (!mu_surface_read(&asked->source, &surface, &error)) return complain(&error);
    const double *m = asked->m, det = m[0] * m[3] - m[1] * m[2];
    s.f = surface.f, s.open = asked->open || surface.open;
    s.cotransform[0] = m[3] / det, s.cotransform[1] = -m[2] / det; /* M^-T */
    s.cotransform[2] = -m[1] / det, s.cotransform[3] = m[0] / det;
    const int code = answer(asked, &s);
    mu_surface_free(&surface);
    return code;
}

int mu_command_surface_fit(int argc, char **argv) {
    mu_asked asked = {
        .source = mu_surface_source_begin(), .fit = {.keep = 0.999, .tolerance = 0.02}, .m = {1, 0, 0, 1}};
    int code;
    if (!mu_surface_options(&usage, argc, argv, read_option, &asked, &asked.source.file, &code)) return code;
    return fit(&asked);
}
