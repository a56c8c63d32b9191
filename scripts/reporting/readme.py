# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Writes measured tables into README.md, each between its two markers."""
import pathlib

README = pathlib.Path(__file__).resolve().parent.parent.parent / "README.md"


def write(name, block):
    """Between <!-- name: begin --> and <!-- name: end -->."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    head, rest = README.read_text().split(begin)
    temporary = README.with_suffix(".new")
    temporary.write_text(head + begin + block + end + rest.split(end)[1])
    temporary.replace(README)
