# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Judges the measurements against geometry and against the core, and says why each tolerance is what it is.

A verdict is one of AGREES, KNOWN ("differs as Smith is known to") and FAILS.
"""
import numpy as np

from . import maps, masking as geometry, mesh, normals, smith, statistics

AGREES, KNOWN, FAILS = "agrees", "differs as Smith is known to", "FAILS"

MASKING_LIMIT = 1e-4  # of the bits; 3e-5 are seen: height_field is not mesh2 to the last bit where a ray grazes an edge
CONTROL_LIMIT = 1e-2  # a wrong direction must change at least this share of the bits
ROUNDING = 1e-9  # relative, of quotients of numbers that the core gives in double precision
SAMPLING = 1e-3  # relative, of a projected mean taken from 9 points per facet


def row(check, name, view, verdict, **values):
    return {"check": check, "map": name, "view": view, "verdict": verdict,
            **{k: float(v) if isinstance(v, np.floating) else v for k, v in values.items()}}


def label(view):
    theta, phi = np.degrees(np.arctan2(np.hypot(view[0], view[1]), view[2])), np.degrees(np.arctan2(view[1], view[0]))
    return f"{theta:.4g} deg, azimuth {phi % 360:.4g}"


def tests(setup):
    """How many chances to err one validation has. Maps add none: by Eq. (11) all of them see the same bits."""
    bins = sum(len(smith.edges(setup.nu(v))) - 1 for v in setup.views)
    return 2 * len(setup.views) + bins + len(setup.pairs)


def masking(setup, measured):
    """Eq. (11): what v sees of the surface, M v sees of its image. Pure geometry, the core has no part in it."""
    rows = []
    for name, surfaces in measured["maps"].items():
        for k, view in enumerate(setup.views):
            different, total = sum(int(s["different"][k]) for s in surfaces), sum(s["total"] for s in surfaces)
            from_mesh = sum(int(s["different_from_mesh"][k]) for s in surfaces)
            facets = sum(int(s["different_facets"][k]) for s in surfaces), sum(s["facets"] for s in surfaces)
            rows.append(row("masking", name, label(view), AGREES if different <= MASKING_LIMIT * total else FAILS,
                            different=different, total=total, different_from_mesh=from_mesh, different_facets=facets[0], facets=facets[1],
                            share=different / total, tolerance=MASKING_LIMIT))
    return rows


def control(setup, measured):
    """The masking check must be able to fail: lit from v or from M^-1 v instead of M v, it does.

    Where the wrong direction is within 10 degrees of the right one, seen from the original, nothing is asked.
    """
    rows = []
    for c in measured["controls"]:
        back = np.linalg.inv(setup.maps[c["map"]])
        for k, view in enumerate(setup.views):
            wrong = maps.carried(back, view if c["lit_from"] == "v" else maps.carried(back, view))
            if wrong @ view > np.cos(np.radians(10)):
                continue
            different, total = int(c["different"][k]), c["total"]
            rows.append(row("control", c["map"], label(view), AGREES if different >= CONTROL_LIMIT * total else FAILS,
                            lit_from=c["lit_from"], different=different, total=total, share=different / total,
                            tolerance=CONTROL_LIMIT))
    return rows


def compare(check, name, view, measured, error, core, tolerance, **more):
    """One number of the surface against the core's."""
    return row(check, name, label(view), AGREES if abs(measured - core) <= tolerance else FAILS, measured=measured,
               standard_error=error, predicted=core, deviation=measured / core - 1 if core else float("nan"),
               tolerance=tolerance, **more)


def projected(setup, measured, core):
    """G1's projected mean and sigma: identities of geometry, which hold the core's D, sigma and M to the surface."""
    rows = []
    for name, m in setup.maps.items():
        directions = [maps.carried(m, v) for v in setup.views]
        g1, sigma = core.masking(setup.alpha, m, directions)
        slopes = [mesh.baked_slopes(h, m) for h in setup.plain]
        for k, view in enumerate(setup.views):
            blocks = np.concatenate([s["projected"][k] for s in measured["maps"][name]], -1)
            mean, error = statistics.ratio(*blocks)
            facet, facet_error = statistics.ratio(*np.concatenate([s["facet_mean"][k] for s in measured["maps"][name]], -1))
            chance = statistics.student(blocks.shape[-1] - 1, tests(setup)) * error
            rows.append(compare("G1 projected mean", name, view, mean, error, g1[k], chance + SAMPLING * mean,
                                facet_mean=facet, facet_error=facet_error))
            areas = [geometry.sigma(s, directions[k]) for s in slopes]
            error = statistics.standard_error(areas)
            rows.append(compare("sigma", name, view, np.mean(areas), error, sigma[k],
                                statistics.student(len(areas) - 1, tests(setup)) * error))
    return rows


