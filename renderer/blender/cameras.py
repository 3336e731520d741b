"""Blender's camera as the renderer's. The field of view is 90 degrees always, and the screen window says the rest: its
numbers are tangents then, or for a parallel projection lengths."""

import math
from collections import namedtuple

import numpy as np

# A camera of a 3D view: kind, screen window (x0, x1, y0, y1), matrix row by row, (width, height); as tuples, to compare.
View = namedtuple("View", "kind window world_from_camera size")

_NEAREST_M, _NEAREST_ANYWHERE_M = 0.1, 0.5  # that a picture's sharpness is thought of
_FLIPPED_Z = np.diag([1.0, 1.0, -1.0, 1.0])  # Blender's cameras look along -z, the renderer's along +z


def matrix_of(blender_matrix):
    return np.array(blender_matrix, np.float64)


def is_flat(matrix):
    """Whether it has no inverse."""
    return abs(np.linalg.det(matrix[:3, :3])) < 1e-30


def unscaled(matrix):
    """A camera's or lamp's matrix with axes of length 1."""
    made = matrix.copy()
    made[:3, :3] /= np.maximum(np.linalg.norm(made[:3, :3], axis=0), 1e-30)
    return made


def picture_size(render):
    """Of the whole picture, in pixels."""
    return (max(1, int(render.resolution_x * render.resolution_percentage / 100)),
            max(1, int(render.resolution_y * render.resolution_percentage / 100)))


def border_of(render, size):
    """The pixels that are rendered: x0, y0, x1, y1, y from below. Blender computes them by floats of 32 bits."""
    if not render.use_border:
        return 0, 0, *size
    x0, x1 = (int(np.float32(edge) * np.float32(size[0])) for edge in (render.border_min_x, render.border_max_x))
    y0, y1 = (int(np.float32(edge) * np.float32(size[1])) for edge in (render.border_min_y, render.border_max_y))
    return x0, y0, max(x1, x0 + 1), max(y1, y0 + 1)


def crop_window(border, size):
    """The renderer's cropwindow, from the top. Half a pixel off, no rounding moves an edge."""
    x0, y0, x1, y1 = border
    width, height = size
    edges = ((x0 - 0.5) / width, (x1 - 0.5) / width, (height - y1 - 0.5) / height, (height - y0 - 0.5) / height)
    return ",".join(repr(min(max(edge, 0.0), 1.0)) for edge in edges)


def _screen_window(camera, shift_x, render, size, half_width_of_sensor):
    """half_width_of_sensor: of the picture's longer side, or of that which the sensor is fitted to."""
    x_aspect, y_aspect = render.pixel_aspect_x, render.pixel_aspect_y
    y_over_x = y_aspect / x_aspect
    fit = camera.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if size[0] * x_aspect >= size[1] * y_aspect else "VERTICAL"
    fitted = size[0] if fit == "HORIZONTAL" else y_over_x * size[1]
    half = np.array([size[0], y_over_x * size[1]]) / fitted
    middle = 2.0 * np.array([shift_x, camera.shift_y])
    window = half_width_of_sensor * np.array([middle[0] - half[0], middle[0] + half[0],
                                              middle[1] - half[1], middle[1] + half[1]])
    return window.astype(np.float32)


def view_of(view_matrix, window_matrix, is_perspective, size):
    """The view of a region: its matrices say where it is, and which part of its screen it shows."""
    projection = matrix_of(window_matrix)
    window = []
    for axis in (0, 1):
        offset = projection[axis, 2] if is_perspective else -projection[axis, 3]
        window += [(-1 + offset) / projection[axis, axis], (1 + offset) / projection[axis, axis]]
    world_from_camera = np.linalg.inv(matrix_of(view_matrix)) @ _FLIPPED_Z
    return View("perspective" if is_perspective else "orthographic", tuple(window),
                tuple(world_from_camera.ravel()), tuple(size))


def add_view(scene, view):
    """Sets the camera to a view; of a complete scene, too."""
    parameters = {"float screenwindow": np.array(view.window, np.float32)}
    if view.kind == "perspective":
        parameters["float fov"] = 90
    scene.camera(view.kind, parameters, world_from_camera=np.reshape(view.world_from_camera, (4, 4)))


def _focus(camera, world_from_camera, lens_radius):
    depth = camera.dof.focus_distance
    if camera.dof.focus_object:
        there = np.array(camera.dof.focus_object.matrix_world.translation) - world_from_camera[:3, 3]
        depth = abs(float(there @ world_from_camera[:3, 2]))
    return {"float lensradius": lens_radius, "float focaldistance": max(depth, 1e-5)}


def _view_matrix(engine, camera_object):
    """Where the active view of several is, as seen from the camera's own place."""
    own, view = (unscaled(matrix_of(m)) for m in (camera_object.matrix_world, engine.camera_model_matrix(camera_object)))
    return np.linalg.inv(own) @ view


def add_camera(scene, camera_object, render, motion, notes, engine=None):
    """Sets the camera of the renderer's scene to a Blender object; engine: to its active view, of several. Errors:
    RuntimeError, where it is no camera."""
    if camera_object.type != "CAMERA":
        raise RuntimeError(f'the scene\'s camera "{camera_object.name}" is a {camera_object.type.lower()}, no camera')
    camera, size = camera_object.data, picture_size(render)
    start, end = motion.of_camera(camera_object.name, matrix_of(camera_object.matrix_world))
    view = _view_matrix(engine, camera_object) if engine else np.eye(4)
    shift_x = engine.camera_shift_x(camera_object) if engine else camera.shift_x
    world_from_camera = unscaled(start) @ view @ _FLIPPED_Z
    world_from_camera_end = None if end is None else unscaled(end) @ view @ _FLIPPED_Z
    if camera.type == "PANO":
        notes.say(f'camera "{camera_object.name}": panoramas are not translated, it is a perspective camera here')
    if camera.type == "ORTHO":
        kind, parameters, half = "orthographic", {}, camera.ortho_scale / 2
        lens_radius = 0.5 / max(camera.dof.aperture_fstop, 1e-5)
    else:
        sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
        kind, parameters, half = "perspective", {"float fov": 90}, sensor / camera.lens / 2
        lens_radius = 0.5e-3 * camera.lens / max(camera.dof.aperture_fstop, 1e-5)
    parameters["float screenwindow"] = _screen_window(camera, shift_x, render, size, half)
    if camera.dof.use_dof:
        parameters.update(_focus(camera, world_from_camera, lens_radius))
        if camera.dof.aperture_blades or camera.dof.aperture_ratio != 1:
            notes.say(f'camera "{camera_object.name}": its aperture is round here')
    scene.camera(kind, parameters, world_from_camera=world_from_camera, world_from_camera_end=world_from_camera_end)


def pixels_of_unit(camera, size, matrix, positions, is_anywhere):
    """About how many pixels of the picture a unit of a mesh's length has where it is nearest to the camera; is_anywhere:
    it stands in other places too, which may be nearer."""
    stretch, data = abs(np.linalg.det(matrix[:3, :3])) ** (1 / 3), camera.data
    if data.type == "ORTHO":
        return stretch * max(size) / max(data.ortho_scale, 1e-6)
    points, eye = positions @ matrix[:3, :3].T + matrix[:3, 3], np.array(camera.matrix_world.translation)
    away = np.maximum(np.maximum(points.min(axis=0) - eye, eye - points.max(axis=0)), 0)
    distance = _NEAREST_ANYWHERE_M if is_anywhere else max(float(np.linalg.norm(away)), _NEAREST_M)
    return stretch * max(size) / (2 * math.tan(min(data.angle, 3.0) / 2) * distance)
