"""Panels of render and view layer properties; and those of Blender's own that go with any engine."""

import bpy


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
        _props(self.layout, context.scene.afterglow, (
            "photons", "caustic_photons", "radius", "gather_samples", "clamp_direct", "clamp_indirect",
            "photon_map", "use_path_tracing"))


class AFTERGLOW_PT_passes(_RenderPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        _props(self.layout, context.view_layer, ("use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_uv"))
        _props(self.layout, context.view_layer.afterglow, (
            "use_albedo", "use_emission", "use_direct", "use_indirect", "use_caustic", "use_specular"))


# Panels for lamps, materials and the world that draw nothing but what Blender itself and its nodes have.
_EXCLUDED = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_simplify"}
_CYCLES_PANELS = {"CYCLES_LIGHT_PT_light", "CYCLES_LIGHT_PT_nodes", "CYCLES_MATERIAL_PT_surface",
                  "CYCLES_WORLD_PT_surface", "CYCLES_CAMERA_PT_dof", "CYCLES_CAMERA_PT_dof_aperture",
                  "CYCLES_RENDER_PT_light_groups", "CYCLES_RENDER_PT_passes_lightgroups"}
_CLASSES = (AFTERGLOW_PT_sampling, AFTERGLOW_PT_light, AFTERGLOW_PT_passes)


def _foreign_panels():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None:
            continue
        if ("BLENDER_RENDER" in engines and panel.__name__ not in _EXCLUDED) or panel.__name__ in _CYCLES_PANELS:
            yield engines


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    for engines in _foreign_panels():
        engines.add("AFTERGLOW")


def unregister():
    for engines in _foreign_panels():
        engines.discard("AFTERGLOW")
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
