# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Asks POV-Ray which points of a microsurface three directions see.

Dual method: a top-down orthographic camera looks at one period, three parallel lights stand in the three directions,
one per colour channel, and the finish returns 1 for every lit point whatever its slope. So each channel of a pixel is
the visibility of one point from one direction. The camera's right and up are M-images, hence the points are, too:
pixel (k, l) of a 2 Nx s x Ny s image is the point M ((k + 1/2)/(2 s), (l + 1/2)/s), s^2 points in every facet.
"""
import os
import pathlib
import re
import shutil
import subprocess
import time

import numpy as np

from . import mesh

FAR = 1e5  # lights closer than about 1e3 periods' cells light what is masked
CHANNELS = ("rgb <1,0,0>", "rgb <0,1,0>", "rgb <0,0,1>")


class PovrayError(Exception):
    """POV-Ray is missing or failed; the message holds its own words."""


def tiles(h, views):
    """Periods needed on each side so that a ray that leaves the middle one ends above the surface: range tan / N."""
    reach = max(np.ptp(h) * np.hypot(v[0], v[1]) / v[2] for v in views)
    return max(1, int(np.ceil(reach / min(h.shape))))


def upright(m):
    """The rotation of the plane that brings the long axis of M to x.

    POV-Ray bounds triangles by boxes along its axes: slivers that M stretches along a slanted line fill such boxes so badly
    that M of condition 100 took 30 times as long. Turning the whole scene, points and lights, changes nothing that is seen.
    """
    square = m @ m.T
    angle = np.arctan2(2 * square[0, 1], square[0, 0] - square[1, 1]) / 2
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def turned(turn, v):
    return np.array([*(turn @ np.asarray(v)[:2]), v[2]])


def number(x):
    return format(float(x), ".17g")


def vector(p):
    return "<" + ",".join(number(x) for x in p) + ">"


def mesh2(h, m):
    """The period as mesh2 text with M baked into its vertices. The object itself is never transformed by M."""
    points, faces = mesh.vertices(h, m).reshape(-1, 3), mesh.triangles(h.shape).reshape(-1, 3)
    return "mesh2 {\nvertex_vectors {%d,\n%s\n}\nface_indices {%d,\n%s\n}\n}" % (
        len(points), ",\n".join("<%.17g,%.17g,%.17g>" % tuple(p) for p in points.tolist()),
        len(faces), ",\n".join("<%d,%d,%d>" % tuple(f) for f in faces.tolist()))


def height_field(h, quantised, path):
    """The period as POV-Ray's own height_field from a 16-bit PGM; another code than mesh2's. Row 0 is the highest y."""
    levels, lowest, highest = quantised
    image = np.pad(levels, (0, 1), mode="wrap").T[::-1]
    path.write_bytes(b"P5\n%d %d\n65535\n" % (image.shape[1], image.shape[0]) + image.astype(">u2").tobytes())
    (nx, ny), rise = h.shape, highest - lowest
    # from the unit cube, heights along y, to cells of size 1, heights along z
    return 'height_field { pgm "%s" matrix <%d,0,0, 0,0,%s, 0,%d,0, 0,0,%s> }' % (
        path.name, nx, number(rise), ny, number(lowest))


def scene(surface, h, m, lights, around):
    """The whole scene: the period's camera, the lights in the directions given, (2 around + 1)^2 periods.

    `surface` is mesh2(h, m) or height_field with M = 1; the caller turns M and the lights upright.
    """
    nx, ny = h.shape
    x, y = m @ [nx, 0], m @ [0, ny]
    centre = np.array([*(x + y) / 2, 0.0])
    text = ["#version 3.7;", "global_settings { assumed_gamma 1 ambient_light rgb 0 }",
            "camera { orthographic location %s direction <0,0,-1> right %s up %s }" % (
                vector([*centre[:2], h.max() + 10]), vector([*x, 0]), vector([*y, 0]))]
    for light, colour in zip(lights, CHANNELS):
        text.append("light_source { %s color %s parallel point_at %s }" % (
            vector(centre + FAR * np.asarray(light)), colour, vector(centre)))
    text.append("#declare Period = object { %s\n  texture { pigment { color rgb 1 } "
                "finish { ambient 0 emission 0 diffuse 1 brilliance 0 } } }" % surface)
    for a in range(-around, around + 1):
        for b in range(-around, around + 1):
            text.append("object { Period translate %s }" % vector([*(a * x + b * y), 0]))
    return "\n".join(text) + "\n"


def version():
    done = subprocess.run([find(), "--version"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return next((x for x in (done.stdout + done.stderr).splitlines() if x.startswith("POV-Ray")), "POV-Ray").strip()


def find():
    program = shutil.which(os.environ.get("POVRAY", "povray"))
    if not program:
        raise PovrayError("POV-Ray not found; install it (Debian: apt-get install povray) or name it in POVRAY")
    return program


def complaint(stderr):
    """POV-Ray's own words about what failed."""
    lines = [line.strip() for line in stderr.splitlines() if line.strip()]
    wanted = [line for line in lines if "rror" in line or "ailed" in line]
    return "; ".join(wanted[:3] or lines[-3:]) or "no message"


