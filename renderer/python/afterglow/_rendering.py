"""Pictures, and those that grow."""

from __future__ import annotations

import operator
from ctypes import POINTER, byref, c_float, c_int, c_void_p
from typing import Any, Optional

import numpy
from numpy.typing import NDArray

from ._arguments import Poll
from ._errors import opened
from ._interface import library


def pixels_of(film):
    width, height = c_int(), c_int()
    pixels = library.ag_film_pixels(film, byref(width), byref(height))
    return numpy.ctypeslib.as_array(pixels, (height.value, width.value, 3)).copy()


def _floats(array):
    return array.ctypes.data_as(POINTER(c_float))


class Rendering:
    """Made by Scene.rendering. The scene and its camera stay as they are until it is closed. `shape` is the picture's,
    (height, width)."""

    shape: tuple[int, int]

    def __init__(self, scene, settings, poll):
        self._context, self._scene, self._held, self._film = scene._context, scene, c_void_p(), c_void_p()
        scene.complete(poll)
        room, _kept = scene._settings(settings)
        scene._renderings.append(self)
        try:
            self._context._work(library.ag_rendering_create, self._context._pointer, scene._pointer, room,
                                byref(self._held), poll=poll)
        except BaseException:
            self.close()
            raise
        width, height = c_int(), c_int()
        library.ag_film_pixels(self._shown(), byref(width), byref(height))
        self.shape = (height.value, width.value)
        self._watched, self._version = numpy.zeros((*self.shape, 3), numpy.float32), 0

    @property
    def _pointer(self):
        return opened(self._held, "rendering")

    def _shown(self):
        return self._film or c_void_p(library.ag_rendering_film(self._pointer))

    def advance(self, samples: int, poll: Poll = None) -> None:
        """Brings every pixel to so many samples, or to the noise that was asked for: those of the settings at most. poll:
        called about every 0.1 s meanwhile, on the calling thread; an exception there calls the work off."""
        self._context._work(library.ag_rendering_continue, self._pointer, operator.index(samples), poll=poll)

    def watch(self) -> Optional[NDArray[numpy.float32]]:
        """The picture as far as it is shown by now, whole tiles, from any thread and while it is at work; None where
        nothing is new. The array is the same in each call."""
        version = library.ag_film_read_picture(self._shown(), self._version, _floats(self._watched))
        is_new, self._version = version != self._version, version
        return self._watched if is_new else None

    def sample_counts(self) -> tuple[int, int, float]:
        """The least, the most, and the mean number of samples that a pixel has had."""
        counts = library.ag_rendering_sample_counts(self._pointer)
        return counts.least, counts.most, counts.mean

    def pixels(self) -> NDArray[numpy.float32]:
        """A copy of the picture."""
        return pixels_of(self._shown())

    def channels(self) -> dict[str, NDArray[numpy.float32]]:
        """Copies of picture and layers, (height, width) each, by the names that they have in a file: "R", "Z", "N.X"."""
        film, found = self._shown(), {}
        for number in range(library.ag_film_channel_count(film)):
            values = numpy.empty(self.shape, numpy.float32)
            self._context._check(library.ag_film_read_channel(film, number, _floats(values)))
            found[library.ag_film_channel_name(film, number).decode()] = values
        return found

    def denoise(self, poll: Poll = None) -> None:
        """Ends the rendering and takes the noise out of R, G and B, by Open Image Denoise; denoise=True among the
        settings has kept what it needs. The channels stay to be read."""
        self._context._expect_rest()
        library.ag_rendering_finish(self._pointer, byref(self._film))
        self._held = c_void_p()
        self._context._work(library.ag_film_denoise, self._context._pointer, self._film, poll=poll)

    def close(self) -> None:
        """Ends the rendering and forgets its picture."""
        if self._held:
            self._context._expect_rest()
        if self in self._scene._renderings:
            self._scene._renderings.remove(self)
        library.ag_rendering_finish(self._held, None)
        library.ag_film_destroy(self._film)
        self._held, self._film = c_void_p(), c_void_p()

    def __enter__(self) -> Rendering:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
