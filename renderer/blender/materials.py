"""Blender's materials as the renderer's: what a node tree says of surface, emission and alpha, with pictures baked to
sheets of the material's own coordinates."""

import itertools
import math
from collections import namedtuple

import bpy
import numpy as np

from . import closures, pictures
from .atlas import Atlas
from .nodes import Graph, Sheet, source

_SHEET_MOST = 4096
IN_SPACE = "IN_SPACE"  # a layout: each part of a mesh has textures of its own (atlas.py)

# What a mesh's part needs: the material's name, parameters of the shape (alpha), those of its light or None, how its
# pictures lie (meshes.py), the medium within or None, and the tangent that it is brushed along or None (closures.py).
Look = namedtuple("Look", "name shape light layout medium tangent", defaults=(None, None))

LUMA = np.array([0.2126, 0.7152, 0.0722])

# Of a sheen that goes by Schlick's approximation: the largest factor with which it reflects no more than it gets, and the
# share that it reflects of even light with a factor of 1.
SHEEN_MOST, SHEEN_ALBEDO = 11.3, 0.0116


class MaterialSheet(Sheet):
    """A sheet whose unit square is that of the material's layout; pictures with another one are looked up there."""

    def __init__(self, width, height, layout):
        super().__init__(width, height)
        self._layout = layout

    def relative(self, layout):
        """From the sheet's square to the picture's, 2 x 3; None where it is the sheet's own, or has no such matrix."""
        own, other = (_flat(one) for one in (self._layout, layout))
        if _is_same(self._layout, layout) or own is None or other is None or abs(np.linalg.det(own)) < 1e-12:
            return None
        return (other @ np.linalg.inv(own))[:2]


def _is_same(a, b):
    return a[0] == b[0] and np.allclose(a[1], b[1])


def _flat(layout):
    """Its matrix in the plane of the source's first two coordinates, 3 x 3; None where there is none."""
    (_, _, projection), matrix = layout
    if projection != "FLAT" or np.abs(matrix[:2, 2]).max() > 1e-6 * np.abs(matrix[:2, :3]).max():
        return None
    return np.vstack([matrix[:2][:, [0, 1, 3]], [0, 0, 1]])


