"""Lamps, in Cycles' units: a point's W go evenly over the sphere, an area's radiance is W / (4 area), a sun's
strength is W/m^2. Lamps with a size are shapes that no ray meets, as Cycles' lamps hide from the camera and cast no
shadow."""

import math

import bpy
import numpy as np

from . import cameras
from .nodes import Graph, source
from .passes import group_of

_DISK_SIDES = 64


def _color(lamp, notes, name):
    """Energy and colour, with those of its nodes."""
    color = np.array(lamp.color, np.float64) * lamp.energy
    if lamp.use_nodes and lamp.node_tree:
        output = lamp.node_tree.get_output_node("CYCLES")
        emission, _, path = source(output.inputs["Surface"], ()) if output else (None, None, ())
        if emission is None:
            return np.zeros(3)
        if emission.node.type != "EMISSION":
            notes.say(f'lamp "{name}": node "{emission.node.bl_label}" is not translated, an even Emission stands in')
            return color
        graph = Graph(f'lamp "{name}"', notes)
        strength = emission.node.inputs["Strength"]
        falloff, _, inside = source(strength, path)
        if falloff is not None and falloff.node.type == "LIGHT_FALLOFF":
            if falloff.name != "Quadratic" or graph.number(falloff.node.inputs["Smooth"], inside) > 0:
                graph.skip(falloff.node, "light falls off with the square of the distance")
            strength, path_of_strength = falloff.node.inputs["Strength"], inside
        else:
            path_of_strength = path
        color = color * graph.color(emission.node.inputs["Color"], path) * graph.number(strength, path_of_strength)
    return color


_VISIBILITIES = {"visible_diffuse": "diffuse", "visible_glossy": "glossy", "visible_transmission": "transmission"}


def _tell(lamp_object, notes):
    hidden = [kind for name, kind in _VISIBILITIES.items() if not getattr(lamp_object, name)]
    if hidden:
        notes.say(f'lamp "{lamp_object.name}": it is hidden from {", ".join(hidden)} rays in Blender, and seen by all here')
    cycles = getattr(lamp_object.data, "cycles", None)
    if cycles and not cycles.cast_shadow:
        notes.say(f'lamp "{lamp_object.name}": what it lights casts shadows here')


def _point(scene, lamp_object, matrix, color, notes):
    lamp, radius = lamp_object.data, lamp_object.data.shadow_soft_size
    if radius > 0:
        radiance = color / (4 * math.pi ** 2 * radius ** 2)
        place = np.eye(4)
        place[:3, 3] = matrix[:3, 3]
        scene.shape("sphere", {"float radius": radius, "float alpha": 0}, world_from_shape=place,
                    light={"rgb L": radiance, **group_of(lamp_object)})
    else:
        scene.light("point", {"rgb I": color / (4 * math.pi), "point3 from": matrix[:3, 3], **group_of(lamp_object)})


def _spot(scene, lamp_object, matrix, color, notes):
    lamp = lamp_object.data
    half = lamp.spot_size / 2
    # Cycles' edge is smooth in the cosine, over this share of what lies between axis and edge.
    full = math.acos(min(1.0, math.cos(half) + (1 - math.cos(half)) * lamp.spot_blend))
    if lamp.shadow_soft_size > 0.1:
        notes.say(f'lamp "{lamp_object.name}": spots have no size here, their shadows are sharp')
    at = matrix[:3, 3]
    scene.light("spot", {"rgb I": color / (4 * math.pi), "point3 from": at, "point3 to": at - matrix[:3, 2],
                         "float coneangle": math.degrees(half), "float conedeltaangle": math.degrees(half - full),
                         "bool cosine": bpy.app.version < (3, 5),  # Cycles' spots were dimmer off their axis
                         **group_of(lamp_object)})


def _sun(scene, lamp_object, matrix, color, notes):
    scene.light("distant", {"rgb L": color, "float angle": math.degrees(lamp_object.data.angle),
                            "point3 from": (0, 0, 0), "point3 to": -matrix[:3, 2], **group_of(lamp_object)})


def _area(scene, lamp_object, matrix, color, notes):
    lamp = lamp_object.data
    size = np.array([lamp.size, lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size]) / 2
    if lamp.spread < math.pi - 1e-3:
        notes.say(f'lamp "{lamp_object.name}": its spread is not translated, it shines to all sides')
    if lamp.shape in ("DISK", "ELLIPSE"):
        angles = np.arange(_DISK_SIDES) * (2 * math.pi / _DISK_SIDES)
        size = size * math.sqrt(2 * math.pi / _DISK_SIDES / math.sin(2 * math.pi / _DISK_SIDES))  # the disk's area
        corners = np.stack([np.cos(angles), np.sin(angles)], 1)
    else:
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    positions = np.zeros((len(corners), 3))
    positions[:, :2] = corners * size
    positions = positions @ matrix[:3, :3].T + matrix[:3, 3]
    fan = np.array([[0, k + 1, k] for k in range(1, len(corners) - 1)], np.int32)  # its front faces -z
    if np.linalg.det(matrix[:3, :3]) < 0:
        fan = fan[:, ::-1].copy()
    edges = positions[fan[:, 1:]] - positions[fan[:, :1]]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum() / 2
    if area > 0:
        scene.shape("trianglemesh", {"point3 P": positions, "integer indices": fan, "float alpha": 0},
                    light={"rgb L": color / (4 * area), **group_of(lamp_object)})


def add_lamp(scene, lamp_object, matrix, notes):
    """Adds a Blender object of the type LIGHT, at a 4 x 4 matrix."""
    cycles = getattr(lamp_object.data, "cycles", None)
    if lamp_object.data.type == "AREA" and cycles and cycles.is_portal:
        notes.say(f'lamp "{lamp_object.name}": a portal does not shine, and guides nothing here')
        return
    color = _color(lamp_object.data, notes, lamp_object.name)
    if (color < 0).any():
        notes.say(f'lamp "{lamp_object.name}": light below 0 is not translated')
        color = np.maximum(color, 0)
    if not (color > 0).any():
        return
    _tell(lamp_object, notes)
    kind = lamp_object.data.type
    {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}[kind](
        scene, lamp_object, matrix if kind == "AREA" else cameras.unscaled(matrix), color, notes)
