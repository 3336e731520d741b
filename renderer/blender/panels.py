"""Panels of render and view layer properties; and those of Blender's own that go with any engine."""

import bpy
from bl_ui.properties_view_layer import ViewLayerLightgroupsPanel


class _RenderPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {"AFTERGLOW"}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


def _props(layout, owner, names):
    layout.use_property_split = True
    layout.use_property_decorate = False
    for name in names:
        layout.prop(owner, name)


class AFTERGLOW_PT_sampling(_RenderPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context):
        _props(self.layout, context.scene.afterglow, ("noise", "samples", "seed", "use_animated_seed", "use_denoising"))


class AFTERGLOW_PT_light(_RenderPanel, bpy.types.Panel):
    bl_label = "Light"

    def draw(self, context):
        own = context.scene.afterglow
        _props(self.layout, own, ("use_fixed_photons",))
        numbers = self.layout.column()
        numbers.active = own.use_fixed_photons
        _props(numbers, own, ("photons", "caustic_photons"))
        _props(self.layout, own, ("radius", "gather_samples", "clamp_direct", "clamp_indirect", "photon_map",
                                  "use_path_tracing"))


class AFTERGLOW_PT_passes(_RenderPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        _props(self.layout, context.view_layer, ("use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_uv"))
        _props(self.layout, context.view_layer.afterglow, (
            "use_albedo", "use_emission", "use_direct", "use_indirect", "use_caustic", "use_specular"))


class AFTERGLOW_PT_lightgroups(_RenderPanel, ViewLayerLightgroupsPanel):
    bl_label = "Light Groups"
    bl_context = "view_layer"
    bl_parent_id = "AFTERGLOW_PT_passes"


class AFTERGLOW_PT_object_lightgroup(_RenderPanel, bpy.types.Panel):
    bl_label = "Light Group"
    bl_context = "object"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop_search(context.object, "lightgroup", context.view_layer, "lightgroups")


# Panels for lamps, materials and the world that draw nothing but what Blender itself and its nodes have.
_EXCLUDED = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_simplify"}
_CYCLES_PANELS = {"CYCLES_LIGHT_PT_light", "CYCLES_LIGHT_PT_nodes", "CYCLES_MATERIAL_PT_surface",
                  "CYCLES_WORLD_PT_surface", "CYCLES_CAMERA_PT_dof", "CYCLES_CAMERA_PT_dof_aperture",
                  "CYCLES_WORLD_PT_settings", "CYCLES_WORLD_PT_settings_light_group"}
_given = []  # what panels of Blender have got: panel, attribute, what the panel itself had there before or None
_CLASSES = (AFTERGLOW_PT_sampling, AFTERGLOW_PT_light, AFTERGLOW_PT_passes, AFTERGLOW_PT_lightgroups,
            AFTERGLOW_PT_object_lightgroup)


class _AsCycles:
    """A context in which the engine is Cycles."""
    engine = "CYCLES"

    def __init__(self, context):
        self._context = context

    def __getattr__(self, name):
        return getattr(self._context, name)


def _panels(base=bpy.types.Panel):
    for panel in base.__subclasses__():
        yield panel
        yield from _panels(panel)


def _give(panel, name, value):
    _given.append((panel, name, vars(panel).get(name)))
    setattr(panel, name, value)


def _poll_as_cycles(own):
    """Cycles' panels share one set of engines, and ask that which all inherit: each is asked as if for Cycles."""
    def poll(_panel, context):
        return own(_AsCycles(context) if context.engine == "AFTERGLOW" else context)
    return classmethod(poll)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    for panel in set(_panels()):
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if panel.__name__ in _CYCLES_PANELS:
            _give(panel, "poll", _poll_as_cycles(panel.poll))
        elif "BLENDER_RENDER" in engines and panel.__name__ not in _EXCLUDED:
            _give(panel, "COMPAT_ENGINES", engines | {"AFTERGLOW"})


def unregister():
    while _given:
        panel, name, before = _given.pop()
        if before is None:
            delattr(panel, name)
        else:
            setattr(panel, name, before)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
