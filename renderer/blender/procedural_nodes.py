"""Blender's nodes of procedural textures: their sockets and choices, for the textures of procedural.py."""

import numpy as np

from . import procedural


def _flat_or_not(graph, node, points):
    """The points in the dimensions that the node has; None: it has others than two and three."""
    if node.noise_dimensions if hasattr(node, "noise_dimensions") else False:
        kind = node.noise_dimensions
    elif hasattr(node, "voronoi_dimensions"):
        kind = node.voronoi_dimensions
    else:
        kind = node.musgrave_dimensions
    if kind not in ("2D", "3D"):
        graph.skip(node, f"of its {kind} textures those of 3D stand in")
    return points[..., :2] if kind == "2D" else points


def _brick(graph, node, number, points, color):
    mortar, tint = procedural.brick(
        points, number("Mortar Size"), number("Mortar Smooth"), number("Bias"), max(number("Brick Width"), 1e-6),
        max(number("Row Height"), 1e-6), node.offset, node.offset_frequency, node.squash, node.squash_frequency)
    if not color:
        return mortar
    first, second, between = (color(name) for name in ("Color1", "Color2", "Mortar"))
    bricks = first * (1 - tint[..., None]) + second * tint[..., None]
    return bricks * (1 - mortar[..., None]) + between * mortar[..., None]


def _voronoi(graph, node, number, points, output):
    points = _flat_or_not(graph, node, points)
    feature, metric = node.feature, node.distance
    if feature not in ("F1", "F2", "DISTANCE_TO_EDGE"):
        graph.skip(node, f'its feature "{feature.lower()}" is F1 here')
        feature = "F1"
    if metric == "MINKOWSKI":
        graph.skip(node, "its distance is Euclid's")
    distance, cell = procedural.voronoi(points, feature, metric, min(max(number("Randomness"), 0.0), 1.0))
    if output.name == "Color":
        return procedural.cell_color(cell)
    if output.name != "Distance":
        graph.skip(node, f'its "{output.name}" is 0')
        return np.zeros(points.shape[:-1] + ((3,) if output.type == "VECTOR" else ()))
    return distance


def _musgrave(graph, node, number, points):
    kind = node.musgrave_type
    if kind not in ("FBM", "MULTIFRACTAL"):
        graph.skip(node, f'its type "{kind.lower()}" is fBM here')
        kind = "FBM"
    return procedural.musgrave(_flat_or_not(graph, node, points), kind, number("Dimension"), number("Lacunarity"),
                               number("Detail"))


def _wave(graph, node, number, points):
    is_bands = node.wave_type == "BANDS"
    return procedural.wave(points, node.wave_type, node.bands_direction if is_bands else node.rings_direction,
                           node.wave_profile, number("Distortion"), number("Detail"), number("Detail Scale"),
                           number("Detail Roughness"), number("Phase Offset"))


def evaluate(graph, node, output, path, sheet):
    """As Graph.value. Numbers that vary over the sheet count by their means, but for colours."""
    def number(name):
        return float(np.mean(graph.number(node.inputs[name], path, sheet)))

    def color(name):
        return graph.color(node.inputs[name], path, sheet)

    points = graph.vector(node.inputs["Vector"], path, sheet, "GENERATED")
    if "Scale" in node.inputs:
        points = points * np.asarray(graph.number(node.inputs["Scale"], path, sheet))[..., None]
    is_color, kind = output.type in ("RGBA", "VECTOR"), node.type
    if kind == "TEX_CHECKER":
        is_first = procedural.checker(points)
        if not is_color:
            return is_first * 1.0, False
        return np.where(is_first[..., None], color("Color1"), color("Color2")), True
    if kind == "TEX_MAGIC":
        made = procedural.magic(points, node.turbulence_depth, number("Distortion"))
        return (made, True) if is_color else (made.mean(axis=-1), False)
    if kind == "TEX_BRICK":
        return _brick(graph, node, number, points, color if is_color else None), is_color
    if kind == "TEX_NOISE":
        return procedural.noise(_flat_or_not(graph, node, points), number("Detail"), number("Roughness"),
                                number("Distortion"), is_color), is_color
    if kind == "TEX_VORONOI":
        return _voronoi(graph, node, number, points, output), is_color
    if kind == "TEX_WAVE":
        made = _wave(graph, node, number, points)
    elif kind == "TEX_MUSGRAVE":
        made = _musgrave(graph, node, number, points)
    else:
        made = procedural.gradient(points, node.gradient_type)
    return (np.repeat(made[..., None], 3, axis=-1), True) if is_color else (made, False)
