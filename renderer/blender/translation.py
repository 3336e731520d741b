"""From the dependency graph to a scene of the renderer: what is drawn, once each, and where."""

import itertools

import numpy as np

from . import cameras, hair, lamps, meshes, worlds
from .materials import IN_SPACE, Materials
from .passes import group_of

# Of a mesh's textures that are computed place by place; for each pixel of the picture where the mesh is nearest.
_PIXELS_LEAST, _PIXELS_MOST, _PIXELS_IN_VIEW, _PIXELS_FOR_EACH = 1 << 16, 1 << 20, 1 << 16, 16


class _Model:
    """The parts of one mesh, and where it stands: its matrices as the shutter opens, as it closes (or None), and at the
    frame."""

    def __init__(self, name, parts, looks, group):
        self.name, self.parts, self.looks, self.group, self.places = name, parts, looks, group, []


def _look_list(owner, materials):
    slots = [slot.material for slot in owner.material_slots] or [None]
    return [materials.look_of_mesh(material) for material in slots]


def _has_generated(look):
    if look.tangent and look.tangent[0] == "RADIAL":
        return True
    return look.layout == IN_SPACE or (look.layout is not None and look.layout[0][0] == "GENERATED")


class _Sharpness:
    """How fine textures are made that are computed place by place. view: that of a 3D view, which moves, or None."""

    def __init__(self, blender_scene, depsgraph, view):
        self._camera = None if view else blender_scene.camera.evaluated_get(depsgraph)
        self._size = cameras.picture_size(blender_scene.render)

    def pixels(self, part, matrix, is_instance):
        if self._camera is None:
            return _PIXELS_IN_VIEW
        each = cameras.pixels_of_unit(self._camera, self._size, matrix, part.positions.reshape(-1, 3), is_instance)
        a, b, c = part.corners.positions.astype(np.float64).transpose(1, 0, 2)
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=-1).sum()
        return int(np.clip(_PIXELS_FOR_EACH * area * each ** 2, _PIXELS_LEAST, _PIXELS_MOST))


def _make_in_space(parts, looks, materials, pixels_of):
    """Looks of its own for each part that wants them, in place."""
    for k, part in enumerate(parts):
        if part.corners is not None:
            looks[part.slot], parts[k] = materials.look_in_space(looks[part.slot], part, pixels_of(part))


def _model(instance_object, materials, name, notes, pixels_of, poses):
    """Reads the mesh at once: what Blender makes for an instance goes with it. poses: of a mesh that deforms, or None."""
    looks = _look_list(instance_object, materials)
    try:
        mesh = instance_object.to_mesh()
    except RuntimeError:
        mesh = None
    if mesh is None:
        return None
    try:
        parts, agree = meshes.parts_of(mesh, [look.layout for look in looks], poses, [look.tangent for look in looks])
    finally:
        instance_object.to_mesh_clear()
    if not agree:
        notes.say(f'object "{instance_object.name}": its mesh has other vertices or faces while the shutter is open, and does '
                  'not deform')
    if any(_has_generated(look) for look in looks) and instance_object.modifiers:
        notes.say(f'object "{instance_object.name}": Generated coordinates are those after its modifiers')
    bad = [part for part in parts if not np.isfinite(part.positions).all()]
    if bad:
        notes.say(f'object "{instance_object.name}": vertices that are not finite are left out with their material')
        parts = [part for part in parts if np.isfinite(part.positions).all()]
    _make_in_space(parts, looks, materials, pixels_of)
    for k, part in enumerate(parts):
        if part.positions.ndim == 3 and looks[part.slot].light is not None:
            parts[k] = meshes.at_rest(part)
            notes.say(f'object "{instance_object.name}": what shines of it does not deform while the shutter is open')
    return _Model(name, parts, looks, group_of(instance_object))


def _key(instance_object, is_by_name):
    data = instance_object.data
    slots = tuple(slot.material.name_full if slot.material else "" for slot in instance_object.material_slots)
    return data.as_pointer(), slots, instance_object.lightgroup, instance_object.name if is_by_name else ""


_VISIBILITIES = {"visible_camera": "camera", "visible_diffuse": "diffuse", "visible_glossy": "glossy",
                 "visible_transmission": "transmission", "visible_shadow": "shadow"}


def _tell_visibility(shown, notes):
    if shown.type == "LIGHT":
        return  # it is hidden from the camera anyway, and casts no shadow
    hidden = [kind for name, kind in _VISIBILITIES.items() if not getattr(shown, name)]
    if hidden:
        notes.say(f'object "{shown.name}": it is hidden from {", ".join(hidden)} rays in Blender, and seen by all here')
    if shown.is_holdout or shown.is_shadow_catcher:
        notes.say(f'object "{shown.name}": it is an object like others here, no holdout or shadow catcher')


