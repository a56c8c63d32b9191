# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Materials of a scene for `musurf check`: what its random ones are not. Written for tests to a file of their own."""
import json

MAPS = {"identity": [[1, 0], [0, 1]], "skew": [[1, 2], [0, 1]], "mirror": [[-1.5, 0.4], [0.3, 0.8]]}
GLASS = {"transmission": True, "fresnel": {"dielectric": 1.5}}
SAMPLERS = ("visible", "folded", "folded_uniform", "bounded", "visible_uniform", "ndf", "mixed", "auto")
MASKINGS = ("separable", "height_correlated", "direction_correlated")
TABLE = {"ndf": "tabulated", "histogram": {"bounds": [-0.5, 0.5, -0.5, 0.5], "weights": [[1, 2], [3, 4]]}}
FLAKES = {"ndf": "discrete_ggx", "alpha": 0.3, "flakes": {"density": 1e6, "cone": 0.02}}
# Each law of what these do beyond single scattering of smooth densities: a table's jumps (folded, which from above is visible
# normals), a tail that hardly ends, light turned up again, a smooth lobe, walks. The three maps take turns.
FEW = {"table": {**TABLE, "histogram": {"bounds": [-0.5, 0.5, -0.5, 0.5], "weights": [[1, 4], [5, 1]]}, "transform": MAPS["skew"],
                 "sampler": "folded"},
       "tail": {"ndf": "std", "alpha": 0.3, "gamma": 1.6, "transform": MAPS["mirror"]},
       "folded": {"ndf": "gtr", "alpha": 0.6, "gamma": 1, "sampler": "folded", "transform": MAPS["skew"]},
       "lobe": {"alpha": 0.6, "multiple_scattering": "compensated"},
       "walk": {"alpha": 0.6, "multiple_scattering": "random_walk", "transform": MAPS["mirror"], "fresnel": {"schlick": [0.9, 0.5, 0.2]}},
       "flakes": {**FLAKES, "transform": MAPS["mirror"]}}


def every():
    """All samplers, masking forms, a tilt, transmission, flakes, tables, long tails, lobes and walks, under each of the maps."""
    kinds = {f"sampler {s}": {"ndf": "ggx" if s == "bounded" else "gtr", "alpha": 0.4, "gamma": 2 if s == "bounded" else 1.3, "sampler": s}
             for s in SAMPLERS}
    for form in MASKINGS:
        kinds[f"masking {form}"] = {"ndf": "beckmann", "alpha": 0.4, "masking": form}
        kinds[f"tilted {form}"] = {"ndf": "beckmann", "alpha": 0.4, "masking": form, "tilt": [0.2, -0.1], "sampler": "folded"}
        kinds[f"glass {form}"] = {"ndf": "ggx", "alpha": 0.4, "masking": form, **GLASS}
    kinds |= {"tilted glass": {"ndf": "gtr", "alpha": 0.3, "gamma": 1.5, "tilt": [0.2, -0.1], **GLASS}, "flakes": FLAKES,
              "folded flakes": {**FLAKES, "ndf": "discrete_beckmann", "sampler": "folded"}, "table": TABLE,
              "folded table": {**TABLE, "sampler": "folded"}, "sheen": {"ndf": "sheen", "alpha": 0.3, "sampler": "folded_uniform"},
              "tail": {"ndf": "std", "alpha": 0.3, "gamma": 1.6}}
    for more in ("compensated", "random_walk"):
        kinds[more] = {"alpha": 0.6, "multiple_scattering": more, "fresnel": {"schlick": [0.9, 0.5, 0.2]}}
        kinds[f"{more} glass"] = {"ndf": "beckmann", "alpha": 0.5, "multiple_scattering": more, **GLASS}
    return {f"{name}, {turn}": {**kind, "transform": m} for name, kind in kinds.items() for turn, m in MAPS.items()}


def write(path, materials):
    path.write_text(json.dumps({"musurf": 1, "camera": {"position": [0, -3, 1], "target": [0, 0, 0]}, "objects": [],
                                "materials": {k: {"material": "musurf.microfacet", **m} for k, m in materials.items()}}))
    return path
