"""The widget that VTK draws in: with a graphics card, without one, and with no display at all."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from functools import cache

import numpy as np
import pyvista as pv
from PySide6.QtCore import Qt
from PySide6.QtGui import (
    QGuiApplication,
    QImage,
    QOffscreenSurface,
    QOpenGLContext,
    QPainter,
    QPaintEvent,
    QResizeEvent,
)
from PySide6.QtWidgets import QWidget
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkProp

from app.seeing.still import StillPicture
from app.showing.graphics import is_safe_mode

_GL_RENDERER = 0x1F01


def make_canvas(parent: QWidget) -> tuple[QWidget, pv.BasePlotter]:
    """Return a widget and the plotter whose scene it shows.

    It is an interactor that takes no focus and no files; where no graphics card draws for Qt, it is a
    ``PaintedCanvas``.
    """
    if is_safe_mode() or not has_graphics_card():
        painted = PaintedCanvas(parent)
        return painted, painted.plotter
    from pyvistaqt import QtInteractor  # noqa: PLC0415 (a fifth of a second that not every start needs)

    interactor = QtInteractor(parent, auto_update=False, multi_samples=0, lighting="none")
    interactor.setAcceptDrops(False)
    interactor.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return interactor, interactor


@cache
def has_graphics_card() -> bool:
    """Tell whether OpenGL in Qt's windows is there and quick; Qt composes all of such a window with it.

    On software OpenGL that took longer than the picture itself. Only on Linux VTK has a software OpenGL of
    its own to draw with where Qt has no other.
    """
    if QGuiApplication.platformName() == "offscreen":
        return False
    if not sys.platform.startswith("linux"):
        return True
    context, ground = QOpenGLContext(), QOffscreenSurface()
    ground.create()
    if not (context.create() and context.makeCurrent(ground)):
        return False
    name = str(context.functions().glGetString(_GL_RENDERER)).lower()
    context.doneCurrent()
    return not any(software in name for software in ("llvmpipe", "softpipe", "swrast", "swiftshader"))


def draw(canvas: QWidget) -> None:
    """Have ``canvas`` draw its scene anew when the event loop next turns."""
    if isinstance(canvas, PaintedCanvas):
        canvas.forget()
    canvas.update()


class PaintedCanvas(QWidget):
    """Pictures of an off-screen plotter, painted as any other widget's: they need no OpenGL from Qt.

    While ``quick`` is set, what ``still`` returns is drawn again only if it has changed.
    """

    still: Callable[[], Iterable[vtkProp]] = staticmethod(tuple)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMouseTracking(True)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.plotter = pv.Plotter(off_screen=True, lighting="none")
        self.plotter.ren_win.SetMultiSamples(0)
        self.quick = False
        self._picture = StillPicture(self.plotter)
        self._image: QImage | None = None

    def let_go(self) -> None:
        """Give back what is kept of the graphics, before the plotter is closed."""
        self._picture.forget()
        del self.still

    def forget(self) -> None:
        """Have a new picture made at the next paint."""
        self._image = None

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Draw again at the new size."""
        self.forget()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Show the picture, made anew only if the scene has changed."""
        if self._image is None and not self.plotter._closed:
            self._image = self._render()
        if self._image is not None:
            painter = QPainter(self)
            painter.drawImage(self.rect(), self._image)
            painter.end()

    def _render(self) -> QImage:
        ratio = self.devicePixelRatioF()
        width, height = (max(round(side * ratio), 1) for side in (self.width(), self.height()))
        if list(self.plotter.window_size) != [width, height]:
            self.plotter.window_size = [width, height]
        window, pixels = self.plotter.ren_win, vtkUnsignedCharArray()
        if self.quick:
            self._picture.render(self.still())
        else:
            window.Render()
        window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels)
        rows = np.ascontiguousarray(vtk_to_numpy(pixels).reshape(height, width, 4)[::-1])
        rows[..., 3] = 255
        # QImage only borrows the pixels, so that it needs its own copy.
        return QImage(rows.data, width, height, 4 * width, QImage.Format.Format_RGBX8888).copy()
