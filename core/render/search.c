/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* search.c: asks the environment, the dynamic loader and the system where that is. */
#include "core/render/search.h"

#include <dlfcn.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Takes the last part of a path away, and the slash before it. */
static void cut_last(char *path) {
    char *slash = strrchr(path, '/');
    if (slash) *slash = '\0';
}

/* The directory of the running program; empty if the system does not tell. */
static void program_directory(char out[MU_LONGEST_PATH]) {
    const ssize_t length = readlink("/proc/self/exe", out, MU_LONGEST_PATH - 1);
    out[length > 0 ? length : 0] = '\0';
    cut_last(out);
}

/* That of the shared object that this code is in; false if it is the program's own. */
static _Bool own_directory(char out[MU_LONGEST_PATH]) {
    static const char here = 0;
    Dl_info unused;
    struct link_map *object = NULL;
    if (!dladdr1(&here, &unused, (void **)&object, RTLD_DL_LINKMAP) || !object || !object->l_name[0]) return 0;
    char *whole = realpath(object->l_name, NULL);
    const _Bool good = whole && (size_t)snprintf(out, MU_LONGEST_PATH, "%s", whole) < MU_LONGEST_PATH;
    free(whole);
    if (good) cut_last(out);
    return good;
}

_Bool mu_search_directory(size_t index, char *out, size_t size) {
    const char *at = getenv("MUSURF_PLUGIN_PATH");
    while (at && *at) {
        const size_t length = strcspn(at, ":");
        if (length > 0 && length < size && index-- == 0) {
            memcpy(out, at, length);
            out[length] = '\0';
            return 1;
        }
        at += length + (at[length] == ':');
    }
    char found[MU_LONGEST_PATH];
    if (own_directory(found) && index-- == 0) return (size_t)snprintf(out, size, "%s", found) < size;
    if (index > 1) return 0;
    program_directory(found);
    if (index == 1) cut_last(found);
    return (size_t)snprintf(out, size, index == 0 ? "%s" : "%s/lib/musurf", found) < size;
}
