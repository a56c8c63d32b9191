/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * film_state.c: the exact sums of a film as a file, to go on with later.
 *
 * A head, the pixels as they are in memory, a CRC-32 of both. The file belongs to this machine and this
 * version: it is neither an image nor an exchange format, so there is no conversion, only refusal.
 */
#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

#include "core/render/film.h"
#include "core/render/output.h"

typedef struct mu_state_head {
    char magic[16];
    uint32_t order; /* of bytes */
    uint32_t pixel_bytes;
    uint32_t width, height;
    uint64_t key;
    uint64_t rays, refused;
    double seconds;
} mu_state_head;

#define MAGIC "musurf film v2\n"
#define ORDER 0x01020304u

static_assert(sizeof MAGIC == 16, "the magic fills its field");
static_assert(sizeof(mu_pixel) == 80 && sizeof(mu_state_head) == 64,
              "no padding: every byte written is defined");

enum { BATCH = 1 << 14 }; /* pixels handed to the file at once */

static uint32_t checksum(uint32_t crc, const void *data, size_t bytes) {
    return (uint32_t)crc32_z(crc, data, bytes);
}

_Bool mu_film_save(const mu_film *film, const char *file, uint64_t key, mu_error *error) {
    mu_output output;
    if (!mu_output_open(&output, file, error)) return 0;
    const mu_state_head head = {.magic = MAGIC,
                                .order = ORDER,
                                .pixel_bytes = sizeof(mu_pixel),
                                .width = film->width,
                                .height = film->height,
                                .key = key,
                                .rays = film->rays,
                                .refused = film->refused,
                                .seconds = film->seconds};
    mu_output_write(&output, &head, sizeof head, 0);
    uint32_t crc = checksum(0, &head, sizeof head);
    uint64_t offset = sizeof head;
    const size_t count = (size_t)film->width * film->height;
    for (size_t i = 0; i < count && !output.trouble; i += BATCH) {
        const size_t bytes = (count - i < BATCH ? count - i : BATCH) * sizeof(mu_pixel);
        crc = checksum(crc, &film->pixels[i], bytes);
        mu_output_write(&output, &film->pixels[i], bytes, offset);
        offset += bytes;
    }
    mu_output_write(&output, &crc, sizeof crc, offset);
    return mu_output_commit(&output, error);
}

/* A checksum is no proof against a file made up on purpose: nothing may enter the film that sampling cannot
 * make. */
static _Bool plausible(const mu_pixel *pixel) {
    double sum = pixel->luminance2;
    for (int i = 0; i < 3; ++i)
        sum += fabs(pixel->rgb[i]) + fabs((double)pixel->albedo[i]) + fabs((double)pixel->normal[i]);
    return isfinite(sum) && pixel->luminance2 >= 0 && pixel->hits <= pixel->samples;
}

static _Bool load(mu_film *film, FILE *stream, const char *file, uint64_t key, mu_error *error) {
    mu_state_head head;
    struct stat status;
    if (fstat(fileno(stream), &status))
        return mu_fail(error, "%s: cannot be read: %s", file, strerror(errno));
    if (fread(&head, sizeof head, 1, stream) != 1 || memcmp(head.magic, MAGIC, sizeof head.magic))
        return mu_fail(error, "%s: is no checkpoint of a musurf render", file);
    if (head.order != ORDER || head.pixel_bytes != sizeof(mu_pixel))
        return mu_fail(error, "%s: was written by another kind of machine or build", file);
    if (head.width != film->width || head.height != film->height)
        return mu_fail(error, "%s: holds %u x %u pixels, this render has %u x %u", file, head.width,
                       head.height, film->width, film->height);
    if (head.key != key)
        return mu_fail(error, "%s: belongs to another scene, seed or version of musurf", file);
    const size_t count = (size_t)film->width * film->height;
    const uint64_t size = sizeof head + (uint64_t)count * sizeof(mu_pixel) + sizeof(uint32_t);
    if ((uint64_t)status.st_size != size)
        return mu_fail(error, "%s: is damaged: %lld bytes long instead of %llu", file,
                       (long long)status.st_size, (unsigned long long)size);

    uint32_t stored, crc = checksum(0, &head, sizeof head);
    for (size_t i = 0; i < count; i += BATCH) {
        const size_t batch = count - i < BATCH ? count - i : BATCH;
        if (fread(&film->pixels[i], sizeof(mu_pixel), batch, stream) != batch)
            return mu_fail(error, "%s: cannot be read: %s", file, strerror(errno));
        crc = checksum(crc, &film->pixels[i], batch * sizeof(mu_pixel));
    }
    if (fread(&stored, sizeof stored, 1, stream) != 1 || stored != crc)
        return mu_fail(error, "%s: is damaged: its checksum does not match", file);
    _Bool sane = isfinite(head.seconds) && head.seconds >= 0;
    for (size_t i = 0; i < count && sane; ++i) sane = plausible(&film->pixels[i]);
    if (!sane) return mu_fail(error, "%s: is damaged: it holds sums that no render makes", file);

    film->rays = head.rays;
    film->refused = head.refused;
    film->seconds = head.seconds;
    return 1;
}

_Bool mu_film_load(mu_film *film, const char *file, uint64_t key, mu_error *error) {
    FILE *stream = fopen(file, "rbe");
    if (!stream) return mu_fail(error, "%s: cannot be read: %s", file, strerror(errno));
    const _Bool loaded = load(film, stream, file, key, error);
    fclose(stream);
    if (!loaded) memset(film->pixels, 0, (size_t)film->width * film->height * sizeof(mu_pixel));
    return loaded;
}
