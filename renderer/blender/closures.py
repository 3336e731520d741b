"""Shaders of a node tree as a material of the renderer, emission and alpha."""

from dataclasses import dataclass, field, replace
from typing import Optional

import numpy as np

from . import materials
from .nodes import source


_MIXES_MOST = 16  # the renderer's


@dataclass(frozen=True)
class Surface:
    """kind and parameters: of the renderer's material; kind None: it reflects nothing. parts: of a mix, the surfaces.
    emission: radiance, (3,) or a picture; alpha: a number or a picture; None: 0, and 1. is_transparent: it lets all
    pass. depth: of the mixes in it."""
    kind: Optional[str] = None
    parameters: dict = field(default_factory=dict)
    parts: tuple = ()
    emission: Optional[np.ndarray] = None
    alpha: Optional[np.ndarray] = None
    is_transparent: bool = False
    depth: int = 0


def add_material(baker, name, surface):
    """Makes the material of that name, and those that it mixes, each once."""
    if surface.is_transparent:
        baker.scene.material(name, "interface")
        return
    parameters = dict(surface.parameters)
    if surface.parts:
        parameters["string materials"] = [_part_name(baker, part) for part in surface.parts]
    if surface.kind is None:
        parameters["rgb reflectance"] = (0, 0, 0)
    baker.scene.material(name, surface.kind or "diffuse", parameters)


def _part_name(baker, part):
    if id(part) not in baker.part_names:
        name = baker.part_names[id(part)] = f"{baker.name}|{len(baker.part_names)}"
        add_material(baker, name, part)
    return baker.part_names[id(part)]


def translate(baker, socket, path):
    """A shader that several others share is translated once."""
    output, _, path = source(socket, path)
    if output is None:
        return Surface()
    key = output.as_pointer(), path
    if key not in baker.surfaces:
        baker.surfaces[key] = _make(baker, output.node, path)
    return baker.surfaces[key]


def _make(baker, node, path):
    maker = _SHADERS.get(node.type)
    if maker is None:
        baker.graph.skip(node, "a grey diffuse surface stands in")
        return Surface("diffuse", {"rgb reflectance": (0.5, 0.5, 0.5)})
    return maker(baker, node, path)


def _maps(baker, node, path):
    """What a shader's Normal says, as a normal map or relief."""
    socket = node.inputs.get("Normal")
    output, _, path = source(socket, path) if socket is not None else (None, None, path)
    if output is None:
        return {}
    tilt = output.node
    if tilt.type == "NORMAL_MAP" and baker.atlas:
        baker.graph.skip(tilt, "beside procedural textures the surface keeps its own normal")
        return {}
    if tilt.type == "NORMAL_MAP" and tilt.space == "TANGENT":
        strength = float(baker.graph.number(tilt.inputs["Strength"], path))
        values = baker.bake(tilt.inputs["Color"], path, True)
        if values.ndim == 1:
            return {}
        normals = values * 2 - 1
        normals[..., :2] *= strength
        normals[..., 2] = 1 + (normals[..., 2] - 1) * min(strength, 1.0)
        normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-6)
        return {"string normalmap": baker.image(normals * 0.5 + 0.5)}
    if tilt.type == "BUMP":
        if tilt.inputs["Normal"].is_linked:
            baker.graph.skip(tilt, "the relief below it is left out")
        depth = float(baker.graph.number(tilt.inputs["Distance"], path)) * float(
            baker.graph.number(tilt.inputs["Strength"], path)) * (-1 if tilt.invert else 1)
        height = baker.bake(tilt.inputs["Height"], path, False)
        return {} if height.ndim == 0 or depth == 0 else {"texture displacement": baker.texture(height * depth, False)}
    baker.graph.skip(tilt, "the surface keeps its own normal")
    return {}


def _constant(baker, node, name, path):
    """A number that is to be the same everywhere."""
    values = baker.bake(node.inputs[name], path, False)
    if values.ndim:
        baker.graph.skip(node, f'its "{name}" is the same all over, the mean of what the picture says')
    return float(np.mean(values))


