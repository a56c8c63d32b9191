/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* command_tension.c: `musurf tension`, how a mesh deforms, as the M of its microsurface. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/command.h"
#include "core/render/error.h"
#include "core/render/inputs.h"
#include "core/render/options.h"
#include "core/render/output.h"
#include "core/render/output_stream.h"
#include "core/render/sequence.h"
#include "core/render/tension_files.h"

enum { OUTPUT, PICTURE, JSON, POSE, FRAME };

static const mu_option options[] = {
    {"o", "FILE.ply", "the deformed mesh with the vertex properties m00 m01 m10 m11"},
    {"picture", "FILE.svg", "ellipses that circles become, over the texture coordinates"},
    {"json", NULL, "print M of every face and vertex, not the summary only"},
    {"pose", "JSON", "{\"morph\": {NAME: WEIGHT}, \"animation\": NAME, \"time\": S} of DEFORMED"},
    {"frame", "N", "only this one of a numbered sequence"},
    {NULL, NULL, NULL}};

static const mu_usage usage = {
    "tension", "[REST] DEFORMED [-o FILE.ply] [--picture FILE.svg] [--json] [--pose JSON] [--frame N]",
    "Compares a mesh at rest with the same mesh deformed (OBJ, PLY, glTF, FBX): M = [m00 m01; m10 m11] = D "
    "R^-1 "
    "maps the\n"
    "tangent plane at rest to the deformed one, both seen with the texture's u direction as +x and the "
    "normal as +z.\n",
    options,
    "Both files need the same vertices and faces in the same order; texture coordinates may differ, or be "
    "missing in\n"
    "one. Vertices have the mean of their faces (of log sqrt(M^T M), weighted by area and angle at rest), "
    "moved "
    "to what a\n"
    "quadratic through the vertices around says: one for each chart of the texture, of one deformation. "
    "Rigid "
    "motions\ngive M = 1.\n"
    "A glTF or FBX file can be deformed by --pose: by morph targets, and by bones and nodes as they are at a "
    "time of "
    "an\n"
    "animation. Without REST it is compared with its own undeformed bind shape.\n"
    "\"balloon_####.ply\" is a numbered sequence: each file is compared, in order, and a warning counts gaps; "
    "-o and\n--picture then need #, too.\n"
    "out, one line of JSON for each mesh:\n"
    "  \"frame\"     the number, of a sequence\n"
    "  \"summary\"   numbers of \"faces\", \"triangles\", \"vertices\", \"seams\"; least and largest "
    "\"stretch\" and "
    "change of\n"
    "              \"area\"; numbers of triangles \"rest_flat\", \"deformed_flat\" (no area), \"uv_none\", "
    "\"uv_flat\",\n"
    "              \"uv_once\" (in one file), \"uv_changed\", \"uv_mirrored\", \"inverted\"; "
    "\"points_without\"\n"
    "  --json:\n"
    "  \"faces\"     [m00, m01, m10, m11] of each face in the file's order; of a polygon, the mean of its "
    "triangles\n"
    "  \"vertices\"  the same of each vertex in the file's order, on a seam of its first chart\n"
    "  \"seams\"     of the further charts: \"vertex\" (from 0), \"uv\", \"m\"\n"
    "The PLY has the vertices of further charts at its end. A warning counts triangles that were not "
    "healthy.\n"};

typedef struct mu_asked {
    const char *rest, *deformed, *output, *picture, *pose;
    int json;
    long long frame;
} mu_asked;

static _Bool write_files(const mu_asked *asked, const mu_deformation *d, mu_error *error) {
    mu_output_stream stream;
    if (asked->output) {
        if (!mu_output_stream_open(&stream, asked->output, error)) return 0;
        if (!mu_tension_write_ply(d, stream.file)) {
            mu_output_stream_discard(&stream);
            return mu_fail(error, "%s: not enough memory", asked->output);
        }
        if (!mu_output_stream_commit(&stream, error)) return 0;
    }
    if (!asked->picture) return 1;
    if (!mu_tension_can_draw(d, error) || !mu_output_stream_open(&stream, asked->picture, error)) return 0;
    mu_tension_draw(d, stream.file);
    return mu_output_stream_commit(&stream, error);
}

/* One mesh: the names are files. */
static _Bool answer(const mu_asked *asked, const mu_pose *pose, mu_error *error) {
    mu_deformation d;
    char line[768];
    if (mu_is_same_file(asked->output, asked->rest) || mu_is_same_file(asked->output, asked->deformed))
        return mu_fail(error, "%s: would replace a mesh that is compared", asked->output);
    if ((asked->output && !mu_output_check(asked->output, error)) ||
        (asked->picture && !mu_output_check(asked->picture, error)) ||
        !mu_deformation_read(&d, asked->rest, asked->deformed, pose, error))
        return 0;
    if (mu_deformation_describe(&d, line, sizeof line)) mu_warn(error, "%s: %s", asked->deformed, line);
    const _Bool good = write_files(asked, &d, error);
    if (good) mu_tension_write_json(&d, asked->frame, asked->json, stdout);
    mu_deformation_free(&d);
    return good;
}

