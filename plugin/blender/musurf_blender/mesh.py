# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Evaluated meshes as OBJ files, vertices and faces in Blender's order: two shapes of one mesh give two files that differ in their positions
alone, which is what tension is measured between. Positions and normals are in the object's own space."""
import numpy as np


def floats(collection, name, width):
    found = np.empty(len(collection) * width, dtype=np.float32)
    collection.foreach_get(name, found)
    return found.reshape(-1, width)


def integers(collection, name):
    found = np.empty(len(collection), dtype=np.int32)
    collection.foreach_get(name, found)
    return found


def corner_normals(mesh):
    if hasattr(mesh, "corner_normals"):  # from Blender 4.1 on
        return floats(mesh.corner_normals, "vector", 3)
    mesh.calc_normals_split()
    found = floats(mesh.loops, "normal", 3)
    mesh.free_normals_split()
    return found


def texture_coordinates(mesh):
    """Of the layer that renders; None without one."""
    layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    return floats(layer.data, "uv", 2) if layer and len(layer.data) == len(mesh.loops) else None


class Shape:
    """A mesh as arrays."""

    def __init__(self, mesh):
        self.positions = floats(mesh.vertices, "co", 3)
        self.vertex = integers(mesh.loops, "vertex_index")
        self.first, self.total = integers(mesh.polygons, "loop_start"), integers(mesh.polygons, "loop_total")
        self.slot = integers(mesh.polygons, "material_index")
        self.normals, self.uvs = corner_normals(mesh), texture_coordinates(mesh)
        self.solid = self.with_area()

    def with_area(self):
        """Whether each face has an area: what the renderer calls a flat triangle, of twice the area at most 2^-23 of its longest edge squared, leaves out
        none of these. A face of n corners is n - 2 triangles, one of which has its share of the area; its edges are at most twice as long as its
        farthest corner is away from the first, and the 2 more is for sums in floats."""
        if len(self.first) == 0:
            return np.zeros(0, dtype=bool)
        corner = np.arange(len(self.vertex))
        face = np.repeat(np.arange(len(self.first)), self.total)
        corner = self.first[face] + (corner - np.repeat(np.cumsum(self.total) - self.total, self.total))
        following = np.where(corner + 1 < (self.first + self.total)[face], corner + 1, self.first[face])
        origin = self.positions[self.vertex[self.first[face]]].astype(float)
        here, there = self.positions[self.vertex[corner]] - origin, self.positions[self.vertex[following]] - origin
        twice, reach = np.zeros((len(self.first), 3)), np.zeros(len(self.first))
        np.add.at(twice, face, np.cross(here, there))
        np.maximum.at(reach, face, (here ** 2).sum(axis=1))
        return np.linalg.norm(twice, axis=1) > (self.total - 2) * 2.0 ** -22 * 4 * reach

    def same_faces(self, other):
        return (len(self.positions) == len(other.positions) and np.array_equal(self.vertex, other.vertex)
                and np.array_equal(self.first, other.first) and np.array_equal(self.total, other.total))


def lines(letter, rows):
    form = letter + " %.9g" * rows.shape[1] + "\n"
    return "".join([form % tuple(row) for row in rows.tolist()])


def write(path, shape, slot, positions=None):
    """The faces of one material slot; with other positions: the same mesh in another shape."""
    where = shape.positions if positions is None else positions
    faces = np.flatnonzero(shape.slot == slot)
    textured = shape.uvs is not None
    corner = [(f"{v}/{i}/{i}" if textured else f"{v}//{i}") for i, v in enumerate((shape.vertex + 1).tolist(), 1)]
    with open(path, "w", encoding="ascii") as file:
        file.write(lines("v", where))
        if textured:
            file.write(lines("vt", shape.uvs))
        file.write(lines("vn", shape.normals))
        for start, count in zip(shape.first[faces].tolist(), shape.total[faces].tolist()):
            file.write("f " + " ".join(corner[start:start + count]) + "\n")
