"""Quantities of the body that can be targets, with their slopes by the control points (ours)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from scipy import sparse

from core.deformation.changes import Changes
from core.deformation.tffd import Binding
from core.errors import UserError
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.messages import Length, Message
from core.pipeline.build import Stages
from core.pipeline.observables import Tapes

SIDES = {"": np.array([0.5, 0.5]), " left": np.array([1.0, 0.0]), " right": np.array([0.0, 1.0])}
"""What the left and the right count for [1], by the end of a figure's name."""


PRIORITIES = {"high": 4.0, "normal": 1.0, "low": 0.25}
"""By how much the tolerance of a target is divided where not all of them can be met [1]."""


@dataclass(frozen=True)
class Goal:
    """A target: a quantity by its ``name`` in ``readings``, its ``value`` [mm], and one of PRIORITIES."""

    name: str
    value: float
    priority: str = "normal"


@dataclass(frozen=True, eq=False)
class Reading:
    """A figure [mm] and its slopes by the control points, shape (n, 3) [1]."""

    value: float
    slopes: Points


Read = Callable[[Points], Reading]
"""Reads a figure off control points, shape (n, 3) [mm]."""

ReadMany = Callable[[Points], tuple[Floats, Floats]]
"""Reads m figures off control points at once: values (m,) [mm] and slopes (m, n, 3) [1]."""


@dataclass(frozen=True)
class QuantityFamily:
    """Figures that are read alike: their ``names``, and what makes a ``read`` for one of them.

    Names that begin with the word ``numbered`` go on with numbers, which ``read`` looks at itself. Targets
    that conflict are balanced by how many times their ``tolerance`` [mm] they are missed.
    """

    names: tuple[str, ...]
    read: Callable[[Stages, str], Read]
    numbered: str = ""
    tolerance: float = 1.0

    def has(self, name: str) -> bool:
        """Return whether a quantity of that name belongs to this family."""
        return name in self.names or (bool(self.numbered) and name.startswith(f"{self.numbered} "))


LIFT, OUT = "lift", "out"
_AXES = {LIFT: np.array([0.0, 0.0, 1.0]), OUT: np.array([0.0, -1.0, 0.0])}
_APEX_AXES = {"apex lift": np.array([0.0, 1.0]), "apex out": np.array([-1.0, 0.0])}  # by y and z
HIGHER, FURTHER_OUT = "left higher", "left further out"
_LEFT_LESS_RIGHT = {HIGHER: _AXES[LIFT], FURTHER_OUT: _AXES[OUT]}


class _Weighted:
    """The sum of two places, one of each side, times ``weights`` (2, 2 or 3), with its ``slopes``.

    It is counted from its value at ``rest`` control points, shape (n, 3) [mm], where these are given.
    """

    def __init__(
        self,
        places: Callable[[Points], Points],
        slopes: Callable[[Points, Floats], Points],
        weights: Floats,
        rest: Points | None = None,
    ) -> None:
        self._places, self._slopes, self._weights = places, slopes, weights
        self._rest = 0.0 if rest is None else self._sum(rest)

    def _sum(self, control_points: Points) -> float:
        return float(np.sum(self._weights * self._places(control_points)))

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        return Reading(self._sum(control_points) - self._rest, self._slopes(control_points, self._weights))


def _read_bust(stages: Stages, name: str) -> Read:
    what, watch = name.split(maxsplit=1)[0], stages.watch
    weights = SIDES[name.removeprefix(what)][:, None] * _AXES[what]
    return _Weighted(watch.bust_points, watch.bust_point_slopes, weights, stages.control.mesh.vertices)


def _read_apex(stages: Stages, name: str) -> Read:
    what, watch = next(each for each in _APEX_AXES if name.startswith(each)), stages.watch
    weights = SIDES[name.removeprefix(what)][:, None] * _APEX_AXES[what]
    return _Weighted(watch.apexes, watch.apex_slopes, weights, stages.control.mesh.vertices)


def _read_balance(stages: Stages, name: str) -> Read:
    weights = np.array([[1.0], [-1.0]]) * _LEFT_LESS_RIGHT[name]
    return _Weighted(stages.watch.bust_points, stages.watch.bust_point_slopes, weights)


