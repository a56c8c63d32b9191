# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Writes measured tables into the README that has their two markers: the project's, or a room's."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def page_of(name):
    """The one file with <!-- name: begin -->."""
    pages = [page for page in (ROOT / "README.md", *sorted(ROOT.glob("core/*/README.md"))) if f"<!-- {name}: begin -->\n" in page.read_text()]
    if len(pages) != 1:
        raise ValueError(f"{len(pages)} pages have a place for the table {name}")
    return pages[0]


def write(name, block):
    """Between <!-- name: begin --> and <!-- name: end -->. Links in the block are from the top of the tree."""
    page, begin, end = page_of(name), f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    if page.parent != ROOT:
        block = re.sub(r"\]\((?!https?:)", "](../../", block)
    head, rest = page.read_text().split(begin)
    temporary = page.with_suffix(".new")
    temporary.write_text(head + begin + block + end + rest.split(end)[1])
    temporary.replace(page)
