/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* musurf_given.h: the settings that a host gave, by parameter id. */
#ifndef MUSURF_GIVEN_H
#define MUSURF_GIVEN_H

#include "plugin/musurf_parameters.h"

/* NULL where the default holds. */
typedef struct given {
    const musurf_host *host;
    const musurf_setting *by_id[PARAMETER_COUNT + 1];
} given;

/* Tells the host, and returns `result`. */
__attribute__((format(printf, 4, 5))) musurf_result musurf_fail(const musurf_host *host, musurf_result result,
                                                                uint32_t param, const char *format, ...);
musurf_result musurf_gather(given *g, const musurf_setting *settings, size_t count);

/* The value given, or the default. */
double musurf_number(const given *g, uint32_t id);
/* Is it in a slot? Then the value given is the default. */
int musurf_varies(const given *g, uint32_t id);
void musurf_numbers(const given *g, uint32_t id, size_t count, double *out);
/* Is it set, to something other than its default? */
int musurf_differs(const given *g, uint32_t id);
/* Index of the choice; the table's order is that of the core's enumerations. */
int musurf_choice(const given *g, uint32_t id);

/* Distribution, roughness and everything that deforms the microsurface (musurf_parse_shape.c). */
musurf_result musurf_parse_shape(const given *g, parsed *out);
/* What of the shape varies (musurf_varying.c), of a definition that holds where it does not; own: its M but for stretch and
 * transform, with the defaults of what varies. */
musurf_result musurf_varying_parse(const given *g, const mu_definition *d, int ellipsoid, const double own[4],
                                   musurf_varying *out);
/* How many floats of slots are read. */
uint32_t musurf_varying_slots(const musurf_varying *varying);

#endif
