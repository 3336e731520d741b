"""What is raised."""


class Error(Exception):
    """What the library could not do, with what its log says of it."""


class Cancelled(Error):
    """The work was called off, by Context.cancel."""


def opened(held, what):
    """A pointer that the library may be given. Errors: Error, where what it points to is closed."""
    if not held:
        raise Error(f"the {what} is closed")
    return held