def _at_one_size(*values):
    """Numbers and colours with a last axis of 1 or 3 channels, and with the rows and columns of the largest picture among
    them; those that are the same all over have none."""
    made = [v[..., None] if v.ndim % 2 == 0 else v for v in map(np.asarray, values)]
    largest = max(made, key=lambda v: v[..., 0].size)
    return [v if v.ndim == 1 else _stretched(v, largest)[0] for v in made]


def _has_any(baker, socket, path):
    return bool((np.abs(baker.bake(socket, path, False)) > 1e-4).any())


def _sheen(baker, inputs, path):
    """Cycles' sheen, which is Burley's: what metal and glass leave of it, tinted by the base colour's hue."""
    if not _has_any(baker, inputs["Sheen"], path):
        return {}, 0.0
    amount, tint, metallic, transmission = (baker.bake(inputs[name], path, False) for name in (
        "Sheen", "Sheen Tint", "Metallic", "Transmission"))
    amount, tint, metallic, transmission, color = _at_one_size(
        amount, tint, np.clip(metallic, 0, 1), np.clip(transmission, 0, 1), baker.bake(inputs["Base Color"], path, True))
    brightness = (color * materials.LUMA).sum(axis=-1, keepdims=True)
    hue = np.where(brightness > 0, color / np.maximum(brightness, 1e-30), 1.0)
    sheen = amount * (1 - metallic) * (1 - transmission) * (1 - tint + tint * hue)
    sheen = np.clip(np.nan_to_num(sheen), 0, materials.SHEEN_MOST)
    taken = materials.SHEEN_ALBEDO * float(np.mean(sheen.max(axis=-1)))
    return {**baker.parameter("sheen", sheen, True), "string sheen_model": "schlick"}, taken


def _grain(baker, inputs, path, name):
    """By how much a shader's tangent is turned."""
    turns = baker.bake(inputs[name], path, False)
    if turns.ndim == 0:
        return {"float grain_rotation": 360.0 * float(turns)} if turns else {}
    angles = 2 * np.pi * turns
    return {"string grainmap": baker.image(0.5 + 0.5 * np.stack([np.cos(angles), np.sin(angles), 0 * angles], -1))}


def _brushed(baker, inputs, path):
    """Cycles' roughness along the tangent and across it, of a Principled BSDF."""
    if not _has_any(baker, inputs["Anisotropic"], path):
        return baker.number("roughness", inputs["Roughness"], path)
    roughness, amount = _at_one_size(*(baker.bake(inputs[name], path, False) for name in ("Roughness", "Anisotropic")))
    root = (1 - 0.9 * np.clip(amount, 0, 1)) ** 0.25
    return {**baker.parameter("uroughness", (roughness / root)[..., 0], False, 0.0, 1.0),
            **baker.parameter("vroughness", (roughness * root)[..., 0], False, 0.0, 1.0),
            **_grain(baker, inputs, path, "Anisotropic Rotation")}


def _say_left_out(baker, node, names, path):
    for name in names:
        if node.inputs[name].is_linked or float(np.mean(baker.bake(node.inputs[name], path, False))) > 1e-4:
            baker.graph.notes.say(f'{baker.graph.name}: "{name}" of {node.bl_label} is not translated')


def _emission(baker, color, strength, path):
    light = baker.bake(color, path, True) * np.asarray(baker.bake(strength, path, False))[..., None]
    return light if (light > 0).any() else None


