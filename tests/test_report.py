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