def _way_of(node):
    """How a texture goes on beyond its picture, and between its pixels."""
    return {"string wrap": {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black"}[node.extension],
            "string filter": "point" if node.interpolation == "Closest" else "bilinear"}


class Baker:
    """The values of one material: constants, or textures that are added to the scene."""

    def __init__(self, scene, material, notes, name=None, atlas=None):
        self.scene, self.name, self.notes = scene, name or material.name_full, notes
        self.atlas, self._baked = atlas, {}
        self.graph = Graph(f'material "{material.name_full}"', notes)
        self.layout = None
        self._way = {"string wrap": "clamp", "string filter": "point" if atlas.is_coarse else "bilinear"} if atlas else {}
        self._made = {}
        self.count = 0
        self.surfaces, self.part_names = {}, {}  # of shaders, and of surfaces that a mix has (closures.py)

    def look_for_layout(self, socket):
        found = self.graph.pictures(socket)
        layouts = [self.graph.layout(node, path) for node, path in found]
        if not layouts:
            return
        self._way = _way_of(found[0][0])
        self.layout = layouts[0]
        if all(_is_same(layout, layouts[0]) for layout in layouts):
            return
        if any(layout[0] != layouts[0][0] or _flat(layout) is None for layout in layouts):
            self.notes.say(f'material "{self.name}": its pictures lie by several coordinates: the first counts')
        else:
            self.layout = layouts[0][0], np.eye(4)[:3]  # they repeat by a common square

    def bake(self, socket, path, is_color, change=None):
        """A constant (3,) or (), or an array of the sheet's size; change: applied to what the sockets say."""
        if self.atlas:
            values = self._bake_in_space(socket, path, is_color)
            return change(values) if change else values
        found = self.graph.pictures(socket, path)
        sheet = None
        if found:
            sizes = np.array([node.image.size[:] for node, _ in found if node.image.size[0] > 0] or [(1, 1)])
            width, height = np.minimum(sizes.max(axis=0), _SHEET_MOST)
            sheet = MaterialSheet(int(width), int(height), self.layout)
        values = (self.graph.color if is_color else self.graph.number)(socket, path, sheet)
        return change(values) if change else values

    def _bake_in_space(self, socket, path, is_color):
        key = socket.as_pointer(), path, is_color
        if key not in self._baked:
            sheet = self.atlas if self.graph.varies(socket, path) else None
            values = (self.graph.color if is_color else self.graph.number)(socket, path, sheet)
            self._baked[key] = self.atlas.spread(values) if values.ndim > (1 if is_color else 0) else values
        return self._baked[key]

    def parameter(self, name, values, is_color, low=None, high=None):
        """{"rgb name": ...} of a constant, {"texture name": ...} of an array."""
        values = np.clip(np.nan_to_num(values), low, high) if low is not None else np.nan_to_num(values)
        if values.ndim == (1 if is_color else 0):
            return {("rgb " if is_color else "float ") + name: values}
        return {f"texture {name}": self.texture(values, is_color)}

    def image(self, values):
        """Adds an array as a picture in memory; gives its name."""
        self.count += 1
        name = f"{self.name}/{self.count}"
        self.scene.image(name, values[::-1].astype(np.float32))
        return name

    def texture(self, values, is_color):
        name = self.image(values)
        self.scene.texture(name, "spectrum" if is_color else "float", "imagemap",
                           {"string filename": name, **self._way})
        return name

    def direct_picture(self, socket, path, scale):
        """A colour socket that is a plain picture of 8 bits: its texture without a detour by floats."""
        output, _, _ = source(socket, path)
        if self.atlas or output is None or output.node.type != "TEX_IMAGE" or output.name != "Color":
            return None
        image = output.node.image
        if not image or image.is_float or pictures.is_linear(image, self.notes):
            return None
        if self.layout and not _is_same(self.graph.layout(output.node, path), self.layout):
            return None
        key = image.as_pointer(), output.node.extension, output.node.interpolation, scale
        if key not in self._made:
            self.count += 1
            name = file_name = f"{self.name}/{self.count}"
            if image.source == "TILED":
                file_name = pictures.tiled_file(image)
                if not pictures.has_all_tiles(image, file_name):
                    self.notes.say(f'picture "{image.name}": a file of its UDIM tiles is missing')
                    return None
            else:
                raw = pictures.raw_pixels(image)
                if raw is None:
                    return None
                self.scene.image(name, np.round(raw[::-1, :, :3] * 255).astype(np.uint8))
            self.scene.texture(name, "spectrum", "imagemap",
                               {"string filename": file_name, "string encoding": "sRGB", "float scale": scale,
                                **_way_of(output.node)})
            self._made[key] = name
        return self._made[key]

    def color(self, name, socket, path, scale=1.0):
        """A colour in [0, 1], times the scale."""
        texture = self.direct_picture(socket, path, scale)
        if texture:
            return {f"texture {name}": texture}
        return self.parameter(name, scale * self.bake(socket, path, True), True, 0.0, 1.0)

    def number(self, name, socket, path, low=0.0, high=1.0, change=None):
        return self.parameter(name, self.bake(socket, path, False, change), False, low, high)


class Materials:
    """The looks of the materials that meshes ask for, each made once. override: a material instead of all, or None."""

    def __init__(self, scene, notes, override):
        self._scene, self._notes, self._override = scene, notes, override
        self._looks, self._wants_space = {}, {}
        self._given, self._of_file = {}, {material.name_full for material in bpy.data.materials}

    def names(self):
        return list(self._given)

    def _new_name(self, material):
        """The material's own name where nothing has it yet, else with a number: one that no other material of the file has."""
        own = material.name_full if material else "(none)"
        if own in self._given or (material is None and own in self._of_file):
            numbered = (f"{own}#{k}" for k in itertools.count(max(len(self._given), 1)))
            name = next(name for name in numbered if name not in self._given and name not in self._of_file)
        else:
            name = own
        self._given[name] = True
        return name

    def look_of_mesh(self, material):
        """As look, but of a material with procedural textures one whose layout is IN_SPACE; look_in_space has what its
        parts want."""
        material = self._override or material
        if material is None or not material.use_nodes or not material.node_tree:
            return self.look(material)
        key = material.name_full
        output = material.node_tree.get_output_node("CYCLES")
        if key not in self._wants_space:
            self._wants_space[key] = output is not None and Graph(key, self._notes).has_procedural(output.inputs["Surface"])
        if not self._wants_space[key]:
            return self.look(material)
        graph = Graph(f'material "{key}"', self._notes)
        return Look(key, material, None, IN_SPACE, tangent=closures.tangent_of(graph, output.inputs["Surface"]))

    def look_in_space(self, look, part, pixels):
        """The look of one part, and the part with coordinates by its atlas, of about so many pixels."""
        atlas = Atlas(part.corners, pixels)
        name = self._new_name(look.shape)
        if atlas.is_coarse:
            self._notes.say(f'material "{look.name}": on a mesh of so many triangles its textures have one colour for each')
        baker = Baker(self._scene, look.shape, self._notes, name, atlas)
        made = self._translate(baker, look.shape.node_tree.get_output_node("CYCLES"))
        return made, part._replace(uvs=np.ascontiguousarray(atlas.uvs.reshape(-1, 2), np.float32), corners=None)

    def look(self, material):
        material = self._override or material
        key = material.name_full if material else None
        if key not in self._looks:
            self._looks[key] = self._make(material)
        return self._looks[key]

    def _make(self, material):
        name = self._new_name(material)
        if material is None or not material.use_nodes or not material.node_tree:
            color = (0.8, 0.8, 0.8) if material is None else material.diffuse_color[:3]
            self._scene.material(name, "diffuse", {"rgb reflectance": np.clip(color, 0, 1)})
            return Look(name, {}, None, None)
        output = material.node_tree.get_output_node("CYCLES")
        baker = Baker(self._scene, material, self._notes, name)
        if output is None:
            self._scene.material(baker.name, "diffuse", {"rgb reflectance": (0, 0, 0)})
            return Look(baker.name, {}, None, None)
        baker.look_for_layout(output.inputs["Surface"])
        return self._translate(baker, output)._replace(tangent=closures.tangent_of(baker.graph, output.inputs["Surface"]))

    def _translate(self, baker, output):
        if output.inputs["Displacement"].is_linked:
            self._notes.say(f"{baker.graph.name}: its displacement is not translated")
        medium = self._make_medium(baker, output.inputs["Volume"])
        if source(output.inputs["Surface"], ())[0] is None and source(output.inputs["Volume"], ())[0] is not None:
            surface = closures.Surface(is_transparent=True)  # what has a volume alone lets light in, as in Cycles
        else:
            surface = closures.translate(baker, output.inputs["Surface"], ())
        return self._finish(baker, surface, medium)

    def _make_medium(self, baker, socket):
        output, _, path = source(socket, ())
        if output is None:
            return None
        node = output.node
        if node.type != "VOLUME_ABSORPTION":
            self._notes.say(f"{baker.graph.name}: its volume is not translated")
            return None
        color = np.clip(baker.graph.color(node.inputs["Color"], path), 0, 1)
        density = max(float(baker.graph.number(node.inputs["Density"], path)), 0.0)
        name = f"{baker.name}|volume"
        self._scene.medium(name, "homogeneous", {"rgb sigma_a": (1 - color) * density, "rgb sigma_s": (0, 0, 0)})
        return name

    def _finish(self, baker, surface, medium):
        closures.add_material(baker, baker.name, surface)
        shape, light = {}, None
        if surface.alpha is not None and (surface.alpha < 1).any():
            shape = baker.parameter("alpha", surface.alpha, False, 0.0, 1.0)
        if surface.emission is not None and (surface.emission > 0).any():
            if surface.emission.ndim == 1:
                light = {"rgb L": np.maximum(surface.emission, 0)}
            else:
                light = {"string filename": baker.image(np.maximum(surface.emission, 0))}
            light["bool twosided"] = True
        return Look(baker.name, shape, light, baker.layout, medium)


def roughness_squared(value):
    return np.square(np.clip(value, 0, 1))


def reflected_by_interface(specular, roughness):
    """About the share of even light that a dielectric interface of Blender's Principled BSDF reflects: the mean of
    Schlick's approximation, less what rough facets lose to one another."""
    normal = 0.08 * min(max(specular, 0.0), 1.0)
    return 0.0 if normal == 0 else (normal + (1 - normal) / 21) * (1 - 0.4 * roughness ** 4)


def index_of_specular(specular):
    """The index whose reflectance at the normal is Blender's 0.08 specular."""
    root = math.sqrt(min(max(0.08 * float(specular), 0.0), 0.99))
    return (1 + root) / (1 - root)
