"""Compute and format the movement of the bust points from the original body."""

from __future__ import annotations

from dataclasses import dataclass

from app.i18n.catalog import listed, tr
from app.i18n.lengths import length_number, length_unit
from app.presenters.measurements import length_uncertainty
from core.geometry.mesh import Floats
from core.measurements.uncertain_value import LIFT, OUT, OutputUncertainties
from core.mechanics.iteration import Observables
from core.pipeline.frame import Frame

APART = 1.0
"""Difference above which left and right are given separately [mm]."""


@dataclass(frozen=True)
class BustStep:
    """How far a bust point went up and forward [mm]; down and back where it is negative."""

    up: float
    forward: float


@dataclass(frozen=True)
class BustShift:
    """The moves of both bust points, against the body before."""

    left: BustStep
    right: BustStep

    @property
    def mean(self) -> BustStep:
        """Return the mean of both, which is shown and plotted."""
        return BustStep(0.5 * (self.left.up + self.right.up), 0.5 * (self.left.forward + self.right.forward))

    @property
    def differs(self) -> bool:
        """Return whether left and right are so far apart that the mean alone would hide it."""
        up, forward = self.left.up - self.right.up, self.left.forward - self.right.forward
        return max(abs(up), abs(forward)) > APART


def bust_shift(frame: Frame) -> BustShift:
    """Return how far the bust points of a frame are from where they are on the body before."""
    return shift_between(frame.stages.rest_marks, frame.marks)


def shift_between(rest: Observables, now: Observables) -> BustShift:
    """Return how far the bust points went between two states of a body."""
    return BustShift(
        BustStep(
            now.bust_point_left_z - rest.bust_point_left_z, now.bust_point_left_out - rest.bust_point_left_out
        ),
        BustStep(
            now.bust_point_right_z - rest.bust_point_right_z,
            now.bust_point_right_out - rest.bust_point_right_out,
        ),
    )


def mean_lifts(rest: Observables, left: Floats, right: Floats) -> Floats:
    """Return the mean move up of many turns, (n,) [mm], from the heights of both bust points, each (n,)."""
    return 0.5 * ((left - rest.bust_point_left_z) + (right - rest.bust_point_right_z))


Offs = tuple[float | None, float | None]
"""How far a move up and one forward may be off [mm], None where that is not known."""

UNKNOWN: Offs = (None, None)


def uncertainties_of(spread: OutputUncertainties | None, side: str = "") -> Offs:
    """Return how far the move of the bust point of a ``side`` may be off, or the mean of both."""
    if spread is None:
        return UNKNOWN
    up, out = (spread.plus_minus(" ".join(filter(None, (kind, side)))) for kind in (LIFT, OUT))
    return up, out


def step_text(step: BustStep, offs: Offs = UNKNOWN) -> str:
    """Return a move in words: "3.9 mm up, 2.1 mm forward", or "3.9 ± 0.4 mm up" where that is known."""
    return listed((up_text(step.up, offs[0]), forward_text(step.forward, offs[1])))


def up_text(up: float, off: float | None = None) -> str:
    """Return a move up or down in words [mm]."""
    return (tr("{length} down") if round(up, 1) < 0.0 else tr("{length} up")).format(length=_sized(up, off))


def forward_text(forward: float, off: float | None = None) -> str:
    """Return a move forward or back in words [mm]."""
    back = round(forward, 1) < 0.0
    return (tr("{length} back") if back else tr("{length} forward")).format(length=_sized(forward, off))


def _sized(move: float, off: float | None) -> str:
    # What belongs together is not parted at the end of a line.
    told = [length_number(abs(move)), *([] if off is None else [length_uncertainty(off)])]
    return " ".join(told).replace(" ", "\N{NO-BREAK SPACE}") + f" {length_unit()}"


def sides_text(move: BustShift) -> tuple[str, str]:
    """Return the moves of left and right in words: that part of them which differs more, up or forward."""
    left, right = move.left, move.right
    if abs(left.up - right.up) >= abs(left.forward - right.forward):
        return up_text(left.up), up_text(right.up)
    return forward_text(left.forward), forward_text(right.forward)


def bust_sentence(move: BustShift, offs: Offs = UNKNOWN) -> str:
    """Return a move in one line, with both sides where they differ; ``offs`` are those of the mean."""
    text = tr("Bust points: {shift}").format(shift=step_text(move.mean, offs))
    if not move.differs:
        return text
    left, right = sides_text(move)
    return tr("{shift} (left {left}, right {right})").format(shift=text, left=left, right=right)
