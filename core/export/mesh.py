"""Geometry export: the reshaped body and the control mesh, a complete file or none."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from core.control_mesh.fit import ControlMesh
from core.errors import UserError
from core.export.units_and_axes import GLTF, FileSpace, space_of
from core.files.atomic_write import atomic_path
from core.geometry.mesh import Mesh, Points
from core.geometry.planar_curves import Curve, Plane
from core.messages import Message
from core.progress import Progress, quiet

FORMATS = ("ply", "obj", "stl", *GLTF)

_CLAY = (216, 175, 149, 255)  # what #EDD8C9 is as glTF counts light, from black 0 to 255


def write_mesh(
    path: str | os.PathLike[str], mesh: Mesh, progress: Progress = quiet, space: FileSpace | None = None
) -> None:
    """Write ``mesh`` [mm] as PLY, OBJ, STL or GLB by the suffix, in a ``space`` or the default of the format.

    Raises UserError for another suffix or a path that cannot be written; Cancelled leaves no file.
    """
    target = Path(path)
    kind = kind_of(target)
    space = space or space_of(kind)
    import trimesh  # noqa: PLC0415 (it takes long to load, and is needed here alone)

    progress("writing", 0.2)
    shape = trimesh.Trimesh(space.places(mesh.vertices), mesh.faces, process=False)
    options = {}
    if kind in GLTF:  # those who show it find it smooth, and not of metal as where nothing is said
        shape.vertex_normals = space.normals(mesh.vertex_normals)
        matt = trimesh.visual.material.PBRMaterial(
            baseColorFactor=_CLAY, metallicFactor=0.0, roughnessFactor=0.9, doubleSided=True
        )
        shape.visual = trimesh.visual.TextureVisuals(material=matt)
        options = {"include_normals": True}
    data = shape.export(file_type=kind, **options)
    progress("writing", 0.8)
    with atomic_path(target) as partial:
        partial.write_bytes(data.encode() if isinstance(data, str) else data)
        progress("writing", 1.0)


def kind_of(path: str | os.PathLike[str]) -> str:
    """Return the kind of mesh file that a name ends in. Raises UserError if Busk does not write it."""
    kind = Path(path).suffix.lower().lstrip(".")
    if kind not in FORMATS:
        raise UserError(
            Message(".{kind} files are not supported for export.", kind=kind),
            Message("Choose one of: {choices}.", choices=", ".join(FORMATS)),
        )
    return kind


def write_control_points(
    path: str | os.PathLike[str], control: ControlMesh, points: Points | None = None
) -> None:
    """Write control points [mm] as CSV, with the number, row and column that name them in lines.

    They are those at rest, or ``points``, shape (n, 3). Raises UserError if the place cannot be written to.
    """
    target, places = Path(path), control.mesh.vertices if points is None else points
    with atomic_path(target) as partial, open(partial, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["number", "row", "column", "x_mm", "y_mm", "z_mm", "free"])
        for number, (place, fixed) in enumerate(zip(places, control.fixed, strict=True)):
            figures = (f"{value:.3f}" for value in place)
            at = control.row[number], control.column[number]
            writer.writerow([number, *at, *figures, "no" if fixed else "yes"])


def write_profile(path: str | os.PathLike[str], plane: Plane, bodies: Mapping[str, Sequence[Curve]]) -> None:
    """Write the curves in which a plane cuts ``bodies``, named before, after .., as CSV [mm].

    Raises UserError if the place cannot be written to.
    """
    target = Path(path)
    with atomic_path(target) as partial, open(partial, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["body", "curve", "x_mm", "y_mm", "z_mm"])
        for body, curves in bodies.items():
            for number, curve in enumerate(curves, start=1):
                for place in plane.in_space(curve.places):
                    writer.writerow([body, number, *(f"{value:.3f}" for value in place)])
