"""Afterglow as a render engine of Blender 3.4. README.md beside this file says what is translated."""

bl_info = {
    "name": "Afterglow",
    "author": "The Afterglow authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties, Render Engine",
    "description": "Global illumination by photon mapping and final gathering",
    "category": "Render",
}

import bpy

from . import engine, panels, properties


class AfterglowPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    library: bpy.props.StringProperty(
        name="Library", subtype="FILE_PATH",
        description="libafterglow.so, where it is not installed; read when Blender first renders with it")

    def draw(self, _context):
        self.layout.prop(self, "library")


_MODULES = (properties, engine, panels)


def register():
    bpy.utils.register_class(AfterglowPreferences)
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
    bpy.utils.unregister_class(AfterglowPreferences)