def bins(setup, measured, core):
    """G1 per slope against Smith's one value: differs, and must differ as measured elsewhere, no more."""
    rows = []
    for name, m in setup.maps.items():
        g1, _ = core.masking(setup.alpha, m, [maps.carried(m, v) for v in setup.views])
        for k, view in enumerate(setup.views):
            seen, every = (np.concatenate([s["bins"][k][part] for s in measured["maps"][name]], -1) for part in (0, 1))
            value, error = statistics.ratio(seen, every)
            edges = smith.edges(setup.nu(view))
            for index in range(len(value)):
                chance = statistics.student(seen.shape[-1] - 1, tests(setup)) * error[index] / g1[k]
                deviation, known = value[index] / g1[k] - 1, smith.known_deviation(setup.nu(view), index)
                if not np.isfinite(deviation) or not np.isfinite(chance):
                    verdict = FAILS
                elif abs(deviation) <= chance:
                    verdict = AGREES
                else:
                    verdict = KNOWN if known and known[0] - chance <= deviation <= known[1] + chance else FAILS
                rows.append(row("G1 per slope", name, label(view), verdict, bin=index, low=edges[index],
                                high=min(edges[index + 1], setup.nu(view)), share=every[index].sum() / every.sum(),
                                measured=value[index], standard_error=error[index], predicted=g1[k],
                                deviation=deviation, chance=chance, known=known))
    return rows


def joint(setup, measured, core):
    """How far being seen by two directions goes together for facets of like normals: G2 over G1 G1.

    On explicit surfaces it goes together more than Smith's height correlation says (1.01 where that says 1.001 was
    measured beforehand at alpha .3, 75 degrees, opposite azimuths), since valleys have high neighbours on all sides. So
    the core's ratio must lie between independence (1) and the measured one. Two bounds need no model: G2 is symmetric
    and never above the smaller G1. The G2 within f, the BRDF, must be the same.
    """
    rows = []
    for name, m in setup.maps.items():
        directions = [maps.carried(m, v) for v in setup.views]
        g1, _ = core.masking(setup.alpha, m, directions)
        for (a, b), blocks in zip(setup.pairs, zip(*(s["joint"] for s in measured["maps"][name]))):
            both, seen_a, seen_b, every = np.concatenate(blocks, -1)
            ratio, error = statistics.dependence(both, seen_a, seen_b, every)
            chance = statistics.student(both.shape[-1] - 1, tests(setup)) * error
            asked = [*core.joint(setup.alpha, m, directions[a], directions[b]),
                     *core.joint(setup.alpha, m, directions[b], directions[a])]
            forth, predicted, least = asked[0], asked[0] / (g1[a] * g1[b]), min(g1[a], g1[b])
            sound = all(abs(x / forth - 1) <= ROUNDING for x in asked) and \
                1 - ROUNDING <= predicted and forth <= least * (1 + ROUNDING)
            if not sound or not predicted <= ratio + chance:
                verdict = FAILS
            else:
                verdict = AGREES if ratio <= predicted + chance else KNOWN
            rows.append(row("G2 / (G1 G1)", name, f"{label(setup.views[a])} and {label(setup.views[b])}", verdict,
                            measured=ratio, standard_error=error, predicted=predicted, deviation=ratio / predicted - 1,
                            chance=chance, G2_predicted=asked, least_G1=least))
    return rows


def distribution(setup, measured, core):
    """Eq. (22): normals of the transformed facets against the core's D, by total variation.

    Tolerance: what errors of the bins' size, estimated between surfaces, make by chance, and four standard deviations.
    """
    rows, tables = [], {}
    for name, m in setup.maps.items():
        slopes = [mesh.baked_slopes(h, m) for h in setup.plain]
        edges = normals.ring_edges(slopes[0])
        shares = np.array([normals.histogram(s, edges) for s in slopes])
        at, weights = normals.nodes(edges)
        core_shares = normals.predicted(core.distribution(setup.alpha, m, normals.normals_of(at)), at, weights)
        reference = shares.mean(0)
        shares, predicted = normals.pooled(shares, reference), normals.pooled(core_shares, reference)
        error = statistics.standard_error(shares)
        mean, spread = statistics.chance_variation(error / statistics.small_sample(len(shares)))
        variation, tolerance = normals.total_variation(shares.mean(0), predicted), mean + 4 * spread
        relative = shares.mean(0)[:-1] / predicted[:-1] - 1
        rows.append(row("D of normals", name, "all", AGREES if variation <= tolerance else FAILS, measured=variation,
                        predicted=0.0, chance_mean=mean, standard_error=spread, tolerance=tolerance, bins=len(predicted),
                        rms=float(np.sqrt((relative**2).mean())), integral=float(core_shares.sum())))
        tables[name] = {"measured": shares.mean(0), "predicted": predicted, "error": error}
    return rows, tables
