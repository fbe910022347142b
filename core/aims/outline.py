"""How far the skin stands out at a height, as a section shows it: figures that can be asked for (ours).

``profile left 1150`` is the foremost place of the skin 1150 mm above the origin, on the upright section from
front to back through the left bust point at rest; ``profile 85.5 1150`` that on the section at x = 85.5 mm.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from scipy import sparse

from core.aims.figure import Family, Goal, Read, Reading
from core.errors import UserError
from core.mesh import Floats, Indices, Mesh, Points
from core.pipeline import Stages
from core.tffd import Binding

PROFILE = "profile"

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


def profiles_off(goals: Sequence[Goal], reached: Mapping[str, float]) -> dict[str, Floats]:
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
        self._binding, self._at = binding, at
        self._faces, self._vertices = _near(mesh, at)
        self._rest = mesh.vertices[self._vertices]
        self._operator = _operator_of(binding, self._vertices)
        self._last: tuple[Points, Points, Indices, Points] | None = None

    def __call__(self, control_points: Points, height: float) -> Reading | None:
        """Return how far the skin stands out at a height [mm], and its slopes; None where there is none."""
        places, faces, corners = self._crossing(control_points)
        inside = (corners[:, :, 2].min(axis=1) <= height) & (corners[:, :, 2].max(axis=1) >= height)
        faces, corners = faces[inside], corners[inside]
        parts = _parts(corners[:, :, [0, 2]], np.array([self._at, height]))
        hit = np.flatnonzero(parts.min(axis=1, initial=1.0) >= -1e-9)
        if not len(hit):
            return None
        outs = np.einsum("fc,fc->f", parts[hit], corners[hit, :, 1])
        first = hit[int(outs.argmin())]
        a, b, c = corners[first]
        normal = np.cross(b - a, c - a)
        slopes = np.zeros_like(places)
        slopes[faces[first]] = -parts[first][:, None] * (normal / normal[1])
        by_points = self._binding.by_points(control_points, self._operator.T @ slopes)
        return Reading(-float(outs.min()), by_points)

    def _crossing(self, control_points: Points) -> tuple[Points, Indices, Points]:
        """Return the places, (k, 3), and the faces that cross the section: (f, 3) and corners (f, 3, 3)."""
        last = self._last
        if last is None or last[0] is not control_points:
            places = self._rest + self._operator @ self._binding.change(control_points)
            across = places[self._faces, 0] - self._at
            faces = self._faces[(across.min(axis=1) <= 0.0) & (across.max(axis=1) >= 0.0)]
            self._last = last = control_points, places, faces, places[faces]
        return last[1:]


def _near(mesh: Mesh, at: float) -> tuple[Indices, Indices]:
    """Return the faces that may come to cross x = ``at``, as places among their vertices, and these."""
    side = np.digitize(mesh.vertices[:, 0] - at, [-_REACH, _REACH])[mesh.faces]
    faces = mesh.faces[side.min(axis=1) <= 1]
    faces = faces[side[side.min(axis=1) <= 1].max(axis=1) >= 1]
    vertices, place = np.unique(faces, return_inverse=True)
    return place.reshape(-1, 3), vertices


def _operator_of(binding: Binding, vertices: Indices) -> sparse.csr_array:
    """Return what moves ``vertices`` (k,) of the body, shape (k, columns); rows of nothing keep still."""
    place = np.full(len(binding.body.vertices), -1)
    place[binding.moving] = np.arange(len(binding.moving))
    moves = place[vertices] >= 0
    rows = binding.operator.of_rows(place[vertices[moves]])
    spread = sparse.csr_array(
        (np.ones(len(rows.indptr) - 1), (np.flatnonzero(moves), np.arange(moves.sum()))),
        shape=(len(vertices), int(moves.sum())),
    )
    return sparse.csr_array(spread @ rows)


def _parts(corners: Floats, place: Floats) -> Floats:
    """Return what each corner of flat triangles, (f, 3, 2), counts for at a place, (f, 3); flat ones: -1."""
    (ax, ay), (bx, by), (cx, cy) = (corners[:, at].T - place[:, None] for at in range(3))
    areas = np.stack([bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx], axis=1)
    whole = areas.sum(axis=1, keepdims=True)
    return np.asarray(np.where(np.abs(whole) > 1e-12, areas / np.where(whole == 0.0, 1.0, whole), -1.0))


@lru_cache(maxsize=2)  # all heights of a profile are read off the same one
def _section(mesh: Mesh, binding: Binding, at: float) -> _Section:
    return _Section(mesh, binding, at)


def _read(stages: Stages, name: str) -> Read:
    match = _NAME.fullmatch(name)
    if match is None:
        raise UserError(
            f"'{name}' names no place of a profile.", "Name the section and a height: profile left 1150."
        )
    at, height = section_at(stages, match[1]), float(match[2])
    section = _section(stages.body.mesh, stages.binding, at)

    def read(control_points: Points) -> Reading:
        found = section(control_points, height)
        if found is None:
            raise UserError(
                f"There is no skin at a height of {height:.0f} mm on the section at x = {at:.0f} mm.",
                "Heights are those of the body as Busk shows it, in millimetres.",
            )
        return found

    read(stages.control.mesh.vertices)
    return read


OUTLINE = Family((), _read, PROFILE)
"""How far the skin stands out at a height of a section, to the front of the origin [mm]."""
