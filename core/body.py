"""A body: the skin of a scan, cleaned, upright and in millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from core.calm import calmed
from core.errors import ScanError
from core.mesh import Mesh
from core.progress import Progress, quiet
from core.repair import repair
from core.scan_file import read_triangles, scan_bytes
from core.upright import Pose, find_pose


@dataclass(frozen=True, eq=False)
class Body:
    """The skin in the canonical frame [mm], wound outward; ``repairs`` holds one sentence a repair.

    ``rebuilt``: the file held points only, and the skin was laid through them.
    """

    mesh: Mesh
    pose: Pose
    repairs: tuple[str, ...]
    name: str
    rebuilt: bool = False

    @cached_property
    def calm(self) -> Mesh:
        """The skin without the noise of the scanner: what is measured [mm]."""
        return calmed(self.mesh)


def read_scan(
    path: str | Path,
    *,
    unit: str | None = None,
    up: str | None = None,
    front: str | None = None,
    progress: Progress = quiet,
) -> Body:
    """Read a scan from its file; see ``body_of``. Raises ScanError, Cancelled."""
    path = Path(path)
    return body_of(path.name, scan_bytes(path), unit=unit, up=up, front=front, progress=progress)


def body_of(
    name: str,
    data: bytes,
    *,
    unit: str | None = None,
    up: str | None = None,
    front: str | None = None,
    progress: Progress = quiet,
) -> Body:
    """Take the bytes of a scan, clean it and bring it upright, facing -y, in mm.

    ``name`` is that of the file and ``data`` what it holds; ``unit`` ("mm", "cm", "m", "inch"), ``up`` and
    ``front`` ("+x" .. "-z", axes of the file) overrule what the shape tells. Raises ScanError, Cancelled.
    """
    triangles = read_triangles(name, data, progress)
    progress("repairing", 0.4)
    vertices, faces, repairs = repair(*triangles)
    if len(faces) == 0:
        raise ScanError(f"{name} has no sound triangles.", "Export the scan again.")
    progress("finding up and front", 0.6)
    pose = find_pose(vertices, faces, unit=unit, up=up, front=front)
    progress("finding up and front", 1.0)
    turn = pose.file_to_mm[:3, :3]
    return Body(Mesh(vertices @ turn.T, faces), pose, repairs, Path(name).stem)
