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

from __future__ import annotations

import ctypes
import ctypes.util
import operator
import os
import threading
import warnings
from collections.abc import Callable, Mapping
from typing import Any, Optional, Union
from ctypes import (POINTER, byref, c_bool, c_char_p, c_double, c_float, c_int, c_size_t, c_uint, c_uint64, c_void_p)

import numpy
from numpy.typing import ArrayLike, NDArray

__all__ = ["Context", "Scene", "Rendering", "Error", "Cancelled", "version", "vertices"]

_Path = Union[str, bytes, os.PathLike]
_Parameters = Optional[Mapping[str, Any]]  # {"rgb reflectance": (1, 0, 0)}
_Poll = Optional[Callable[[], None]]

_CANCELLED = 9  # AG_CANCELLED
_PARAMETER_TYPES = ["float", "integer", "string", "bool", "point2", "vector2", "point3", "vector3", "normal", "rgb",
                    "spectrum", "blackbody", "texture"]
_HINTS = {"film": 0, "sampler": 1, "integrator": 2, "pixelfilter": 3}
_NAMED = ["material", "medium", "float texture", "spectrum texture", "image"]  # as in ag_named
_SCENE_SETTINGS = 1  # AG_STRUCT_SCENE_SETTINGS
_RENDER_SETTINGS = 2  # AG_STRUCT_RENDER_SETTINGS, which are only handed on

_LOG = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p)
_PROGRESS = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_double)


class Error(Exception):
    """What the library could not do, with what its log says of it."""


class Cancelled(Error):
    """The work was called off, by Context.cancel."""


class _ContextSettings(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("thread_count", c_uint), ("isa", c_char_p), ("color_config", c_char_p),
                ("working_space", c_char_p), ("is_confined", c_bool), ("confined_to", POINTER(c_char_p)),
                ("confined_count", c_size_t), ("log", _LOG), ("progress", _PROGRESS), ("user", c_void_p)]


class _Parameter(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("type", c_int), ("count", c_size_t), ("floats", c_void_p), ("doubles", c_void_p),
                ("integers", c_void_p), ("strings", POINTER(c_char_p)), ("bools", c_void_p)]


class _Shape(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("type", c_char_p), ("parameters", POINTER(_Parameter)),
                ("parameter_count", c_size_t), ("material", c_char_p), ("object", c_char_p),
                ("world_from_shape", c_void_p), ("world_from_shape_end", c_void_p), ("reverse_orientation", c_bool),
                ("is_light", c_bool), ("light_parameters", POINTER(_Parameter)), ("light_parameter_count", c_size_t),
                ("medium_inside", c_char_p), ("medium_outside", c_char_p), ("borrows_arrays", c_bool)]


class _SceneSettings(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("definitions", c_void_p), ("definition_count", c_size_t),
                ("gltf_light_units", c_int), ("has_camera", c_bool), ("camera_from", c_float * 3),
                ("camera_to", c_float * 3), ("camera_up", c_float * 3), ("camera_fov_degrees", c_float),
                ("camera_name", c_char_p), ("texture_memory_bytes", c_uint64),
                ("texture_cache", c_char_p), ("texture_cache_bytes", c_uint64), ("drops_lights", c_bool), ("up", c_int),
                ("has_sun", c_bool), ("sun_azimuth_degrees", c_float), ("sun_elevation_degrees", c_float),
                ("sun_irradiance", c_float), ("sun_angle_degrees", c_float), ("has_sky", c_bool),
                ("sky_radiance", c_float * 3), ("sky_file", c_char_p), ("sky_rotation_degrees", c_float),
                ("find_file", c_void_p), ("find_file_user", c_void_p), ("is_editable", c_bool)]


class _CommitCounts(ctypes.Structure):
    _fields_ = [(name, c_uint64) for name in ("commits", "meshes_made", "trees_built", "trees_kept", "pictures_read",
                                              "pictures_kept")]


class _Instance(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("object", c_char_p), ("world_from_object", c_void_p),
                ("world_from_object_end", c_void_p)]


