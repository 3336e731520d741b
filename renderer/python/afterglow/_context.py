"""Threads, log and progress, and where scenes come from."""

from __future__ import annotations

import ctypes
import operator
import threading
import warnings
from collections.abc import Callable
from ctypes import byref, c_void_p
from typing import Any, Optional, Union

from ._arguments import Path, encoded
from ._declarations import ContextSettings, LogFn, LogLevel, ProgressFn, SceneSettings, Status, Struct
from ._errors import Cancelled, Error, opened
from ._interface import library
from ._scene import Scene

MOST_THREADS = 2**32 - 1  # that the library's unsigned number can say


class Context:
    """Threads, log and progress. `threads`: 0 for as many as there are; `progress`: called with the number of a phase
    (AG_PHASE_..., from 0 on) and how far it is, in [0, 1], on the library's threads; an exception there calls the work
    off. `warn`: called with the text of each warning, on the thread that works with the context; None: Python's
    warnings. `color_config` and `working_space` are those of the program's options."""

    def __init__(self, threads: int = 0, progress: Optional[Callable[[int, float], None]] = None,
                 working_space: Optional[str] = None, color_config: Optional[Path] = None,
                 warn: Optional[Callable[[str], None]] = None) -> None:
        if not 0 <= operator.index(threads) <= MOST_THREADS:
            raise ValueError(f"threads: {threads} is not in [0, {MOST_THREADS}]")
        self._said = []
        self._progress = progress
        self._warn = warn or (lambda message: warnings.warn(message, stacklevel=4))
        self._failed = None
        self._callbacks = (LogFn(self._hear), ProgressFn(self._tell))  # they live as long as the context
        self._held = c_void_p()
        self._scenes = []  # that are not closed
        self._is_at_work = False
        settings = ContextSettings(struct_size=ctypes.sizeof(ContextSettings), thread_count=threads,
                                   working_space=encoded(working_space), color_config=encoded(color_config),
                                   log=self._callbacks[0], progress=self._callbacks[1])
        self._check(library.ag_context_create(byref(settings), byref(self._held)))

    @property
    def _pointer(self):
        return opened(self._held, "context")

    def _hear(self, _user, level, message):
        if level <= LogLevel.WARNING:
            self._said.append(message.decode(errors="replace"))

    def _tell(self, _user, phase, fraction):
        if not self._progress or self._failed:
            return
        try:
            self._progress(phase, fraction)
        except BaseException as failed:  # it is raised where the work was begun
            self._failed = failed
            self.cancel()

    def _check(self, status):
        said, self._said = self._said, []
        failed, self._failed = self._failed, None
        if failed:
            library.ag_context_clear_cancel(self._pointer)
            raise failed
        if status == Status.OK:
            for message in said:
                self._warn(message)
            return
        text = "\n".join(said) or library.ag_status_text(status).decode()
        raise (Cancelled if status == Status.CANCELLED else Error)(text)

    def _work(self, function, *arguments, poll=None):
        """Calls the library on a thread of its own, so that Ctrl-C is heard here meanwhile, and calls it off. poll: called
        about every 0.1 s; so does an exception there."""
        self._expect_rest()
        self._is_at_work = True
        try:
            status = self._work_aside(function, arguments, poll)
        finally:
            self._is_at_work = False
        self._check(status)

    def _expect_rest(self):
        """Errors: Error, where the context is at work; its callbacks may not call what would work with it as well."""
        if self._is_at_work:
            raise Error("the context is at work, and until that is done only cancel and watch can be called")

    def _work_aside(self, function, arguments, poll):
        result, failed = [], []
        is_done = threading.Event()  # an interrupted Thread.join takes the thread for ended (bpo-45274)

        def work():
            try:
                result.append(function(*arguments))
            except BaseException as error:  # of an argument's type; it is raised on the calling thread
                failed.append(error)
            finally:
                is_done.set()

        threading.Thread(target=work).start()
        try:
            while not is_done.wait(0.1):
                if poll:
                    poll()
        except BaseException:
            self.cancel()
            while not is_done.is_set():  # what the library works on is still its own, however often Ctrl-C is pressed
                try:
                    is_done.wait()
                except KeyboardInterrupt:
                    pass
            library.ag_context_clear_cancel(self._pointer)
            self._said = []
            raise
        if failed:
            raise failed[0]
        return result[0]

    def cancel(self) -> None:
        """Calls the work under way off, as soon as ag_context_cancel of context.h says; from any thread."""
        library.ag_context_cancel(self._pointer)

    def scene(self, editable: bool = False) -> Scene:
        """An empty scene. editable: it can be changed once it is complete."""
        self._expect_rest()
        settings = SceneSettings()
        library.ag_struct_fill(Struct.SCENE_SETTINGS, byref(settings), ctypes.sizeof(settings))
        settings.is_editable = editable
        return Scene(self, library.ag_scene_create, byref(settings))

    def load(self, path: Path) -> Scene:
        """The scene of a file: pbrt-v4's text, glTF, OBJ and what else the program reads."""
        return Scene(self, library.ag_scene_load, encoded(path), is_complete=True)

    def load_text(self, text: Union[str, bytes], name: str = "text") -> Scene:
        """The scene of pbrt-v4's text; files are looked for in the folder in front of the name's last slash."""
        text = text.encode() if isinstance(text, str) else text
        return Scene(self, library.ag_scene_load_text, encoded(name), text, len(text), None, is_complete=True)

    def close(self) -> None:
        """Ends the context; closes its scenes and their renderings."""
        self._expect_rest()
        for scene in list(self._scenes):
            scene.close()
        if self._held:
            library.ag_context_destroy(self._held)
            self._held = c_void_p()

    def __enter__(self) -> Context:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
