/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* soup_file.c: reads triangles; every number is finite, every index is that of a vertex, no triangle is a line. */
#include "core/render/soup_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/document.h"

typedef struct mu_corners { /* vertices so far, and the soup that is made of them */
    double (*v)[3];
    size_t count, room;
    mu_soup *soup;
    const char *file;
    mu_error *error;
} mu_corners;

static _Bool put_vertex(mu_corners *c, const double p[3]) {
    if (c->count == c->room) {
        c->room = 2 * c->room + 64;
        double(*more)[3] = realloc(c->v, c->room * sizeof *more);
        if (!more) return mu_fail(c->error, "%s: not enough memory", c->file);
        c->v = more;
    }
    memcpy(c->v[c->count++], p, sizeof *c->v);
    return 1;
}

static _Bool put_triangle(mu_corners *c, const size_t corner[3]) {
    mu_soup *soup = c->soup;
    if (soup->count == MU_SOUP_MOST)
        return mu_fail(c->error, "%s: more than %d triangles", c->file, MU_SOUP_MOST);
    for (int k = 0; k < 3; k++) memcpy(soup->triangles[soup->count].p[k], c->v[corner[k]], sizeof *c->v);
    double n[3], longest = 0;
    mu_soup_normal(soup, soup->count, n);
    for (int k = 0; k < 3; k++)
        for (int x = 0; x < 3; x++)
            longest = fmax(longest, fabs(soup->triangles[soup->count].p[k][x] -
                                         soup->triangles[soup->count].p[(k + 1) % 3][x]));
    if (!(hypot(hypot(n[0], n[1]), n[2]) > 1e-14 * longest * longest))
        return mu_fail(c->error, "%s: triangle %zu has no area", c->file, soup->count);
    soup->count++;
    return 1;
}

/* ------------------------------------------------------------------------------------------------------- OBJ */

static _Bool read_obj_vertex(mu_corners *c, const char *at, size_t line) {
    double p[3];
    for (int k = 0; k < 3; k++) {
        char *end;
        p[k] = strtod(at, &end);
        if (end == at || !isfinite(p[k]))
            return mu_fail(c->error, "%s:%zu: a vertex needs three numbers", c->file, line);
        at = end;
    }
    return put_vertex(c, p);
}

/* 7, 7/1, 7/1/3, 7//3, or counted from the end: -1. */
static _Bool read_obj_face(mu_corners *c, const char *at, size_t line) {
    size_t corner[3] = {0}, count = 0;
    for (;; count++) {
        char *end;
        at += strspn(at, " \t\r");
        if (!*at) break;
        const long long index = strtoll(at, &end, 10);
        const long long vertex = index < 0 ? (long long)c->count + index : index - 1;
        if (end == at || vertex < 0 || vertex >= (long long)c->count)
            return mu_fail(c->error, "%s:%zu: a face names a vertex that is not there", c->file, line);
        at = end + strcspn(end, " \t\r");
        if (count > 2) corner[1] = corner[2];
        corner[count < 2 ? count : 2] = (size_t)vertex;
        if (count >= 2 && !put_triangle(c, corner)) return 0;
    }
    return count >= 3 || mu_fail(c->error, "%s:%zu: a face needs three corners", c->file, line);
}

static _Bool read_obj(mu_corners *c, FILE *stream) {
    static const char *const passed[] = {"vn", "vt", "vp", "g", "o", "s", "usemtl", "mtllib"};
    char *text = NULL;
    size_t room = 0, line = 0;
    _Bool good = 1;
    while (good && getline(&text, &room, stream) >= 0) {
        char *at = text + strspn(text, " \t");
        line++;
        at[strcspn(at, "#\n")] = '\0';
        const size_t word = strcspn(at, " \t\r");
        _Bool known = word == 0;
        for (size_t k = 0; k < sizeof passed / sizeof passed[0]; k++)
            known = known || (strlen(passed[k]) == word && strncmp(at, passed[k], word) == 0);
        if (known) continue;
        if (word == 1 && *at == 'v')
            good = read_obj_vertex(c, at + 1, line);
        else if (word == 1 && *at == 'f')
            good = read_obj_face(c, at + 1, line);
        else
            good = mu_fail(c->error, "%s:%zu: \"%.20s\" is neither v nor f", c->file, line, at);
    }
    if (good && ferror(stream)) good = mu_fail(c->error, "%s: %s", c->file, strerror(errno));
    free(text);
    return good;
}

