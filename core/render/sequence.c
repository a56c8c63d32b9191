/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* sequence.c: see sequence.h. */
#include "core/render/sequence.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The run of # as [*first, *last); false: there is none. */
static _Bool find_run(const char *pattern, size_t *first, size_t *last) {
    const char *slash = strrchr(pattern, '/'), *name = slash ? slash + 1 : pattern,
               *hash = strrchr(name, '#');
    if (!hash) return 0;
    *last = (size_t)(hash - pattern) + 1;
    for (*first = *last - 1; *first > 0 && pattern[*first - 1] == '#';) --*first;
    return 1;
}

_Bool mu_sequence_is(const char *pattern) {
    size_t first, last;
    return find_run(pattern, &first, &last) && access(pattern, F_OK) != 0;
}

char *mu_sequence_file(const char *pattern, long long frame) {
    size_t first, last;
    if (!find_run(pattern, &first, &last)) return strdup(pattern);
    const size_t room = strlen(pattern) + 32;
    char *file = malloc(room);
    if (file)
        snprintf(file, room, "%.*s%0*lld%s", (int)first, pattern, (int)(last - first), frame, pattern + last);
    return file;
}

/* The number in the name of a file of the sequence, or MU_NO_FRAME. prefix, suffix: of names in the folder. */
static long long number_of(const char *name, const char *prefix, size_t prefix_length, const char *suffix,
                           size_t digits) {
    const size_t length = strlen(name), tail = strlen(suffix);
    if (length <= prefix_length + tail || strncmp(name, prefix, prefix_length) ||
        strcmp(name + length - tail, suffix))
        return MU_NO_FRAME;
    const char *text = name + prefix_length;
    const size_t count = length - tail - prefix_length;
    if (strspn(text, "0123456789") < count || count < digits || count > 9 || (count > digits && *text == '0'))
        return MU_NO_FRAME;
    return strtoll(text, NULL, 10);
}

static int compare(const void *a, const void *b) {
    const long long x = *(const long long *)a, y = *(const long long *)b;
    return (x > y) - (x < y);
}

static _Bool append(long long **frames, size_t count, long long frame) {
    if (!(count & (count + 1))) { /* room for 0, 1, 3, 7, ... is used up */
        long long *larger = realloc(*frames, (2 * count + 1) * sizeof *larger);
        if (!larger) return 0;
        *frames = larger;
    }
    (*frames)[count] = frame;
    return 1;
}

_Bool mu_sequence_list(const char *pattern, long long **frames, size_t *count, mu_error *error) {
    size_t first = 0, last = 0;
    const char *slash = strrchr(pattern, '/');
    const size_t start = slash ? (size_t)(slash - pattern) + 1 : 0;
    *frames = NULL, *count = 0;
    find_run(pattern, &first, &last);
    char *folder = slash ? strndup(pattern, start) : strdup(".");
    DIR *open = folder ? opendir(folder) : NULL;
    const int why = errno;
    free(folder);
    if (!open) return mu_fail(error, "%s: %s", pattern, strerror(why));
    _Bool good = 1;
    for (struct dirent *entry; good && (entry = readdir(open));) {
        const long long frame =
            number_of(entry->d_name, pattern + start, first - start, pattern + last, last - first);
        if (frame == MU_NO_FRAME) continue;
        good = append(frames, *count, frame);
        *count += good;
    }
    closedir(open);
    if (!good) mu_fail(error, "%s: not enough memory", pattern);
    if (good && !*count) good = mu_fail(error, "%s: there is no file of this sequence", pattern);
    if (good) qsort(*frames, *count, sizeof **frames, compare);
    if (!good) free(*frames), *frames = NULL;
    return good;
}
