#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The command line as a contract: help, usage errors, exit codes, output that cannot be written, plugins that cannot be
used, and `musurf info`."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from command import BUILD, MUSURF, ROOT, musurf, strict

LINE = b'{"material": {"material": "musurf.microfacet"}, "wo": [0, 0, 1]}\n'


def commands():
    return re.findall(r"^  (\w+)  +\S", musurf("--help").out.split("commands:")[1].split("\n\n")[0], re.M)


class Usage(unittest.TestCase):
    def test_help_is_complete(self):
        done = musurf("--help")
        self.assertEqual((done.returncode, done.err), (0, ""))
        self.assertGreaterEqual(set(commands()), {"eval", "sample", "info"})
        for command in commands():
            done = musurf(command, "--help")
            self.assertEqual((done.returncode, done.err), (0, ""), command)
            self.assertIn(f"usage: musurf {command}", done.out)

    def test_every_command_in_the_source_is_listed(self):
        declared = re.findall(r"int mu_command_(\w+)\(", (ROOT / "core/render/command.h").read_text())
        defined = {name for name in declared for file in (ROOT / "core/render").glob("*.c")
                   if re.search(rf"^int mu_command_{name}\(", file.read_text(), re.M)}
        self.assertEqual(set(commands()), defined)

    def test_version(self):
        done = musurf("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.out, r"^musurf \d+\.\d+\.\d+\n$")

    def test_mistakes_are_refused_with_one_line(self):
        for arguments, words in [
            (["evla"], 'no command "evla"; did you mean "eval"?'),
            (["frobnicate"], 'no command "frobnicate"; see musurf --help'),
            (["eval", "--precison", "float"], "no option --precison; did you mean --precision?"),
            (["eval", "--precision", "half"], '--precision is "half"'),
            (["eval", "--precision"], "--precision needs a value: float|double"),
            (["eval", "a", "b"], '"b" is a second'),
            (["eval", "/nonexistent/file"], "/nonexistent/file: cannot be opened: No such file"),
            (["eval", "/"], "Is a directory"),
            (["sample", "--n", "-1"], '--n is "-1"; a whole number from 0'),
            (["sample", "--n", "1.5"], '--n is "1.5"'),
            (["sample", "--seed", "18446744073709551616"], "--seed is"),
            (["info", "--json", "--schema"], "exclude each other"),
            (["info", "musurf.velvet"], '"musurf.velvet" is not in'),
        ]:
            done = musurf(*arguments, stdin=LINE)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertEqual(done.err.count("\n"), 1, done.err)
            self.assertIn(words, done.err)
            self.assertTrue(done.err.startswith("musurf"), done.err)
        self.assertEqual(musurf().returncode, 2)


class Output(unittest.TestCase):
    """A result that was not written is not a success."""

    def test_full_disk(self):
        for arguments in (["eval"], ["sample"], ["info"], ["--help"], ["eval", "--help"], ["--version"],
                          ["check", "--quick", "--n", "1"], ["render", ROOT / "scenes/first.json", "--explain"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([MUSURF, *arguments], input=LINE, stdout=full, stderr=subprocess.PIPE, timeout=60)
            self.assertEqual(done.returncode, 1, arguments)
            self.assertIn(b"standard output: No space left on device", done.stderr)
            self.assertEqual(done.stderr.count(b"\n"), 1)

    def test_reader_that_goes_away(self):
        for command, stdin in (("eval", LINE * 20000), ("sample", LINE)):
            with tempfile.TemporaryFile() as file:
                file.write(stdin)
                file.seek(0)
                arguments = [MUSURF, command] + (["--n", "100000"] if command == "sample" else [])
                child = subprocess.Popen(arguments, stdin=file, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                child.stdout.readline()
                child.stdout.close()
                message = child.stderr.read()
                child.stderr.close()
                self.assertEqual(child.wait(timeout=60), 1)
                self.assertIn(b"standard output: Broken pipe", message)

    def test_closed_files(self):
        for redirection, code in ((">&-", 1), ("<&-", 2), ("2>&-", 0)):
            done = subprocess.run(["sh", "-c", f'"$0" eval {redirection}', MUSURF], input=LINE, capture_output=True,
                                  timeout=60)
            self.assertEqual(done.returncode, code, redirection)


class Plugins(unittest.TestCase):
    """A shared object that is no plugin for this program is refused with a line, never called."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def refused(self, words):
        line = {"id": 1, "material": {"material": "bad.thing"}, "wo": [0, 0, 1]}
        done = musurf("eval", stdin=[line], env={"MUSURF_PLUGIN_PATH": f"/nonexistent::{self.folder.name}"})
        self.assertEqual(done.returncode, 1)
        self.assertIn(words, strict(done.out)["error"])
        self.assertIn("stdin:1:36: $.material.material: ", strict(done.out)["error"])

    def compiled(self, source):
        file = pathlib.Path(self.folder.name) / "bad.c"
        file.write_text('#include "plugin/musurf_plugin.h"\n' + source)
        subprocess.run([os.environ.get("CC", "cc"), "-shared", "-fPIC", f"-I{ROOT}", str(file), "-o",
                        f"{self.folder.name}/bad_material.so"], check=True, timeout=60)

    def test_none(self):
        self.refused(f"there is no plugin bad_material.so in /nonexistent, {self.folder.name}, ")

    def test_text(self):
        (pathlib.Path(self.folder.name) / "bad_material.so").write_text("hello")
        self.refused("bad_material.so: cannot be opened as a plugin: ")

    def test_another_major_version(self):
        self.compiled("const void *musurf_plugin_v2(void) { return 0; }")
        self.refused("exports no musurf_plugin_v1")

    def test_null(self):
        self.compiled("const musurf_plugin *musurf_plugin_v1(void) { return 0; }")
        self.refused("musurf_plugin_v1 returned NULL")

    def test_short_table(self):
        self.compiled("static const musurf_plugin p = {8};\nconst musurf_plugin *musurf_plugin_v1(void) { return &p; }")
        self.refused("its plugin table is 8 bytes long")

    def test_material_without_probe(self):
        line = {"material": {"material": "template.lambert"}, "wo": [0, 0, 1]}
        done = musurf("eval", stdin=[line])
        self.assertEqual(done.returncode, 1)
        self.assertIn("template.lambert does not offer musurf.probe/1", strict(done.out)["error"])


class Info(unittest.TestCase):
    def test_json_and_text_agree(self):
        for material in ("musurf.microfacet", "template.lambert"):
            done = musurf("info", "--json", material)
            self.assertEqual(done.returncode, 0, done.err)
            info = strict(done.out)
            text = musurf("info", material).out
            self.assertEqual(info["material"]["id"], material)
            self.assertEqual(info["plugin"]["file"], str(BUILD / f"{material.split('.')[0]}_material.so"))
            for parameter in info["material"]["parameters"]:
                self.assertIn(f"\n  {parameter['name']}\n      {parameter['kind']}", text)
                self.assertTrue(parameter["doc"] and parameter["label"], parameter)
            for library, version in info["build"]["libraries"].items():
                self.assertIn(f"{library} {version}", text)

    def test_what_the_microfacet_material_offers(self):
        table = {p["name"]: p for p in strict(musurf("info", "--json").out)["material"]["parameters"]}
        self.assertGreaterEqual(set(table["ndf"]["choices"]), {"ggx", "beckmann", "gtr"})
        self.assertEqual(table["transform"]["default"], [[1, 0], [0, 1]])
        self.assertTrue(table["transform"]["may_vary"])
        self.assertEqual(table["alpha"]["min"], 0)
        self.assertGreaterEqual(set(table["fresnel"]["choices"]), {"none", "schlick", "dielectric", "conductor"})

    def test_build_without_a_plugin(self):
        done = musurf("info", "nobody.thing")
        self.assertEqual(done.returncode, 2)
        self.assertIn("jansson", done.out)


class StartUp(unittest.TestCase):
    def test_no_image_library_is_linked(self):
        linked = subprocess.run(["ldd", MUSURF], capture_output=True, text=True, check=True).stdout
        self.assertNotIn("OpenImageIO", linked)

    def test_start_up_time(self):
        """Reported, not judged: the machine may be busy."""
        times = []
        for _ in range(10):
            start = time.perf_counter()
            self.assertEqual(subprocess.run([MUSURF, "eval"], input=LINE, capture_output=True).returncode, 0)
            times.append(time.perf_counter() - start)
        print(f"musurf eval, one line: {min(times) * 1e3:.1f} ms (best of {len(times)})")


if __name__ == "__main__":
    sys.exit(unittest.main())