class _Light(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("type", c_char_p), ("parameters", POINTER(_Parameter)),
                ("parameter_count", c_size_t), ("world_from_light", c_void_p), ("medium_outside", c_char_p)]


class _Camera(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("type", c_char_p), ("parameters", POINTER(_Parameter)),
                ("parameter_count", c_size_t), ("world_from_camera", c_void_p), ("world_from_camera_end", c_void_p),
                ("medium", c_char_p)]


class _Texture(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("name", c_char_p), ("value", c_int), ("type", c_char_p),
                ("parameters", POINTER(_Parameter)), ("parameter_count", c_size_t), ("world_from_texture", c_void_p)]


class _Image(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("width", c_int), ("height", c_int), ("channel_count", c_int),
                ("bytes", c_void_p), ("floats", c_void_p)]


class _SampleCounts(ctypes.Structure):
    _fields_ = [("least", c_int), ("most", c_int), ("mean", c_double)]


def _load_library():
    name = os.environ.get("AFTERGLOW_LIBRARY") or ctypes.util.find_library("afterglow")
    if not name:
        raise ImportError("libafterglow is not installed, and $AFTERGLOW_LIBRARY does not name it")
    library = ctypes.CDLL(name)
    parameters = [POINTER(_Parameter), c_size_t]
    signatures = {
        "ag_version": (c_char_p, []),
        "ag_status_text": (c_char_p, [c_int]),
        "ag_context_create": (c_int, [POINTER(_ContextSettings), POINTER(c_void_p)]),
        "ag_context_destroy": (None, [c_void_p]),
        "ag_context_cancel": (None, [c_void_p]),
        "ag_context_clear_cancel": (None, [c_void_p]),
        "ag_scene_create": (c_int, [c_void_p, c_void_p, POINTER(c_void_p)]),
        "ag_scene_load": (c_int, [c_void_p, c_char_p, POINTER(c_void_p)]),
        "ag_scene_load_text": (c_int, [c_void_p, c_char_p, c_char_p, c_size_t, c_void_p, POINTER(c_void_p)]),
        "ag_scene_commit": (c_int, [c_void_p]),
        "ag_scene_destroy": (None, [c_void_p]),
        "ag_scene_add_shape": (c_int, [c_void_p, POINTER(_Shape), POINTER(c_uint64)]),
        "ag_scene_add_instance": (c_int, [c_void_p, POINTER(_Instance), POINTER(c_uint64)]),
        "ag_scene_add_light": (c_int, [c_void_p, POINTER(_Light), POINTER(c_uint64)]),
        "ag_scene_set_camera": (c_int, [c_void_p, POINTER(_Camera)]),
        "ag_scene_add_texture": (c_int, [c_void_p, POINTER(_Texture)]),
        "ag_scene_add_image": (c_int, [c_void_p, c_char_p, POINTER(_Image)]),
        "ag_scene_add_material": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_add_medium": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_set_hint": (c_int, [c_void_p, c_int, c_char_p] + parameters),
        "ag_render_settings_fill": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t]),
        "ag_struct_size": (c_size_t, [c_int]),
        "ag_struct_fill": (None, [c_int, c_void_p, c_size_t]),
        "ag_scene_change_shape": (c_int, [c_void_p, c_uint64, POINTER(_Shape)]),
        "ag_scene_change_instance": (c_int, [c_void_p, c_uint64, POINTER(_Instance)]),
        "ag_scene_change_light": (c_int, [c_void_p, c_uint64, POINTER(_Light)]),
        "ag_scene_change_texture": (c_int, [c_void_p, POINTER(_Texture)]),
        "ag_scene_change_image": (c_int, [c_void_p, c_char_p, POINTER(_Image)]),
        "ag_scene_change_material": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_change_medium": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_move": (c_int, [c_void_p, c_uint64, c_void_p, c_void_p]),
        "ag_scene_assign_material": (c_int, [c_void_p, c_uint64, c_char_p]),
        "ag_scene_remove": (c_int, [c_void_p, c_uint64]),
        "ag_scene_remove_named": (c_int, [c_void_p, c_int, c_char_p]),
        "ag_scene_commit_counts": (_CommitCounts, [c_void_p]),
        "ag_render_settings_set": (c_int, [c_void_p, c_char_p, c_char_p]),
        "ag_render": (c_int, [c_void_p, c_void_p, c_void_p, POINTER(c_void_p)]),
        "ag_rendering_create": (c_int, [c_void_p, c_void_p, c_void_p, POINTER(c_void_p)]),
        "ag_rendering_continue": (c_int, [c_void_p, c_int]),
        "ag_rendering_sample_counts": (_SampleCounts, [c_void_p]),
        "ag_rendering_film": (c_void_p, [c_void_p]),
        "ag_rendering_finish": (None, [c_void_p, POINTER(c_void_p)]),
        "ag_film_channel_count": (c_int, [c_void_p]),
        "ag_film_channel_name": (c_char_p, [c_void_p, c_int]),
        "ag_film_read_channel": (c_int, [c_void_p, c_int, POINTER(c_float)]),
        "ag_film_read_picture": (c_uint64, [c_void_p, c_uint64, POINTER(c_float)]),
        "ag_film_denoise": (c_int, [c_void_p, c_void_p]),
        "ag_film_destroy": (None, [c_void_p]),
        "ag_film_pixels": (POINTER(c_float), [c_void_p, POINTER(c_int), POINTER(c_int)]),
        "ag_film_write": (c_int, [c_void_p, c_void_p, c_void_p, c_char_p]),
    }
    for function, (result, arguments) in signatures.items():
        getattr(library, function).restype = result
        getattr(library, function).argtypes = arguments
    return library


