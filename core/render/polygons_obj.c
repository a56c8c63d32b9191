/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * polygons_obj.c: Wavefront OBJ with its own numbering, which assimp's reader does not keep: it makes a vertex of every
 * corner and sorts faces by material. Reads v, vt, vn and f (Wavefront, "Advanced Visualizer Manual", appendix B1);
 * other lines say nothing of the shape. Indices may be negative (from the end), a backslash continues a line.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/polygons.h"

typedef struct mu_list { /* of numbers or of indices */
    void *at;
    size_t count, room;
} mu_list;

typedef struct mu_obj {
    const char *file;
    unsigned long line;
    mu_list positions, uvs, normals;        /* double */
    mu_list first, vertex, texture, normal; /* uint32_t; the last two UINT32_MAX: none */
    mu_error *error;
} mu_obj;

static _Bool append(mu_obj *obj, mu_list *list, const void *item, size_t size) {
    if (list->count == list->room) {
        const size_t room = 2 * list->room + 256;
        void *larger = realloc(list->at, room * size);
        if (!larger) return mu_fail(obj->error, "%s: not enough memory", obj->file);
        list->at = larger, list->room = room;
    }
    memcpy((char *)list->at + list->count++ * size, item, size);
    return 1;
}

/* `needed` numbers, up to `most`; what is missing of the latter is 0. */
static _Bool read_numbers(mu_obj *obj, mu_list *list, const char *text, int needed, int most) {
    for (int k = 0; k < most; k++) {
        char *end;
        double value = strtod(text, &end);
        if (end == text && k < needed)
            return mu_fail(obj->error, "%s:%lu: %d numbers are needed, \"%.40s\" is none", obj->file,
                           obj->line, needed, text);
        if (end == text) value = 0;
        if (!(fabs(value) <= 1e9))
            return mu_fail(obj->error, "%s:%lu: a coordinate is %g; must be finite, within 1e9", obj->file,
                           obj->line, value);
        if (!append(obj, list, &value, sizeof value)) return 0;
        text = end;
    }
    return 1;
}

/* One index at *text, 1 for the first, -1 for the latest of `count`; moves on. */
static _Bool read_index(mu_obj *obj, char **text, size_t count, const char *what, uint32_t *out) {
    char *end;
    const long long given = strtoll(*text, &end, 10),
                    number = given < 0 ? given + (long long)count : given - 1;
    if (end == *text)
        return mu_fail(obj->error, "%s:%lu: \"%.40s\" is no index", obj->file, obj->line, *text);
    if (!given || number < 0 || number >= (long long)count)
        return mu_fail(obj->error, "%s:%lu: a face names %s %lld of %zu", obj->file, obj->line, what, given,
                       count);
    *text = end;
    *out = (uint32_t)number;
    return 1;
}

/* v, v/t, v//n or v/t/n. */
static _Bool read_corner(mu_obj *obj, char **text) {
    uint32_t vertex, texture = UINT32_MAX, normal = UINT32_MAX;
    if (!read_index(obj, text, obj->positions.count / 3, "vertex", &vertex)) return 0;
    if (**text == '/' && strcspn(++*text, " \t/") &&
        !read_index(obj, text, obj->uvs.count / 2, "texture coordinate", &texture))
        return 0;
    if (**text == '/' && strcspn(++*text, " \t") &&
        !read_index(obj, text, obj->normals.count / 3, "normal", &normal))
        return 0;
    if (strcspn(*text, " \t"))
        return mu_fail(obj->error, "%s:%lu: \"%.40s\" in a face", obj->file, obj->line, *text);
    return append(obj, &obj->vertex, &vertex, sizeof vertex) &&
           append(obj, &obj->texture, &texture, sizeof texture) &&
           append(obj, &obj->normal, &normal, sizeof normal);
}

static _Bool read_face(mu_obj *obj, char *text) {
    const uint32_t start = (uint32_t)obj->vertex.count;
    for (text += strspn(text, " \t"); *text; text += strspn(text, " \t"))
        if (!read_corner(obj, &text)) return 0;
    const size_t corners = obj->vertex.count - start;
    if (corners < 3 || corners > MU_POLYGON_MOST)
        return mu_fail(obj->error, "%s:%lu: a face of %zu vertices; must have 3 to %d", obj->file, obj->line,
                       corners, MU_POLYGON_MOST);
    if (obj->vertex.count > 0xc0000000u)
        return mu_fail(obj->error, "%s: more than 3 * 2^30 corners", obj->file);
    return append(obj, &obj->first, &start, sizeof start);
}

