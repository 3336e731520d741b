"""The nodes of Blender that compute colours and numbers from others."""

import colorsys
import math

import numpy as np

_RAMP_STEPS = 1024


def mapping_matrix(node, constant, graph):
    """Of a Mapping node, 4 x 4."""
    def axes(name):
        return np.resize(np.asarray(constant(node.inputs[name]), np.float64), 3)

    place = np.zeros(3)
    if node.vector_type in ("POINT", "TEXTURE"):
        place = axes("Location")
    x, y, z = axes("Rotation")
    cx, sx, cy, sy, cz, sz = math.cos(x), math.sin(x), math.cos(y), math.sin(y), math.cos(z), math.sin(z)
    rotation = (np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]) @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
                @ np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]]))
    matrix = np.eye(4)
    matrix[:3, :3] = rotation @ np.diag(axes("Scale"))
    matrix[:3, 3] = place
    if node.vector_type == "TEXTURE":
        if abs(np.linalg.det(matrix)) < 1e-12:
            graph.skip(node, "its scale of 0 is left out")
            return np.eye(4)
        return np.linalg.inv(matrix)
    if node.vector_type == "NORMAL":
        graph.skip(node, "it turns as a point does")
    return matrix


def _blend(mode, a, b, fac):
    """Colours mixed as Blender's Mix does; None where the mode is not known here."""
    with np.errstate(divide="ignore", invalid="ignore"):
        made = {
            "MIX": lambda: b, "ADD": lambda: a + b, "MULTIPLY": lambda: a * b, "SUBTRACT": lambda: a - b,
            "SCREEN": lambda: 1 - (1 - a) * (1 - b), "DIVIDE": lambda: np.where(b != 0, a / b, a),
            "DIFFERENCE": lambda: np.abs(a - b), "DARKEN": lambda: np.minimum(a, b),
            "LIGHTEN": lambda: np.maximum(a, b),
            "OVERLAY": lambda: np.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b)),
        }.get(mode)
        return None if made is None else a * (1 - fac) + made() * fac


_MATH = {
    "ADD": lambda a, b, c: a + b, "SUBTRACT": lambda a, b, c: a - b, "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: np.divide(a, b, out=np.zeros(np.broadcast(a, b).shape), where=np.asarray(b) != 0),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c, "MINIMUM": lambda a, b, c: np.minimum(a, b),
    "MAXIMUM": lambda a, b, c: np.maximum(a, b), "ABSOLUTE": lambda a, b, c: np.abs(a),
    "POWER": lambda a, b, c: np.nan_to_num(np.power(np.maximum(a, 0), b)),
    "SQRT": lambda a, b, c: np.sqrt(np.maximum(a, 0)), "LESS_THAN": lambda a, b, c: (a < b) * 1.0,
    "GREATER_THAN": lambda a, b, c: (a > b) * 1.0, "FLOOR": lambda a, b, c: np.floor(a),
    "CEIL": lambda a, b, c: np.ceil(a), "ROUND": lambda a, b, c: np.floor(a + 0.5),
    "FRACT": lambda a, b, c: a - np.floor(a), "SINE": lambda a, b, c: np.sin(a), "COSINE": lambda a, b, c: np.cos(a),
    "RADIANS": lambda a, b, c: np.radians(a), "DEGREES": lambda a, b, c: np.degrees(a),
    "SIGN": lambda a, b, c: np.sign(a), "EXPONENT": lambda a, b, c: np.exp(a),
}


def _hue_saturation(color, hue, saturation, value):
    low, high = color.min(axis=-1), color.max(axis=-1)
    span = np.where(high > low, high - low, 1.0)
    r, g, b = color[..., 0], color[..., 1], color[..., 2]
    h = np.where(high == r, (g - b) / span, np.where(high == g, 2 + (b - r) / span, 4 + (r - g) / span)) / 6
    s = np.where(high > 0, (high - low) / np.where(high > 0, high, 1), 0)
    h, s, v = (h + hue + 0.5) % 1.0, np.clip(s * saturation, 0, 1), high * value
    parts = [np.clip(np.abs((h * 6 + k) % 6 - 3) - 1, 0, 1) for k in (0, 4, 2)]
    return np.stack([v * (1 + s * (p - 1)) for p in parts], -1)


