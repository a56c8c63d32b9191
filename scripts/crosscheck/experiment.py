# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes the surfaces, has POV-Ray look at them under every M, and reduces the bits to the numbers that are judged."""
import concurrent.futures
import itertools

import numpy as np

from . import heightfield, maps, masking, mesh, normals, povray, smith

PLAIN = 16  # surfaces in the statistics of normals, which need no POV-Ray
FINE = 3  # points per facet side: 9 points in every facet, the middle one among them


class Setup:
    """What is asked: alpha, size, correlation, seed, realisations (at most PLAIN), views (up to three, untransformed),
    maps {name: M}, threads."""

    def __init__(self, **values):
        self.__dict__.update(values)
        # surfaces whose normals are counted but which nobody looks at; the first of them are those POV-Ray sees
        self.plain = [heightfield.make(self.size, self.alpha, self.correlation, (self.seed, k)) for k in range(PLAIN)]
        self.pairs = list(itertools.combinations(range(len(self.views)), 2))

    def nu(self, view):
        return view[2] / np.hypot(view[0], view[1]) / self.alpha


class Surface:
    def __init__(self, setup, number, folder):
        self.h, self.quantised = heightfield.quantise(setup.plain[number])
        self.number, self.folder = number, folder
        self.around = povray.tiles(self.h, setup.views)

    def seen(self, setup, name, m, lights, fine, steps, entry, field=False):
        """Bits [direction, i, j, L|U, point] under M; field: by height_field instead of a mesh."""
        label = f"{name.replace(' ', '-')}-{self.number}"
        surface = (povray.height_field(self.h, self.quantised, self.folder / f"{label}.pgm") if field
                   else povray.mesh2(self.h, m))
        scene = povray.scene(surface, self.h, m, lights, self.around)
        image, used = povray.run(scene, self.folder, label, 2 * setup.size * fine, setup.size * fine)
        steps.povray(entry, used)
        steps.advance(f"{name}, surface {self.number + 1}", fine**2 + 2)
        return povray.visibility(image, setup.size, len(lights))


def work(setup):
    """All that advance() will be told, for the time left."""
    moved = sum(not np.array_equal(m, np.eye(2)) for m in setup.maps.values())
    return setup.realisations * (1 + len(setup.maps)) * (FINE**2 + 2) + 2 * moved * 3


def parallel(setup, jobs):
    """Runs the jobs, setup.threads at a time; results in order; the first failure stops the rest."""
    with concurrent.futures.ThreadPoolExecutor(setup.threads) as pool:
        waiting = [pool.submit(job) for job in jobs]
        try:
            return [future.result() for future in waiting]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def measure(setup, surface, m, bits, original, first):
    """The numbers of one surface under one M, from its own baked geometry and its own bits.

    first: the bits of the mesh under the first M, which is the identity unless the setup says otherwise. Against them
    height_field's own rounding plays no part.
    """
    slopes = mesh.baked_slopes(surface.h, m)
    directions = [maps.carried(m, v) for v in setup.views]
    kinds = masking.classes(slopes, setup.alpha, m)
    different, total = masking.disagreement(bits, original)
    edges = [smith.edges(setup.nu(v)) for v in setup.views]
    return {"different": different, "total": total, "different_from_mesh": masking.disagreement(bits, first)[0],
            "different_facets": masking.disagreement(masking.centre(bits), masking.centre(original))[0],
            "facets": slopes[0].size,
            "projected": [masking.projected_mean(b, slopes, w) for b, w in zip(bits, directions)],
            "facet_mean": [masking.facet_mean(b, slopes, w) for b, w in zip(bits, directions)],
            "bins": [masking.binned(b, slopes, w, setup.nu(v), e)
                     for b, w, v, e in zip(bits, directions, setup.views, edges)],
            "joint": [masking.joint(bits, slopes, a, b, directions, kinds) for a, b in setup.pairs]}


def run(setup, folder, steps):
    """Returns {"maps": {name: [numbers per surface]}, "controls": [...], "bits": first surface's bits by name}."""
    with steps.step("heightfields"):
        surfaces = [Surface(setup, k, folder) for k in range(setup.realisations)]
    identity, first = np.eye(2), None
    with steps.step("original as POV-Ray's height_field") as entry:
        originals = parallel(setup, [lambda s=s: s.seen(setup, "original", identity, setup.views, FINE, steps, entry, True)
                                     for s in surfaces])
    result = {"maps": {}, "controls": [], "bits": {"original": originals[0]}, "first": surfaces[0].h}
    for name, m in setup.maps.items():
        with steps.step(f"baked mesh under {name}") as entry:
            lights = [maps.carried(m, v) for v in setup.views]
            seen = parallel(setup, [lambda s=s: s.seen(setup, name, m, lights, FINE, steps, entry) for s in surfaces])
            first = first or seen
            result["maps"][name] = [measure(setup, s, m, *bits)
                                    for s, *bits in zip(surfaces, seen, originals, first)]
            result["bits"][name] = seen[0]
    with steps.step("negative controls") as entry:
        result["controls"] = controls(setup, surfaces[0], masking.centre(originals[0]), steps, entry)
    return result


def controls(setup, surface, original, steps, entry):
    """The transformed surface lit from wrong directions: the comparison of bits must notice."""
    jobs, names = [], []
    for name, m in setup.maps.items():
        if np.array_equal(m, np.eye(2)):
            continue
        for wrong, lights in (("v", setup.views), ("M^-1 v", [maps.carried(np.linalg.inv(m), v) for v in setup.views])):
            names.append((name, wrong))
            label = f"{name} lit from {wrong}".replace("^-1", " inverse")
            jobs.append(lambda label=label, m=m, lights=lights: surface.seen(setup, label, m, lights, 1, steps, entry))
    return [{"map": name, "lit_from": wrong, "bits": bits, "different": masking.disagreement(bits, original)[0],
             "total": original[0].size} for (name, wrong), bits in zip(names, parallel(setup, jobs))]
