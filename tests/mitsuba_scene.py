# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A scene file of musurf as Mitsuba's, as far as scenes/hosts.json goes: spheres, rectangles, a lamp and light from everywhere; materials by
their files, which BSDFs read as they are. Run in Mitsuba's Python:

    mitsuba_scene.py SCENE OUT.npy WIDTHxHEIGHT SAMPLES COUNT SEED
"""
import json
import pathlib
import sys

import mitsuba_host


def transform_of(mi, steps):
    """The first acts first."""
    T, whole = mi.ScalarTransform4f, mi.ScalarTransform4f()
    for step in steps:
        (kind, value), = step.items()
        whole = {"translate": lambda: T().translate(value), "scale": lambda: T().scale(value),
                 "rotate": lambda: T().rotate(value[:3], value[3])}[kind]() @ whole
    return whole


def shape_of(mi, thing):
    placed = transform_of(mi, thing.get("transform", []))
    if thing.get("shape") == "sphere":
        return {"type": "sphere", "to_world": placed @ mi.ScalarTransform4f().scale(thing["radius"])}
    x, y = thing["size"]
    return {"type": "rectangle", "to_world": placed @ mi.ScalarTransform4f().scale([x / 2, y / 2, 1])}  # Mitsuba's spans 2 x 2


def scene_of(mi, path, width, height):
    scene = json.loads(path.read_text())
    camera, integrator = scene["camera"], scene["integrator"]
    found = {"type": "scene",
             "integrator": {"type": "path", "max_depth": integrator["depth"] + 1, "rr_depth": integrator["roulette"]},
             "sensor": {"type": "perspective", "fov": camera["fov"], "fov_axis": "y",
                        "to_world": mi.ScalarTransform4f().look_at(camera["position"], camera["target"], [0, 0, 1]),
                        "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}}}}
    for i, thing in enumerate(scene["objects"]):
        file = path.parent / scene["materials"][thing["material"]]["file"]
        found[f"object{i}"] = {**shape_of(mi, thing), "bsdf": {"type": "musurf", "file": str(file)}}
    for i, light in enumerate(scene["lights"]):
        radiance = {"type": "rgb", "value": light["radiance"]}
        if light["type"] == "constant":
            found[f"light{i}"] = {"type": "constant", "radiance": radiance}
        else:
            found[f"light{i}"] = {**shape_of(mi, light), "emitter": {"type": "area", "radiance": radiance}}
    return mi.load_dict(found)


def main():
    mi, musurf_mitsuba = mitsuba_host.enter()
    import numpy as np
    path, out, size, samples, count, seed = sys.argv[1:]
    heard = mitsuba_host.listen(mi)
    scene = scene_of(mi, pathlib.Path(path), *map(int, size.split("x")))
    with musurf_mitsuba.evaluated():
        pictures = [np.array(mi.render(scene, spp=int(samples), seed=int(seed) + i)) for i in range(int(count))]
    np.save(out, np.stack(pictures))
    sys.exit("\n".join(heard) or 0)  # there is nothing to warn of


if __name__ == "__main__":
    main()
