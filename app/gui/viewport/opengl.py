"""Choice of OpenGL: graphics card, software, or neither (safe mode)."""

from __future__ import annotations

import os
from contextlib import suppress

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QOffscreenSurface, QOpenGLContext

from core.document.storage.crash_counter import StartMarker, failed_starts, forget_failed_starts

_SAFE = "safe mode"
_OFTEN = 2
_STRINGS = (("OpenGL", 0x1F02), ("Renderer", 0x1F01), ("Vendor", 0x1F00))
_trying: list[StartMarker] = []


def is_safe_mode() -> bool:
    """Return whether the 3D view is painted from images, without OpenGL in the window."""
    app = QCoreApplication.instance()
    return app is not None and bool(app.property(_SAFE))


def begin_graphics(safe: bool) -> str:
    """Decide before the first view how it is drawn, and return why it is drawn safely, or an empty text.

    It is done safely when asked for (``asked``), or when the last starts have ended before the view was
    drawn (``failed``): a graphics driver that crashes takes the whole program with it.
    """
    why = "asked" if safe else "failed" if len(failed_starts()) >= _OFTEN else ""
    app = QCoreApplication.instance()
    assert app is not None
    app.setProperty(_SAFE, bool(why))
    if why:
        # The driver that fails is left out wherever there is another: Mesa draws in software then.
        os.environ["LIBGL_ALWAYS_SOFTWARE"] = "1"
    else:
        try_graphics()
    return why


def try_graphics() -> None:
    """Remember, right before the driver is asked for something, that it may end the program."""
    spare_graphics()
    with suppress(OSError):
        _trying.append(StartMarker())


def spare_graphics() -> None:
    """Forget the last ``try_graphics``: nothing is asked of the driver for now. Former ends still count."""
    while _trying:
        _trying.pop().remove()


def graphics_work() -> None:
    """Record that the driver has done what it was asked for."""
    spare_graphics()
    forget_failed_starts()


def graphics_in_words() -> list[tuple[str, str]]:
    """Return version, renderer and vendor of the OpenGL that Qt has, ready to read."""
    context, ground = QOpenGLContext(), QOffscreenSurface()
    ground.create()
    if not (context.create() and context.makeCurrent(ground)):
        return [("OpenGL", "-")]
    functions = context.functions()
    texts = [(name, str(functions.glGetString(number))) for name, number in _STRINGS]
    context.doneCurrent()
    return texts
