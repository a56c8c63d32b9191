# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How well inputs determine a value: what moving each of them by a few roundings does to the exact value.

c53 of a value is the sum over the input numbers of its relative change when that number moves by 8 units of 2^-53
(the worse of both signs), in such units; c24 the same with 2^-24. See make_reference.py for what it is for.
"""
import mpmath as mp

import smith
import spline

ROUNDINGS = 8


def measure(case, digits=30):
    """(expect, c53, c24) of a Bsdf: mpf values by name, and floats."""
    base = {}

    def exact(*arguments):
        *point, side = arguments
        base[side] = (smith.Lambda(*point, digits=digits), smith.derivatives(*point), point[1:])
        return base[side][0]

    def nearby(*arguments):
        """Lambda next to the base point, by its logarithmic derivatives: only how far values move is wanted."""
        *point, side = arguments
        if side not in base:  # a perturbation brought wi into view: the value it had was 0
            return mp.mpf(0)
        value, slopes, origin = base[side]
        return value * mp.exp(sum(k * mp.log(x / x0) for k, x, x0 in zip(slopes, point[1:], origin) if k and x0))

    def approximate(ndf, alpha, gamma, tau, side):
        return spline.Lambda(alpha, gamma, tau, lambda name: case.x[name])

    if case.spline:
        exact = nearby = approximate
    values = case.evaluate(exact)
    kept = case.density, case.density_pdf, case.visible
    conditions = []
    with mp.workdps(40):
        for bits in (53, 24):
            step = mp.mpf(ROUNDINGS) / 2 ** bits
            moves = dict.fromkeys(values, mp.mpf(0))
            for name, number in case.x.items():
                absolute = name in case.ABSOLUTE
                if (number == 0 and not absolute) or (name == "table" and bits == 53):
                    continue
                most = dict.fromkeys(values, mp.mpf(0))
                for sign in (1, -1):
                    case.x[name] = number + sign * step * (1 if absolute else number)
                    moved = case.evaluate(nearby)
                    for key in values:
                        most[key] = max(most[key], abs(moved.get(key, mp.inf) - values[key]))
                case.x[name] = number
                for key in moves:
                    moves[key] += most[key]
            conditions.append({key: 0.0 if moves[key] == 0 else float(mp.nstr(min(
                moves[key] / abs(values[key]) / step if values[key] else mp.inf, mp.mpf(10) ** 99), 3)) for key in values})
    case.density, case.density_pdf, case.visible = kept
    return values, *conditions
