#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Against Mitsuba's own BSDFs where they are the same surface: roughconductor (GGX and Beckmann, alpha_u != alpha_v) and roughdielectric from
both sides, as values and as pictures. Mitsuba's shadowing-masking is separable, so ours is switched to that; its G1 of Beckmann is a
rational fit that it states to be good to 0.35 %, ours is exact."""
import os
import sys
import unittest

import mitsuba_host

mi, musurf_mitsuba = mitsuba_host.enter()
import drjit as dr  # noqa: E402
import numpy as np  # noqa: E402
import pixel_test  # noqa: E402

mitsuba_host.listen(mi)
FULL = bool(os.environ.get("FULL"))
ALPHA = (0.15, 0.45)
N, K = (0.2, 0.9, 1.4), (3.9, 2.5, 1.6)
METAL = dict(fresnel="conductor", fresnel_conductor="custom", fresnel_conductor_n=" ".join(map(str, N)), fresnel_conductor_k=" ".join(map(str, K)))
# Of a product of two G1, each off by that: twice the fit's error. What is exact on both sides differs by rounding: floats, of some hundred operations.
ROUNDING, FIT = 1e-4, 2 * 0.0035


def rgb(values):
    return {"type": "rgb", "value": list(values)}


def conductors(ndf):
    own = mi.load_dict({"type": "roughconductor", "distribution": ndf, "alpha_u": ALPHA[0], "alpha_v": ALPHA[1], "eta": rgb(N), "k": rgb(K)})
    ours = mi.load_dict({"type": "musurf", "ndf": ndf, "alpha_x": ALPHA[0], "alpha_y": ALPHA[1], "masking": "separable", "sampler": "visible", **METAL})
    return own, ours


def dielectrics(ndf):
    own = mi.load_dict({"type": "roughdielectric", "distribution": ndf, "alpha_u": ALPHA[0], "alpha_v": ALPHA[1], "int_ior": 1.5, "ext_ior": 1.0})
    ours = mi.load_dict({"type": "musurf", "ndf": ndf, "alpha_x": ALPHA[0], "alpha_y": ALPHA[1], "masking": "separable", "fresnel": "dielectric",
                         "fresnel_dielectric": 1.5, "transmission": True})
    return own, ours


def directions(count, seed, sides):
    rng = np.random.default_rng(seed)
    z = rng.uniform(0.1, 1, count) * rng.choice(sides, count)
    phi = rng.uniform(0, 2 * np.pi, count)
    return mi.Vector3f(*[mi.Float(x.astype(np.float32)) for x in (np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z)])


class Values(unittest.TestCase):
    def same(self, pair, tolerance, sides, mode=None):
        own, ours = pair
        si = dr.zeros(mi.SurfaceInteraction3f, 20000)
        si.wi, wo = directions(20000, 31, sides), directions(20000, 32, sides)
        context = mi.BSDFContext()
        if mode is not None:
            context.mode = mode
        wanted, found = own.eval_pdf(context, si, wo), ours.eval_pdf(context, si, wo)
        worst = []
        for a, b in zip(wanted, found):
            a, b = np.array(a), np.array(b)
            # far down a lobe float exponentials of large arguments lose digits on both sides: relative to a thousandth of the peak there
            worst.append(np.max(np.abs(a - b) / np.maximum(a, 1e-3 * a.max())))
        print(f"{own.class_name()}: f and pdf off by at most {worst[0]:.1e} and {worst[1]:.1e} of it")
        self.assertLess(worst[0], tolerance)
        self.assertLess(worst[1], tolerance)
        self.assertGreater(np.mean(np.array(wanted[0]) > 0), 0.2)

    def test_ggx_conductor(self):
        self.same(conductors("ggx"), ROUNDING, [1])

    def test_beckmann_conductor(self):
        self.same(conductors("beckmann"), FIT, [1])

    def test_ggx_dielectric(self):
        for mode in (mi.TransportMode.Radiance, mi.TransportMode.Importance):
            self.same(dielectrics("ggx"), ROUNDING, [1, -1], mode)

    def test_beckmann_dielectric(self):
        self.same(dielectrics("beckmann"), FIT, [1, -1])

    def test_height_correlated_masking_is_another(self):
        """The test sees the form of masking: unswitched, ours differs."""
        own, ours = conductors("ggx")[0], mi.load_dict({"type": "musurf", "alpha_x": ALPHA[0], "alpha_y": ALPHA[1], "sampler": "visible", **METAL})
        with self.assertRaises(AssertionError):
            self.same((own, ours), FIT, [1])


def scene(bsdf, plate):
    look = mi.ScalarTransform4f().look_at
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 6, "rr_depth": 99},
        "sensor": {"type": "perspective", "fov": 40, "to_world": look([0, -4, 2.5], [0, 0, 0.3], [0, 0, 1]),
                   "film": {"type": "hdrfilm", "width": 48, "height": 36, "rfilter": {"type": "box"}}},
        "plate": {"type": "rectangle", "to_world": mi.ScalarTransform4f().scale(2), "bsdf": plate},
        "ball": {"type": "sphere", "radius": 0.7, "center": [0, 0, 0.75], "bsdf": bsdf},
        "sky": {"type": "constant", "radiance": rgb((0.2, 0.3, 0.4))},
        "lamp": {"type": "rectangle", "to_world": look([2, -1, 3], [0, 0, 0], [0, 0, 1]), "emitter": {"type": "area", "radiance": rgb((6, 5, 4))}}})


def pictures(bsdf, plate, seed):
    built = scene(bsdf, plate)
    with musurf_mitsuba.evaluated():
        return [np.array(mi.render(built, spp=256 if FULL else 32, seed=seed + i)) for i in range(8)]


class Pictures(unittest.TestCase):
    """The sphere's tangents are Mitsuba's for both, so that alpha_u and alpha_v lie alike; light goes from object to object."""

    def compare(self, pair):
        (own, ours), (plate, our_plate) = pair, conductors("ggx")
        return pixel_test.judge(pictures(own, plate, 100), pictures(ours, our_plate, 200))

    def test_same_pictures(self):
        for name, pair in (("GGX conductor", conductors("ggx")), ("Beckmann conductor", conductors("beckmann")), ("GGX glass", dielectrics("ggx"))):
            found, bound = self.compare(pair)
            print(f"{name}: mean |t| {found:.3f}, at most {bound:.3f}")
            self.assertLess(found, bound, name)

    def test_another_roughness_is_seen(self):
        own = conductors("ggx")[0]
        ours = mi.load_dict({"type": "musurf", "alpha_x": ALPHA[1], "alpha_y": ALPHA[0], "masking": "separable", **METAL})
        found, bound = self.compare((own, ours))
        self.assertGreater(found, 1.5 * bound)


if __name__ == "__main__":
    sys.exit(unittest.main())
