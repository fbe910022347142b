"""Straight lines of sight: where they first meet what is drawn."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from core.geometry.mesh import Floats


class RayPicker:
    """Where a straight sight first meets drawn triangles; looks them up anew after they moved."""

    def __init__(self, data: pv.PolyData) -> None:
        self._data = data
        self._locator: vtkStaticCellLocator | None = None

    def clear(self) -> None:
        """Say that the triangles have moved."""
        self._locator = None

    def hit(self, start: Floats, end: Floats) -> Floats | None:
        """Return where the segment between two points, each (3,) [mm], first meets the triangles, or None."""
        if self._locator is None:
            self._locator = vtkStaticCellLocator()
            self._locator.SetDataSet(self._data)
            self._locator.BuildLocator()
        places = vtkPoints()
        self._locator.IntersectWithLine(start.tolist(), end.tolist(), places, None)
        return np.array(places.GetPoint(0)) if places.GetNumberOfPoints() else None
