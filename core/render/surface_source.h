/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_source.h: heightfields from files of any kind, as every surface command reads them.
 *
 * Scanline i of the image is x, pixel j in it is y. A pixel's value v, a whole-number code as it is stored (no gamma, no
 * division by the largest), is the height v S, pixels being C apart; in cells that is v S/C, which is what is kept.
 *     .exr (scanlines)   one channel or a chosen one: half, float or uint (image_plane.c)
 *     .pgm               P5 and P2, 1 to 16 bits (surface_pgm.c)
 *     all others         PNG, TIFF, tiled EXR ..., through OpenImageIO (image_read.h)
 * The kind is told by how the file begins. The nx x ny values are vertices; what happens at the border, see mu_border.
 */
#ifndef MU_SURFACE_SOURCE_H
#define MU_SURFACE_SOURCE_H

#include "core/render/options.h"
#include "core/render/error.h"
#include "core/surface/heightfield.h"

enum { MU_SURFACE_LEAST = 2, MU_SURFACE_MOST = 16384 };

typedef enum mu_border {
    /* Repeats after nx, ny cells. Right for what was made so; elsewhere the facets across the border are not the surface's. */
    MU_BORDER_PERIODIC,
    /* (nx - 1) x (ny - 1) cells; those count whose rays are above everything before they leave. Unbiased, smaller. */
    MU_BORDER_CROP,
    /* Even extension to 2 (nx - 1) x 2 (ny - 1) cells: every facet is the surface's, but each slope appears with all signs,
     * so that a mean slope, a skew and what couples x and y are lost. */
    MU_BORDER_MIRROR,
    /* The last eighth fades into the first, with weights whose squares add up to 1: 7/8 nx x 7/8 ny cells. Keeps the variance of
     * heights (about their mean); slopes in the strips are too Gaussian, and too steep by 1.2 (correlation length/strip)^2. */
    MU_BORDER_BLEND
} mu_border;

typedef enum mu_level { MU_LEVEL_NONE, MU_LEVEL_MEAN, MU_LEVEL_PLANE } mu_level;

/* In their order, NULL last. */
const char *const *mu_border_names(void);
const char *const *mu_level_names(void);

typedef struct mu_surface_source {
    const char *file, *channel; /* channel NULL: the only one */
    double cell, height_scale;
    mu_border border;
    mu_level level; /* subtracts the mean height, or the plane of least squares */
    _Bool fill;     /* closes holes (what is not finite) by the harmonic surface over their border */
    _Bool
        border_given; /* then a periodic one is what the user wants, and steps across it are not warned of */
} mu_surface_source;

/* The last rows of a command's table of options. */
#define MU_SURFACE_SOURCE_OPTIONS                                                                            \
    {"channel", "NAME", "the channel that holds heights, of a file with several"},                           \
        {"cell", "C", "width of a pixel (default: 1)"},                                                      \
        {"height-scale", "S", "height of one unit of the file's values, as wide as C is (default: 1)"},      \
        {"border", "periodic|crop|mirror|blend",                                                             \
         "what is beyond the border: the other side (default); nothing, and only facets count whose rays\n"  \
         "cannot leave; the mirror image; or the other side after a cross-fade over an eighth"},             \
        {"level", "none|mean|plane", "what to subtract from the heights (default: none)"}, {                 \
        "fill", NULL, "close holes (values that are not finite) smoothly; without it they are an error"      \
    }
/* What their help says of FILE. */
#define MU_SURFACE_SOURCE_HELP                                                                               \
    "FILE is an image of one channel, nx scanlines of ny pixels: scanline i is x, pixel j in it is y. "      \
    "OpenEXR and PGM\n"                                                                                      \
    "are read directly, PNG, TIFF and others by OpenImageIO. Values are taken as they are stored (no "       \
    "gamma; 0 to 65535\n"                                                                                    \
    "for 16 bits), times S/C: heights in cells. What musurf writes is periodic, with cells of size 1.\n"     \
    "A map that does not repeat: crop is unbiased. mirror shows each slope with all signs (no mean slope, "  \
    "no skew);\n"                                                                                            \
    "blend keeps the variance of heights, but in its strips slopes become Gaussian, and somewhat steeper.\n"

mu_surface_source mu_surface_source_begin(void);
/* The index-th of these options was met; false after a line on stderr. */
_Bool mu_surface_source_option(mu_surface_source *source, const mu_options *at, int index);

typedef struct mu_surface {
    mu_heightfield f; /* in cells, all finite, periodic */
    double *heights;  /* f's */
    _Bool
        open; /* MU_BORDER_CROP: the last row and column of cells are none, rays must not leave the others */
    uint32_t pixels[2]; /* the file's scanlines and pixels in each */
    size_t filled;      /* holes closed */
    double plane[3];    /* subtracted: the mean, and slopes along x and y about the middle */
} mu_surface;

/* Needs source->file. Warnings on what is suspicious. */
_Bool mu_surface_read(const mu_surface_source *source, mu_surface *out, mu_error *error);
void mu_surface_free(mu_surface *surface);

/* Cells [i0, i1) x [j0, j1). */
typedef struct mu_window {
    uint32_t i0, i1, j0, j1;
} mu_window;
/* The cells whose rays along w (under M) stay over the surface's own cells until they are above all of it; all cells of a
 * surface that is not open. May be empty. */
mu_window mu_surface_window(const mu_heightfield *f, _Bool open, const double m[4], const double w[3]);

/* The parts: a raw image, row by row (surface_pgm.c); heights put right and made periodic (surface_border.c), with a
 * warning if the border is doubted and heights do not go on across it. */
double *mu_pgm_read(const char *file, int *width, int *height, mu_error *error);
_Bool mu_surface_prepare(const mu_surface_source *source, _Bool doubt_border, mu_surface *surface,
                         mu_error *error);

#endif
