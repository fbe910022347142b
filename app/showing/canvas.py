"""The widget that VTK draws in, on platforms with OpenGL and without."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QImage, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor


def make_canvas(parent: QWidget) -> tuple[QWidget, pv.BasePlotter]:
    """Return a widget and the plotter whose scene it shows.

    It is an interactor that takes no focus and no files; on Qt's offscreen platform, where it would have no
    OpenGL, it is a ``PaintedCanvas``.
    """
    if QGuiApplication.platformName() == "offscreen":
        painted = PaintedCanvas(parent)
        return painted, painted.plotter
    interactor = QtInteractor(parent, auto_update=False, multi_samples=0, lighting="none")
    interactor.setAcceptDrops(False)
    interactor.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return interactor, interactor


def draw(canvas: QWidget) -> None:
    """Have ``canvas`` draw its scene anew when the event loop next turns."""
    if isinstance(canvas, PaintedCanvas):
        canvas.forget()
    canvas.update()


class PaintedCanvas(QWidget):
    """Pictures of an off-screen plotter, for platforms on which Qt has no OpenGL."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMouseTracking(True)
        self.plotter = pv.Plotter(off_screen=True, lighting="none")
        self.plotter.ren_win.SetMultiSamples(0)
        self._image: QImage | None = None

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
        size = [max(round(side * ratio), 1) for side in (self.width(), self.height())]
        if list(self.plotter.window_size) != size:
            self.plotter.window_size = size
        self.plotter.ren_win.Render()
        pixels = np.ascontiguousarray(self.plotter.screenshot(return_img=True))
        height, width, _ = pixels.shape
        # QImage only borrows the pixels, so that it needs its own copy.
        return QImage(pixels.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
