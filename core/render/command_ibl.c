/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_ibl.c: `musurf ibl ...`, image-based lighting along the major axis of a lobe. */
#include "core/render/command_ibl.h"

#include <float.h>
#include <math.h>

#include "core/render/command.h"
#include "core/render/query.h"
#include "core/render/subcommand.h"

static const mu_option no_options[] = {{NULL, NULL, NULL}};
static const mu_usage usage = {
    "ibl", "albedo|axis|plot|prefilter ...",
    "Image-based lighting: where a glossy, anisotropic material looks into its "
    "environment, by the major axis of its\n"
    "lobe (Cocco, Zanni, Chermain 2024).\n",
    no_options,
    "  albedo      what a material reflects of even light, by view; see musurf ibl albedo --help\n"
    "  axis        closest and farthest points, the axis above the horizon, "
    "samples; see musurf ibl axis --help\n"
    "  plot        these as a picture; see musurf ibl plot --help\n"
    "  prefilter   an environment blurred for every roughness; see musurf ibl prefilter --help\n"};

int mu_command_ibl(int argc, char **argv) {
    static const mu_subcommand list[] = {{"albedo", mu_command_ibl_albedo},
                                         {"axis", mu_command_ibl_axis},
                                         {"plot", mu_command_ibl_plot},
                                         {"prefilter", mu_command_ibl_prefilter},
                                         {NULL, NULL}};
    return mu_run_subcommand(&usage, list, argc, argv);
}

_Bool mu_ibl_ask(const mu_place *root, mu_ibl_question *out, mu_error *error) {
    static const char *const known[] = {"sigma", "angle", "wo", "k", "N", "beta", "id", "appendix_c", NULL};
    static const char *const shifts[] = {
        [MU_IBL_SYMMETRIC] = "symmetric", [MU_IBL_PRINTED] = "printed", NULL};
    if (!mu_place_only(root, known, error)) return 0;
    const mu_place sigma = mu_place_member(root, "sigma"), angle = mu_place_member(root, "angle"),
                   wo = mu_place_member(root, "wo"), k = mu_place_member(root, "k"),
                   samples = mu_place_member(root, "N"), beta = mu_place_member(root, "beta"),
                   shift = mu_place_member(root, "appendix_c");
    out->settings = mu_ibl_settings_default_d();
    double turn = 0;
    long long count = (long long)out->settings.samples;
    size_t choice = out->settings.shift;
    if (!mu_place_numbers(&sigma, 2, 0, INFINITY, out->lobe.sigma, error)) return 0;
    if (angle.value && !mu_place_number(&angle, -INFINITY, INFINITY, &turn, error)) return 0;
    if (!mu_query_direction(&wo, out->wo, error)) return 0;
    if (out->wo[2] < 0) return mu_place_fail(&wo, error, "looks from below; z must not be negative");
    if (k.value && !mu_place_number(&k, DBL_MIN, INFINITY, &out->settings.k, error)) return 0;
    if (beta.value && !mu_place_number(&beta, 0, INFINITY, &out->settings.beta, error)) return 0;
    if (samples.value && !mu_place_integer(&samples, 1, MU_IBL_SAMPLES_MOST, &count, error)) return 0;
    if (shift.value && !mu_place_choice(&shift, shifts, &choice, error)) return 0;
    out->lobe.turn[0] = cos(turn), out->lobe.turn[1] = sin(turn);
    out->settings.samples = (size_t)count;
    out->settings.shift = (mu_ibl_shift)choice;
    return 1;
}
