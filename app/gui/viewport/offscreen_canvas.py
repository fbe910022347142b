"""Pictures of a scene drawn off-screen, for a canvas that Qt paints as any other widget."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import pyvista as pv
from PySide6.QtGui import QImage
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkProp

from app.rendering.layer_cache import StaticLayerCache


class OffscreenCanvas:
    """Draws an off-screen plotter; no OpenGL is needed from Qt.

    While ``quick`` is set, what ``still`` returns is drawn again only if it has changed.
    """

    still: Callable[[], Iterable[vtkProp]] = staticmethod(tuple)

    def __init__(self) -> None:
        self.plotter = pv.Plotter(off_screen=True, lighting="none")
        self.plotter.ren_win.SetMultiSamples(0)
        self.quick = False
        self._picture = StaticLayerCache(self.plotter)

    def let_go(self) -> None:
        """Release graphics resources, before the plotter is closed."""
        self._picture.clear()
        del self.still

    def draw(self, width: int, height: int) -> QImage | None:
        """Return what is seen in so many pixels; None once the plotter is closed."""
        if self.plotter._closed:
            return None
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
