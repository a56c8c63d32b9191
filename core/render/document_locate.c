/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * document_locate.c: a JSON path's place in the text, found by walking the text along the path.
 *
 * The text has passed jansson, so the walk only needs to recognise strings and brackets; it still stops at
 * the end of the text whatever it meets, because one caller looks into lines that jansson refused.
 */
#include "core/render/document_locate.h"

#include <stdint.h>
#include <string.h>

typedef struct cursor {
    const char *at, *end;
} cursor;

static void skip_space(cursor *c) {
    while (c->at < c->end && (*c->at == ' ' || *c->at == '\t' || *c->at == '\n' || *c->at == '\r')) c->at++;
}

static _Bool take(cursor *c, char expected) {
    skip_space(c);
    if (c->at >= c->end || *c->at != expected) return 0;
    c->at++;
    return 1;
}

/* From the opening quote to behind the closing one. */
static _Bool skip_string(cursor *c) {
    if (!take(c, '"')) return 0;
    for (; c->at < c->end; c->at++) {
        if (*c->at == '"') {
            c->at++;
            return 1;
        }
        if (*c->at == '\\' && c->end - c->at > 1) c->at++;
    }
    return 0;
}

/* One value of any kind. Brackets are counted, not recursed into: depth costs no stack. */
static _Bool skip_value(cursor *c) {
    size_t depth = 0;
    skip_space(c);
    const char *const begin = c->at;
    while (c->at < c->end) {
        const char now = *c->at;
        if (now == '"') {
            if (!skip_string(c)) return 0;
            if (depth == 0) return 1;
        } else if (now == '[' || now == '{') {
            depth++, c->at++;
        } else if (depth == 0 && (now == ',' || now == ']' || now == '}' || now == ' ' || now == '\n' ||
                                  now == '\t' || now == '\r')) {
            break;
        } else {
            c->at++;
            if ((now == ']' || now == '}') && --depth == 0) return 1;
        }
    }
    return depth == 0 && c->at > begin;
}

static uint32_t hex4(const char *digits) {
    uint32_t value = 0;
    for (int i = 0; i < 4; i++) {
        const char d = digits[i];
        const int digit = d >= '0' && d <= '9'   ? d - '0'
                          : d >= 'a' && d <= 'f' ? d - 'a' + 10
                          : d >= 'A' && d <= 'F' ? d - 'A' + 10
                                                 : 0;
        value = value << 4 | (uint32_t)digit;
    }
    return value;
}

static size_t encode(uint32_t code, char out[4]) {
    if (code < 0x80) return out[0] = (char)code, 1;
    if (code < 0x800) {
        out[0] = (char)(0xc0 | code >> 6), out[1] = (char)(0x80 | (code & 63));
        return 2;
    }
    if (code < 0x10000) {
        out[0] = (char)(0xe0 | code >> 12), out[1] = (char)(0x80 | (code >> 6 & 63));
        out[2] = (char)(0x80 | (code & 63));
        return 3;
    }
    out[0] = (char)(0xf0 | code >> 18), out[1] = (char)(0x80 | (code >> 12 & 63));
    out[2] = (char)(0x80 | (code >> 6 & 63)), out[3] = (char)(0x80 | (code & 63));
    return 4;
}

/* Whether the JSON string between the quotes [at, end) means `key`. */
static _Bool means(const char *at, const char *end, const char *key) {
    while (at < end) {
        char bytes[4] = {*at};
        size_t count = 1;
        if (*at != '\\') {
            at++;
        } else if (end - at >= 6 && at[1] == 'u') {
            uint32_t code = hex4(at + 2);
            at += 6;
            if (code >= 0xd800 && code < 0xdc00 && end - at >= 6 && at[0] == '\\' && at[1] == 'u') {
                code = 0x10000 + ((code - 0xd800) << 10) + (hex4(at + 2) - 0xdc00);
                at += 6;
            }
            count = encode(code, bytes);
        } else if (end - at >= 2) {
            static const char from[] = "bfnrt", to[] = "\b\f\n\r\t";
            const char *escape = memchr(from, at[1], 5);
            bytes[0] = escape ? to[escape - from] : at[1];
            at += 2;
        } else {
            return 0;
        }
        if (strncmp(key, bytes, count) != 0) return 0;
        key += count;
    }
    return *key == '\0';
}

/* With the cursor at an object: its member `key`, leaving the cursor at the value. */
static _Bool enter_member(cursor *c, const char *key, mu_span *name, const char *text) {
    if (!take(c, '{')) return 0;
    do {
        skip_space(c);
        const char *const begin = c->at;
        if (!skip_string(c)) return 0;
        const char *const end = c->at;
        if (!take(c, ':')) return 0;
        skip_space(c);
        if (means(begin + 1, end - 1, key)) {
            *name = (mu_span){(size_t)(begin - text), (size_t)(end - text)};
            return 1;
        }
        if (!skip_value(c)) return 0;
    } while (take(c, ','));
    return 0;
}

static _Bool enter_element(cursor *c, size_t index) {
    if (!take(c, '[')) return 0;
    for (; index > 0; index--)
        if (!skip_value(c) || !take(c, ',')) return 0;
    skip_space(c);
    return c->at < c->end && *c->at != ']';
}

_Bool mu_locate(const mu_place *place, _Bool at_key, mu_span *span) {
    const mu_document *document = place->document;
    cursor c = {document->text, document->text + document->length};
    mu_span name = {0, 0};
    if (place->parent) {
        if (!mu_locate(place->parent, 0, span)) return 0;
        if (!place->value) return 1;
        c.at = document->text + span->begin;
        if (place->key ? !enter_member(&c, place->key, &name, document->text)
                       : !enter_element(&c, place->index))
            return 0;
    }
    skip_space(&c);
    span->begin = (size_t)(c.at - document->text);
    if (!skip_value(&c)) return 0;
    span->end = (size_t)(c.at - document->text);
    if (at_key && place->parent && place->key) *span = name;
    return 1;
}

_Bool mu_locate_member(const char *text, size_t length, const char *key, mu_span *value) {
    cursor c = {text, text + length};
    mu_span name;
    if (!enter_member(&c, key, &name, text)) return 0;
    value->begin = (size_t)(c.at - text);
    if (!skip_value(&c)) return 0;
    value->end = (size_t)(c.at - text);
    return 1;
}

mu_position mu_position_of(const mu_document *document, size_t offset) {
    mu_position position = {document->first_line, 1};
    for (size_t i = 0; i < offset && i < document->length; i++) {
        const char byte = document->text[i];
        if (byte == '\n') {
            position.line++;
            position.column = 1;
        } else if ((byte & 0xc0) != 0x80) { /* continuation bytes are no characters of their own */
            position.column++;
        }
    }
    return position;
}
