/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_surface_statistics.c: `musurf surface statistics`, what microfacet theory says of a surface, counted on it. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "core/render/command_surface.h"
#include "core/render/surface_source.h"
#include "core/render/surface_statistics.h"

enum {
    TRANSFORM,
    VIEW,
    BOUNCES,
    FRESNEL,
    TRANSMISSION,
    LIGHT,
    RINGS,
    SECTORS,
    SLOPES,
    SLOPE_BOUNDS,
    SUBSAMPLES,
    TRACER,
    THREADS,
    SOURCE
};
enum { MOST_FILES = 1024 };

static const mu_option options[] = {
    {"transform", "A,C,B,D", "M = [a c; b d], row by row (default: 1,0,0,1)"},
    {"view", "X,Y,Z", "a direction in the space of the transformed surface, Z > 0; up to 16 of them"},
    {"bounces", "N", "mirror reflections to follow, 0 to 64 (default: 1; 0 leaves reflection out)"},
    {"fresnel", "LAW",
     "none (default: mirrors), schlick:R[,G,B], dielectric:ETA, conductor:N,K or\nconductor:N,N,N,K,K,K"},
    {"transmission", NULL,
     "follow what facets refract as well: the index below is ETA times that above, where the\n"
     "views are (ETA < 1: from inside a dense medium). Needs --fresnel dielectric:ETA"},
    {"light", "X,Y,Z[,DEGREES]",
     "a disc of light about this direction (default: 10 degrees from its middle to its border),\n"
     "wholly above the horizon or, with --transmission, wholly below; up to 16 of them"},
    {"rings", "R", "bins of directions from zenith to horizon, 1 to 180 (default: 12)"},
    {"sectors", "S", "bins of directions around, 1 to 720 (default: 24)"},
    {"slopes", "K", "the histogram of slopes has K x K cells, 1 to 1024 (default: 32)"},
    {"slope-bounds", "X0,X1,Y0,Y1",
     "between these slopes (default: wide enough for 99 % along each axis, and 1.25 times)"},
    {"subsamples", "K", "points per facet: a square, 9 to 225 (default: 9)"},
    {"tracer", "own|embree|povray",
     "what views see: own: exact, double precision (default); embree: float; povray: the program "
     "POV-Ray.\nWhat facets "
     "reflect or refract always by the first"},
    {"threads", "N", "threads (default: one per processor); the result does not depend on it"},
    MU_SURFACE_SOURCE_OPTIONS,
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "surface statistics", "FILE [FILE ...] [--view X,Y,Z ...] [--transform A,C,B,D] [--bounces N] ...",
    "Counts slopes, normals, masking, visible normals and reflections on explicit surfaces whose vertices\n"
    "M has moved.\n",
    options,
    /* clang-format off */
    MU_SURFACE_SOURCE_HELP
    "Several FILEs are realisations of one kind of surface.\n"
    "Frame: x, y in the plane of the transformed surface, z up; directions point away from it and\n"
    "are unit vectors in the output. Bins of directions: R rings of equal theta from +z (0 to 90 degrees),\n"
    "S sectors of equal phi from +x toward +y; a list holds bin ring * S + sector. Areas count per macro\n"
    "area, the surface's own in the plane. V is 1 where a point is seen, 0 for facets that turn away.\n"
    "out, one line of JSON:\n"
    "  \"slopes\"   \"density\" of (dz/dx, dz/dy) per macro area, K x K, row by row from the least dz/dy on;\n"
    "             the share \"outside\" the \"bounds\"; \"mean\"; \"covariance\" xx, xy, yy\n"
    "  \"normals\"  \"facets\" in each bin; \"D\", 1/sr: area of facets per macro area; \"area\": all of it\n"
    "  \"views\"    per --view, in order:\n"
    "    \"facing\", \"G1\"    per normal bin: share of the area that faces the view; that it sees (what Smith's\n"
    "                      G1 means is G1 / facing)\n"
    "    \"Dv\"              per normal bin, 1/sr: visible projected area over the plane's own\n"
    "    \"projected_area\"  all of it: 1 but for the finite number of points, for every surface\n"
    "    \"G1_projected\"    visible over facing projected area: 1/(1 + Lambda)\n"
    "    \"reflection\"      per colour of F: mirrors followed from the visible points, in shares of the light\n"
    "                      of the view (visible projected area): \"escaped\" + \"over_limit\" (more than N) +\n"
    "                      \"lost\" (rays that all but stay level, 2^23 edges on) + \"absorbed\" (by F) = 1\n"
    "      \"orders\"        after 1, 2, ... reflections: \"albedo\", and \"density\", 1/sr, per bin of the outgoing\n"
    "                      direction; it holds the cosine: the BRDF is density / cos theta\n"
    "      \"lights\"        per --light above: \"f\", 1/sr, the BRDF's mean over the disc, Eq. (11f) of On Microsurface\n"
    "                      Transformations (Golubev), F and the light asked for every facet; \"f_grouped\", the\n"
    "                      same of facets sorted by normal into groups, 8 R x 8 S (up to 360 x 1440), F and the light\n"
    "                      asked once a group; \"f_all_orders\", with further reflections\n"
    "    \"transmission\"    with --transmission, from the same points, in the same shares: what facets refract\n"
    "                      once and \"escaped\" downward; was \"caught\", meets the underside again; \"reflected\", of\n"
    "                      which \"total_reflection\": the first three add up to 1\n"
    "      \"factor\"        1/ETA^2, by which refraction changes radiance on its way to the viewer: index squared on the\n"
    "                      viewer's side over that on the light's. Eq. (11f) is printed with its inverse, against\n"
    "                      Eq. (9c)\n"
    "      \"density\"       1/sr, per bin of the direction below, theta from -z: it holds the cosine and the factor: the\n"
    "                      BTDF, for radiance, is density / |cos theta|. All of it is escaped times factor\n"
    "      \"lights\"        per --light below: \"f\", the BTDF's mean over the disc, Eq. (11f); \"f_grouped\". Lights\n"
    "                      above are in \"reflection\"\n"
    "  \"pairs\"    per two views \"a\", \"b\" (0 is the first), per normal bin: share of the area that is \"facing\"\n"
    "             both; \"G2\", that both see; \"G2_facet_mean\": points seen by both, of facets that face both.\n"
    "             Give the direction of a light as a view to have its G2\n"
    "\"..._error\" is one standard error of a ratio of sums over \"units\": the realisations, if there are several\n"
    "files, else 4 x 4 blocks of the one surface, \"block\" cells a side. Blocks say how far another surface of\n"
    "this kind would lie, if they are wide against \"correlation_length\" (1/e of the heights' autocorrelation\n"
    "along x, y, in cells; below four of them a warning says so): what lies across a border belongs to two\n"
    "blocks, which makes errors too small. At eight, on 20 unfitted Gaussian surfaces, errors of blocks were\n"
    "1.07 times the scatter of realisations (median; 0.9 to 1.7). Of fitted surfaces, as musurf surface make\n"
    "makes them, the whole scatters less than its blocks tell: errors are up to twice too large for slopes, D\n"
    "and what hangs on them (slopes 2.1, D 1.4, albedos 1.5, G1 per bin 1.1); the mean slope of a periodic\n"
    "surface is even 0 exactly. Several files know no such bias. Errors from 16 units are known to 18 %.\n"
    "null: nothing was there to count.\n"};
