/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* output.c: write beside, flush, rename (POSIX). */
#include "core/render/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The folder of `file`, with its slash; "" is the current one. */
static size_t folder_length(const char *file) {
    const char *slash = strrchr(file, '/');
    return slash ? (size_t)(slash - file) + 1 : 0;
}

_Bool mu_output_ends_in(const char *file, const char *ending) {
    const char *const name = file + folder_length(file);
    const size_t length = strlen(name), tail = strlen(ending);
    return length > tail && !strcmp(name + length - tail, ending);
}

/* Where the file really is, so that a symbolic link keeps pointing at what is renamed into place. */
static char *resolve(const char *file, mu_error *error) {
    struct stat status;
    if (lstat(file, &status)) {
        if (errno != ENOENT) {
            mu_fail(error, "%s: cannot be written: %s", file, strerror(errno));
            return NULL;
        }
    } else if (S_ISLNK(status.st_mode)) {
        char *target = realpath(file, NULL);
        if (!target) mu_fail(error, "%s: the symbolic link leads nowhere: %s", file, strerror(errno));
        return target;
    }
    char *target = strdup(file);
    if (!target) mu_fail(error, "%s: out of memory", file);
    return target;
}

_Bool mu_output_open(mu_output *output, const char *file, mu_error *error) {
    *output = (mu_output){.descriptor = -1};
    if (!*file) return mu_fail(error, "\"\" is no name of a file");
    output->target = resolve(file, error);
    if (!output->target) return 0;

    struct stat status;
    const _Bool exists = !stat(output->target, &status);
    if (exists && !S_ISREG(status.st_mode)) {
        mu_fail(error, "%s: is a %s, not a regular file", file,
                S_ISDIR(status.st_mode) ? "folder" : "device or pipe");
        goto failed;
    }
    if (exists && access(output->target, W_OK)) {
        mu_fail(error, "%s: exists and cannot be written: %s", file, strerror(errno));
        goto failed;
    }

    /* A short name of its own, so that any name that fits the file system fits here too. */
    const size_t folder = folder_length(output->target), room = folder + 64;
    output->beside = malloc(room);
    if (!output->beside) {
        mu_fail(error, "%s: out of memory", file);
        goto failed;
    }
    memcpy(output->beside, output->target, folder);
    for (int attempt = 0; output->descriptor < 0 && attempt < 1000; ++attempt) {
        snprintf(output->beside + folder, room - folder, ".musurf-%ld-%d.tmp", (long)getpid(), attempt);
        output->descriptor = open(output->beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (output->descriptor < 0 && errno != EEXIST) break;
    }
    if (output->descriptor < 0) {
        mu_fail(error, "%s: no file can be made in its folder: %s", file, strerror(errno));
        free(output->beside);
        output->beside = NULL;
        goto failed;
    }
    if (exists && fchmod(output->descriptor, status.st_mode & 0777) && errno != EPERM)
        output->trouble = errno; /* EPERM: another's file; a new one with our own mode is what rename gives */
    return 1;
failed:
    free(output->target);
    output->target = NULL;
    return 0;
}

_Bool mu_output_write(mu_output *output, const void *data, size_t bytes, uint64_t offset) {
    const char *from = data;
    while (bytes && !output->trouble) {
        const ssize_t written = pwrite(output->descriptor, from, bytes, (off_t)offset);
        if (written > 0) {
            from += written;
            bytes -= (size_t)written;
            offset += (uint64_t)written;
        } else if (written == 0 || errno != EINTR) {
            output->trouble = written == 0 ? ENOSPC : errno;
        }
    }
    return !output->trouble;
}

void mu_output_discard(mu_output *output) {
    if (output->descriptor >= 0) close(output->descriptor);
    if (output->beside) unlink(output->beside);
    free(output->beside);
    free(output->target);
    *output = (mu_output){.descriptor = -1};
}

/* The new name must survive a power cut too. Some file systems cannot flush a folder; the data are safe
 * anyway. */
static void flush_folder(const char *target) {
    const size_t length = folder_length(target);
    char *folder = length ? strndup(target, length) : strdup(".");
    if (!folder) return;
    const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        (void)fsync(descriptor);
        close(descriptor);
    }
    free(folder);
}

_Bool mu_output_commit(mu_output *output, mu_error *error) {
    if (!output->trouble && fsync(output->descriptor)) output->trouble = errno;
    if (close(output->descriptor) && !output->trouble) output->trouble = errno;
    output->descriptor = -1;
    if (!output->trouble && rename(output->beside, output->target)) output->trouble = errno;
    const int trouble = output->trouble;
    if (trouble) {
        mu_fail(error, "%s: cannot be written: %s", output->target, strerror(trouble));
    } else {
        free(output->beside);
        output->beside = NULL;
        flush_folder(output->target);
    }
    mu_output_discard(output);
    return !trouble;
}

_Bool mu_output_check(const char *file, mu_error *error) {
    mu_output output;
    if (!mu_output_open(&output, file, error)) return 0;
    mu_output_discard(&output);
    return 1;
}