def _principled(baker, node, path):
    """The base below Cycles' interface is as bright as without it, ours is lit by what the interface lets in: it is made
    brighter by that, and by what a sheen takes, so that both are as bright in all."""
    inputs = node.inputs
    specular = _constant(baker, node, "Specular", path)
    is_glass = np.mean(baker.bake(inputs["Transmission"], path, False)) > 0.5
    sheen, taken = _sheen(baker, inputs, path)
    lost = 0.0 if is_glass else (1 - np.mean(baker.bake(inputs["Metallic"], path, False))) * (
        materials.reflected_by_interface(specular, np.mean(baker.bake(inputs["Roughness"], path, False))))
    parameters = {**sheen, **baker.color("reflectance", inputs["Base Color"], path, 1 / ((1 - lost) * (1 - taken)))}
    parameters.update(baker.number("metallic", inputs["Metallic"], path))
    parameters.update(_brushed(baker, inputs, path))
    parameters.update(baker.number("transmission", inputs["Transmission"], path))
    parameters.update(baker.number("clearcoat", inputs["Clearcoat"], path, change=lambda v: 0.25 * v))
    parameters.update(baker.number("clearcoat_roughness", inputs["Clearcoat Roughness"], path))
    parameters["bool is_thin"] = False
    if is_glass:
        parameters["float ior"] = max(_constant(baker, node, "IOR", path), 1.0)
    elif specular > 0:
        parameters["float ior"] = materials.index_of_specular(specular)
    else:
        parameters.update({"float ior": 1.0, "float specular": 0.0})
    _say_left_out(baker, node, ("Subsurface", "Specular Tint"), path)
    parameters.update(_maps(baker, node, path))
    alpha = baker.bake(inputs["Alpha"], path, False)
    return Surface("principled", parameters, alpha=alpha if (alpha < 1).any() else None,
                   emission=_emission(baker, inputs["Emission"], inputs["Emission Strength"], path))


def _diffuse(baker, node, path):
    return Surface("diffuse", {**baker.color("reflectance", node.inputs["Color"], path), **_maps(baker, node, path)})


def _glossy(baker, node, path):
    roughness = 0.0 if getattr(node, "distribution", "") == "SHARP" else baker.bake(node.inputs["Roughness"], path, False)
    parameters = baker.color("reflectance", node.inputs["Color"], path)
    parameters.update(baker.parameter("roughness", materials.roughness_squared(roughness), False))
    parameters["bool remaproughness"] = False
    parameters.update(_maps(baker, node, path))
    return Surface("conductor", parameters)


def _anisotropic(baker, node, path):
    """Unlike a Principled BSDF, one that is above 0 is smoother along the tangent."""
    parameters = _glossy(baker, node, path).parameters
    if node.distribution == "SHARP" or not _has_any(baker, node.inputs["Anisotropy"], path):
        return Surface("conductor", parameters)
    roughness, amount = _at_one_size(*(baker.bake(node.inputs[name], path, False) for name in ("Roughness", "Anisotropy")))
    alpha, amount = materials.roughness_squared(roughness), np.clip(amount, -0.99, 0.99)
    small, large = alpha * (1 - np.abs(amount)), np.minimum(alpha / (1 - np.abs(amount)), 1)
    for name in ("float roughness", "texture roughness"):
        parameters.pop(name, None)
    parameters.update(baker.parameter("uroughness", np.where(amount > 0, small, large)[..., 0], False))
    parameters.update(baker.parameter("vroughness", np.where(amount > 0, large, small)[..., 0], False))
    parameters.update(_grain(baker, node.inputs, path, "Rotation"))
    return Surface("conductor", parameters)


def _velvet(baker, node, path):
    return Surface("principled", {
        "rgb reflectance": (0, 0, 0), "float metallic": 0, "float specular": 0, "float ior": 1.0, "bool is_thin": False,
        "string sheen_model": "velvet", **baker.color("sheen", node.inputs["Color"], path),
        **baker.number("sheen_roughness", node.inputs["Sigma"], path), **_maps(baker, node, path)})


def _glass(baker, node, path):
    parameters = baker.color("reflectance", node.inputs["Color"], path)
    if node.distribution == "SHARP":
        parameters["float roughness"] = 0
    else:
        parameters.update(baker.number("roughness", node.inputs["Roughness"], path))
    parameters.update({"bool is_thin": False, "float transmission": 1, "float ior": max(_constant(baker, node, "IOR", path), 1.0)})
    parameters.update(_maps(baker, node, path))
    return Surface("principled", parameters)


def _refraction(baker, node, path):
    baker.graph.skip(node, "glass stands in, which reflects as well")
    return _glass(baker, node, path)