/* clang-format on */

typedef struct mu_inquiry {
    mu_gathering g;
    mu_surface_source source;
    const char *files[MOST_FILES];
    _Bool terminal;
    double began, shown;
} mu_inquiry;

static _Bool read_fresnel(mu_inquiry *q, const mu_options *at) {
    static const char *const names[] = {"none", "schlick", "dielectric", "conductor", NULL};
    static const size_t least[] = {0, 1, 1, 2}, most[] = {0, 3, 1, 6};
    char name[32];
    int kind = 0;
    const size_t length = strcspn(at->value, ":");
    mu_reflectance *r = &q->g.reflectance;
    snprintf(name, sizeof name, "%.*s", (int)length, at->value);
    mu_options word = *at, rest = *at;
    word.value = name, rest.value = at->value + length + (at->value[length] == ':');
    if (!mu_options_choice(&word, names, &kind)) return 0;
    double v[6] = {0};
    const size_t count = kind ? mu_options_numbers(&rest, least[kind], most[kind], v) : 0;
    if (kind && !count) return 0;
    if (!kind && *rest.value) return mu_refuse(&usage, "--fresnel none takes no numbers"), 0;
    const size_t each = kind == 3 ? count / 2 : count;
    if (count && ((kind == 3 && count % 2) || (each != 1 && each != 3)))
        return mu_refuse(&usage,
                         "--fresnel is \"%s\"; one number a colour is needed, for one colour or three",
                         at->value),
               0;
    *r = (mu_reflectance){kind == 0   ? MU_REFLECTS_ALL
                          : kind == 1 ? MU_REFLECTS_SCHLICK
                                      : MU_REFLECTS_INDEX,
                          each == 3 ? 3 : 1,
                          {0},
                          {0}};
    for (size_t k = 0; k < each; k++) {
        r->a[k] = v[k], r->b[k] = kind == 3 ? v[each + k] : 0;
        const _Bool good = kind == 1 ? v[k] >= 0 && v[k] <= 1 : v[k] > 0 && r->b[k] >= 0;
        if (!good)
            return mu_refuse(&usage, "--fresnel is \"%s\"; %s", at->value,
                             kind == 1 ? "reflectances lie between 0 and 1"
                                       : "indices are above 0, extinctions not below"),
                   0;
    }
    return 1;
}

