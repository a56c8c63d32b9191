# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Writes binary glTF 2.0 files: one mesh with morph targets, a skin and animations."""
import json
import struct

import numpy as np

FLOAT, SHORT, INT = 5126, 5123, 5125
KINDS = {FLOAT: "<f4", SHORT: "<u2", INT: "<u4"}


class Writer:
    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, values, component=FLOAT, bounds=False):
        """Number of a new accessor; the last axis are the components, a matrix' last two."""
        values = np.ascontiguousarray(values, KINDS[component])
        width = 1 if values.ndim == 1 else int(np.prod(values.shape[1:]))
        accessor = {"bufferView": len(self.views), "componentType": component, "count": len(values),
                    "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[width]}
        if bounds:
            accessor.update(min=np.atleast_1d(values.min(0)).tolist(), max=np.atleast_1d(values.max(0)).tolist())
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes})
        self.data += values.tobytes() + b"\0" * (-values.nbytes % 4)
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def animation(self, name, channels):
        """channels: (node, path, times, values)."""
        samplers = [{"input": self.add(times, bounds=True), "output": self.add(values)} for _, _, times, values in channels]
        return {"name": name, "samplers": samplers,
                "channels": [{"sampler": i, "target": {"node": node, "path": path}}
                             for i, (node, path, _, _) in enumerate(channels)]}

    def finish(self, **parts):
        text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "buffers": [{"byteLength": len(self.data)}],
                           "bufferViews": self.views, "accessors": self.accessors, **parts}).encode()
        text += b" " * (-len(text) % 4)
        return (struct.pack("<5I", 0x46546c67, 2, 28 + len(text) + len(self.data), len(text), 0x4e4f534a) + text +
                struct.pack("<2I", len(self.data), 0x004e4942) + self.data)