def _lookup(values, table):
    at = np.clip(values, 0, 1) * (_RAMP_STEPS - 1)
    return np.stack([np.interp(at, np.arange(_RAMP_STEPS), table[:, k]) for k in range(table.shape[1])], -1)


# The CIE's observer of 1931 from 380 to 780 nm, every 20.
_OBSERVER_NM = np.arange(380.0, 781.0, 20.0)
_OBSERVER = np.array([
    [.0014, .0143, .1344, .3483, .2908, .0956, .0049, .0633, .2904, .5945, .9163, 1.0622, .8544, .4479, .1649, .0468, .0114,
     .0029, .0007, .0002, .0000],
    [.0000, .0004, .0040, .0230, .0600, .1390, .3230, .7100, .9540, .9950, .8700, .6310, .3810, .1750, .0610, .0170, .0041,
     .0010, .0002, .0001, .0000],
    [.0065, .0679, .6456, 1.7471, 1.6692, .8130, .2720, .0782, .0203, .0039, .0017, .0008, .0002, .0000, .0000, .0000, .0000,
     .0000, .0000, .0000, .0000]])
_REC709_FROM_XYZ = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                             [0.0556434, -0.2040259, 1.0572252]])


def rgb_of_spectrum(nm, spectrum):
    """Linear Rec. 709 of spectra (..., waves) at evenly spaced wavelengths; Y is the integral of power times
    sensitivity."""
    xyz = [(spectrum * np.interp(nm, _OBSERVER_NM, row)).sum(axis=-1) for row in _OBSERVER]
    return np.stack(xyz, -1) * (nm[1] - nm[0]) @ _REC709_FROM_XYZ.T


def _black_body(kelvin):
    """Linear Rec. 709 of the luminance 1, after Planck."""
    nm = np.arange(380.0, 781.0, 5.0)
    rgb = rgb_of_spectrum(nm, nm ** -5 / np.expm1(1.4388e7 / (nm * max(float(kelvin), 800.0))))
    return np.maximum(rgb / (rgb @ (0.2126, 0.7152, 0.0722)), 0)


def _mix(graph, node, path, sheet):
    """Of both kinds of Mix nodes: the parts that the node's type of data has."""
    if node.type == "MIX_RGB":
        a, b, fac = (node.inputs[name] for name in ("Color1", "Color2", "Fac"))
        mode, is_clamped = node.blend_type, node.use_clamp
    else:
        enabled = [s for s in node.inputs if s.enabled]
        fac, a, b = (next(s for s in enabled if s.name == name) for name in ("Factor", "A", "B"))
        mode = node.blend_type if node.data_type == "RGBA" else "MIX"
        is_clamped = node.data_type == "RGBA" and node.clamp_result
        if node.data_type == "FLOAT":
            share = np.clip(graph.number(fac, path, sheet), 0, 1)
            return graph.number(a, path, sheet) * (1 - share) + graph.number(b, path, sheet) * share, False
    share = np.clip(graph.number(fac, path, sheet), 0, 1)[..., None]
    first, second = graph.color(a, path, sheet), graph.color(b, path, sheet)
    made = _blend(mode, first, second, share)
    if made is None:
        graph.skip(node, f'its mode "{mode.lower()}" mixes plainly')
        made = first * (1 - share) + second * share
    return (np.clip(made, 0, 1) if is_clamped else made), True


def _map_range(graph, node, path, sheet):
    value, low, high, to_low, to_high = (graph.number(node.inputs[name], path, sheet) for name in (
        "Value", "From Min", "From Max", "To Min", "To Max"))
    part = (value - low) / np.where(high != low, high - low, 1)
    if node.clamp:
        part = np.clip(part, 0, 1)
    if node.interpolation_type == "SMOOTHSTEP":
        part = np.clip(part, 0, 1)
        part = part * part * (3 - 2 * part)
    return to_low + part * (to_high - to_low), False


