# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Camera, lights and world of a depsgraph as those of a scene file. Radiances as Cycles has them: a sun's strength is the irradiance on what
faces it; an area light of P watts and area A has the radiance P / (4 A), and P / (pi A) from Blender 4 on (measured in 3.4; 4.2, 4.5, 5.0)."""
import math
import os

import bpy
import numpy as np

LARGEST, SINGULAR = 1e9, 1e-9  # of the renderer: any number of a scene; |determinant| over the product of a map's columns
POINT = 1 / (4 * math.pi)
AREA = math.pi if bpy.app.version >= (4, 0, 0) else 4


def camera(thing, depsgraph, width, height, say):
    data, world, render = thing.data, thing.matrix_world, depsgraph.scene.render
    if data.type not in ("PERSP", "ORTHO"):
        say(f"the camera \"{thing.name}\" is of type {data.type}, which is not known here; it is perspective now")
    projection = thing.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    if abs(projection[0][2]) > 1e-6 or abs(projection[1][2]) > 1e-6 or (data.type == "ORTHO" and (data.shift_x or data.shift_y)):
        say(f"the camera \"{thing.name}\" is shifted; the shift is left out")
    if abs(projection[1][1] * height / (projection[0][0] * width) - 1) > 1e-4:
        say("pixels that are not square are not known here; they are square now")
    if data.dof.use_dof:
        say(f"the camera \"{thing.name}\" has a depth of field; all is sharp here")
    origin = world.translation
    found = {"position": list(origin), "target": list(origin - world.col[2].xyz.normalized()), "up": list(world.col[1].xyz.normalized())}
    if data.type == "ORTHO":
        return {"type": "orthographic", "height": 2 / projection[1][1], **found}
    return {"type": "perspective", "fov": math.degrees(2 * math.atan(1 / projection[1][1])), **found}


def rows(matrix):
    return [list(row) for row in matrix][:3]


def is_invertible(matrix):
    """What the renderer says of it (core/render/affine.c)."""
    found = np.array(rows(matrix))
    linear = found[:, :3]
    with np.errstate(all="ignore"):
        return bool(np.all(np.abs(found) <= LARGEST)
                    and abs(np.linalg.det(linear)) > SINGULAR * np.prod(np.linalg.norm(linear, axis=0)))


def is_light(numbers, what, say):
    """Whether the renderer takes it as light; lamps of Blender's may be negative."""
    if all(0 <= number <= LARGEST for number in numbers):
        return True
    say(f"{what} is negative or too bright; it is left out")
    return False


def light(data, matrix, name, say):
    """One for the list of lights, or None."""
    color = [c * data.energy for c in data.color]
    if not is_light(color, f"the light \"{name}\"", say):
        return None
    if data.use_nodes and data.node_tree:
        say(f"the light \"{name}\" has nodes; they are left out")
    if data.type == "SUN":
        if data.angle > math.radians(1):
            say(f"the sun \"{name}\" is {math.degrees(data.angle):.2g} degrees wide; it is a point here")
        return {"type": "directional", "direction": list(matrix.col[2].xyz.normalized()), "irradiance": color}
    if data.type in ("POINT", "SPOT"):
        return point(data, matrix, color, name, say)
    if data.type != "AREA" or data.shape not in ("SQUARE", "RECTANGLE"):
        say(f"the light \"{name}\" is of type {data.type.lower()}{', ' + data.shape.lower() if data.type == 'AREA' else ''}: only suns, points, spots, and square or "
            "rectangular areas are known here; it is left out")
        return None
    size = [data.size, data.size if data.shape == "SQUARE" else data.size_y]
    scale = [matrix.col[i].xyz.length for i in range(3)]
    if min(scale) == 0 or min(size) <= 0:
        say(f"the light \"{name}\" has no area; it is left out")
        return None
    size = [size[0] * scale[0], size[1] * scale[1]]
    radiance = [c / (AREA * size[0] * size[1]) for c in color]
    if not is_light(radiance, f"the light \"{name}\"", say):
        return None
    # ours shines along its +z: turned about its x axis
    axes = [matrix.col[i].xyz / scale[i] for i in range(3)]
    place = [[axes[0][k], -axes[1][k], -axes[2][k], matrix.translation[k]] for k in range(3)]
    return {"type": "rectangle", "size": size, "radiance": radiance, "transform": place}


def point(data, matrix, color, name, say):
    """A point or spot lamp."""
    if data.shadow_soft_size > 0:
        say(f"the light \"{name}\" is a ball of radius {data.shadow_soft_size:.2g}; it is a point here, and its shadows are sharp")
    made = {"type": "point", "position": list(matrix.translation), "intensity": [c * POINT for c in color]}
    if data.type == "SPOT":
        made |= {"direction": list(-matrix.col[2].xyz.normalized()), "angle": math.degrees(data.spot_size), "blend": data.spot_blend}
    return made


def linked(socket, kinds):
    """The node behind a socket, if it is of one of these types."""
    node = socket.links[0].from_node if socket.is_linked else None
    return node if node and node.type in kinds else None


def turn_of(node, say):
    """Degrees about +z of an environment picture's vector."""
    mapping = linked(node.inputs["Vector"], ("MAPPING",))
    if not mapping:
        return 0.0
    turned = mapping.inputs["Rotation"].default_value
    if abs(turned[0]) > 1e-6 or abs(turned[1]) > 1e-6 or any(abs(s - 1) > 1e-6 for s in mapping.inputs["Scale"].default_value):
        say("the world's mapping does more than turn about z; only that is known here")
    return math.degrees(-turned[2])  # the vector is turned, and the picture the other way


def world(data, path_of, say):
    """What surrounds the scene, or None for darkness."""
    found = surrounding(data, path_of, say)
    return found if found and is_light(found.get("radiance") or found["scale"], "the world", say) else None


def surrounding(data, path_of, say):
    if not data:
        return None
    if not data.use_nodes or not data.node_tree:
        return {"type": "constant", "radiance": list(data.color)}
    output = next((n for n in data.node_tree.nodes if n.type == "OUTPUT_WORLD" and n.is_active_output), None)
    node = linked(output.inputs["Surface"], ("BACKGROUND",)) if output else None
    if not node:
        if output and output.inputs["Surface"].is_linked:
            say("the world has nodes that are not known here: a Background with a color or an environment picture is; it is black")
        return None
    strength, color = node.inputs["Strength"].default_value, node.inputs["Color"]
    picture = linked(color, ("TEX_ENVIRONMENT",))
    if color.is_linked and not (picture and picture.image and picture.projection == "EQUIRECTANGULAR"):
        say("the world's color comes from nodes that are not known here: an equirectangular environment picture is; the socket's own color serves")
        picture = None
    if picture:
        path = path_of(picture.image)
        space = picture.image.colorspace_settings.name
        if picture.image.is_float and not (space.startswith("Linear") or space in ("Non-Color", "Raw")):
            say(f"the world's picture \"{picture.image.name}\" has floats of the color space {space}; they are taken as linear")
        if path and os.path.exists(path):
            return {"type": "environment", "image": path, "rotation": turn_of(picture, say), "scale": [strength] * 3}
        say(f"the world's picture \"{picture.image.name}\" has no file{': ' + path if path else ''}; the world is black")
        return None
    found = [c * strength for c in list(color.default_value)[:3]]
    return {"type": "constant", "radiance": found} if np.any(found) else None
