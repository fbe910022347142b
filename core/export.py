"""What leaves the program as geometry: the deformed body and the control mesh, whole file or no file."""

from __future__ import annotations

import os
from pathlib import Path

import trimesh

from core.errors import UserError
from core.mesh import Mesh
from core.project import whole_file

FORMATS = ("ply", "obj", "stl")


def write_mesh(path: str | os.PathLike[str], mesh: Mesh) -> None:
    """Write ``mesh`` [mm] as PLY, OBJ or STL by the name's ending.

    Raises UserError for another ending, or a place that cannot be written to.
    """
    target = Path(path).absolute()
    kind = target.suffix.lower().lstrip(".")
    if kind not in FORMATS:
        raise UserError(f"Busk does not write .{kind} files.", f"Choose one of: {', '.join(FORMATS)}.")
    data = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(file_type=kind)
    with whole_file(target) as partial:
        partial.write_bytes(data.encode() if isinstance(data, str) else data)
