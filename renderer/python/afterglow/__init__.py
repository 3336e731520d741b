"""Afterglow, a global illumination renderer with photon mapping and final gathering, over its C library.

    with afterglow.Context() as context, context.scene() as scene:
        scene.camera("perspective", {"float fov": 40}, world_from_camera=matrix)
        scene.material("red", "diffuse", {"rgb reflectance": (0.6, 0.1, 0.1)})
        scene.shape("trianglemesh", {"point3 P": positions, "integer indices": triangles}, material="red")
        scene.light("point", {"rgb I": (10, 10, 10)})
        pixels = scene.render(size="320x180", spp=16)

Directives, parameters, units and defaults are those of pbrt-v4's text (pbrt.org/fileformat-v4). Values are numbers,
strings, sequences, or numpy arrays: those of 32-bit floats, 64-bit floats and 32-bit integers are handed to the library
where they lie, which copies them once. Pictures are arrays of shape (height, width, 3), linear RGB of the working space.

    with scene.rendering(size="320x180", spp=64, aov="Z") as rendering:
        for samples in (1, 4, 16, 64):
            rendering.advance(samples)  # the same bits as at once
        depth = rendering.channels()["Z"]

The library is libafterglow.so, found as the system finds libraries, or named by $AFTERGLOW_LIBRARY. A context and its
scenes belong to one thread at a time; rendering lets go of Python's lock, so that other threads go on meanwhile.
Callbacks may call cancel and watch alone: other calls are errors while the context is at work.
"""

from ._arguments import vertices
from ._context import Context
from ._errors import Cancelled, Error
from ._interface import library as _library
from ._rendering import Rendering
from ._scene import Scene

__all__ = ["Context", "Scene", "Rendering", "Error", "Cancelled", "version", "vertices"]


def version() -> str:
    """The library's version, "MAJOR.MINOR.PATCH"."""
    return _library.ag_version().decode()


for _public in (Context, Scene, Rendering, Error, Cancelled, vertices):
    _public.__module__ = __name__  # as messages and help name them
