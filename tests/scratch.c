/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
#include "tests/scratch.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

int test_scratch_make(void **state) {
    const char *base = getenv("TMPDIR");
    char *folder = malloc(4096);
    if (!folder) return -1;
    snprintf(folder, 4096, "%s/musurf-test-XXXXXX", base ? base : "/tmp");
    *state = mkdtemp(folder);
    return *state ? 0 : -1;
}

int test_scratch_remove(void **state) {
    char path[8192];
    DIR *folder = opendir(*state);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        snprintf(path, sizeof path, "%s/%s", (char *)*state, entry->d_name);
        unlink(path);
    }
    if (folder) closedir(folder);
    const int failed = rmdir(*state);
    free(*state);
    return failed;
}

const char *test_scratch_write(void **state, const char *name, const void *bytes, size_t size) {
    static char path[8192];
    snprintf(path, sizeof path, "%s/%s", (char *)*state, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

const char *test_scratch_text(void **state, const char *name, const char *text) {
    return test_scratch_write(state, name, text, strlen(text));
}