BUST = QuantityFamily(tuple(f"{what}{side}" for what in _AXES for side in SIDES), _read_bust)
"""How far bust points rise and come out, the mean of both or one [mm]."""

APEX = QuantityFamily(tuple(f"{what}{side}" for what in _APEX_AXES for side in SIDES), _read_apex)
"""How far the foremost places, whatever skin that is, rise and come out, the mean of both or one [mm]."""

EVEN = QuantityFamily(tuple(_LEFT_LESS_RIGHT), _read_balance)
"""How much higher and further out the left bust point is than the right, as they are now [mm]."""

TAPE_STEP = 5.0
"""Heights at which a tape is laid, to be read between them [mm]."""


class _Girth:
    """A tape laid level round the body at the mean height of the bust points, which it follows.

    It is laid at heights that are ``TAPE_STEP`` apart and read between the two next to the bust points.
    """

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._rise = _read_bust(stages, LIFT)
        marks = stages.rest_marks
        self._rest_height = (marks.bust_point_left_z + marks.bust_point_right_z) / 2.0
        self._levels: dict[float, Tapes] = {}

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        binding, moving = self._stages.binding, self._stages.moving
        places = binding.places(control_points, moving.rest)
        rise = self._rise(control_points)
        low, part = divmod((self._rest_height + rise.value) / TAPE_STEP, 1.0)
        tapes = [self._tape(TAPE_STEP * level) for level in (low, low + 1.0)]
        (below,), (above,) = (tape(places) for tape in tapes)
        (by_below,), (by_above,) = (tape.slopes(places) for tape in tapes)
        by_places = (1.0 - part) * by_below + part * by_above
        slopes = binding.gradient(control_points, by_places[: moving.count])
        steep = float(above - below) / TAPE_STEP
        return Reading(float((1.0 - part) * below + part * above), slopes + steep * rise.slopes)

    def _tape(self, height: float) -> Tapes:
        if height not in self._levels:
            self._levels[height] = Tapes(self._stages.moving, [height])
        return self._levels[height]


GIRTH = "girth"
_TOLERANCE = 5.0  # a girth grows by 2 pi times what its outline moves by [mm]
GIRTHS = QuantityFamily((GIRTH,), lambda stages, _: _Girth(stages), tolerance=_TOLERANCE)
"""The girth at the level of the bust points, as they are then [mm]."""


PROFILE = "profile"
"""``profile left 1150`` is the foremost place of the skin 1150 mm above the origin, on the upright section
from front to back through the left bust point at rest; ``profile 85.5 1150`` that at x = 85.5 mm.
"""

_NAME = re.compile(rf"{PROFILE} (left|right|-?\d+(?:\.\d+)?) (-?\d+(?:\.\d+)?)")
_REACH = 40.0  # no vertex of a body under a garment moves so far [mm]


def profile_name(section: str, height: float) -> str:
    """Return what the skin's foremost place at a ``height`` [mm] of a section is called.

    The ``section`` is "left" or "right", through that bust point, or its x [mm].
    """
    return f"{PROFILE} {section} {height:.3f}"


def section_of(name: str) -> str:
    """Return the name of a profile's figure without its height; nothing for a figure of another kind."""
    return name.rpartition(" ")[0] if name.startswith(f"{PROFILE} ") else ""


def profile_deviations(goals: Sequence[Goal], reached: Mapping[str, float]) -> dict[str, Floats]:
    """Return by how much what is ``reached`` stands out further than asked for, (k,) [mm], by section."""
    off: dict[str, list[float]] = {}
    for goal in goals:
        if section_of(goal.name):
            off.setdefault(section_of(goal.name), []).append(reached[goal.name] - goal.value)
    return {section: np.array(each) for section, each in off.items()}


def section_at(stages: Stages, section: str) -> float:
    """Return the x of a section [mm]: "left" and "right" go through the bust points at rest."""
    if section in ("left", "right"):
        return float(stages.landmarks.position(f"bust_point_{section}")[0])
    return float(section)