def _add_part(scene, model, part, **where):
    look = model.looks[part.slot]
    light = look.light
    if light is not None:
        light = {**light, **model.group}
    scene.shape("trianglemesh", {**meshes.parameters_of(part), **look.shape, "string name": model.name},
                material=look.name, light=light, medium_inside=look.medium, **where)


def _place_part(scene, model, part, place, end=None):
    """Where a scale of 0 makes it flat it does not go along its matrices, and its vertices are in world space."""
    if cameras.is_flat(place):
        positions = part.positions @ place[:3, :3].T + place[:3, 3]
        _add_part(scene, model, part._replace(positions=positions, normals=None))
    else:
        _add_part(scene, model, part, world_from_shape=place, world_from_shape_end=end)


def _add_model(scene, model):
    """One that stands in several places is instanced, but for what shines in it, which stands still in each place, where it
    is at the frame."""
    dark = [part for part in model.parts if model.looks[part.slot].light is None]
    shining = [part for part in model.parts if model.looks[part.slot].light is not None]
    for _, _, frame in model.places:
        for part in shining:
            _place_part(scene, model, part, frame)
    solid = [(place, end) for place, end, _ in model.places if not cameras.is_flat(place)]
    alone = [(place, None) for place, _, _ in model.places if cameras.is_flat(place)] + (solid if len(solid) == 1 else [])
    for place, end in alone:
        for part in dark:
            _place_part(scene, model, part, place, end)
    if len(solid) < 2 or not dark:
        return
    for part in dark:
        _add_part(scene, model, part, object=model.name)
    for place, end in solid:
        scene.instance(model.name, place, end)


def translate(scene, depsgraph, motion, notes, poll, view=None, is_by_name=False):
    """Fills an empty scene, up to its completion. view: instead of the scene's camera (cameras.View). motion: see
    motion.py. poll: called between objects; an exception there ends it. is_by_name: each object keeps its name for
    Cryptomattes, so that those with a mesh in common have one each. Gives the names of objects and of materials."""
    blender_scene, layer = depsgraph.scene_eval, depsgraph.view_layer_eval
    if view:
        cameras.add_view(scene, view)
    elif blender_scene.camera is None:
        raise RuntimeError("the scene has no camera")
    else:
        cameras.add_camera(scene, blender_scene.camera.evaluated_get(depsgraph), blender_scene.render, motion, notes)
    materials, models = Materials(scene, notes, layer.material_override), {}
    sharpness = _Sharpness(blender_scene, depsgraph, view)
    taken, tufts = set(), {}  # names of models; hair by whose it is, None where there is none
    for instance in depsgraph.object_instances:
        poll()
        shown = instance.object
        matrix = cameras.matrix_of(instance.matrix_world)

        def places():
            return (*motion.of_instance(instance, matrix), matrix)

        def poses_of_hair(now):
            return motion.of_strands(instance, now)

        if layer.use_strand and instance.show_particles and shown.type == "MESH":
            if shown.name_full not in tufts:
                tufts[shown.name_full] = hair.particle_tuft(shown, materials, poll, poses_of_hair)
            if tufts[shown.name_full]:
                tufts[shown.name_full].places.append(places()[:2])
        if not instance.show_self:
            continue
        _tell_visibility(shown, notes)
        if shown.type == "LIGHT":
            lamps.add_lamp(scene, shown, matrix, notes)
        elif shown.type in meshes.SURFACES and layer.use_solid:
            key = _key(shown, is_by_name)
            if key not in models:
                name = shown.name
                if not is_by_name or name in taken:
                    name = f"{name}#{len(models)}"
                taken.add(name)
                models[key] = _model(shown, materials, name, notes, lambda part: sharpness.pixels(
                    part, matrix, instance.is_instance), motion.of_shape(instance))
            if models[key]:
                models[key].places.append(places())
        elif shown.type == "CURVES" and layer.use_strand:
            if shown.name_full not in tufts:
                tufts[shown.name_full] = hair.curves_tuft(shown, materials, poses_of_hair)
            tufts[shown.name_full].places.append(places()[:2])
        elif shown.type in ("VOLUME", "POINTCLOUD", "GPENCIL"):
            notes.say(f'object "{shown.name}": a {shown.type.lower()} is not translated')
    for model in models.values():
        poll()
        if model:
            _add_model(scene, model)
    hairs = [tuft for tuft in tufts.values() if tuft]
    for tuft in hairs:
        name = next(name for name in (f"{tuft.name}|hair{k}" for k in itertools.count()) if name not in taken)
        taken.add(name)
        hair.add_tuft(scene, tuft, name, poll)
    if layer.use_sky:
        worlds.add_world(scene, blender_scene.world, notes)
    return {tuft.name for tuft in hairs}.union(model.name for model in models.values() if model), set(materials.names())
