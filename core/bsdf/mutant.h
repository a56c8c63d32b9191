/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mutant.h: known mistakes, so that the tests can be tested. Compiled with -DMUSURF_MUTANT=n, mutant n
 * replaces the right expression by a wrong one; the default, 0, compiles to the right ones at no cost.
 * - 1: |det M| dropped from Eq. (22)
 * - 2: M where M^-1 belongs, Eq. (12)
 * - 3: 1/|M^T m|^4 forgotten in Eq. (22)
 * - 4: G1(wo) in place of G2
 * - 5: the pdf of D cos returned for visible-normal sampling
 * - 6: det M without its absolute value, Eq. (22)
 * - 7: M m for M^T m, Eq. (13)
 * - 8: sampling weight without 1/G1
 * - 9: refraction's eta² on radiance in place of importance
 * - 10: the tilt with its sign changed
 * - 11: the azimuth of direction-correlated shadowing between v and l, not M^-1 v and M^-1 l
 * - 12: the visible part of a tilted surface's Lambda below 0 not clamped in G2
 * - 13: F left out of the pdf of a surface that transmits
 * - 14: what is folded back left out of the density of folded sampling
 * - 15: the cells of a table drawn alike in every row
 * - 16: the smooth lobe of compensation left out of its pdf
 * - 17: a random walk's first facet counted twice
 */
#ifndef MU_MUTANT_H
#define MU_MUTANT_H

#ifndef MUSURF_MUTANT
#define MUSURF_MUTANT 0
#endif
#define MUTANT(n, wrong, right) (MUSURF_MUTANT == (n) ? (wrong) : (right))

#endif
