"""Bust landmarks: bust points, inframammary folds, lowest points of the breasts, and two levels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Mesh, Points
from core.landmarks.anchor import find_anchor
from core.landmarks.body_scale import measure_build
from core.landmarks.breast_root import breast_root_landmarks
from core.landmarks.bust_point import bust_points, missing_sides
from core.landmarks.chest import find_poles
from core.landmarks.lower_breast import ABOVE, folds_and_lowest
from core.landmarks.manual import project_to_skin, reconcile_with_detected
from core.landmarks.plausibility import confidence_limit, hints, require_not_angular
from core.landmarks.torso.cross_sections import scan_torso
from core.landmarks.torso_landmarks import torso_landmarks
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.landmarks.validation import check, check_anchor, check_placed, placed_warnings
from core.messages import Length, Message
from core.progress import Progress, quiet
from core.scan.body import Body
from core.scan.edited_body import is_estimated
from core.scan.repair.inner_surfaces import BURIED

NEAR = 40.0
"""The points of the scan are counted so far round a place [mm]."""

FINE, COARSER = 9.0, 8.0
"""Points so far apart show a fold [mm]; each ``COARSER`` [mm] more divide the confidence by e."""


NOTHING: Mapping[str, Points] = MappingProxyType({})

FINDING = "find landmarks"
"""The name of this work."""

UNMEASURED = 0.55
"""Landmarks that were never held against a known answer claim this part of their confidence: below 0.5."""

ESTIMATED = 0.3
"""The most confidence [1] in a landmark on skin that fills a hole: no more than in one that a hole hides."""

FILLED = Message("Detected on skin that fills a hole (estimate).")


def spacing(mesh: Mesh, places: Sequence[Points]) -> float:
    """Return how far apart the vertices lie round ``places``, each (3,) [mm], their median [mm]."""
    counts = [int((((mesh.vertices - place) ** 2).sum(axis=1) < NEAR**2).sum()) for place in places]
    return float(np.median(NEAR * np.sqrt(np.pi / np.maximum(counts, 1))))


def confidence_factor(apart: float) -> float:
    """Return how much (0..1) of a confidence holds where the points of the scan lie ``apart`` [mm]. Ours."""
    return float(np.exp(-max(apart - FINE, 0.0) / COARSER))


def coarse_warning(apart: float) -> tuple[Message, ...]:
    """Return one sentence if the points of the scan lie too far ``apart`` [mm] for sure landmarks."""
    if apart <= FINE + 1.0:
        return ()
    return (
        Message(
            "The scan is coarse (point spacing about {apart}). Landmarks and girths are less accurate.",
            apart=Length(apart),
        ),
    )


def find_landmarks(
    body: Body, placed: Mapping[str, Points] = NOTHING, progress: Progress = quiet
) -> Landmarks:
    """Detect the bust landmarks of ``body``.

    ``placed`` points, by name, shape (3,) [mm], replace detected ones, and landmarks that depend on them
    follow. Raises LandmarkError if no bust is detected, unless bust points and folds are all placed, or if a
    position or name is invalid; Cancelled. Source: ours.
    """
    calm = body.smoothed
    by_hand = project_to_skin(calm, placed)
    around = all(f"{name}_{side}" in by_hand for name in ("bust_point", "fold") for side in SIDES)
    found, warnings = (_around(calm, by_hand), ()) if around else _detected(calm, by_hand, progress)
    progress(FINDING, 0.7)
    further = {
        mark.name: mark if mark.name.startswith("front_centre") else _less(mark, UNMEASURED)
        for mark in (*torso_landmarks(calm, found), *breast_root_landmarks(calm, found))
    }
    further = {name: reconcile_with_detected(by_hand.get(name), mark) for name, mark in further.items()}
    told = replace(found, points=MappingProxyType({**by_hand, **further, **found.points}))
    progress(FINDING, 0.9)
    build = measure_build(calm, told)
    if not around:
        require_not_angular(build, found)
    strange = hints(build, body.pose, told)
    most = confidence_limit(found.points, strange)
    bust = {name: _at_most(mark, most) for name, mark in found.points.items()}
    points = MappingProxyType(_on_filled(body, {**told.points, **bust}))
    warnings = (*[BURIED] * (BURIED in body.repairs), *(hint.sentence for hint in strange), *warnings)
    warnings = (*warnings, *placed_warnings(found), *coarse_warning(_spacing(calm, found.points)))
    return Landmarks(points, found.bust_level, found.underbust_level, warnings, strange)


def _detected(
    mesh: Mesh, by_hand: Mapping[str, Landmark], progress: Progress
) -> tuple[Landmarks, tuple[Message, ...]]:
    """Return the landmarks of the bust, with warnings, where not all of them are placed."""
    trunk = scan_torso(mesh)
    progress(FINDING, 0.3)
    anchor = find_anchor(trunk)
    check_anchor(anchor)
    poles = find_poles(trunk, anchor)
    progress(FINDING, 0.5)
    flat = missing_sides(poles, anchor.lone)
    missing = [side for side in flat if f"bust_point_{side}" not in by_hand]
    seen = bust_points(mesh, poles, trunk.middle, flat)
    busts = [reconcile_with_detected(by_hand.get(mark.name), mark) for mark in seen]
    progress(FINDING, 0.6)
    marks = busts + folds_and_lowest(mesh, busts, anchor.z, by_hand)
    found = _levels(mesh, marks, by_hand, missing)
    return found, check(mesh, trunk, anchor, poles, missing, found)


def _around(mesh: Mesh, by_hand: Mapping[str, Landmark]) -> Landmarks:
    """Return the landmarks round bust points and folds that are all placed, whatever the body looks like."""
    busts = [by_hand[f"bust_point_{side}"] for side in SIDES]
    level = min(by_hand[f"fold_{side}"].position[2] for side in SIDES) - ABOVE
    found = _levels(mesh, busts + folds_and_lowest(mesh, busts, level, by_hand), by_hand)
    check_placed(found)
    return found


def _levels(
    mesh: Mesh, marks: list[Landmark], by_hand: Mapping[str, Landmark], missing: Sequence[str] = ()
) -> Landmarks:
    """Return the landmarks with the levels of the sides that have a breast; others are unsure."""
    sure = confidence_factor(_spacing(mesh, {mark.name: mark for mark in marks}))
    found = {
        mark.name: reconcile_with_detected(
            by_hand.get(mark.name), _less(mark, sure * (0.3 if mark.name.endswith(tuple(missing)) else 1.0))
        )
        for mark in marks
    }
    sides = [side for side in SIDES if side not in missing] or SIDES
    bust = [found[f"bust_point_{side}"].position[2] for side in sides]
    under = [found[f"{name}_{side}"].position[2] for name in ("fold", "lowest") for side in sides]
    return Landmarks(MappingProxyType(found), float(sum(bust)) / len(bust), float(min(under)))


def _on_filled(body: Body, points: Mapping[str, Landmark]) -> dict[str, Landmark]:
    """Return landmarks with little confidence in those that were found on skin that fills a hole."""
    if len(body.estimated) == 0:
        return dict(points)
    inside = is_estimated(body, np.stack([mark.position for mark in points.values()]))
    return {
        name: replace(mark, confidence=min(mark.confidence, ESTIMATED), rule=FILLED)
        if on and not mark.by_hand
        else mark
        for (name, mark), on in zip(points.items(), inside, strict=True)
    }


def _less(mark: Landmark, share: float) -> Landmark:
    return mark if mark.by_hand else replace(mark, confidence=share * mark.confidence)


def _at_most(mark: Landmark, most: float) -> Landmark:
    return mark if mark.by_hand else replace(mark, confidence=min(most, mark.confidence))


def _spacing(mesh: Mesh, marks: Mapping[str, Landmark]) -> float:
    return spacing(
        mesh, [marks[f"{name}_{side}"].position for name in ("bust_point", "fold") for side in SIDES]
    )
