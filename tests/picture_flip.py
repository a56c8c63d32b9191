# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How different two pictures look: the mean of FLIP (Andersson et al. 2020), by its authors' evaluator, at display exposure."""
import flip_evaluator
import numpy as np


def display(picture):
    """Linear light, clipped to what a display shows, in sRGB's code values."""
    x = np.clip(picture, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055).astype(np.float32)


def flip(reference, picture):
    return float(flip_evaluator.evaluate(display(reference), display(picture), "LDR", True, False, True, {})[1])
