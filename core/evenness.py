"""How left and right differ, at rest and reshaped: bust points, volumes and skin of both breasts (ours)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import hypot

import numpy as np
from scipy.spatial import cKDTree

from core.advice.mirrored import MM3_PER_ML, Mirrored, SkinGap
from core.body import Body
from core.control_mesh import ControlMesh
from core.landmark import SIDES
from core.measures import calm_moves, subject_at_rest
from core.measuring.subject import Subject, shows_breast
from core.mesh import Points
from core.patch import Patch
from core.pipeline import Stages
from core.tffd import deform

NO_BREAST = "On one side no breast stands out: its bust point only mirrors the other one."
NO_VOLUME = "The root of a breast does not show on both sides, so their volumes are not known."


@dataclass(frozen=True)
class Volumes:
    """The volumes of both breasts [ml], each an estimate: where the top of its root is taken makes ± so much.

    That is not all: where landmarks lie is told by ``core.spread``.
    """

    left: float
    right: float
    left_plus_minus: float
    right_plus_minus: float

    @property
    def more(self) -> float:
        """By how much the left is larger [ml]."""
        return self.left - self.right

    @property
    def plus_minus(self) -> float:
        """How far the roots put that off [ml]: nothing says that both are taken wrong alike."""
        return hypot(self.left_plus_minus, self.right_plus_minus)


@dataclass(frozen=True)
class Evenness:
    """How left and right differ in one shape of a body.

    ``higher`` and ``further_out`` are how much higher and further to the front the left bust point is than
    the right one, ``further_aside`` how much further from the mirror [mm]; ``volumes`` those of the breasts,
    None where they are not known, and ``skin`` how one lies beside the other. ``gained`` is what the skin of
    the left has gained since rest more than that of the right [ml].
    """

    higher: float
    further_out: float
    further_aside: float
    gained: float
    volumes: Volumes | None
    skin: SkinGap | None

    @property
    def furthest(self) -> float:
        """The larger one of what the bust points differ by in height and to the front [mm]."""
        return max(abs(self.higher), abs(self.further_out))

    @property
    def apart(self) -> float:
        """How far one bust point is from the other, mirrored, in height and to the front together [mm]."""
        return hypot(self.higher, self.further_out)


@dataclass(frozen=True)
class BeforeAfter:
    """How left and right differ ``before``, at rest, and ``after``; ``notes`` say what is not known."""

    before: Evenness
    after: Evenness
    notes: tuple[str, ...]


def evenness(stages: Stages, control_points: Points) -> BeforeAfter:
    """Return how left and right differ at rest, and reshaped by ``control_points``, shape (n, 3) [mm].

    Raises ValueError unless there are as many control points as the control mesh has.
    """
    before, after = (_of(stages, points) for points in (stages.control.mesh.vertices, control_points))
    shown = all(shows_breast(stages.landmarks, side) for side in SIDES)
    notes = (*(() if shown else (NO_BREAST,)), *(() if before.volumes else (NO_VOLUME,)))
    return BeforeAfter(before, after, notes)


def _of(stages: Stages, control_points: Points) -> Evenness:
    mirrored = _mirrored(stages.body, stages.control, stages.patch)
    left, right = stages.watch.bust_points(control_points)
    aside = (left[0] - mirrored.middle) - (mirrored.middle - right[0])
    gains = stages.body_change(control_points) / MM3_PER_ML
    calm = stages.body.calm.vertices
    moves = deform(stages.binding, control_points) - stages.body.mesh.vertices
    return Evenness(
        float(left[2] - right[2]),
        float(right[1] - left[1]),
        float(aside),
        float(gains[0] - gains[1]),
        _volumes(subject_at_rest(stages.body.calm, stages.landmarks), *gains.tolist()),
        mirrored.gap(calm + calm_moves(stages.body, moves)),
    )


def _volumes(subject: Subject, *gains: float) -> Volumes | None:
    """Return the volumes of breasts [ml] whose skin has gained so much: both measured at rest."""
    if not all(side in subject.breasts and subject.fold_seen(side) for side in SIDES):
        return None
    left, right = (
        subject.breasts[side].volume / MM3_PER_ML + gain for side, gain in zip(SIDES, gains, strict=True)
    )
    return Volumes(left, right, *(subject.spreads[side] / MM3_PER_ML for side in SIDES))


@lru_cache(maxsize=2)  # while lines change, the body at rest and what of it moves are the same
def _mirrored(body: Body, control: ControlMesh, patch: Patch) -> Mirrored:
    """Return the breasts of a body: its skin nearest to control points that can move."""
    calm, fade = body.calm, patch.fade
    if len(calm.vertices) != len(fade):  # of a giant scan the calm skin is coarser
        fade = fade[cKDTree(body.mesh.vertices).query(calm.vertices)[1]]
    nearest = np.asarray(cKDTree(control.mesh.vertices).query(calm.vertices)[1])
    breasts = ~control.fixed[nearest] & (fade > 0.0)
    middle = float(control.mesh.vertices[control.border, 0].mean())
    return Mirrored(calm, fade == 0.0, breasts, middle)


@dataclass(frozen=True)
class EvenRow:
    """One figure ``before`` and ``after`` in ``unit``, None where it is not known.

    A ``sided`` one is positive where it is the left that is higher, further or larger, negative where it is
    the right; the roots of the breasts may put it off by ``plus_minus``.
    """

    key: str
    unit: str
    before: float | None
    after: float | None
    sided: bool = True
    plus_minus: float = 0.0


def even_rows(before: Evenness, after: Evenness) -> list[EvenRow]:
    """Return how left and right differ as a table, two shapes side by side."""
    first, last = _values(before), _values(after)
    roots = after.volumes.plus_minus if after.volumes else 0.0
    units = {key: "ml" if key in ("larger", "left_more", "right_more") else "mm" for key in first}
    return [
        EvenRow(
            key,
            units[key],
            first[key],
            last[key],
            sided=key not in ("mean", "left_more", "right_more"),
            plus_minus=roots if key == "larger" else 0.0,
        )
        for key in first
    ]


def _values(told: Evenness) -> dict[str, float | None]:
    skin, volumes = told.skin, told.volumes
    return {
        "higher": told.higher,
        "further_out": told.further_out,
        "further_aside": told.further_aside,
        "larger": volumes.more if volumes else None,
        "mean": skin.mean if skin else None,
        "largest": (skin.largest if skin.side == "left" else -skin.largest) if skin else None,
        "left_more": skin.left_more if skin else None,
        "right_more": skin.right_more if skin else None,
    }
