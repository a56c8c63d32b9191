# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A musurf material as nodes of Cycles, where there is an equal: GGX under one M, as glossy BSDF with anisotropy and rotation.

The map M takes slopes p to M^-T p, so slopes of covariance alpha^2 / 2 become (alpha^2 / 2) (M M^T)^-1. With M = U S V^T its axes are the columns
u_i of U, and the roughness along them is alpha / s_i. Cycles has, along the tangent turned by 2 pi "rotation", r^2 (1 - a), and across it
r^2 / (1 - a), for a >= 0; so the smoother axis is along, r^2 = alpha / sqrt(s_1 s_2), and 1 - a = sqrt(s_2 / s_1)."""
import math

import numpy as np

from . import material

MOST = 0.99  # Cycles' limit of anisotropy
HEIGHT_CORRELATED = (3, 5, 0)  # from this Blender on Cycles' masking


class NotThere(Exception):
    """Why a material has no equal in Cycles, in one line."""


def map_of(described):
    """M of a described material: transform, alpha_x and alpha_y with rotation (M_a acts first)."""
    known = {"material", "ndf", "alpha", "roughness", "transform", "fresnel", "masking", "alpha_x", "alpha_y", "rotation", "sampler"}
    for name in described:
        if name not in known:
            raise NotThere(f"{name}: has no equal in Cycles")
    if any(isinstance(value, dict) and "texture" in value for value in described.values()):
        raise NotThere("images of parameters have no equal in Cycles")
    if described["material"] != "musurf.microfacet" or described.get("ndf", "ggx") != "ggx":
        raise NotThere("only GGX has an equal in Cycles")
    m = np.array(described.get("transform", [[1, 0], [0, 1]]), dtype=float)
    alpha = described.get("alpha", described["roughness"] ** 2 if "roughness" in described else 0.3)
    if "alpha_x" in described or "alpha_y" in described:
        if not ("alpha_x" in described and "alpha_y" in described):
            raise NotThere("alpha_x and alpha_y are needed both")
        x, y = described["alpha_x"], described["alpha_y"]
        if "alpha" not in described and "roughness" not in described:
            alpha = math.sqrt(x * y)
        turn = described.get("rotation", 0.0)
        r = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        m = m @ r @ np.diag([alpha / x, alpha / y]) @ r.T
    return alpha, m


def parameters(alpha, m):
    """(roughness, anisotropy, rotation in turns) of Cycles."""
    u, s, _ = np.linalg.svd(m)
    if not s[1] > 0:
        raise NotThere("the transform is singular")
    anisotropy = 1 - math.sqrt(s[1] / s[0])
    if anisotropy > MOST:
        raise NotThere(f"an anisotropy of {anisotropy:.4f} is beyond Cycles' {MOST}")
    return math.sqrt(alpha / math.sqrt(s[0] * s[1])), anisotropy, math.atan2(u[1, 0], u[0, 0]) / (2 * math.pi) % 0.5


def reflectance(described):
    fresnel = described.get("fresnel", "none")
    if fresnel != "none":
        raise NotThere("a Fresnel term has no equal in Cycles' glossy BSDF: without one (fresnel none) it has")
    return (1.0, 1.0, 1.0, 1.0)


def write(one):
    """Gives the material nodes."""
    group = one.musurf.group()
    if group is None or one.musurf.file:
        raise NotThere("its parameters are not in this file")
    described = material.write(group, lambda image: image.filepath, lambda text: None)
    roughness, anisotropy, rotation = parameters(*map_of(described))
    color = reflectance(described)
    one.use_nodes = True
    nodes, links = one.node_tree.nodes, one.node_tree.links
    nodes.clear()
    glossy, tangent, output = (nodes.new(kind) for kind in ("ShaderNodeBsdfAnisotropic", "ShaderNodeTangent", "ShaderNodeOutputMaterial"))
    glossy.distribution = "GGX"
    tangent.direction_type = "UV_MAP"
    for name, value in (("Color", color), ("Roughness", roughness), ("Anisotropy", anisotropy), ("Rotation", rotation)):
        glossy.inputs[name].default_value = value
    links.new(tangent.outputs["Tangent"], glossy.inputs["Tangent"])
    links.new(glossy.outputs["BSDF"], output.inputs["Surface"])
    glossy.location, tangent.location, output.location = (0, 0), (-250, -150), (250, 0)
