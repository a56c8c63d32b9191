/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_render.h: the renderer as a shared library for host programs: a scene file's text in, pixels out.
 *
 * The scene is that of `musurf render` (scene.schema.json); meshes and pictures are files that it names. Everything goes
 * on inside one call, on threads of its own; callbacks come on the thread that called. Nothing is printed, no signal is
 * caught, no state is kept between calls. Plugins are looked for in $MUSURF_PLUGIN_PATH, then
 * beside the shared library.
 */
#ifndef MUSURF_RENDER_H
#define MUSURF_RENDER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MUSURF_RENDER_MAJOR 1 /* changes with what is not compatible; structs grow at their end only */

enum { MUSURF_RENDER_DONE = 0, MUSURF_RENDER_STOPPED = 1, MUSURF_RENDER_FAILED = 2 };
enum { MUSURF_RENDER_WARNING = 1, MUSURF_RENDER_ERROR = 2 };

typedef struct musurf_render_request {
    uint32_t size;     /* sizeof of this struct as the caller knows it: at least up to `stop` */
    uint32_t threads;  /* at most 1024; 0: one per processor */
    const char *scene; /* JSON */
    const char
        *name;     /* of that text, as if it were a file: for messages, and files are named relative to it */
    float *pixels; /* RGBA, linear, alpha is coverage and RGB not multiplied by it; row by row from the top */
    size_t count;  /* of pixels: width times height of the scene's film, or the call fails */
    double noise;  /* stop at this mean relative standard error; 0: at the scene's samples alone */
    double interval;                /* seconds from one `picture` to the next */
    void *context;                  /* of the callbacks, each of which may be NULL */
    int32_t (*stop)(void *context); /* polled 20 times a second; not 0: end */
    void (*progress)(void *context, double fraction, double remaining,
                     uint32_t samples); /* remaining < 0: unknown */
    void (*picture)(void *context);     /* the buffers hold what is there so far */
    void (*message)(void *context, int32_t severity, const char *text); /* one line */
    float *albedo, *normal; /* 3 numbers per pixel, of the first hit, 0 where there is none; or NULL */
} musurf_render_request;

/* Major version times 1000 plus minor. */
uint32_t musurf_render_version(void);
/* After DONE and STOPPED the buffers hold the picture; after FAILED `message` was told why. [any] */
int32_t musurf_render_run(const musurf_render_request *request);
/* The material's parameter table, {"id", "label", "doc", "parameters": [...]} as `musurf info --json` prints it, to be
 * given to musurf_render_free. NULL: `message` was told why. [any] */
char *musurf_render_parameters(const char *material, void *context,
                               void (*message)(void *context, int32_t severity, const char *text));
void musurf_render_free(char *text);

#ifdef __cplusplus
}
#endif

#endif
