/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_output.c: files that appear whole or not at all, also when the disk is full. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "core/render/image.h"
#include "core/render/output.h"
#include "tests/film_fixture.h"

static const mu_image_info info = {.scene_file = "a.json"};

static void put(const char *file, const char *text) {
    FILE *out = fopen(file, "wb");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void assert_holds(const char *file, const char *text) {
    char found[256] = "";
    FILE *in = fopen(file, "rb");
    assert_non_null(in);
    (void)!fread(found, 1, sizeof found - 1, in);
    fclose(in);
    assert_string_equal(found, text);
}

static int files_in(const char *path) {
    char command[256];
    snprintf(command, sizeof command, "ls -A '%s' | wc -l", path);
    FILE *pipe = popen(command, "r");
    int count = -1;
    assert_int_equal(fscanf(pipe, "%d", &count), 1);
    pclose(pipe);
    return count;
}

/* Files may not grow beyond some KiB: what a full disk does, for one process. */
static void a_full_disk_leaves_the_old_file(void **state) {
    (void)state;
    mu_film film = noise_film(200, 100, 2);
    const mu_film_settings settings = {.width = 200, .height = 100};
    mkdir(in_folder("full"), 0777);
    const char *files[] = {in_folder("full/a.exr"), in_folder("full/a.png"), in_folder("full/a.resume")};
    for (int i = 0; i < 3; ++i) put(files[i], "old");
    struct rlimit old, small = {.rlim_cur = 16384, .rlim_max = RLIM_INFINITY};
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small.rlim_max = old.rlim_max;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (rlim_t limit = 0; limit <= 16384; limit = limit ? 4 * limit : 256) {
        small.rlim_cur = limit;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        mu_error errors[3] = {{.text = ""}, {.text = ""}, {.text = ""}};
        assert_false(mu_image_write_exr(files[0], &film, &settings, &info, &errors[0]));
        assert_false(mu_image_write_png(files[1], &film, &settings, &info, &errors[1]));
        assert_false(mu_film_save(&film, files[2], 1, &errors[2]));
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        for (int i = 0; i < 3; ++i) {
            assert_holds(files[i], "old");
            if (!strstr(errors[i].text, "File too large")) fail_msg("'%s' lacks the reason", errors[i].text);
        }
        assert_int_equal(files_in(in_folder("full")), 3); /* nothing beside */
    }
    signal(SIGXFSZ, handler);
    mu_film_free(&film);
}

static void output_places(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    mu_output output;
    assert_false(mu_output_check(in_folder("no/such/a.exr"), &error));
    assert_non_null(strstr(error.text, "No such file"));
    error.text[0] = 0;
    assert_false(mu_output_check(in_folder("."), &error));
    assert_non_null(strstr(error.text, "folder"));
    error.text[0] = 0;
    assert_false(mu_output_check("/dev/null", &error));
    assert_non_null(strstr(error.text, "device"));
    error.text[0] = 0;
    mkdir(in_folder("link"), 0777);
    assert_int_equal(symlink("nowhere/x", in_folder("link/broken")), 0);
    assert_false(mu_output_check(in_folder("link/broken"), &error));

    /* Through a symbolic link the file it leads to is replaced, and keeps its mode. */
    error.text[0] = 0;
    put(in_folder("link/real"), "old");
    chmod(in_folder("link/real"), 0640);
    assert_int_equal(symlink("real", in_folder("link/alias")), 0);
    assert_true(mu_output_open(&output, in_folder("link/alias"), &error));
    assert_true(mu_output_write(&output, "w", 1, 2));
    assert_true(mu_output_write(&output, "ne", 2, 0)); /* in any order */
    assert_holds(in_folder("link/real"), "old");
    assert_true(mu_output_commit(&output, &error));
    assert_holds(in_folder("link/real"), "new");
    struct stat status;
    assert_int_equal(lstat(in_folder("link/alias"), &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_int_equal(stat(in_folder("link/real"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);

    assert_true(mu_output_open(&output, in_folder("link/real"), &error));
    assert_true(mu_output_write(&output, "gone", 4, 0));
    mu_output_discard(&output);
    assert_holds(in_folder("link/real"), "new");
    assert_int_equal(files_in(in_folder("link")), 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_disk_leaves_the_old_file),
        cmocka_unit_test(output_places),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
