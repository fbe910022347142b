"""Describe the model options: titles, effects, and which are those of the paper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from app.i18n.catalog import number, tr
from core.document.design import Design
from core.mechanics.options import RANGES

SOFT_LINE = 0.2
"""Line stiffness that goes with forces one turn late: stiffer lines would not come to rest [1]."""


@dataclass(frozen=True)
class Choice:
    """A field ``key`` of the design that is one of a few values, each with its words."""

    key: str
    title: str
    tip: str
    options: tuple[tuple[Any, str], ...]

    def words(self, value: Any) -> str:
        """Return the words for a value; one that is none of the options reads as the last."""
        return next((words for each, words in self.options if each == value), self.options[-1][1])


@dataclass(frozen=True)
class Amount:
    """A field ``key`` of the design that is a number, shown ``scale`` times as large with its ``unit``.

    ``limits`` are the least and the largest number; without them any can be typed.
    """

    key: str
    title: str
    tip: str
    unit: str
    scale: float
    digits: int
    limits: tuple[float, float] = (-math.inf, math.inf)

    def words(self, value: float | None) -> str:
        """Return a value as it is written."""
        if value is None:
            return tr("automatic")
        return f"{number(self.scale * value, self.digits)} {self.unit}".strip()


Setting = Choice | Amount
Group = tuple[str, tuple[Setting, ...]]


def groups() -> tuple[Group, ...]:
    """Return all settings of the model, by what they are about."""
    return (
        (tr("Lines"), (_contact(), _hold(), _stiffness(), _height(), _force())),
        (tr("Body"), (_chest(), _law(), _prestress(), _weights(), _normals())),
        (tr("Volume"), (_control(), _volume_of(), _dense(), _gain())),
    )


def defaults() -> dict[str, Any]:
    """Return what every setting of the model is in a new design."""
    keys = {setting.key for _, settings in groups() for setting in settings}
    return {field.name: field.default for field in fields(Design) if field.name in keys}


def consequences(key: str, value: Any, present: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that change when a setting is chosen: forces one turn late need a soft line."""
    changes = {key: value}
    stiffness = float(present["line_stiffness"])
    if key == "line_force" and value == "explicit" and stiffness > SOFT_LINE:
        changes["line_stiffness"] = SOFT_LINE
    if key == "line_force" and value == "implicit" and stiffness == SOFT_LINE:
        changes["line_stiffness"] = defaults()["line_stiffness"]
    return changes


def summary(present: Mapping[str, Any]) -> str:
    """Return in a line what is chosen: how lines act always, else what is not as in a new design."""
    usual = defaults()
    said = [
        setting.words(present[setting.key])
        for _, settings in groups()
        for setting in settings
        if setting.key in ("line_contact", "line_hold")
        or (isinstance(setting, Choice) and present[setting.key] != usual[setting.key])
    ]
    return " · ".join(said)


def _contact() -> Choice:
    tip = tr(
        "Sticks: the whole pull of a line acts on the skin, as in the paper. Slides: only what presses on"
        " the skin acts, the garment carries the rest; this lifts the bust."
    )
    options = (("glued", tr("Sticks to the skin")), ("sliding", tr("Slides over it")))
    return Choice("line_contact", tr("Skin contact"), tip, options)


def _hold() -> Choice:
    tip = tr(
        "Springs back: a line gives way a little to the body, as in the paper. Held: it reaches the "
        "length that is set exactly, at whatever tension that takes."
    )
    options = (("spring", tr("Springs back")), ("held", tr("Held exactly")))
    return Choice("line_hold", tr("Length"), tip, options)


def _stiffness() -> Amount:
    low, high = RANGES["line_stiffness"]
    tip = tr("How stiff lines are against the body, from {low} to {high}; the paper gives no number.")
    return Amount(
        "line_stiffness", tr("Stiffness"), tip.format(low=low, high=number(high, 0)), "×", 1.0, 1, (low, high)
    )


