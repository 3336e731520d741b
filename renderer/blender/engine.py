"""The render engine: a picture's way from the dependency graph to Blender's render result."""

import time
import traceback
import weakref

import bpy
import numpy as np

from . import cameras, cryptomatte, library, motion, passes, translation, untranslated, view_drawing, viewport
from .notes import Notes

_PHASES = ("Reading", "Building trees", "Tracing photons", "Building maps", "Computing irradiance", "Rendering", "Writing")
_PHASE_RENDER = 5
_SHOW_S = 0.5  # the picture is shown no more often than this, nor does showing it take more than a tenth of the time


_VIEWPORTS = {}  # of engines that draw a 3D view, by their id


class _Stopped(Exception):
    pass


def _redrawing(engine):
    """Asks for a redraw as long as the engine is there; it does not keep it."""
    reference = weakref.ref(engine)

    def redraw():
        try:
            reference().tag_redraw()
        except (AttributeError, ReferenceError):
            pass  # the view has been closed

    return redraw


class AfterglowEngine(bpy.types.RenderEngine):
    bl_idname = "AFTERGLOW"
    bl_label = "Afterglow"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True  # materials are previewed by it

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for one in passes.passes_of(renderlayer):
            self.register_pass(scene, renderlayer, one.name, len(one.channels), one.channels, one.kind)

    def _viewport_of(self, context):
        """Made when it is first asked for; None where the library cannot be used."""
        if id(self) not in _VIEWPORTS:
            _VIEWPORTS[id(self)] = None
            try:
                _VIEWPORTS[id(self)] = viewport.Viewport(library.load(), _redrawing(self),
                                                         lambda text: print(f"Afterglow: {text}"))
            except ImportError as error:
                self.update_stats("Afterglow", str(error))
        region, view = context.region, context.region_data
        return _VIEWPORTS[id(self)], cameras.view_of(view.view_matrix, view.window_matrix, view.is_perspective,
                                               (max(region.width, 1), max(region.height, 1)))

    def view_update(self, context, depsgraph):
        shown, view = self._viewport_of(context)
        if shown:
            try:
                shown.update(depsgraph, view)
            except Exception as error:  # of a scene: the view stays as it is, and says so
                self.update_stats("Afterglow", str(error))

    def view_draw(self, context, depsgraph):
        shown, view = self._viewport_of(context)
        if not shown:
            return
        shown.look(view)
        self.update_stats("Afterglow", shown.status)
        pixels = shown.picture()
        if pixels is not None:
            self.bind_display_space_shader(depsgraph.scene)
            view_drawing.draw(pixels, view.size)
            self.unbind_display_space_shader()

    def __del__(self):  # of what Blender has taken away already: there are no attributes any more
        shown = _VIEWPORTS.pop(id(self), None)
        if shown:
            shown.close()

    def render(self, depsgraph):
        try:
            afterglow = library.load()
        except ImportError as error:
            self.report({"ERROR"}, str(error))
            self.error_set(str(error))
            return
        try:
            _Frame(self, depsgraph, afterglow).render()
        except (_Stopped, afterglow.Cancelled):
            pass
        except Exception as error:  # one that left this function could end Blender
            if not isinstance(error, (afterglow.Error, RuntimeError)):
                traceback.print_exc()
            self.report({"ERROR"}, f"Afterglow: {error}")
            self.error_set(f"Afterglow: {error}")


