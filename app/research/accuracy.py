"""Measure the accuracy on files with known values: detected landmarks and girths, and their errors."""

from __future__ import annotations

import time
import traceback
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from app.research.ground_truth import APEXES, LEVELLED, Truth
from core.errors import LandmarkError, UserError
from core.geometry.mesh import Floats, Points
from core.landmarks.as_dict import detection
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_trunk.detect import find_lower_landmarks
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.types import SIDES, Landmarks
from core.scan.body import Body, body_of
from core.scan.readers.registry import scan_bytes

UPRIGHT = 20.0
"""Up and front [degrees] that are nearer than this to the true ones count as right."""

OFF = 8.0
"""A landmark that is further off [mm] should carry a confidence below ``TRUSTED``."""

TRUSTED, DOUBTED = 0.5, 0.3
"""Landmarks from this confidence up are shown as sure, and below this one as unsure."""


@dataclass(frozen=True)
class Mark:
    """One landmark of a file: how far off it is [mm] and how sure it claims to be (0..1).

    ``off`` is the distance of a single point, of a bust point that from the segment between nipple and apex
    if both are known, and for fold and lowest point that in height: along the crease their place follows that
    of the bust point. Landmarks of the lower trunk are judged by their heights too.
    """

    name: str
    off: float
    confidence: float


@dataclass(frozen=True, eq=False)
class Case:
    """What came of one file.

    ``failed`` is why nothing was found, empty if something was; ``crashed`` that this was no sentence for a
    user. ``errors`` by what is judged, signed where a sign makes sense [mm, degrees, %]. ``found`` and
    ``true`` are points in the true canonical frame, (3,) [mm], to which ``to_mm``, (4, 4), takes the file.
    ``invented`` are bust points where no breast is, and how sure they claim to be.
    """

    truth: Truth
    failed: str = ""
    crashed: bool = False
    sure: bool = False
    turned: float = 0.0
    unit_right: bool = True
    sides_right: bool = True
    seconds: float = 0.0
    errors: Mapping[str, float] = field(default_factory=dict)
    marks: tuple[Mark, ...] = ()
    invented: Mapping[str, float] = field(default_factory=dict)
    found: Mapping[str, Points] = field(default_factory=dict)
    true: Mapping[str, Points] = field(default_factory=dict)
    to_mm: Floats = field(default_factory=lambda: np.eye(4))

    @property
    def right(self) -> bool:
        """Return whether the file was read in the right unit, upright, facing front."""
        return not self.failed and self.turned <= UPRIGHT and self.unit_right and self.sides_right

    @property
    def lacking(self) -> tuple[str, ...]:
        """Return known landmarks that were not detected though the body was."""
        names = () if self.failed else self.true
        return tuple(name for name in names if name not in self.found and name not in APEXES)


@dataclass(frozen=True)
class Spread:
    """Errors of one kind over all files: mean, 95 % and worst size, signed mean, and which is worst."""

    what: str
    count: int
    mean: float
    most: float
    worst: float
    bias: float
    where: str


def judged(folder: Path, truths: Sequence[Truth]) -> Iterator[Case]:
    """Find the landmarks of each file and hold them against what is known; a failure is a case as well."""
    for truth in truths:
        start = time.process_time()
        try:
            body = body_of(truth.file, scan_bytes(folder / truth.file))
            found = detection(body, *_landmarks(body, truth))
        except UserError as problem:
            yield Case(truth, str(problem), seconds=time.process_time() - start, to_mm=truth.to_mm)
        except Exception as problem:  # whatever goes wrong in one file, the others are judged
            place = traceback.extract_tb(problem.__traceback__)[-1]
            where = f"{Path(place.filename).name}:{place.lineno}"
            why = f"{type(problem).__name__} in {where}: {problem}"
            yield Case(truth, why, crashed=True, seconds=time.process_time() - start, to_mm=truth.to_mm)
        else:
            yield compared(truth, found, time.process_time() - start)


def _landmarks(body: Body, truth: Truth) -> tuple[Landmarks, LowerLandmarks | None]:
    """Return the landmarks of a body, those of the lower trunk if one of them is known and they are found."""
    bust = find_landmarks(body)
    if not truth.points.keys() & set(LEVELLED):
        return bust, None
    try:
        return bust, find_lower_landmarks(body, bust)
    except LandmarkError:
        return bust, None


def compared(truth: Truth, found: Mapping[str, Any], seconds: float = 0.0) -> Case:
    """Compare what ``detection`` found in a file with the known values."""
    ours = np.asarray(found["file_to_mm"], dtype=np.float64)
    to_mm = truth.to_mm
    if not truth.sized:
        to_mm = to_mm * np.append(np.full(3, _size(ours) / _size(to_mm)), 1.0)[:, None]
    if not truth.stands:
        to_mm = _sized_like(ours, to_mm)
    points = {name: _moved(to_mm, mark["file"]) for name, mark in found["landmarks"].items()}
    known = {name: _moved(to_mm, point) for name, point in truth.points.items()}
    confidence = {name: float(mark["confidence"]) for name, mark in found["landmarks"].items()}
    scale = _size(ours) / _size(to_mm)
    errors = {
        **_point_errors(points, known),
        **_level_errors(truth, found, points, to_mm @ np.linalg.inv(ours)),
    }
    turned = _turned(ours, to_mm) if truth.stands else 0.0
    if truth.stands:
        errors["turned [deg]"] = turned
    marks = tuple(Mark(name, _distance(name, errors), confidence[name]) for name in points if name in known)
    gone = [f"bust_point_{side}" for side in truth.gone]
    invented = {name: confidence[name] for name in gone if name in points}
    return Case(
        truth,
        sure=bool(found["sure"]),
        turned=turned,
        unit_right=bool(abs(scale - 1.0) < 0.01),
        sides_right=_sides_right(points, known),
        seconds=seconds,
        errors=errors,
        marks=marks,
        invented=invented,
        found=points,
        true=known,
        to_mm=to_mm,
    )


