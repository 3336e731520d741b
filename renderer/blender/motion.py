"""Motion blur: where all that is drawn stands when the shutter opens and when it closes; between, it goes straight on."""

import math

from . import cameras


def _key(instance):
    parent = instance.parent.name_full if instance.is_instance and instance.parent else ""
    return instance.object.name_full, parent, tuple(instance.persistent_id) if instance.is_instance else ()


def _poses(depsgraph):
    """Copies: what the graph lends goes with the next frame."""
    poses = {_key(instance): cameras.matrix_of(instance.matrix_world) for instance in depsgraph.object_instances}
    camera = depsgraph.scene_eval.camera
    if camera:
        poses["camera", camera.name] = cameras.matrix_of(camera.evaluated_get(depsgraph).matrix_world)
    return poses


class Motion:
    """opened, closed: poses by key, or None where nothing moves."""

    def __init__(self, opened=None, closed=None):
        self._opened, self._closed = opened, closed

    def _pair(self, key, matrix):
        if self._opened is None or key not in self._opened or key not in self._closed:
            return matrix, None
        start, end = self._opened[key], self._closed[key]
        return (start, end) if (start != end).any() else (start, None)

    def of_instance(self, instance, matrix):
        """Its matrix when the shutter opens, and when it closes; the latter None where it stands still."""
        return self._pair(_key(instance), matrix)

    def of_camera(self, name, matrix):
        return self._pair(("camera", name), matrix)


def look_ahead(engine, depsgraph, notes):
    """The motion of the current frame; the graph is evaluated anew for it, and stands at the frame afterwards."""
    scene = depsgraph.scene
    render = scene.render
    if not render.use_motion_blur:
        return Motion()
    cycles = getattr(scene, "cycles", None)
    position = cycles.motion_blur_position if cycles else "CENTER"
    if cycles and cycles.rolling_shutter_type != "NONE":
        notes.say("the shutter is open for all lines at once here, not rolling")
    frame, shutter = scene.frame_current + scene.frame_subframe, render.motion_blur_shutter
    first = frame - {"START": 0.0, "CENTER": 0.5, "END": 1.0}[position] * shutter
    poses = []
    for when in (first, first + shutter, frame):
        engine.frame_set(math.floor(when), when - math.floor(when))
        if len(poses) < 2:
            poses.append(_poses(depsgraph))
    return Motion(*poses)
