"""Actors of many colours that are moved in place, and rays that meet them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from core.geometry.mesh import Faces, Floats

Reals = npt.NDArray[np.floating]


def smooth_actor(
    plotter: pv.BasePlotter, name: str, places: Reals, normals: Reals, faces: Faces, **look: float
) -> tuple[pv.PolyData, pv.Actor]:
    """Show a mesh of places and unit normals (n, 3) with "Colour", (n, 3) uint8, at its vertices.

    ``look`` is how it takes light. The data may be changed in place: single precision, and no copies.
    """
    data = pv.PolyData.from_regular_faces(places.astype(np.float32), faces)
    data.point_data["Normals"] = normals.astype(np.float32)
    data.point_data["Colour"] = np.full(places.shape, 255, dtype=np.uint8)
    actor = plotter.add_mesh(
        data,
        scalars="Colour",
        rgb=True,
        copy_mesh=False,
        name=name,
        reset_camera=False,
        render=False,
        **look,
    )
    # Else a filter in Python stands between, which is asked several times a picture and copies.
    data.set_active_scalars("Colour")
    actor.mapper.SetInputDataObject(data)
    actor.prop.interpolation = "Gouraud"
    data.point_data.active_normals_name = "Normals"
    return data, actor


class RayPicker:
    """Where a straight sight first meets drawn triangles; looks them up anew after they moved."""

    def __init__(self, data: pv.PolyData) -> None:
        self._data = data
        self._locator: vtkStaticCellLocator | None = None

    def clear(self) -> None:
        """Drop the cached triangles after a change."""
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
