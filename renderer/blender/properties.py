"""What a user may set: of a scene, and of a view layer the passes that Blender itself has no switch for."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, PointerProperty, StringProperty


class AfterglowSceneSettings(bpy.types.PropertyGroup):
    samples: IntProperty(name="Samples", min=1, max=1 << 20, default=256,
                         description="Samples per pixel, the most that any pixel gets")
    noise: FloatProperty(name="Noise", min=0, max=1, default=0.02, precision=4,
                         description="Pixels get samples until the noise that is seen is below this, where white is 1; 0: "
                                     "all get as many")
    seed: IntProperty(name="Seed", min=0, default=0, description="Of all random numbers")
    use_animated_seed: BoolProperty(name="Animate Seed", default=True,
                                    description="The frame's number is added to the seed, so that noise does not stand still")
    use_fixed_photons: BoolProperty(name="Fixed Photons", default=False,
                                    description="As many as are told below, whatever the picture; else as many as its "
                                                "samples can show")
    photons: IntProperty(name="Photons", min=1, default=1000000, description="To be stored in the global map")
    caustic_photons: IntProperty(name="Caustic Photons", min=0, default=500000,
                                 description="To be stored in the caustic map, where anything is specular")
    radius: FloatProperty(name="Radius", min=0, default=0, subtype="DISTANCE",
                          description="Largest radius of an estimate; 0: from the photons' density")
    gather_samples: IntProperty(name="Gather Rays", min=0, max=65536, default=0,
                                description="For each camera sample; 0: pixels choose by their noise")
    clamp_direct: FloatProperty(name="Clamp Direct", min=0, default=0, description="No sample gets more; 0: unbounded")
    clamp_indirect: FloatProperty(name="Clamp Indirect", min=0, default=0,
                                  description="No sample gets more; 0: unbounded")
    use_path_tracing: BoolProperty(name="Path Tracing", default=False,
                                   description="Without photons, to compare with: slower, and without caustics of points")
    photon_map: StringProperty(name="Photon Map", subtype="FILE_PATH",
                               description="A file that keeps the photon map from frame to frame, where nothing but the "
                                           "camera moves; traced anew where the scene is another one")
    use_denoising: BoolProperty(name="Denoise", default=False,
                                description="With Open Image Denoise, where its library is installed")


class AfterglowLayerSettings(bpy.types.PropertyGroup):
    use_albedo: BoolProperty(name="Albedo", default=False)
    use_emission: BoolProperty(name="Emission", default=False, description="Straight from lamps and sky")
    use_direct: BoolProperty(name="Direct", default=False, description="From lamps by way of one diffuse surface")
    use_indirect: BoolProperty(name="Indirect", default=False, description="What else diffuse surfaces reflect")
    use_caustic: BoolProperty(name="Caustic", default=False, description="From lamps by way of mirrors and glass")
    use_specular: BoolProperty(name="Specular", default=False, description="By mirrors, glass and glossy surfaces")


_CLASSES = (AfterglowSceneSettings, AfterglowLayerSettings)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.afterglow = PointerProperty(type=AfterglowSceneSettings)
    bpy.types.ViewLayer.afterglow = PointerProperty(type=AfterglowLayerSettings)


def unregister():
    del bpy.types.Scene.afterglow
    del bpy.types.ViewLayer.afterglow
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