def _translucent(baker, node, path):
    return Surface("diffusetransmission", {"rgb reflectance": (0, 0, 0), "float scale": 1, **baker.color(
        "transmittance", node.inputs["Color"], path), **_maps(baker, node, path)})


def _transparent(baker, node, path):
    color = baker.bake(node.inputs["Color"], path, True)
    if (np.abs(color - 1) > 1e-3).any():
        baker.graph.notes.say(f"{baker.graph.name}: a coloured Transparent BSDF is as clear as it is bright")
        return Surface(None, alpha=1 - np.clip(color.mean(axis=-1), 0, 1))
    return Surface(is_transparent=True)


def _shines(baker, node, path):
    return Surface(None, emission=_emission(baker, node.inputs["Color"], node.inputs["Strength"], path))


def _sum(a, b):
    return b if a is None else a if b is None else a + b


def _stretched(a, b):
    """Two pictures or numbers at one size, the larger one's."""
    if a.ndim < 2 or b.ndim < 2 or a.shape[:2] == b.shape[:2]:
        return a, b
    if a.shape[0] * a.shape[1] < b.shape[0] * b.shape[1]:
        return _stretched(b, a)[::-1]
    rows = np.arange(a.shape[0]) * b.shape[0] // a.shape[0]
    columns = np.arange(a.shape[1]) * b.shape[1] // a.shape[1]
    return a, b[rows][:, columns]


def _scaled(color, factor):
    if color is None:
        return None
    if np.ndim(factor) == 0:
        return color * factor
    if color.ndim == 1:
        return color * factor[..., None]
    color, factor = _stretched(color, factor)
    return color * factor[..., None]


def _times(a, b):
    a, b = _stretched(np.asarray(a), np.asarray(b))
    return a * b


def _mix(baker, node, path):
    first, second = (translate(baker, node.inputs[k], path) for k in (1, 2))
    amount = np.clip(baker.bake(node.inputs["Fac"], path, False), 0, 1)
    if first is second or (amount.ndim == 0 and amount in (0, 1)):
        return second if amount.ndim == 0 and amount == 1 else first
    if first.is_transparent or second.is_transparent:
        solid, share = (second, amount) if first.is_transparent else (first, 1 - amount)
        if solid.is_transparent:
            return solid
        return replace(solid, alpha=share if solid.alpha is None else _times(solid.alpha, share))
    a, b = _scaled(first.emission, 1 - amount), _scaled(second.emission, amount)
    emission = a if b is None else b if a is None else _sum(*_stretched(a, b))
    if first.alpha is not None or second.alpha is not None:
        alphas = [np.float64(1) if s.alpha is None else s.alpha for s in (first, second)]
        alpha = _sum(*_stretched(_times(alphas[0], 1 - amount), _times(alphas[1], amount)))
    else:
        alpha = None
    if first.kind is None and second.kind is None:
        return Surface(None, emission=emission, alpha=alpha)
    return _mixed(baker, node, baker.parameter("amount", amount, False), (first, second), emission=emission, alpha=alpha)


def _mixed(baker, node, amount, parts, **rest):
    depth = 1 + max(part.depth for part in parts)
    if depth > _MIXES_MOST:
        baker.graph.skip(node, f"of {depth} mixes within one another the innermost {_MIXES_MOST} stand in")
        return replace(max(parts, key=lambda part: part.depth), **rest)
    return Surface("mix", amount, parts=parts, depth=depth, **rest)


def _add(baker, node, path):
    first, second = (translate(baker, node.inputs[k], path) for k in (0, 1))
    solid, other = (second, first) if first.kind is None and not second.is_transparent else (first, second)
    if other.kind is not None:
        baker.graph.skip(node, "of two surfaces the mean stands in")
        return _mixed(baker, node, {"float amount": 0.5}, (first, second), emission=_sum(first.emission, second.emission))
    if first.emission is not None and second.emission is not None:
        emission = _sum(*_stretched(first.emission, second.emission))
    else:
        emission = _sum(first.emission, second.emission)
    if solid.is_transparent and emission is not None:
        return Surface(None, emission=emission)
    return replace(solid, emission=emission)


