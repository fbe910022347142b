"""Warnings: what to check before pose and landmarks of a scan are trusted.

A new one goes into ``landmark_warnings``; those that detection itself adds are ``Landmarks.warnings``. Report
and command line print all of them; the window lists them at the Landmarks step and shows a notice if one is
``prominent``.
"""

from __future__ import annotations

from dataclasses import dataclass

from core.landmarks.bust_point import ACROSS, NIPPLE
from core.landmarks.types import CERTAIN, POOR, SIDES, Landmarks
from core.messages import Message, SideName
from core.scan.body import Body
from core.scan.edited_body import mirror_sentence

ESSENTIAL = ("bust_point", "fold")
"""The landmarks, a pair each, that the control mesh hangs on: warnings about others would only distract."""


@dataclass(frozen=True)
class LandmarkWarning:
    """A warning with the ``landmark`` to review, such as "fold_left".

    A ``prominent`` one is worth a notice, any other only a line in the list.
    """

    landmark: str
    message: Message
    prominent: bool = True


def collect_warnings(body: Body, landmarks: Landmarks) -> list[Message]:
    """Return one sentence for each thing that should be looked at. Source: ours."""
    told = [warning.message for warning in landmark_warnings(landmarks)]
    unsure = Message(
        "The unit and orientation of this scan are uncertain. Check the unit and the up and front axes."
    )
    return [unsure] * (not body.pose.is_certain) + edit_warnings(body) + told


def edit_warnings(body: Body) -> list[Message]:
    """Return what edits of the scan leave to be looked at."""
    filled = Message("Holes in the scan were filled manually: measurements there are estimates.")
    mirrored = [mirror_sentence(body.edits.kept)] if body.edits.kept else []
    return mirrored + [filled] * (len(body.estimated) > 0)


def landmark_warnings(landmarks: Landmarks) -> list[LandmarkWarning]:
    """Return what should be looked at on the landmarks alone; a side without a breast is named once."""
    points, found = landmarks.points, []
    for kind in ESSENTIAL:
        for sides, message in _uncertainty_messages(kind, _untold(landmarks, kind), landmarks):
            marks = [points[f"{kind}_{side}"] for side in sides]
            poor = any(mark.confidence < POOR for mark in marks)
            found.append(LandmarkWarning(marks[0].name, message, poor))
    names = (f"{kind}_{side}" for kind in ESSENTIAL for side in SIDES)
    weakest = min((name for name in names if name in points), key=lambda name: points[name].confidence)
    return [*found, *(LandmarkWarning(weakest, message) for message in landmarks.warnings)]


def _untold(landmarks: Landmarks, kind: str) -> list[str]:
    """Return the weak sides of a landmark, but for sides without a breast, of which a warning tells."""
    told = [side for side in SIDES if landmarks.points[f"bust_point_{side}"].rule == ACROSS]
    return [side for side in uncertain_sides(landmarks, kind) if side not in told]


def uncertain_sides(landmarks: Landmarks, kind: str) -> list[str]:
    """Return the sides on which a landmark, like "fold", was found and is not certain."""
    found = {side: landmarks.points.get(f"{kind}_{side}") for side in SIDES}
    return [side for side, mark in found.items() if mark and not mark.by_hand and mark.confidence < CERTAIN]


def _uncertainty_messages(
    kind: str, sides: list[str], landmarks: Landmarks
) -> list[tuple[list[str], Message]]:
    """Return the sentences about a landmark that is weak on some ``sides``, with the sides of each."""
    if not sides:
        return []
    if kind == "fold":
        one = Message(
            "The inframammary fold of the {side} breast is not clearly visible. Please check.",
            side=SideName(sides[0]),
        )
        two = Message("The inframammary folds of both breasts are not clearly visible. Please check.")
        return [(sides, two if len(sides) == 2 else one)]
    shown = [side for side in sides if landmarks.points[f"bust_point_{side}"].rule == NIPPLE]
    if shown:
        one = Message(
            "The nipple of the {side} breast is not clearly visible. Check its bust point.",
            side=SideName(shown[0]),
        )
        two = Message("The nipples are not clearly visible. Check both bust points.")
        rest = _uncertainty_messages(kind, [side for side in sides if side not in shown], landmarks)
        return [(shown, two if len(shown) == 2 else one), *rest]
    one = Message(
        "No nipple clearly detected on the {side} breast. Check its bust point.",
        side=SideName(sides[0]),
    )
    two = Message("No nipples clearly detected: the bust points are estimated from the shape of the breasts.")
    return [(sides, two if len(sides) == 2 else one)]
