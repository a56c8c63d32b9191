#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Rays per second of the renderer against POV-Ray's: the same mesh, camera, light and pixels, one thread each.

    tests/bench_rays.py [--cells 708] [--size 1024] [--repeats 3]

A heightfield of 2 cells^2 triangles under one parallel light with shadows, matt, direct light only: one camera ray
for each pixel, and one shadow ray wherever the light can be seen from. Tracing is counted in processor seconds, for on
a busy machine the clock measures the others: POV-Ray reports its own; the renderer's are the difference between
renders of 1 + MORE and 1 samples per pixel, so that reading the mesh, building and writing cancel. Medians of runs
taken in turn; the clock's times of whole runs with one sample per pixel stand beside. Exit code 1 if the renderer is
not GOAL times as fast.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy

GOAL = 4
MORE = 16
MUSURF = pathlib.Path(os.environ.get("BUILD", "build")).resolve() / "musurf"
LIGHT = (0.5, -0.3, 0.12)  # toward it


def heights(cells):
    """A sum of plane waves with random phases, of some 6 to 60 cells: slopes of about 1/3, shadows included."""
    random = numpy.random.default_rng(20240917)
    x, y = numpy.meshgrid(numpy.arange(cells + 1.0), numpy.arange(cells + 1.0), indexing="ij")
    h = numpy.zeros_like(x)
    for length in numpy.geomspace(6, 60, 24):
        angle, phase = random.uniform(0, 2 * numpy.pi, 2)
        wave = 2 * numpy.pi / length
        h += 0.1 / wave * numpy.sin(wave * (x * numpy.cos(angle) + y * numpy.sin(angle)) + phase)
    vertices = numpy.stack([x, y, h], -1).reshape(-1, 3).astype("<f4")
    i = (numpy.arange(cells)[:, None] * (cells + 1) + numpy.arange(cells)).ravel()
    right, up = i + cells + 1, i + 1
    return vertices, numpy.concatenate([numpy.stack([i, right, up], -1), numpy.stack([right + 1, up, right], -1)])


def write_ply(file, vertices, triangles):
    faces = numpy.empty(len(triangles), [("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    file.write_bytes(head.encode() + vertices.tobytes() + faces.tobytes())


def write_pov(file, vertices, triangles, position, target, tangent):
    """No `smooth`, no antialiasing; a parallel light far outside the mesh."""
    def vectors(rows, form):
        return ",\n".join("<" + form % tuple(row) + ">" for row in rows.tolist())
    forward = (target - position) / numpy.linalg.norm(target - position)
    right = numpy.cross(forward, (0, 0, 1))
    right /= numpy.linalg.norm(right)
    up = numpy.cross(right, forward)
    vector = lambda v: "<%.9g,%.9g,%.9g>" % tuple(v)
    far = 1e5 * numpy.array(LIGHT) / numpy.linalg.norm(LIGHT) + target
    file.write_text(f"""#version 3.7;
global_settings {{ assumed_gamma 1 max_trace_level 1 }}
camera {{ perspective location {vector(position)} direction {vector(forward)}
  right {vector(2 * tangent * right)} up {vector(2 * tangent * up)} }}
light_source {{ {vector(far)} rgb 1 parallel point_at {vector(target)} }}
mesh2 {{ vertex_vectors {{ {len(vertices)},
{vectors(vertices, "%.9g,%.9g,%.9g")} }}
face_indices {{ {len(triangles)},
{vectors(triangles, "%d,%d,%d")} }}
texture {{ pigment {{ rgb 0.5 }} finish {{ ambient 0 emission 0 diffuse 1 brilliance 1 }} }} }}
""")


def write_scene(file, mesh, size, position, target, tangent):
    file.write_text(json.dumps({
        "musurf": 1,
        "camera": {"type": "perspective", "position": position.tolist(), "target": target.tolist(), "up": [0, 0, 1],
                   "fov": 2 * numpy.degrees(numpy.arctan(tangent))},
        "film": {"width": size, "height": size, "filter": "box"},
        "integrator": {"samples": 1, "depth": 1},
        "materials": {"matt": {"material": "template.lambert", "reflectance": 0.5}},
        "meshes": {"ground": {"file": mesh}},
        "objects": [{"mesh": "ground", "material": "matt"}],
        "lights": [{"type": "directional", "direction": LIGHT, "irradiance": [1, 1, 1]}]}))


def render(folder, samples):
    """Rays, processor seconds and the clock's of one render."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run([MUSURF, "render", "scene.json", "-o", "musurf.exr", "--threads", "1", "--spp", str(samples),
                           "--progress=json"], cwd=folder, check=True, capture_output=True, text=True)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.loads(done.stderr.splitlines()[-1])["rays"], busy, wall


def run_musurf(folder):
    one, many = render(folder, 1), render(folder, 1 + MORE)
    return many[0] - one[0], many[1] - one[1], one[2]


def run_povray(folder, size):
    start = time.monotonic()
    done = subprocess.run(["povray", "+Iscene.pov", "+Opov.exr", "+FE", f"+W{size}", f"+H{size}", "-A", "-D", "-C", "-P",
                           "+WT1", "-GD", "-GR", "-V", "File_Gamma=1"], cwd=folder, capture_output=True, text=True)
    wall = time.monotonic() - start
    if done.returncode:
        sys.exit(f"bench_rays: povray failed:\n{done.stderr}")
    text = done.stderr
    number = lambda pattern: float(re.search(pattern, text).group(1))
    rays = number(r"\nRays:\s+(\d+)") + number(r"Shadow Ray Tests:\s+(\d+)")
    return rays, number(r"Trace Time:[^\n]*\n[^\n]*with ([\d.]+) CPU-seconds"), wall


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=708)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    n = options.cells
    target, tangent = numpy.array([n / 2, n / 2, 0]), numpy.tan(numpy.radians(15))
    position = target + 0.8 * n * numpy.array([0, -1, 1]) / numpy.sqrt(2)
    with tempfile.TemporaryDirectory(prefix="musurf-rays-") as name:
        folder = pathlib.Path(name)
        vertices, triangles = heights(n)
        write_ply(folder / "ground.ply", vertices, triangles)
        write_scene(folder / "scene.json", "ground.ply", options.size, position, target, tangent)
        write_pov(folder / "scene.pov", vertices, triangles, position, target, tangent)
        runs = {"musurf": [], "povray": []}
        for _ in range(options.repeats):
            runs["musurf"].append(run_musurf(folder))
            runs["povray"].append(run_povray(folder, options.size))
    print(f"rays: {len(triangles)} triangles, {options.size} x {options.size} pixels, one thread, "
          f"medians of {options.repeats}; tracing in processor seconds, of {MORE} samples per pixel (musurf) and 1 (povray)")
    rates = {}
    for who, rows in runs.items():
        rays, seconds, wall = (statistics.median(column) for column in zip(*rows))
        rates[who] = rays / seconds
        print(f"  {who}: {rays / 1e6:.2f} Mrays (camera and shadow) traced in {seconds:.2f} s: {rates[who] / 1e6:.2f} Mray/s; "
              f"a whole run with 1 sample per pixel {wall:.2f} s")
    ratio = rates["musurf"] / rates["povray"]
    print(f"  ratio of tracing rates: {ratio:.2f} (goal {GOAL})")
    return 0 if ratio >= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