_library = _load_library()


def version() -> str:
    """The library's version, "MAJOR.MINOR.PATCH"."""
    return _library.ag_version().decode()


def _opened(held, what):
    """A pointer that the library may be given. Errors: Error, where what it points to is closed."""
    if not held:
        raise Error(f"the {what} is closed")
    return held


def _text(value):
    made = None if value is None else os.fsencode(value)
    if made and b"\0" in made:
        raise ValueError("a text with a NUL in it cannot be handed on")
    return made


def _matrix(value, kept):
    """The address of 16 numbers, row by row, which `kept` keeps; None: no matrix."""
    if value is None:
        return None
    rows = numpy.require(value, numpy.float64, "CA")
    if rows.size != 16:
        raise ValueError("a matrix has 4 x 4 numbers")
    kept.append(rows)
    return rows.ctypes.data


def _strings(values, kept):
    array = (c_char_p * len(values))(*[_text(value) for value in values])
    kept.append(array)
    return ctypes.cast(array, POINTER(c_char_p))


def _parameter(declaration, value, kept):
    """One of {"rgb reflectance": (1, 0, 0)}; what it points to is kept by `kept`."""
    words = declaration.split()
    if len(words) != 2 or words[0] not in _PARAMETER_TYPES:
        raise ValueError(f'"{declaration}" is no "type name" of a parameter')
    made = _Parameter(name=words[1].encode(), type=_PARAMETER_TYPES.index(words[0]))
    if isinstance(value, (str, os.PathLike)):
        value = [value]
    if isinstance(value, (list, tuple)) and value and isinstance(value[0], (str, os.PathLike)):
        made.count, made.strings = len(value), _strings(value, kept)
        return made
    array = numpy.asarray(value)
    if words[0] == "bool":
        array, field = array.astype(numpy.bool_), "bools"
    elif words[0] == "integer":
        whole = array.astype(numpy.int32)
        if not numpy.array_equal(whole, array):
            raise ValueError(f'"{declaration}": the values are no integers of 32 bits')
        array, field = whole if array.dtype != numpy.int32 else array, "integers"
    elif array.dtype == numpy.float32:
        field = "floats"
    else:
        array, field = array.astype(numpy.float64, copy=False), "doubles"
    array = numpy.require(array, requirements="CA")
    kept.append(array)
    made.count = array.size
    setattr(made, field, array.ctypes.data)
    return made


