# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How much the study measures: everything, or a glance."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Effort:
    environments: tuple  # names of build/environments
    cell: int            # pixels a side for a sphere
    roughness: tuple     # alpha_lin that are taken of scenes/ibl/spheres.json; empty: all
    anisotropy: tuple    # eta, likewise
    truth: int           # paths a pixel of each of the two halves
    samples: int         # a pixel, of the techniques
    rounds: int          # of each frame, for its time
    reads: tuple         # N
    scenes: tuple        # (scene, width, height): looked at as a whole
    k: tuple
    beta: tuple


FULL = Effort(("courtyard", "forest", "interior", "sunrise"), 64, (), (-0.8, 0, 0.8, 0.95), 256, 4, 2, (1, 2, 4, 6, 8, 10, 12, 16, 32, 64), (("teapot", 192, 120), ("plate", 128, 128)),
              (0.25, 0.5, 1, 1.5, 2, 3), (0.5, 1, 1.5, 2.3, 3.5, 5))
QUICK = Effort(("interior",), 32, (0.2, 0.8), (-0.8, 0.8), 48, 4, 3, (1, 4, 8, 12, 16, 64), (), (0.5, 1, 2), (1, 2.3, 5))
FILTERED = 25  # reads of filtered importance sampling in Figure 21
SEED = 16      # reads that the paper settles on
