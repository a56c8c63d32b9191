/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_ply.c: is a PLY file whole? Asked before assimp reads it, which on a truncated one may loop for ever,
 * abort, or make up the rest.
 *
 * Walks the header and every value of the body: enough of them, each a number, lists of sane length, and
 * faces that name vertices there are. Format: Turk, "The PLY Polygon File Format" (1994).
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/mesh_internal.h"

enum { MOST_ELEMENTS = 16, MOST_PROPERTIES = 64, LONGEST_TOKEN = 64, LONGEST_LIST = 1 << 16 };

typedef struct mu_ply_property {
    char name[LONGEST_TOKEN];
    char type, count_type; /* of its numbers, and of a list's length: see type_of; count_type 0: no list */
    _Bool indices;         /* a face's corners */
} mu_ply_property;

typedef struct mu_ply_element {
    char name[LONGEST_TOKEN];
    unsigned long long count;
    int property_count;
    mu_ply_property properties[MOST_PROPERTIES];
} mu_ply_element;

typedef struct mu_ply {
    const char *file;
    FILE *stream;
    enum { ASCII, LITTLE, BIG } format;
    int element_count;
    mu_ply_element elements[MOST_ELEMENTS];
    unsigned long long vertices;
    mu_error *error;
} mu_ply;

/* b B signed and unsigned byte, s S short, i I int, f float, d double; 0: not a type. */
static char type_of(const char *name) {
    static const char *const names[] = {"bchar",   "bint8",    "Buchar",  "Buint8",  "sshort", "sint16",
                                        "Sushort", "Suint16",  "iint",    "iint32",  "Iuint",  "Iuint32",
                                        "ffloat",  "ffloat32", "ddouble", "dfloat64"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (!strcmp(names[i] + 1, name)) return names[i][0];
    return 0;
}

static _Bool add_property(mu_ply *ply, const char *line) {
    char type[LONGEST_TOKEN], count[LONGEST_TOKEN], name[LONGEST_TOKEN];
    mu_ply_element *element = ply->element_count ? &ply->elements[ply->element_count - 1] : NULL;
    if (!element || element->property_count == MOST_PROPERTIES) return 0;
    mu_ply_property *property = &element->properties[element->property_count++];
    if (sscanf(line, "property list %63s %63s %63s", count, type, name) == 3) {
        property->count_type = type_of(count);
        property->indices = !strcmp(element->name, "face") && !strncmp(name, "vertex_ind", 10);
        if (!property->count_type || strchr("fd", property->count_type)) return 0;
    } else if (sscanf(line, "property %63s %63s", type, name) != 2)
        return 0;
    snprintf(property->name, sizeof property->name, "%s", name);
    property->type = type_of(type);
    return property->type != 0;
}

static _Bool add_header_line(mu_ply *ply, const char *line) {
    char word[LONGEST_TOKEN];
    if (sscanf(line, "format %63s 1.0", word) == 1) {
        static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        for (int i = 0; i < 3; ++i)
            if (!strcmp(word, formats[i])) return ply->format = (__typeof__(ply->format))i, 1;
        return 0;
    }
    if (!strncmp(line, "element ", 8)) {
        if (ply->element_count == MOST_ELEMENTS) return 0;
        mu_ply_element *element = &ply->elements[ply->element_count++];
        if (sscanf(line, "element %63s %llu", element->name, &element->count) != 2) return 0;
        if (!strcmp(element->name, "vertex")) ply->vertices = element->count;
        if (element->count > 1ull << 30)
            return mu_fail(ply->error, "%s: %llu of element %s are more than 2^30", ply->file, element->count,
                           element->name);
        return 1;
    }
    if (!strncmp(line, "property ", 9)) return add_property(ply, line);
    return !strncmp(line, "comment", 7) || !strncmp(line, "obj_info", 8) || line[0] == '\0';
}

static _Bool read_header(mu_ply *ply) {
    char line[1024];
    for (int number = 1; number < 10000 && fgets(line, sizeof line, ply->stream); ++number) {
        line[strcspn(line, "\r\n")] = '\0';
        if (number == 1) {
            if (strcmp(line, "ply")) return mu_fail(ply->error, "%s:1: not a PLY file", ply->file);
            continue;
        }
        if (!strcmp(line, "end_header")) return 1;
        if (!add_header_line(ply, line))
            return mu_fail(ply->error, "%s:%d: \"%.40s\" is no line of a PLY header", ply->file, number,
                           line);
    }
    return mu_fail(ply->error, "%s: truncated: the header does not end", ply->file);
}

static _Bool read_ascii(FILE *stream, double *out) {
    char token[LONGEST_TOKEN], *end;
    int c = getc_unlocked(stream), length = 0;
    while (c == ' ' || c == '\n' || c == '\r' || c == '\t') c = getc_unlocked(stream);
    for (; c != EOF && c > ' ' && length < LONGEST_TOKEN - 1; c = getc_unlocked(stream))
        token[length++] = (char)c;
    token[length] = '\0';
    *out = strtod(token, &end);
    return length && !*end;
}

static _Bool read_binary(const mu_ply *ply, char type, double *out) {
    const size_t size = strchr("bB", type) ? 1 : strchr("sS", type) ? 2 : type == 'd' ? 8 : 4;
    unsigned char bytes[8];
    uint64_t bits = 0;
    if (fread(bytes, 1, size, ply->stream) != size) return 0;
    for (size_t i = 0; i < size; ++i)
        bits |= (uint64_t)bytes[ply->format == LITTLE ? i : size - 1 - i] << (8 * i);
    union {
        uint32_t bits;
        float value;
    } single = {.bits = (uint32_t)bits};
    switch (type) {
    case 'b':
        *out = (int8_t)bits;
        break;
    case 's':
        *out = (int16_t)bits;
        break;
    case 'i':
        *out = (int32_t)bits;
        break;
    case 'f':
        *out = (double)single.value;
        break;
    case 'd':
        memcpy(out, &bits, sizeof *out);
        break;
    default:
        *out = (double)bits;
    }
    return 1;
}

static _Bool read_number(const mu_ply *ply, char type, double *out) {
    return ply->format == ASCII ? read_ascii(ply->stream, out) : read_binary(ply, type, out);
}

static _Bool check_item(const mu_ply *ply, const mu_ply_element *element, unsigned long long item) {
    for (const mu_ply_property *p = element->properties; p < element->properties + element->property_count;
         ++p) {
        double count = 1, value;
        if (p->count_type && !read_number(ply, p->count_type, &count)) goto truncated;
        if (!(count >= 0 && count <= LONGEST_LIST) || (p->indices && count < 3))
            return mu_fail(ply->error, "%s: %s %llu has a list of %g", ply->file, element->name, item, count);
        for (int i = 0; i < (int)count; ++i) {
            if (!read_number(ply, p->type, &value)) goto truncated;
            if (p->indices && !(value >= 0 && value < (double)ply->vertices))
                return mu_fail(ply->error, "%s: face %llu names vertex %g of %llu", ply->file, item, value,
                               ply->vertices);
        }
    }
    return 1;
truncated:
    return mu_fail(ply->error, "%s: truncated or damaged: %s %llu of %llu cannot be read", ply->file,
                   element->name, item, element->count);
}

_Bool mu_ply_check(const char *file, mu_error *error) {
    mu_ply *ply = calloc(1, sizeof *ply);
    _Bool ok = ply != NULL;
    if (!ply) return mu_fail(error, "%s: not enough memory", file);
    *ply = (mu_ply){.file = file, .error = error, .stream = fopen(file, "rb")};
    ok = ply->stream ? read_header(ply) : mu_fail(error, "%s: %s", file, strerror(errno));
    for (int i = 0; ok && i < ply->element_count; ++i)
        for (unsigned long long item = 0; ok && item < ply->elements[i].count; ++item)
            ok = !ply->elements[i].property_count || check_item(ply, &ply->elements[i], item);
    if (ply->stream) fclose(ply->stream);
    free(ply);
    return ok;
}

/* Reads every value of an item; `columns` of the names that are among its properties. */
static _Bool read_item(const mu_ply *ply, const mu_ply_element *element, size_t item, const char *const *names, int wanted,
                       double **columns) {
    for (const mu_ply_property *p = element->properties; p < element->properties + element->property_count; ++p) {
        double count = 1, value = 0;
        if (p->count_type && !read_number(ply, p->count_type, &count)) return 0;
        for (int i = 0; i < (int)count; ++i)
            if (!read_number(ply, p->type, &value)) return 0;
        for (int k = 0; k < wanted && !p->count_type; ++k)
            if (names[k] && columns[k] && !strcmp(names[k], p->name)) columns[k][item] = value;
    }
    return 1;
}

static const mu_ply_property *find_property(const mu_ply_element *element, const char *name) {
    for (int i = 0; i < element->property_count; ++i)
        if (!element->properties[i].count_type && !strcmp(element->properties[i].name, name))
            return &element->properties[i];
    return NULL;
}

_Bool mu_ply_vertices(const char *file, const char *const *names, int wanted, double **columns, size_t *count,
                      mu_error *error) {
    mu_ply *ply = calloc(1, sizeof *ply);
    if (!ply) return mu_fail(error, "%s: not enough memory", file);
    *ply = (mu_ply){.file = file, .error = error, .stream = fopen(file, "rb")};
    _Bool ok = ply->stream ? read_header(ply) : mu_fail(error, "%s: %s", file, strerror(errno));
    int i = 0;
    for (; ok && i < ply->element_count && strcmp(ply->elements[i].name, "vertex"); ++i)
        for (size_t item = 0; item < ply->elements[i].count && ok; ++item)
            ok = read_item(ply, &ply->elements[i], item, names, 0, columns);
    if (ok && i == ply->element_count) ok = mu_fail(error, "%s: has no vertices", file);
    const mu_ply_element *const vertex = ok ? &ply->elements[i] : NULL;
    for (int k = 0; ok && k < wanted; ++k) {
        if (!names[k]) continue;
        if (!find_property(vertex, names[k]))
            ok = mu_fail(error, "%s: its vertices have no property \"%s\"", file, names[k]);
        else if (!(columns[k] = malloc((size_t)(vertex->count + 1) * sizeof **columns)))
            ok = mu_fail(error, "%s: not enough memory", file);
    }
    for (size_t item = 0; ok && item < vertex->count; ++item)
        ok = read_item(ply, vertex, item, names, wanted, columns) ||
             mu_fail(error, "%s: truncated or damaged: vertex %zu cannot be read", file, item);
    *count = ok ? (size_t)vertex->count : 0;
    if (ply->stream) fclose(ply->stream);
    free(ply);
    return ok;
}

_Bool mu_ply_has(const char *file, const char *name) {
    mu_error ignored = {.text = ""};
    mu_ply *ply = calloc(1, sizeof *ply);
    if (!ply) return 0;
    *ply = (mu_ply){.file = file, .error = &ignored, .stream = fopen(file, "rb")};
    _Bool found = 0;
    if (ply->stream && read_header(ply))
        for (int i = 0; i < ply->element_count; ++i)
            if (!strcmp(ply->elements[i].name, "vertex")) found = find_property(&ply->elements[i], name) != NULL;
    if (ply->stream) fclose(ply->stream);
    free(ply);
    return found;
}
