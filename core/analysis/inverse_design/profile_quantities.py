"""How far the skin stands out along a section from front to back, by the control points (ours)."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache, partial

import numpy as np
from scipy import sparse

from core.analysis.inverse_design.quantity import Goal, QuantityFamily, Read, Reading, ReadMany
from core.deformation.changes import Changes
from core.deformation.tffd import Binding
from core.errors import UserError
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.messages import Length, Message
from core.pipeline.build import Stages

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


def is_signed(name: str) -> bool:
    """Return whether a quantity is relative to the original, so that its plus is written."""
    return "girth" not in name and not section_of(name)


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
    """The faces that may come to cross x = ``at`` [mm], as the control points of all regions shape them."""

    def __init__(self, mesh: Mesh, parts: Sequence[tuple[range, Binding]], at: float) -> None:
        self._at = at
        self._faces, self._vertices = _near(mesh, at)
        self._rest = mesh.vertices[self._vertices]
        self._parts = [
            (slice(rows.start, rows.stop), *_followed(binding, self._vertices)) for rows, binding in parts
        ]

    def __call__(self, control_points: Points, heights: Floats) -> tuple[Floats, Floats]:
        """Return how far the skin stands out at heights (k,) [mm], and its slopes, (k, n, 3).

        Where there is no skin it is nan, and the slopes are nothing.
        """
        places = self._rest
        for rows, operator, changes in self._parts:
            places = places + operator @ changes.of(control_points[rows])
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
        at_vertices = sparse.csr_array((parts.ravel(), faces.ravel(), starts), shape=shape)
        found = np.zeros((len(faces), *control_points.shape))
        for rows, operator, changes in self._parts:
            by_columns = (at_vertices @ operator).toarray()[:, :, None] * ways[:, None, :]
            found[:, rows] = changes.gradient(control_points[rows], by_columns)
        return found


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
def _known_section(mesh: Mesh, parts: tuple[tuple[range, Binding], ...], at: float) -> _Section:
    return _Section(mesh, parts, at)


def _section(stages: Stages, at: float) -> _Section:
    rows = (range(part.start, part.stop) for part in stages.region_rows)
    bindings = (region.binding for region in stages.regions)
    return _known_section(stages.body.mesh, tuple(zip(rows, bindings, strict=True)), at)


def skin_of(stages: Stages, section: str, heights: Floats) -> ReadMany:
    """Return what reads how far the skin stands out at ``heights`` (k,) [mm]; nan where there is none."""
    return partial(_section(stages, section_at(stages, section)), heights=heights)


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
    section = _section(stages, at)

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

    read(stages.rest_points)
    return read


def _read_profile(stages: Stages, name: str) -> Read:
    together = profile_reader(stages, [name])

    def read(control_points: Points) -> Reading:
        (value,), (slopes,) = together(control_points)
        return Reading(float(value), slopes)

    return read


OUTLINE = QuantityFamily((), _read_profile, PROFILE, region="")
"""How far the skin stands out at a height of a section, to the front of the origin [mm]."""
