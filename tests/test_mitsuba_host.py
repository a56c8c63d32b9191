#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The BSDF "musurf" in Mitsuba: its records are the headers', its values are those of `musurf eval`, parameters arrive from dict, XML and
material file alike, textures and mesh attributes vary M per point, edits and flags are Mitsuba's."""
import ctypes
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import mitsuba_host

mi, musurf_mitsuba = mitsuba_host.enter()
import drjit as dr  # noqa: E402
import numpy as np  # noqa: E402
from musurf_mitsuba import abi  # noqa: E402

HEARD = mitsuba_host.listen(mi)
SKEW = dict(ndf="gtr", alpha=0.3, gamma=1.5, transform="1 2 0 1", fresnel="conductor", fresnel_conductor="Au", masking="separable")
SAME = {"material": "musurf.microfacet", "ndf": "gtr", "alpha": 0.3, "gamma": 1.5, "transform": [[1, 2], [0, 1]],
        "fresnel": {"conductor": "Au"}, "masking": "separable"}


def directions(count, seed, below=False):
    rng = np.random.default_rng(seed)
    z = rng.uniform(0.05, 1, count) * (rng.choice([-1, 1], count) if below else 1)
    phi = rng.uniform(0, 2 * np.pi, count)
    r = np.sqrt(1 - z * z)
    return np.array([r * np.cos(phi), r * np.sin(phi), z], dtype=np.float32)


def hits(wo, uv=(0.5, 0.5)):
    si = dr.zeros(mi.SurfaceInteraction3f, wo.shape[1])
    si.wi, si.uv = mi.Vector3f(*[mi.Float(row) for row in wo]), mi.Point2f(*[mi.Float(x) for x in uv])
    return si


def vector(wi):
    return mi.Vector3f(*[mi.Float(row) for row in wi])


def load(**properties):
    return mi.load_dict({"type": "musurf", **properties})


def values(bsdf, wo, wi, **where):
    """f |wi.z| as 3 x n, and pdf."""
    f, pdf = bsdf.eval_pdf(mi.BSDFContext(), hits(wo, **where), vector(wi))
    return np.array(f), np.array(pdf)


def command_eval(material, wo, wi):
    lines = "".join(json.dumps({"material": material, "wo": a.tolist(), "wi": b.tolist()}) + "\n"
                    for a, b in zip(wo.T.astype(float), wi.T.astype(float)))
    done = subprocess.run([mitsuba_host.BUILD / "musurf", "eval", "--precision", "double"], input=lines, capture_output=True, text=True, check=True)
    found = [json.loads(line) for line in done.stdout.splitlines()]
    return np.array([x["f"] for x in found]).T * np.abs(wi[2]), np.array([x["pdf"] for x in found])


class Records(unittest.TestCase):
    def test_are_the_headers(self):
        """Every field that ctypes knows stands where a C compiler puts it."""
        of = {abi.Host: "musurf_host", abi.Param: "musurf_param", abi.Setting: "musurf_setting", abi.Plan: "musurf_plan",
              abi.MaterialType: "musurf_material_type", abi.Plugin: "musurf_plugin", abi.Column: "musurf_column",
              abi.Wavefront: "musurf_wavefront", abi.Values: "musurf_wavefront_values", abi.Samples: "musurf_wavefront_samples"}
        names = [(record, field[0]) for record in of for field in record._fields_]
        prints = "".join(f'printf("%zu %zu\\n", offsetof({of[r]}, {f}), sizeof((({of[r]} *)0)->{f}));\n' for r, f in names)
        prints += "".join(f'printf("%zu 0\\n", sizeof({c}));\n' for c in of.values())
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "offsets.c")
            source.write_text('#include "plugin/mitsuba/wavefront.h"\n#include <stdio.h>\nint main(void) {\n' + prints + "return 0; }\n")
            subprocess.run(["cc", f"-I{mitsuba_host.ROOT}", source, "-o", source.with_suffix("")], check=True)
            lines = subprocess.run([source.with_suffix("")], capture_output=True, text=True, check=True).stdout.splitlines()
        wanted = [f"{getattr(r, f).offset} {getattr(r, f).size}" for r, f in names] + [f"{ctypes.sizeof(r)} 0" for r in of]
        self.assertEqual(lines, wanted)

    def test_ids_are_the_headers(self):
        text = (mitsuba_host.ROOT / "plugin/musurf_plugin.h").read_text()
        for name, number in re.findall(r"MUSURF_([A-Z0-9_]+) = (\d+)\b", text):
            self.assertEqual(getattr(abi, name, int(number)), int(number), name)
        for name, bit in re.findall(r"MUSURF_([A-Z0-9_]+) = 1u << (\d+)", text):
            self.assertEqual(getattr(abi, name, 1 << int(bit)), 1 << int(bit), name)


