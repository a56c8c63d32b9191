# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""libmusurf_render.so (core/render/musurf_render.h) by ctypes: a parameter table, and a render with progress and cancel. Knows no Blender.

The shared objects are looked for in MUSURF_PLUGIN_PATH and in the folder lib beside this file; those that are not there, do not load or are of
another major version are a LibraryError in one line."""
import ctypes
import json
import os
import pathlib

MAJOR = 1
DONE, STOPPED, FAILED = 0, 1, 2
WARNING, ERROR = 1, 2
NAME = "libmusurf_render.so"

STOP = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)
PROGRESS = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_uint32)
PICTURE = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
MESSAGE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int32, ctypes.c_char_p)
FLOATS = ctypes.POINTER(ctypes.c_float)


class Request(ctypes.Structure):
    """musurf_render_request, field by field."""
    _fields_ = [("size", ctypes.c_uint32), ("threads", ctypes.c_uint32), ("scene", ctypes.c_char_p), ("name", ctypes.c_char_p),
                ("pixels", FLOATS), ("count", ctypes.c_size_t), ("noise", ctypes.c_double), ("interval", ctypes.c_double),
                ("context", ctypes.c_void_p), ("stop", STOP), ("progress", PROGRESS), ("picture", PICTURE), ("message", MESSAGE),
                ("albedo", FLOATS), ("normal", FLOATS)]


class LibraryError(Exception):
    """What stands between this host and the renderer, in one line."""


def folders():
    given = [folder for folder in os.environ.get("MUSURF_PLUGIN_PATH", "").split(":") if folder]
    own = str(pathlib.Path(__file__).resolve().parent / "lib")
    return given + [own] * (own not in given)


def open_library():
    # the renderer looks for materials and its module for pictures in the same places
    os.environ["MUSURF_PLUGIN_PATH"] = ":".join(folders())
    file = next((path for path in (pathlib.Path(folder, NAME) for folder in folders()) if path.exists()), None)
    if not file:
        raise LibraryError(f"there is no {NAME} in {', '.join(folders())}; MUSURF_PLUGIN_PATH can name other folders")
    try:
        library = ctypes.CDLL(str(file))
    except OSError as why:
        raise LibraryError(f"{file} does not load: {why}") from None
    try:
        version = library.musurf_render_version
    except AttributeError:
        raise LibraryError(f"{file} is no musurf renderer: it has no musurf_render_version") from None
    version.restype = ctypes.c_uint32
    if version() // 1000 != MAJOR:
        raise LibraryError(f"{file} has version {version() // 1000} of its interface, and this add-on knows {MAJOR}: "
                           "install the add-on that came with it")
    library.musurf_render_run.argtypes, library.musurf_render_run.restype = [ctypes.POINTER(Request)], ctypes.c_int32
    library.musurf_render_parameters.argtypes = [ctypes.c_char_p, ctypes.c_void_p, MESSAGE]
    library.musurf_render_parameters.restype = ctypes.c_void_p
    library.musurf_render_free.argtypes = [ctypes.c_void_p]
    library.musurf_render_free.restype = None
    return library


def parameters(material):
    """{"id", "label", "doc", "parameters": [...]} of a material type."""
    library, said = open_library(), []
    heard = MESSAGE(lambda _, severity, text: said.append(text.decode(errors="replace")))
    text = library.musurf_render_parameters(material.encode(), None, heard)
    if not text:
        raise LibraryError("; ".join(said) or f"{material}: not known")
    try:
        return json.loads(ctypes.string_at(text))
    finally:
        library.musurf_render_free(text)


def pointer(array):
    return array.ctypes.data_as(FLOATS)


def render(scene, name, buffers, watch, threads=0, noise=0.0, interval=1.0):
    """Fills buffers = (pixels n x 4, albedo n x 3, normal n x 3), float32. `watch` has stop(), progress(fraction, remaining, samples),
    picture() and message(severity, text). What they raise ends the render, and is raised again."""
    library, raised = open_library(), []

    def guarded(function, otherwise=None):
        def call(*arguments):
            try:
                return function(*arguments[1:])
            except Exception as why:  # must not cross C
                raised.append(why)
                return otherwise
        return call

    pixels, albedo, normal = buffers
    request = Request(ctypes.sizeof(Request), threads, scene.encode(), name.encode(), pointer(pixels), len(pixels), noise, interval, None,
                      STOP(guarded(lambda: int(bool(raised or watch.stop())), 1)), PROGRESS(guarded(watch.progress)),
                      PICTURE(guarded(watch.picture)),
                      MESSAGE(guarded(lambda severity, text: watch.message(severity, text.decode(errors="replace")))),
                      pointer(albedo), pointer(normal))
    end = library.musurf_render_run(ctypes.byref(request))
    if raised:
        raise raised[0]
    return end
