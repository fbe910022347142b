"""Format a scan: facts, edits, open holes, and the steps of its processing."""

from __future__ import annotations

from dataclasses import dataclass

from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.messages import render
from core.document.design import ScanSource
from core.geometry.mesh import Points
from core.landmarks.types import Landmarks
from core.landmarks.warnings import edit_warnings
from core.scan.body import Body
from core.scan.orientation.lean_angles import lean_angles
from core.scan.readers.registry import FORMATS
from core.scan.repair.holes import NAMED, hole_sentence, hole_sentences
from core.scan.source import ScanEdits

PACKED = ".gz"
"""Any scan may be packed."""

KINDS = ", ".join(kind.upper() for kind in FORMATS if f".{kind}" != PACKED)
"""The formats in a row: PLY, OBJ and so on."""

PATTERNS = " ".join(f"*.{kind}" for kind in FORMATS)
"""What their names look like."""


def scan_view(
    source: ScanSource, body: Body, upright: bool = True, landmarks: Landmarks | None = None
) -> ScanView:
    """Return the facts of the scan; one that is not ``upright`` cannot be edited."""
    pose = body.pose
    return ScanView(
        source.name,
        pose.unit,
        render(pose.reason),
        pose.is_certain,
        pose.up,
        pose.front,
        len(body.mesh.faces),
        tuple(map(render, body.repairs)),
        _notes(body),
        frozenset(key for key in ("unit", "up", "front") if getattr(source, key) is not None),
        _edits_view(source, body) if upright else None,
        body.colours is not None,
        LeanView(*lean_angles(pose), landmarks.upright if landmarks else "") if upright else None,
    )


def _edits_view(source: ScanSource, body: Body) -> EditsView:
    """Return the edits of a scan, with those of its open holes that are listed."""
    rows, (low, high) = body.holes[:NAMED], body.heights
    holes = [HoleView(render(hole_sentence(body.mesh, hole)), _place(hole.centre)) for hole in rows]
    more = [render(each) for each in hole_sentences(body.mesh, body.holes)[NAMED:]]
    return EditsView(source.edits, high - low, tuple(holes), "".join(more))


def _place(centre: Points) -> tuple[float, float, float]:
    x, y, z = centre.round(1).tolist()
    return x, y, z


def _notes(body: Body) -> tuple[str, ...]:
    """Return what else is to be known of a body: its edits, and on what copy of its skin it is measured."""
    return (*map(render, edit_warnings(body)), *_copy_notes(body))


def _copy_notes(body: Body) -> tuple[str, ...]:
    if body.smoothed is body.mesh:
        return ()
    if len(body.smoothed.faces) != len(body.mesh.faces):
        return (tr("Measured on a simplified copy: the scan has very many triangles."),)
    return (tr("Measured on a smoothed copy: the scan noise is {noise}.").format(noise=length(body.noise)),)


def work_text(what: str) -> str:
    """Return the name of a step of the work; empty for one that takes no time."""
    words = {
        "read scan": tr("Reading scan"),
        "reading": tr("Reading scan"),
        "repairing": tr("Repairing scan"),
        "closing holes": tr("Repairing scan"),
        "rebuilding the surface": tr("Reconstructing surface"),
        "finding up and front": tr("Detecting orientation"),
        "calming the skin": tr("Detecting landmarks"),
        "find landmarks": tr("Detecting landmarks"),
        "fit control mesh": tr("Fitting control mesh"),
        "condense tissue": tr("Computing tissue"),
        "tissue": tr("Computing tissue"),
        "find patch": tr("Binding body to control mesh"),
        "bind body": tr("Binding body to control mesh"),
        "preparing the view": tr("Preparing view"),
    }
    return words.get(what, "")


def work_steps() -> list[str]:
    """Return the names of the steps in which a scan is opened, in order."""
    names = (
        "reading",
        "repairing",
        "finding up and front",
        "find landmarks",
        "fit control mesh",
        "bind body",
        "preparing the view",
    )
    return [work_text(name) for name in names]


@dataclass(frozen=True)
class HoleView:
    """An open hole: its sentence and its centre (x, y, z) [mm]."""

    text: str
    centre: tuple[float, float, float]


@dataclass(frozen=True)
class EditsView:
    """The edits of a scan that is ``height`` high [mm], and its open holes, the largest first."""

    edits: ScanEdits
    height: float
    holes: tuple[HoleView, ...] = ()
    more: str = ""


@dataclass(frozen=True)
class ScanView:
    """What is shown of a scan: ``reason`` why this ``unit``; ``up`` and ``front`` are axes of the file.

    ``notes`` are further sentences on it; ``told`` names what was not found but told: unit, up, front.
    ``edits`` and ``lean`` are None for a scan that cannot be edited, as it is not upright.
    """

    file: str
    unit: str
    reason: str
    sure: bool
    up: str
    front: str
    triangles: int
    repairs: tuple[str, ...]
    notes: tuple[str, ...] = ()
    told: frozenset[str] = frozenset()
    edits: EditsView | None = None
    coloured: bool = False
    lean: LeanView | None = None


@dataclass(frozen=True)
class LeanView:
    """The lean of a body in its file that is corrected, ``forward`` and to its ``left`` [degrees].

    ``upright`` is the up direction "x,y,z" that sets a leaning body upright; empty if it does not lean.
    """

    forward: float
    left: float
    upright: str = ""
