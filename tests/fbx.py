# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Writes FBX 7.4 files as text: one mesh with blend shapes, a chain of bones and one animation of them."""
import numpy as np

TICKS = 46186158000  # per second


def numbers(values):
    return ",".join(f"{float(x):.17g}" if isinstance(x, (float, np.floating)) else str(x) for x in np.ravel(values).tolist())


def array(name, values):
    return f"{name}: *{np.size(values)} {{\na: {numbers(values)}\n}}\n"


def vector(name, kind, values):
    return f'P: "{name}", "{kind}", "", "A",{numbers(np.asarray(values, float))}\n'


def properties(*rows):
    return "Properties70: {\n" + "".join(rows) + "}\n"


class Writer:
    def __init__(self):
        self.objects, self.connections, self.last = "", "", 1000

    def add(self, kind, name, sort, content):
        self.last += 1
        self.objects += f'{kind}: {self.last}, "{name}", "{sort}" {{\n{content}}}\n'
        return self.last

    def connect(self, child, parent, slot=None):
        self.connections += f'C: "{"OP" if slot else "OO"}",{child},{parent}' + (f', "{slot}"' if slot else "") + "\n"

    def mesh(self, name, positions, uvs, faces):
        ends = np.array([[a, b, -c - 1] for a, b, c in faces])
        self.geometry = self.add("Geometry", f"Geometry::{name}", "Mesh", array("Vertices", positions) + array("PolygonVertexIndex", ends) +
                                 "GeometryVersion: 124\nLayerElementUV: 0 {\nVersion: 101\nName: \"map\"\nMappingInformationType: \"ByPolygonVertex\"\n"
                                 "ReferenceInformationType: \"IndexToDirect\"\n" + array("UV", uvs) + array("UVIndex", faces) + "}\n"
                                 "Layer: 0 {\nVersion: 100\nLayerElement: {\nType: \"LayerElementUV\"\nTypedIndex: 0\n}\n}\n")
        model = self.add("Model", f"Model::{name}", "Mesh", "Version: 232\n" + properties())
        self.connect(model, 0)
        self.connect(self.geometry, model)

    def shape(self, name, deltas):
        shape = self.add("Geometry", f"Geometry::{name}", "Shape", "Version: 100\n" + array("Indexes", np.arange(len(deltas))) +
                         array("Vertices", deltas) + array("Normals", 0 * deltas))
        blend = self.add("Deformer", f"Deformer::{name}", "BlendShape", "Version: 100\n")
        channel = self.add("Deformer", f"SubDeformer::{name}", "BlendShapeChannel", "Version: 100\nDeformPercent: 0\n" + array("FullWeights", [100.0]))
        self.connect(blend, self.geometry)
        self.connect(channel, blend)
        self.connect(shape, channel)

    def bones(self, bones, weights):
        """bones: (name, translation, degrees, scaling, matrix in the world when bound), each the child of the last."""
        skin, parent, models = self.add("Deformer", "Deformer::skin", "Skin", "Version: 101\n"), 0, []
        self.connect(skin, self.geometry)
        for (name, move, turn, scale, world), weight in zip(bones, weights.T):
            rows = vector("Lcl Translation", "Lcl Translation", move), vector("Lcl Rotation", "Lcl Rotation", turn), vector("Lcl Scaling", "Lcl Scaling", scale)
            model = self.add("Model", f"Model::{name}", "LimbNode", "Version: 232\n" + properties(*rows))
            cluster = self.add("Deformer", f"SubDeformer::{name}", "Cluster", "Version: 100\n" + array("Indexes", np.arange(len(weight))) +
                               array("Weights", weight) + array("Transform", np.linalg.inv(world).T) + array("TransformLink", world.T))
            self.connect(model, parent)
            self.connect(cluster, skin)
            self.connect(model, cluster)
            models.append(model)
            parent = model
        return models

    def animation(self, name, times, tracks):
        """tracks: (model, "Lcl Rotation" or the like, three values per time)."""
        span = f'P: "LocalStop", "KTime", "Time", "",{int(max(times) * TICKS)}\n'
        stack, layer = self.add("AnimationStack", f"AnimStack::{name}", "", properties(span)), self.add("AnimationLayer", "AnimLayer::base", "", "")
        self.connect(layer, stack)
        for model, slot, values in tracks:
            node = self.add("AnimationCurveNode", "AnimCurveNode::" + slot[4], "", "")
            self.connect(node, layer)
            self.connect(node, model, slot)
            for axis, column in zip("XYZ", np.asarray(values, float).T):
                curve = self.add("AnimationCurve", "AnimCurve::", "", "KeyVer: 4008\n" + array("KeyTime", [int(t * TICKS) for t in times]) +
                                 array("KeyValueFloat", column))
                self.connect(curve, node, "d|" + axis)

    def finish(self):
        head = ("; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\n"
                "GlobalSettings: {\nVersion: 1000\n" + properties('P: "UpAxis", "int", "Integer", "",1\n', 'P: "UnitScaleFactor", "double", "Number", "",1\n') + "}\n")
        return head + "Definitions: {\nVersion: 100\n}\nObjects: {\n" + self.objects + "}\nConnections: {\n" + self.connections + "}\n"
