/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* options.c: --name VALUE, --name=VALUE, -n VALUE, operands anywhere, "--" before operands that begin with a
 * dash. */
#include "core/render/options.h"

#include <errno.h>
#include <inttypes.h>
#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/document.h"

int mu_refuse(const mu_usage *usage, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    mu_error line = {.text = ""};
    mu_fail(&line, "%s", text); /* makes it printable */
    fprintf(stderr, "musurf %s: %s\n", usage->command, line.text);
    return MU_EXIT_REFUSED;
}

uint32_t mu_processors(void) {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set)) return 1;
    const int count = CPU_COUNT(&set);
    return count > 0 ? (uint32_t)count : 1;
}

static void print_option(const char *name, const char *argument, const char *doc) {
    char left[80];
    snprintf(left, sizeof left, "%s%s%s%s", strlen(name) == 1 ? "-" : "--", name, argument ? " " : "",
             argument ? argument : "");
    for (const char *line = doc; *line;) {
        const size_t length = strcspn(line, "\n");
        if (strlen(left) > 24) {
            printf("  %s\n", left);
            left[0] = '\0';
        }
        printf("  %-24s  %.*s\n", left, (int)length, line);
        left[0] = '\0';
        line += length + (line[length] == '\n');
    }
}

static void print_help(const mu_usage *usage) {
    printf("usage: musurf %s %s\n\n%s\n", usage->command, usage->synopsis, usage->doc);
    printf("options:\n");
    for (const mu_option *o = usage->options; o->name; o++) print_option(o->name, o->argument, o->doc);
    print_option("help", NULL, "this text");
    if (usage->more) printf("\n%s", usage->more);
}

mu_options mu_options_begin(const mu_usage *usage, int argc, char **argv) {
    return (mu_options){.usage = usage, .argc = argc, .argv = argv, .next = 1};
}

static int unknown_option(const mu_options *options, const char *name) {
    const char *known[64] = {"help"};
    size_t count = 1;
    for (const mu_option *o = options->usage->options; o->name && count < 63; o++) known[count++] = o->name;
    known[count] = NULL;
    const char *const nearest = mu_nearest(name, known);
    if (nearest)
        mu_refuse(options->usage, "there is no option %s; did you mean %s%s?",
                  options->argv[options->next - 1], strlen(nearest) == 1 ? "-" : "--", nearest);
    else
        mu_refuse(options->usage, "there is no option %s; see musurf %s --help",
                  options->argv[options->next - 1], options->usage->command);
    return MU_OPTIONS_REFUSED;
}

int mu_options_next(mu_options *options) {
    if (options->next >= options->argc) return MU_OPTIONS_END;
    const char *const word = options->argv[options->next++];
    if (options->operands_only || word[0] != '-' || word[1] == '\0') {
        options->value = word;
        return MU_OPTIONS_OPERAND;
    }
    if (strcmp(word, "--") == 0) {
        options->operands_only = 1;
        return mu_options_next(options);
    }
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_help(options->usage);
        return MU_OPTIONS_HELP;
    }

    const _Bool is_long = word[1] == '-';
    char name[64];
    const size_t length = strcspn(word, "=");
    snprintf(name, sizeof name, "%.*s", (int)(length - (is_long ? 2 : 1)), word + (is_long ? 2 : 1));
    const mu_option *o = options->usage->options;
    while (o->name && !(strcmp(o->name, name) == 0 && (strlen(name) > 1 || !is_long || o->argument))) o++;
    if (!o->name || (!is_long && strlen(name) > 1)) return unknown_option(options, name);
    options->name = o->name;
    options->value = word[length] == '=' ? word + length + 1 : NULL;
    if (!o->argument && options->value) {
        mu_refuse(options->usage, "--%s takes no value", o->name);
        return MU_OPTIONS_REFUSED;
    }
    if (o->argument && !options->value) {
        if (options->next >= options->argc) {
            mu_refuse(options->usage, "%s needs a value: %s", word, o->argument);
            return MU_OPTIONS_REFUSED;
        }
        options->value = options->argv[options->next++];
    }
    return (int)(o - options->usage->options);
}

int mu_options_exit(int met) {
    return met == MU_OPTIONS_REFUSED ? MU_EXIT_REFUSED : MU_EXIT_OK;
}

_Bool mu_options_unsigned(const mu_options *options, uint64_t min, uint64_t max, uint64_t *out) {
    char *end;
    errno = 0;
    const unsigned long long value = strtoull(options->value, &end, 10);
    const _Bool digit = options->value[0] >= '0' && options->value[0] <= '9'; /* strtoull would take -1 */
    if (!digit || *end || errno || value < min || value > max) {
        mu_refuse(options->usage, "--%s is \"%s\"; a whole number from %" PRIu64 " to %" PRIu64 " is needed",
                  options->name, options->value, min, max);
        return 0;
    }
    *out = value;
    return 1;
}

_Bool mu_options_choice(const mu_options *options, const char *const *choices, int *out) {
    for (int i = 0; choices[i]; i++) {
        if (strcmp(choices[i], options->value) == 0) {
            *out = i;
            return 1;
        }
    }
    const char *const nearest = mu_nearest(options->value, choices);
    char list[256] = "";
    for (int i = 0; choices[i]; i++) {
        const size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", i ? ", " : "", choices[i]);
    }
    mu_refuse(options->usage, "--%s is \"%s\"%s%s%s; known: %s", options->name, options->value,
              nearest ? "; did you mean " : "", nearest ? nearest : "", nearest ? "?" : "", list);
    return 0;
}
