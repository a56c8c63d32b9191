# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How much of each study is run. Seeds are fixed here, before any run: each study draws from a range of its own."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Effort:
    sizes: dict       # cells a side: surfaces made of it; the largest is the reference
    points: tuple     # a facet, of the study of subsamples; 225 is the reference
    points_of: dict   # tracer: surfaces it looks at
    most_points: dict  # tracer: more would take too long
    points_size: int
    pool: int         # realisations
    pool_size: int
    pixels: tuple     # along a side of the image; odd multiples of none of the grids
    aligned: tuple    # likewise, multiples of the grid
    images_of: int    # surfaces seen by images
    image_size: int
    scales: dict      # tracer: cells a side
    check: float      # seconds that a prediction may take to be tried


QUICK = Effort({64: 12, 128: 8, 256: 4}, (9, 25, 64), {"own": 3, "embree": 2, "povray": 1}, {"own": 225, "embree": 64, "povray": 9}, 64,
               8, 64, (91, 181, 363), (64, 128), 1, 64, {"own": (64, 128), "embree": (64, 128), "povray": (64, 128)}, 1.0)
FULL = Effort({64: 64, 128: 64, 256: 48, 512: 16, 1024: 8}, (9, 16, 25, 36, 64, 100, 144), {"own": 16, "embree": 6, "povray": 2},
              {"own": 225, "embree": 144, "povray": 36}, 128, 64, 256, (91, 181, 363, 725, 1449), (64, 128, 256, 512, 1024), 3, 128,
              {"own": (64, 128, 256, 512, 1024), "embree": (64, 128, 256, 512, 1024), "povray": (64, 128, 256, 512)}, 12.0)

REFERENCE = 225  # points per facet, the most there are
SIZES, POINTS, POOL, IMAGES, SCALES, TRIALS = (k * 1000 for k in range(1, 7))  # first seeds
