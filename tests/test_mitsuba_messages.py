#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What goes wrong between Mitsuba and a plugin is said in one line of Mitsuba's own log, and Mitsuba goes on: files that are missing
or are no plugins, plugins older and newer than the host, renamed parameters, materials that ask for what the host cannot feed, wrong
values, recorded loops, variants of Mitsuba that a plugin cannot serve. Plugins to that end are made from plugin/template.c."""
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import mitsuba_host

mi, musurf_mitsuba = mitsuba_host.enter()
import numpy as np  # noqa: E402

HEARD = mitsuba_host.listen(mi)
FOLDER = tempfile.TemporaryDirectory()
TEMPLATE = (mitsuba_host.ROOT / "plugin/template.c").read_text()


def plugin(name, *changes, export=True):
    """A plugin like the template, but for these changes of its source, each of which must be found there."""
    text = TEMPLATE
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    source, made = pathlib.Path(FOLDER.name, f"{name}.c"), pathlib.Path(FOLDER.name, f"{name}_material.so")
    source.write_text(text)
    script = [f"-Wl,--version-script={mitsuba_host.ROOT / 'plugin/export.map'}"] if export else []
    subprocess.run(["cc", "-std=c17", "-shared", "-fPIC", "-O1", "-w", f"-I{mitsuba_host.ROOT}", '-DMUSURF_VERSION="0"', *script, str(source),
                    "-lm", "-o", str(made)], check=True)
    return str(made)


def lambert(path, **more):
    return mi.load_dict({"type": "musurf", "material": "template.lambert", "plugin": path, **more})


class Messages(unittest.TestCase):
    def says(self, what, make):
        """`make` is refused; `what` stands in the log, in a line of its own, and in the error."""
        HEARD.clear()
        with self.assertRaises(RuntimeError) as caught:
            make()
        lines = [line for text in HEARD for line in text.splitlines() if what in line]
        self.assertTrue(lines, f"{what!r} is not in the log: {HEARD}")
        self.assertIn(what, str(caught.exception))

    def musurf(self, what, **properties):
        self.says(what, lambda: mi.load_dict({"type": "musurf", **properties}))

    def test_values(self):
        self.musurf("\"alhpa\"; did you mean \"alpha\"?", alhpa=0.2)
        self.musurf("alpha: -1 is out of range: at least 0", alpha=-1)
        self.musurf("alpha: takes 1 number, not 'rough'", alpha="rough")
        self.musurf("ndf: \"ggxx\" is not known; it may be one of: ggx,", ndf="ggxx")
        self.musurf("ndf: takes a word", ndf=3)
        self.musurf("transform: takes 4 numbers", transform="1 0 0")
        self.musurf("is singular", transform="1 1 1 1")
        self.musurf("only the upper 2 x 2 numbers", transform=mi.ScalarTransform4f().translate([1, 0, 0]))
        self.musurf("gamma: belongs to ndf \"gtr\"", gamma=1.5)
        self.musurf("histogram: is a grid of numbers, which a material file can give", histogram=1)
        self.musurf("takes numbers, a word or a texture, not a", alpha={"type": "diffuse"})
        self.musurf("fresnel_schlick: takes red, green and blue, not a spectrum", fresnel="schlick",
                    fresnel_schlick={"type": "spectrum", "value": [(400, 0.1), (700, 0.9)]})
        self.musurf("alpha: takes 1 number, not", alpha={"type": "rgb", "value": [0.1, 0.2, 0.3]})
        for key in ("material", "file", "plugin"):
            self.musurf(f"{key}: takes text, not '3'", **{key: 3})

    def test_what_the_host_cannot_feed(self):
        checkers = {"type": "checkerboard"}
        self.musurf("gamma: cannot be textured: musurf.microfacet takes it once for the whole surface; what may vary: ", ndf="gtr", gamma=checkers)
        self.musurf("musurf.microfacet: alpha: ", ndf="phong", alpha=checkers)  # may vary, but not in this material: the plugin says why
        self.musurf("transform: has 4 numbers, and a texture gives one: texture transform_0,", transform=checkers)
        HEARD.clear()
        mi.load_dict({"type": "musurf", "ndf": "discrete_ggx"})
        self.assertIn("the surface looks as from afar", "".join(HEARD))

    def test_files(self):
        self.musurf("there is no nobody_material.so in ", material="nobody.lambert")
        self.musurf("does not name a material", material="lambert")
        self.musurf("\"template.phong\" is not in", material="template.phong")
        self.musurf("nowhere.so: cannot be opened", plugin="/nowhere.so")
        self.musurf("cannot be opened: ", plugin=__file__)
        self.musurf("exports no musurf_plugin_v1", plugin=str(mitsuba_host.BUILD / "musurf_wavefront.so"))
        self.musurf("cannot be opened: No such file", file="/nowhere.json")
        broken = pathlib.Path(FOLDER.name, "broken.json")
        for text, what in (("{", "is no JSON"), ("[" * 100000, "is no JSON"),
                           ('{"material": "musurf.microfacet", "alpha": 1' + 400 * "0" + "}", "alpha: inf is not a finite number"),
                           ('{"material": "musurf.microfacet", "alpha": NaN}', "alpha: nan is not a finite number"), ('{"ndf": "ggx"}', "is no material"),
                           ('{"material": "musurf.microfacet", "alpha": [1, 2]}', "$.alpha: takes 1 number"),
                           ('{"material": "musurf.microfacet", "fresnel": {"schlik": 1}}', "$.fresnel.schlik: musurf.microfacet has no"),
                           ('{"material": "musurf.microfacet", "jacobian": {}}', "$.jacobian: is for musurf's own renderer"),
                           ('{"material": "musurf.microfacet", "normal_map": {}}', "$.normal_map: is for musurf's own renderer"),
                           ('{"material": "musurf.microfacet", "alpha": {"texture": "a.png"}}', "as \"alpha\" beside \"file\""),
                           ('{"material": "musurf.microfacet", "transform": {"attribute": "m"}}', "as \"transform_0\", \"transform_1\","),
                           ('{"material": "musurf.microfacet", "ndf": "tabulated", "histogram": {"heightfield": "h.exr"}}',
                            "$.histogram: this host reads grids with their weights")):
            broken.write_text(text)
            self.musurf(what, file=str(broken))

    def test_other_plugins(self):
        sizes = plugin("short", (".size = sizeof(musurf_material_type)", ".size = 128"))
        self.says("a material type is 128 bytes long; at least 136", lambda: lambert(sizes))
        table = plugin("table", (".size = sizeof(musurf_param)", ".size = 64"))
        self.says("a parameter of template.lambert is 64 bytes long", lambda: lambert(table))
        other = plugin("major", ("musurf_plugin_v1", "musurf_plugin_v2"), export=False)
        self.says("or one for another major version than 1", lambda: lambert(other))
        renamed = plugin("renamed", ('.name = "reflectance"', '.name = "albedo"'))
        self.says("template.lambert has no parameter \"reflectance\"; it has albedo", lambda: lambert(renamed, reflectance=0.5))
        self.assertIn("lambert", str(lambert(renamed, albedo=0.5)))
        kind = plugin("kind", (".kind = MUSURF_COLOR", ".kind = 77"))
        self.says("this host is older than the plugin and cannot set a parameter of kind 77", lambda: lambert(kind, reflectance=0.5))
        needs = plugin("needs", ("MUSURF_NEEDS_SLOTS : 0u", "MUSURF_NEEDS_SLOTS : 0x100u"))
        self.says("needs something of its host that this one does not know (bits 0x100): the plugin is newer", lambda: lambert(needs))
        large = plugin("large", (".closure_bytes = sizeof(closure)", ".closure_bytes = 100000"))
        self.says("asks for closures of 100000 bytes", lambda: lambert(large))
        silent = plugin("silent", ("*out = material;\n    return MUSURF_OK", "return MUSURF_UNSUPPORTED"))
        self.says("refused this material (result 3) without saying why", lambda: lambert(silent))
        greedy = plugin("greedy", ("material->slot + 3 : 0", "material->slot + 9 : 9"))
        self.says("reads 9 slots, and textures feed 0", lambda: lambert(greedy))

    def test_a_newer_plugin_of_the_same_major_version_works(self):
        """Records grow at the end; what this host does not know, it does not look at."""
        grown = plugin("grown",
                       ("static const musurf_material_type LAMBERT = {\n    .size = sizeof(musurf_material_type)",
                        "static const struct { musurf_material_type t; double more[4]; } LAMBERT = {.t = {\n    .size = sizeof LAMBERT"),
                       (".extension = lambert_extension,\n};", ".extension = lambert_extension,\n}, {1, 2, 3, 4}};"),
                       ("{&LAMBERT}", "{&LAMBERT.t}"))
        bsdf, si = lambert(grown, reflectance=0.5), mi.SurfaceInteraction3f()
        si.wi = mi.Vector3f(0, 0, 1)
        self.assertAlmostEqual(float(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(0, 0, 1))[0][0]), 0.5 / np.pi, delta=1e-7)

    def test_tangents_of_a_mesh_without_texture_coordinates(self):
        mesh = mi.Mesh("bare", 3, 1)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = [-9, -9, 0, 9, -9, 0, 0, 9, 0]
        parameters["faces"] = [0, 1, 2]
        parameters.update()
        path = pathlib.Path(FOLDER.name, "bare.ply")
        mesh.write_ply(str(path))
        bare = {"type": "ply", "filename": str(path)}
        for shape, transform, told in ((bare, "1 0 0 1", False), (bare, "2 0 0 1", True), ({"type": "cube"}, "2 0 0 1", False),
                                       ({"type": "rectangle"}, "2 0 0 1", False)):
            scene = mi.load_dict({"type": "scene", "integrator": {"type": "path", "max_depth": 2}, "light": {"type": "constant"},
                                  "mesh": {**shape, "bsdf": {"type": "musurf", "transform": transform}},
                                  "sensor": {"type": "perspective", "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                                             "film": {"type": "hdrfilm", "width": 4, "height": 4}}})
            HEARD.clear()
            with musurf_mitsuba.evaluated():
                self.assertGreater(np.array(mi.render(scene, spp=1)).mean(), 0.1)
            self.assertEqual("has no texture coordinates" in "".join(HEARD), told, HEARD)

    def test_recorded_loops(self):
        scene = mi.load_dict({"type": "scene", "integrator": {"type": "path"}, "light": {"type": "constant"},
                              "ball": {"type": "sphere", "bsdf": {"type": "musurf", "alpha": 0.3}},
                              "sensor": {"type": "perspective", "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                                         "film": {"type": "hdrfilm", "width": 8, "height": 8}}})
        HEARD.clear()
        with self.assertRaises(RuntimeError):
            np.array(mi.render(scene, spp=1))
        self.assertIn("Render inside `with musurf_mitsuba.evaluated():`", "".join(HEARD))
        with musurf_mitsuba.evaluated():  # and Mitsuba lives
            self.assertTrue(np.isfinite(np.array(mi.render(scene, spp=1))).all())

    def test_an_llvm_that_would_end_the_process(self):
        with unittest.mock.patch.object(musurf_mitsuba.dr.detail, "llvm_version", lambda: (14, 0, 6)):
            self.says("Dr.Jit uses LLVM 14, which cannot compile", lambda: mi.load_dict({"type": "musurf"}))
        self.assertIn("musurf.microfacet", str(mi.load_dict({"type": "musurf"})))

    def test_other_variants(self):
        for variant in ("scalar_rgb", "llvm_ad_spectral", "llvm_ad_mono"):
            mi.set_variant(variant)
            try:
                self.says(f"works in Mitsuba's variant llvm_ad_rgb, not in {variant}", lambda: mi.load_dict({"type": "musurf"}))
            finally:
                mi.set_variant("llvm_ad_rgb")
        self.assertIn("musurf.microfacet", str(mi.load_dict({"type": "musurf"})))


if __name__ == "__main__":
    sys.exit(unittest.main())
