"""A body: the skin of a scan, cleaned, upright and in millimetres."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from core.errors import ScanError
from core.geometry.mesh import Faces, Indices, Mesh, Points
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.orientation.pose import STANDING, Pose, estimate_pose
from core.scan.orientation.unit_detection import MILLIMETRES
from core.scan.readers.colors import is_plain, transfer_colors
from core.scan.readers.raw_scan import Colours, RawScan
from core.scan.readers.registry import no_memory, read_raw, scan_bytes
from core.scan.reconstruction.point_cloud import FEWEST_POINTS, is_cloud, reconstruct_surface
from core.scan.repair.denoise import denoise, estimate_noise
from core.scan.repair.editable_mesh import EditableMesh
from core.scan.repair.holes import Hole, fill_holes, find_holes
from core.scan.repair.repair import repair
from core.scan.source import UNEDITED, ScanEdits

TORSO = 600.0
"""About how high the scan of a torso is [mm]."""


@dataclass(frozen=True, eq=False)
class Body:
    """The skin in the canonical frame [mm], wound outward; ``repairs`` holds one sentence a repair.

    ``rebuilt``: the file held points only, and the skin was laid through them. ``edits`` are those of the
    scan that were applied, ``cut`` the heights of its crop [mm], ``estimated`` the vertices, shape (k,), that
    fill holes, ``uncropped_range`` the lowest and the highest level before a crop, if there was one [mm].
    ``colours`` are those of the scan at the vertices, shape (n, 4), None without any.
    """

    mesh: Mesh
    pose: Pose
    repairs: tuple[Message, ...]
    name: str
    rebuilt: bool = False
    edits: ScanEdits = UNEDITED
    cut: tuple[float, ...] = ()
    estimated: Indices = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    uncropped_range: tuple[float, float] | None = None
    colours: Colours | None = None

    @property
    def heights(self) -> tuple[float, float]:
        """Return the lowest and the highest level of the whole scan, before a crop [mm]."""
        if self.uncropped_range is not None:
            return self.uncropped_range
        z = self.mesh.vertices[:, 2]
        return float(z.min()), float(z.max())

    @cached_property
    def smoothed(self) -> Mesh:
        """Return the skin without the noise of the scanner: what is measured [mm]."""
        return denoise(self.mesh)

    def denoise(self, progress: Progress) -> None:
        """Compute ``smoothed`` now with progress: a large skin takes seconds. Raises Cancelled."""
        if "smoothed" not in vars(self):
            vars(self)["smoothed"] = denoise(self.mesh, progress)

    @cached_property
    def noise(self) -> float:
        """Return the noise of the scanner, its standard deviation along each axis [mm]."""
        return estimate_noise(self.mesh)

    @cached_property
    def holes(self) -> tuple[Hole, ...]:
        """The holes that stay open, longest first; where a neck, an arm or the hips were cut is none."""
        return tuple(hole for hole in find_holes(self.mesh) if not hole.opening and not self._is_cut(hole))

    def _is_cut(self, hole: Hole) -> bool:
        """Return whether most of a border is where the scan was cropped."""
        z = self.mesh.vertices[hole.border, 2]
        return any(float((np.abs(z - level) < 1e-6).mean()) > 0.5 for level in self.cut)


class ImplausibleScanError(ScanError):
    """It cannot be told how a scan stands; ``body`` is what it holds as it lies in its file, z up."""

    def __init__(self, problem: ScanError, body: Body) -> None:
        super().__init__(problem.message, problem.hint)
        self.body = body


def read_scan(
    path: str | Path,
    *,
    unit: str | None = None,
    up: str | None = None,
    front: str | None = None,
    progress: Progress = quiet,
) -> Body:
    """Read a scan file and return the repaired, upright body in mm.

    ``unit`` (``"cm"``), ``up`` and ``front`` (``"+y"``) override what the shape shows. Raises ScanError,
    Cancelled.
    """
    path = Path(path)
    return body_of(path.name, scan_bytes(path, progress), unit=unit, up=up, front=front, progress=progress)


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
    try:
        return _body_of(name, data, unit, up, front, progress)
    except MemoryError:
        raise no_memory(name) from None


def _body_of(
    name: str, data: bytes, unit: str | None, up: str | None, front: str | None, progress: Progress
) -> Body:
    scan = read_raw(name, data, progress)
    rebuilt = is_cloud(scan)
    notes = scan.notes
    shape = scan.vertices, scan.faces
    if rebuilt:
        notes = (
            Message("Reconstructed a surface from {count} points.", count=f"{len(scan.vertices):,}"),
            *notes,
        )
        shape = _surface(name, scan, progress)
    vertices, faces, repairs = repair(*shape, progress)
    if len(faces) == 0:
        raise ScanError(
            Message("{file} contains no valid triangles.", file=name), Message("Export the scan again.")
        )
    progress(STANDING, 0.0)
    try:
        pose = estimate_pose(vertices, faces, unit=unit, up=up, front=front, progress=progress)
    except ScanError as refusal:
        lies = raw_pose(vertices, unit)
        mesh = Mesh(vertices @ lies.file_to_mm[:3, :3].T, faces)
        raise ImplausibleScanError(
            refusal, Body(mesh, lies, (*notes, *repairs), scan_name(name), rebuilt)
        ) from refusal
    progress(STANDING, 1.0)
    turn = pose.file_to_mm[:3, :3]
    skin, cut = _off_the_stand(EditableMesh(vertices @ turn.T, faces), pose.stand)
    mesh, mendings = fill_holes(Mesh(skin.vertices, skin.faces), progress)
    colours = _colours(mesh, scan, pose)
    return Body(mesh, pose, (*notes, *repairs, *cut, *mendings), scan_name(name), rebuilt, colours=colours)


def _colours(mesh: Mesh, scan: RawScan, pose: Pose) -> Colours | None:
    """Return the colours of a scan on the skin that was made of it, None where they show nothing."""
    if scan.colours is None or is_plain(scan.colours):
        return None
    return transfer_colors(mesh.vertices, scan.vertices @ pose.file_to_mm[:3, :3].T, scan.colours)


def _off_the_stand(skin: EditableMesh, level: float) -> tuple[EditableMesh, tuple[Message, ...]]:
    """Cut away what lies under a level [mm], and say so."""
    body = skin.vertices[:, 2] > level
    if body.all():
        return skin, ()
    return skin.with_vertices(body).compact(), (Message("Removed the stand that supports the body."),)


def raw_pose(vertices: Points, unit: str | None) -> Pose:
    """Return the pose of what is only looked at: z up, in the unit told or that which makes it a torso."""
    height = max(float(np.ptp(vertices[:, 2])), 1e-9)
    likely = min(MILLIMETRES, key=lambda each: abs(np.log(height * MILLIMETRES[each] / TORSO)))
    unit = unit if unit in MILLIMETRES else likely
    scale = np.diag([*[MILLIMETRES[unit]] * 3, 1.0])
    return Pose(
        unit, "+z", "-y", scale, False, Message("Shown in the original orientation of the file."), 0.0
    )


def scan_name(name: str) -> str:
    """Return the name of a scan without what its file's name ends in."""
    path = Path(name)
    return (path.with_suffix("") if path.suffix.lower() == ".gz" else path).stem


def _surface(name: str, scan: RawScan, progress: Progress) -> tuple[Points, Faces]:
    if len(scan.vertices) < FEWEST_POINTS:
        raise ScanError(
            Message(
                "{file} has no valid triangles and too few points for a surface: {count}.",
                file=name,
                count=f"{len(scan.vertices):,}",
            ),
            Message("Scan with at least {few} points (30,000 recommended).", few=f"{FEWEST_POINTS:,}"),
        )
    try:
        return reconstruct_surface(scan.vertices, scan.normals, progress)
    except (ArithmeticError, ValueError, IndexError) as problem:
        raise ScanError(
            Message("A surface cannot be reconstructed from the points of {file}.", file=name),
            Message("Create a mesh from the points in the scanner software first."),
        ) from problem
