# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The cross-check as a command: plan, surfaces, POV-Ray, comparison, verdicts, pictures, report fragment."""
import base64
import html
import pathlib
import shutil
import sys

from . import options as command_line
from . import plan, povray, predict, run as running, scene, statistics, steps as progress, store, surfaces, tables, verdicts

CAPTIONS = {"surfaces.png": "One surface under each M. Above: from above, lit from Mv (second view), M baked into the vertices. "
                            "Below, in the original's coordinates: visible from the three views (red, green, blue); crosses where a bit differs.",
            "g1.png": "G1 per slope along the view by POV-Ray, one standard error, against Smith.",
            "normals.png": "Normals of the transformed facets against the core's D under M (Eq. 22).",
            "deviations.png": "Deviations from the core with 99 % intervals. Green: agrees; orange: differs as Smith is known to; red: fails."}


def fragment(result, folder, timing):
    """What the report takes over: verdict, pictures inside, tables, times."""
    parts = ["<h2>Cross-check against POV-Ray</h2>", f"<p>{html.escape(result['summary'])}</p>",
             f"<p><code>{html.escape(result['command'])}</code> · {html.escape(result['povray'])}</p>"]
    parts += [f"<p>Not checked: {html.escape(name)}, {html.escape(why)}</p>" for name, why in result["left_out"].items()]
    for name, caption in CAPTIONS.items():
        data = base64.b64encode((folder / name).read_bytes()).decode()
        parts.append(f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}">'
                     f"<figcaption>{html.escape(caption)}</figcaption></figure>")
    times = "; ".join(f"{t['step']} {t['seconds']:.1f} s" for t in timing)
    return "\n".join([*parts, tables.sections(result["checks"]), f"<p>{html.escape(times)}</p>"]) + "\n"


def planned(options, core):
    """The plan, and {material that is left out: why}."""
    how = plan.Plan("full" if options.full else "quick", options.seed, options.size)
    left = {}
    if options.heightfield:
        how.replace([surfaces.Given(core, options.heightfield, options.reading)])
    elif options.scene:
        found, left = scene.materials(options.scene, how.size, options.seed * 1000)
        how.replace(found)
    return how.only(options.transform, options.view), left


def check(options, build, command):
    version, folder = povray.version(), pathlib.Path(options.output)
    fresh = not folder.exists()
    try:
        core = predict.Core(build / "musurf", store.Store(folder / "store"), options.plugin_path)
        how, left = planned(options, core)
    except BaseException:
        if fresh:
            shutil.rmtree(folder, ignore_errors=True)
        raise
    steps = progress.Steps()
    with running.alone(folder) as scratch:
        one = running.Run(how, core, version, scratch, steps, options.threads)
        rows, shares = measured(one, steps, scratch)
        with steps.step("pictures"):
            from . import pictures  # matplotlib is slow to load, and a wrong option is told without it
            pictures.surfaces(one, folder / "surfaces.png")
            pictures.per_slope(rows, folder / "g1.png")
            pictures.distributions(shares, folder / "normals.png")
            pictures.deviations(rows, folder / "deviations.png")
        return written(rows, left, how, version, folder, steps, command)


def measured(one, steps, scratch):
    """Judged rows, and shares of normals. A scene that POV-Ray failed on is kept."""
    try:
        with steps.step("making surfaces"):
            one.make_surfaces()
            one.enumerate()
        with steps.step("measuring"):
            one.measure()
    except povray.PovrayError as error:
        raise povray.PovrayError(f"{error} (kept in {scratch} until the next run)") from None
    except BaseException:
        shutil.rmtree(scratch, ignore_errors=True)
        raise
    shutil.rmtree(scratch)
    with steps.step("comparing"):
        rows, shares = one.compare()
    return verdicts.judge(rows), shares


def written(rows, left, how, version, folder, steps, command):
    """The result, also as files. Times have a file of their own: the result is the same for every run."""
    count = {v: sum(r["verdict"] == v for r in rows) for v in (verdicts.AGREES, verdicts.KNOWN, verdicts.FAILS)}
    result = {"verdict": "FAILS" if count[verdicts.FAILS] else "agrees",
              "summary": f"{count[verdicts.AGREES]} comparisons agree, {count[verdicts.KNOWN]} differ as Smith's model is known to, "
                         f"{count[verdicts.FAILS]} fail", "command": command, "povray": version, "size": how.size, "seed": how.seed,
              "significance": statistics.FAMILY, "left_out": left,
              "surfaces": {s.name: {"material": s.material() if not s.file else str(s.file), "alpha": s.alpha, "map": s.base.tolist(),
                                    **({"read": s.read} if s.file else {})}
                           for s in how.surfaces},
              "realisations": {"looked at": how.seen, "normals": how.plain, "reflecting": how.mirrors},
              "looks": {name: [v.tolist() for v in views] for name, views, _ in how.looks},
              "maps": {k: m.tolist() for k, m in how.maps.items()}, "checks": rows}
    store.write(folder / "fragment.html", fragment(result, folder, steps.list))
    store.write(folder / "times.json", tables.dumps(steps.list))
    store.write(folder / "validate.json", tables.dumps(result))
    return result


def main(arguments, build):
    options = command_line.parse(arguments, str(build))
    try:
        result = check(options, pathlib.Path(build), "scripts/validate " + " ".join(arguments))
    except (povray.PovrayError, predict.PredictionError, surfaces.SurfaceError, scene.SceneError, OSError) as error:
        print(f"validate: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("validate: interrupted; started again, it goes on from here", file=sys.stderr)
        return 130
    if options.json:
        print(tables.dumps(result), end="")
    else:
        print("\n".join([*tables.lines(result["checks"]), *(f"not checked: {k}: {v}" for k, v in result["left_out"].items()),
                         f"{result['verdict']}: {result['summary']}"]))
    return 1 if result["verdict"] == "FAILS" else 0
