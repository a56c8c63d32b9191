# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Directions that put a question to a material: views down to the horizon, micronormals that it has, and lights that are
reflected or refracted by them, backscattered, mirrored or anywhere. In doubles, for inputs only: nothing is judged by them.
"""
import math

VIEWS = ("normal", 30, 60, 85, 89.99, "horizon")


def view(rng, kind):
    phi = rng.uniform(0, 2 * math.pi)
    if kind == "normal":
        return [0.0, 0.0, 1.0]
    if kind == "horizon":
        return [math.cos(phi), math.sin(phi), 1e-9]
    theta = math.radians(kind)
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


def dot(v, w):
    return sum(x * y for x, y in zip(v, w))


def unit(v):
    # scaled first: slopes of 1e200 occur
    most = max(map(abs, v))
    norm = math.hypot(*(x / most for x in v))
    return [x / most / norm for x in v]


def matrix(material):
    """Rows of the composed M, and t."""
    M = material.get("transform", [[1.0, 0.0], [0.0, 1.0]])
    if "alpha_x" in material and material["ndf"] != "ellipsoid":
        ax, ay = material["alpha_x"], material["alpha_y"]
        alpha = material.get("alpha", math.sqrt(ax * ay))
        c, s = math.cos(material.get("rotation", 0)), math.sin(material.get("rotation", 0))
        p, q = alpha / ax, alpha / ay
        Ma = [[c * c * p + s * s * q, c * s * (p - q)], [c * s * (p - q), s * s * p + c * c * q]]
        M = [[sum(M[i][k] * Ma[k][j] for k in range(2)) for j in range(2)] for i in range(2)]
    return M, material.get("tilt", [0.0, 0.0])


def ellipsoid_rows(material):
    if "A" in material:
        return material["A"]
    (cx, sx), (cy, sy), (cz, sz) = ((math.cos(material[k]), math.sin(material[k])) for k in ("theta_x", "theta_y", "theta_z"))
    R = [[cy * cz, -cy * sz, sy], [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
         [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy]]
    return [[e * scale for e in row] for row, scale in zip(R, (material["alpha_x"], material["alpha_y"], 1))]


def width(material):
    """A typical slope of the family."""
    if material["ndf"] == "phong":
        return math.sqrt(2 / (material["exponent"] + 2))
    if material["ndf"] == "sheen":
        return 1 / math.sqrt(material["alpha"])
    return material.get("alpha", math.sqrt(material.get("alpha_x", 1) * material.get("alpha_y", 1)))


def micronormal(rng, material, wo):
    """A normal that the material has, mostly facing the viewer (who is above: wo_z > 0)."""
    if material["ndf"] == "ellipsoid":
        p = unit([rng.gauss(0, 1) for _ in range(3)])
        A = ellipsoid_rows(material)
        u = [sum(A[k][i] * p[k] for k in range(3)) for i in range(3)]
        u = [e * math.copysign(1, u[2]) for e in u]
    elif material["ndf"] == "tabulated":  # somewhere in a cell that is not empty
        rows, (x0, x1, y0, y1) = material["histogram"]["weights"], material["histogram"]["bounds"]
        j, i = rng.choice([(j, i) for j, row in enumerate(rows) for i, weight in enumerate(row) if weight > 0])
        u = [-(x0 + (i + rng.random()) * (x1 - x0) / len(rows[0])), -(y0 + (j + rng.random()) * (y1 - y0) / len(rows)), 1.0]
    else:
        size, phi = width(material) * rng.choice((0.0, 0.5, 1.0, 3.0, 30.0)), rng.uniform(0, 2 * math.pi)
        u = [-size * math.cos(phi), -size * math.sin(phi), 1.0]
    M, t = matrix(material)
    (a, c), (b, d) = M
    det = a * d - b * c
    x, y = u[0] - t[0] * u[2], u[1] - t[1] * u[2]  # B^-T u
    m = [(d * x - b * y) / det, (a * y - c * x) / det, u[2]]
    if not all(map(math.isfinite, m)) or not any(m):
        return [0.0, 0.0, 1.0]
    m = unit(m)
    if dot(m, wo) < 0 and rng.random() < 0.8:
        m = [-m[0], -m[1], m[2]]
    return m if m[2] > 0 else [m[0], m[1], 1e-9]


def refract(wo, m, eta):
    """wi on the other side, or None; eta = n_i / n_o."""
    c = dot(wo, m)
    square = 1 - (1 - c * c) / (eta * eta)
    if c <= 0 or square <= 0:
        return None
    wi = unit([(c / eta - math.sqrt(square)) * y - x / eta for x, y in zip(wo, m)])
    return wi if wi[2] < 0 else None


def light(rng, material, wo, wm, eta=None):
    """wi and what it is; with eta = n_i/n_o, two of three on the other side."""
    if eta and rng.random() < 0.67:
        wi = refract(wo, wm, eta)
        if wi and rng.random() < 0.8:
            return wi, "refracted"
        kind = rng.choice(VIEWS)
        wi = view(rng, kind)
        return [wi[0], wi[1], -wi[2]], f"below {kind}"
    how = rng.random()
    if how < 0.15:
        return list(wo), "backscatter"
    if how < 0.25:
        return [-wo[0], -wo[1], wo[2]], "mirror"
    if how < 0.8:
        along = 2 * dot(wo, wm)
        wi = [along * m - o for m, o in zip(wm, wo)]
        if wi[2] > 0:
            return wi, "reflected"
    kind = rng.choice(VIEWS)
    return view(rng, kind), str(kind)


def scaled(rng, v):
    factor = rng.choice((1.0, 1.0, 3.7, 1e3))
    return [x * factor for x in v]


def ask(rng, material, kind, below=False):
    """One line of input: wo, wm, wi for this material, viewed from `kind`, or from that below the surface."""
    wo = view(rng, kind)
    eta = None
    if material.get("transmission"):
        eta = material["fresnel"]["dielectric"] ** (-1 if below else 1)
    wm = micronormal(rng, material, wo)
    wi, how = light(rng, material, wo, wm, eta)
    sign = -1 if below else 1
    wo, wm, wi = (scaled(rng, [sign * x for x in v]) for v in (wo, wm, wi))
    return {"material": {"material": "musurf.microfacet", **material}, "wo": wo, "wm": wm, "wi": wi}, how
