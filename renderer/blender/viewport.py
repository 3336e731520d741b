"""Rendering in a 3D view: a scene that is read when anything in it changes, and a thread that refines its picture. A moved
view alone goes on with the same scene and photons, which a file keeps as long as the view is there."""

import os
import tempfile
import threading

from . import cameras, translation
from .motion import Motion
from .notes import Notes

_PHOTONS_MOST = 200000  # of a view; pictures have as many as their settings say


class _Stopped(Exception):
    pass


class Viewport:
    """redraw: called, on any thread, when there is a new picture; report: with the text of each note."""

    def __init__(self, afterglow, redraw, report):
        self._redraw, self._notes = redraw, Notes(report)
        self._context = afterglow.Context(warn=self._notes.say)
        self._cancelled = afterglow.Cancelled
        self._folder = tempfile.TemporaryDirectory(
            prefix="afterglow-view-", dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None)
        self._scene = self._thread = self._settings = self.view = None
        self._is_stopping = False
        self._lock = threading.Lock()
        self._picture = None
        self.status = ""

    def update(self, depsgraph, view):
        """Reads the scene anew, on the thread that may ask Blender, and shows it by a view."""
        self._stop()
        self._close_scene()
        own = depsgraph.scene_eval.afterglow
        fixed = (own.photons, own.caustic_photons) if own.use_fixed_photons else 2 * (_PHOTONS_MOST,)
        self._settings = {"spp": own.samples, "noise": own.noise, "seed": own.seed, "radius": own.radius,
                          "photons": min(fixed[0], _PHOTONS_MOST), "caustic_photons": min(fixed[1], _PHOTONS_MOST),
                          "photon_map": os.path.join(self._folder.name, "photons.map"), "photon_map_refresh": True}
        self._scene = self._context.scene()
        try:
            translation.translate(self._scene, depsgraph, Motion(), self._notes, lambda: None, view)
        except BaseException:
            self._close_scene()
            raise
        self._start(view)

    def look(self, view):
        """Shows the same scene by another view; nothing where it is this one already."""
        if self._scene is not None and view != self.view:
            self._stop()
            self._start(view)

    def picture(self):
        """(height, width, 3), top row first; None before there is any."""
        with self._lock:
            return self._picture

    def wait(self):
        """Until the picture has all its samples."""
        if self._thread:
            self._thread.join()

    def close(self):
        self._stop()
        self._close_scene()
        self._context.close()
        self._folder.cleanup()

    def _close_scene(self):
        if self._scene is not None:
            self._scene.close()
            self._scene = None

    def _start(self, view):
        self.view, self._is_stopping = view, False
        self._thread = threading.Thread(target=self._refine)
        self._thread.start()

    def _stop(self):
        if self._thread:
            self._is_stopping = True
            self._thread.join()
            self._thread = None

    def _poll(self):
        if self._is_stopping:
            raise _Stopped

    def _show(self, rendering):
        pixels = rendering.watch()
        if pixels is not None:
            with self._lock:
                self._picture = pixels.copy()
            self._redraw()

    def _refine(self):
        def poll():
            self._poll()
            self._show(rendering)

        try:
            self.status = "Tracing photons"
            self._scene.complete(self._poll)
            cameras.add_view(self._scene, self.view)
            settings = dict(self._settings, size="%dx%d" % self.view.size)
            with self._scene.rendering(poll=self._poll, **settings) as rendering:
                samples, most = 1, self._settings["spp"]
                while True:
                    rendering.advance(samples, poll)
                    self._show(rendering)
                    self.status = f"Sample {samples} of {most} at most"
                    if samples == most or rendering.sample_counts()[1] < samples:
                        break
                    samples = min(2 * samples, most)
        except (_Stopped, self._cancelled):
            pass
        except Exception as error:  # a thread has nobody to raise it to
            self.status = str(error)
            self._notes.say(str(error))
            self._redraw()
