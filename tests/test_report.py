#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The report: self-contained, tells what the EXR headers say, and leaves an older page whole when an input is broken."""
import base64
import html.parser
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
PNG = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==")


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


# hand-written from the OpenEXR file layout
HEADER = b"v/1\x01" + struct.pack("<i", 2) + b"".join([
    attribute("dataWindow", "box2i", struct.pack("<4i", 0, 0, 639, 359)), attribute("samples", "int", struct.pack("<i", 77)),
    attribute("seconds", "double", struct.pack("<d", 12.25)), attribute("noise", "double", struct.pack("<d", 0.0321)),
    attribute("channels", "chlist", b"\0"), attribute("seed", "string", b"5")]) + b"\0"


class Page(html.parser.HTMLParser):
    """Open tags must close, and nothing may be fetched."""

    VOID = {"meta", "img", "link", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.fetched, self.pictures, self.text = [], [], 0, text
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.pictures += tag == "img"
        source = values.get("src") or values.get("href") or ""
        if source and not source.startswith(("data:", "#")):
            self.fetched.append(source)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open.pop() != tag:
            raise AssertionError(f"</{tag}> closes another element")


class Report(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        (self.path / "a.png").write_bytes(PNG)
        (self.path / "a.exr").write_bytes(HEADER)
        (self.path / "plates.json").write_text(json.dumps({"plates": [
            {"name": "a", "png": "a.png", "exr": "a.exr", "caption": "T(u) < 5×", "command": "musurf render & more"}]}))
        (self.path / "validate.json").write_text(json.dumps({"verdict": "agrees", "povray": "POV-Ray 3.7"}))
        (self.path / "fragment.html").write_text("<h2>Cross-check</h2>")
        self.output = self.path / "out" / "index.html"

    def run_report(self, *arguments):
        return subprocess.run([sys.executable, str(ROOT / "scripts" / "report"), *arguments, "-o", str(self.output)],
                              capture_output=True, text=True, env=dict(os.environ, BUILD=str(self.path)))

    def test_page(self):
        done = self.run_report("--plates", str(self.path), "--validate", str(self.path))
        self.assertEqual((done.returncode, done.stdout), (0, f"{self.output}\n"), done.stderr)
        page = Page(self.output.read_text())
        self.assertEqual((page.open, page.fetched, page.pictures), (["html"][:0], [], 1))
        for fact in ("640 × 360", ">77<", ">12.2<", "3.21%", "T(u) &lt; 5×", "musurf render &amp; more", "Cross-check: agrees",
                     "POV-Ray 3.7"):
            self.assertIn(fact, page.text)

    def test_curves_and_data(self):
        curves, study, data = self.path / "curves", self.path / "efficiency", self.path / "out" / "report.json"
        curves.mkdir(), study.mkdir()
        points = [{"x": 10 ** k, "y": 10.0 ** -k, "label": f"h {k}"} for k in range(4)]
        for name in ("2-b", "1-a"):  # any file of this form is shown, in the order of names
            (curves / f"{name}.json").write_text(json.dumps({
                "title": f"Table <{name}>", "text": "why", "command": "bench & more", "x": {"label": "seconds", "log": True},
                "y": {"label": "error", "log": True}, "series": [{"name": "rule", "line": True, "points": points}]}))
        (study / "efficiency.json").write_text('{"goal": 0.75}')
        (study / "fragment.html").write_text("<h2>Study</h2>")
        done = self.run_report("--plates", str(self.path), "--curves", str(curves), "--efficiency", str(study), "--json", str(data))
        self.assertEqual(done.returncode, 0, done.stderr)
        page, told = Page(self.output.read_text()), json.loads(data.read_text())
        self.assertEqual((page.open, page.fetched, page.pictures), ([], [], 3))
        for fact in ("Table &lt;1-a&gt;", "bench &amp; more", "<td>h 3</td><td>1000</td><td>0.001</td>", "<h2>Study</h2>"):
            self.assertIn(fact, page.text)
        self.assertLess(page.text.index("Table &lt;1-a&gt;"), page.text.index("Table &lt;2-b&gt;"))
        self.assertEqual([c["title"] for c in told["curves"]], ["Table <1-a>", "Table <2-b>"])
        self.assertEqual(told["efficiency"]["goal"], 0.75)
        self.assertEqual(told["plates"][0]["header"]["samples"], 77)
        self.assertIn("machine", told["versions"])
        (curves / "3-c.json").write_text('{"title": "no points"}')
        done = self.run_report("--curves", str(curves))
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^report: [^\n]*not what it should be[^\n]*\n$")

    def test_mutants_and_stability_are_told_or_how_to_make_them(self):
        mutants, stability, data = self.path / "mutants.json", self.path / "stability", self.path / "report.json"
        words = ("--mutants", str(mutants), "--stability", str(stability), "--json", str(data))
        done = self.run_report(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.output.read_text()
        self.assertIn("make test ONLY=mutants", page)
        self.assertIn("make stability", page)
        self.assertEqual([json.loads(data.read_text())[key] for key in ("mutants", "stability")], [None, None])
        lives = {"mutant": 2, "what": "M < N", "as_it_should_be": False, "fast": False, "slow": False}
        mutants.write_text(json.dumps({"checks": ["fast", "slow"], "mutants": [
            {"mutant": 0, "what": "none", "as_it_should_be": True, "fast": False, "slow": False},
            {"mutant": 1, "what": "det", "as_it_should_be": True, "fast": True, "slow": None}, lives]}))
        stability.mkdir()
        row = {"values": 7, "median": 0, "p99": 1e-9, "worst": 2.5e-8, "excess_worst": 0, "of_allowed": 0.25, "where": "3:ggx"}
        (stability / "stability.json").write_text(json.dumps({"points": 9, "failures": ["F & G"], "summary": {"double": {"D": row}}, "records": [1]}))
        done = self.run_report(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.output.read_text()
        self.assertIn("1 of 2 wrong versions of the core are rejected", page)
        self.assertIn("<tr class=fails><td>2</td><td>M &lt; N</td>", page)
        self.assertRegex(page, "9 materials and directions[^<]* 1 failures.*2.5e-08.*3:ggx.*F &amp; G")
        self.assertNotIn("records", json.loads(data.read_text())["stability"])

    def test_a_failed_part_is_told_and_loses_no_other(self):
        """No musurf in this build folder: the gallery cannot be made. What an earlier run left of it is not shown as this one's."""
        for name, values in (("gallery", {"surfaces": []}), ("validate", None), ("efficiency", {
                "figure9": [], "goal": 0.75, "averages": {"bsdf": {"mixed": {"samples": 1}, "auto": {"samples": 0.7}}}})):
            (self.path / name).mkdir()
            (self.path / name / "fragment.html").write_text(f"<h2>Part {name}</h2>")
            if values is not None:
                (self.path / name / f"{name}.json").write_text(json.dumps(values))
        rows = [{"check": "masking", "different": d, "total": 1000, "verdict": "agrees"} for d in (0, 3)]
        rows += [{"check": "control", "verdict": "FAILS"}, {"check": "G1 per slope", "verdict": "agrees"}, {"check": "G2 / (G1 G1)", "verdict": "differs as Smith is known to"}]
        (self.path / "validate" / "validate.json").write_text(json.dumps({"verdict": "FAILS", "checks": rows}))
        os.utime(self.path / "gallery" / "gallery.json", (1e9, 1e9))
        for file in (self.path / "validate").iterdir():
            os.utime(file, (1.2e9, 1.2e9))
        data = self.path / "out" / "report.json"
        done = self.run_report("--all", "--quick", "--part", "gallery", "--json", str(data))
        self.assertEqual((done.returncode, done.stdout), (1, f"{self.output}\n"), done.stderr)
        page, told = Page(self.output.read_text()), json.loads(data.read_text())
        self.assertEqual((page.open, page.fetched), ([], []))
        self.assertEqual([(p["name"], p["fresh"]) for p in told["parts"]], [("gallery", False)])
        self.assertNotEqual(told["parts"][0]["code"], 0)
        for fact in ("Parts that failed: gallery", "Part validate", "Part efficiency", 'id="geometry">', "This part is missing"):
            self.assertIn(fact, page.text)
        self.assertNotIn("Part gallery", page.text)
        self.assertIn("Left by an earlier run, 2008-01-1", page.text)  # 1.2e9 seconds: January 10, 21:20 UTC
        for c in told["claims"]:
            if c["verdict"] != "not measured in this run":
                c["number"], earlier, _ = c["number"].partition(" (earlier run, ")
                self.assertTrue(earlier, c)
        said = {c["claim"].partition(".")[0]: (c["number"], c["verdict"]) for c in told["claims"]}
        self.assertEqual(said["Masking is invariant under linear maps of the microsurface"], ("3 of 2000 bits differ; the most in one comparison 3.0e-03", "agrees"))
        self.assertEqual(said["The cross-check would notice if it were not"][1], "FAILS")
        self.assertEqual([v for k, v in said.items() if k.startswith("Smith")], [("1 comparisons agree, 1 differ as known, 0 fail", "differs as known")])
        self.assertEqual([v for k, v in said.items() if k.startswith("Sampling visible")], [("auto needs 0.700 of the samples of mixed (goal 0.75)", "agrees")])
        self.assertEqual(said["Explicit surfaces follow the laws of their slopes"], ("", "not measured in this run"))  # an older run's is no number of this one
        missing = [c["section"] for c in told["claims"] if c["verdict"] == "not measured in this run"]
        self.assertLess({"gallery", "costs", "geometry", "curves", "mutants", "stability"}, {*missing, "more"})

    def test_points_say_what_they_took_and_fits_are_drawn(self):
        sys.path.insert(0, str(ROOT / "scripts"))
        from reporting import curves
        points = [{"x": x, "y": 2 / x, "label": f"N {x}", "y_error": 0.1 / x, "seconds": x, "cpu_seconds": x / 2, "megabytes": 12.5} for x in (1, 2, 4)]
        curve = {"title": "t", "x": {"label": "s", "log": True}, "y": {"label": "e", "log": True},
                 "series": [{"name": "a<b", "points": points, "fit": {"slope": -1.0, "error": None, "factor": 2.0}}]}
        self.assertIn("<td>a&lt;b</td><td>N 2</td><td>2</td><td>1 ± 0.05</td><td>2</td><td>1</td><td>12.5</td>", curves.table(curve))
        plain = dict(curve, series=[{key: value for key, value in curve["series"][0].items() if key != "fit"}])
        self.assertNotEqual(curves.picture(curve), curves.picture(plain))

    def test_points_that_share_labels_stand_in_one_column(self):
        sys.path.insert(0, str(ROOT / "scripts"))
        from reporting import curves
        point = lambda x, y, label: {"x": x, "y": y, "label": label}  # noqa: E731
        curve = {"x": {"label": "ns"}, "y": {"label": "error"}, "series": [
            {"name": "a", "points": [point(12345.6, 0.5, "4"), point(2, 0.25, "8")]}, {"name": "b", "points": [point(3, 0.125, "8")]}]}
        table = curves.table(curve)
        self.assertIn("<th>4</th><th>8</th>", table)
        self.assertIn("<td>a</td><td>0.5<br><span class=faint>12346</span></td><td>0.25<br><span class=faint>2</span></td>", table)
        self.assertIn("<td>b</td><td>–</td><td>0.125<br>", table)

    def test_broken_inputs_leave_the_old_page(self):
        self.output.parent.mkdir()
        self.output.write_text("old")
        for spoil, word in ((lambda: (self.path / "a.exr").write_bytes(HEADER[:-20]), "header ends too early"),
                            (lambda: (self.path / "a.exr").write_bytes(b"PNG"), "not an EXR file"),
                            (lambda: (self.path / "plates.json").write_text("{"), "not what it should be"),
                            (lambda: (self.path / "plates.json").write_text('{"plates": [{"name": "b", "png": "b.png"}]}'), "b.png")):
            spoil()
            done = self.run_report("--plates", str(self.path))
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertRegex(done.stderr, f"^report: [^\n]*{word}[^\n]*\n$")
            self.assertEqual(self.output.read_text(), "old")


if __name__ == "__main__":
    unittest.main()
