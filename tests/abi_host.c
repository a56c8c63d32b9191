/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* abi_host.c: the host side that the tests of the plugin contract share; see abi_host.h. */
#include "tests/abi_host.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

_Noreturn static void give_up(const char *what, const char *name) {
    fprintf(stderr, "%s: %s\n", what, name ? name : "");
    abort();
}

abi_plugin abi_open(const char *name) {
    const char *build = getenv("BUILD");
    char path[4096];
    snprintf(path, sizeof path, "%s%s/%s_material.so", build && *build == '/' ? "" : "./",
             build ? build : "build", name);
    abi_plugin opened = {.so = dlopen(path, RTLD_NOW | RTLD_LOCAL)};
    if (!opened.so) give_up("dlopen", dlerror());
    musurf_plugin_entry entry;
    *(void **)&entry = dlsym(opened.so, MUSURF_ENTRY_NAME);
    if (!entry) give_up("no entry point", path);
    opened.plugin = entry();
    return opened;
}

void abi_close(abi_plugin opened) {
    dlclose(opened.so);
}

const musurf_material_type *abi_type(int index) {
    static abi_plugin opened[ABI_TYPES];
    static const char *const names[ABI_TYPES] = {"template", "musurf"};
    if (!opened[index].so) opened[index] = abi_open(names[index]);
    return opened[index].plugin->types[0];
}

static void on_message(void *context, musurf_severity severity, uint32_t param, const char *text) {
    abi_host *host = context;
    (void)severity;
    host->messages++;
    host->param = param;
    snprintf(host->text, sizeof host->text, "%s", text);
}

static void *on_allocate(void *context, size_t bytes, size_t alignment) {
    abi_host *host = context;
    if (++host->allocations == host->fail_at) return NULL;
    if (alignment < sizeof(void *)) alignment = sizeof(void *);
    void *memory = NULL;
    if (posix_memalign(&memory, alignment, bytes)) return NULL;
    memset(memory, 0xa5, bytes); /* nobody may count on zeros */
    host->live++;
    return memory;
}

static void on_release(void *context, void *memory) {
    abi_host *host = context;
    if (memory) host->live--;
    free(memory);
}

void abi_host_start(abi_host *host) {
    *host = (abi_host){
        .host = {sizeof(musurf_host), MUSURF_ABI_MINOR, host, on_message, on_allocate, on_release}};
}

static const musurf_param *param_named(const musurf_material_type *type, const char *name, size_t length) {
    for (uint32_t i = 0; i < type->param_count; i++) {
        const musurf_param *param = (const musurf_param *)(const void *)((const char *)type->params +
                                                                         i * (size_t)type->params[0].size);
        if (strlen(param->name) == length && !memcmp(param->name, name, length)) return param;
    }
    give_up("no such parameter", name);
}

void abi_settings_read(abi_settings *settings, const musurf_material_type *type, const char *words) {
    *settings = (abi_settings){.count = 0};
    snprintf(settings->text, sizeof settings->text, "%s", words);
    for (char *rest = NULL, *word = strtok_r(settings->text, " ", &rest); word;
         word = strtok_r(NULL, " ", &rest)) {
        const size_t length = strcspn(word, "=");
        const musurf_param *param = param_named(type, word, length);
        musurf_setting *setting = &settings->setting[settings->count];
        double *values = settings->values[settings->count++];
        char *value = word + length + 1;
        *setting = (musurf_setting){.size = sizeof *setting, .param = param->id};
        if (*value == '@') {
            setting->source = MUSURF_SLOT;
            setting->slot = (uint32_t)strtoul(value + 1, NULL, 10);
        } else if (param->kind == MUSURF_CHOICE) {
            setting->text = value;
        } else {
            setting->values = values;
            for (int i = 0; i < ABI_VALUES && *value; i++, value += *value == ',', setting->count++)
                values[i] = strtod(value, &value);
        }
    }
}

