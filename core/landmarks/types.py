"""Landmarks: named points of the body, each with its rule, its evidence and how sure it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from core.geometry.mesh import Points, frozen
from core.messages import Message

SIDES = ("left", "right")

CERTAIN = 0.5
"""The confidence [1] from which on a landmark, and what is measured there, needs no second look."""

POOR = 0.3
"""The confidence [1] below which a landmark is more likely wrong than right."""

PAIRS = ("bust_point", "fold", "lowest", "root_inner", "root_outer", "side", "armpit")
SINGLE = (
    *("front_centre", "front_centre_underbust", "back_centre", "back_centre_underbust"),
    *("waist_front", "hip_front", "neck_front", "neck_back"),
)

NAMES = (*(f"{pair}_{side}" for pair in PAIRS for side in SIDES), *SINGLE)
"""The names of all landmarks of the bust. One that the scan does not show is absent from what is found."""

LOWER_PAIRS = ("buttock", "gluteal_fold", "iliac_crest", "side_seam", "leg_opening")
LOWER_SINGLE = ("crotch", "waist", "belly", "hip")
LOWER_NAMES = (*LOWER_SINGLE, *(f"{pair}_{side}" for pair in LOWER_PAIRS for side in SIDES))
"""The names of all landmarks of the lower trunk.

Waist, belly and hip are points of the front centre line at their levels, the crotch lies between the legs.
"""

ALL_NAMES = (*NAMES, *LOWER_NAMES)


@dataclass(frozen=True, eq=False)
class Landmark:
    """A named point of the body, shape (3,) [mm], with how sure it is (0..1) and the rule that found it.

    ``evidence`` is the curve on the skin that it was read from, shape (k, 3) [mm], empty if there is none.
    ``by_hand`` tells that the designer placed it, and then ``off`` how far from where its rule finds it
    [mm]: 0 where that is no contradiction.
    """

    name: str
    position: Points
    confidence: float
    rule: Message
    evidence: Points = field(default_factory=lambda: np.empty((0, 3)))
    by_hand: bool = False
    off: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", frozen(self.position))
        object.__setattr__(self, "evidence", frozen(self.evidence))
        object.__setattr__(self, "confidence", float(np.clip(self.confidence, 0.0, 1.0)))


@dataclass(frozen=True)
class Hint:
    """What a body seems to be that no customer's should be: its ``kind``, and a sentence for the user.

    Kinds are "size", "clothes", "flat" and "lean"; ``up`` is the up direction "x,y,z" of the file that
    corrects a lean.
    """

    kind: str
    sentence: Message
    up: str = ""


@dataclass(frozen=True, eq=False)
class Landmarks:
    """The landmarks by name, and the heights of the bust and of the under-bust level [mm].

    ``points`` have names of ``NAMES``; _left is +x. ``warnings`` hold one sentence each, those of the
    ``hints`` among them.
    """

    points: Mapping[str, Landmark]
    bust_level: float
    underbust_level: float
    warnings: tuple[Message, ...] = ()
    hints: tuple[Hint, ...] = ()

    @property
    def size_doubted(self) -> bool:
        """Return whether the body seems to have another size than the scan gives it."""
        return any(hint.kind == "size" for hint in self.hints)

    @property
    def upright(self) -> str:
        """The up direction "x,y,z" of the file that sets a leaning body upright; empty for any other."""
        return next((hint.up for hint in self.hints if hint.up), "")

    def position(self, name: str) -> Points:
        """Return where landmark ``name`` is, shape (3,) [mm]."""
        return self.points[name].position