static _Bool read_light(mu_inquiry *q, const mu_options *at) {
    const double degree = 3.14159265358979323846 / 180;
    double v[4] = {0, 0, 0, 10};
    if (q->g.lamp_count == MU_STATISTICS_LIGHTS)
        return mu_refuse(&usage, "more than %d lights", MU_STATISTICS_LIGHTS), 0;
    if (!mu_options_numbers(at, 3, 4, v)) return 0;
    const double length = hypot(hypot(v[0], v[1]), v[2]), flat = hypot(v[0], v[1]);
    if (!(length > 0 && isfinite(length) && v[3] > 0 &&
          atan2(flat, fabs(v[2])) + v[3] * degree <= 90 * degree))
        return mu_refuse(&usage, "--light is \"%s\"; the disc must lie above the horizon, or below",
                         at->value),
               0;
    q->g.lamps[q->g.lamp_count++] = (mu_lamp){{v[0] / length, v[1] / length, v[2] / length}, v[3] * degree};
    return 1;
}

static _Bool read_whole(const mu_options *at, uint64_t least, uint64_t most, uint32_t *out) {
    uint64_t number = 0;
    if (!mu_options_unsigned(at, least, most, &number)) return 0;
    *out = (uint32_t)number;
    return 1;
}

static _Bool read_option(mu_inquiry *q, const mu_options *at, int met) {
    mu_gathering *g = &q->g;
    uint32_t number = 0;
    int choice = 0;
    double b[4];
    if (met >= SOURCE) return mu_surface_source_option(&q->source, at, met - SOURCE);
    switch (met) {
    case TRANSFORM:
        return mu_options_transform(at, g->m);
    case VIEW:
        if (g->view_count == MU_STATISTICS_VIEWS)
            return mu_refuse(&usage, "more than %d views", MU_STATISTICS_VIEWS), 0;
        return mu_options_view(at, g->views[g->view_count].w) && ++g->view_count;
    case BOUNCES:
        return read_whole(at, 0, MU_BOUNCES_MOST, &g->bounces);
    case FRESNEL:
        return read_fresnel(q, at);
    case TRANSMISSION:
        return g->transmission = 1;
    case LIGHT:
        return read_light(q, at);
    case RINGS:
        return read_whole(at, 1, 180, &g->bins.rings);
    case SECTORS:
        return read_whole(at, 1, 720, &g->bins.sectors);
    case SLOPES:
        return read_whole(at, 1, 1024, &g->slope_cells);
    case SLOPE_BOUNDS:
        if (!mu_options_numbers(at, 4, 4, b)) return 0;
        if (!(b[0] < b[1] && b[2] < b[3]))
            return mu_refuse(&usage, "--slope-bounds is \"%s\"; X0 < X1 and Y0 < Y1 are needed", at->value),
                   0;
        memcpy(g->slope_bounds, b, sizeof b);
        return 1;
    case SUBSAMPLES:
        if (!read_whole(at, 9, 225, &number)) return 0;
        g->side = (uint32_t)(sqrt((double)number) + 0.5);
        return g->side * g->side == number ||
               (mu_refuse(&usage, "--subsamples is %s; it must be a square, 9, 16, 25, ...", at->value), 0);
    case TRACER:
        if (!mu_options_choice(at, mu_tracer_names(), &choice)) return 0;
        g->tracer = mu_tracer_get(choice);
        return 1;
    default:
        return read_whole(at, 1, 256, &g->threads);
    }
}