musurf_material *abi_material(const musurf_material_type *type, const musurf_host *host, const char *words) {
    abi_settings settings;
    abi_settings_read(&settings, type, words);
    musurf_material *material = NULL;
    const musurf_host bare = {.size = sizeof bare};
    return type->compile(host ? host : &bare, settings.setting, settings.count, &material) == MUSURF_OK
               ? material
               : NULL;
}

const char *abi_words(const musurf_material_type *type, int index) {
    static const char *const lambert[] = {"", "reflectance=0.1,0.5,0.9", "reflectance=@0", NULL};
    static const char *const microfacet[] = {
        "",
        "ndf=ggx alpha=0.3",
        "ndf=ggx alpha=0.05 transform=5,0,0,1",
        "ndf=ggx alpha=0.4 transform=1,2,0,1",
        "ndf=ggx alpha=0.25 transform=@0",
        "ndf=beckmann alpha=0.2 transform=-1,0.3,0.2,2",
        "ndf=gtr alpha=0.1 gamma=1.7",
        "ndf=gtr alpha=0.0121 gamma=1.7 transform=1,2,0,1",
        "ndf=gtr alpha=0.3 gamma=3.5 transform=0,1,1,0.5 fresnel=dielectric fresnel.dielectric=1.3",
        "ndf=gtr alpha=0.2 gamma=0 transform=20,0,0,20 fresnel=schlick fresnel.schlick=0.04,0.5,1",
        "ndf=ggx alpha=0 fresnel=conductor fresnel.conductor=Au",
        "ndf=beckmann alpha=0.3 sampler=ndf stretch=0.5",
        "ndf=tabulated histogram=3,2,-0.8,1,-0.5,0.9,1,2,0.5,0,3,1 transform=1,0.5,-0.2,0.8",
        "ndf=gtr alpha=0.2 gamma=1.3 transform=@2",
        "ndf=discrete_ggx alpha=0.3 transform=1,2,0,1 flakes.density=1e3 flakes.cone=0.1 "
        "footprint=3,4,0.2,0,0,0.1",
        "ndf=ggx alpha=@4 stretch=0.2",
        "ndf=std gamma=2.5 alpha_x=@4 alpha_y=@5 rotation=@1 transform=@0",
        "ndf=discrete_beckmann alpha=0.2 transform=@0 footprint=@4",
        "ndf=discrete_ggx alpha=0.2 flakes.density=1e4 footprint=@2",
        NULL};
    return strcmp(type->id, "template.lambert") ? microfacet[index] : lambert[index];
}

musurf_plan abi_plan(const musurf_material_type *type, const musurf_material *material) {
    musurf_plan plan = {.size = sizeof plan};
    type->describe(material, &plan);
    return plan;
}

static size_t pages_of(size_t bytes) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    return (bytes + page - 1) / page * page;
}

void *abi_guarded(size_t bytes) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), span = pages_of(bytes);
    char *memory = mmap(NULL, span + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED || mprotect(memory + span, page, PROT_NONE)) give_up("mmap", "guard page");
    return memory + span - bytes;
}

void abi_guarded_free(void *memory, size_t bytes) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), span = pages_of(bytes);
    munmap((char *)memory + bytes - span, span + page);
}

/* A hash of integers to [0,1): a fixed list of inputs, not a random test. */
static float uniform_of(uint32_t index, uint32_t dimension) {
    uint32_t x = index * 0x9e3779b9u + dimension * 0x85ebca6bu + 1;
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return (float)((x ^ (x >> 16)) >> 8) * 0x1p-24f;
}

void abi_uniforms(uint32_t index, float u[3]) {
    for (uint32_t i = 0; i < 3; i++) u[i] = uniform_of(index, i);
}

void abi_direction(uint32_t index, float direction[3]) {
    const float u = uniform_of(index, 3), phi = 6.2831853f * uniform_of(index, 4);
    float z = sqrtf(u);
    if (index % 37 == 5) z = 1e-6f;
    if (index % 53 == 7) z = 1;
    const float r = sqrtf((1 - z) * (1 + z));
    direction[0] = r * cosf(phi);
    direction[1] = r * sinf(phi);
    direction[2] = z;
}