def _curves(graph, node, path, sheet):
    node.mapping.initialize()
    steps = np.linspace(0, 1, _RAMP_STEPS)
    curves = node.mapping.curves
    whole = np.array([node.mapping.evaluate(curves[3], x) for x in steps])
    color, fac = graph.color(node.inputs["Color"], path, sheet), graph.number(node.inputs["Fac"], path, sheet)[..., None]
    made = []
    for k in range(3):
        own = np.array([node.mapping.evaluate(curves[k], min(max(x, 0.0), 1.0)) for x in whole])
        made.append(np.interp(np.clip(color[..., k], 0, 1), steps, own))
    return color * (1 - fac) + np.stack(made, -1) * fac, True


def evaluate(graph, node, output, path, sheet):
    """As Graph.value; None: the node is not known."""
    def color(name):
        return graph.color(node.inputs[name], path, sheet)

    def number(name):
        return graph.number(node.inputs[name], path, sheet)

    kind = node.type
    if kind in ("MIX_RGB", "MIX") and getattr(node, "data_type", "RGBA") in ("RGBA", "FLOAT"):
        return _mix(graph, node, path, sheet)
    if kind == "MATH" and node.operation in _MATH:
        a, b, c = (graph.number(node.inputs[k], path, sheet) for k in range(3))
        made = _MATH[node.operation](a, b, c)
        return (np.clip(made, 0, 1) if node.use_clamp else made), False
    if kind == "GAMMA":
        return np.maximum(color("Color"), 0) ** number("Gamma")[..., None], True
    if kind == "INVERT":
        fac, made = number("Fac")[..., None], color("Color")
        return made * (1 - fac) + (1 - made) * fac, True
    if kind == "BRIGHTCONTRAST":
        contrast = number("Contrast")[..., None]
        return np.maximum((1 + contrast) * color("Color") + number("Bright")[..., None] - 0.5 * contrast, 0), True
    if kind == "HUE_SAT":
        fac, before = number("Fac")[..., None], color("Color")
        return before * (1 - fac) + fac * _hue_saturation(before, number("Hue"), number("Saturation"),
                                                          number("Value")), True
    if kind == "VALTORGB":
        table = np.array([node.color_ramp.evaluate(x) for x in np.linspace(0, 1, _RAMP_STEPS)])
        found = _lookup(number("Fac"), table)
        return (found[..., :3], True) if output.name == "Color" else (found[..., 3], False)
    if kind == "CURVE_RGB":
        return _curves(graph, node, path, sheet)
    if kind == "RGBTOBW":
        return graph.number(node.inputs[0], path, sheet), False
    if kind in ("SEPRGB", "SEPXYZ") or (kind == "SEPARATE_COLOR" and node.mode == "RGB"):
        place = [s.name for s in node.outputs].index(output.name)
        return graph.color(node.inputs[0], path, sheet)[..., place], False
    if kind in ("COMBRGB", "COMBXYZ") or (kind == "COMBINE_COLOR" and node.mode == "RGB"):
        parts = [graph.number(s, path, sheet) for s in list(node.inputs)[:3]]
        return np.stack(np.broadcast_arrays(*parts), -1), True
    if kind == "CLAMP":
        return np.clip(number("Value"), number("Min"), number("Max")), False
    if kind == "MAP_RANGE" and node.data_type == "FLOAT" and node.interpolation_type in ("LINEAR", "SMOOTHSTEP"):
        return _map_range(graph, node, path, sheet)
    if kind == "BLACKBODY":
        return _black_body(number("Temperature").mean()), True
    if kind == "COMBHSV":
        return np.array(colorsys.hsv_to_rgb(*(float(number(n).mean()) for n in "HSV"))), True
    return None
