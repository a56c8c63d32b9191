# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs the cross-check from the command line to the files it leaves."""
import base64
import html
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from . import experiment, options as command_line, pictures, povray, predict, steps as progress, tables, verdicts

CAPTIONS = {"surfaces.png": "A corner of the surface and of its images from above, each in its own space, lit from Mv: light that goes "
                            "with M leaves the same facets dark.",
            "masking.png": "What the three views see (red, green, blue), in the coordinates of the original; below, "
                           "the facets whose bits differ. The last column is lit from v instead of Mv: there it must differ.",
            "g1.png": "G1: POV-Ray against the core.",
            "normals.png": "Normals of the transformed facets against the core's D under M (Eq. 22)."}


def write(path, text):
    """Beside, then renamed."""
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(text)
    fresh.replace(path)


def povray_version(program):
    done = subprocess.run([program, "--version"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return next((x for x in (done.stdout + done.stderr).splitlines() if x.startswith("POV-Ray")), "POV-Ray").strip()


def fragment(result, folder):
    """What the report takes over: verdict, pictures inside, tables, steps."""
    parts = ["<h2>Cross-check against POV-Ray</h2>", f"<p>{html.escape(result['summary'])}</p>",
             f"<p><code>{html.escape(result['command'])}</code> · {html.escape(result['povray'])}</p>"]
    for name, caption in CAPTIONS.items():
        data = base64.b64encode((folder / name).read_bytes()).decode()
        parts.append(f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}">'
                     f"<figcaption>{html.escape(caption)}</figcaption></figure>")
    return "\n".join([*parts, tables.sections(result["checks"]), tables.steps(result["steps"])]) + "\n"


def judge(setup, measured, core, steps):
    rows = verdicts.masking(setup, measured) + verdicts.control(setup, measured)
    with steps.step("G1, sigma and G2 against the core"):
        rows += verdicts.projected(setup, measured, core)
        rows += verdicts.bins(setup, measured, core) + verdicts.joint(setup, measured, core)
    with steps.step("normals against the core's D"):
        found, shares = verdicts.distribution(setup, measured, core)
    return rows + found, shares


def run(options, build, command):
    start = time.monotonic()
    program, core = povray.find(), predict.Core(build / "musurf", options.plugin_path)
    setup = experiment.Setup(alpha=options.alpha, size=options.size, correlation=8.0, seed=options.seed,
                             realisations=options.surfaces, views=options.views, maps=options.maps, threads=options.threads)
    core.masking(setup.alpha, setup.maps["identity"], setup.views)  # a core that cannot answer is found before the work
    folder = pathlib.Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    steps = progress.Steps(experiment.work(setup))
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="povray.", dir=folder))
    try:
        measured = experiment.run(setup, scratch, steps)
    except povray.PovrayError as error:
        raise povray.PovrayError(f"{error} (kept in {scratch})") from None
    except BaseException:
        shutil.rmtree(scratch, ignore_errors=True)
        raise
    shutil.rmtree(scratch)
    rows, shares = judge(setup, measured, core, steps)
    steps.finish()
    with steps.step("pictures"):
        pictures.surfaces(setup, measured, folder / "surfaces.png")
        pictures.masks(setup, measured, folder / "masking.png")
        pictures.masking_functions(setup, rows, folder / "g1.png")
        pictures.distributions(shares, folder / "normals.png")
    failed = sum(r["verdict"] == verdicts.FAILS for r in rows)
    known = sum(r["verdict"] == verdicts.KNOWN for r in rows)
    seconds = time.monotonic() - start
    summary = (f"{len(rows) - failed - known} comparisons agree, {known} differ as Smith's model is known to, "
               f"{failed} fail; {seconds:.0f} s")
    result = {"verdict": "FAILS" if failed else "agrees", "summary": summary, "command": command,
              "povray": povray_version(program), "alpha": setup.alpha, "size": setup.size, "seed": setup.seed,
              "correlation": setup.correlation, "surfaces": setup.realisations, "surfaces_of_normals": experiment.PLAIN,
              "views": [v.tolist() for v in setup.views], "maps": {k: m.tolist() for k, m in setup.maps.items()},
              "seconds": seconds, "steps": steps.list, "checks": rows}
    write(folder / "fragment.html", fragment(result, folder))
    write(folder / "validate.json", tables.dumps(result))
    return result


def main(arguments, build):
    options = command_line.parse(arguments, str(build))
    try:
        result = run(options, build, "scripts/validate " + " ".join(arguments))
    except (povray.PovrayError, predict.PredictionError, OSError) as error:
        print(f"validate: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("validate: interrupted", file=sys.stderr)
        return 130
    if options.json:
        print(tables.dumps(result), end="")
    else:
        print("\n".join([*tables.lines(result["checks"]), f"{result['verdict']}: {result['summary']}"]))
    return 1 if result["verdict"] == "FAILS" else 0
