# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What musurf claims, each claim in a line: how it is tested, the number of this very run, a verdict, and where to read on.

Numbers come from the sections' own data; a claim whose section is missing, or says nothing about it, was not measured.
"""
import html

AGREES, KNOWN, FAILS, MEASURED, MISSING = "agrees", "differs as known", "FAILS", "measured", "not measured in this run"
DEFAULT = 0.01  # compensation_error, as the README promises
CLASSES = {AGREES: "agrees", KNOWN: "known", FAILS: "fails", MEASURED: "", MISSING: "faint"}


def rows_of(data, *checks):
    found = [row for row in data["validate"]["checks"] if row["check"] in checks]
    if not found:
        raise KeyError(checks)
    return found


def verdict_of(rows):
    """Of rows of the cross-check."""
    words = {row["verdict"] for row in rows}
    return FAILS if "FAILS" in words else AGREES if words == {"agrees"} else KNOWN


def counts(rows):
    agree, fail = sum(r["verdict"] == "agrees" for r in rows), sum(r["verdict"] == "FAILS" for r in rows)
    return f"{agree} comparisons agree, {len(rows) - agree - fail} differ as known, {fail} fail"


def judged(*checks):
    return lambda data: (counts(rows_of(data, *checks)), verdict_of(rows_of(data, *checks)))


def invariance(data):
    rows = rows_of(data, "masking")
    different, total = sum(r["different"] for r in rows), sum(r["total"] for r in rows)
    worst = max(r["different"] / r["total"] for r in rows)
    return f"{different} of {total} bits differ; the most in one comparison {worst:.1e}", verdict_of(rows)


def tracers(data):
    rows = [r for r in data["costs"]["scales"] if r["tracer"] != "own"]
    names = sorted({r["tracer"] for r in rows})
    return "; ".join(f"{name}: {sum(r['different'] for r in rows if r['tracer'] == name)} of {sum(r['bits'] for r in rows if r['tracer'] == name)} bits differ" for name in names), MEASURED


def masking(data):
    curve = next(c for c in data["curves"] if c["title"].startswith("Masking: error against the time"))
    said = {s["name"].split(",")[1].strip(): max(p["y"] for p in s["points"]) for s in curve["series"] if s["name"].startswith("exact,")}
    return "largest error of G1: " + ", ".join(f"{value:.1e} in {name}" for name, value in said.items()), MEASURED


def spline(data):
    worst = max(data["efficiency"]["figure9"], key=lambda row: row["largest"])
    return f"the spline’s G1 is off by up to {worst['largest']:.3f} (α {worst['alpha']:g}, γ {worst['gamma']:g})", MEASURED


def samplers(data):
    study = data["efficiency"]
    best = min(((v["samples"], name) for name, v in study["averages"]["bsdf"].items() if name != "mixed"))
    return f"{best[1]} needs {best[0]:.3f} of the samples of mixed (goal {study['goal']:g})", AGREES if best[0] <= study["goal"] else FAILS


def compensation(data):
    rows = next(c["rows"] for c in data["curves"] if c.get("rows") and "asked" in c["rows"][0])
    with_it, without = (max(r["worst"] for r in rows if r["asked"] == asked) for asked in (DEFAULT, 0))
    return f"largest error of the furnace {with_it:.1e}; at most {DEFAULT:g}; without compensation {without:.2g}", AGREES if with_it <= DEFAULT else FAILS


def geometry(data):
    rows = [(abs(row["deviation"]), plate["name"], row) for plate in data["geometry"]["plates"] for row in plate["rows"] if row["comparison"] == "all, random walk"]
    _, name, row = max(rows, key=lambda r: r[0])
    return f"largest deviation of the plate’s mean {row['deviation']:+.2%} ± {row['error']:.2%} ({name}), FLIP {row['flip']:.3f} (noise {row['flip_of_noise']:.3f})", MEASURED


def deformed(data):
    rows = [(abs(row["deviation"]), plate["name"], row) for plate in data["deformed"]["plates"] for row in plate["rows"]]
    _, name, row = max(rows, key=lambda r: r[0])
    verdicts = [row["verdict"] for _, _, row in rows]
    told = all(any(row["verdict"] == FAILS for row in plate["as_at_rest"]) for plate in data["deformed"]["plates"])
    number = (f"largest deviation {row['deviation']:+.2%} ± {row['error']:.2%} ({name}, {row['measure']}); {verdicts.count(AGREES)} of {len(verdicts)} agree, "
              f"{verdicts.count(FAILS)} fail; the material as at rest {'fails' if told else 'does not fail'}, as it must")
    return number, FAILS if FAILS in verdicts or not told else AGREES if set(verdicts) == {AGREES} else MEASURED


def slopes(data):
    worst = max(data["gallery"]["surfaces"], key=lambda s: s["total_variation"])
    return f"total variation at most {worst['total_variation']:.4f} ({worst['name']})", MEASURED


def stability(data):
    found = data["stability"]
    count = len(found["failures"])
    return f"{found['points']} materials and directions, {count or 'no'} failures", FAILS if count else AGREES


def mutants(data):
    found, checks = data["mutants"]["mutants"], data["mutants"]["checks"]
    wrong = [m for m in found if m["mutant"]]
    killed = sum(any(m[check] for check in checks) for m in wrong)
    return f"{killed} of {len(wrong)} rejected", AGREES if all(m["as_it_should_be"] for m in found) else FAILS


def lighting(name):
    """A claim that scripts/imaging/verdicts.py judged."""
    def told(data):
        found = next(c for c in data["ibl"]["claims"] if c["name"] == name)
        return found["number"], AGREES if found["holds"] else FAILS
    return told


def costs(data):
    chosen = [r for r in data["costs"]["choices"]["rows"] if r.get("measured") is not None]
    if not chosen:
        return "no prediction was tried", MEASURED
    return "predicted and found: " + "; ".join(f"{r['tracer']} {r['predicted']:.2%}, {r['measured']:.2%}" + (f" ± {r['measured_error']:.2%}" if r["measured_error"] else "")
                                                for r in chosen), MEASURED


CLAIMS = [
    ("Masking is invariant under linear maps of the microsurface.", "Bits of visibility of explicit surfaces by POV-Ray, M baked into the vertices", "validate", invariance),
    ("The cross-check would notice if it were not.", "The same comparison lit from wrong directions must fail", "validate", judged("control")),
    ("Normals of a transformed surface follow D under M (Eq. 22).", "Facets of explicit surfaces against the core’s D", "validate", judged("D facet by facet", "D of normals", "D")),
    ("Smith’s masking and shadowing under M are what explicit surfaces show, up to what Smith is known to be off by.", "G1 and G2 per slope and view, with confidence intervals", "validate",
     judged("G1 per slope", "G1 projected mean", "G1", "visible normals", "G2 / (G1 G1)", "G2 itself", "G2")),
    ("Reflection under M, once and many times, is what explicit surfaces show, likewise.", "Light that leaves mirror and dielectric facets in POV-Ray against albedo and BRDF", "validate",
     judged("albedo, one reflection", "BRDF per bin", "energy, all reflections: compensation", "energy, all reflections: random walk", "energy conserved")),
    ("Explicit surfaces follow the laws of their slopes.", "Slopes of facets that are not fitted directly against the core’s D", "gallery", slopes),
    ("Three independent tracers see the same facets.", "Bits of the exact tracer against Embree’s and POV-Ray’s", "costs", tracers),
    ("What accuracy costs on explicit surfaces is known beforehand.", "Power laws over grid, points, realisations; predictions tried with fresh seeds", "costs", costs),
    ("A material fitted to a surface looks as the surface does.", "Plates of facets by POV-Ray beside the fitted material, several M", "geometry", geometry),
    ("A microsurface deforms with its object (Section 5.1).", "Highlights of deformed plates of facets by POV-Ray beside meshes under tension", "deformed", deformed),
    ("Lighting by the major axis costs little more than by the bent normal.", "Time of whole frames of the same run, N = 16; at most 2.5 times", "ibl", lighting("cost")),
    ("It is nearer to the truth for α_lin < 0.5, as its paper says.", "Mean FLIP against path tracing over roughness, anisotropy, environments", "ibl", lighting("seed")),
    ("Better reads halve its FLIP there at no higher cost.", "The same; the default, lobe", "ibl", lighting("half")),
    ("They are better than the bent normal above 0.5, too.", "The same", "ibl", lighting("above")),
    ("Masking of GTR is exact for every γ, not only for integers.", "G1 against the rule at half the step", "curves", masking),
    ("The paper’s approximate masking of GTR is not exact between integers.", "Figure 9: G1 by the spline of Appendix A against exact masking", "efficiency", spline),
    ("Sampling visible normals needs fewer samples than the paper’s mixed sampling.", "Noise on the torus knot of Figure 10 against a long reference", "efficiency", samplers),
    ("Compensated multiple scattering closes the furnace within 1 %.", "White furnace over distributions, α, M and views", "curves", compensation),
    ("Values are right to the last digits that their inputs determine.", "Float and double against 50-digit answers, stiff and extreme cases", "stability", stability),
    ("The tests notice wrong formulas.", "Wrong versions of the core must be rejected, the right one not", "mutants", mutants)]


def measured(data, older=()):
    """[{"claim", "tested", "section", "number", "verdict"}]; older: when sections were made that this run did not."""
    found = []
    for claim, tested, section, measure in CLAIMS:
        try:
            number, verdict = measure(data)
            number += f" (earlier run, {older[section]})" if section in older else ""
        except (KeyError, TypeError, ValueError, StopIteration, IndexError):
            number, verdict = "", MISSING
        found.append({"claim": claim, "tested": tested, "section": section, "number": number, "verdict": verdict})
    return found


def section(found):
    rows = []
    for c in found:
        link = f'<a href="#{c["section"]}">{c["verdict"]}</a>' if c["verdict"] != MISSING else MISSING
        rows.append(f'<tr class="{CLASSES[c["verdict"]]}"><td class=text>{html.escape(c["claim"])}</td><td class=text>{html.escape(c["tested"])}</td>'
                    f'<td class=text>{html.escape(c["number"])}</td><td>{link}</td></tr>')
    return ('<h2 id="claims">What is claimed, and what this run says</h2>\n<p>musurf is a library, a material plugin and a renderer for microfacet materials whose '
            "microsurface is linearly transformed by a matrix M (Atanasov et al., <i>Microsurface Transformations</i>, 2022). Each line is a claim; its number was read "
            "from the section that the verdict links to. “Measured” is a number without a threshold: nothing was set beforehand that it could fail.</p>\n"
            f"<table><thead><tr><th>claim</th><th>tested by</th><th>found</th><th>verdict</th></tr></thead><tbody>{''.join(rows)}</tbody></table>")