def _parameters(values, kept):
    items = [_parameter(declaration, value, kept) for declaration, value in (values or {}).items()]
    array = (_Parameter * max(len(items), 1))(*items)
    kept.append(array)
    return array, len(items)


def vertices(count: int) -> NDArray[numpy.float32]:
    """An array of zeros, (count, 3) of 32-bit floats, with the room behind it that a borrowed P needs."""
    return numpy.zeros(3 * count + 1, numpy.float32)[:-1].reshape(count, 3)


def _has_room(array):
    """Whether 4 bytes behind an array belong to the array that it is a view of."""
    whole = array
    while isinstance(whole.base, numpy.ndarray):
        whole = whole.base
    return array.ctypes.data + array.nbytes + 4 <= whole.ctypes.data + whole.nbytes


def _check_borrowed(parameters):
    for declaration, dtype in (("point3 P", "float32"), ("point2 uv", "float32"), ("integer indices", "int32")):
        array = parameters.get(declaration)
        if array is None:
            continue
        if (not isinstance(array, numpy.ndarray) or array.dtype != dtype or not array.flags.c_contiguous
                or not array.flags.aligned):
            raise ValueError(f'"{declaration}": a borrowed array is of numpy, contiguous, aligned and of {dtype}')
        if declaration == "point3 P" and not _has_room(array):
            raise ValueError('"point3 P": a borrowed array has room behind it, as those of vertices() have')


