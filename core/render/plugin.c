/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * plugin.c: finds and opens shared objects of materials, each once and only when something names it.
 *
 * "vendor.name" is looked for in vendor_material.so, where search.h says. The first file of that name is taken; if it
 * cannot be used that is an error, not a reason to look further: a broken plugin must not be replaced silently by
 * another.
 */
#include "core/render/plugin.h"
#include "core/render/search.h"
#include "core/render/text.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct opened {
    char *vendor, *file;
    void *handle;
    const musurf_plugin *plugin;
    struct opened *next;
} opened;

struct mu_plugins {
    opened *first;
};

mu_plugins *mu_plugins_new(void) {
    return calloc(1, sizeof(mu_plugins));
}

static void close_one(opened *o) {
    if (!o) return;
    if (o->handle) dlclose(o->handle);
    free(o->vendor);
    free(o->file);
    free(o);
}

void mu_plugins_free(mu_plugins *plugins) {
    if (!plugins) return;
    for (opened *o = plugins->first, *next; o; o = next) {
        next = o->next;
        close_one(o);
    }
    free(plugins);
}

const char *mu_plugins_opened(const mu_plugins *plugins, size_t index) {
    const opened *o = plugins->first;
    while (o && index--) o = o->next;
    return o ? o->file : NULL;
}

/* A vendor becomes part of a file name, so it holds letters, digits, - and _ only. */
static _Bool is_vendor(const char *text, size_t length) {
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return length > 0 && length <= 64 && strspn(text, allowed) >= length;
}

static char *find_file(const char *vendor, mu_error *error) {
    char directory[MU_LONGEST_PATH], file[MU_LONGEST_PATH + 128], tried[512] = "";
    for (size_t i = 0; mu_search_directory(i, directory, sizeof directory); i++) {
        snprintf(file, sizeof file, "%s/%s_material.so", directory, vendor);
        if (access(file, F_OK) == 0) return strdup(file);
        if (tried[0]) mu_append(tried, sizeof tried, ", ");
        mu_append(tried, sizeof tried, directory);
    }
    mu_fail(error, "there is no plugin %s_material.so in %s; MUSURF_PLUGIN_PATH can name other directories",
            vendor, tried);
    return NULL;
}

static opened *open_one(const char *vendor, mu_error *error) {
    char *file = find_file(vendor, error);
    if (!file) return NULL;
    opened *o = calloc(1, sizeof *o);
    if (!o || !(o->vendor = strdup(vendor))) {
        mu_fail(error, "%s: not enough memory", file);
        free(file);
        close_one(o);
        return NULL;
    }
    o->file = file;

    o->handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!o->handle) {
        const char *why = dlerror(); /* mostly begins with the file's name */
        const size_t length = strlen(file);
        if (strncmp(why, file, length) == 0 && why[length] == ':')
            why += length + 1 + strspn(why + length + 1, " ");
        mu_fail(error, "%s: cannot be opened as a plugin: %s", file, why);
    } else {
        /* POSIX guarantees that the object pointer of dlsym holds a function; ISO C has no cast for it. */
        void *const symbol = dlsym(o->handle, MUSURF_ENTRY_NAME);
        musurf_plugin_entry entry;
        memcpy(&entry, &symbol, sizeof entry);
        if (!symbol)
            mu_fail(error, "%s: exports no %s: no musurf plugin, or one for another major version than %d",
                    file, MUSURF_ENTRY_NAME, MUSURF_ABI_MAJOR);
        else if (mu_plugin_check(o->plugin = entry(), vendor, file, error))
            return o;
    }
    close_one(o);
    return NULL;
}

const musurf_plugin *mu_plugins_vendor(mu_plugins *plugins, const char *vendor, const char **file,
                                       mu_error *error) {
    opened *o = plugins->first;
    while (o && strcmp(o->vendor, vendor) != 0) o = o->next;
    if (!o) {
        o = open_one(vendor, error);
        if (!o) return NULL;
        o->next = plugins->first;
        plugins->first = o;
    }
    if (file) *file = o->file;
    return o->plugin;
}

const musurf_material_type *mu_plugins_type(mu_plugins *plugins, const char *id, mu_error *error) {
    const size_t length = strcspn(id, ".");
    char vendor[65];
    if (!is_vendor(id, length) || id[length] != '.' || id[length + 1] == '\0') {
        mu_fail(error,
                "\"%.80s\" does not name a material; \"vendor.name\" is needed, e.g. \"musurf.microfacet\"",
                id);
        return NULL;
    }
    memcpy(vendor, id, length);
    vendor[length] = '\0';

    const char *file;
    const musurf_plugin *plugin = mu_plugins_vendor(plugins, vendor, &file, error);
    if (!plugin) return NULL;
    char offered[512] = "";
    for (size_t i = 0; i < plugin->type_count; i++) {
        if (strcmp(plugin->types[i]->id, id) == 0) return plugin->types[i];
        mu_append(offered, sizeof offered, i ? ", " : " ");
        mu_append(offered, sizeof offered, plugin->types[i]->id);
    }
    mu_fail(error, "\"%.80s\" is not in %s; it offers%s", id, file, offered);
    return NULL;
}
