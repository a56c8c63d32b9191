# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""One material and its directions, to 50 digits: every family, anisotropy, tilt, masking, both sides of a surface.

The microsurface is the family's own, moved by (x, y, z) -> (M (x, y), z + t.(x, y)), B = [[M, 0], [t, 1]]:
    directions go with B, normals with B^-T;  D(m) = |det M| / |B^T m|^4 D0(B^T m / |B^T m|), Eq. (22) with B for M;
    sigma(w) = int max(0, w.m) D(m) dm = sigma0(B^-1 w), sigma0 homogeneous of degree 1;
    sigma0(u) = max(0, u_z) + |u_z| Lambda(|u_xy| / |u_z|): the half below is the half above by int (u.m) D = u_z.
Ellipsoids: Eq. (1) and (28) of *The Ellipsoid NDF*, with A as it stands. From those, and nothing else:
    Lambda = sigma/cos - 1, G1 = min(1, cos/sigma) on the visible side, Dv = D max(0, wo.wm)/sigma, and G2 with
    L = max(0, Lambda); reflection D G2 F / (4 cos cos); refraction by Walter et al. 2007, Eq. (21), (17), as radiance:
    f = |wo.h||wi.h| / (|wo.z||wi.z|) (1-F) G2 D / (eta wi.h + wo.h)^2, h along -(wo + eta wi), eta = n_i/n_o.
