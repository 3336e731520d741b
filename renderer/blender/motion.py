"""Motion blur: where all that is drawn stands at steps from the opening of the shutter to its closing; between two of them
it goes straight on, and turns evenly. Of what deforms (shape keys, armatures and other modifiers that move vertices; hair)
the mesh and the strands at these steps as well."""

import math

import numpy as np

from . import cameras, hair, meshes

_STEPS_MOST = 129  # of the renderer, and of Cycles


def _key(instance):
    parent = instance.parent.name_full if instance.is_instance and instance.parent else ""
    return instance.object.name_full, parent, tuple(instance.persistent_id) if instance.is_instance else ()


def _owners(instance):
    """The object, and what it is an instance for, as the file has them: Cycles' settings of the copies that the graph lends
    are made when they are read, and Blender never frees those of an instance."""
    owners = [instance.object] + ([instance.parent] if instance.is_instance and instance.parent else [])
    return [owner.original for owner in owners]


def _steps_of(instance):
    """The times at which Cycles looks at what moves."""
    most = max(getattr(getattr(owner, "cycles", None), "motion_steps", 1) for owner in _owners(instance))
    return min(2 ** most + 1, _STEPS_MOST)


def _has(instance, name):
    """Whether Cycles' switches of that name are on, of all owners."""
    return all(getattr(getattr(owner, "cycles", None), name, True) for owner in _owners(instance))


def _may_move(instance):
    return _has(instance, "use_motion_blur") and (instance.object.type in meshes.SURFACES or instance.object.type == "CURVES")


def _may_deform(instance, scene):
    return (_may_move(instance) and _has(instance, "use_deform_motion")
            and instance.object.type != "CURVES" and instance.object.is_deform_modified(scene, "RENDER"))