class _Section:
    """The faces that may come to cross x = ``at`` [mm], as the control points shape them."""

    def __init__(self, mesh: Mesh, binding: Binding, at: float) -> None:
        self._at = at
        self._faces, self._vertices = _near(mesh, at)
        self._rest = mesh.vertices[self._vertices]
        self._operator, self._changes = _followed(binding, self._vertices)

    def __call__(self, control_points: Points, heights: Floats) -> tuple[Floats, Floats]:
        """Return how far the skin stands out at heights (k,) [mm], and its slopes, (k, n, 3).

        Where there is no skin it is nan, and the slopes are nothing.
        """
        places = self._rest + self._operator @ self._changes.of(control_points)
        faces = self._faces[_crossing(places[:, 0], self._at, self._faces)]
        corners = places[faces]
        low, high = corners[:, :, 2].min(axis=1), corners[:, :, 2].max(axis=1)
        row, face = np.nonzero((low <= heights[:, None]) & (high >= heights[:, None]))
        spot = np.stack([np.full(len(row), self._at), heights[row]], axis=1)
        parts = _parts(corners[face][:, :, [0, 2]], spot)
        hit = parts.min(axis=1, initial=1.0) >= -1e-9
        row, face, parts = row[hit], face[hit], parts[hit]
        outs = -np.einsum("hc,hc->h", parts, corners[face, :, 1])
        order = np.lexsort((-outs, row))
        found, first = np.unique(row[order], return_index=True)
        foremost = order[first]
        values, slopes = np.full(len(heights), np.nan), np.zeros((len(heights), *control_points.shape))
        values[found] = outs[foremost]
        chosen = face[foremost]
        slopes[found] = self._slopes(control_points, faces[chosen], corners[chosen], parts[foremost])
        return values, slopes

    def _slopes(self, control_points: Points, faces: Indices, corners: Floats, parts: Floats) -> Floats:
        """Return the slopes of places on ``faces`` (k, 3), at their ``parts``, along y, (k, n, 3)."""
        a, b, c = corners.swapaxes(0, 1)
        normals = np.cross(b - a, c - a)
        ways = -normals / normals[:, 1:2]
        starts = np.arange(0, 3 * len(faces) + 1, 3)
        shape = (len(faces), len(self._rest))
        weights = sparse.csr_array((parts.ravel(), faces.ravel(), starts), shape=shape) @ self._operator
        by_columns = weights.toarray()[:, :, None] * ways[:, None, :]
        return self._changes.gradient(control_points, by_columns)


def _near(mesh: Mesh, at: float) -> tuple[Indices, Indices]:
    """Return the faces that may come to cross x = ``at``, as places among their vertices, and these."""
    x = mesh.vertices[:, 0]
    faces = mesh.faces[_crossing(x, at - _REACH, mesh.faces, at + _REACH)]
    used = np.zeros(len(x), dtype=bool)
    used[faces] = True
    return (np.cumsum(used) - 1)[faces], np.flatnonzero(used)


def _crossing(x: Floats, low: float, faces: Indices, high: float | None = None) -> Flags:
    """Return which faces come between ``low`` and ``high`` (or to ``low``), by the x of their vertices."""
    a, b, c = faces.T
    left, right = x <= (low if high is None else high), x >= low
    return np.asarray((left[a] | left[b] | left[c]) & (right[a] | right[b] | right[c]))


def _followed(binding: Binding, vertices: Indices) -> tuple[sparse.csr_array, Changes]:
    """Return what moves ``vertices`` (k,) of the body, (k, columns), and its columns; empty rows stay."""
    place = np.full(len(binding.body.vertices), -1)
    place[binding.moving] = np.arange(len(binding.moving))
    moves = place[vertices] >= 0
    few = binding.few(place[vertices[moves]])
    spread = sparse.csr_array(
        (np.ones(int(moves.sum())), (np.flatnonzero(moves), np.arange(moves.sum()))),
        shape=(len(vertices), int(moves.sum())),
    )
    return sparse.csr_array(spread @ few.operator), few.changes


def _parts(corners: Floats, places: Floats) -> Floats:
    """Return what corners of flat triangles, (f, 3, 2), count for at places (f, 2), (f, 3); flat ones: -1."""
    (ax, ay), (bx, by), (cx, cy) = ((corners[:, at] - places).T for at in range(3))
    areas = np.stack([bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx], axis=1)
    whole = areas.sum(axis=1, keepdims=True)
    return np.asarray(np.where(np.abs(whole) > 1e-12, areas / np.where(whole == 0.0, 1.0, whole), -1.0))


