"""Node trees as arrays: what a socket says, at one point where no picture is behind it, or at all points of a sheet of
picture coordinates. A colour is an array (..., 3), a number (...); both scene-linear."""

import numpy as np

from . import node_math, pictures, procedural, procedural_nodes

_LUMA = np.array([0.2126, 0.7152, 0.0722])
_LIGHT_PATH = {"Is Camera Ray": 1.0}  # as the eye meets it; other kinds of rays see that, too


class Sheet:
    """Points in the unit square of a material's picture coordinates, v from below."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
        self.points = np.stack([u, v], -1)


def source(socket, path):
    """The output that a socket is linked to, through groups, reroutes and muted nodes, with the groups that it is in;
    None, and the socket whose own value counts."""
    while True:
        if not socket.is_linked or not socket.links[0].is_valid or socket.links[0].is_muted:
            return None, socket, path
        output = socket.links[0].from_socket
        node = output.node
        if node.mute:
            link = next((link for link in node.internal_links if link.to_socket == output), None)
            if not link:
                return None, socket, path
            socket = link.from_socket
        elif node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.type == "GROUP" and node.node_tree:
            inner = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
            if not inner:
                return None, socket, path
            socket = next(s for s in inner.inputs if s.identifier == output.identifier)
            path = path + (node,)
        elif node.type == "GROUP_INPUT" and path:
            socket = next(s for s in path[-1].inputs if s.identifier == output.identifier)
            path = path[:-1]
        else:
            return output, socket, path


def _default(socket):
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float, bool)):
        return np.float64(value)
    if isinstance(value, str):
        return np.float64(0.0)
    return np.array(value[:3], np.float64)


def as_color(value, is_color):
    return value if is_color else np.repeat(np.asarray(value)[..., None], 3, axis=-1)


def as_number(value, is_color, is_vector=False):
    if not is_color:
        return value
    return value.mean(axis=-1) if is_vector else value @ _LUMA


class Graph:
    """The node tree of one material, world or lamp."""

    def __init__(self, name, notes):
        self.name = name
        self.notes = notes
        self._shared, self._depth = {}, 0  # values of outputs that are asked for more than once; how deep value is in itself

    def skip(self, node, stand_in):
        self.notes.say(f'{self.name}: node "{node.bl_label}" is not translated: {stand_in}')

    def pictures(self, socket, path=()):
        """The image nodes behind a socket, with the groups that they are in."""
        return [(node, inside) for node, inside in self.behind(socket, path) if node.type == "TEX_IMAGE" and node.image]

    def has_procedural(self, socket):
        """Whether there is what wants the places of the surface: a procedural texture that is translated."""
        return any(node.type in procedural.NODES for node, _ in self.behind(socket, ()))

    def varies(self, socket, path):
        """Whether a socket may say something else elsewhere on the surface."""
        return any(node.type in procedural.NODES or node.type in ("TEX_IMAGE", "TEX_COORD", "UVMAP")
                   for node, _ in self.behind(socket, path))

    def behind(self, socket, path=()):
        """The nodes behind a socket, with the groups that they are in; not those that place a picture."""
        found, seen, open_sockets = [], set(), [(socket, path)]
        while open_sockets:
            output, _, inside = source(*open_sockets.pop())
            if output is None or (output.node.as_pointer(), inside) in seen:
                continue
            node = output.node
            seen.add((node.as_pointer(), inside))
            found.append((node, inside))
            if node.type not in ("TEX_ENVIRONMENT", "TEX_COORD", "UVMAP") and not (node.type == "TEX_IMAGE" and node.image):
                open_sockets += [(s, inside) for s in node.inputs if s.enabled]
        return found

    def layout(self, node, path):
        """How a picture lies: ((source, name of the uv map, "FLAT" or "BOX"), affine matrix 3 x 4). Of what the matrix
        makes of the source's coordinates a flat picture takes the first two, a box the two across the face's axis."""
        matrix = np.eye(4)
        output, _, path = source(node.inputs["Vector"], path)
        while output is not None and output.node.type == "MAPPING":
            matrix = matrix @ node_math.mapping_matrix(output.node, lambda s: self.constant(s, path), self)
            output, _, path = source(output.node.inputs["Vector"], path)
        where = "UV", ""
        if output is not None:
            inner = output.node
            if inner.type == "UVMAP":
                where = "UV", inner.uv_map
            elif inner.type == "TEX_COORD" and output.name in ("UV", "Generated", "Object"):
                where = output.name.upper(), ""
                if inner.object:
                    self.skip(inner, "another object's coordinates are its own")
            else:
                self.skip(inner, "pictures lie by the uv map")
        projection = getattr(node, "projection", "FLAT")
        if projection not in ("FLAT", "BOX"):
            self.notes.say(f'{self.name}: a picture lies flat here, by no "{projection.lower()}"')
            projection = "FLAT"
        if projection == "BOX" and node.projection_blend > 0:
            self.notes.say(f"{self.name}: the sides of a picture's box are not blended")
        return (*where, projection), matrix[:3]

    def constant(self, socket, path):
        return self.value(socket, path, None)[0]

    def color(self, socket, path=(), sheet=None):
        return np.asarray(as_color(*self.value(socket, path, sheet)), np.float64)

    def number(self, socket, path=(), sheet=None):
        output = source(socket, path)[0]
        return np.asarray(as_number(*self.value(socket, path, sheet), output is not None and output.type == "VECTOR"),
                          np.float64)

    def vector(self, socket, path, sheet, otherwise):
        """Of an Atlas, (n, 3); otherwise: the coordinates where nothing is linked."""
        if source(socket, path)[0] is None:
            return sheet.coordinates(otherwise)
        return np.broadcast_to(self.color(socket, path, sheet), sheet.coordinates("OBJECT").shape)

    def value(self, socket, path, sheet):
        """A value, and whether it is a colour or vector."""
        output, own, inside = source(socket, path)
        if output is None:
            value = _default(own)
            return value, value.ndim > 0
        is_shared = len(output.links) > 1 or socket.links[0].from_socket != output
        key = output.as_pointer(), inside, id(sheet)
        if key in self._shared:
            return self._shared[key]
        self._depth += 1
        try:
            made = self._evaluate(output, inside, sheet)
        finally:
            self._depth -= 1
            if self._depth == 0:  # large arrays are not kept for long
                self._shared.clear()
        if is_shared and self._depth > 0:
            self._shared[key] = made
        return made

    def _evaluate(self, output, path, sheet):
        node = output.node
        kind = node.type
        if kind == "RGB":
            return np.array(output.default_value[:3]), True
        if kind == "VALUE":
            return np.float64(output.default_value), False
        if kind == "TEX_IMAGE":
            return self._picture(node, output, path, sheet)
        if kind == "LIGHT_PATH":
            self.skip(node, "all rays see what the camera's do")
            return np.float64(_LIGHT_PATH.get(output.name, 0.0)), False
        if hasattr(sheet, "coordinates"):
            made = self._evaluate_in_space(node, output, path, sheet)
            if made is not None:
                return made
        made = node_math.evaluate(self, node, output, path, sheet)
        if made is not None:
            return made
        if output.type == "RGBA":
            self.skip(node, "grey stands in")
            return np.full(3, 0.5), True
        if output.type == "VECTOR":
            self.skip(node, "a vector of 0 stands in")
            return np.zeros(3), True
        self.skip(node, "0.5 stands in" if kind.startswith("TEX_") else "0 stands in")
        return np.float64(0.5 if kind.startswith("TEX_") else 0.0), False

    def _evaluate_in_space(self, node, output, path, sheet):
        """What an Atlas knows, and no other sheet; None: nothing of it."""
        if node.type in procedural.NODES:
            key = output.as_pointer(), path
            if key not in sheet.kept:
                sheet.kept[key] = procedural_nodes.evaluate(self, node, output, path, sheet)
            return sheet.kept[key]
        if node.type == "UVMAP":
            return sheet.coordinates("UV", node.uv_map), True
        if node.type == "TEX_COORD" and output.name in ("UV", "Generated", "Object"):
            if node.object:
                self.skip(node, "another object's coordinates are its own")
            return sheet.coordinates(output.name.upper()), True
        if node.type == "MAPPING":
            matrix = node_math.mapping_matrix(node, lambda s: self.constant(s, path), self)
            return self.vector(node.inputs["Vector"], path, sheet, "OBJECT") @ matrix[:3, :3].T + matrix[:3, 3], True
        return None

    def _points_of_picture(self, node, path, sheet):
        if hasattr(sheet, "coordinates"):
            if node.projection != "FLAT":
                self.skip(node, "beside procedural textures it lies flat")
            return self.vector(node.inputs["Vector"], path, sheet, "UV")[:, :2]
        matrix = sheet.relative(self.layout(node, path)) if hasattr(sheet, "relative") else None
        return sheet.points if matrix is None else sheet.points @ matrix[:, :2].T + matrix[:, 2]

    def _picture(self, node, output, path, sheet):
        if not node.image or sheet is None:
            if node.image:
                self.skip(node, "of a constant its colour is magenta, and its alpha 1")
            return (np.array([1.0, 0.0, 1.0]), True) if output.name == "Color" else (np.float64(1.0), False)
        pixels = pictures.linear_pixels(node.image, self.notes)
        sampled = pictures.sample(pixels, self._points_of_picture(node, path, sheet), node.extension, node.interpolation == "Closest")
        return (sampled[..., :3], True) if output.name == "Color" else (sampled[..., 3], False)
