"""What is to be seen, put together by calls or read from a file."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_uint64, c_void_p
from typing import Any, Optional

import numpy
from numpy.typing import ArrayLike, NDArray

from ._arguments import Parameters, Path, Poll, check_borrowed, encoded, ends_address, matrix_address, parameter_array
from ._declarations import (Camera, Image, Instance, Light, Named, RenderSettings, SceneHint, Shape, Status, Texture,
                            TextureValue)
from ._errors import opened
from ._interface import library
from ._rendering import Rendering, pixels_of

_HINTS = {each.name.replace("_", "").lower(): each for each in SceneHint}
_NAMED = {each.name.replace("_", " ").lower(): each for each in Named}
_TEXTURE_VALUES = {each.name.lower(): each for each in TextureValue}


def _one_of(names, name):
    if name not in names:
        raise ValueError(f'"{name}" is none of: {", ".join(names)}')
    return names[name]


class Scene:
    """Made by Context.scene, load or load_text. Of one that is complete, by rendering it, the camera alone can change; of
    one that was made with Context.scene(editable=True) all can, by instead, instead_of, move, assign, remove and further
    calls, as long as no rendering of it is open. Such changes take effect with the next complete, or picture; where that
    fails they are dropped. What did not change is kept, and the picture is, to the last bit, that of a scene made
    afresh. Matrices are 4 x 4, row by row, of column vectors."""

    def __init__(self, context, function, *arguments, is_complete=False):
        self._context = context
        self._held = c_void_p()
        self._renderings = []  # that are not closed
        self._is_complete = self._was_complete = is_complete
        self._lent = {}  # by handle: the arrays that the library borrows, as of the last commit
        self._lent_since = []  # handles, and their arrays or None, as they were said since
        context._scenes.append(self)
        try:
            context._work(function, context._pointer, *arguments, byref(self._held))
        except BaseException:
            self.close()
            raise

    @property
    def _pointer(self):
        return opened(self._held, "scene")

    def _call(self, function, *arguments, handle=None, lent=None):
        """handle: a c_uint64 with the handle of what borrows the arrays `lent` from now on, or with None none any more."""
        self._context._expect_rest()
        status = function(self._pointer, *arguments)
        if status == Status.OK:  # before anything is raised: what was done is done, whoever takes offence at a warning
            self._is_complete = False
            if handle is not None:
                self._lent_since.append((handle.value, lent))
        self._context._check(status)

    def _named(self, function, name, kind, parameters):
        kept = []
        self._call(function, name, encoded(kind), *parameter_array(parameters, kept))

    def hint(self, directive: str, type: str, parameters: Parameters = None) -> None:
        """What the scene wishes of the picture; directive: "Film", "Sampler", "Integrator" or "PixelFilter"."""
        self._named(library.ag_scene_set_hint, _one_of(_HINTS, directive.lower()), type, parameters)

    def material(self, name: str, type: str, parameters: Parameters = None, *, instead: bool = False) -> None:
        """A material for shapes to name. instead: of the one of that name, in a scene that can be changed."""
        function = library.ag_scene_change_material if instead else library.ag_scene_add_material
        self._named(function, encoded(name), type, parameters)

    def medium(self, name: str, type: str, parameters: Parameters = None, *, instead: bool = False) -> None:
        """A medium for shapes, lights and the camera to name. instead: as of material."""
        function = library.ag_scene_change_medium if instead else library.ag_scene_add_medium
        self._named(function, encoded(name), type, parameters)

    def texture(self, name: str, value: str, type: str, parameters: Parameters = None,
                world_from_texture: Optional[ArrayLike] = None, *, instead: bool = False) -> None:
        """A texture for parameters of type "texture" to name; value: "float" or "spectrum". instead: as of material."""
        kept = []
        items, count = parameter_array(parameters, kept)
        function = library.ag_scene_change_texture if instead else library.ag_scene_add_texture
        self._call(function, byref(Texture(
            ctypes.sizeof(Texture), encoded(name), _one_of(_TEXTURE_VALUES, value), encoded(type), items, count,
            matrix_address(world_from_texture, kept))))

    def image(self, name: str, pixels: ArrayLike, *, instead: bool = False) -> None:
        """Pixels that stand in for the file of that name: (height, width) or (height, width, channels), bytes as an
        8-bit file has them, all else as linear floats. instead: as of material."""
        array = numpy.asarray(pixels)
        if array.ndim not in (2, 3):
            raise ValueError("a picture has two or three dimensions")
        is_bytes = array.dtype == numpy.uint8
        array = numpy.require(array, numpy.uint8 if is_bytes else numpy.float32, "CA")
        made = Image(ctypes.sizeof(Image), array.shape[1], array.shape[0], array.shape[2] if array.ndim == 3 else 1)
        setattr(made, "bytes" if is_bytes else "floats", array.ctypes.data)
        function = library.ag_scene_change_image if instead else library.ag_scene_add_image
        self._call(function, encoded(name), byref(made))

    def shape(self, type: str, parameters: Parameters = None, *, material: Optional[str] = None,
              light: Parameters = None, object: Optional[str] = None, world_from_shape: Optional[ArrayLike] = None,
              world_from_shape_end: Optional[ArrayLike] = None, reverse_orientation: bool = False,
              medium_inside: Optional[str] = None, medium_outside: Optional[str] = None, borrow: bool = False,
              instead_of: Optional[int] = None) -> int:
        """A shape; gives its handle. object: the name of what it is a part of, which instances show; None: it stands where
        it is. light: the parameters of an AreaLightSource, {} for its defaults; None: it does not shine. Of a "trianglemesh"
        whose vertices move while the shutter is open P is (steps, vertices, 3), N likewise, and "integer motionsteps" is steps.
        world_from_shape_end: where it is as the shutter closes; or several matrices, (count, 4, 4), for evenly spaced times
        behind the opening, the last for the closing.

        borrow: the arrays of a "trianglemesh", P from vertices() and uv of 32-bit floats, indices of 32-bit integers, are
        used where they are, without a copy, and kept alive; who writes to them says so by instead_of. instead_of: the
        handle of the shape whose place it takes, in a scene that can be changed."""
        kept = []
        if borrow:
            check_borrowed(parameters or {})
        items, count = parameter_array(parameters, kept)
        light_items, light_count = parameter_array(light, kept)
        shape = Shape(ctypes.sizeof(Shape), encoded(type), items, count, encoded(material), encoded(object),
                      matrix_address(world_from_shape, kept), *ends_address(world_from_shape_end, kept),
                      reverse_orientation, light is not None, light_items, light_count, encoded(medium_inside),
                      encoded(medium_outside), borrow)
        return self._place("shape", shape, instead_of, kept if borrow else None)

    def instance(self, object: str, world_from_object: Optional[ArrayLike] = None,
                 world_from_object_end: Optional[ArrayLike] = None, *, instead_of: Optional[int] = None) -> int:
        """Shows the shapes that were made with that object's name; gives its handle. world_from_object_end, instead_of: as of
        shape."""
        kept = []
        return self._place("instance", Instance(ctypes.sizeof(Instance), encoded(object),
                                                matrix_address(world_from_object, kept),
                                                *ends_address(world_from_object_end, kept)), instead_of)

    def light(self, type: str, parameters: Parameters = None, *, world_from_light: Optional[ArrayLike] = None,
              medium_outside: Optional[str] = None, instead_of: Optional[int] = None) -> int:
        """A light that is no shape, "point", "spot", "distant", "infinite" and so on; gives its handle. instead_of: as of
        shape."""
        kept = []
        items, count = parameter_array(parameters, kept)
        return self._place("light", Light(ctypes.sizeof(Light), encoded(type), items, count,
                                          matrix_address(world_from_light, kept), encoded(medium_outside)), instead_of)

    def _place(self, kind, description, instead_of, lent=None):
        """Adds what has a handle, or lets it take the place of another; lent: the arrays that are borrowed for it."""
        if instead_of is not None:
            self._call(getattr(library, f"ag_scene_change_{kind}"), instead_of, byref(description),
                       handle=c_uint64(instead_of), lent=lent)
            return instead_of
        handle = c_uint64()
        self._call(getattr(library, f"ag_scene_add_{kind}"), byref(description), byref(handle),
                   handle=handle if lent else None, lent=lent)
        return handle.value

    def move(self, handle: int, world_from_own: Optional[ArrayLike] = None,
             world_from_own_end: Optional[ArrayLike] = None) -> None:
        """Places a light, an instance or a shape that is no mesh by another matrix."""
        kept = []
        self._call(library.ag_scene_move, handle, matrix_address(world_from_own, kept),
                   matrix_address(world_from_own_end, kept))

    def assign(self, shape: int, material: Optional[str]) -> None:
        """Gives a shape another material; nothing of it is read anew."""
        self._call(library.ag_scene_assign_material, shape, encoded(material))

    def remove(self, handle: int) -> None:
        """Removes a shape, a light or an instance."""
        self._call(library.ag_scene_remove, handle, handle=c_uint64(handle))

    def remove_named(self, kind: str, name: str) -> None:
        """Removes what has a name; kind: "material", "medium", "float texture", "spectrum texture" or "image"."""
        self._call(library.ag_scene_remove_named, _one_of(_NAMED, kind), encoded(name))

    def commit_counts(self) -> dict[str, int]:
        """What the commits of a scene that can be changed have made in all: "commits", "meshes_made", "trees_built",
        "trees_kept", "pictures_read", "pictures_kept"."""
        counts = library.ag_scene_commit_counts(self._pointer)
        return {name: getattr(counts, name) for name, _ in counts._fields_}

    def camera(self, type: str = "perspective", parameters: Parameters = None, *,
               world_from_camera: Optional[ArrayLike] = None, world_from_camera_end: Optional[ArrayLike] = None,
               medium: Optional[str] = None) -> None:
        """The camera, instead of the one before. It looks along +z; x is to the right and y up."""
        self._context._expect_rest()
        kept = []
        items, count = parameter_array(parameters, kept)
        made = Camera(ctypes.sizeof(Camera), encoded(type), items, count, matrix_address(world_from_camera, kept),
                        matrix_address(world_from_camera_end, kept), encoded(medium))
        self._context._check(library.ag_scene_set_camera(self._pointer, byref(made)))

    def complete(self, poll: Poll = None) -> None:
        """Builds what rays need; rendering does so where it is not done yet. poll: as for Rendering.advance."""
        if self._is_complete:
            return
        statuses = []

        def commit(pointer):
            statuses.append(library.ag_scene_commit(pointer))
            return statuses[0]

        try:
            self._context._work(commit, self._pointer, poll=poll)
        finally:  # the library has done it, or has not, whatever was raised beside it
            if statuses:
                self._note_commit(statuses[0] == Status.OK)

    def _note_commit(self, is_done):
        """Which arrays are lent from now on: where it failed after one that did not, the changes since are dropped."""
        if is_done:
            for handle, lent in self._lent_since:
                self._lent.pop(handle, None)
                if lent:
                    self._lent[handle] = lent
        if is_done or self._was_complete:
            self._lent_since = []
            self._is_complete = self._was_complete = True

    def _settings(self, values):
        """An ag_render_settings, and what it borrows."""
        room = RenderSettings()
        self._context._check(library.ag_render_settings_fill(self._context._pointer, self._pointer, byref(room),
                                                             ctypes.sizeof(room)))
        kept = [room]
        for name, value in values.items():
            kept.append(None if value is True else encoded(str(value)))
            name = name.replace("_", "-")
            if library.ag_render_settings_set(room, name.encode(), kept[-1]) != Status.OK:
                raise ValueError(f"{name}: there is no such setting, or {value!r} is no value of it")
        return room, kept

    def render(self, write_to: Optional[Path] = None, **settings: Any) -> NDArray[numpy.float32]:
        """Completes the scene, renders it, and gives its pixels. settings: options of the program by name, with _ for
        -: size="320x180", spp=16, noise=0.02, integrator="path", photon_map="room.map"; True for those without a
        value. write_to: a file that the picture is written to as well."""
        context, film = self._context, c_void_p()
        self.complete()
        room, _kept = self._settings(settings)
        try:
            context._work(library.ag_render, context._pointer, self._pointer, room, byref(film))
            if write_to is not None:
                context._work(library.ag_film_write, context._pointer, film, None, encoded(write_to))
            return pixels_of(film)
        finally:
            library.ag_film_destroy(film)

    def rendering(self, poll: Poll = None, **settings: Any) -> Rendering:
        """A picture that grows. Completes the scene and traces its photons. settings: as for render."""
        return Rendering(self, settings, poll)

    def close(self) -> None:
        """Forgets the scene; closes its renderings."""
        self._context._expect_rest()
        for rendering in list(self._renderings):
            rendering.close()
        if self in self._context._scenes:
            self._context._scenes.remove(self)
        if self._held:
            library.ag_scene_destroy(self._held)
            self._held = c_void_p()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