def spreads(cases: Sequence[Case]) -> list[Spread]:
    """Return the errors of all files that were read upright, kind by kind; left and right are one kind."""
    gathered: dict[str, list[tuple[float, str]]] = {}
    for case in cases:
        for what, error in case.errors.items() if case.right else ():
            kind = what.replace("_left", "").replace("_right", "").replace("_", " ")
            gathered.setdefault(kind, []).append((error, case.truth.name))
    table = []
    for what, rows in sorted(gathered.items(), key=lambda item: _rank(item[0])):
        errors = np.array([error for error, _ in rows])
        sizes = np.abs(errors)
        worst = int(np.argmax(sizes))
        mean, most, bias = float(sizes.mean()), float(np.percentile(sizes, 95)), float(errors.mean())
        table.append(Spread(what, len(rows), mean, most, float(sizes[worst]), bias, rows[worst][1]))
    return table


ORDER = ("turned", "bust point", "fold", "lowest", "bust level", "underbust level", "bust girth", "underbust")


def _rank(what: str) -> tuple[int, str]:
    return next((k for k, start in enumerate(ORDER) if what.startswith(start)), len(ORDER)), what


def _point_errors(points: Mapping[str, Points], known: Mapping[str, Points]) -> dict[str, float]:
    errors = {}
    for name, at in points.items():
        if name not in known:
            continue
        if name not in LEVELLED:
            errors[name] = float(np.linalg.norm(at - known[name]))
        if name.startswith(("fold", "lowest")) or name in LEVELLED:
            errors[f"{name} height"] = float(at[2] - known[name][2])
        apex = known.get(name.replace("bust_point", "bust_apex"))
        if name.startswith("bust_point") and apex is not None:
            errors[f"{name} to nipple-apex"] = _from_segment(at, known[name], apex)
    return errors


def _distance(name: str, errors: Mapping[str, float]) -> float:
    """Return how far off a landmark is [mm]: in height, from the segment to the apex, or else in space."""
    kinds = (f"{name} height", f"{name} to nipple-apex", name)
    return abs(next(errors[kind] for kind in kinds if kind in errors))


def _level_errors(
    truth: Truth, found: Mapping[str, Any], points: Mapping[str, Points], to_true: Floats
) -> dict[str, float]:
    """Return the errors of levels and girths; ``to_true`` takes our canonical frame to the true one."""
    errors: dict[str, float] = {}
    for ours, theirs, at in (("bust", "bust", "bust_point"), ("underbust", "underbust_stable", "lowest")):
        known, girth = truth.girths.get(theirs), found["girths"].get(ours)
        level = _true_height(found["levels"][ours], at, points, to_true)
        if ours in truth.girths and level is not None and truth.stands:
            errors[f"{ours} level"] = level - truth.girths[ours].level
        if known is None or girth is None:
            continue
        errors[f"{ours} girth"] = girth["tape_mm"] - known.tape
        errors[f"{ours} girth [%]"] = 100.0 * (girth["tape_mm"] / known.tape - 1.0)
        height = _true_height(girth["level_mm"], at, points, to_true)
        there = truth.girths[ours].at(height) if ours in truth.girths and height is not None else None
        if there is not None and truth.stands:
            errors[f"{ours} girth at its level"] = girth["tape_mm"] - there
    return errors


def _true_height(z: float, near: str, points: Mapping[str, Points], to_true: Floats) -> float | None:
    """Return how high our level ``z`` lies in the true frame, at the landmarks ``near``."""
    sides = [points[f"{near}_{side}"] for side in SIDES if f"{near}_{side}" in points]
    if not sides:
        return None
    middle = np.linalg.inv(to_true) @ np.append(np.mean(sides, axis=0), 1.0)
    return float((to_true @ np.array([middle[0], middle[1], z, 1.0]))[2])


def _moved(matrix: Floats, point: Any) -> Points:
    return np.asarray(matrix[:3, :3] @ np.asarray(point, dtype=np.float64) + matrix[:3, 3])


def _size(matrix: Floats) -> float:
    return float(np.cbrt(np.linalg.det(matrix[:3, :3])))


def _sized_like(ours: Floats, to_mm: Floats) -> Floats:
    """Return our turn with the true scale, for a truth that does not know how the body stands."""
    matrix = np.eye(4)
    matrix[:3, :3] = ours[:3, :3] * (_size(to_mm) / _size(ours))
    return matrix


def _turned(ours: Floats, true: Floats) -> float:
    """Return the larger of the angles between our up and front and the true ones [degrees]."""
    a, b = (m[:3, :3] / np.linalg.norm(m[:3, :3], axis=1, keepdims=True) for m in (ours, true))
    cosines = np.clip((a * b).sum(axis=1)[1:], -1.0, 1.0)
    return float(np.degrees(np.arccos(cosines)).max())


def _from_segment(at: Points, a: Points, b: Points) -> float:
    along = b - a
    t = np.clip((at - a) @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
    return float(np.linalg.norm(at - a - t * along))


def _sides_right(points: Mapping[str, Points], known: Mapping[str, Points]) -> bool:
    """Return whether no bust point of one side lies nearer to the true one of the other."""
    left, right = (known.get(f"bust_point_{side}") for side in SIDES)
    if left is None or right is None:
        return True
    pairs = ((points.get("bust_point_left"), left, right), (points.get("bust_point_right"), right, left))
    return all(
        at is None or float(np.linalg.norm(at - own)) <= float(np.linalg.norm(at - other))
        for at, own, other in pairs
    )
