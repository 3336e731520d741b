"""Motion blur: where all that is drawn stands when the shutter opens and when it closes; between, it goes straight on. Of
what deforms (shape keys, armatures and other modifiers that move vertices) the mesh at steps between as well."""

import math

from . import cameras, meshes

_STEPS_MOST = 129  # of the renderer, and of Cycles


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


def _steps_of(shown):
    """The times at which Cycles looks at a mesh that deforms."""
    cycles = getattr(shown, "cycles", None)
    return min(2 ** (cycles.motion_steps if cycles else 1) + 1, _STEPS_MOST)


def _has(instance, name):
    """Whether Cycles' switches of that name are on, of the object and of what it is an instance for."""
    owners = [instance.object] + ([instance.parent] if instance.is_instance and instance.parent else [])
    return all(getattr(getattr(owner, "cycles", None), name, True) for owner in owners)


def _may_deform(instance, scene):
    return (_has(instance, "use_motion_blur") and _has(instance, "use_deform_motion")
            and instance.object.type in meshes.SURFACES and instance.object.is_deform_modified(scene, "RENDER"))


def _stride(shown, last):
    """Of the steps 0 to `last` of all objects an object takes each so many-th: steps are powers of two, and one."""
    return max(last // (_steps_of(shown) - 1), 1)


def _shapes(depsgraph, k, last, before):
    """The poses of what may deform and has a pose at step k; those that have not changed are the ones of `before`, of the
    first step."""
    shapes, by_data = {}, {}
    for instance in depsgraph.object_instances:
        if not instance.show_self or not _may_deform(instance, depsgraph.scene) or k % _stride(instance.object, last):
            continue
        key, data = _key(instance), instance.object.data.as_pointer()
        if data not in by_data:
            try:
                mesh = instance.object.to_mesh()
            except RuntimeError:
                mesh = None
            by_data[data] = meshes.pose_of(mesh, before.get(key)) if mesh else None
            instance.object.to_mesh_clear()
        shapes[key] = by_data[data]
    return shapes


class Motion:
    """opened, closed: poses by key, or None where nothing moves. shapes: for each step the poses of the meshes
    that have one at it, by key."""

    def __init__(self, opened=None, closed=None, shapes=()):
        self._opened, self._closed, self._shapes = opened, closed, shapes

    def _pair(self, key, matrix):
        if self._opened is None or key not in self._opened or key not in self._closed:
            return matrix, None
        start, end = self._opened[key], self._closed[key]
        return (start, end) if (start != end).any() else (start, None)

    def of_instance(self, instance, matrix):
        """Its matrix when the shutter opens, and when it closes; the latter None where it stands still."""
        return self._pair(_key(instance), matrix) if _has(instance, "use_motion_blur") else (matrix, None)

    def of_shape(self, instance):
        """Its poses from the opening of the shutter to its closing, of which some may be None; None where it keeps its
        shape."""
        key = _key(instance)
        if not self._shapes or not any(key in shapes for shapes in self._shapes):
            return None
        poses = [shapes.get(key) for shapes in self._shapes[::_stride(instance.object, len(self._shapes) - 1)]]
        return None if all(pose is poses[0] for pose in poses) else poses

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
    steps = max((_steps_of(instance.object) for instance in depsgraph.object_instances
                 if _may_deform(instance, scene)), default=0)
    last = max(steps, 2) - 1
    poses, shapes = [], []
    for k in range(last + 1):
        when = first + shutter * k / last
        engine.frame_set(math.floor(when), when - math.floor(when))
        if k in (0, last):
            poses.append(_poses(depsgraph))
        if steps:
            shapes.append(_shapes(depsgraph, k, last, shapes[0] if shapes else {}))
    engine.frame_set(math.floor(frame), frame - math.floor(frame))
    return Motion(*poses, shapes)
