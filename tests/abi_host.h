/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * abi_host.h: a host for tests of the plugin contract: opens the shared objects in $BUILD, counts its
 * callbacks, can refuse the n-th allocation, and hands out memory that ends at a page nobody may touch.
 */
#ifndef MU_ABI_HOST_H
#define MU_ABI_HOST_H

#include "plugin/musurf_plugin.h"

/* An open shared object. */
typedef struct abi_plugin {
    void *so;
    const musurf_plugin *plugin;
} abi_plugin;

/* "musurf" or "template": opens $BUILD/NAME_material.so, aborts the test if it cannot. */
abi_plugin abi_open(const char *name);
void abi_close(abi_plugin opened);

/* All types under test, of both plugins; stays open until the program ends. */
enum { ABI_TYPES = 2 };
const musurf_material_type *abi_type(int index);

typedef struct abi_host {
    musurf_host host; /* its context is this struct */
    int live;         /* allocations not yet released */
    int allocations;  /* so far */
    int fail_at;      /* the allocation, counted from 1, that gets NULL; 0: none */
    int messages;
    uint32_t param; /* of the last message */
    char text[512]; /* the last message */
} abi_host;

void abi_host_start(abi_host *host);

/* Settings from words: "ndf=gtr alpha=0.2 transform=1,2,0,1"; "alpha=@3" takes alpha from slot 3. Aborts the
 * test on a name that the table does not have. Returns the number of settings. */
enum { ABI_SETTINGS = 16, ABI_VALUES = 16 };
typedef struct abi_settings {
    musurf_setting setting[ABI_SETTINGS];
    size_t count;
    double values[ABI_SETTINGS][ABI_VALUES];
    char text[1024];
} abi_settings;
void abi_settings_read(abi_settings *settings, const musurf_material_type *type, const char *words);

/* compile() of such words; NULL when refused. `host` may be NULL. */
musurf_material *abi_material(const musurf_material_type *type, const musurf_host *host, const char *words);

/* The i-th material of a fixed list that covers the plans of `type`; NULL past its end. */
const char *abi_words(const musurf_material_type *type, int index);

/* The plan, whole. */
musurf_plan abi_plan(const musurf_material_type *type, const musurf_material *material);

/* Exactly `bytes` (rounded up to `alignment` at the front) before a page that faults when touched. */
void *abi_guarded(size_t bytes);
void abi_guarded_free(void *memory, size_t bytes);

/* A direction of the upper hemisphere for each index: cosine-distributed, now and then grazing or normal. */
void abi_direction(uint32_t index, float direction[3]);
void abi_uniforms(uint32_t index, float u[3]);

#endif
