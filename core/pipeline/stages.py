"""The stages of a region, the results that a design leads to before any turn, and their reuse."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from core.control_mesh.back_length import Back
from core.control_mesh.fit import ControlMesh
from core.control_mesh.straps import Tail
from core.deformation.blend_region import BlendRegion
from core.deformation.incremental_normals import MovingFaces
from core.deformation.tffd import Binding
from core.document.design import Design
from core.geometry.mesh import Floats, Points
from core.landmarks.manual import PLACED, in_mm
from core.landmarks.types import Landmark, Landmarks
from core.mechanics.iteration import Watch
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium
from core.pipeline.line_routes import LineRoute
from core.progress import Progress
from core.scan.body import Body
from core.tissue.condensed import TissueResponse

SHARES = {
    "read scan": 0.46,
    "edit scan": 0.04,
    "find landmarks": 0.1,
    "fit control mesh": 0.1,
    "bind body": 0.1,
}
"""What part of the time of a build the slow stages take, roughly."""

PARTS = {
    "reading": (0.0, 0.15),
    "rebuilding the surface": (0.15, 0.3),
    "repairing": (0.3, 0.4),
    "finding up and front": (0.4, 0.45),
    "closing holes": (0.45, 0.46),
    "calming the skin": (0.46, 0.5),
    "find landmarks": (0.5, 0.6),
    "tissue": (0.72, 0.74),
}
"""Where each part of the first stages begins and ends, as shares of the time of a build, roughly."""

UNKNOWN = (0.0, 0.5)
"""The same for any other part of reading and editing a scan."""


GAIN_SHARE = 0.97
"""The default conventional gain in parts of the limit at rest: just calm, so that excess makes it vibrate."""

T = TypeVar("T")
Memo = Mapping[str, tuple[tuple[Any, ...], Any]]


@dataclass(frozen=True, eq=False)
class RegionStages(ABC):
    """What a design leads to in one region of the body.

    ``fitted`` is the control mesh whose points own lines are named by, which ``control`` may have halved.
    ``backs`` complete the lines of the template to whole bands, ``tails`` own lines to straps; ``routes`` are
    where all of them run at rest. ``tissue`` is what the solid under the skin answers, where the model has
    one. ``balance`` is the exact answer where the elastics of lines were fitted to it. ``gain_limit`` is the
    conventional gain at which it begins to vibrate at rest (probe units [1]). ``watch`` tells what is watched
    on the body.
    """

    design: Design
    body: Body
    control: ControlMesh
    fitted: ControlMesh
    patch: BlendRegion
    binding: Binding
    moving: MovingFaces
    backs: Mapping[str, Back]
    tails: Mapping[str, Tail]
    routes: Mapping[str, LineRoute]
    model: ConstrainedModel
    balance: Equilibrium | None
    gain_limit: float
    tissue: TissueResponse | None
    watch: Watch | None

    @property
    def gain(self) -> float:
        """Return the conventional gain in force [probe units]."""
        return GAIN_SHARE * self.gain_limit if self.design.gain is None else self.design.gain

    @abstractmethod
    def bust_height(self, control_points: Points) -> float:
        """Return how high the bust points are in the mean [mm], for control points of this region."""

    def shape(self, control_points: Points) -> tuple[Points, Points]:
        """Return places [mm] and normals [1] of ``moving.vertices``, each of shape (r, 3).

        ``control_points`` have shape (n, 3) [mm].
        """
        places = self.binding.places(control_points, self.moving.rest)
        return places, self.moving.normals(places)

    def body_change(self, control_points: Points) -> Floats:
        """Return the volumes that the body's left and right have gained since rest, shape (2,) [mm^3]."""
        return DenseVolumeChange(self.binding, self.moving)(control_points)


@dataclass(frozen=True, eq=False)
class DenseVolumeChange:
    """Tells what the body's left and right have gained [mm^3], (2,), when it follows the control points."""

    binding: Binding
    moving: MovingFaces

    def __call__(self, control_points: Points) -> Floats:
        """Return it for control points, shape (n, 3) [mm]."""
        places = self.binding.places(control_points, self.moving.rest)
        return self.moving.side_volume_changes(places)


class Built(Protocol):
    """What was built before: stages, or what there is of them."""

    @property
    def seconds(self) -> Mapping[str, float]:
        """Return what each stage took [s]."""

    @property
    def memo(self) -> Memo:
        """Return each stage's inputs and result."""


class StageCache:
    """Makes stages in order, taking each from the previous build if its inputs are the same."""

    def __init__(self, previous: Built | None, progress: Progress) -> None:
        self._old: Memo = previous.memo if previous else {}
        self._old_seconds: Mapping[str, float] = previous.seconds if previous else {}
        self._progress = progress
        self._done = 0.0
        self.memo: dict[str, tuple[tuple[Any, ...], Any]] = {}
        self.seconds: dict[str, float] = {}

    def __call__(self, name: str, make: Callable[..., T], *inputs: Any) -> T:
        """Return what ``make`` returns for its ``inputs``, made now or before."""
        begun, self._done = self._done, self._done + SHARES.get(name, 0.02)
        known = self._old.get(name)
        if known is not None and _same(known[0], inputs):
            self.memo[name], self.seconds[name] = known, self._old_seconds[name]
            return known[1]  # type: ignore[no-any-return]
        self._progress(name, begun)
        start = time.perf_counter()
        result = make(*inputs)
        self.seconds[name] = time.perf_counter() - start
        self.memo[name] = (inputs, result)
        return result

    def former(self, name: str) -> Any:
        """Return what a stage made in the previous build, or None."""
        return self._old[name][1] if name in self._old else None

    def landmarks(self, body: Body, design: Design) -> Mapping[str, Landmark]:
        """Return what was found before it went wrong; of landmarks those at least that were placed."""
        if "find landmarks" in self.memo:
            found: Landmarks = self.memo["find landmarks"][1]
            return found.points
        placed = in_mm(design.placed, body.pose.file_to_mm)
        return {name: Landmark(name, place, 1.0, PLACED, by_hand=True) for name, place in placed.items()}

    def inside(self, what: str, share: float) -> None:
        """Hear how far a part of one of the first stages is."""
        start, end = PARTS.get(what, UNKNOWN)
        self._progress(what, start + share * (end - start))


def _same(old: tuple[Any, ...], new: tuple[Any, ...]) -> bool:
    # Arrays are never changed in place: the same array is the same input, without a look at its figures.
    return all(a is b or (not isinstance(a, np.ndarray) and a == b) for a, b in zip(old, new, strict=True))
