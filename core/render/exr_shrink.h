/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * exr_shrink.h: blocks of an EXR image that compression makes neither smaller nor larger.
 *
 * A block as long as its pixels is read as pixels, so one that comes out of the compressor at exactly that length must
 * be replaced by the pixels. OpenEXR's C core before 3.4.8 replaces only longer ones and writes such blocks damaged
 * (its issue 2306); with noise and small blocks that is no rarity: one block in some 20 of heights 256 wide.
 */
#ifndef MU_EXR_SHRINK_H
#define MU_EXR_SHRINK_H

#include <openexr.h>
#include <string.h>

typedef struct mu_exr_shrink {
    exr_result_t (*shrink)(exr_encode_pipeline_t *pipe);
} mu_exr_shrink;

static inline exr_result_t mu_exr_shrink_or_keep(exr_encode_pipeline_t *pipe) {
    const exr_result_t code = ((const mu_exr_shrink *)pipe->encoding_user_data)->shrink(pipe);
    if (!code && pipe->compressed_bytes >= pipe->packed_bytes) {
        memcpy(pipe->compressed_buffer, pipe->packed_buffer, pipe->packed_bytes);
        pipe->compressed_bytes = pipe->packed_bytes;
    }
    return code;
}

/* After the default routines were chosen; `own` must live as long as the pipeline. */
static inline void mu_exr_shrink_use(exr_encode_pipeline_t *pipe, mu_exr_shrink *own) {
    if (!pipe->compress_fn) return;
    own->shrink = pipe->compress_fn;
    pipe->encoding_user_data = own;
    pipe->compress_fn = mu_exr_shrink_or_keep;
}

#endif