def run(text, folder, name, width, height, deep=False):
    """Renders the scene; returns (image [row, column, channel] of 8 or, if deep, 16 bits, {"seconds", "megabytes"})."""
    folder = pathlib.Path(folder)
    (folder / f"{name}.pov").write_text(text)
    output = folder / f"{name}.ppm"
    output.unlink(missing_ok=True)
    command = [find(), f"+I{name}.pov", f"+O{output.name}", "+FP16" if deep else "+FP", f"+W{width}", f"+H{height}",
               "-A", "-D", "-C", "-P", "+WT1", "-GD", "-GR", "-V", "File_Gamma=1"]
    start = time.monotonic()
    with open(folder / f"{name}.log", "w+b") as log:
        child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        try:
            peak = watch(child)
        except BaseException:
            child.kill()
            child.wait()
            raise
        log.seek(0)
        stderr = log.read().decode(errors="replace")
    if child.returncode or not output.exists():
        raise PovrayError(f"POV-Ray ended with {child.returncode} on {name}.pov: {complaint(stderr)}")
    image = read_ppm(output)
    for suffix in ("pov", "ppm", "pgm", "log"):  # a failed run leaves them for inspection
        (folder / f"{name}.{suffix}").unlink(missing_ok=True)
    return image, {"seconds": time.monotonic() - start, "megabytes": peak}


def watch(child):
    """Waits; returns the process's own peak memory in MB. (wait4's figure would count the parent before the exec.)"""
    peak = 0
    while child.poll() is None:
        try:
            status = pathlib.Path(f"/proc/{child.pid}/status").read_text()
            peak = max(peak, int(status.partition("VmHWM:")[2].split()[0]))
        except (OSError, IndexError):
            pass  # it has just ended
        time.sleep(0.02)
    return peak / 1024


def read_ppm(path):
    """A binary PPM of 8 or 16 bits as [row, column, channel]; row 0 is the highest."""
    data = path.read_bytes()
    header = re.match(rb"P6\s+(?:#[^\n]*\n\s*)*(\d+)\s+(\d+)\s+(255|65535)\s", data)
    if not header:
        raise PovrayError(f"{path.name}: POV-Ray wrote no PPM of 8 or 16 bits")
    kind = np.uint8 if header[3] == b"255" else ">u2"
    return np.frombuffer(data, kind, offset=header.end()).reshape(int(header[2]), int(header[1]), 3)


def visibility(image, shape, directions=3):
    """Bits [direction, i, j, L|U, point] from the image of 2 Nx s x Ny s pixels; s^2 points in every facet."""
    if not np.isin(image, (0, 255)).all():
        raise PovrayError("POV-Ray's image holds values between dark and lit; the finish is not 0 or 1")
    (nx, ny), fine = shape, image.shape[0] // shape[1]
    bits = (image[::-1] == 255).transpose(2, 1, 0)[:directions].reshape(directions, nx, 2 * fine, ny, fine).transpose(0, 1, 3, 2, 4)
    p, q = np.meshgrid(np.arange(2 * fine), np.arange(fine), indexing="ij")
    lower = 2 * p + 4 * q + 3 < 4 * fine  # x + y < 1 within the cell; equality cannot occur
    return np.stack([bits[..., lower], bits[..., ~lower][..., ::-1]], 3)
