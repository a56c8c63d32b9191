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
    return floats(mesh.loops, "normal", 3)


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
