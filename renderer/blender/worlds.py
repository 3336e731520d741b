"""The world: light from all sides, one colour or a picture."""

import numpy as np

from . import node_math, pictures, skies
from .nodes import Graph, source
from .passes import group_of

_MIRRORED_X = np.diag([-1.0, 1.0, 1.0, 1.0])  # Blender's pictures of skies run the other way round


def _background(graph, socket, path):
    """The Background node that lights the scene."""
    output, _, path = source(socket, path)
    while output is not None and output.node.type in ("MIX_SHADER", "ADD_SHADER"):
        graph.skip(output.node, "the first background counts that it is linked to")
        linked = [s for s in output.node.inputs if s.type == "SHADER" and s.is_linked]
        if not linked:
            return None, path
        output, _, path = source(linked[-1], path)
    if output is None or output.node.type not in ("BACKGROUND", "EMISSION"):
        if output is not None:
            graph.skip(output.node, "there is no light from the world")
        return None, path
    return output.node, path


def _sky_picture(graph, socket, path, strength):
    """A picture of all directions behind a socket, how it is turned, and the node's sky or None."""
    output, _, path = source(socket, path)
    node = output.node
    if node.type != "TEX_SKY" and not (node.type == "TEX_ENVIRONMENT" and node.image):
        return None
    matrix = np.eye(4)
    if node.type == "TEX_ENVIRONMENT" and node.projection != "EQUIRECTANGULAR":
        graph.skip(node, "its picture is read as latitude and longitude")
    vector, _, path = source(node.inputs["Vector"], path)
    while vector is not None and vector.node.type == "MAPPING":
        matrix = matrix @ node_math.mapping_matrix(vector.node, lambda s, p=path: graph.constant(s, p), graph)
        vector, _, path = source(vector.node.inputs["Vector"], path)
    turn, _, other = np.linalg.svd(matrix[:3, :3])
    matrix[:3, :3], matrix[:3, 3] = turn @ other, 0  # what it does beyond turning has no meaning here
    sky = None
    if node.type == "TEX_SKY":
        if node.sky_type != "NISHITA":
            graph.skip(node, "Nishita's sky stands in for the other kinds, with this node's settings of that")
        sky = skies.Sky(node)
    pixels = sky.picture() if sky else pictures.linear_pixels(node.image, graph.notes)[..., :3]
    return pixels * np.float32(strength), matrix, sky if sky and node.sun_disc else None, node


def _add_sun(scene, sky, node, strength, world_from_picture, group):
    direction = world_from_picture[:3, :3] @ sky.sun_direction()
    irradiance = sky.sun_irradiance() * node.sun_intensity * strength
    if (irradiance > 0).any():
        scene.light("distant", {"rgb L": irradiance, "float angle": np.degrees(node.sun_size),
                                "point3 from": direction, "point3 to": (0, 0, 0), **group})


def add_world(scene, world, notes):
    if world is None:
        return
    if not world.use_nodes or not world.node_tree:
        color, picture = np.array(world.color), None
    else:
        graph = Graph(f'world "{world.name}"', notes)
        output = world.node_tree.get_output_node("CYCLES")
        node, path = _background(graph, output.inputs["Surface"], ()) if output else (None, ())
        if output and output.inputs["Volume"].is_linked:
            notes.say(f'world "{world.name}": its volume is not translated')
        if node is None:
            return
        strength = float(graph.number(node.inputs["Strength"], path))
        linked = source(node.inputs["Color"], path)[0]
        picture = _sky_picture(graph, node.inputs["Color"], path, strength) if linked else None
        color = graph.color(node.inputs["Color"], path) * strength if picture is None else None
    group = group_of(world)
    if picture is not None:
        pixels, picture_from_world, sky, node = picture
        scene.image("(world)", np.maximum(pixels[::-1], 0))
        scene.light("infinite", {"string filename": "(world)", **group},
                    world_from_light=np.linalg.inv(picture_from_world) @ _MIRRORED_X)
        if sky:
            _add_sun(scene, sky, node, strength, np.linalg.inv(picture_from_world), group)
    elif (color > 0).any():
        scene.light("infinite", {"rgb L": np.maximum(color, 0), **group})
