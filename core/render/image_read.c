/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_read.c: finds and opens the module. The dynamic loader knows what is open already; no state is kept
 * here. */
#include "core/render/image_read.h"

#include <dlfcn.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MODULE "musurf_oiio.so"

typedef float *(*mu_reader)(const char *file, int *width, int *height, char *message, size_t size);
typedef float *(*mu_channel_reader)(const char *file, const char *const *names, int named, int count, int *width,
                                    int *height, char *message, size_t size);
typedef double *(*mu_raw_reader)(const char *file, const char *channel, int *width, int *height,
                                 char *message, size_t size);

/* The first file of that name is taken; if it does not load, `why` says so and no other is tried in its
 * place. */
static void *open_in(const char *folder, size_t length, char *why, size_t size) {
    char path[PATH_MAX];
    const int written = snprintf(path, sizeof path, "%.*s/%s", (int)length, folder, MODULE);
    if (written < 0 || (size_t)written >= sizeof path || access(path, R_OK) != 0) return NULL;
    void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!module) snprintf(why, size, "%s", dlerror());
    return module;
}

static void *open_module(char *why, size_t size) {
    const char *path = getenv("MUSURF_PLUGIN_PATH");
    void *module = NULL;
    while (path && *path && !module && !why[0]) {
        const size_t length = strcspn(path, ":");
        if (length) module = open_in(path, length, why, size);
        path += length + (path[length] == ':');
    }
    char program[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (module || why[0] || length <= 0) return module;
    program[length] = 0;
    char *slash = strrchr(program, '/');
    if (!slash) return NULL;
    module = open_in(program, (size_t)(slash - program), why, size);
    if (module || why[0]) return module;
    snprintf(slash, sizeof program - (size_t)(slash - program), "/../lib/musurf");
    return open_in(program, strlen(program), why, size);
}

/* A function of the module, which is left open: OpenImageIO keeps threads of its own, which must not lose their code. */
static void *find(const char *file, const char *name, mu_error *error) {
    char why[512] = "";
    void *module = open_module(why, sizeof why);
    if (!module) {
        mu_fail(error, "%s: images need the module " MODULE ", which was %s%s", file,
                why[0] ? "found but does not load: "
                       : "not found in $MUSURF_PLUGIN_PATH, beside the program or in ../lib/musurf",
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
                              int *height, mu_error *error) {
    mu_channel_reader reader;
    char why[512] = "";
    sigset_t before;
    hold_signals(&before);
    float *values = NULL;
    *(void **)&reader = find(file, "mu_oiio_read_channels", error);
    if (reader && !(values = reader(file, names, named, count, width, height, why, sizeof why)))
        mu_fail(error, "%s: %s", file, why[0] ? why : "cannot be read as an image");
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return values;
}
