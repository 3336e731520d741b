"""A picture over a region of Blender's window."""

import numpy as np


def draw(pixels, size):
    """pixels: (height, width, 3), top row first; stretched to the region's size until there is one of that size."""
    import gpu  # what runs without a window has none
    from gpu_extras.presets import draw_texture_2d

    height, width = pixels.shape[:2]
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = pixels[::-1]
    buffer = gpu.types.Buffer("FLOAT", rgba.size, rgba.ravel())
    texture = gpu.types.GPUTexture((width, height), format="RGBA32F", data=buffer)
    gpu.state.blend_set("ALPHA_PREMULT")
    draw_texture_2d(texture, (0, 0), *size)
    gpu.state.blend_set("NONE")
