"""Smooth things of many colours, moved in place: the skin, ribbons."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pyvista as pv

from core.geometry.mesh import Faces

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
