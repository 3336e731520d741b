"""The Python module of Afterglow, a copy of which lies beside this file, and the library that it finds."""

import os

import bpy


def load():
    """Errors: ImportError, whose text is for the user."""
    preferences = bpy.context.preferences.addons.get(__package__)
    path = preferences.preferences.library if preferences and preferences.preferences else ""
    is_named_here = path and "AFTERGLOW_LIBRARY" not in os.environ
    if is_named_here:
        os.environ["AFTERGLOW_LIBRARY"] = bpy.path.abspath(path)
    try:
        from . import afterglow
    except (OSError, AttributeError) as error:  # of a library that is there, and cannot be used
        raise ImportError(f"libafterglow cannot be used: {error}") from error
    finally:
        if is_named_here:  # the user may name another one
            del os.environ["AFTERGLOW_LIBRARY"]
    return afterglow
