"""Differences of left and right, original and reshaped: bust points, breasts, seat (ours)."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

from core.deformation.tffd import deform
from core.geometry.mesh import Points
from core.landmarks.types import SIDES
from core.measurements.lower_trunk import LowerSubject, lower_subjects
from core.measurements.mirrored_surface import SkinGap, mirrored_breasts
from core.measurements.subject import shows_breast
from core.measurements.tracked_points import smoothed_moves
from core.messages import Message
from core.pipeline.build import Stages

NO_BREAST = Message("One side has no breast protrusion: its bust point is mirrored from the other side.")


@dataclass(frozen=True)
class SeatDifference:
    """How left and right of the seat differ, positive where it is the left that is more.

    The buttock point ``higher`` and ``further_back``, the gluteal fold ``fold_higher`` [mm].
    """

    higher: float
    further_back: float
    fold_higher: float


@dataclass(frozen=True)
class SideDifference:
    """How left and right differ in one shape of a body.

    ``higher`` and ``further_out`` are how much higher and further to the front the left bust point is than
    the right one, ``further_lateral`` how much further from the mirror [mm]; ``skin`` is how that of one
    breast lies beside the other one's, None where it cannot be told. ``seat`` is that of the lower trunk,
    where the design has it.
    """

    higher: float
    further_out: float
    further_lateral: float
    skin: SkinGap | None
    seat: SeatDifference | None = None

    @property
    def largest_difference(self) -> float:
        """Return the larger one of what the bust points differ by in height and to the front [mm]."""
        return max(abs(self.higher), abs(self.further_out))


@dataclass(frozen=True)
class BeforeAfter:
    """How left and right differ ``before``, at rest, and ``after``; ``notes`` say what is not known."""

    before: SideDifference
    after: SideDifference
    notes: tuple[Message, ...]


def compare_sides(stages: Stages, *region_points: Points) -> BeforeAfter:
    """Return how left and right differ at rest, and reshaped by the control points of the regions.

    ``region_points`` are those of each, the bust's first, shape (n, 3) [mm]; regions left out keep their
    shape. Raises ValueError unless there are as many control points as a control mesh has.
    """
    before, after = (_of(stages, points) for points in (stages.control.mesh.vertices, region_points[0]))
    if stages.lower is not None:
        points = region_points[1] if len(region_points) > 1 else stages.lower.control.mesh.vertices
        seats = map(_seat, lower_subjects(stages.lower, points))
        before, after = (replace(each, seat=seat) for each, seat in zip((before, after), seats, strict=True))
    shown = all(shows_breast(stages.landmarks, side) for side in SIDES)
    return BeforeAfter(before, after, () if shown else (NO_BREAST,))


def _of(stages: Stages, control_points: Points) -> SideDifference:
    mirrored = mirrored_breasts(stages.body, stages.control, stages.patch)
    left, right = stages.watch.bust_points(control_points)
    aside = (left[0] - mirrored.middle) - (mirrored.middle - right[0])
    calm = stages.body.smoothed.vertices
    moves = deform(stages.binding, control_points) - stages.body.mesh.vertices
    return SideDifference(
        float(left[2] - right[2]),
        float(right[1] - left[1]),
        float(aside),
        mirrored.gap(calm + smoothed_moves(stages.body, moves)),
    )


def _seat(subject: LowerSubject) -> SeatDifference:
    left, right = (subject.places[f"buttock_{side}"] for side in SIDES)
    folds = [subject.places[f"gluteal_fold_{side}"][2] for side in SIDES]
    return SeatDifference(
        float(left[2] - right[2]),
        float(left[1] - right[1]),
        float(folds[0] - folds[1]),
    )


@dataclass(frozen=True)
class SymmetryRow:
    """One figure ``before`` and ``after`` in ``unit``, None where it is not known.

    A ``sided`` one is positive where it is the left that is higher or further, negative where the right is.
    """

    key: str
    unit: str
    before: float | None
    after: float | None
    sided: bool = True


_VOLUMES = ("in_all", "left_more", "right_more")


def symmetry_rows(before: SideDifference, after: SideDifference) -> list[SymmetryRow]:
    """Return how left and right differ as a table, two shapes side by side."""
    first, last = _values(before), _values(after)
    units = {key: "ml" if key in _VOLUMES else "mm" for key in first}
    sided = {key: key not in ("mean", "left_more", "right_more") for key in first}
    return [SymmetryRow(key, units[key], first[key], last[key], sided[key]) for key in first]


def _values(told: SideDifference) -> dict[str, float | None]:
    skin, seat = told.skin, told.seat
    below = {} if seat is None else {f"seat_{name}": value for name, value in asdict(seat).items()}
    return {
        "higher": told.higher,
        "further_out": told.further_out,
        "further_aside": told.further_lateral,
        "in_all": skin.total if skin else None,
        "mean": skin.mean if skin else None,
        "largest": (skin.largest if skin.side == "left" else -skin.largest) if skin else None,
        "left_more": skin.left_more if skin else None,
        "right_more": skin.right_more if skin else None,
        **below,
    }
