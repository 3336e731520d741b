"""The C interface of libafterglow by ctypes: structs, functions, constants, and the library itself."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
from ctypes import POINTER, c_bool, c_char_p, c_double, c_float, c_int, c_size_t, c_uint, c_uint64, c_void_p

CANCELLED = 9  # AG_CANCELLED
PARAMETER_TYPES = ["float", "integer", "string", "bool", "point2", "vector2", "point3", "vector3", "normal", "rgb",
                   "spectrum", "blackbody", "texture"]
HINTS = {"film": 0, "sampler": 1, "integrator": 2, "pixelfilter": 3}
NAMED = ["material", "medium", "float texture", "spectrum texture", "image"]  # as in ag_named
SCENE_SETTINGS = 1  # AG_STRUCT_SCENE_SETTINGS
RENDER_SETTINGS = 2  # AG_STRUCT_RENDER_SETTINGS, which are only handed on

LOG = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p)
PROGRESS = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_double)


class ContextSettings(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("thread_count", c_uint), ("isa", c_char_p), ("color_config", c_char_p),
                ("working_space", c_char_p), ("is_confined", c_bool), ("confined_to", POINTER(c_char_p)),
                ("confined_count", c_size_t), ("log", LOG), ("progress", PROGRESS), ("user", c_void_p)]


class Parameter(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("type", c_int), ("count", c_size_t), ("floats", c_void_p), ("doubles", c_void_p),
                ("integers", c_void_p), ("strings", POINTER(c_char_p)), ("bools", c_void_p)]


class Shape(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("type", c_char_p), ("parameters", POINTER(Parameter)),
                ("parameter_count", c_size_t), ("material", c_char_p), ("object", c_char_p),
                ("world_from_shape", c_void_p), ("world_from_shape_end", c_void_p), ("reverse_orientation", c_bool),
                ("is_light", c_bool), ("light_parameters", POINTER(Parameter)), ("light_parameter_count", c_size_t),
                ("medium_inside", c_char_p), ("medium_outside", c_char_p), ("borrows_arrays", c_bool)]


class SceneSettings(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("definitions", c_void_p), ("definition_count", c_size_t),
                ("gltf_light_units", c_int), ("has_camera", c_bool), ("camera_from", c_float * 3),
                ("camera_to", c_float * 3), ("camera_up", c_float * 3), ("camera_fov_degrees", c_float),
                ("camera_name", c_char_p), ("texture_memory_bytes", c_uint64),
                ("texture_cache", c_char_p), ("texture_cache_bytes", c_uint64), ("drops_lights", c_bool), ("up", c_int),
                ("has_sun", c_bool), ("sun_azimuth_degrees", c_float), ("sun_elevation_degrees", c_float),
                ("sun_irradiance", c_float), ("sun_angle_degrees", c_float), ("has_sky", c_bool),
                ("sky_radiance", c_float * 3), ("sky_file", c_char_p), ("sky_rotation_degrees", c_float),
                ("find_file", c_void_p), ("find_file_user", c_void_p), ("is_editable", c_bool)]


class CommitCounts(ctypes.Structure):
    _fields_ = [(name, c_uint64) for name in ("commits", "meshes_made", "trees_built", "trees_kept", "pictures_read",
                                              "pictures_kept")]


class Instance(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("object", c_char_p), ("world_from_object", c_void_p),
                ("world_from_object_end", c_void_p)]


class Light(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("type", c_char_p), ("parameters", POINTER(Parameter)),
                ("parameter_count", c_size_t), ("world_from_light", c_void_p), ("medium_outside", c_char_p)]


class Camera(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("type", c_char_p), ("parameters", POINTER(Parameter)),
                ("parameter_count", c_size_t), ("world_from_camera", c_void_p), ("world_from_camera_end", c_void_p),
                ("medium", c_char_p)]


class Texture(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("name", c_char_p), ("value", c_int), ("type", c_char_p),
                ("parameters", POINTER(Parameter)), ("parameter_count", c_size_t), ("world_from_texture", c_void_p)]


class Image(ctypes.Structure):
    _fields_ = [("struct_size", c_size_t), ("width", c_int), ("height", c_int), ("channel_count", c_int),
                ("bytes", c_void_p), ("floats", c_void_p)]


class SampleCounts(ctypes.Structure):
    _fields_ = [("least", c_int), ("most", c_int), ("mean", c_double)]


def _load():
    name = os.environ.get("AFTERGLOW_LIBRARY") or ctypes.util.find_library("afterglow")
    if not name:
        raise ImportError("libafterglow is not installed, and $AFTERGLOW_LIBRARY does not name it")
    loaded = ctypes.CDLL(name)
    parameters = [POINTER(Parameter), c_size_t]
    signatures = {
        "ag_version": (c_char_p, []),
        "ag_status_text": (c_char_p, [c_int]),
        "ag_context_create": (c_int, [POINTER(ContextSettings), POINTER(c_void_p)]),
        "ag_context_destroy": (None, [c_void_p]),
        "ag_context_cancel": (None, [c_void_p]),
        "ag_context_clear_cancel": (None, [c_void_p]),
        "ag_scene_create": (c_int, [c_void_p, c_void_p, POINTER(c_void_p)]),
        "ag_scene_load": (c_int, [c_void_p, c_char_p, POINTER(c_void_p)]),
        "ag_scene_load_text": (c_int, [c_void_p, c_char_p, c_char_p, c_size_t, c_void_p, POINTER(c_void_p)]),
        "ag_scene_commit": (c_int, [c_void_p]),
        "ag_scene_destroy": (None, [c_void_p]),
        "ag_scene_add_shape": (c_int, [c_void_p, POINTER(Shape), POINTER(c_uint64)]),
        "ag_scene_add_instance": (c_int, [c_void_p, POINTER(Instance), POINTER(c_uint64)]),
        "ag_scene_add_light": (c_int, [c_void_p, POINTER(Light), POINTER(c_uint64)]),
        "ag_scene_set_camera": (c_int, [c_void_p, POINTER(Camera)]),
        "ag_scene_add_texture": (c_int, [c_void_p, POINTER(Texture)]),
        "ag_scene_add_image": (c_int, [c_void_p, c_char_p, POINTER(Image)]),
        "ag_scene_add_material": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_add_medium": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_set_hint": (c_int, [c_void_p, c_int, c_char_p] + parameters),
        "ag_render_settings_fill": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t]),
        "ag_struct_size": (c_size_t, [c_int]),
        "ag_struct_fill": (None, [c_int, c_void_p, c_size_t]),
        "ag_scene_change_shape": (c_int, [c_void_p, c_uint64, POINTER(Shape)]),
        "ag_scene_change_instance": (c_int, [c_void_p, c_uint64, POINTER(Instance)]),
        "ag_scene_change_light": (c_int, [c_void_p, c_uint64, POINTER(Light)]),
        "ag_scene_change_texture": (c_int, [c_void_p, POINTER(Texture)]),
        "ag_scene_change_image": (c_int, [c_void_p, c_char_p, POINTER(Image)]),
        "ag_scene_change_material": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_change_medium": (c_int, [c_void_p, c_char_p, c_char_p] + parameters),
        "ag_scene_move": (c_int, [c_void_p, c_uint64, c_void_p, c_void_p]),
        "ag_scene_assign_material": (c_int, [c_void_p, c_uint64, c_char_p]),
        "ag_scene_remove": (c_int, [c_void_p, c_uint64]),
        "ag_scene_remove_named": (c_int, [c_void_p, c_int, c_char_p]),
        "ag_scene_commit_counts": (CommitCounts, [c_void_p]),
        "ag_render_settings_set": (c_int, [c_void_p, c_char_p, c_char_p]),
        "ag_render": (c_int, [c_void_p, c_void_p, c_void_p, POINTER(c_void_p)]),
        "ag_rendering_create": (c_int, [c_void_p, c_void_p, c_void_p, POINTER(c_void_p)]),
        "ag_rendering_continue": (c_int, [c_void_p, c_int]),
        "ag_rendering_sample_counts": (SampleCounts, [c_void_p]),
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
        getattr(loaded, function).restype = result
        getattr(loaded, function).argtypes = arguments
    return loaded


library = _load()
