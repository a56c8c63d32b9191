# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What is looked at: surfaces, maps, views, lights, and how many realisations, quick or full."""
import numpy as np

from . import maps, surfaces

VIEWS = (maps.direction(60, 20), maps.direction(75, 50), maps.direction(85, 200))
# lights beside views: azimuths 10, 80 and 90 degrees apart, of like elevation
LIGHTS = (maps.direction(75, 0), maps.direction(75, 10), maps.direction(60, 90))
MIRROR_VIEWS = {"quick": (maps.direction(60, 20),),
                "full": (maps.direction(60, 20), maps.direction(75, 50))}
DISTRIBUTIONS = {
    "quick": {"Beckmann .3": {"ndf": "beckmann", "alpha": 0.3}, "GGX .3": {"ndf": "ggx", "alpha": 0.3}},
    "full": {"Beckmann .3": {"ndf": "beckmann", "alpha": 0.3}, "Beckmann .6": {"ndf": "beckmann", "alpha": 0.6},
             "GGX .3": {"ndf": "ggx", "alpha": 0.3}, "GTR 1": {"ndf": "gtr", "alpha": 0.3, "gamma": 1.0},
             "GTR 1.5": {"ndf": "gtr", "alpha": 0.3, "gamma": 1.5}, "GTR 3": {"ndf": "gtr", "alpha": 0.3, "gamma": 3.0},
             "STD 2.5": {"ndf": "std", "alpha": 0.3, "gamma": 2.5}},
}
SKEW = np.array([[1.0, 2.0], [0.0, 1.0]])
MIRROR = np.array([[1.0, 0.0], [0.0, -1.0]])


def all_maps(seed, how):
    turn = maps.rotation(np.radians(35))
    chosen = {"identity": np.eye(2), "stretch 5x": np.diag([5.0, 1.0]), "skew": SKEW}
    if how == "full":
        chosen |= {"compression .4x": np.diag([1.0, 0.4]), "rotation 30": maps.rotation(np.radians(30)), "mirror": MIRROR}
    chosen["random mirror"] = maps.random_mirror(seed)
    if how == "full":
        chosen["condition 100"] = turn @ np.diag([10.0, 0.1]) @ maps.rotation(np.radians(20))
    return chosen


# Maps under which light is traced on: none makes the surface rougher in any direction than the compression, which is as far as
# Smith's error is known (known.py)
MIRROR_MAPS = {"identity": np.eye(2), "half skew": np.array([[1.0, 1.0], [0.0, 1.0]]), "stretch 5x": np.diag([5.0, 1.0]),
               "mirrored skew": np.array([[1.0, 0.8], [0.0, -1.0]]), "compression .5x": np.diag([1.0, 0.5])}
MIRRORS = {"quick": ("identity", "half skew", "mirrored skew"), "full": ("identity", "stretch 5x", "mirrored skew", "compression .5x")}


class Plan:
    """surfaces [Spec or Given], maps {name: M}, looks [(name, views, names of maps)], mirror maps and views, counts."""

    def __init__(self, how, seed, size=None):
        quick = how == "quick"
        self.how, self.seed, self.size = how, seed, size or (192 if quick else 256)
        self.surfaces = [surfaces.Spec(name, self.size, seed * 1000, **values) for name, values in DISTRIBUTIONS[how].items()]
        self.maps = all_maps(seed, how)
        lights = list(self.maps) if quick else ["identity", "skew", "random mirror"]
        self.looks = [("views", VIEWS, list(self.maps))] + ([] if quick else [("lights", LIGHTS, lights)])
        self.seen = 2  # realisations that are looked at
        self.plain = 8 if quick else 16  # realisations whose normals are counted
        self.mirrors = 4  # realisations that reflect
        self.resolution = 307 if quick else 401  # pixels a side; prime, lest they fall in step with the cells
        self.mirror_maps = {name: MIRROR_MAPS[name] for name in MIRRORS[how]}
        self.mirror_views = MIRROR_VIEWS[how]

    def only(self, transforms, views):
        """What the user asks for: these maps besides the identity, these views of the original."""
        if transforms:
            given = {f"given {k}": m for k, m in enumerate(transforms, 1)}
            self.maps = {"identity": np.eye(2), **given}
            self.mirror_maps = dict(self.maps)
        if views:
            self.looks = [("views", tuple(views), list(self.maps))]
            self.mirror_views = tuple(views)
        elif transforms:
            self.looks = [(name, v, list(self.maps)) for name, v, _ in self.looks]
        return self

    def replace(self, chosen):
        """Other surfaces: a heightfield, or the materials of a scene."""
        self.surfaces = chosen
        if any(s.file for s in chosen):
            self.seen = self.plain = self.mirrors = 1
        return self