/* One of a sequence: the names are patterns. */
static _Bool answer_frame(const mu_asked *asked, const mu_pose *pose, long long frame, mu_error *error) {
    mu_asked one = *asked;
    char *const deformed = mu_sequence_file(asked->deformed, frame),
                *const output = asked->output ? mu_sequence_file(asked->output, frame) : NULL,
                *const picture = asked->picture ? mu_sequence_file(asked->picture, frame) : NULL;
    one.deformed = deformed, one.output = output, one.picture = picture, one.frame = frame;
    const _Bool good = deformed && !output == !asked->output && !picture == !asked->picture
                           ? answer(&one, pose, error)
                           : mu_fail(error, "%s: not enough memory", asked->deformed);
    free(deformed);
    free(output);
    free(picture);
    return good;
}

static _Bool answer_sequence(const mu_asked *asked, const mu_pose *pose, mu_error *error) {
    const char *const files[] = {asked->output, asked->picture};
    long long *frames = NULL;
    size_t count = 0;
    for (size_t i = 0; i < 2 && asked->frame == MU_NO_FRAME; i++)
        if (files[i] && !strchr(files[i], '#'))
            return mu_fail(error, "%s: one file for a sequence; ### in its name would stand for the number",
                           files[i]);
    if (asked->frame != MU_NO_FRAME) return answer_frame(asked, pose, asked->frame, error);
    _Bool good = mu_sequence_list(asked->deformed, &frames, &count, error);
    if (good && frames[count - 1] - frames[0] + 1 > (long long)count)
        mu_warn(error, "%s: of the numbers from %lld to %lld, %lld have no file", asked->deformed, frames[0],
                frames[count - 1], frames[count - 1] - frames[0] + 1 - (long long)count);
    for (size_t i = 0; good && i < count; i++) good = answer_frame(asked, pose, frames[i], error);
    free(frames);
    return good;
}

static int answer_all(const mu_asked *asked) {
    mu_error error = {.text = ""};
    mu_pose pose;
    if (asked->output && !mu_output_ends_in(asked->output, ".ply"))
        return mu_refuse(&usage, "-o is \"%s\"; it must be a name that ends in .ply", asked->output);
    if (asked->picture && !mu_output_ends_in(asked->picture, ".svg"))
        return mu_refuse(&usage, "--picture is \"%s\"; it must be a name that ends in .svg", asked->picture);
    const _Bool sequence = mu_sequence_is(asked->deformed);
    if (!sequence && asked->frame != MU_NO_FRAME)
        return mu_refuse(&usage, "--frame is of a sequence, such as name_####.ply, which %s is not",
                         asked->deformed);
    if (asked->pose && !mu_pose_parse(asked->pose, &pose, &error)) return mu_refuse(&usage, "%s", error.text);
    const mu_pose *given = asked->pose ? &pose : NULL;
    const _Bool good = sequence ? answer_sequence(asked, given, &error) : answer(asked, given, &error);
    if (given) mu_pose_free(&pose);
    return good ? MU_EXIT_OK : mu_refuse(&usage, "%s", error.text);
}

int mu_command_tension(int argc, char **argv) {
    mu_asked asked = {.frame = MU_NO_FRAME};
    uint64_t frame;
    int met;
    mu_options given = mu_options_begin(&usage, argc, argv);
    while ((met = mu_options_next(&given)) != MU_OPTIONS_END) {
        if (met == OUTPUT) {
            asked.output = given.value;
        } else if (met == PICTURE) {
            asked.picture = given.value;
        } else if (met == JSON) {
            asked.json = 1;
        } else if (met == POSE) {
            asked.pose = given.value;
        } else if (met == FRAME) {
            if (!mu_options_unsigned(&given, 0, MU_LAST_FRAME, &frame)) return MU_EXIT_REFUSED;
            asked.frame = (long long)frame;
        } else if (met != MU_OPTIONS_OPERAND) {
            return mu_options_exit(met);
        } else if (asked.rest && asked.deformed) {
            return mu_refuse(&usage, "REST and DEFORMED, but \"%s\" is a third", given.value);
        } else {
            *(asked.rest ? &asked.deformed : &asked.rest) = given.value;
        }
    }
    if (!asked.deformed && asked.rest && asked.pose) asked.deformed = asked.rest, asked.rest = NULL;
    if (!asked.deformed)
        return mu_refuse(&usage, "two mesh files are needed: REST and DEFORMED; or one, with a --pose");
    return answer_all(&asked);
}
