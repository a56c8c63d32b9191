/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* povray_run.c: a folder, a child, and what the child has to say. */
#include "core/render/povray_run.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

enum { MOST_ARGUMENTS = 24, LOG = 1 << 16 };

static const char *program(void) {
    const char *named = getenv("POVRAY");
    return named && *named ? named : "povray";
}

static void path(const mu_povray *run, const char *name, char out[4200]) {
    snprintf(out, 4200, "%s/%s", run->folder, name);
}

_Bool mu_povray_begin(mu_povray *run, mu_error *error) {
    const char *place = getenv("TMPDIR");
    snprintf(run->folder, sizeof run->folder, "%s/musurf-povray-XXXXXX", place && *place ? place : "/tmp");
    if (mkdtemp(run->folder)) return 1;
    mu_fail(error, "%s: no temporary folder can be made: %s", run->folder, strerror(errno));
    run->folder[0] = 0;
    return 0;
}

void mu_povray_end(mu_povray *run) {
    DIR *folder = run->folder[0] ? opendir(run->folder) : NULL;
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, ".."))
            unlinkat(dirfd(folder), entry->d_name, 0);
    if (folder) closedir(folder);
    if (run->folder[0]) rmdir(run->folder);
    run->folder[0] = 0;
}

/* ------------------------------------------------------------------------------------------------------------- child */

/* Signals that end us; while they are blocked, they wait for sigtimedwait, together with the child's end. */
static void watched_signals(sigset_t *set, _Bool child) {
    sigemptyset(set);
    sigaddset(set, SIGINT);
    sigaddset(set, SIGTERM);
    sigaddset(set, SIGHUP);
    if (child) sigaddset(set, SIGCHLD);
}

/* 0 or errno. Input is empty, and all that is said goes to "log". */
static int start(const mu_povray *run, const char *const *arguments, const sigset_t *mask, pid_t *child) {
    char *list[MOST_ARGUMENTS + 1] = {NULL}, log[4200];
    for (int k = 0; arguments[k] && k < MOST_ARGUMENTS; k++) list[k] = (char *)(uintptr_t)arguments[k];
    path(run, "log", log);
    sigset_t defaults;
    watched_signals(&defaults, 1);
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&how);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&files, 1, 2);
    posix_spawn_file_actions_addchdir_np(&files, run->folder);
    posix_spawnattr_setsigmask(&how, mask);
    posix_spawnattr_setsigdefault(&how, &defaults);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int code = posix_spawnp(child, list[0], &files, &how, list, environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&how);
    return code;
}

/* Waits for the child; a signal that ends us ends it. The number of that signal, or 0. */
static int attend(pid_t child, const sigset_t *watched, int *status) {
    int met = 0;
    while (waitpid(child, status, WNOHANG) == 0) {
        const struct timespec most = {
            .tv_nsec = 100000000}; /* the child's signal may have been taken by another wait */
        const int number = sigtimedwait(watched, NULL, &most);
        if (number <= 0 || number == SIGCHLD) continue;
        met = number;
        kill(child, SIGKILL);
    }
    return met;
}

/* POV-Ray's own words: the lines that speak of an error or a failure, or else the last ones. */
static void complaint(const mu_povray *run, char *out, size_t size) {
    char log[4200], line[400], last[400] = "no message";
    size_t length = 0;
    out[0] = 0;
    path(run, "log", log);
    FILE *said = fopen(log, "re");
    while (said && fgets(line, sizeof line, said)) {
        line[strcspn(line, "\r\n")] = 0;
        const char *text = line + strspn(line, " \t=");
        if (!*text) continue;
        snprintf(last, sizeof last, "%s", text);
        if ((strstr(text, "rror") || strstr(text, "ailed") || strstr(text, "emory")) && length < size)
            length += (size_t)snprintf(out + length, size - length, "%s%s", length ? "; " : "", text);
    }
    if (said) fclose(said);
    if (!length) snprintf(out, size, "%s", last);
}

