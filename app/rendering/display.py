"""Availability of a display; imported before Qt and VTK."""

from __future__ import annotations

import os
import sys


def has_display() -> bool:
    """Return whether a window can be shown."""
    return sys.platform in ("win32", "darwin") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


def off_screen() -> None:
    """Let Qt and VTK draw into memory, if there is no display to draw on."""
    if not has_display():
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