/* What options ask of each other. */
static _Bool consistent(const mu_gathering *g) {
    const mu_reflectance *r = &g->reflectance;
    uint32_t below = 0;
    for (uint32_t k = 0; k < g->lamp_count; k++) below += mu_lamp_below(&g->lamps[k]);
    const char *wrong = NULL;
    if (!g->file_count)
        wrong = "a heightfield FILE is needed";
    else if (g->lamp_count && !g->view_count)
        wrong = "--light needs a --view";
    else if (g->lamp_count > below && !g->bounces)
        wrong = "--light needs --bounces of 1 or more";
    else if (below && !g->transmission)
        wrong = "--light from below needs --transmission";
    else if (g->transmission && !(r->kind == MU_REFLECTS_INDEX && r->channels == 1 && r->b[0] == 0))
        wrong = "--transmission needs --fresnel dielectric:ETA";
    return !wrong || (mu_refuse(&usage, "%s", wrong), 0);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void show(void *context, double done) {
    mu_inquiry *q = context;
    const double passed = now() - q->began;
    if (passed < q->shown + 0.2) return;
    q->shown = passed;
    const double rest = done > 0 ? passed / done * (1 - done) : 0;
    fprintf(stderr, "\r%3.0f %%, %.0f s to go\033[K", 100 * done, rest);
}

static void warn_of_blocks(const mu_gathering *g) {
    const double length = fmax(g->correlation[0], g->correlation[1]); /* of one number if the other is NaN */
    if (g->file_count == 1 && !(g->block >= 4 * length))
        fprintf(stderr,
                "musurf surface statistics: blocks of %g cells are less than four correlation lengths (%.3g) "
                "wide: errors are too small; give several files\n",
                g->block, length);
}

static _Bool gather(mu_inquiry *q, mu_error *error) {
    if (!mu_gathering_begin(&q->g, error)) return 0;
    for (uint32_t k = 0; k < q->g.file_count; k++) {
        mu_surface surface;
        q->source.file = q->files[k];
        if (!mu_surface_read(&q->source, &surface, error)) return 0;
        const _Bool good =
            surface.open
                ? mu_fail(error, "--border crop: all facets count here; measure has a window of them")
                : mu_gathering_add(&q->g, k, &surface.f, error);
        mu_surface_free(&surface);
        if (!good) return 0;
    }
    return 1;
}

static int run(mu_inquiry *q) {
    mu_error error = {.text = ""};
    int code = MU_EXIT_OK;
    q->began = now();
    if (isatty(STDERR_FILENO)) q->g.progress = show, q->g.context = q;
    const _Bool good = gather(q, &error);
    if (q->g.progress) fprintf(stderr, "\r\033[K");
    errno = 0;
    if (!good && !error.text[0]) {
        code = MU_EXIT_INTERRUPTED;
    } else if (!good) {
        code = mu_refuse(&usage, "%s", error.text);
    } else {
        warn_of_blocks(&q->g);
        if (!mu_gathering_report(&q->g)) {
            fprintf(stderr, "musurf surface statistics: standard output: %s\n", strerror(errno));
            code = MU_EXIT_FAILED;
        }
    }
    mu_gathering_free(&q->g);
    return code;
}

int mu_command_surface_statistics(int argc, char **argv) {
    mu_inquiry q = {.source = mu_surface_source_begin(),
                    .g = {.m = {1, 0, 0, 1},
                          .tracer = &mu_tracer_own,
                          .side = 3,
                          .threads = mu_processors(),
                          .bounces = 1,
                          .bins = {12, 24, 3.14159265358979323846 / 2},
                          .slope_cells = 32,
                          .reflectance = {MU_REFLECTS_ALL, 1, {0}, {0}}}};
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == MU_OPTIONS_OPERAND) {
            if (q.g.file_count == MOST_FILES) return mu_refuse(&usage, "more than %d files", MOST_FILES);
            q.files[q.g.file_count++] = given.value;
        } else if (met < 0) {
            return mu_options_exit(met);
        } else if (!read_option(&q, &given, met)) {
            return MU_EXIT_REFUSED;
        }
    }
    if (!consistent(&q.g)) return MU_EXIT_REFUSED;
    return run(&q);
}
