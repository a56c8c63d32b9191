/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * page.h: what the page calls. This folder is a program, compiled to WebAssembly; numbers come and go as arrays in its
 * memory. Frame, units and names are those of core/bsdf/musurf.h; `query` is that of numbers.h.
 */
#ifndef PAGE_PAGE_H
#define PAGE_PAGE_H

#include <stdint.h>

#ifdef __wasm__
#define PAGE_EXPORT(name) __attribute__((export_name(#name))) name
#else
#define PAGE_EXPORT(name) name
#endif

/* material.c: what the controls describe (numbers: material.h). */
typedef struct page_material page_material;
/* Names of scene files: of the distributions and forms of masking, and of metals; NULL after the last. */
typedef enum page_list { PAGE_NDFS, PAGE_MASKINGS, PAGE_METALS } page_list;
const char *PAGE_EXPORT(page_choice)(int list, int index);
page_material *PAGE_EXPORT(page_material_new)(void);
/* 0: refused, and the material is as before; the member of mu_definition and why. */
int PAGE_EXPORT(page_material_set)(page_material *material, const double *numbers);
const char *PAGE_EXPORT(page_material_field)(const page_material *material);
const char *PAGE_EXPORT(page_material_complaint)(const page_material *material);

/* numbers.c: names, each with how many numbers it has; the numbers one after the other; the micronormals of the
 * samples. */
const char *PAGE_EXPORT(page_number_names)(void);
void PAGE_EXPORT(page_numbers)(const page_material *material, const double *query, double *out);
void PAGE_EXPORT(page_samples)(const page_material *material, const double *query, double *out);

/* density.c, `frame`: panel.h: size x size pixels, row by row from the top; r, g, b are `ink`'s, opacity the root of
 * the density over the largest, which is returned. `work`: as many floats. */
double PAGE_EXPORT(page_density)(const page_material *material, const double *query, int space,
                                 const double *frame, int size, unsigned ink, float *work, unsigned *rgba);

/* curves.c: what is drawn over it, x and y of points; of a line `count` of them. Returns how many there are. */
typedef enum page_curve {
    PAGE_BOUNDARY, /* of the confidence region, k sigma */
    PAGE_WHOLE,    /* the axis between the farthest points */
    PAGE_CLAMPED,  /* what of it reflects above the horizon */
    PAGE_POINTS,   /* far 2, near 2, near shifted 2, the normal */
    PAGE_SAMPLED,  /* one each */
    PAGE_DISCS     /* 32 each: directions a chord of the radius away; among reflected directions alone */
} page_curve;
int PAGE_EXPORT(page_curve_points)(const page_material *material, const double *query, int space,
                                   const double *frame, int curve, int count, double *out);

/* surroundings.c: what lights the sphere; its sharpest square has `side` texels, a power of two from 64 on, to a side.
 * NULL without memory. */
typedef struct page_surroundings page_surroundings;
const char *PAGE_EXPORT(page_surroundings_name)(int kind);
page_surroundings *PAGE_EXPORT(page_surroundings_new)(int kind, int side);
void PAGE_EXPORT(page_surroundings_free)(page_surroundings *surroundings);

/* sphere.c: the sphere in a light. */
typedef struct page_sphere page_sphere;
const char *PAGE_EXPORT(page_technique_name)(int technique);
page_sphere *PAGE_EXPORT(page_sphere_new)(void);
/* `numbers`: sphere.c. `samples` of each node of the table of albedos; 0: it stays. */
void PAGE_EXPORT(page_sphere_set)(page_sphere *sphere, const page_material *material,
                                  const page_surroundings *surroundings, const double *query,
                                  const double *numbers, int samples);
/* Rows `row` and size - 1 - row of the picture, one after the other. `sums`: of the sampled technique, three floats a
 * pixel, which pass `pass` adds to; NULL of the others. `linear`: where radiance goes, three floats a pixel; NULL:
 * what is shown goes to `rgba`, with an opacity at the edge. */
void PAGE_EXPORT(page_sphere_rows)(const page_sphere *sphere, int row, int pass, float *sums, float *linear,
                                   uint32_t *rgba);

/* What a wide lens sees behind it, blurred: size x size pixels. */
void PAGE_EXPORT(page_backdrop)(const page_sphere *sphere, int size, uint32_t *rgba);

#endif
