"""What of scene, view layer and world has no counterpart in the renderer, told once each."""

_PASSES_MADE = {"use_pass_combined", "use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_uv",
                "use_pass_cryptomatte_object", "use_pass_cryptomatte_material"}
_CLIP_START_M = 0.5  # nearer to the camera there is seldom anything
_RAYS = ("camera", "diffuse", "glossy", "transmission")


def _collections(layer_collection):
    yield layer_collection
    for child in layer_collection.children:
        yield from _collections(child)


def _tell_layer(layer, notes):
    for collection in _collections(layer.layer_collection):
        for name, kind in (("holdout", "holdout"), ("indirect_only", "indirect only")):
            if getattr(collection, name):
                notes.say(f'collection "{collection.name}": "{kind}" is not translated, it is seen as any other')
    for item in layer.bl_rna.properties:
        if (item.type == "BOOLEAN" and not item.is_array and item.identifier.startswith("use_pass_")
                and "accurate" not in item.identifier  # a way to make another pass
                and item.identifier not in _PASSES_MADE and getattr(layer, item.identifier)):
            notes.say(f'view layer "{layer.name}": there is no pass "{item.name}"')


def _tell_world(world, notes):
    rays = getattr(world, "cycles_visibility", None)
    hidden = [kind for kind in _RAYS if rays and not getattr(rays, kind)]
    if hidden:
        notes.say(f'world "{world.name}": it is hidden from {", ".join(hidden)} rays in Blender, and seen by all here')


def tell(scene, layer, notes):
    """scene, layer: evaluated ones."""
    _tell_layer(layer, notes)
    if scene.world:
        _tell_world(scene.world, notes)
    if scene.camera and scene.camera.type == "CAMERA" and scene.camera.data.clip_start > _CLIP_START_M:
        notes.say(f'camera "{scene.camera.name}": nothing is clipped, from the camera on all is seen')
    cycles = getattr(scene, "cycles", None)
    if cycles and scene.render.film_transparent and cycles.film_transparent_glass:
        notes.say("the film is not transparent behind glass")
