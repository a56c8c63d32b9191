# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The kill matrix: which check rejects which wrong version of the core (tests/test_mutants.py)."""
import html
import json

HOW = "make test ONLY=mutants"
WORDS = {True: "killed", False: "passes", None: ""}


def load(path):
    found = json.loads(path.read_text())
    if not found["mutants"] or not found["checks"]:
        raise ValueError(f"{path} holds no mutant")
    return found


def section(found):
    head = '<h2 id="mutants">The tests, tested</h2>'
    if not found:
        return f"{head}<p>Not measured yet: <code>{HOW}</code> makes the matrix of mutants and the checks that reject them.</p>"
    wrong, rows = [m for m in found["mutants"] if m["mutant"]], []
    for m in found["mutants"]:
        cells = "".join(f'<td class="{WORDS[m[check]]}">{WORDS[m[check]]}</td>' for check in found["checks"])
        rows.append(f'<tr{"" if m["as_it_should_be"] else " class=fails"}><td>{m["mutant"] or ""}</td><td>{html.escape(m["what"])}</td>{cells}</tr>')
    killed = sum(any(m[check] for check in found["checks"]) for m in wrong)
    return (f"{head}<p>{killed} of {len(wrong)} wrong versions of the core are rejected, each by the first check that sees it, from the fastest to the "
            f"slowest; the right core must pass them all. <code>{HOW}</code></p><table><thead><tr><th></th><th>mutant</th>"
            + "".join(f"<th>{html.escape(check)}</th>" for check in found["checks"]) + f"</tr></thead><tbody>{''.join(rows)}</tbody></table>")