/* ------------------------------------------------------------------------------------------------------ JSON */

static _Bool read_members(mu_corners *c, const mu_place *root) {
    static const char *const known[] = {"vertices", "triangles", "period", NULL};
    const mu_place vertices = mu_place_member(root, "vertices"),
                   triangles = mu_place_member(root, "triangles"), period = mu_place_member(root, "period");
    if (!mu_place_only(root, known, c->error)) return 0;
    if (!json_is_array(vertices.value))
        return mu_place_fail(&vertices, c->error, "a list of vertices is needed");
    if (!json_is_array(triangles.value))
        return mu_place_fail(&triangles, c->error, "a list of triangles is needed");
    for (size_t k = 0; k < json_array_size(vertices.value); k++) {
        const mu_place place = mu_place_element(&vertices, k);
        double p[3];
        if (!mu_place_numbers(&place, 3, -1e300, 1e300, p, c->error) || !put_vertex(c, p)) return 0;
    }
    for (size_t k = 0; k < json_array_size(triangles.value); k++) {
        const mu_place place = mu_place_element(&triangles, k);
        size_t corner[3];
        if (!json_is_array(place.value) || json_array_size(place.value) != 3)
            return mu_place_fail(&place, c->error, "three indices of vertices are needed");
        for (size_t x = 0; x < 3; x++) {
            const mu_place index = mu_place_element(&place, x);
            long long number = 0;
            if (!mu_place_integer(&index, 0, (long long)c->count - 1, &number, c->error)) return 0;
            corner[x] = (size_t)number;
        }
        if (!put_triangle(c, corner)) return 0;
    }
    if (!period.value) return 1;
    if (!json_is_array(period.value) || json_array_size(period.value) != 2)
        return mu_place_fail(&period, c->error, "two vectors are needed, [[x, y], [x, y]]");
    for (size_t k = 0; k < 2; k++) {
        const mu_place place = mu_place_element(&period, k);
        if (!mu_place_numbers(&place, 2, -1e300, 1e300, c->soup->period[k], c->error)) return 0;
    }
    const double(*e)[2] = c->soup->period;
    const double det = e[0][0] * e[1][1] - e[0][1] * e[1][0];
    return fabs(det) > 1e-14 * hypot(e[0][0], e[0][1]) * hypot(e[1][0], e[1][1]) ||
           mu_place_fail(&period, c->error, "the two vectors span no area");
}

static _Bool read_json(mu_corners *c) {
    mu_document document;
    if (!mu_document_read(&document, c->file, c->error)) return 0;
    const mu_place root = mu_place_root(&document);
    const _Bool good = json_is_object(root.value) ? read_members(c, &root)
                                                  : mu_place_fail(&root, c->error, "an object is needed");
    mu_document_free(&document);
    return good;
}

_Bool mu_soup_read(const char *file, mu_soup *soup, mu_error *error) {
    *soup = (mu_soup){.triangles = calloc(MU_SOUP_MOST + 1, sizeof *soup->triangles)};
    mu_corners c = {.soup = soup, .file = file, .error = error};
    FILE *stream = fopen(file, "rbe");
    _Bool good = 1;
    int first = EOF;
    if (!soup->triangles) good = mu_fail(error, "not enough memory for %d triangles", MU_SOUP_MOST);
    if (good && !stream) good = mu_fail(error, "%s: cannot be opened: %s", file, strerror(errno));
    if (good) {
        do first = getc(stream);
        while (first == ' ' || first == '\t' || first == '\r' || first == '\n');
        rewind(stream);
        good = first == '{' ? read_json(&c) : read_obj(&c, stream);
    }
    if (good && !soup->count) good = mu_fail(error, "%s: has no triangle", file);
    if (stream) fclose(stream);
    free(c.v);
    return good;
}
