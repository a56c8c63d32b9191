# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The major axis of a lobe by its definitions, to any number of digits: what tests/test_ibl_axis.py holds `musurf ibl axis` to.

Nothing here is solved in closed form as Appendix A and B of Cocco et al. 2024 do, or as the program does. The boundary of
Eq. (6) is a curve; its closest and farthest points are the roots of the derivative of the alignment d(t), bracketed on a grid
and refined by bisection and secants; where the axis meets the horizon is found by interpolating the height of the reflection
along it. The rest is Eq. (8) to (10) and Appendix C and D as printed, with vectors in three dimensions.
"""
from mpmath import mp

INPUTS = ("su", "sv", "angle", "ox", "oy", "oz", "k", "beta")


def add(a, b, scale=1):
    return [x + scale * y for x, y in zip(a, b)]


def dot(a, b):
    return mp.fsum(x * y for x, y in zip(a, b))


def norm(a):
    return mp.sqrt(dot(a, a))


def unit(a):
    length = norm(a)
    return [x / length for x in a]


def nlerp(a, b, t):
    return unit(add([(1 - t) * x for x in a], b, t))


def half_turn(t):
    """In (-pi/2, pi/2]; what a root may be off at -pi/2 is still pi/2."""
    t = t - mp.pi * mp.floor(t / mp.pi)  # [0, pi)
    return t - mp.pi if t > mp.pi / 2 + mp.mpf(10) ** (-mp.dps // 2) else t


class Lobe:
    def __init__(self, x):
        self.o = unit([x["ox"], x["oy"], x["oz"]])
        self.r = x["k"] * x["su"], x["k"] * x["sv"]
        c, s = mp.cos(x["angle"]), mp.sin(x["angle"])
        self.u, self.v = (c, s), (-s, c)
        self.mirrored = [-self.o[0], -self.o[1], self.o[2]]  # the geometric normal's reflection

    def leaning(self, t, rate=0):
        """The unnormalised micronormal of the boundary at t, or its derivative."""
        a, b = (mp.cos(t), mp.sin(t)) if rate == 0 else (-mp.sin(t), mp.cos(t))
        return [-(self.r[0] * a * self.u[i] + self.r[1] * b * self.v[i]) for i in (0, 1)] + [mp.mpf(1 - rate)]

    def normal(self, t):
        return unit(self.leaning(t))

    def reflect(self, m):
        return add([2 * dot(m, self.o) * c for c in m], self.o, -1)

    def alignment(self, t):
        return dot(self.reflect(self.normal(t)), self.mirrored)

    def slope(self, t):
        """A positive multiple of d'(t): d = 2 (n.o)(n.g) / n.n - o.g."""
        n, m, o, g = self.leaning(t), self.leaning(t, 1), self.o, self.mirrored
        return (dot(m, o) * dot(n, g) + dot(n, o) * dot(m, g)) * dot(n, n) - 2 * dot(n, o) * dot(n, g) * dot(n, m)

    def root(self, a, b):
        fa, goal = self.slope(a), mp.mpf(10) ** (8 - mp.dps)
        for _ in range(40):
            middle = (a + b) / 2
            fm = self.slope(middle)
            if (fm > 0) == (fa > 0):
                a, fa = middle, fm
            else:
                b = middle
        return self.refine(a, b, goal)

    def refine(self, a, b, goal):
        fa, fb = self.slope(a), self.slope(b)
        for _ in range(60):
            if fb == fa or abs(b - a) <= goal * abs(b):
                break
            a, b, fa = b, b - fb * (b - a) / (fb - fa), fb
            fb = self.slope(b)
        return b

    def extrema(self, near=None):
        """t0 of the closest and t1 of the farthest point, or None where all are equally far. `near`: roots next to these."""
        if near:
            step = mp.mpf(10) ** (-mp.dps // 2)
            return [self.refine(t, t + step * (abs(t) + step), mp.mpf(10) ** (8 - mp.dps)) for t in near]
        # even steps in the angle that a narrow ellipse's points have in normal space, so that none is missed
        ratio = mp.sqrt((1 + self.r[0] ** 2) / (1 + self.r[1] ** 2))
        grid = [mp.atan2(ratio * mp.sin(u), mp.cos(u)) for u in (mp.pi * (i + mp.mpf(1) / 7) / 24 - mp.pi / 2 for i in range(25))]
        values = [self.slope(t) for t in grid]
        size = max(abs(self.alignment(t) - 1) for t in grid)
        if max(map(abs, values)) <= size * mp.mpf(10) ** (10 - mp.dps):
            return None
        roots = [self.root(a, b) for a, b, p, q in zip(grid, grid[1:], values, values[1:]) if (p > 0) != (q > 0)]
        assert len(roots) == 2, "one closest and one farthest point in half a turn"
        return sorted(map(half_turn, roots), key=self.alignment, reverse=True)

    def horizon(self, ends):
        """tau0 < 1/2 < tau1 where the reflection of what lies between the ends is level; None: nowhere."""
        def height(tau):
            v = add([(1 - tau) * c for c in ends[0]], ends[1], tau)
            return 2 * dot(v, self.o) * v[2] - self.o[2] * dot(v, v)

        low, middle, high = (height(mp.mpf(tau)) for tau in (-1, 0, 1))  # a quadratic in tau
        c2, c1, c0 = (low + high) / 2 - middle, (high - low) / 2, middle
        tiny = mp.mpf(10) ** (10 - mp.dps) * (abs(c1) + abs(c0))
        if abs(c2) <= tiny:
            roots = [-c0 / c1] if abs(c1) > mp.mpf(10) ** (10 - mp.dps) * abs(c0) else []
            # of the root at infinity only the side is known: the axis is above the horizon between them
            if not roots:
                return None, None
            return (roots[0], None) if c1 > 0 else (None, roots[0])
        root = mp.sqrt(c1 * c1 - 4 * c2 * c0)
        return tuple(sorted(((-c1 - root) / (2 * c2), (-c1 + root) / (2 * c2))))


def major_axis(x, samples, shift, near=None):
    """All that `musurf ibl axis` answers; vectors as lists. `x` has the INPUTS; extrema next to `near`, if given."""
    lobe = Lobe(x)
    # Appendix A where all points are equally far
    t = lobe.extrema(near) or [mp.pi / 2, mp.mpf(0)]
    out = {"t": t, "near": [lobe.normal(t[0] + i * mp.pi) for i in (0, 1)], "far": [lobe.normal(t[1] + i * mp.pi) for i in (0, 1)]}
    tau = [mp.mpf(i) if at is None else at for i, at in enumerate(lobe.horizon(out["far"]))]
    held = [min(max(at, 0), 1) for at in tau]
    clamped = [nlerp(*out["far"], at) for at in held]
    if shift == "printed":
        delta = (held[0] if held[0] > 0 else held[1] - 1) * (t[0] - t[1])
    else:
        delta = (held[0] + held[1] - 1) * (t[0] - t[1])
    delta *= 1 + x.get("delta", 0)

    def apart(a, b):
        return norm(add(lobe.reflect(a), lobe.reflect(b), -1))

    width = apart(lobe.normal(t[0] + delta), lobe.normal(t[0] - delta + mp.pi))
    length = apart(*clamped)
    zeta = (length - width) / length if length else mp.mpf(0)
    middle = unit(add(*clamped))
    outer = [nlerp(middle, end, zeta) for end in clamped]
    steps = [mp.mpf(j) / (samples - 1) for j in range(samples)] if samples > 1 else [mp.mpf(1) / 2]
    return {**out, "tau": tau, "far_clamped": clamped, "delta": delta, "width": width, "length": length, "zeta": zeta,
            "radius": max(width / (2 * x["k"]), x["beta"] * length / (2 * samples)),
            "samples": [nlerp(*outer, step) for step in steps]}


def conditions(x, samples, shift, values):
    """What one unit of relative change in every input, and in delta, does to each value, in absolute terms: lists as `flat`
    has them. Delta is an angle that is rounded on the way: the curve's own points are steep functions of it only where slopes
    are far above 1."""
    step = mp.mpf(10) ** (-mp.dps // 3)
    moves = {key: [mp.mpf(0)] * len(flat(value)) for key, value in values.items()}
    for name in (*INPUTS, "delta"):
        if x.get(name) == 0:
            continue
        most = {key: list(m) for key, m in moves.items()}
        for sign in (1, -1):
            moved = major_axis({**x, name: x[name] * (1 + sign * step) if name in x else sign * step}, samples, shift, values["t"])
            for key, value in values.items():
                for i, (a, b) in enumerate(zip(flat(moved[key]), flat(value))):
                    most[key][i] = max(most[key][i], moves[key][i] + abs(a - b) / step)
        moves = most
    return moves


def flat(value):
    if not isinstance(value, (list, tuple)):
        return [value]
    return [number for part in value for number in flat(part)]
