"""Passes of a view layer, and the renderer's layers that they are."""

from collections import namedtuple

import numpy as np

# name and channels as Blender knows the pass; the layer's name among the renderer's settings; its channels there
Pass = namedtuple("Pass", "name channels kind layer names")

_DEPTH = Pass("Depth", "Z", "VALUE", "Z", ("Z",))
_NORMAL = Pass("Normal", "XYZ", "VECTOR", "N", ("N.X", "N.Y", "N.Z"))
_POSITION = Pass("Position", "XYZ", "VECTOR", "P", ("P.X", "P.Y", "P.Z"))
_UV = Pass("UV", "UVA", "VECTOR", "uv", ("u", "v", "A"))
_CRYPTO_LEVELS = 3  # two ranks each
_OWN = {name: Pass(title, "RGB", "COLOR", layer, tuple(f"{layer}.{c}" for c in "RGB")) for name, title, layer in (
    ("use_albedo", "Albedo", "albedo"), ("use_emission", "Emission", "emission"), ("use_direct", "Direct", "direct"),
    ("use_indirect", "Indirect", "indirect"), ("use_caustic", "Caustic", "caustic"),
    ("use_specular", "Specular", "specular"))}


def group_name(name):
    """A light group's name as the renderer takes it."""
    return "".join(c if c.isascii() and (c.isalnum() or c in "_-") else "_" for c in name)[:40]


def group_of(owner):
    """The parameter of a light that puts it into its owner's group."""
    return {"string lightgroup": group_name(owner.lightgroup)} if owner.lightgroup else {}


def crypto_kinds(view_layer):
    """The Cryptomattes that the view layer asks for: "object" is 0, "material" 1 among the names of a translation."""
    kinds = ("object", view_layer.use_pass_cryptomatte_object), ("material", view_layer.use_pass_cryptomatte_material)
    return [(kind, place) for place, (kind, is_asked) in enumerate(kinds) if is_asked]


def passes_of(view_layer):
    """Those that the view layer asks for beside Combined."""
    asked = []
    if view_layer.use_pass_z:
        asked.append(_DEPTH)
    if view_layer.use_pass_normal:
        asked.append(_NORMAL)
    if view_layer.use_pass_position:
        asked.append(_POSITION)
    if view_layer.use_pass_uv:
        asked.append(_UV)
    for kind, _ in crypto_kinds(view_layer):
        for level in range(min((view_layer.pass_cryptomatte_depth + 1) // 2, _CRYPTO_LEVELS)):
            name = f"Crypto{kind.title()}{level:02d}"
            asked.append(Pass(name, "RGBA", "COLOR", f"crypto_{kind}", tuple(f"{name}.{c}" for c in "RGBA")))
    own = view_layer.afterglow
    asked += [found for name, found in _OWN.items() if getattr(own, name)]
    for group in view_layer.lightgroups:
        names = tuple(f"light_{group_name(group.name)}.{c}" for c in "RGB")
        asked.append(Pass(f"Combined_{group.name}", "RGB", "COLOR", "lightgroups", names))
    return asked


def layers_of(asked, is_transparent):
    """The renderer's layers; a transparent film needs to know what comes straight from the sky."""
    return ",".join(dict.fromkeys(["A", *(one.layer for one in asked), *(["emission"] if is_transparent else [])]))


def pixels_of(one, channels, shape):
    """(pixels, channels), lowest row first, as Blender takes them."""
    black = np.zeros(shape, np.float32)
    planes = [channels.get(name, black)[::-1] for name in one.names]
    return np.ascontiguousarray(np.stack(planes, -1).reshape(-1, len(planes)))


def without_sky(rgb, channels):
    """Of a transparent film: where the picture is not covered whole, what comes straight to the eye is the sky's."""
    emission = np.stack([channels[f"emission.{c}"] for c in "RGB"], -1)
    return rgb - emission * (channels["A"] < 1)[..., None]


def combined_pixels(rgb, alpha=None):
    """The same of Combined; alpha None: 1 everywhere."""
    made = np.ones((*rgb.shape[:2], 4), np.float32)
    made[..., :3] = rgb[::-1]
    if alpha is not None:
        made[..., 3] = alpha[::-1]
    return made.reshape(-1, 4)
