/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scratch.h: a folder for a test's files, gone when the test is over. */
#ifndef MU_TEST_SCRATCH_H
#define MU_TEST_SCRATCH_H

#include <stddef.h>

/* Group setup and teardown for cmocka; the folder's path is *state. */
int test_scratch_make(void **state);
int test_scratch_remove(void **state);
/* Writes a file there and returns its path, valid until the next call. */
const char *test_scratch_write(void **state, const char *name, const void *bytes, size_t size);
const char *test_scratch_text(void **state, const char *name, const char *text);

#endif
