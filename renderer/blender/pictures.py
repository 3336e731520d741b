"""Blender's images as arrays: (height, width, 4), lowest row first, scene-linear."""

import os

import bpy
import numpy as np

_LINEAR = {"Non-Color", "Raw", "Linear", "Linear BT.709", "Linear Rec.709", "Generic Data"}


def tiled_file(image):
    """The name that the tiles of an image have in common, with <UDIM> in it."""
    return bpy.path.abspath(image.filepath, library=image.library)


def has_all_tiles(image, file_name):
    return all(os.path.isfile(file_name.replace("<UDIM>", str(tile.number))) for tile in image.tiles)


def raw_pixels(image):
    """As the file has them; floats, also of 8 bits."""
    width, height = image.size
    if width == 0 or height == 0:
        return None
    channels = max(image.channels, 1)
    pixels = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, channels)
    full = np.ones((height, width, 4), np.float32)
    full[..., :3] = pixels[..., :3] if channels >= 3 else pixels[..., :1]
    if channels in (2, 4):
        full[..., 3] = pixels[..., channels - 1]
    return full


def is_linear(image, notes):
    """Whether its values are light already: floats are, as Blender has converted them."""
    space = image.colorspace_settings.name
    if image.is_float or space in _LINEAR:
        return True
    if space != "sRGB":
        notes.say(f'picture "{image.name}": the colour space "{space}" is read as sRGB')
    return False


def from_srgb(values):
    low = values / np.float32(12.92)
    return np.where(values <= 0.04045, low, ((np.maximum(values, 0.04045) + 0.055) / 1.055) ** np.float32(2.4))


def linear_pixels(image, notes):
    if image.source == "TILED":
        notes.say(f'picture "{image.name}": of its UDIM tiles only the first is read')
    if image.source == "MOVIE":
        notes.say(f'picture "{image.name}": a film stays at one of its pictures')
    pixels = raw_pixels(image)
    if pixels is None:
        notes.say(f'picture "{image.name}" cannot be read: magenta stands in')
        return np.array([[[1.0, 0.0, 1.0, 1.0]]], np.float32)
    if not is_linear(image, notes):
        pixels[..., :3] = from_srgb(pixels[..., :3])
    return pixels


def sample(pixels, points, extension="REPEAT", is_closest=False):
    """At points (..., 2) of its unit square, between its pixels."""
    height, width = pixels.shape[:2]
    at = points * (width, height) - (0 if is_closest else 0.5)
    low = np.floor(at).astype(np.int64)
    part = at - low

    def texel(x, y):
        if extension == "REPEAT":
            return pixels[y % height, x % width]
        found = pixels[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]
        if extension == "CLIP":
            inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
            return found * inside[..., None]
        return found

    x, y = low[..., 0], low[..., 1]
    if is_closest or not part.any():
        return texel(x, y)
    u, v = part[..., :1].astype(np.float32), part[..., 1:].astype(np.float32)
    return (texel(x, y) * (1 - u) + texel(x + 1, y) * u) * (1 - v) + (
        texel(x, y + 1) * (1 - u) + texel(x + 1, y + 1) * u) * v
