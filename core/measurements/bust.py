"""Measurements of the bust: distances, cups, volumes, and differences of left and right."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from core.errors import LineError
from core.geometry.geodesic import shortest_path
from core.geometry.mesh import Mesh, Points
from core.geometry.plane_sections import arc_length
from core.landmarks.types import SIDES, Landmark
from core.measurements.breast_volume import foremost
from core.measurements.definitions import Measure, missing
from core.measurements.girths import UNSURE_LEVEL
from core.measurements.subject import Subject, shows_breast
from core.messages import EMPTY, Message

NO_MARK = Message("The landmarks of this measurement are not in the scan.")
NO_BREAST = Message("No breast protrusion on this side.")
NO_FOLD = Message("The inframammary fold is not visible.")
UNSURE_FOLD = Message("The inframammary fold is uncertain: the volume is an estimate.")
NO_WAY = Message("No path over the skin connects the two points.")
NO_ROOT = Message("The ends of the breast root were not detected.")
OPEN_ROOT = Message("The skin around the breast root is incomplete in the scan.")
UNSEEN_CHEST = Message(
    "The chest wall behind the breast and the top of the breast root are not visible: estimate."
)
NO_CONTROL_MESH = Message("This value needs a control mesh: measure a project.")
HOLED = Message("The path crosses a hole in the scan: estimate.")


OF_A_CUP = ("bust_point_to_fold", "cup_depth", "cup_width", "root_length")
"""What is measured of one cup."""


def cup_measures(subject: Subject) -> Iterator[Measure]:
    """Yield what is measured between landmarks, of cups and of breasts."""
    yield _between_bust_points(subject)
    yield from _heights(subject)
    for side in SIDES:
        if shows_breast(subject.landmarks, side):
            yield _to_fold(subject, side)
            yield from _cup(subject, side)
        else:
            yield from (missing(f"{name}_{side}", NO_BREAST) for name in OF_A_CUP)
        yield _volume(subject, side)
    yield from _sides(subject)


def straight(key: str, marks: list[Landmark | None]) -> Measure:
    """Return the straight distance between two landmarks."""
    ends = [mark for mark in marks if mark]
    if len(ends) < 2:
        return Measure(key, None, "mm", confidence=0.0, note=NO_MARK)
    line = np.array([mark.position for mark in ends])
    return Measure(key, _length(line), "mm", (line,), min(mark.confidence for mark in ends))


def over_skin(key: str, subject: Subject, marks: list[Landmark | None]) -> Measure:
    """Return the length of the shortest way over the skin between two landmarks."""
    ends = [mark for mark in marks if mark]
    if len(ends) < 2:
        return Measure(key, None, "mm", confidence=0.0, note=NO_MARK)
    try:
        way = shortest_path(subject.mesh, ends[0].position, ends[1].position)
    except LineError:
        return Measure(key, None, "mm", confidence=0.0, note=NO_WAY)
    round_hole = _along_border(subject.mesh, way)
    sure = min(mark.confidence for mark in ends)
    return Measure(key, _length(way), "mm", (way,), sure, round_hole, note=HOLED if round_hole else EMPTY)


def _along_border(mesh: Mesh, way: Points) -> bool:
    """Return whether a way had to go round a hole: then it passes vertices of a border."""
    if not mesh.boundary_loops:
        return False
    border = mesh.vertices[np.concatenate(mesh.boundary_loops)]
    return bool((np.asarray(cKDTree(border).query(way[1:-1])[0]) < 1e-6).any())


def apexes(subject: Subject) -> Points | None:
    """Return the foremost place of each breast, shape (2, 3) [mm]; None without both."""
    if len(subject.breasts) < len(SIDES):
        return None
    places = subject.mesh.vertices
    return np.array([foremost(places[subject.breasts[side].vertices]) for side in SIDES])


def _length(curve: Points) -> float:
    return float(arc_length(curve)[-1])


def _busts(subject: Subject) -> list[Landmark | None]:
    return [subject.mark(f"bust_point_{side}") for side in SIDES]


def _between_bust_points(subject: Subject) -> Measure:
    return straight("bust_point_distance", _busts(subject))


def _heights(subject: Subject) -> Iterator[Measure]:
    """Yield how high and how far out the bust stands; shown by the lines that are measured."""
    landmarks = subject.landmarks
    marks = [mark for mark in _busts(subject) if mark]
    height = landmarks.bust_level - landmarks.underbust_level
    lines = tuple(
        np.array([mark.position, [*mark.position[:2], landmarks.underbust_level]]) for mark in marks
    )
    sure = min((mark.confidence for mark in marks), default=0.0)
    shown = [side for side in SIDES if shows_breast(landmarks, side)]
    yield _by_fold(Measure("bust_height", height, "mm", lines, sure), subject, shown)
    apex, chest = apexes(subject), subject.mark("front_centre_underbust")
    if apex is None or chest is None:
        yield missing("bust_protrusion", NO_ROOT if chest else NO_MARK)
        return
    lines = tuple(np.array([[tip[0], chest.position[1], tip[2]], tip]) for tip in apex)
    out = float(chest.position[1] - apex[:, 1].mean())
    yield Measure("bust_protrusion", out, "mm", lines, min(sure, chest.confidence))


def _to_fold(subject: Subject, side: str) -> Measure:
    bust, fold = (subject.mark(f"{name}_{side}") for name in ("bust_point", "fold"))
    measure = over_skin(f"bust_point_to_fold_{side}", subject, [bust, fold])
    if fold is None or measure.value is None or subject.fold_seen(side):
        return _by_fold(measure, subject, [side])
    return replace(measure, estimate=True, note=fold.rule)


def _cup(subject: Subject, side: str) -> Iterator[Measure]:
    """Yield depth and width of a cup and the length of its root."""
    bust, *ends = [subject.mark(f"{name}_{side}") for name in ("bust_point", "root_inner", "root_outer")]
    inner, outer = ends
    if bust is None or inner is None or outer is None:
        yield from (missing(f"cup_{what}_{side}", NO_ROOT) for what in ("depth", "width"))
    else:
        a, b, tip = inner.position, outer.position, bust.position
        way = (b - a)[:2]
        along = float((tip - a)[:2] @ way) / max(float(way @ way), 1e-9)
        foot = np.array([*(a[:2] + along * way), tip[2]])
        sure, line = min(mark.confidence for mark in (bust, inner, outer)), np.array([a, b])
        depth = np.array([foot, tip])
        yield Measure(f"cup_depth_{side}", _length(depth), "mm", (depth, line), sure)
        yield Measure(
            f"cup_width_{side}", _length(line), "mm", (line,), min(inner.confidence, outer.confidence)
        )
    root = subject.roots.get(side)
    if root is None or not subject.fold_seen(side):
        yield missing(f"root_length_{side}", NO_FOLD if root else NO_ROOT)
    else:
        length = _length(root.under)
        found = Measure(f"root_length_{side}", length, "mm", (root.under,), root.confidence)
        yield _by_fold(found, subject, [side])


def _by_fold(measure: Measure, subject: Subject, sides: Sequence[str]) -> Measure:
    """Return a measure that hangs on the folds of ``sides``: an estimate where one needs a second look."""
    if measure.value is None or measure.estimate or all(map(subject.fold_sure, sides)):
        return measure
    return replace(measure, estimate=True, note=UNSURE_LEVEL)


def _volume(subject: Subject, side: str) -> Measure:
    key, breast = f"breast_volume_{side}", subject.breasts.get(side)
    if not shows_breast(subject.landmarks, side):
        return missing(key, NO_BREAST)
    if side not in subject.roots or not subject.fold_seen(side):
        return missing(key, NO_FOLD if side in subject.roots else NO_ROOT)
    if breast is None:
        return missing(key, OPEN_ROOT)
    root = subject.roots[side]
    return Measure(
        key,
        subject.volume(side) / 1000.0,
        "ml",
        (root.closed,),
        root.confidence,
        True,
        subject.spreads[side] / 1000.0,
        HOLED if breast.holed else UNSEEN_CHEST if subject.fold_sure(side) else UNSURE_FOLD,
    )


def _sides(subject: Subject) -> Iterator[Measure]:
    """Yield by how much the left side exceeds the right one; the excess volume needs a control mesh."""
    left, right = _busts(subject)
    keys = "asymmetry_height", "asymmetry_forward", "asymmetry_volume"
    if left is None or right is None or not all(shows_breast(subject.landmarks, each) for each in SIDES):
        yield from (missing(key, NO_BREAST) for key in keys)
        return
    line, sure = np.array([left.position, right.position]), min(left.confidence, right.confidence)
    _, forward, up = (left.position - right.position) * (1.0, -1.0, 1.0)
    yield Measure(keys[0], float(up), "mm", (line,), sure)
    yield Measure(keys[1], float(forward), "mm", (line,), sure)
    yield missing(keys[2], NO_CONTROL_MESH)
