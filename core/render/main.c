/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * main.c: `musurf COMMAND ...`. Picks the command, and answers for standard output: a reader that went away
 * or a full disk is a failure (exit 1, one line), never a silent success and never a signal.
 */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/render/command.h"
#include "core/render/document.h"

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *doc;
} commands[] = {
    {"eval", mu_command_eval, "values of materials at given directions, JSON Lines in and out"},
    {"sample", mu_command_sample, "directions drawn from a material"},
    {"render", mu_command_render, "an image of a scene file"},
    {"wedge", mu_command_wedge, "a contact sheet of a scene whose values vary"},
    {"check", mu_command_check, "the numerical validation: random materials, and those of scenes"},
    {"surface", mu_command_surface, "explicit microsurfaces: make heightfields, measure what theory says of them, write meshes"},
    {"tension", mu_command_tension, "how a mesh deforms, as the linear map of its microsurface"},
    {"ibl", mu_command_ibl, "image-based lighting: the major axis of a lobe and samples along it"},
    {"info", mu_command_info, "distributions, parameters, build"},
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_help(FILE *out) {
    fprintf(out, "usage: musurf COMMAND [OPTIONS]\n\n"
                 "Microfacet materials whose microsurface is linearly transformed.\n\n"
                 "commands:\n");
    for (int i = 0; i < COMMAND_COUNT; i++) fprintf(out, "  %-8s  %s\n", commands[i].name, commands[i].doc);
    fprintf(
        out,
        "\n  musurf COMMAND --help   all about a command\n"
        "  musurf --version        the version\n\n"
        "Results go to standard output, messages to standard error. Exit codes: 0 ok, 1 a check failed or "
        "an\n"
        "input line was bad, 2 usage or refused input, 130 interrupted.\n"
        "MUSURF_PLUGIN_PATH: directories of plugins (vendor_material.so), separated by colons; they come\n"
        "before the program's own directory and ../lib/musurf beside it.\n");
}

static int refuse_command(const char *word) {
    const char *known[COMMAND_COUNT + 1] = {NULL};
    for (int i = 0; i < COMMAND_COUNT; i++) known[i] = commands[i].name;
    const char *const nearest = mu_nearest(word, known);
    mu_error line = {.text = ""};
    if (nearest)
        mu_fail(&line, "there is no command \"%.60s\"; did you mean \"%s\"?", word, nearest);
    else
        mu_fail(&line, "there is no command \"%.60s\"; see musurf --help", word);
    fprintf(stderr, "musurf: %s\n", line.text);
    return MU_EXIT_REFUSED;
}

/* A caller may have closed some of the three standard files; nothing that we open may end up in their place.
 * The replacements fail when used the way the missing file would have been. */
static void fill_standard_files(void) {
    static const int modes[3] = {O_WRONLY, O_RDONLY, O_WRONLY};
    for (int i = 0; i < 3; i++)
        if (fcntl(i, F_GETFD) < 0 && errno == EBADF && open("/dev/null", modes[i]) < 0) return;
}

static int run(int argc, char **argv) {
    if (argc < 2) {
        print_help(stderr);
        return MU_EXIT_REFUSED;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(stdout);
        return MU_EXIT_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("musurf %s\n", MUSURF_VERSION);
        return MU_EXIT_OK;
    }
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(argv[1], commands[i].name) == 0) return commands[i].run(argc - 1, argv + 1);
    return refuse_command(argv[1]);
}

int main(int argc, char **argv) {
    static char buffer[1 << 16];
    fill_standard_files();
    setvbuf(stdout, buffer, _IOFBF, sizeof buffer); /* commands that talk with a partner flush on their own */
    signal(SIGPIPE, SIG_IGN);
    int code = run(argc, argv);
    errno = 0;
    const _Bool failed_before = ferror(stdout);
    if ((fflush(stdout) != 0 || failed_before) && code == MU_EXIT_OK) {
        fprintf(stderr, "musurf: standard output: %s\n", errno ? strerror(errno) : "could not be written");
        code = MU_EXIT_FAILED;
    }
    return code;
}