def _subsurface(baker, node, path):
    baker.graph.skip(node, "a diffuse surface of its colour stands in")
    return Surface("diffuse", baker.color("reflectance", node.inputs["Color"], path))


def _hair(baker, node, path):
    """Principled Hair by melanin, colour or absorption; of Hair BSDF a Principled one of its colour."""
    inputs = node.inputs
    if node.type == "BSDF_HAIR":
        baker.graph.skip(node, "hair of its colour stands in")
        return Surface("hair", {"rgb reflectance": np.clip(baker.graph.color(inputs["Color"], path), 0.01, 0.99)})
    constant = {name: float(baker.graph.number(inputs[name], path)) for name in (
        "Roughness", "Radial Roughness", "IOR", "Offset", "Melanin", "Melanin Redness")}
    made = {"float beta_m": min(max(constant["Roughness"], 0.01), 1), "float eta": max(constant["IOR"], 1.01),
            "float beta_n": min(max(constant["Radial Roughness"], 0.01), 1), "float alpha": np.degrees(constant["Offset"])}
    if node.parametrization == "COLOR":
        made["rgb reflectance"] = np.clip(baker.graph.color(inputs["Color"], path), 0.01, 0.99)
    elif node.parametrization == "ABSORPTION":
        made["rgb sigma_a"] = np.maximum(baker.graph.color(inputs["Absorption Coefficient"], path), 0)
    else:
        amount = -np.log(max(1 - min(constant["Melanin"], 1.0), 1e-4))
        made.update({"float eumelanin": amount * (1 - constant["Melanin Redness"]),
                     "float pheomelanin": amount * constant["Melanin Redness"]})
    return Surface("hair", made)


def _holdout(baker, node, path):
    baker.graph.skip(node, "it is black, and no hole in the picture")
    return Surface()


_SHADERS = {
    "BSDF_PRINCIPLED": _principled, "BSDF_DIFFUSE": _diffuse, "BSDF_GLOSSY": _glossy, "BSDF_GLASS": _glass,
    "BSDF_REFRACTION": _refraction, "BSDF_TRANSLUCENT": _translucent, "BSDF_TRANSPARENT": _transparent,
    "BSDF_ANISOTROPIC": _anisotropic, "BSDF_VELVET": _velvet, "BSDF_TOON": _subsurface, "SUBSURFACE_SCATTERING": _subsurface,
    "BSDF_HAIR": _hair, "BSDF_HAIR_PRINCIPLED": _hair, "EMISSION": _shines,
    "MIX_SHADER": _mix, "ADD_SHADER": _add, "HOLDOUT": _holdout,
}


_ANISOTROPIC = {"BSDF_PRINCIPLED": "Anisotropic", "BSDF_ANISOTROPIC": "Anisotropy"}


def _brushed_shaders(graph, socket):
    """Those that reach a socket, with the groups that they are in."""
    for node, path in graph.behind(socket):
        if node.type in _ANISOTROPIC:
            output, value, _ = source(node.inputs[_ANISOTROPIC[node.type]], path)
            if output is not None or abs(value.default_value) > 1e-4:
                yield node, path


def tangent_of(graph, socket):
    """Along which direction the shaders that reach a material's socket are brushed: ("RADIAL", axis) about an axis of the
    Generated coordinates, as Cycles has it unless a Tangent node says otherwise, or ("UV", name of the map); None: no shader
    is."""
    found = []
    for shader, path in _brushed_shaders(graph, socket):
        output, _, _ = source(shader.inputs["Tangent"], path)
        if output is None or output.node.type != "TANGENT":
            if output is not None:
                graph.skip(output.node, "the tangent is radial")
            found.append(("RADIAL", 2))
        elif output.node.direction_type == "UV_MAP":
            found.append(("UV", output.node.uv_map))
        else:
            found.append(("RADIAL", "XYZ".index(output.node.axis)))
    if len(set(found)) > 1:
        graph.notes.say(f"{graph.name}: its shaders are brushed along several tangents: the first counts")
    return found[0] if found else None