class _Frame:
    """One picture of one view layer."""

    def __init__(self, engine, depsgraph, afterglow):
        self._engine, self._depsgraph, self._afterglow = engine, depsgraph, afterglow
        self._scene = depsgraph.scene_eval
        self._settings = self._scene.afterglow
        self._layer = depsgraph.view_layer_eval
        self._notes = Notes(lambda text: engine.report({"WARNING"}, f"Afterglow: {text}"))
        self._passes = passes.passes_of(self._layer)
        self._shown_s, self._show_cost_s = 0.0, 0.0
        self._progress = (0, 0.0)

    def _hear_progress(self, phase, fraction):  # on a thread of the library
        self._progress = (phase, fraction)

    def _poll(self):
        if self._engine.test_break():
            raise _Stopped

    def _library_settings(self, size, border):
        own = self._settings
        seed = own.seed + (self._scene.frame_current if own.use_animated_seed else 0)
        made = {"size": f"{size[0]}x{size[1]}", "cropwindow": cameras.crop_window(border, size), "seed": seed,
                "spp": own.samples, "noise": own.noise, "radius": own.radius,
                "clamp_direct": own.clamp_direct, "clamp_indirect": own.clamp_indirect,
                "aov": passes.layers_of(self._passes, self._scene.render.film_transparent)}
        if own.use_fixed_photons:
            made.update(photons=own.photons, caustic_photons=own.caustic_photons)
        if own.gather_samples:
            made["gather_samples"] = own.gather_samples
        if own.use_path_tracing:
            made["integrator"] = "path"
        if own.use_denoising:
            made["denoise"] = True
        if own.photon_map:
            made.update(photon_map=bpy.path.abspath(own.photon_map), photon_map_refresh=True, photon_seed=own.seed)
        return made

    def render(self):
        render = self._scene.render
        threads = render.threads if render.threads_mode == "FIXED" else 0
        size = cameras.picture_size(render)
        border = cameras.border_of(render, size)
        self._engine.update_stats("", _PHASES[0])
        with self._afterglow.Context(threads=threads, progress=self._hear_progress, warn=self._notes.say) as context, \
                context.scene() as scene:
            untranslated.tell(self._scene, self._layer, self._notes)
            self._hint(scene)
            moved = motion.look_ahead(self._engine, self._depsgraph, self._notes, self._poll)
            mattes = passes.crypto_kinds(self._layer)
            names = translation.translate(scene, self._depsgraph, moved, self._notes, self._poll, is_by_name=bool(mattes))
            for kind, place in mattes:
                self._tell_names(cryptomatte.metadata(self._layer.name, kind, names[place]))
            scene.complete(self._watch_phase)
            for view in self._views():
                if view:
                    self._engine.active_view_set(view)
                    cameras.add_camera(scene, self._engine.camera_override, render, moved, self._notes, self._engine)
                with scene.rendering(poll=self._watch_phase, **self._library_settings(size, border)) as rendering:
                    self._refine(rendering, view)

    def _views(self):
        """Names of the views to be rendered; "" where there is one alone."""
        return [view.name for view in self._engine.get_result().views] if self._scene.render.use_multiview else [""]

    def _tell_names(self, fields):
        result = self._engine.get_result()
        for field, value in fields.items():
            result.stamp_data_add_field(field, value)

    def _hint(self, scene):
        cycles = getattr(self._scene, "cycles", None)
        exposure = cycles.film_exposure if cycles else 1.0
        scene.hint("Film", "rgb", {"float iso": 100 * max(exposure, 1e-6)})
        width = cycles.filter_width if cycles else 1.5
        scene.hint("PixelFilter", "gaussian", {"float xradius": width, "float yradius": width, "float sigma": width / 3})

    def _watch_phase(self):
        self._poll()
        phase, fraction = self._progress
        self._engine.update_stats("", f"{_PHASES[phase]} {100 * fraction:.0f} %")

    def _refine(self, rendering, view):
        """All samples in passes, each twice as many as before, and the picture shown as it grows."""
        height, width = rendering.shape
        result = self._engine.begin_result(0, 0, width, height, layer=self._layer.name, view=view)
        most, samples = self._settings.samples, 1
        is_whole = False
        try:
            while True:
                rendering.advance(samples, lambda: self._watch(rendering, result, samples / 2, samples, most))
                if samples == most:
                    break
                samples = min(2 * samples, most)
                if rendering.sample_counts()[1] < samples / 2:
                    break  # the noise that was asked for is reached everywhere
            if self._settings.use_denoising:
                self._engine.update_stats("", "Denoising")
                self._denoise(rendering)
            self._fill(result, rendering)
            is_whole = True
        finally:
            if not is_whole:
                self._show(rendering, result)
            self._engine.end_result(result, cancel=False)

    def _denoise(self, rendering):
        """A picture that cannot be denoised is whole for all that."""
        try:
            rendering.denoise(self._poll)
        except self._afterglow.Cancelled:
            raise
        except self._afterglow.Error as error:
            self._notes.say(f"the picture is not denoised: {error}")

    def _watch(self, rendering, result, before, samples, most):
        self._poll()
        phase, fraction = self._progress
        done = (before + (samples - before) * fraction) / most if phase == _PHASE_RENDER else before / most
        self._engine.update_progress(min(max(done, 0.0), 1.0))
        self._engine.update_stats("", f"Sample {samples} of {most} at most, {100 * fraction:.0f} %")
        now = time.monotonic()
        if now - self._shown_s >= max(_SHOW_S, 10 * self._show_cost_s):
            self._show(rendering, result)
            self._shown_s = time.monotonic()
            self._show_cost_s = self._shown_s - now

    def _show(self, rendering, result):
        pixels = rendering.watch()
        if pixels is not None:
            result.layers[0].passes["Combined"].rect = passes.combined_pixels(pixels)
            self._engine.update_result(result)

    def _fill(self, result, rendering):
        channels = rendering.channels()
        rgb = np.stack([channels[name] for name in "RGB"], -1)
        alpha = channels["A"] if self._scene.render.film_transparent else None
        if alpha is not None:
            rgb = passes.without_sky(rgb, channels)
        found = result.layers[0].passes
        found["Combined"].rect = passes.combined_pixels(rgb, alpha)
        for one in self._passes:
            if one.name in found:
                found[one.name].rect = passes.pixels_of(one, channels, rendering.shape)


def register():
    bpy.utils.register_class(AfterglowEngine)


def unregister():
    bpy.utils.unregister_class(AfterglowEngine)
