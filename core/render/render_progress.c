/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_progress.c: a bar on a terminal, lines of JSON for programs, one last line for everyone. */
#include "core/render/render_progress.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

mu_progress mu_progress_begin(const mu_render_options *options) {
    mu_progress progress = {.last = -1, .command = "render"};
    const char *terminal = getenv("TERM");
    const _Bool bar = isatty(STDERR_FILENO) && terminal && strcmp(terminal, "dumb") != 0;
    progress.show = options->quiet                          ? MU_SHOW_NOTHING
                    : options->progress == MU_PROGRESS_JSON ? MU_SHOW_JSON
                    : options->progress == MU_PROGRESS_NONE ? MU_SHOW_LAST
                    : bar                                   ? MU_SHOW_BAR
                                                            : MU_SHOW_LAST;
    return progress;
}

/* 1:02:03, or 2:03 under an hour. */
static void print_duration(char text[32], double seconds) {
    const long long s = (long long)fmin(seconds + 0.5, 1e12);
    if (seconds < 0)
        snprintf(text, 32, "?");
    else if (s < 3600)
        snprintf(text, 32, "%lld:%02lld", s / 60, s % 60);
    else
        snprintf(text, 32, "%lld:%02lld:%02lld", s / 3600, s / 60 % 60, s % 60);
}

static void draw(mu_progress *progress, const mu_render_status *status) {
    struct winsize window;
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) || !window.ws_col ? 80 : window.ws_col;
    char text[160], eta[32], noise[32] = "", bar[64];
    print_duration(eta, status->remaining);
    if (status->noise >= 0 && isfinite(status->noise))
        snprintf(noise, sizeof noise, "  noise %.3g", status->noise);
    snprintf(text, sizeof text, " %3.0f %%  %u spp  %.1f Mray/s%s  eta %s", floor(100 * status->fraction),
             status->samples, 1e-6 * status->rays_per_second, noise, eta);
    const int room = columns - 3 - (int)strlen(text), width = room > 40 ? 40 : room;
    const int full = width > 0 ? (int)(status->fraction * width) : 0;
    for (int i = 0; i < width; ++i) bar[i] = i < full ? '#' : '.';
    bar[width > 0 ? width : 0] = '\0';
    fprintf(stderr, "\r%s%s%s%.*s\033[K", width > 0 ? "[" : "", bar, width > 0 ? "]" : "", columns - 1, text);
    progress->drawn = 1;
}

static void put(mu_progress *progress, const char *key, double value) {
    mu_json_number(&progress->json, key, value < 0 ? (double)NAN : value); /* unknown becomes null */
}

void mu_progress_prepare(mu_progress *progress, uint32_t done, uint32_t count) {
    if (progress->show == MU_SHOW_BAR) {
        fprintf(stderr, "\rpreparing the light: material %u of %u\033[K", done + 1, count);
        progress->drawn = 1;
    }
    if (progress->show != MU_SHOW_JSON) return;
    mu_json_begin(&progress->json);
    mu_json_string(&progress->json, "event", "preparing");
    put(progress, "done", done);
    put(progress, "of", count);
    mu_json_write(&progress->json, stderr);
}

void mu_progress_clear(mu_progress *progress) {
    if (progress->drawn) fputs("\r\033[K", stderr);
    progress->drawn = 0;
}

void mu_progress_report(mu_progress *progress, const mu_render_status *status) {
    if (progress->show == MU_SHOW_BAR) draw(progress, status);
    if (progress->show != MU_SHOW_JSON || (progress->last >= 0 && status->seconds - progress->last < 0.5))
        return;
    progress->last = status->seconds;
    mu_json_begin(&progress->json);
    mu_json_string(&progress->json, "event", "progress");
    put(progress, "fraction", status->fraction);
    put(progress, "samples", status->samples);
    put(progress, "seconds", status->seconds);
    put(progress, "remaining", status->remaining);
    put(progress, "rays_per_second", status->rays_per_second);
    put(progress, "noise", status->noise);
    mu_json_write(&progress->json, stderr);
}

static void say(mu_progress *progress, const char *event, const char *before, const char *text) {
    if (progress->show == MU_SHOW_NOTHING) return;
    mu_progress_clear(progress);
    if (progress->show == MU_SHOW_JSON) {
        mu_json_begin(&progress->json);
        mu_json_string(&progress->json, "event", event);
        mu_json_string(&progress->json, "text", text);
        mu_json_write(&progress->json, stderr);
    } else {
        fprintf(stderr, "musurf %s: %s%s\n", progress->command, before, text);
    }
}

void mu_progress_note(mu_progress *progress, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    say(progress, "note", "", text);
}

void mu_progress_warn(void *progress, const char *text) {
    say(progress, "warning", "warning: ", text);
}

void mu_progress_end(mu_progress *progress, const char *event, const char *file, const mu_film *film) {
    uint32_t least, most;
    mu_progress_clear(progress);
    mu_film_samples(film, &least, &most);
    const double noise = mu_film_noise(film);
    const double rate = film->seconds > 0 ? (double)film->rays / film->seconds : 0;
    if (progress->show == MU_SHOW_JSON) {
        mu_json_begin(&progress->json);
        mu_json_string(&progress->json, "event", event);
        if (file) mu_json_string(&progress->json, "file", file);
        put(progress, "width", film->width);
        put(progress, "height", film->height);
        put(progress, "samples", least);
        put(progress, "seconds", film->seconds);
        put(progress, "rays", (double)film->rays);
        put(progress, "rays_per_second", rate);
        put(progress, "noise", noise);
        put(progress, "refused_samples", (double)film->refused);
        mu_json_write(&progress->json, stderr);
    } else if (progress->show != MU_SHOW_NOTHING && file) {
        char text[48] = "";
        if (isfinite(noise)) snprintf(text, sizeof text, ", noise %.3g", noise);
        fprintf(stderr, "%s: %u x %u, %u samples per pixel, %.2f s, %.2f Mray/s%s\n", file, film->width,
                film->height, least, film->seconds, 1e-6 * rate, text);
    }
    if (film->refused && progress->show != MU_SHOW_JSON)
        mu_progress_note(
            progress,
            "%llu samples or contributions were not finite and count as black; please report this scene",
            (unsigned long long)film->refused);
    mu_json_free(&progress->json);
}
