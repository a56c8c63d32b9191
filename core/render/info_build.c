/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* info_build.c: which compiler and which libraries. Versions are those in use where the library tells at run
 * time, else those it was built against. */
#include <assimp/version.h>
#include <embree3/rtcore_config.h>
#include <openexr.h>
#include <png.h>
#include <zlib.h>

#include "core/render/info.h"

json_t *mu_info_build(void) {
    int exr_major = 0, exr_minor = 0, exr_patch = 0;
    const char *exr_extra = NULL;
    exr_get_library_version(&exr_major, &exr_minor, &exr_patch, &exr_extra);
#ifdef __clang__
    const char *const compiler = "clang " __clang_version__;
#else
    const char *const compiler = "gcc " __VERSION__;
#endif
    return json_pack(
        "{s:s, s:s, s:s, s:{s:s, s:o, s:o, s:s, s:s, s:s}}", "version", MUSURF_VERSION, "compiler", compiler,
        "abi", MUSURF_ENTRY_NAME, "libraries", "embree", RTC_VERSION_STRING, "openexr",
        json_sprintf("%d.%d.%d", exr_major, exr_minor, exr_patch), "assimp",
        json_sprintf("%u.%u.%u", aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch()), "jansson",
        jansson_version_str(), "libpng", png_get_libpng_ver(NULL), "zlib", zlibVersion());
}