@lru_cache(maxsize=2)  # all heights of a profile are read off the same one
def _section(mesh: Mesh, binding: Binding, at: float) -> _Section:
    return _Section(mesh, binding, at)


def skin_of(stages: Stages, section: str, heights: Floats) -> ReadMany:
    """Return what reads how far the skin stands out at ``heights`` (k,) [mm]; nan where there is none."""
    return partial(_section(stages.body.mesh, stages.binding, section_at(stages, section)), heights=heights)


def profile_reader(stages: Stages, names: Sequence[str]) -> ReadMany:
    """Return what reads heights of one section at once. Raises UserError if a name names none."""
    found = [_NAME.fullmatch(name) for name in names]
    for name, match in zip(names, found, strict=True):
        if match is None:
            raise UserError(
                Message("'{name}' is not a position on a profile.", name=name),
                Message("Specify the section and a height, such as 'profile left 1150'."),
            )
    known = [match for match in found if match is not None]
    at, heights = section_at(stages, known[0][1]), np.array([float(match[2]) for match in known])
    section = _section(stages.body.mesh, stages.binding, at)

    def read(control_points: Points) -> tuple[Floats, Floats]:
        values, slopes = section(control_points, heights)
        if np.isnan(values).any():
            height = heights[int(np.flatnonzero(np.isnan(values))[0])]
            raise UserError(
                Message(
                    "The section at x = {at} has no skin at a height of {height}.",
                    height=Length(height),
                    at=Length(at),
                ),
                Message("Use heights on the body as shown in Busk, in millimetres."),
            )
        return values, slopes

    read(stages.control.mesh.vertices)
    return read


def _read_profile(stages: Stages, name: str) -> Read:
    together = profile_reader(stages, [name])

    def read(control_points: Points) -> Reading:
        (value,), (slopes,) = together(control_points)
        return Reading(float(value), slopes)

    return read


OUTLINE = QuantityFamily((), _read_profile, PROFILE)
"""How far the skin stands out at a height of a section, to the front of the origin [mm]."""


FAMILIES: tuple[QuantityFamily, ...] = (BUST, APEX, GIRTHS, EVEN, OUTLINE)
"""All families of figures."""

NAMES = tuple(name for family in FAMILIES for name in family.names)
"""What can be asked for by name, in millimetres."""


def reading(stages: Stages, name: str) -> Read:
    """Return what reads the figure ``name``. Raises UserError if there is none of that name."""
    for family in FAMILIES:
        if family.has(name):
            return family.read(stages, name)
    raise UserError(
        Message("'{name}' is not a target.", name=name),
        Message("Choose one of: {names}.", names=", ".join(NAMES)),
    )


def tolerance(name: str) -> float:
    """Return the tolerance [mm] of the quantity ``name``; 1 if there is none of that name."""
    return next((family.tolerance for family in FAMILIES if family.has(name)), 1.0)


class QuantityReaders:
    """The figures of one body, whatever its lines are; what was made for one question is kept."""

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._single: dict[str, Read] = {}
        self._heights: dict[tuple[str, ...], ReadMany] = {}

    def reader(self, names: Sequence[str]) -> ReadMany:
        """Return what reads these figures together: all heights of a section at once. Raises UserError."""
        sections: dict[str, list[int]] = {}
        for at, name in enumerate(names):
            sections.setdefault(section_of(name) or name, []).append(at)
        parts = [(at, self._together(tuple(names[each] for each in at))) for at in sections.values()]

        def read(control_points: Points) -> tuple[Floats, Floats]:
            values, slopes = np.zeros(len(names)), np.zeros((len(names), *control_points.shape))
            for at, part in parts:
                values[at], slopes[at] = part(control_points)
            return values, slopes

        return read

    def _together(self, names: tuple[str, ...]) -> ReadMany:
        if section_of(names[0]):
            if names not in self._heights:
                self._heights[names] = profile_reader(self._stages, names)
            return self._heights[names]
        name = names[0]
        read = self._known(name)

        def alone(control_points: Points) -> tuple[Floats, Floats]:
            found = read(control_points)
            return np.array([found.value]), found.slopes[None]

        return alone

    def _known(self, name: str) -> Read:
        if name not in self._single:
            self._single[name] = reading(self._stages, name)
        return self._single[name]
