# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How far a picture is from the truth, over the pixels that see nothing but the object: FLIP as displayed, and relative error.

FLIP (Andersson et al. 2020), by its authors' evaluator, of pictures clipped at 1 and in sRGB's code values, at its usual 67 pixels per degree;
what is not inside is black in both. Relative error is the mean absolute difference of radiance over the mean radiance, of all three channels.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import picture_flip  # noqa: E402


def flip_map(truth, picture, inside):
    import flip_evaluator

    shown = [picture_flip.display(np.where(inside[..., None], p, 0)) for p in (truth, picture)]
    return np.asarray(flip_evaluator.evaluate(*shown, "LDR", True, False, True, {})[0]).reshape(inside.shape)


def flip(truth, picture, inside):
    return float(flip_map(truth, picture, inside)[inside].mean())


def relative(truth, picture, inside):
    return float(np.abs(picture - truth)[inside].mean() / truth[inside].mean())


def both(truth, picture, inside):
    return {"flip": flip(truth, picture, inside), "relative": relative(truth, picture, inside)}


def noise(halves, inside):
    """Of the mean of two halves: their difference is twice as large as its error. FLIP is that of the halves, and so an upper bound for the mean's."""
    a, b = halves
    return {"flip": flip(a, b, inside), "relative": float(np.abs(a - b)[inside].mean() / (a + b)[inside].mean())}
