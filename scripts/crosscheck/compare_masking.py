# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What views see: invariance bit by bit, G1 and visible normals against Smith, G2 against its three forms."""
import numpy as np

from . import expect, known, laws, maps, measure, normals, statistics, surfaces
from .verdicts import bounded, label, statistical

MASKING_LIMIT = 1e-4  # of the bits; 3e-5 are seen: height_field is not mesh2 to the last bit where a ray grazes an edge
# A wrong direction must change so many bits that the masking check would fail ten times over. Not more can be asked: at alpha .3
# and 60 degrees .7 % of the points are masked at all, and a wrong direction that sees everything changes these and no others.
CONTROL_LIMIT = 10 * MASKING_LIMIT
ROUNDING = 1e-9  # relative, of quotients of numbers that the core gives in double precision
SAMPLING = 1e-3  # relative, of a projected mean taken from 9 points per facet


def unpacked(job):
    return np.unpackbits(job["bits"])


def differing(a, b, views):
    """Bits that differ, per view."""
    return (unpacked(a) != unpacked(b))[: views * int(a["total"])].reshape(views, -1).sum(1)


def patch(jobs):
    """What one correlation area seen or unseen would change, in shares of all the surfaces.

    Facets are hidden in patches of about this size. Where few are, blocks without any have no scatter, and the standard error
    from blocks knows nothing of the next patch: so one is added to it, in quadrature.
    """
    cells = sum(int(job["total"]) for job in jobs) / (2 * measure.FINE**2)
    return surfaces.CORRELATION**2 / cells


def invariance(spec, look, views, name, jobs, originals, first):
    """Eq. (11): what v sees of the surface, M v sees of its image. Pure geometry, the core has no part in it."""
    total = sum(int(j["total"]) for j in jobs)
    from_field = sum(differing(j, o, len(views)) for j, o in zip(jobs, originals))
    from_mesh = sum(differing(j, o, len(views)) for j, o in zip(jobs, first))
    for k, view in enumerate(views):
        yield bounded("masking", spec.name, name, label(view), from_field[k] <= MASKING_LIMIT * total, tracer="povray",
                      different=from_field[k], total=total, different_from_mesh=from_mesh[k], share=from_field[k] / total,
                      tolerance=MASKING_LIMIT)


def control(spec, views, name, m, wrong, job, original):
    """Lit from v or from M^-1 v instead of M v, the comparison of bits must notice.

    Nothing is asked where the wrong direction is within 10 degrees of the right one, seen from the original.
    """
    back = np.linalg.inv(m)
    different = differing(job, original, len(views))
    for k, view in enumerate(views):
        seen = maps.carried(back, view if wrong == "v" else maps.carried(back, view))
        if seen @ view <= np.cos(np.radians(10)):
            yield bounded("control", spec.name, name, label(view), different[k] >= CONTROL_LIMIT * int(job["total"]),
                          tracer="povray", lit_from=wrong, different=different[k], total=int(job["total"]),
                          share=different[k] / int(job["total"]), tolerance=CONTROL_LIMIT)


def blocks(spec, jobs, key, *index):
    return np.concatenate([statistics.folded(job[key][index], spec.folds) for job in jobs], -1)


def smith(spec, core, views, name, m, jobs, limit):
    """G1: its projected mean, which is cos/sigma for every periodic heightfield; per slope along the view; visible normals."""
    directions = [maps.carried(m, v) for v in views]
    parameters = spec.parameters
    g1, sigma = expect.masking(core, spec, m, directions)
    for k, (view, w) in enumerate(zip(views, directions)):
        top, bottom = blocks(spec, jobs, "projected", k)
        mean, error = statistics.ratio(top, bottom)
        error = np.hypot(error, patch(jobs))
        clip = laws.clipped(parameters, limit) / np.linalg.norm([*(m @ view[:2]), view[2]]) / np.pi * np.hypot(*view[:2])
        yield statistical("G1 projected mean", spec.name, name, label(view), mean, error, len(top) - 1, g1[k], tracer="povray",
                          exact=(g1[k] * (1 - SAMPLING), min(1.0, w[2] / max(sigma[k] - clip, w[2])) * (1 + SAMPLING)))
        scale = measure.nu(view, spec.alpha)
        seen, every = blocks(spec, jobs, f"bins{k}")
        value, error = statistics.ratio(seen, every)
        error = np.hypot(error, patch(jobs))
        cuts = measure.edges(scale)
        deviations = []
        for b in range(len(value)):
            away = known.slope_bin(parameters, scale, b)
            deviations.append(away or (-1.0, 1.0 / g1[k] - 1))
            span = (g1[k] * (1 + away[0]), g1[k] * (1 + away[1]), away[2]) if away else (0, 1, "none: any masking")
            yield statistical("G1 per slope", spec.name, name, label(view), value[b], error[b], seen.shape[-1] - 1, g1[k],
                              known=span, tracer="povray", bin=b, low=cuts[b], high=min(cuts[b + 1], scale),
                              share=every[b].sum() / every.sum())
        yield visible(spec, core, view, w, name, m, jobs, k, cuts, deviations)