def _stride(instance, last):
    """Of the steps 0 to `last` of all objects an object takes each so many-th: steps are powers of two, and one."""
    return max(last // (_steps_of(instance) - 1), 1)


def _poses(depsgraph, k, last):
    """Matrices at step k of what has one at it; copies: what the graph lends goes with the next frame."""
    poses = {_key(instance): cameras.matrix_of(instance.matrix_world) for instance in depsgraph.object_instances
             if _may_move(instance) and k % _stride(instance, last) == 0}
    camera = depsgraph.scene_eval.camera
    if camera and k in (0, last):
        poses["camera", camera.name] = cameras.matrix_of(camera.evaluated_get(depsgraph).matrix_world)
    return poses


def _shapes(depsgraph, k, last, before):
    """The poses of what may deform and has a pose at step k; those that have not changed are the ones of `before`, of the
    first step."""
    shapes, by_data = {}, {}
    for instance in depsgraph.object_instances:
        if not instance.show_self or not _may_deform(instance, depsgraph.scene) or k % _stride(instance, last):
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


def _strands(depsgraph, k, last, poll):
    """Where hair is at step k, of what is shown with hair and has a pose at it; hair is read once for all of an object's
    instances."""
    strands, by_object = {}, {}
    if not depsgraph.view_layer_eval.use_strand:
        return strands
    for instance in depsgraph.object_instances:
        shown = instance.object
        is_curves = shown.type == "CURVES"
        if (not (instance.show_self if is_curves else instance.show_particles and shown.type == "MESH")
                or not _may_move(instance) or not _has(instance, "use_deform_motion") or k % _stride(instance, last)):
            continue
        name = shown.name_full, is_curves
        if name not in by_object:
            by_object[name] = hair.curves_pose(shown) if is_curves else hair.particle_pose(shown, poll)
        if by_object[name] is not None:
            strands[_key(instance)] = by_object[name]
    return strands


def _is_even(path):
    """Whether a path goes straight and evenly, without a turn: its ends say all of it."""
    way, size = path[-1] - path[0], np.abs(path[:, :3, 3]).max()
    between = path[0] + way * np.linspace(0, 1, len(path))[:, None, None]
    return (not way[:3, :3].any() and (path[:, :3, :3] == path[0, :3, :3]).all()
            and np.abs(path - between).max() <= 1e-4 * np.abs(way).max() + 1e-6 * size)


def _is_one_shape(poses):
    """Whether hair is the same in all, but for the rounding."""
    return all(np.abs(now - first).max(initial=0) <= 1e-5 * np.ptp(first, axis=tuple(range(first.ndim - 1))).max(initial=0)
               for pose in poses[1:] for now, first in zip(pose, poses[0]))


class Motion:
    """poses, shapes, strands: for each step the matrices, the meshes and the hair of what has them at it, by key."""

    def __init__(self, notes=None, poses=(), shapes=(), strands=()):
        self._notes, self._poses, self._shapes, self._strands = notes, poses, shapes, strands

    def _at_steps(self, instance, steps):
        key, stride = _key(instance), _stride(instance, len(steps) - 1)
        return [at_step.get(key) for at_step in steps[::stride]]

    def of_instance(self, instance, matrix):
        """Its matrix when the shutter opens, and those behind it to the closing: one, (4, 4), or several, (count, 4, 4); None
        where it stands still."""
        path = self._at_steps(instance, self._poses) if self._poses else [None]
        if any(pose is None for pose in path):
            return matrix, None
        path = np.array(path)
        if (path == path[0]).all():
            return path[0], None
        volumes = np.linalg.det(path[:, :3, :3])
        if np.abs(volumes).min() < 1e-30 or (np.sign(volumes) != np.sign(volumes[0])).any():
            self._notes.say(f'object "{instance.object.name}": it is flat, or turns inside out, while the shutter is open, and '
                            'stands still')
            return matrix, None
        return path[0], path[-1] if _is_even(path) else path[1:]

    def of_shape(self, instance):
        """Its poses from the opening of the shutter to its closing, of which some may be None; None where it keeps its
        shape."""
        key = _key(instance)
        if not self._shapes or not any(key in shapes for shapes in self._shapes):
            return None
        poses = self._at_steps(instance, self._shapes)
        return None if all(pose is poses[0] for pose in poses) else poses

    def of_strands(self, instance, now):
        """The poses of its hair from the opening of the shutter to its closing; None where it keeps its shape. now: its
        pose at the frame."""
        if not self._strands:
            return None
        poses = self._at_steps(instance, self._strands)
        if all(pose is None for pose in poses):
            return None
        if any(pose is hair.FLAT for pose in poses):
            self._notes.say(f'object "{instance.object.name}": it is flat for a while as the shutter is open, and its hair does '
                            'not deform')
            return None
        if any(pose is None or [one.shape for one in pose] != [one.shape for one in now] for pose in poses):
            self._notes.say(f'object "{instance.object.name}": its hair has other strands while the shutter is open, and '
                            'does not deform')
            return None
        return None if _is_one_shape(poses) else poses

    def of_camera(self, name, matrix):
        key = "camera", name
        if not self._poses or key not in self._poses[0] or key not in self._poses[-1]:
            return matrix, None
        start, end = self._poses[0][key], self._poses[-1][key]
        return (start, end) if (start != end).any() else (start, None)


def look_ahead(engine, depsgraph, notes, poll=lambda: None):
    """The motion of the current frame; the graph is evaluated anew for it, and stands at the frame afterwards, also where
    `poll`, which is called now and then, raises something."""
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
    last, deforms = 1, False
    for instance in depsgraph.object_instances:
        if _may_move(instance):
            last = max(last, _steps_of(instance) - 1)
            deforms = deforms or _may_deform(instance, scene)
    poses, shapes, strands = [], [], []
    try:
        for k in range(last + 1):
            poll()
            when = first + shutter * k / last
            engine.frame_set(math.floor(when), when - math.floor(when))
            poses.append(_poses(depsgraph, k, last))
            strands.append(_strands(depsgraph, k, last, poll))
            if deforms:
                shapes.append(_shapes(depsgraph, k, last, shapes[0] if shapes else {}))
    finally:
        engine.frame_set(math.floor(frame), frame - math.floor(frame))
    return Motion(notes, poses, shapes, strands)
