# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Microfacet quantities to 50 digits, from their definitions: nothing here was taken from the C code.

Equation numbers are those of *Microsurface Transformations*. Distributions: D of GTR is Eq. (32), (33); of GGX the
same with gamma = 2; of Beckmann exp(-tan^2/alpha^2) / (pi alpha^2 cos^4). Lambda is the Smith integral, see smith.py.
M acts by explicit 3x3 matrices and their inverse, exactly as the equations are printed.
"""
import mpmath as mp

mp.mp.dps = 50


def normalise(v):
    return v / mp.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)


def dot(v, w):
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2]


def D_isotropic(ndf, alpha, gamma, cos):
    """D of the untransformed microsurface, 1/sr."""
    a = alpha * alpha
    if ndf == "beckmann":
        return mp.exp(-(1 - cos * cos) / (cos * cos) / a) / (mp.pi * a * cos ** 4)
    if alpha == 1:
        return 1 / mp.pi  # the limit of Eq. (32) for every gamma
    base = 1 + (a - 1) * cos * cos
    if gamma == 1:
        return (a - 1) / (mp.pi * mp.log(a)) / base  # Eq. (33)
    return (gamma - 1) * (a - 1) / (mp.pi * (1 - a ** (1 - gamma))) / base ** gamma  # Eq. (32)


def fresnel(kind, values, cos):
    """Reflectance per channel: exact unpolarised Fresnel, or Schlick's approximation."""
    if kind == "none":
        return [mp.mpf(1)] * 3
    if kind == "schlick":
        return [f0 + (1 - f0) * (1 - cos) ** 5 for f0 in values]
    result = []
    for N in values:  # complex index n + ik relative to above
        # N cos_t = sqrt(N^2 - sin^2); no real angle is needed
        root = mp.sqrt(N * N - (1 - cos * cos))
        rs = (cos - root) / (cos + root)
        rp = (N * N * cos - root) / (N * N * cos + root)
        result.append((abs(rs) ** 2 + abs(rp) ** 2) / 2)
    return result


class Case:
    """One material and three directions, in numbers that may be perturbed one by one."""

    def __init__(self, ndf, alpha, gamma, transform, kind, values, wo, wm, wi):
        self.ndf, self.kind = ndf, kind
        self.complex_index = kind == "conductor"
        # exactly the doubles; then the lengths of the normalised wo and wi, which no rounded vector has exactly
        self.numbers = [mp.mpf(x) for x in (alpha, gamma, *transform, *wo, *wm, *wi, 1, 1, *values)]

    def evaluate(self, Lambda):
        """All quantities; Lambda(ndf, alpha, gamma, tau, side) supplies the Smith integral."""
        x = self.numbers
        alpha, gamma = x[0], x[1]
        M = mp.matrix([[x[2], x[3], 0], [x[4], x[5], 0], [0, 0, 1]])  # rows [a c], [b d] of Eq. (9)
        Mt, inverse = M.T, M ** -1
        det = abs(M[0, 0] * M[1, 1] - M[0, 1] * M[1, 0])
        v, m, l = (normalise(mp.matrix(x[i:i + 3])) for i in (6, 9, 12))
        v, l = v * x[15], l * x[16]
        values = x[17:]
        if self.complex_index:
            values = [mp.mpc(values[i], values[i + 3]) for i in range(3)]

        def smith(w, side):
            w = normalise(inverse * w)  # Eq. (12)
            return Lambda(self.ndf, alpha, gamma, mp.sqrt(w[0] ** 2 + w[1] ** 2) / w[2], side)

        def D(normal):
            u = Mt * normal
            length = mp.sqrt(u[0] ** 2 + u[1] ** 2 + u[2] ** 2)
            return det / length ** 4 * D_isotropic(self.ndf, alpha, gamma, u[2] / length)  # Eq. (22)

        Lv, Ll = smith(v, 0), smith(l, 1)
        out = {"Lambda": Lv, "sigma": v[2] * (1 + Lv), "D": D(m)}
        out["G1"] = 1 / (1 + Lv) if dot(v, m) > 0 else mp.mpf(0)
        out["Dv"] = out["G1"] * max(mp.mpf(0), dot(v, m)) * out["D"] / v[2]  # Eq. (28)
        h = normalise(v + l)
        Dh = D(h)
        G2 = 1 / (1 + Lv + Ll)  # height-correlated
        F = fresnel(self.kind, values, dot(v, h))
        out["G2"] = G2
        out["pdf"] = Dh / (1 + Lv) / (4 * v[2])  # Eq. (28) at h times dh/dl = 1/(4 v.h)
        out.update({f"F{i}": F[i] for i in range(3)})
        out.update({f"f{i}": F[i] * Dh * G2 / (4 * v[2] * l[2]) for i in range(3)})
        return out
