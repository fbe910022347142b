"""Pictures to keep of what the views show: finer than the screen, without what is there for the hand."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pyvista as pv
from PySide6.QtCore import QPoint, QSize, Qt
from PySide6.QtGui import QImage, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkResizingWindowToImageFilter

from app.gui.viewport.plane_handle import PlaneHandle
from app.gui.viewport.split_view import SplitView
from app.gui.viewport.viewport import Viewport

SAMPLES = 2
"""Pixels drawn for each one of the picture, in both directions: no stairs at the outlines."""

MOST = 8192
"""Width and height that every graphics driver can draw [px]."""


def fine_picture(panes: SplitView, finer: float) -> QImage:
    """Return all that is seen with ``finer`` times the pixels of the screen in both directions.

    No line is marked as selected; pins, values and titles stay. Belongs to the thread of the window.
    """
    ratio = panes.devicePixelRatioF() * finer
    image = QImage(_times(panes.size(), ratio), QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    handles = [handle for handle in panes.findChildren(PlaneHandle) if not handle.isHidden()]
    sheets: list[_Sheet] = []
    try:
        panes.handle.set_bare(True)
        for handle in handles:
            handle.hide()
        for viewport in panes.viewports:
            viewport.paint_at_once()
            sheets.append(_Sheet(viewport, finer))  # one by one: those that were made are taken away
        panes.render(image, QPoint())
    finally:
        for sheet in sheets:
            sheet.take_away()
        panes.handle.set_bare(False)
        for handle in handles:
            handle.show()
    return image


class _Sheet(QWidget):
    """A finely drawn picture of a scene, over its canvas and under what Qt draws on it."""

    def __init__(self, viewport: Viewport, finer: float) -> None:
        overlay = viewport.overlay
        super().__init__(overlay.parentWidget())
        self._viewport = viewport
        self._image = _drawn(viewport, finer)
        overlay.set_band(None)
        self.setGeometry(overlay.geometry())
        self.stackUnder(overlay)
        self.show()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Lay the picture on the canvas."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.drawImage(self.rect(), self._image)

    def take_away(self) -> None:
        """Show the canvas again, with all its labels."""
        self.hide()
        self.deleteLater()
        self._viewport.request_draw()


def _drawn(viewport: Viewport, finer: float) -> QImage:
    """Return the scene of a viewport with no line marked."""
    scene, plotter = viewport.scene, viewport.scene.plotter
    size = _times(viewport.overlay.size(), viewport.devicePixelRatioF() * finer)
    samples = SAMPLES if SAMPLES * max(size.width(), size.height()) <= MOST else 1
    marked = scene.bands.selected, scene.bands.hovered
    viewport.request_draw()  # the filters for smooth outlines are for the size of the screen
    scene.mark_bands()
    if scene.body is not None:
        scene.body.set_detail(0.0)
    try:
        with _thicker(plotter, finer * samples):
            image = _rendered(plotter, size * samples)
    finally:
        scene.mark_bands(*marked)
    return image.scaled(
        size, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation
    )


def _rendered(plotter: pv.BasePlotter, size: QSize) -> QImage:
    camera = vtkResizingWindowToImageFilter()
    camera.SetInput(plotter.ren_win)
    camera.SetSize(size.width(), size.height())
    camera.SetInputBufferTypeToRGB()
    camera.Update()
    output = camera.GetOutput()
    width, height, _ = output.GetDimensions()
    pixels = vtk_to_numpy(output.GetPointData().GetScalars()).reshape(height, width, 3)
    rows = np.ascontiguousarray(pixels[::-1])
    return QImage(rows.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()


@contextmanager
def _thicker(plotter: pv.BasePlotter, times: float) -> Iterator[None]:
    """Draw lines so many times as thick meanwhile: their width is in pixels."""
    actors = (actor for actor in plotter.renderer.actors.values() if isinstance(actor, pv.Actor))
    props = {id(actor.prop): actor.prop for actor in actors}
    widths = [(prop, prop.line_width) for prop in props.values()]
    for prop, width in widths:
        prop.line_width = times * width
    try:
        yield
    finally:
        for prop, width in widths:
            prop.line_width = width


def _times(size: QSize, ratio: float) -> QSize:
    return QSize(round(size.width() * ratio), round(size.height() * ratio)).expandedTo(QSize(1, 1))
