"""Doubts: what should be looked at before a scan's pose and landmarks are trusted, in plain words."""

from __future__ import annotations

from core.body import Body
from core.finding.bust_point import ACROSS
from core.landmark import CERTAIN, SIDES, Landmarks

ESSENTIAL = ("bust_point", "fold")
"""The landmarks, a pair each, that the control mesh hangs on: doubts about others would only distract."""


def doubts(body: Body, landmarks: Landmarks) -> list[str]:
    """Return one sentence for each thing that should be looked at. Source: ours."""
    unsure = "It is not certain how this scan is to be understood: please check unit, up and front."
    return [unsure] * (not body.pose.sure) + landmark_doubts(landmarks)


def landmark_doubts(landmarks: Landmarks) -> list[str]:
    """Return what should be looked at on the landmarks alone; a side without a breast is named once."""
    told = [side for side in SIDES if landmarks.points[f"bust_point_{side}"].rule == ACROSS]
    weak = {kind: [side for side in weak_sides(landmarks, kind) if side not in told] for kind in ESSENTIAL}
    return [sentence for kind in ESSENTIAL for sentence in _doubt(kind, weak[kind])] + [*landmarks.warnings]


def weak_sides(landmarks: Landmarks, kind: str) -> list[str]:
    """Return the sides on which a landmark, like "fold", was found and is not certain."""
    found = {side: landmarks.points.get(f"{kind}_{side}") for side in SIDES}
    return [side for side, mark in found.items() if mark and not mark.by_hand and mark.confidence < CERTAIN]


def _doubt(kind: str, sides: list[str]) -> list[str]:
    if not sides:
        return []
    both = len(sides) == 2
    if kind == "fold":
        if both:
            return ["The folds under both breasts could not be seen clearly: please check them."]
        return [f"The fold under the {sides[0]} breast could not be seen clearly: please check it."]
    if both:
        return ["No nipple stands out clearly: the bust points follow the shape of the breasts."]
    return [f"No nipple stands out clearly on the {sides[0]} breast: please check its bust point."]