A transmitting material seen from below is its point reflection: (-wo, -wm, -wi) with 1/eta.
Histograms of slopes: histogram.py; densities of other samplers: samplers.py; the approximate masking of smith "spline": spline.py.
Discrete distributions are their smooth ones: that is their mean over footprints.
"""
import mpmath as mp

import families
import samplers
import spline
from histogram import Histogram
from model import fresnel

mp.mp.dps = 50
ZERO, ONE = mp.mpf(0), mp.mpf(1)


def dot(v, w):
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2]


def length(v):
    return mp.sqrt(dot(v, v))


def unit(v, by=1):
    s = by / length(v)
    return [v[0] * s, v[1] * s, v[2] * s]


def cross(v, w):
    return [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]]


def product(p, q):
    return [[sum(p[i][k] * q[k][j] for k in range(len(q))) for j in range(len(q[0]))] for i in range(len(p))]


def rotation(angle):
    c, s = mp.cos(angle), mp.sin(angle)
    return [[c, -s], [s, c]]


def ellipsoid_matrix(x):
    """A, from its rows or from Eq. (2), (3) of *The Ellipsoid NDF*."""
    if "A00" in x:
        return [[x[f"A{i}{j}"] for j in range(3)] for i in range(3)]
    (cx, sx), (cy, sy), (cz, sz) = ((mp.cos(x[k]), mp.sin(x[k])) for k in ("theta_x", "theta_y", "theta_z"))
    R = product(product([[1, 0, 0], [0, cx, -sx], [0, sx, cx]], [[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]),
                [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return [[row * scale for row in R[i]] for i, scale in enumerate((x["alpha_x"], x["alpha_y"], 1))]


def upper(A):
    """The matrix [[a, b, 0], [0, c, 0], [p, q, 1]] with the same ellipsoid as A: five numbers are all that counts."""
    columns = list(zip(*A))
    g = [[dot(u, v) / dot(columns[2], columns[2]) for v in columns] for u in columns]
    p, q = g[0][2], g[1][2]
    a = mp.sqrt(g[0][0] - p * p)
    b = (g[0][1] - p * q) / a
    return a, b, mp.sqrt(g[1][1] - q * q - b * b), p, q


def triangle(A, M):
    """(N, p, q): the matrix [[N, 0], [(p, q), 1]] with the same ellipsoid as A, N upper or lower triangular, of which M N^-1 in
    rounded numbers is the better: the one whose |M| |N^-1| has the smaller permanent (core/bsdf/ellipsoid.c says why)."""
    a, b, c, p, q = upper(A)
    s = mp.sqrt(b * b + c * c)
    options = [[[a, b], [ZERO, c]], [[a * c / s, ZERO], [a * b / s, s]]]

    def permanent(N):
        (w, x), (y, z) = N
        S = product([[abs(e) for e in row] for row in M], [[abs(z), abs(x)], [abs(y), abs(w)]])  # |N^-1| |det N|
        return S[0][0] * S[1][1] + S[0][1] * S[1][0]

    return min(options, key=permanent), p, q


class Bsdf:
    """Numbers by name that may be perturbed one by one. Those named by ABSOLUTE stand at 0 or 1 and are what no input
    number is but every program has: the lengths of its unit vectors, the entries of the composed map, weights and tails of a
    spline, the place among cells of slopes, in float a table (below), and the components of a sampled wi, which is no input."""

    SAMPLED = ("s0", "s1", "s2")
    SPLINE = tuple(f"{what}{k}" for what in ("weight", "tail") for k in range(5))
    CELLS = ("e0", "e1", "table")
    ABSOLUTE = ("|wo|", "|wi|", *(f"d{i}" for i in range(9)), *SAMPLED, *SPLINE, *CELLS)
    # z Lambda of a histogram in float is a table, right to 3e-5 of sigma for small smooth histograms (tabulated_smith.c), of
    # which one of C c 2^-24 with C = 8 (tests/test_reference.py) is 1/63.
    TABLE = 63

    def __init__(self, material, wo, wm, wi, sampled=False):
        self.material, self.ndf = material, material["ndf"].removeprefix("discrete_")
        self.spline, self.sampled = material.get("smith") == "spline", sampled
        x = {}
        for key in ("alpha", "gamma", "exponent", "alpha_x", "alpha_y", "rotation", "theta_x", "theta_y", "theta_z"):
            if key in material:
                x[key] = mp.mpf(material[key])
        for i, row in enumerate(material.get("A", [])):
            x.update({f"A{i}{j}": mp.mpf(value) for j, value in enumerate(row)})
        for i, row in enumerate(material.get("transform", [])):
            x.update({f"M{i}{j}": mp.mpf(value) for j, value in enumerate(row)})
        x.update({f"t{i}": mp.mpf(value) for i, value in enumerate(material.get("tilt", []))})
        for name, v in (("wo", wo), ("wm", wm), ("wi", wi)):
            x.update({f"{name}{i}": mp.mpf(value) for i, value in enumerate(v)})
        self.composed = self.ndf == "ellipsoid" or "alpha_x" in material or "tilt" in material
        x.update({"|wo|": ONE, "|wi|": ONE})
        if self.composed:
            x.update({f"d{i}": ZERO for i in range(9 if self.ndf == "ellipsoid" else 6)})
        if self.ndf == "tabulated":
            self.histogram = Histogram(material["histogram"]["weights"])
            x.update({f"b{i}": mp.mpf(value) for i, value in enumerate(material["histogram"]["bounds"])})
        x.update(dict.fromkeys((*self.SAMPLED * sampled, *self.SPLINE * self.spline, *self.CELLS * (self.ndf == "tabulated")), ZERO))
        self.kind, values = "none", material.get("fresnel", "none")
        if isinstance(values, dict):
            self.kind, values = next(iter(values.items()))
            if self.kind == "conductor":
                values = [*values["n"], *values["k"]]
            values = values if isinstance(values, list) else [values]
            x.update({f"n{i}": mp.mpf(value) for i, value in enumerate(values)})
        self.x = x

    def shape(self):
        """alpha and gamma of the isotropic family."""
        x = self.x
        if self.ndf == "phong":
            return ONE, x["exponent"]
        alpha = x["alpha"] if "alpha" in x else mp.sqrt(x["alpha_x"] * x["alpha_y"])
        return alpha, x.get("gamma", mp.mpf(2))

    def map(self):
        """Rows of M and t. The error d of a computed product P Q is relative to |P| |Q|, entry by entry."""
        x = self.x
        M = [[x[f"M{i}{j}"] for j in range(2)] for i in range(2)] if "M00" in x else [[ONE, ZERO], [ZERO, ONE]]
        t = [x.get("t0", ZERO), x.get("t1", ZERO)]
        if self.ndf == "ellipsoid":
            return M, t
        if "alpha_x" in x:
            alpha, R = self.shape()[0], rotation(x.get("rotation", ZERO))
            q = [alpha / x["alpha_x"], alpha / x["alpha_y"]]
            turned = [[R[i][0] * q[0], R[i][1] * q[1]] for i in range(2)]
            sizes = product([[abs(e) for e in row] for row in turned], [[abs(e) for e in row] for row in zip(*R)])
            sizes = product([[abs(e) for e in row] for row in M], sizes)
            M = product(M, product(turned, list(zip(*R))))
        else:
            sizes = [[abs(e) for e in row] for row in M]
        if self.composed:
            M = [[M[i][j] + x[f"d{2 * i + j}"] * sizes[i][j] for j in range(2)] for i in range(2)]
            t = [t[i] * (1 + x[f"d{4 + i}"]) for i in range(2)]
        return M, t

    def prepare(self):
        self.M, self.t = self.map()
        self.det = self.M[0][0] * self.M[1][1] - self.M[0][1] * self.M[1][0]
        if self.ndf == "ellipsoid":
            self.A = ellipsoid_matrix(self.x)
            if any(self.x[f"d{i}"] for i in range(9)):
                self.rounded()
            columns = list(zip(*self.A))
            self.cofactors = [cross(self.A[1], self.A[2]), cross(self.A[2], self.A[0]), cross(self.A[0], self.A[1])]
            self.det_A = dot(self.A[0], self.cofactors[0])
            self.An = columns[2]

    def rounded(self):
        """What a program keeps of A is rounded (d0 to d4), and so is its product with M (d5 to d8): M N^-1 + d |M| |N^-1| is M moved
        by d |M| |N^-1| N. N is the better of the two triangles, which at most doubles what rounding M does."""
        d = [self.x[f"d{i}"] for i in range(9)]
        N, p, q = triangle(self.A, self.M)
        size = abs(N[0][0] * N[1][1])
        inverse = [[abs(N[1][1]) / size, abs(N[0][1]) / size], [abs(N[1][0]) / size, abs(N[0][0]) / size]]
        N = [[N[0][0] * (1 + d[0]), N[0][1] * (1 + d[1])], [N[1][0] * (1 + d[1]), N[1][1] * (1 + d[2])]]
        self.A = [[*N[0], ZERO], [*N[1], ZERO], [p * (1 + d[3]), q * (1 + d[4]), ONE]]
        sizes = product([[abs(e) for e in row] for row in self.M], inverse)
        moves = product([[d[5 + 2 * i + j] * sizes[i][j] for j in range(2)] for i in range(2)], N)
        self.M = [[self.M[i][j] + moves[i][j] for j in range(2)] for i in range(2)]
        self.det = self.M[0][0] * self.M[1][1] - self.M[0][1] * self.M[1][0]

    def original(self, w):
        """B^-1 w and how far its z is from that of w."""
        (a, c), (b, d) = self.M
        p = [(d * w[0] - c * w[1]) / self.det, (a * w[1] - b * w[0]) / self.det]
        moved = -(self.t[0] * p[0] + self.t[1] * p[1])
        return [*p, w[2] + moved], moved

    def sigma(self, w, Lambda, side):
        """sigma, sigma - w_z (which is cos Lambda), and the place of w in the isotropic surface's tangent plane."""
        u, moved = self.original(w)
        if self.ndf == "ellipsoid":
            Au = [dot(row, u) for row in self.A]
            nA = length(self.An)
            sigma = (length(Au) * nA + dot(Au, self.An)) / (2 * nA * nA)  # Eq. (28) / Eq. (26)
            a, b, c, _, _ = upper(self.A)
            return sigma, sigma - w[2], (a * u[0] + b * u[1], c * u[1])
        if self.ndf == "tabulated":
            b = [self.x[f"b{i}"] for i in range(4)]
            level, off = self.histogram.level(b, u), self.x["table"] * self.TABLE
            if off:
                off *= max(ZERO, level) + self.histogram.spread(b, u)
            return self.histogram.part(b, u, 1) + off, self.histogram.part(b, u, -1) + level - w[2] + off, u[:2]
        z = abs(u[2])
        hidden = z * Lambda(self.ndf, *self.shape(), mp.sqrt(u[0] ** 2 + u[1] ** 2) / z, side)
        if u[2] > 0:
            return u[2] + hidden, moved + hidden, u[:2]
        return hidden, hidden - w[2], u[:2]

    def D(self, m):
        if m[2] <= 0:
            return ZERO
        (a, c), (b, d) = self.M
        u = [a * m[0] + b * m[1] + self.t[0] * m[2], c * m[0] + d * m[1] + self.t[1] * m[2], m[2]]
        if self.ndf == "ellipsoid":
            v = [dot(row, u) / self.det_A for row in self.cofactors]  # A^-T u
            return abs(self.det) / (mp.pi * abs(self.det_A) * length(self.An) * dot(v, v) ** 2)  # Eq. (1)
        if self.ndf == "tabulated":
            b = [self.x[f"b{i}"] for i in range(4)]
            slope = [-u[k] / u[2] for k in range(2)]
            slope = [s + self.x[f"e{k}"] * (abs(s) + max(abs(b[2 * k]), abs(b[2 * k + 1]))) for k, s in enumerate(slope)]
            return abs(self.det) * self.histogram.density(b, slope) / u[2] ** 4
        square = dot(u, u)
        flat = u[0] ** 2 + u[1] ** 2
        return abs(self.det) / square ** 2 * families.density(self.ndf, *self.shape(), u[2] ** 2 / square, flat / square)

    def G2(self, Lo, Li, po, pi, reflecting):
        masking = self.material.get("masking", "height_correlated")
        if masking == "separable":
            return 1 / ((1 + Lo) * (1 + Li))
        if masking == "direction_correlated" and reflecting:
            if min(Lo, Li) > 0 and not (any(po) and any(pi)):
                return None  # a view along the normal has no azimuth
            phi = abs(mp.atan2(po[0] * pi[1] - po[1] * pi[0], po[0] * pi[0] + po[1] * pi[1]))
            g = 1 / (1 + mp.mpf("4.41") * phi)
            return 1 / (1 + max(Lo, Li) + (1 - g) * min(Lo, Li))
        return 1 / (1 + Lo + Li)

    def evaluate(self, Lambda):
        """All that is defined here, by name; Lambda(ndf, alpha, gamma, tau, side) supplies the Smith integral."""
        self.prepare()
        self.density = self.density_pdf = ZERO  # at the half-vector; of all that pdf is made of
        self.visible = ONE
        x = self.x
        o, m, i = (unit([x[f"{name}{k}"] for k in range(3)]) for name in ("wo", "wm", "wi"))
        o, i = [e * x["|wo|"] for e in o], [e * x["|wi|"] + x.get(f"s{k}", 0) for k, e in enumerate(i)]
        transmits = bool(self.material.get("transmission"))
        index = [x[f"n{k}"] for k in range(6) if f"n{k}" in x]
        if self.kind == "conductor":
            index = [mp.mpc(index[k], index[k + 3]) for k in range(3)]
        if o[2] < 0 and transmits:
            o, m, i = ([-e for e in v] for v in (o, m, i))
            index = [1 / index[0]]
        if o[2] <= 0:
            return {"pdf": ZERO, **{f"f{k}": ZERO for k in range(3)}}
        out = {}
        sigma, excess, po = self.sigma(o, Lambda, 0)
        self.visible = sigma / length(self.original(o)[0])  # the untransformed surface's, of a unit vector
        out["sigma"], out["Lambda"], out["D"] = sigma, excess / o[2], self.D(m)
        if sigma == 0:  # a histogram that tilt turns away from the viewer entirely
            out.update({"Dv": ZERO, "pdf": ZERO, **{f"f{k}": ZERO for k in range(3)}})
            return out
        if m[2] > 0:
            out["G1"] = min(ONE, o[2] / sigma) if dot(o, m) > 0 else ZERO
            out["Dv"] = out["D"] * max(ZERO, dot(o, m)) / sigma
        if i[2] > 0:
            h, eta, side = unit([p + q for p, q in zip(o, i)]), ONE, 1
        else:
            h, eta, side = None, index[0] if transmits else ONE, -1
            if transmits:
                h = unit([p + eta * q for p, q in zip(o, i)])
                h = h if h[2] > 0 else [-e for e in h]
        if h is None or i[2] == 0 or (side < 0 and (dot(o, h) <= 0 or dot(i, h) >= 0)):
            out.update({"pdf": ZERO, **{f"f{k}": ZERO for k in range(3)}})
            return out
        Do, oh, ih = self.D(h), dot(o, h), dot(i, h)
        away, more, pi = self.sigma([side * e for e in i], Lambda, 1)
        G2 = self.G2(max(ZERO, out["Lambda"]), max(ZERO, more / abs(i[2])), po, pi, side > 0)
        F = fresnel(self.kind, index, oh)
        F = F if len(F) == 3 else F * 3
        self.density = self.density_pdf = Do
        if G2 is not None:
            out["G2"] = G2
        if side > 0:
            value, pdf, factor = Do / (4 * o[2] * i[2]), Do / (4 * sigma), F
            if self.material.get("sampler", "visible") != "visible":
                pdf, self.density_pdf = samplers.pdf(self, self.material["sampler"], o, i, h, sigma)
        else:
            jacobian = abs(ih) / (eta * ih + oh) ** 2
            value = oh * jacobian / (o[2] * abs(i[2])) * Do
            pdf, factor = Do * oh / sigma * jacobian * eta ** 2, [1 - f for f in F]
        out["pdf"] = pdf * factor[0] if transmits else pdf
        out.update({f"F{k}": F[k] for k in range(3)})
        if G2 is not None:
            out.update({f"f{k}": value * G2 * factor[k] for k in range(3)})
            if self.sampled and out["pdf"]:  # as sampling has it, without a sum or quotient of what may be 0
                out["weight"] = value * G2 * factor[0] * abs(i[2]) / out["pdf"]
        return out
