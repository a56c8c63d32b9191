# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Light reflected once and often by mirror facets against the BRDF under M, its albedo, compensation and the random walk."""
import numpy as np

from . import expect, known, statistics
from .verdicts import bounded, label, statistical

QUADRATURE = expect.QUADRATURE
ESCAPING = 1e-3  # of the light, after 20 reflections of perfect mirrors: 1e-4 is seen, near-level rays and the tiles' border
# rms of the bins' deviations as measured beforehand, sampling included; half of it bounds the total variation, since
# a mean of magnitudes is at most the rms. Beckmann up to alpha .3 and 75 degrees 5 %; rougher, flatter, or longer-tailed 10 %.
RMS = (0.05, 0.10)


def blocks(spec, jobs, key):
    return np.concatenate([statistics.folded(job[key].T, spec.folds).T for job in jobs])


def reflection(spec, core, name, m, view, jobs):
    """view: in the space of the transformed surface."""
    said = expect.reflection(core, spec, m, view)
    parameters = spec.parameters
    pixels, freedom = blocks(spec, jobs, "pixels"), len(blocks(spec, jobs, "pixels")) - 1
    common = {"tracer": "povray"}

    def against(check, key, predicted, away, extra=0.0, **more):
        value, error = statistics.ratio(blocks(spec, jobs, key), pixels)
        exact = (predicted * (1 - QUADRATURE), predicted * (1 + QUADRATURE))
        span = (exact[0] + predicted * away[0], exact[1] + predicted * away[1], away[2]) if away else \
            (0.0, 1.0, "none: any albedo")
        return statistical(check, spec.name, name, label(view), value, np.hypot(error, extra), freedom, predicted, exact=exact,
                           known=span, **common, **more)

    once = known.albedo(parameters, m)
    yield against("albedo, one reflection", "once", float(said["bins"].sum()), once, fresnel="none")
    yield against("albedo, one reflection", "once_fresnel", said["fresnel"], once, fresnel="dielectric 5")
    yield bins(spec, name, m, view, jobs, pixels, said["bins"], parameters, common)
    for kind, label_, predicted, extra in (("compensated", "compensation", said["compensated"], 0.0),
                                           ("random_walk", "random walk", said["walk"], said["walk_error"])):
        yield against(f"energy, all reflections: {label_}", "all_fresnel", predicted, known.all_orders(kind, parameters, m), extra,
                      fresnel="dielectric 5")
    left = float(blocks(spec, jobs, "all").sum() / pixels.sum())
    yield bounded("energy conserved", spec.name, name, label(view), left >= 1 - ESCAPING, measured=left, tolerance=ESCAPING, **common)


def bins(spec, name, m, view, jobs, pixels, predicted, parameters, common):
    """The BRDF per bin of directions, times cosine and solid angle, by total variation; bins below .2 % are united."""
    value, error = statistics.ratio(blocks(spec, jobs, "bins").T, np.broadcast_to(pixels, (len(predicted), len(pixels))))
    large = predicted >= 0.002
    value, error, predicted = ([*a[large], s] for a, s in zip((value, error, predicted), (
        value[~large].sum(), np.sqrt((error[~large] ** 2).sum()), predicted[~large].sum())))
    value, error, predicted = map(np.array, (value, error, predicted))
    mean, spread = statistics.chance_variation(error)
    rough = spec.alpha / np.linalg.svd(m, compute_uv=False)[1]
    mild = parameters and parameters["ndf"] == "beckmann" and rough <= 0.3001 and view[2] >= np.cos(np.radians(75.01))
    relative = value[:-1] / predicted[:-1] - 1
    noise = (error[:-1] / predicted[:-1]) ** 2
    worst = int(abs(relative / np.maximum(np.sqrt(noise), 1e-12)).argmax()) if len(relative) else 0
    top = 0.5 * (RMS[0] if mild else RMS[1]) * predicted.sum() if parameters else 1.0
    return statistical("BRDF per bin", spec.name, name, label(view), 0.5 * float(abs(value - predicted).sum()), spread,
                       statistics.NORMAL, mean, exact=(0.0, mean + QUADRATURE / 2),
                       known=(0.0, mean + top, "table" if parameters else "none: any BRDF"), bins=len(predicted),
                       rms=float(np.sqrt(max(0.0, (relative**2 - noise).mean()))) if len(relative) else None,
                       worst_bin=float(relative[worst]) if len(relative) else None, **common)