def visible(spec, core, view, w, name, m, jobs, k, cuts, deviations):
    """Normals seen, by total variation. Known: half the sum of every bin's mass times what its slope is known to be off."""
    counts = blocks(spec, [{"visible": job["visible"].swapaxes(-1, -2)} for job in jobs], "visible", k).T
    mass, at, slopes = expect.visible_shares(core, spec, m, spec.alpha, w)
    along = measure.nu(view, spec.alpha) * np.tensordot(w[:2], slopes, 1) / w[2]
    off = np.array([max(abs(d[0]), abs(d[1])) for d in deviations])[np.clip(np.searchsorted(cuts, along, "right") - 1, 0, len(cuts) - 2)]
    share, error = statistics.ratio(counts.T, np.broadcast_to(counts.sum(1), counts.T.shape))
    reference = share
    share, predicted, error = normals.pooled(share, reference), normals.pooled(mass, reference), pooled_error(error, reference)
    mean, spread = statistics.chance_variation(error)
    return statistical("visible normals", spec.name, name, label(view), normals.total_variation(share, predicted), spread,
                       statistics.NORMAL, mean, exact=(0.0, mean), known=(0.0, mean + 0.5 * float((at * off).sum()), "G1 per slope"),
                       tracer="povray", bins=len(share), integral=mass.sum())


def pooled_error(error, reference, least=0.002):
    return np.append(error[reference >= least], np.sqrt((error[reference < least] ** 2).sum()))


def joint(spec, core, views, name, m, jobs):
    """How far being seen by two directions goes together for facets of like normals: G2 over G1 G1.

    It goes together at least as much as each form says: valleys have high neighbours on all sides, which no form knows,
    and height correlation knows no azimuth. Known: from the form's value to full correlation, where all that the less
    visible direction sees is seen by the other. That bound is taken from the measured bits. Free of any model: G2 is
    symmetric, at most the smaller G1, and the same within the BRDF f.
    """
    directions = [maps.carried(m, v) for v in views]
    g1, _ = expect.masking(core, spec, m, directions)
    for number, (a, b) in enumerate(measure.pairs(views)):
        both, seen_a, seen_b, every = blocks(spec, jobs, "joint", number)
        ratio, error = statistics.dependence(both, seen_a, seen_b, every)
        error = np.hypot(error, patch(jobs))
        independent = (seen_a.sum(-1) * seen_b.sum(-1) / np.maximum(every.sum(-1), 1)).sum()
        most = float(np.minimum(seen_a.sum(-1), seen_b.sum(-1)).sum() / independent)
        where = f"{label(views[a])} and {label(views[b])}"
        for form, said in expect.joint(core, spec, m, directions[a], directions[b]).items():
            predicted = said[0] / (g1[a] * g1[b])
            yield statistical("G2 / (G1 G1)", spec.name, name, where, ratio, error, both.shape[-1] - 1, predicted, form=form,
                              known=(predicted, max(most, predicted), "independence to full correlation"), tracer="povray")
            least = min(g1[a], g1[b])
            sound = all(abs(x / said[0] - 1) <= ROUNDING for x in said) and 1 - ROUNDING <= predicted \
                and said[0] <= least * (1 + ROUNDING) and (form != "separable" or abs(predicted - 1) <= ROUNDING)
            yield bounded("G2 itself", spec.name, name, where, sound, form=form, G2=said, least_G1=least, tolerance=ROUNDING,
                          tracer="none")



def sigma(spec, core, views, name, m, jobs, limit):
    """Projected area of the facing facets per unit macro area, over realisations, against the core's sigma."""
    if len(jobs) < 2:
        return
    directions = [maps.carried(m, v) for v in views]
    said = expect.masking(core, spec, m, directions)[1]
    areas = np.array([job["sigma"] for job in jobs])
    error = statistics.standard_error(areas)
    for k, view in enumerate(views):
        lost = laws.clipped(spec.parameters, limit) / np.pi * np.hypot(*view[:2]) / np.linalg.norm([*(m @ view[:2]), view[2]])
        yield statistical("sigma", spec.name, name, label(view), areas[:, k].mean(), error[k], len(areas) - 1, said[k],
                          exact=(said[k] - lost, said[k]), tracer="none")
