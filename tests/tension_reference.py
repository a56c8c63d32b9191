# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The tension of a mesh of one chart by the definitions of core/tension (site.h, quadric.h, direction.h), written anew."""
import math

import numpy as np


def frame(p, uv):
    """Edges of a triangle as columns of a matrix, in the frame of dp/du and the winding's normal."""
    edges, parameters = (p[1:] - p[0]).T, (uv[1:] - uv[0]).T
    t = edges @ np.linalg.inv(parameters)[:, 0]
    t /= np.linalg.norm(t)
    n = np.cross(edges[:, 0], edges[:, 1])
    return np.stack([t, np.cross(n / np.linalg.norm(n), t)]) @ edges


def power(symmetric, function):
    values, vectors = np.linalg.eigh(symmetric)
    return vectors @ np.diag(function(values)) @ vectors.T


def unit(v):
    return v / np.linalg.norm(v)


def turned(n, face):
    """Of a triangle's u direction, its plane turned about the line it has in common with that of n, to there."""
    axis, cosine = np.cross(face.n, n), face.n @ n
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return (np.eye(3) + k + k @ k / (1 + cosine)) @ face.t  # Rodrigues' formula


class Face:
    def __init__(self, rest, deformed, uv, corners):
        r, d = frame(rest[corners], uv[corners]), frame(deformed[corners], uv[corners])
        self.corners, self.m = list(corners), d @ np.linalg.inv(r)
        self.log = power(self.m.T @ self.m, lambda x: np.log(x) / 2)
        p = rest[corners]
        cross = np.cross(p[1] - p[0], p[2] - p[0])
        self.n, edges = unit(cross), (p[1:] - p[0]).T
        self.t = unit(edges @ np.linalg.inv((uv[corners][1:] - uv[corners][0]).T)[:, 0])
        sides = [[unit(p[(k + i) % 3] - p[k]) for i in (1, 2)] for k in range(3)]
        self.angle = [math.acos(a @ b) for a, b in sides]
        self.weight = [np.linalg.norm(cross) * angle for angle in self.angle]


class Vertex:
    """M of a vertex in a mesh of one chart, as core/tension defines it: site.h, fit by quadric.h, direction.h."""

    def __init__(self, v, rest, deformed, uv, faces):
        self.v, self.data = v, (rest, deformed, uv)
        self.all, self.near = faces, [face for face in faces if v in face.corners]
        self.n = unit(sum(face.angle[face.corners.index(v)] * face.n for face in self.near))
        first = self.near[0].corners
        edge = rest[first[(first.index(v) + 1) % 3]] - rest[v]
        self.s1 = unit(edge - edge @ self.n * self.n)
        self.s2 = np.cross(self.n, self.s1)

    def seen(self, face):
        t = turned(self.n, face)
        return np.array([t @ self.s1, t @ self.s2])

    def log(self, face):
        c, s = self.seen(face)
        turn = np.array([[c, -s], [s, c]])
        return turn @ face.log @ turn.T

    def patch(self, rings):
        if rings == 1:
            return self.near
        inside = {i for face in self.near for i in face.corners}
        return [face for face in self.all if inside & set(face.corners) and face.n @ self.n >= 0.5]

    def slopes(self, rings):
        rest, deformed, uv = self.data
        others = sorted({i for face in self.patch(rings) for i in face.corners} - {self.v})
        d = rest[others] - rest[self.v]
        x, y = d @ self.s1, d @ self.s2
        weight = 1 / np.linalg.norm(d, axis=1)[:, None]
        terms = weight * np.stack([x, y, x * x, x * y, y * y], 1)
        values = weight * np.column_stack([d @ self.n, deformed[others] - deformed[self.v], uv[others, 1] - uv[self.v, 1]])
        scaled = terms / np.linalg.norm(terms, axis=0)
        try:
            if np.diag(np.linalg.cholesky(scaled.T @ scaled)).min() ** 2 <= (0.04 if rings == 1 else 0.001):
                return None
        except np.linalg.LinAlgError:
            return None
        return np.linalg.lstsq(terms, values, rcond=None)[0][:2]

    def matrix(self):
        weights = [face.weight[face.corners.index(self.v)] for face in self.near]
        log = sum(w * self.log(face) for w, face in zip(weights, self.near)) / sum(weights)
        u = unit(sum(w * self.seen(face) for w, face in zip(weights, self.near)))
        slopes = next(s for s in (self.slopes(1), self.slopes(2)) if s is not None)
        p = np.stack([s + h * self.n for s, h in zip((self.s1, self.s2), slopes[:, 0])], 1)
        along = np.array([[1.0, 0], [0, 1]])  # the frame of p's first column, as if it were u
        m = frame(np.vstack([0 * p[:, 0], p.T]), np.vstack([[0, 0], along]))
        fitted = frame(np.vstack([0 * p[:, 0], slopes[:, 1:4]]), np.vstack([[0, 0], along])) @ np.linalg.inv(m)
        fitted = power(fitted.T @ fitted, lambda x: np.log(x) / 2)
        off = np.linalg.norm(fitted - log)
        most = [max(np.linalg.norm(self.log(face) - log) for face in self.patch(rings)) for rings in (1, 2)]
        most = next((x for x in most if x >= off), most[-1])
        log = log + min(1, most / off) * (fitted - log)
        d = unit(m @ np.array([slopes[1, 4], -slopes[0, 4]]))
        off = abs(np.cross(np.append(u, 0), np.append(d, 0))[2])
        most = [max(abs(u[0] * t[1] - u[1] * t[0]) for t in map(self.seen, self.patch(rings))) for rings in (1, 2)]
        most = next((x for x in most if x >= off), most[-1])
        if most < off:
            angle = math.copysign(math.asin(most), u[0] * d[1] - u[1] * d[0])
            d = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]) @ u
        turn = np.array([[d[0], -d[1]], [d[1], d[0]]])
        return np.linalg.cholesky(power(turn.T @ log @ turn, lambda x: np.exp(2 * x))).T


def reference(rest, deformed, uv, faces):
    """M of faces, and of vertices of one chart, by eigenvectors, numpy's least squares and Cholesky."""
    faces = [Face(rest, deformed, uv, np.asarray(face)) for face in faces]
    return (np.array([face.m for face in faces]),
            np.array([Vertex(v, rest, deformed, uv, faces).matrix() for v in range(len(rest))]))
