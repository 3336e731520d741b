"""The library itself, its functions with the types that the headers declare."""

from __future__ import annotations

import ctypes
import ctypes.util
import os

from ._declarations import FUNCTIONS


def _load():
    name = os.environ.get("AFTERGLOW_LIBRARY") or ctypes.util.find_library("afterglow")
    if not name:
        raise ImportError("libafterglow is not installed, and $AFTERGLOW_LIBRARY does not name it")
    loaded = ctypes.CDLL(name)
    for function, (result, arguments) in FUNCTIONS.items():
        getattr(loaded, function).restype = result
        getattr(loaded, function).argtypes = arguments
    return loaded


library = _load()
