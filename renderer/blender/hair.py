"""Hair: strands of particle systems and of curves objects, each a curve of the renderer."""

from collections import namedtuple

import numpy as np

from .cameras import is_flat, matrix_of


# points: (count, 3), or of a strand that moves (steps, count, 3). radii: at root and tip.
Strand = namedtuple("Strand", "points radii material")

FLAT = object()  # the pose of hair whose object has no inverse


class Tuft:
    """The hair of an object. places: its matrices as the shutter opens, and behind that (or None), for each place."""

    def __init__(self, name, strands):
        self.name, self.strands, self.places = name, strands, []


def _add_strand(scene, name, strand, **where):
    """A spline that is doubled at both ends passes near all points."""
    points = strand.points
    if points.shape[-2] < 2 or not np.isfinite(points).all():
        return
    first, last = points[..., :1, :], points[..., -1:, :]
    root, tip = strand.radii
    parameters = {"point3 P": np.concatenate([first, first, points, last, last], axis=-2), "string basis": "bspline",
                  "string type": "cylinder", "float width0": 2 * root, "float width1": 2 * tip, "string name": name}
    if points.ndim == 3:
        parameters["integer motionsteps"] = len(points)
    scene.shape("curve", parameters, material=strand.material, **where)


def add_tuft(scene, tuft, object_name, poll):
    """Its strands; where it stands in several places as an object of that name, which is instanced."""
    places = [(place, end) for place, end in tuft.places if not is_flat(place)]
    if not places:
        return
    where = {"world_from_shape": places[0][0], "world_from_shape_end": places[0][1]}
    if len(places) > 1:
        where = {"object": object_name}
    for k, strand in enumerate(tuft.strands):
        if k % 256 == 0:
            poll()
        _add_strand(scene, tuft.name, strand, **where)
    if len(places) > 1 and tuft.strands:
        for place, end in places:
            scene.instance(object_name, place, end)


def _systems(owner):
    """The particle systems of an object that are hair."""
    return [modifier.particle_system for modifier in owner.modifiers
            if modifier.type == "PARTICLE_SYSTEM" and modifier.show_render and modifier.particle_system
            and modifier.particle_system.settings.type == "HAIR"
            and modifier.particle_system.settings.render_type == "PATH"]


def _strands(system, owner, poll):
    """The points of all strands in world space, (strands, points, 3)."""
    settings = system.settings
    steps = range(2 ** settings.render_step + 1)
    parents, children = len(system.particles), len(system.child_particles)
    numbers = range(parents if children and settings.child_type != "NONE" else 0, parents + children)
    points = np.empty((len(numbers), len(steps), 3), np.float32)
    for k, number in enumerate(numbers):
        if k % 256 == 0:
            poll()
        points[k] = [system.co_hair(owner, particle_no=number, step=step) for step in steps]
    return points


def _in_object(points, world_from_object):
    own = np.linalg.inv(world_from_object)
    return (points @ own[:3, :3].T + own[:3, 3]).astype(np.float32)


def particle_pose(owner, poll=lambda: None):
    """Where the hair of an object's particle systems is now, in its own space: an array for each; None: there is none;
    FLAT: the object is flat."""
    systems, world_from_object = _systems(owner), matrix_of(owner.matrix_world)
    if not systems:
        return None
    if is_flat(world_from_object):
        return FLAT
    return [_in_object(_strands(system, owner, poll), world_from_object) for system in systems]


def curves_pose(owner):
    """Where the points of a curves object are now, as the arrays of particle_pose."""
    positions = np.empty(3 * len(owner.data.points), np.float32)
    owner.data.points.foreach_get("position", positions)
    return [positions.reshape(-1, 3)]


def _is_there(points):
    """Which points the strands have, (strands, points): what they have not got is where another is, or at the world's
    origin."""
    there = np.ones(points.shape[:2], bool)
    there[:, 1:] = np.abs(np.diff(points, axis=1)).max(axis=2, initial=0) > 0
    last = there.shape[1] - 1 - there[:, ::-1].argmax(axis=1)
    rows = np.flatnonzero((there.sum(axis=1) > 1) & ~points[np.arange(len(points)), last].any(axis=1))
    there[rows, last[rows]] = False
    return there


def _moving(points, poses, number):
    """The points at each step of the poses where they move, with the steps as the first axis; else the points themselves."""
    return points if poses is None else np.stack([pose[number] for pose in poses])


def particle_tuft(owner, materials, poll, poses_of):
    """The hair of an object's particle systems, or None. poses_of: gives for the hair's pose at the frame those from the
    opening of the shutter to its closing if it moves, else None."""
    systems, world_from_object = _systems(owner), matrix_of(owner.matrix_world)
    if not systems or is_flat(world_from_object):
        return None
    in_world = [_strands(system, owner, poll) for system in systems]
    in_object = [_in_object(points, world_from_object) for points in in_world]
    slots, poses, strands = owner.material_slots, poses_of(in_object), []
    for number, system in enumerate(systems):
        settings = system.settings
        look = materials.look(slots[min(settings.material, len(slots)) - 1].material if slots else None)
        scale = settings.radius_scale / 2  # Cycles takes it for a diameter
        radii = settings.root_radius * scale, 0.0 if settings.use_close_tip else settings.tip_radius * scale
        there, points = _is_there(in_world[number]), _moving(in_object[number], poses, number)
        strands += [Strand(points[..., k, :, :][..., there[k], :], radii, look.name) for k in range(len(there))]
    return Tuft(owner.name, strands)


def curves_tuft(owner, materials, poses_of):
    """A curves object of hair. poses_of: as of particle_tuft."""
    curves, pose = owner.data, curves_pose(owner)
    positions = _moving(pose[0], poses_of(pose), 0)
    radius = curves.attributes.get("radius")
    radii = np.full(len(curves.points), 0.005, np.float32)
    if radius:
        radius.data.foreach_get("value", radii)
    look = materials.look(owner.material_slots[0].material if owner.material_slots else None)
    strands = []
    for curve in curves.curves:
        first, behind = curve.first_point_index, curve.first_point_index + curve.points_length
        if behind - first > 1:
            strands.append(Strand(positions[..., first:behind, :], (radii[first], radii[behind - 1]), look.name))
    return Tuft(owner.name, strands)
