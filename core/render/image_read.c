/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_read.c: finds and opens the module. The dynamic loader knows what is open already; no state is kept
 * here. */
#include "core/render/image_read.h"

#include "core/render/search.h"

#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MODULE "musurf_oiio.so"

typedef float *(*mu_reader)(const char *file, int *width, int *height, char *message, size_t size);
typedef float *(*mu_channel_reader)(const char *file, const char *const *names, int named, int count, int *width,
                                    int *height, double *step, char *message, size_t size);
typedef double *(*mu_raw_reader)(const char *file, const char *channel, int *width, int *height,
                                 char *message, size_t size);

/* The first file of that name is taken; if it does not load, `why` says so and no other is tried in its place. */
static void *open_module(char *why, size_t size) {
    char folder[MU_LONGEST_PATH], path[MU_LONGEST_PATH + sizeof MODULE];
    for (size_t i = 0; mu_search_directory(i, folder, sizeof folder); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, MODULE);
        if (access(path, R_OK) != 0) continue;
        void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (!module) snprintf(why, size, "%s", dlerror());
        return module;
    }
    return NULL;
}

/* A function of the module, which is left open: OpenImageIO keeps threads of its own, which must not lose their code. */
static void *find(const char *file, const char *name, mu_error *error) {
    char why[512] = "";
    void *module = open_module(why, sizeof why);
    if (!module) {
        mu_fail(error, "%s: images need the module " MODULE ", which was %s%s", file,
                why[0] ? "found but does not load: "
                       : "not found in $MUSURF_PLUGIN_PATH, beside the program or library, or in ../lib/musurf",
                why);
        return NULL;
    }
    void *function = dlsym(module, name);
    if (!function)
        mu_fail(error, "%s: the module " MODULE " does not offer %s; is it of another version?", file, name);
    return function;
}

/* While threads may be started that are not ours: signals are for our own. */
static void hold_signals(sigset_t *before) {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, before);
}

float *mu_image_read(const char *file, int *width, int *height, mu_error *error) {
    mu_reader reader;
    char why[512] = "";
    sigset_t before;
    hold_signals(&before);
    float *pixels = NULL;
    *(void **)&reader = find(file, "mu_oiio_read", error);
    if (reader && !(pixels = reader(file, width, height, why, sizeof why)))
        mu_fail(error, "%s: %s", file, why[0] ? why : "cannot be read as an image");
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return pixels;
}

double *mu_image_read_raw(const char *file, const char *channel, int *width, int *height, mu_error *error) {
    mu_raw_reader reader;
    char why[512] = "";
    sigset_t before;
    hold_signals(&before);
    double *values = NULL;
    *(void **)&reader = find(file, "mu_oiio_read_raw", error);
    if (reader && !(values = reader(file, channel, width, height, why, sizeof why)))
        mu_fail(error, "%s: %s", file, why[0] ? why : "cannot be read as an image");
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return values;
}

float *mu_image_read_channels(const char *file, const char *const *names, _Bool named, int count, int *width,
                              int *height, double *step, mu_error *error) {
    mu_channel_reader reader;
    char why[512] = "";
    sigset_t before;
    hold_signals(&before);
    float *values = NULL;
    *(void **)&reader = find(file, "mu_oiio_read_channels", error);
    if (reader && !(values = reader(file, names, named, count, width, height, step, why, sizeof why)))
        mu_fail(error, "%s: %s", file, why[0] ? why : "cannot be read as an image");
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return values;
}