def _height() -> Amount:
    tip = tr("Where the mid-bust line runs between fold (0 %) and bust point (100 %), from 25 to 75 %.")
    return Amount("line_height", tr("Height of the mid-bust line"), tip, "%", 100.0, 0, (0.25, 0.75))


def _force() -> Choice:
    tip = tr(
        "In step: a turn solves for cables and lines together. One turn late: to the letter of the paper;"
        " only very soft lines come to rest, so the stiffness changes with it."
    )
    options = (("implicit", tr("In step")), ("explicit", tr("One turn late")))
    return Choice("line_force", tr("Force of a line"), tip, options)


def _chest() -> Choice:
    tip = tr(
        "Free: only its neighbours hold a point, as in the paper. Firm: where there is little tissue over"
        " the ribs the skin stays near its place."
    )
    return Choice("firm_chest", tr("Chest"), tip, ((0.0, tr("Free")), (0.1, tr("Firm"))))


def _law() -> Choice:
    tip = tr(
        "How the cables of the control mesh answer: with the same force for every millimetre, as springs "
        "under tension, or so that shapes may turn. The paper leaves it open."
    )
    options = (
        ("force-density", tr("Force density")),
        ("prestressed", tr("Springs under tension")),
        ("co-rotated", tr("Turning shapes")),
    )
    return Choice("member_law", tr("Cables"), tip, options)


def _prestress() -> Amount:
    tip = tr(
        "How far springs under tension are stretched at rest, from 10 to 100 %; the paper gives no number."
    )
    return Amount("prestress", tr("Tension of the springs"), tip, "%", 100.0, 0, RANGES["prestress"])


def _weights() -> Choice:
    tip = tr(
        "How skin between control points follows them. Smooth: by the distance to each triangle. Paper: "
        "by the distance to its centre, as in the paper; it may crease."
    )
    options = (("smooth", tr("Smooth")), ("paper", tr("Paper")))
    return Choice("weights", tr("Skin between the points"), tip, options)


def _normals() -> Choice:
    tip = tr(
        "Skin that stands off the control mesh keeps its distance, as in the paper, or the distance grows"
        " and shrinks with the triangle below it."
    )
    options = ((False, tr("Keeps")), (True, tr("Grows along")))
    return Choice("scaled_normals", tr("Distance to the mesh"), tip, options)


def control_words(control: str) -> str:
    """Return the name of an edit that chooses a volume control."""
    return tr("Volume control: {control}").format(control=_control().words(control))


def _control() -> Choice:
    tip = tr(
        "What keeps the volume: the paper's two forces, conventional and adaptive (our formula), a plain "
        "one that adds half of every error, the exact answer, or nothing."
    )
    options = (
        ("adaptive", tr("Adaptive")),
        ("conventional", tr("Conventional")),
        ("accumulating", tr("Accumulating")),
        ("none", tr("None")),
        ("exact", tr("Exact")),
    )
    return Choice("volume", tr("Control"), tip, options)


def _volume_of() -> Choice:
    tip = tr(
        "What the exact answer holds: the volume of each breast for itself, or of both together; turns "
        "hold both together, as in the paper."
    )
    options = (("each", tr("Each breast")), ("both", tr("Both together")))
    return Choice("volume_of", tr("Holds"), tip, options)


def _dense() -> Choice:
    tip = tr(
        "Whose volume the exact answer holds: that of the control mesh, as in the paper, or that of the "
        "scanned body itself."
    )
    return Choice("dense_volume", tr("Measured on"), tip, ((False, tr("Control mesh")), (True, tr("Body"))))


def _gain() -> Amount:
    tip = tr(
        "How strongly the conventional force answers a volume error, from 0 to 10. Leave it empty for 97 "
        "% of the limit from which on it vibrates."
    )
    return Amount("gain", tr("Conventional gain"), tip, "", 1.0, 2, (0.0, 10.0))
