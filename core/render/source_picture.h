/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* source_picture.h: the numbers of a parameter from a picture, decoded, placed in their range and checked one by one. */
#ifndef MU_SOURCE_PICTURE_H
#define MU_SOURCE_PICTURE_H

#include "core/render/source.h"

typedef struct mu_picture_request {
    const char *const *names; /* of channels, or NULL (image_read.h) */
    _Bool named;              /* by the user */
    _Bool srgb;
    int count;
    double range[2];           /* what 0 and 1 stand for */
    const musurf_param *param; /* whose limits hold; NULL: none but finite */
    double *step;              /* out: between the codes of a whole-number file, before `range`; NULL: not asked for */
} mu_picture_request;

/* `count` texts, or, of one, that alone; borrowed. */
_Bool mu_source_texts(const mu_place *place, int count, const char **out, mu_error *error);

/* The finest level of a mipmap. `file`: the member that names it, relative to the document. */
_Bool mu_source_picture(mu_mipmap *picture, const mu_place *file, const mu_picture_request *request,
                        mu_wrap wrap, mu_error *error);

#endif