static _Bool read_line(mu_obj *obj, char *line) {
    line[strcspn(line, "#")] = '\0';
    line += strspn(line, " \t");
    const size_t length = strcspn(line, " \t");
    char *rest = line + length;
    if (length == 1 && *line == 'v') return read_numbers(obj, &obj->positions, rest, 3, 3);
    if (length == 2 && !strncmp(line, "vt", 2)) return read_numbers(obj, &obj->uvs, rest, 1, 2);
    if (length == 2 && !strncmp(line, "vn", 2)) return read_numbers(obj, &obj->normals, rest, 3, 3);
    if (length == 1 && *line == 'f') return read_face(obj, rest);
    return 1;
}

/* Joins continued lines; ends are cut off. */
static _Bool read_lines(mu_obj *obj, FILE *stream) {
    char *line = NULL, *more = NULL;
    size_t room = 0, more_room = 0;
    ssize_t length;
    _Bool good = 1;
    while (good && (length = getline(&line, &room, stream)) >= 0) {
        obj->line++;
        for (;;) {
            while (length > 0 && strchr("\r\n", line[length - 1])) line[--length] = '\0';
            if (!length || line[length - 1] != '\\') break;
            line[length - 1] = ' ';
            const ssize_t added = getline(&more, &more_room, stream);
            if (added < 0) break;
            obj->line++;
            char *larger = realloc(line, (size_t)(length + added) + 1);
            if (!larger) {
                good = mu_fail(obj->error, "%s: not enough memory", obj->file);
                break;
            }
            line = larger, room = (size_t)(length + added) + 1;
            memcpy(line + length, more, (size_t)added + 1);
            length += added;
        }
        good = good && read_line(obj, line);
    }
    if (good && ferror(stream)) good = mu_fail(obj->error, "%s: %s", obj->file, strerror(errno));
    free(line);
    free(more);
    return good;
}

static _Bool gather_uvs(mu_obj *obj, mu_polygons *out) {
    out->uv = malloc(((size_t)out->corners + 1) * 2 * sizeof *out->uv);
    if (!out->uv) return mu_fail(obj->error, "%s: not enough memory", obj->file);
    for (size_t i = 0; i < out->corners; i++) {
        const uint32_t at = ((const uint32_t *)obj->texture.at)[i];
        for (size_t k = 0; k < 2; k++)
            out->uv[2 * i + k] = at == UINT32_MAX ? NAN : ((const double *)obj->uvs.at)[2 * (size_t)at + k];
    }
    return 1;
}

static _Bool gather_normals(mu_obj *obj, mu_polygons *out) {
    out->normal = calloc((size_t)out->corners + 1, 3 * sizeof *out->normal);
    if (!out->normal) return mu_fail(obj->error, "%s: not enough memory", obj->file);
    for (size_t i = 0; i < out->corners; i++) {
        const uint32_t at = ((const uint32_t *)obj->normal.at)[i];
        for (size_t k = 0; k < 3 && at != UINT32_MAX; k++)
            out->normal[3 * i + k] = (float)((const double *)obj->normals.at)[3 * (size_t)at + k];
    }
    return 1;
}

static _Bool hand_over(mu_obj *obj, mu_polygons *out) {
    const uint32_t corners = (uint32_t)obj->vertex.count;
    if (!obj->first.count) return mu_fail(obj->error, "%s: the mesh is empty: it has no faces", obj->file);
    if (obj->positions.count / 3 > 0x40000000u)
        return mu_fail(obj->error, "%s: more than 2^30 vertices", obj->file);
    out->faces = (uint32_t)obj->first.count;
    out->vertices = (uint32_t)(obj->positions.count / 3);
    out->corners = corners;
    if (!append(obj, &obj->first, &corners, sizeof corners) || (obj->uvs.count && !gather_uvs(obj, out)) ||
        (obj->normals.count && !gather_normals(obj, out)))
        return 0;
    out->position = obj->positions.at, out->first = obj->first.at, out->vertex = obj->vertex.at;
    obj->positions.at = obj->first.at = obj->vertex.at = NULL;
    return 1;
}

_Bool mu_polygons_read_obj(mu_polygons *polygons, const char *file, mu_error *error) {
    mu_obj obj = {.file = file, .error = error};
    FILE *stream = fopen(file, "r");
    if (!stream) return mu_fail(error, "%s: %s", file, strerror(errno));
    const _Bool good = read_lines(&obj, stream) && hand_over(&obj, polygons);
    fclose(stream);
    free(obj.positions.at);
    free(obj.uvs.at);
    free(obj.first.at);
    free(obj.vertex.at);
    free(obj.texture.at);
    free(obj.normals.at);
    free(obj.normal.at);
    return good;
}