static _Bool run_it(const mu_povray *run, const char *const *arguments, mu_error *error) {
    sigset_t watched, before;
    watched_signals(&watched, 1);
    pthread_sigmask(SIG_BLOCK, &watched, &before);
    pid_t child = 0;
    int status = 0, met = 0;
    const int code = start(run, arguments, &before, &child);
    if (!code) met = attend(child, &watched, &status);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (code)
        return mu_fail(
            error,
            "POV-Ray cannot be started (\"%s\": %s); install it (Debian: povray), or name it in $POVRAY",
            arguments[0], strerror(code));
    if (met) return 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 1;
    char words[600];
    complaint(run, words, sizeof words);
    if (WIFSIGNALED(status))
        return mu_fail(error, "POV-Ray was ended by signal %d: %s", WTERMSIG(status), words);
    return mu_fail(error, "POV-Ray failed: %s", words);
}

/* ------------------------------------------------------------------------------------------------------- what it does */

_Bool mu_povray_version(char *out, size_t size, mu_error *error) {
    mu_povray run;
    if (!mu_povray_begin(&run, error)) return 0;
    const char *const arguments[] = {program(), "--version", NULL};
    _Bool good = run_it(&run, arguments, error);
    char log[4200], line[200] = "";
    path(&run, "log", log);
    FILE *said = good ? fopen(log, "re") : NULL;
    _Bool found = 0;
    while (said && !found && fgets(line, sizeof line, said)) found = !strncmp(line, "POV-Ray ", 8);
    if (said) fclose(said);
    if (good && !found)
        good = mu_fail(error, "\"%s --version\" does not say that it is POV-Ray", arguments[0]);
    line[strcspn(line, "\r\n")] = 0;
    snprintf(out, size, "%s", line);
    mu_povray_end(&run);
    return good;
}

/* "P6", width, height, 255, with comments in between. */
static _Bool read_head(FILE *image, uint32_t width, uint32_t height) {
    const unsigned expected[3] = {width, height, 255};
    if (getc(image) != 'P' || getc(image) != '6') return 0;
    for (int k = 0; k < 3; k++) {
        unsigned number;
        while (fscanf(image, " %1[#]%*[^\n]", (char[2]){0}) == 1) continue;
        if (fscanf(image, "%u", &number) != 1 || number != expected[k]) return 0;
    }
    return getc(image) == '\n';
}

FILE *mu_povray_scene(const mu_povray *run, mu_error *error) {
    char file[4200];
    path(run, "scene.pov", file);
    FILE *out = fopen(file, "we");
    if (!out) mu_fail(error, "%s: cannot be written: %s", file, strerror(errno));
    return out;
}

FILE *mu_povray_render(const mu_povray *run, FILE *scene, uint32_t width, uint32_t height, uint32_t threads,
                       mu_error *error) {
    errno = 0;
    const _Bool written = !ferror(scene);
    if (fclose(scene) || !written) {
        mu_fail(error, "%s: the scene cannot be written: %s", run->folder, strerror(errno ? errno : EIO));
        return NULL;
    }
    char w[32], h[32], t[32], file[4200];
    snprintf(w, sizeof w, "+W%u", width);
    snprintf(h, sizeof h, "+H%u", height);
    snprintf(t, sizeof t, "+WT%u", threads);
    /* No antialiasing, no window, no waiting; warnings and errors stay on stderr; values are written as they are. */
    const char *const arguments[] = {program(), "+Iscene.pov", "+Oimage.ppm",  "+FP", w,    h,
                                     t,         "-A",          "-D",           "-P",  "-C", "-GD",
                                     "-GR",     "-V",          "File_Gamma=1", NULL};
    if (!run_it(run, arguments, error)) return NULL;
    path(run, "image.ppm", file);
    FILE *image = fopen(file, "rbe");
    if (image && read_head(image, width, height)) return image;
    if (image) fclose(image);
    mu_fail(error, "POV-Ray wrote no image of %u x %u pixels as 8-bit PPM", width, height);
    return NULL;
}
