"""Hair: strands of particle systems and of curves objects, each a curve of the renderer."""

import numpy as np


def _add_strand(scene, name, points, radius_root, radius_tip, material, world_from_shape):
    """A strand through its points: a spline that is doubled at both ends passes near all of them."""
    if len(points) < 2 or not np.isfinite(points).all():
        return
    knots = np.concatenate([points[:1], points[:1], points, points[-1:], points[-1:]])
    scene.shape("curve", {"point3 P": knots, "string basis": "bspline", "string type": "cylinder",
                          "float width0": 2 * radius_root, "float width1": 2 * radius_tip, "string name": name},
                material=material, world_from_shape=world_from_shape)


def _add_system(scene, owner, modifier, materials, poll):
    system = modifier.particle_system
    settings = system.settings
    slots = owner.material_slots
    slot = slots[min(settings.material, len(slots)) - 1].material if slots else None
    look = materials.look(slot)
    steps = 2 ** settings.render_step + 1
    scale = settings.radius_scale / 2  # Cycles takes it for a diameter
    tip = 0.0 if settings.use_close_tip else settings.tip_radius * scale
    parents, children = len(system.particles), len(system.child_particles)
    first = parents if children and settings.child_type != "NONE" else 0
    for number in range(first, parents + children):
        if number % 256 == 0:
            poll()
        points = np.array([system.co_hair(owner, particle_no=number, step=step) for step in range(steps)], np.float32)
        # What a strand has not got is at the origin of the world.
        points = points[np.concatenate([[True], np.abs(np.diff(points, axis=0)).max(axis=1) > 0])]
        if len(points) > 1 and not points[-1].any():
            points = points[:-1]
        _add_strand(scene, owner.name, points, settings.root_radius * scale, tip, look.name, None)


def add_particle_hair(scene, owner, materials, poll):
    """The hair of an object's particle systems, in world space."""
    for modifier in owner.modifiers:
        if modifier.type == "PARTICLE_SYSTEM" and modifier.show_render and modifier.particle_system and (
                modifier.particle_system.settings.type == "HAIR"
                and modifier.particle_system.settings.render_type == "PATH"):
            _add_system(scene, owner, modifier, materials, poll)


def add_curves(scene, owner, matrix, materials, poll):
    """A curves object of hair."""
    curves = owner.data
    positions = np.empty(3 * len(curves.points), np.float32)
    curves.points.foreach_get("position", positions)
    positions = positions.reshape(-1, 3)
    radius = curves.attributes.get("radius")
    radii = np.full(len(positions), 0.005, np.float32)
    if radius:
        radius.data.foreach_get("value", radii)
    look = materials.look(owner.material_slots[0].material if owner.material_slots else None)
    for number, curve in enumerate(curves.curves):
        if number % 256 == 0:
            poll()
        first, count = curve.first_point_index, curve.points_length
        if count > 1:
            _add_strand(scene, owner.name, positions[first:first + count], radii[first], radii[first + count - 1], look.name,
                        matrix)