class Host(unittest.TestCase):
    def agree(self, found, wanted, tolerance):
        self.assertLess(np.max(np.abs(found - wanted) / np.maximum(np.abs(wanted), 1e-6)), tolerance)

    def test_values_are_those_of_the_command(self):
        """The plugin shades in float: its own tables state 1e-5 and better for f away from the horizon (README, 3.4e-5 at worst)."""
        wo, wi = directions(500, 1), directions(500, 2)
        glass = {"material": "musurf.microfacet", "ndf": "beckmann", "alpha": 0.4, "transform": [[1.5, 0.2], [0, 1]],
                 "fresnel": {"dielectric": 1.5}, "transmission": True}
        for properties, material, wi_here in ((SKEW, SAME, wi),
                                              (dict(ndf="beckmann", alpha=0.4, transform="1.5 0.2 0 1", fresnel="dielectric",
                                                    fresnel_dielectric=1.5, transmission=True), glass, directions(500, 3, below=True))):
            f, pdf = values(load(**properties, sampler="visible"), wo, wi_here)
            wanted_f, wanted_pdf = command_eval({**material, "sampler": "visible"}, wo, wi_here)
            self.agree(f, wanted_f, 1e-4)
            self.agree(pdf, wanted_pdf, 1e-4)

    def test_sample_is_what_eval_says(self):
        wo, rng = directions(20000, 4), np.random.default_rng(5)
        for properties in (dict(SKEW), dict(ndf="ggx", alpha=0.3, fresnel="dielectric", transmission=True), dict(ndf="flat")):
            bsdf, si, context = load(**properties), hits(wo), mi.BSDFContext()
            u = [mi.Float(rng.random(wo.shape[1], dtype=np.float32)) for _ in range(3)]
            bs, weight = bsdf.sample(context, si, u[0], mi.Point2f(u[1], u[2]))
            kind, component = np.array(bs.sampled_type), np.array(bs.sampled_component)
            drawn = np.array(bs.pdf) > 0
            self.assertGreater(drawn.mean(), 0.6)
            self.assertTrue(np.all((kind != 0) == drawn))
            for index, flags in enumerate(bsdf.m_components):
                self.assertTrue(np.all(kind[drawn & (component == index)] & (flags ^ 0xffffffff) == 0))
            if properties["ndf"] == "flat":
                self.assertTrue(np.all(kind[drawn] == int(mi.BSDFFlags.DeltaReflection)))
                self.assertLess(np.abs(np.array(bs.wo) - wo * [[-1], [-1], [1]]).max(), 1e-6)
                continue
            f, pdf = bsdf.eval_pdf(context, si, bs.wo)
            good = drawn & (np.abs(np.array(bs.wo)[2]) > 0.1) & (np.array(pdf) > 1e-3)
            self.agree(np.array(pdf)[good], np.array(bs.pdf)[good], 1e-2)  # wo is rounded, and so is where the peak is
            self.agree((np.array(weight) * np.array(bs.pdf))[:, good], np.array(f)[:, good], 1e-2)
            through = np.array(bs.wo)[2] < 0
            self.assertTrue(np.all(np.array(bs.eta)[drawn & ~through] == 1))
            if properties.get("transmission"):
                self.assertGreater((through & drawn).mean(), 0.5)
                self.assertLess(np.abs(np.array(bs.eta)[through & drawn] - 1.5).max(), 1e-6)

    def test_masks_and_inactive_lanes(self):
        wo, wi = directions(100, 6), directions(100, 7)
        bsdf, even = load(**SKEW), mi.Mask(np.arange(100) % 2 == 0)
        f, pdf = bsdf.eval_pdf(mi.BSDFContext(), hits(wo), vector(wi), even)
        whole, _ = values(bsdf, wo, wi)
        self.assertTrue(np.all(np.array(f) == np.where(np.arange(100) % 2 == 0, whole, 0)))
        only = mi.BSDFContext()
        only.type_mask = int(mi.BSDFFlags.GlossyTransmission)
        self.assertTrue(np.all(np.array(bsdf.eval(only, hits(wo), vector(wi))) == 0))

    def test_no_hits_and_sizes_that_do_not_go_together(self):
        bsdf, context, one = load(**SKEW), mi.BSDFContext(), directions(1, 26)
        for wo, wi in ((directions(0, 26), one), (directions(0, 26), directions(0, 27))):
            f, pdf = bsdf.eval_pdf(context, hits(wo), vector(wi))
            bs, weight = bsdf.sample(context, hits(wo), mi.Float(0.5), mi.Point2f(0.5, 0.5))
            self.assertEqual([dr.width(x) for x in (f, pdf, bs, weight)], [0] * 4)
        with self.assertRaisesRegex(RuntimeError, "incompatible sizes: .*3.*5"):
            bsdf.eval(context, hits(directions(5, 26)), vector(directions(3, 27)))
        self.assertEqual(dr.width(bsdf.eval(context, hits(one), vector(directions(3, 27)))), 3)

    def test_threads_give_the_bits_of_one(self):
        from musurf_mitsuba import wavefront
        wo, wi, bsdf, before = directions(50000, 8), directions(50000, 9), load(**SKEW), wavefront.THREADS
        try:
            wavefront.THREADS = 1
            alone = values(bsdf, wo, wi)
            wavefront.THREADS = 5
            together = values(bsdf, wo, wi)
        finally:
            wavefront.THREADS = before
        self.assertTrue(np.all(alone[0] == together[0]) and np.all(alone[1] == together[1]))

    def test_no_more_threads_than_mitsuba_s(self):
        from musurf_mitsuba import wavefront
        before, found = dr.thread_count(), []
        original = wavefront.describe

        def describe(*arguments):
            found.append(original(*arguments))
            return found[-1]

        try:
            dr.set_thread_count(3)
            with unittest.mock.patch.object(wavefront, "describe", describe):
                values(load(**SKEW), directions(10, 8), directions(10, 9))
        finally:
            dr.set_thread_count(before)
        self.assertEqual([w.threads for w in found], [3])

    def test_parameters_from_everywhere(self):
        wo, wi = directions(200, 10), directions(200, 11)
        wanted = values(load(**SKEW), wo, wi)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "gold.json")
            file.write_text(json.dumps(SAME))
            xml = mi.load_string("""<bsdf version="3.0.0" type="musurf"><string name="ndf" value="gtr"/><float name="alpha" value="0.3"/>
                <float name="gamma" value="1.5"/><transform name="transform"><matrix value="1 2 0 0  0 1 0 0  0 0 1 0  0 0 0 1"/></transform>
                <string name="fresnel" value="conductor"/><string name="fresnel.conductor" value="Au"/><string name="masking" value="separable"/></bsdf>""")
            tensor = load(**{**SKEW, "transform": mi.TensorXf(np.array([[1, 2], [0, 1]], dtype=np.float32))})
            single = load(**{**SKEW, "transform_1": 2, "transform": "1 0 0 1"})
            changed = load(file=str(file), gamma=3.0)
            for bsdf in (load(file=str(file)), xml, tensor, single):
                self.assertTrue(np.all(values(bsdf, wo, wi)[0] == wanted[0]))
            self.assertTrue(np.all(values(changed, wo, wi)[0] == values(load(**{**SKEW, "gamma": 3.0}), wo, wi)[0]))

    def test_colors_and_vectors_as_mitsuba_writes_them(self):
        wo, wi = directions(100, 24), directions(100, 25)
        red = [0.9, 0.5, 0.2]
        plain = dict(ndf="ggx", alpha=0.3, fresnel="schlick")
        wanted = values(load(**plain, fresnel_schlick="0.9 0.5 0.2"), wo, wi)[0]
        xml = """<bsdf version="3.0.0" type="musurf"><string name="fresnel" value="schlick"/><float name="alpha" value="0.3"/>
            <rgb name="fresnel_schlick" value="0.9 0.5 0.2"/></bsdf>"""
        for bsdf in (load(**plain, fresnel_schlick={"type": "rgb", "value": red}), load(**plain, fresnel_schlick=red), mi.load_string(xml),
                     load(**plain, fresnel_schlick=mi.Color3f(*red)), load(**plain, fresnel_schlick=np.array(red))):
            self.agree(values(bsdf, wo, wi)[0], wanted, 1e-6)  # colors of Mitsuba's may be floats
        grey = values(load(**plain, fresnel_schlick=0.5), wo, wi)[0]
        self.agree(values(load(**plain, fresnel_schlick={"type": "spectrum", "value": 0.5}), wo, wi)[0], grey, 1e-6)
        tilted = values(load(ndf="ggx", alpha=0.3, tilt="0.2 -0.1"), wo, wi)[0]
        self.agree(values(load(ndf="ggx", alpha=0.3, tilt=mi.ScalarPoint2f(0.2, -0.1)), wo, wi)[0], tilted, 1e-5)
        skewed = values(load(ndf="ggx", alpha=0.3, transform="1 2 0 1"), wo, wi)[0]
        self.agree(values(load(ndf="ggx", alpha=0.3, transform=mi.Matrix2f(1, 2, 0, 1)), wo, wi)[0], skewed, 1e-6)

    def test_map_per_point_from_textures(self):
        """A bitmap for one entry of M, a number for the others: at each texel the same as the constant M."""
        wo, wi = directions(4, 12), directions(4, 13)
        entries = np.array([[0.5, 1.0], [2.0, 3.0]], dtype=np.float32)
        bitmap = {"type": "bitmap", "data": mi.TensorXf(entries[:, :, None]), "raw": True, "filter_type": "nearest"}
        plain = {**SKEW}
        del plain["transform"]
        bsdf = load(**plain, transform_1=bitmap, transform_3=0.8)
        self.assertTrue(bsdf.m_flags & int(mi.BSDFFlags.SpatiallyVarying))
        f, pdf = values(bsdf, wo, wi, uv=([0.25, 0.75, 0.25, 0.75], [0.25, 0.25, 0.75, 0.75]))
        for i, c in enumerate(entries.ravel()):
            one, one_pdf = values(load(**plain, transform=f"1 {c} 0 0.8", sampler=bsdf.material.plan.sampler.decode().split(":")[0]),
                                  wo[:, i:i + 1], wi[:, i:i + 1])
            self.agree(f[:, i], one[:, 0], 1e-4)
            self.agree(pdf[i], one_pdf[0], 1e-4)

    def test_roughness_per_point(self):
        wo, wi = directions(2, 22), directions(2, 23)
        alphas = np.array([[[0.1], [0.5]]], dtype=np.float32)
        f, _ = values(load(ndf="ggx", sampler="visible", alpha={"type": "bitmap", "data": mi.TensorXf(alphas), "raw": True, "filter_type": "nearest"}),
                      wo, wi, uv=([0.25, 0.75], [0.5, 0.5]))
        for i, alpha in enumerate(alphas.ravel()):
            self.agree(f[:, i], values(load(ndf="ggx", alpha=float(alpha)), wo[:, i:i + 1], wi[:, i:i + 1])[0][:, 0], 1e-4)

    def test_a_color_per_point_of_another_plugin(self):
        wo, wi = directions(2, 14), directions(2, 15)
        colors = np.array([[[0.1, 0.2, 0.3], [0.9, 0.5, 0.7]]], dtype=np.float32)
        bsdf = load(material="template.lambert", reflectance={"type": "bitmap", "data": mi.TensorXf(colors), "raw": True, "filter_type": "nearest"})
        f, _ = values(bsdf, wo, wi, uv=([0.25, 0.75], [0.5, 0.5]))
        self.agree(f, colors[0].T / np.pi * wi[2], 1e-5)

    def test_map_per_point_from_a_mesh_attribute(self):
        """One triangle whose vertices have M; seen from above, the image is that of the constant M."""
        sensor = {"type": "perspective", "to_world": mi.ScalarTransform4f().look_at([0, -2, 3], [0, 0, 0], [0, 1, 0]),
                  "film": {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}}}
        mesh = mi.Mesh("sheet", 3, 1, has_vertex_texcoords=True)
        mesh.add_attribute("vertex_c", 1, [1.5, 1.5, 1.5])
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"], parameters["faces"] = [-9, -9, 0, 9, -9, 0, 0, 9, 0], [0, 1, 2]
        parameters["vertex_texcoords"] = [0, 0, 1, 0, 0.5, 1]
        parameters.update()
        plain = {**SKEW, "sampler": "visible"}
        del plain["transform"]
        images = []
        with tempfile.TemporaryDirectory() as folder:
            mesh.write_ply(str(pathlib.Path(folder, "sheet.ply")))
            for how in ({"transform": "1 1.5 0 1"}, {"transform_1": {"type": "mesh_attribute", "name": "vertex_c"}}, {"transform": "1 0 0 1"}):
                scene = mi.load_dict({"type": "scene", "sensor": sensor, "integrator": {"type": "path", "max_depth": 2},
                                      "light": {"type": "point", "position": [1, 1, 2], "intensity": 9.0},
                                      "sheet": {"type": "ply", "filename": str(pathlib.Path(folder, "sheet.ply")), "bsdf": {"type": "musurf", **plain, **how}}})
                with musurf_mitsuba.evaluated():
                    images.append(np.array(mi.render(scene, spp=4, seed=1)))
        self.assertLess(np.max(np.abs(images[0] - images[1])), 1e-4 * images[0].max())
        self.assertGreater(np.max(np.abs(images[0] - images[2])), 0.1 * images[0].max())

    def test_edits(self):
        wo, wi = directions(100, 16), directions(100, 17)
        bsdf = load(**SKEW)
        parameters = mi.traverse(bsdf)
        self.assertEqual(np.array(parameters["transform"]).tolist(), [1, 2, 0, 1])
        parameters["transform"], parameters["gamma"] = mi.Float([2, 0, 0, 1]), mi.Float(4)
        parameters.update()
        wanted = values(load(**{**SKEW, "gamma": 4.0, "transform": "2 0 0 1"}), wo, wi)
        self.assertTrue(np.all(values(bsdf, wo, wi)[0] == wanted[0]))
        parameters["alpha"] = mi.Float(-1)
        with self.assertRaisesRegex(RuntimeError, "alpha: -1 is out of range.*the material stays as it was"):
            parameters.update()
        self.assertTrue(np.all(values(bsdf, wo, wi)[0] == wanted[0]))
        self.assertAlmostEqual(float(mi.traverse(bsdf)["alpha"][0]), 0.3, places=6)

    def test_edits_of_textures(self):
        wo, wi = directions(1, 18), directions(1, 19)
        bitmap = {"type": "bitmap", "data": mi.TensorXf(np.full((2, 2, 1), 0.5, np.float32) + np.eye(2, dtype=np.float32)[:, :, None]), "raw": True}
        bsdf = load(transform_0=bitmap)
        before = values(bsdf, wo, wi)[0]
        parameters = mi.traverse(bsdf)
        parameters["transform_0.data"] = mi.TensorXf(np.full((2, 2, 1), 3, np.float32))
        parameters.update()
        self.assertTrue(np.all(values(bsdf, wo, wi)[0] != before))
        self.agree(values(bsdf, wo, wi)[0], values(load(transform="3 0 0 1"), wo, wi)[0], 1e-4)

    def test_flags_and_two_sides(self):
        f = mi.BSDFFlags
        opaque, glass = load(alpha=0.3), load(alpha=0.3, transform="2 0 0 1", fresnel="dielectric", transmission=True)
        self.assertEqual(opaque.m_flags & int(f.BackSide | f.Anisotropic | f.Transmission), 0)
        self.assertTrue(opaque.m_flags & int(f.GlossyReflection) and opaque.m_flags & int(f.FrontSide))
        for flag in (f.GlossyTransmission, f.GlossyReflection, f.FrontSide, f.BackSide, f.Anisotropic, f.NonSymmetric):
            self.assertTrue(glass.m_flags & int(flag), flag)
        wo, wi = directions(50, 20), directions(50, 21)
        both = mi.load_dict({"type": "twosided", "inner": {"type": "musurf", **SKEW}})
        above = values(load(**SKEW), wo, wi)[0]
        self.assertTrue(np.all(values(both, wo, wi)[0] == above))
        flipped = np.array([[1], [1], [-1]], dtype=np.float32)
        self.assertTrue(np.all(values(both, wo * flipped, wi * flipped)[0] == above))
        self.assertTrue(np.all(values(load(**SKEW), wo * flipped, wi * flipped)[0] == 0))


class Installed(unittest.TestCase):
    def test_finds_its_shared_objects(self):
        """From a staged installation, with nothing said about where plugins are."""
        with tempfile.TemporaryDirectory() as stage:
            subprocess.run(["make", "install", f"BUILD={mitsuba_host.BUILD}", f"DESTDIR={stage}", "PREFIX=/usr"], cwd=mitsuba_host.ROOT, check=True,
                           capture_output=True)
            program = ("import mitsuba as mi; mi.set_variant('llvm_ad_rgb'); import musurf_mitsuba; "
                       "print(musurf_mitsuba.__file__, mi.load_dict({'type': 'musurf', 'alpha': 0.2}))")
            env = {k: v for k, v in os.environ.items() if k != "MUSURF_PLUGIN_PATH"}
            done = subprocess.run([sys.executable, "-c", program], env=dict(env, PYTHONPATH=f"{stage}/usr/lib/musurf/mitsuba"), cwd=stage,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue(done.stdout.startswith(stage) and "musurf.microfacet: ggx" in done.stdout, done.stdout)


if __name__ == "__main__":
    sys.exit(unittest.main())
