"""Bodies with arms of capsules in known poses, apart from the trunk or grown together with it."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial import cKDTree
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

from core.geometry.mesh import Mesh

Limb = tuple[tuple[float, float, float], tuple[float, float, float], float]
"""A capsule: both ends of its axis and its radius [mm]."""

POSES: dict[str, tuple[tuple[float, float, float], ...]] = {
    # shoulder, elbow and wrist of a left arm: beyond the side of the trunk, behind its middle, above its bust
    "hanging close": ((30.0, 5.0, 100.0), (52.0, 10.0, -170.0), (60.0, -20.0, -400.0)),
    "touching": ((15.0, 5.0, 100.0), (36.0, 10.0, -170.0), (55.0, -20.0, -400.0)),
    "a little behind": ((20.0, 30.0, 100.0), (42.0, 45.0, -170.0), (60.0, 10.0, -400.0)),
    "spread": ((20.0, 5.0, 110.0), (300.0, 5.0, 90.0), (500.0, 5.0, 80.0)),
    "raised": ((15.0, 5.0, 120.0), (60.0, 5.0, 380.0), (20.0, 5.0, 600.0)),
    "hands on hips": ((25.0, 5.0, 100.0), (190.0, 30.0, -120.0), (20.0, -40.0, -290.0)),
    "forearms in front": ((35.0, 5.0, 100.0), (60.0, 0.0, -150.0), (-60.0, -260.0, -120.0)),
}


def arms(pose: str, half_width: float, middle: tuple[float, float], bust: float) -> list[Limb]:
    """Both arms in a pose, for a trunk of this half width about ``middle`` (x, y), with this bust level."""
    limbs: list[Limb] = []
    for sign in (1.0, -1.0):
        joints = [(middle[0] + sign * (half_width + x), middle[1] + y, bust + z) for x, y, z in POSES[pose]]
        limbs += [(joints[0], joints[1], 42.0), (joints[1], joints[2], 34.0)]
    return limbs


def apart(body: Mesh, limbs: list[Limb]) -> Mesh:
    """The body and its limbs as closed surfaces of their own, which may run into one another."""
    parts = [(body.vertices, body.faces)]
    for a, b, radius in limbs:
        axis = np.subtract(b, a)
        capsule = trimesh.creation.capsule(float(np.linalg.norm(axis)), radius, count=[48, 48])
        turn = trimesh.geometry.align_vectors([0.0, 0.0, 1.0], axis / np.linalg.norm(axis))
        parts.append((capsule.vertices @ turn[:3, :3].T + 0.5 * np.add(a, b), capsule.faces))
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts[:-1]])
    faces = [np.asarray(faces) + start for (_, faces), start in zip(parts, starts, strict=True)]
    return Mesh(np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces))


def grown(body: Mesh, limbs: list[Limb], cell: float = 4.0, web: float = 6.0, low: float = -np.inf) -> Mesh:
    """One skin round the body and its limbs, with a web between them, as scanned, from ``low`` up."""
    ends = [np.add(end, sign * radius) for a, b, radius in limbs for end in (a, b) for sign in (1.0, -1.0)]
    first, last = (
        pick([*ends, *body.vertices], axis=0) + side for pick, side in ((np.min, -10.0), (np.max, 10.0))
    )
    first[2] = max(low, body.vertices[:, 2].min() - 10.0)
    axes = [np.arange(first[k], last[k], cell) for k in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    points = grid.reshape(-1, 3)
    _, nearest = cKDTree(body.vertices).query(points)
    inside = -np.einsum("ij,ij->i", points - body.vertices[nearest], body.vertex_normals[nearest])
    for a, b, radius in limbs:
        axis = np.subtract(b, a)
        t = np.clip((points - a) @ axis / (axis @ axis), 0.0, 1.0)
        limb = radius - np.linalg.norm(points - a - t[:, None] * axis, axis=1)
        inside = np.maximum(inside, limb) + np.maximum(web - np.abs(inside - limb), 0.0) ** 2 / (4.0 * web)
    return _surface(inside.reshape(grid.shape[:3]), first, cell)


def _surface(inside: np.ndarray, low: np.ndarray, cell: float) -> Mesh:
    image = vtkImageData(dimensions=inside.shape, origin=tuple(low), spacing=(cell,) * 3)
    image.GetPointData().SetScalars(numpy_to_vtk(inside.ravel(order="F"), deep=True))
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.0)
    contour.Update()
    skin = contour.GetOutput()
    faces = vtk_to_numpy(skin.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return Mesh(vtk_to_numpy(skin.GetPoints().GetData()), faces)
