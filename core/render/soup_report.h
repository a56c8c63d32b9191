/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * soup_report.h: the exact masking of a small surface of triangles as JSON: of each facet, of all facets with the same
 * normal, of all. A facet's G1 is the share of its area that a view sees, G2 the share that two see, 0 if it turns away;
 * averages over facets are weighted by area: Eq. (2a) and (12a) of On Microsurface Transformations (Golubev).
 */
#ifndef MU_SOUP_REPORT_H
#define MU_SOUP_REPORT_H

#include "core/render/options.h"
#include "core/surface/soup.h"

enum { MU_SOUP_VIEWS = 16 };

typedef struct mu_soup_question {
    mu_soup soup;
    double m[4], views[MU_SOUP_VIEWS][3];
    uint32_t view_count;
    _Bool periodic;           /* else `period` is chosen here, so large that copies do not matter */
    const char *const *parts; /* a name for each triangle, or NULL */
} mu_soup_question;

/* Applies M (the soup's corners move) and writes one line on stdout; the command's exit code. */
int mu_soup_answer(mu_soup_question *question, const mu_usage *usage);
/* What --help of both commands says of that line. */
#define MU_SOUP_OUT                                                                                          \
    "out, one line of JSON; views and normals are unit vectors in the space of the transformed surface:\n"   \
    "  \"facets\"  each with \"triangle\", \"area\", \"normal\" (outward), \"G1\" (a list, one share per "   \
    "view), \"G2\" (one per\n"                                                                               \
    "            pair of views): shares of its area that are seen, exact to rounding; 0 if it turns away\n"  \
    "  \"normals\" facets of the same normal together: \"normal\", \"area\", \"D\" (area per macro area; "   \
    "null without a\n"                                                                                       \
    "            period), \"G1\", \"G2\", weighted by area: the masking functions G1(v, m) and G2(v, m, "    \
    "l)\n"                                                                                                   \
    "  \"views\"   each with \"G1\" over all facets that face it, by area; \"G1_projected\", by projected "  \
    "area; and\n"                                                                                            \
    "            \"projected_area\", seen projected area over the plane's own: 1 for a surface without "     \
    "holes\n"                                                                                                \
    "  \"pairs\"   each with \"a\", \"b\" (0 is the first view) and \"G2\" over all facets that face both, " \
    "by area\n"

#endif