class Context:
    """Threads, log and progress. `threads`: 0 for as many as there are; `progress`: called with the number of a phase
    (AG_PHASE_..., from 0 on) and how far it is, in [0, 1], on the library's threads; an exception there calls the work
    off. `warn`: called with the text of each warning, on the thread that works with the context; None: Python's
    warnings. `color_config` and `working_space` are those of the program's options."""

    def __init__(self, threads: int = 0, progress: Optional[Callable[[int, float], None]] = None,
                 working_space: Optional[str] = None, color_config: Optional[_Path] = None,
                 warn: Optional[Callable[[str], None]] = None) -> None:
        self._said = []
        self._progress = progress
        self._warn = warn or (lambda message: warnings.warn(message, stacklevel=4))
        self._failed = None
        self._callbacks = (_LOG(self._hear), _PROGRESS(self._tell))  # they live as long as the context
        self._held = c_void_p()
        self._scenes = []  # that are not closed
        self._is_at_work = False
        settings = _ContextSettings(struct_size=ctypes.sizeof(_ContextSettings), thread_count=threads,
                                    working_space=_text(working_space), color_config=_text(color_config),
                                    log=self._callbacks[0], progress=self._callbacks[1])
        self._check(_library.ag_context_create(byref(settings), byref(self._held)))

    @property
    def _pointer(self):
        return _opened(self._held, "context")

    def _hear(self, _user, level, message):
        if level <= 1:
            self._said.append(message.decode(errors="replace"))

    def _tell(self, _user, phase, fraction):
        if not self._progress or self._failed:
            return
        try:
            self._progress(phase, fraction)
        except BaseException as failed:  # it is raised where the work was begun
            self._failed = failed
            self.cancel()

    def _check(self, status):
        said, self._said = self._said, []
        failed, self._failed = self._failed, None
        if failed:
            _library.ag_context_clear_cancel(self._pointer)
            raise failed
        if status == 0:
            for message in said:
                self._warn(message)
            return
        text = "\n".join(said) or _library.ag_status_text(status).decode()
        raise (Cancelled if status == _CANCELLED else Error)(text)

    def _work(self, function, *arguments, poll=None):
        """Calls the library on a thread of its own, so that Ctrl-C is heard here meanwhile, and calls it off. poll: called
        about every 0.1 s; so does an exception there."""
        self._expect_rest()
        self._is_at_work = True
        try:
            status = self._work_aside(function, arguments, poll)
        finally:
            self._is_at_work = False
        self._check(status)

    def _expect_rest(self):
        """Errors: Error, where the context is at work; its callbacks may not call what would work with it as well."""
        if self._is_at_work:
            raise Error("the context is at work, and until that is done only cancel and watch can be called")

    def _work_aside(self, function, arguments, poll):
        result, failed = [], []
        is_done = threading.Event()  # an interrupted Thread.join takes the thread for ended (bpo-45274)

        def work():
            try:
                result.append(function(*arguments))
            except BaseException as error:  # of an argument's type; it is raised on the calling thread
                failed.append(error)
            finally:
                is_done.set()

        threading.Thread(target=work).start()
        try:
            while not is_done.wait(0.1):
                if poll:
                    poll()
        except BaseException:
            self.cancel()
            while not is_done.is_set():  # what the library works on is still its own, however often Ctrl-C is pressed
                try:
                    is_done.wait()
                except KeyboardInterrupt:
                    pass
            _library.ag_context_clear_cancel(self._pointer)
            self._said = []
            raise
        if failed:
            raise failed[0]
        return result[0]

    def cancel(self) -> None:
        """Calls the work under way off, within 50 ms; from any thread."""
        _library.ag_context_cancel(self._pointer)

    def scene(self, editable: bool = False) -> Scene:
        """An empty scene. editable: it can be changed once it is complete."""
        self._expect_rest()
        settings = _SceneSettings()
        _library.ag_struct_fill(_SCENE_SETTINGS, byref(settings), ctypes.sizeof(settings))
        settings.is_editable = editable
        return Scene(self, _library.ag_scene_create, byref(settings))

    def load(self, path: _Path) -> Scene:
        """The scene of a file: pbrt-v4's text, glTF, OBJ and what else the program reads."""
        return Scene(self, _library.ag_scene_load, _text(path), is_complete=True)

    def load_text(self, text: Union[str, bytes], name: str = "text") -> Scene:
        """The scene of pbrt-v4's text; files are looked for in the folder in front of the name's last slash."""
        text = text.encode() if isinstance(text, str) else text
        return Scene(self, _library.ag_scene_load_text, _text(name), text, len(text), None, is_complete=True)

    def close(self) -> None:
        """Ends the context; closes its scenes and their renderings."""
        self._expect_rest()
        for scene in list(self._scenes):
            scene.close()
        if self._held:
            _library.ag_context_destroy(self._held)
            self._held = c_void_p()

    def __enter__(self) -> Context:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


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
        return _opened(self._held, "scene")

    def _call(self, function, *arguments, handle=None, lent=None):
        """handle: a c_uint64 with the handle of what borrows the arrays `lent` from now on, or with None none any more."""
        self._context._expect_rest()
        status = function(self._pointer, *arguments)
        if status == 0:  # before anything is raised: what was done is done, whoever takes offence at a warning
            self._is_complete = False
            if handle is not None:
                self._lent_since.append((handle.value, lent))
        self._context._check(status)

    def _named(self, function, name, kind, parameters):
        kept = []
        self._call(function, name, _text(kind), *_parameters(parameters, kept))

    def hint(self, directive: str, type: str, parameters: _Parameters = None) -> None:
        """What the scene wishes of the picture; directive: "Film", "Sampler", "Integrator" or "PixelFilter"."""
        self._named(_library.ag_scene_set_hint, _HINTS[directive.lower()], type, parameters)

    def material(self, name: str, type: str, parameters: _Parameters = None, *, instead: bool = False) -> None:
        """A material for shapes to name. instead: of the one of that name, in a scene that can be changed."""
        function = _library.ag_scene_change_material if instead else _library.ag_scene_add_material
        self._named(function, _text(name), type, parameters)

    def medium(self, name: str, type: str, parameters: _Parameters = None, *, instead: bool = False) -> None:
        """A medium for shapes, lights and the camera to name. instead: as of material."""
        function = _library.ag_scene_change_medium if instead else _library.ag_scene_add_medium
        self._named(function, _text(name), type, parameters)

    def texture(self, name: str, value: str, type: str, parameters: _Parameters = None,
                world_from_texture: Optional[ArrayLike] = None, *, instead: bool = False) -> None:
        """A texture for parameters of type "texture" to name; value: "float" or "spectrum". instead: as of material."""
        kept = []
        items, count = _parameters(parameters, kept)
        function = _library.ag_scene_change_texture if instead else _library.ag_scene_add_texture
        self._call(function, byref(_Texture(
            ctypes.sizeof(_Texture), _text(name), ("float", "spectrum").index(value), _text(type), items, count,
            _matrix(world_from_texture, kept))))

    def image(self, name: str, pixels: ArrayLike, *, instead: bool = False) -> None:
        """Pixels that stand in for the file of that name: (height, width) or (height, width, channels), bytes as an
        8-bit file has them, all else as linear floats. instead: as of material."""
        array = numpy.asarray(pixels)
        if array.ndim not in (2, 3):
            raise ValueError("a picture has two or three dimensions")
        is_bytes = array.dtype == numpy.uint8
        array = numpy.require(array, numpy.uint8 if is_bytes else numpy.float32, "CA")
        made = _Image(ctypes.sizeof(_Image), array.shape[1], array.shape[0], array.shape[2] if array.ndim == 3 else 1)
        setattr(made, "bytes" if is_bytes else "floats", array.ctypes.data)
        function = _library.ag_scene_change_image if instead else _library.ag_scene_add_image
        self._call(function, _text(name), byref(made))

    def shape(self, type: str, parameters: _Parameters = None, *, material: Optional[str] = None,
              light: _Parameters = None, object: Optional[str] = None, world_from_shape: Optional[ArrayLike] = None,
              world_from_shape_end: Optional[ArrayLike] = None, reverse_orientation: bool = False,
              medium_inside: Optional[str] = None, medium_outside: Optional[str] = None, borrow: bool = False,
              instead_of: Optional[int] = None) -> int:
        """A shape; gives its handle. object: the name of what it is a part of, which instances show; None: it stands where
        it is. light: the parameters of an AreaLightSource, {} for its defaults; None: it does not shine.

        borrow: the arrays of a "trianglemesh", P from vertices() and uv of 32-bit floats, indices of 32-bit integers, are
        used where they are, without a copy, and kept alive; who writes to them says so by instead_of. instead_of: the
        handle of the shape whose place it takes, in a scene that can be changed."""
        kept = []
        if borrow:
            _check_borrowed(parameters or {})
        items, count = _parameters(parameters, kept)
        light_items, light_count = _parameters(light, kept)
        shape = _Shape(ctypes.sizeof(_Shape), _text(type), items, count, _text(material), _text(object),
                       _matrix(world_from_shape, kept), _matrix(world_from_shape_end, kept), reverse_orientation,
                       light is not None, light_items, light_count, _text(medium_inside), _text(medium_outside), borrow)
        return self._place("shape", shape, instead_of, kept if borrow else None)

    def instance(self, object: str, world_from_object: Optional[ArrayLike] = None,
                 world_from_object_end: Optional[ArrayLike] = None, *, instead_of: Optional[int] = None) -> int:
        """Shows the shapes that were made with that object's name; gives its handle. instead_of: as of shape."""
        kept = []
        return self._place("instance", _Instance(ctypes.sizeof(_Instance), _text(object),
                                                 _matrix(world_from_object, kept),
                                                 _matrix(world_from_object_end, kept)), instead_of)

    def light(self, type: str, parameters: _Parameters = None, *, world_from_light: Optional[ArrayLike] = None,
              medium_outside: Optional[str] = None, instead_of: Optional[int] = None) -> int:
        """A light that is no shape, "point", "spot", "distant", "infinite" and so on; gives its handle. instead_of: as of
        shape."""
        kept = []
        items, count = _parameters(parameters, kept)
        return self._place("light", _Light(ctypes.sizeof(_Light), _text(type), items, count,
                                           _matrix(world_from_light, kept), _text(medium_outside)), instead_of)

    def _place(self, kind, description, instead_of, lent=None):
        """Adds what has a handle, or lets it take the place of another; lent: the arrays that are borrowed for it."""
        if instead_of is not None:
            self._call(getattr(_library, f"ag_scene_change_{kind}"), instead_of, byref(description),
                       handle=c_uint64(instead_of), lent=lent)
            return instead_of
        handle = c_uint64()
        self._call(getattr(_library, f"ag_scene_add_{kind}"), byref(description), byref(handle),
                   handle=handle if lent else None, lent=lent)
        return handle.value

    def move(self, handle: int, world_from_own: Optional[ArrayLike] = None,
             world_from_own_end: Optional[ArrayLike] = None) -> None:
        """Places a light, an instance or a shape that is no mesh by another matrix."""
        kept = []
        self._call(_library.ag_scene_move, handle, _matrix(world_from_own, kept), _matrix(world_from_own_end, kept))

    def assign(self, shape: int, material: Optional[str]) -> None:
        """Gives a shape another material; nothing of it is read anew."""
        self._call(_library.ag_scene_assign_material, shape, _text(material))

    def remove(self, handle: int) -> None:
        """Removes a shape, a light or an instance."""
        self._call(_library.ag_scene_remove, handle, handle=c_uint64(handle))

    def remove_named(self, kind: str, name: str) -> None:
        """Removes what has a name; kind: "material", "medium", "float texture", "spectrum texture" or "image"."""
        self._call(_library.ag_scene_remove_named, _NAMED.index(kind), _text(name))

    def commit_counts(self) -> dict[str, int]:
        """What the commits of a scene that can be changed have made in all: "commits", "meshes_made", "trees_built",
        "trees_kept", "pictures_read", "pictures_kept"."""
        counts = _library.ag_scene_commit_counts(self._pointer)
        return {name: getattr(counts, name) for name, _ in counts._fields_}

    def camera(self, type: str = "perspective", parameters: _Parameters = None, *,
               world_from_camera: Optional[ArrayLike] = None, world_from_camera_end: Optional[ArrayLike] = None,
               medium: Optional[str] = None) -> None:
        """The camera, instead of the one before. It looks along +z; x is to the right and y up."""
        self._context._expect_rest()
        kept = []
        items, count = _parameters(parameters, kept)
        made = _Camera(ctypes.sizeof(_Camera), _text(type), items, count, _matrix(world_from_camera, kept),
                       _matrix(world_from_camera_end, kept), _text(medium))
        self._context._check(_library.ag_scene_set_camera(self._pointer, byref(made)))

    def complete(self, poll: _Poll = None) -> None:
        """Builds what rays need; rendering does so where it is not done yet. poll: as for Rendering.advance."""
        if self._is_complete:
            return
        statuses = []

        def commit(pointer):
            statuses.append(_library.ag_scene_commit(pointer))
            return statuses[0]

        try:
            self._context._work(commit, self._pointer, poll=poll)
        finally:  # the library has done it, or has not, whatever was raised beside it
            if statuses:
                self._note_commit(statuses[0] == 0)

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
        size = _library.ag_struct_size(_RENDER_SETTINGS)
        room = ctypes.create_string_buffer(size)
        self._context._check(_library.ag_render_settings_fill(self._context._pointer, self._pointer, room, size))
        kept = [room]
        for name, value in values.items():
            kept.append(None if value is True else _text(str(value)))
            name = name.replace("_", "-")
            if _library.ag_render_settings_set(room, name.encode(), kept[-1]) != 0:
                raise ValueError(f"{name}: there is no such setting, or {value!r} is no value of it")
        return room, kept

    def render(self, write_to: Optional[_Path] = None, **settings: Any) -> NDArray[numpy.float32]:
        """Completes the scene, renders it, and gives its pixels. settings: options of the program by name, with _ for
        -: size="320x180", spp=16, noise=0.02, integrator="path", photon_map="room.map"; True for those without a
        value. write_to: a file that the picture is written to as well."""
        context, film = self._context, c_void_p()
        self.complete()
        room, _kept = self._settings(settings)
        try:
            context._work(_library.ag_render, context._pointer, self._pointer, room, byref(film))
            if write_to is not None:
                context._work(_library.ag_film_write, context._pointer, film, None, _text(write_to))
            return _pixels(film)
        finally:
            _library.ag_film_destroy(film)

    def rendering(self, poll: _Poll = None, **settings: Any) -> Rendering:
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
            _library.ag_scene_destroy(self._held)
            self._held = c_void_p()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _pixels(film):
    width, height = c_int(), c_int()
    pixels = _library.ag_film_pixels(film, byref(width), byref(height))
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
            self._context._work(_library.ag_rendering_create, self._context._pointer, scene._pointer, room,
                                byref(self._held), poll=poll)
        except BaseException:
            self.close()
            raise
        width, height = c_int(), c_int()
        _library.ag_film_pixels(self._shown(), byref(width), byref(height))
        self.shape = (height.value, width.value)
        self._watched, self._version = numpy.zeros((*self.shape, 3), numpy.float32), 0

    @property
    def _pointer(self):
        return _opened(self._held, "rendering")

    def _shown(self):
        return self._film or c_void_p(_library.ag_rendering_film(self._pointer))

    def advance(self, samples: int, poll: _Poll = None) -> None:
        """Brings every pixel to so many samples, or to the noise that was asked for: those of the settings at most. poll:
        called about every 0.1 s meanwhile, on the calling thread; an exception there calls the work off."""
        self._context._work(_library.ag_rendering_continue, self._pointer, operator.index(samples), poll=poll)

    def watch(self) -> Optional[NDArray[numpy.float32]]:
        """The picture as far as it is shown by now, whole tiles, from any thread and while it is at work; None where
        nothing is new. The array is the same in each call."""
        version = _library.ag_film_read_picture(self._shown(), self._version, _floats(self._watched))
        is_new, self._version = version != self._version, version
        return self._watched if is_new else None

    def sample_counts(self) -> tuple[int, int, float]:
        """The least, the most, and the mean number of samples that a pixel has had."""
        counts = _library.ag_rendering_sample_counts(self._pointer)
        return counts.least, counts.most, counts.mean

    def pixels(self) -> NDArray[numpy.float32]:
        """A copy of the picture."""
        return _pixels(self._shown())

    def channels(self) -> dict[str, NDArray[numpy.float32]]:
        """Copies of picture and layers, (height, width) each, by the names that they have in a file: "R", "Z", "N.X"."""
        film, found = self._shown(), {}
        for number in range(_library.ag_film_channel_count(film)):
            values = numpy.empty(self.shape, numpy.float32)
            self._context._check(_library.ag_film_read_channel(film, number, _floats(values)))
            found[_library.ag_film_channel_name(film, number).decode()] = values
        return found

    def denoise(self, poll: _Poll = None) -> None:
        """Ends the rendering and takes the noise out of R, G and B, by Open Image Denoise; denoise=True among the
        settings has kept what it needs. The channels stay to be read."""
        self._context._expect_rest()
        _library.ag_rendering_finish(self._pointer, byref(self._film))
        self._held = c_void_p()
        self._context._work(_library.ag_film_denoise, self._context._pointer, self._film, poll=poll)

    def close(self) -> None:
        """Ends the rendering and forgets its picture."""
        if self._held:
            self._context._expect_rest()
        if self in self._scene._renderings:
            self._scene._renderings.remove(self)
        _library.ag_rendering_finish(self._held, None)
        _library.ag_film_destroy(self._film)
        self._held, self._film = c_void_p(), c_void_p()

    def __enter__(self) -> Rendering:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
