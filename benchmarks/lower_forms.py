"""Make other persons of bodies with known landmarks of the lower trunk: other widths, depths and heights.

Heights by definition (largest and least tape, foremost and most backward place) are found anew on the
reshaped surface, by plain plane sections; the others are points that move along.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pyvista as pv
from scipy.interpolate import CubicSpline
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from core.geometry.mesh import Mesh, Points

Truth = dict[str, Any]

CHANGE = 0.06
"""Widths, depths and heights change by at most this, differently at thighs, hip, waist and breast [1]."""

BEND = np.radians(4.0)
"""The upper body leans by at most this, to the front or back and to a side."""

BUMP, SHIFT = 9.0, 18.0
"""Belly and seat come out or go in by at most BUMP, the waist rises or sinks by at most SHIFT [mm]."""

STEP = 2.0
"""Distance of plane sections [mm]."""

ROOM = 35.0
"""The foremost and the most backward place are looked for this far from where they come to [mm]."""

PAIRS = ("buttock", "gluteal_fold")


class Person:
    """A smooth map of space that makes another person of a body with a ``truth``, drawn by ``seed``."""

    def __init__(self, truth: Truth, seed: int) -> None:
        draw = np.random.default_rng([seed, round(1000 * truth["levels"]["hip_largest"] + 1e6)])
        levels = truth["levels"]
        crotch, hip, waist = (levels[name] for name in ("crotch", "hip_joint", "waist_ring"))
        knots = [crotch - 120.0, crotch + 20.0, hip + 0.5 * (waist - hip), waist + 60.0, waist + 260.0]
        width, depth = (CubicSpline(knots, draw.uniform(-CHANGE, CHANGE, 5)) for _ in range(2))
        self._width = lambda z: 1.0 + width(np.clip(z, knots[0], knots[-1]))
        self._depth = lambda z: 1.0 + depth(np.clip(z, knots[0], knots[-1]))
        self._height, self._shift = 1.0 + draw.uniform(-CHANGE, CHANGE), draw.uniform(-SHIFT, SHIFT)
        self._lean = draw.uniform(-BEND, BEND, 2) * (1.0, 0.5)
        self._belly, self._seat = draw.uniform(-BUMP, BUMP, 2)
        self._belly_z = levels["belly"] + draw.uniform(-25.0, 25.0)
        self._seat_z = levels["buttock"] + draw.uniform(-25.0, 25.0)
        self._hip, self._waist = hip, waist
        self._middle = float(
            np.mean([truth["landmarks"][f"waist_ring_{side}"][1] for side in ("left", "right")])
        )

    def __call__(self, points: Points) -> Points:
        """Return where points (n, 3) [mm] come to."""
        x, y, z = np.asarray(points, dtype=float).T
        y = y - self._middle
        front, back = 0.5 * (1.0 - np.tanh(y / 40.0)), 0.5 * (1.0 + np.tanh(y / 40.0))
        y = y - self._belly * front * np.exp(-((x / 110.0) ** 2) - ((z - self._belly_z) / 60.0) ** 2)
        seat = np.exp(-(((np.abs(x) - 60.0) / 60.0) ** 2) - ((z - self._seat_z) / 55.0) ** 2)
        y = y + self._seat * back * seat
        x, y = x * self._width(z), y * self._depth(z)
        z = z + self._shift * np.exp(-(((z - self._waist - 40.0) / 90.0) ** 2))
        up = np.maximum(z - self._hip, 0.0)
        grown = np.minimum(up / 250.0, 1.0) ** 2  # the bend begins at the hip joint
        x, y = x + self._lean[1] * grown * up, y + self._lean[0] * grown * up
        return np.stack([x, y + self._middle, z * self._height], axis=1)


def reshaped(seed: int, mesh: Mesh, truth: Truth) -> tuple[Mesh, Truth]:
    """Return another person made of a body, and its truth, see ``found_anew``."""
    person = Person(truth, seed)
    moved = Mesh(person(mesh.vertices), mesh.faces)
    return moved, found_anew(moved, truth, person)


def coarse(mesh: Mesh, truth: Truth) -> Mesh:
    """Put a body on a quarter of its triangles, chosen by quadrics."""
    data = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces).decimate(0.75)
    return Mesh(np.asarray(data.points, dtype=float), np.asarray(data.regular_faces))


def found_anew(mesh: Mesh, truth: Truth, person: Callable[[Points], Points]) -> Truth:
    """Return the truth of a reshaped body: points move along, extremes are looked for near there."""
    after = deepcopy(truth)
    marks, levels = after["landmarks"], after["levels"]
    for name in ("crotch", *(f"{pair}_{side}" for pair in PAIRS for side in ("left", "right"))):
        marks[name] = person(np.array([truth["landmarks"][name]]))[0].tolist()
    levels["crotch"] = marks["crotch"][2]
    along = {
        name: float(person(np.array([truth["landmarks"][f"{name}_front"]]))[0, 2])
        for name in ("hip", "waist_natural", "waist_ring", "belly")
    }
    for side, sign in (("left", 1.0), ("right", -1.0)):
        marks[f"buttock_{side}"] = _most_backward(mesh.vertices, sign, marks[f"buttock_{side}"])
    levels["hip_largest"] = _extreme(mesh, along["hip"] - 60.0, along["hip"] + 60.0, levels["crotch"], -1.0)
    lowest, highest = levels["hip_largest"] + 60.0, along["waist_ring"] + 160.0
    levels["waist_natural"] = _extreme(mesh, lowest, highest, lowest, 1.0)
    hump = truth["belly_quality"]["hump"]
    levels["belly"] = _foremost(mesh, along["belly"]) if hump else along["belly"]
    return after


def _most_backward(vertices: Points, sign: float, near: list[float]) -> list[float]:
    """Return the most backward vertex of a side near a place [mm]; not a number if there is none."""
    x, y, z = vertices.T
    there = np.flatnonzero((sign * x > 15.0) & (sign * x < 120.0) & (np.abs(z - near[2]) < ROOM))
    found = vertices[there[y[there].argmax()]]
    on_edge = abs(found[2] - near[2]) > ROOM - 3.0  # a flat seat: another hill stands out further
    return [float("nan")] * 3 if on_edge else found.tolist()


def _extreme(mesh: Mesh, low: float, high: float, least: float, sign: float) -> float:
    """Return the height of the least tape (``sign`` 1) or the largest (-1) between two heights [mm]."""
    heights = np.arange(max(low, least), high, STEP)
    tapes = sign * np.array([_tape(mesh, z) for z in heights])
    at = int(np.nanargmin(tapes))
    if not 0 < at < len(tapes) - 1:
        return float(heights[at])
    a, b, c = tapes[at - 1 : at + 2]
    return float(heights[at] + 0.5 * STEP * (a - c) / (a - 2.0 * b + c))


def _tape(mesh: Mesh, z: float) -> float:
    """Return the perimeter of the hull of the outline round the axis at a height [mm]."""
    loops = [loop[:, :2] for loop in _loops(mesh, 2, z)]
    round_axis = [loop for loop in loops if loop[:, 0].min() < -20.0 and loop[:, 0].max() > 20.0]
    return max((float(ConvexHull(loop).area) for loop in round_axis), default=float("nan"))


def _foremost(mesh: Mesh, near: float) -> float:
    """Return the height of the foremost place of the midline near a height [mm]."""
    points = np.concatenate(_loops(mesh, 0, 0.01))
    points = points[np.abs(points[:, 2] - near) < ROOM]
    return float(points[points[:, 1].argmin(), 2])


def _loops(mesh: Mesh, axis: int, level: float) -> list[Points]:
    """Return the points of each outline of a section across an axis at a level [mm]."""
    above = mesh.vertices[:, axis] > level
    faces = mesh.faces[np.ptp(above[mesh.faces].astype(int), axis=1) > 0]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    crossed = above[edges[:, 0]] != above[edges[:, 1]]
    edges, triangle = edges[crossed], np.tile(np.arange(len(faces)), 3)[crossed]
    edges, point = np.unique(edges, axis=0, return_inverse=True)
    a, b = mesh.vertices[edges[:, 0]], mesh.vertices[edges[:, 1]]
    points = a + ((level - a[:, axis]) / (b[:, axis] - a[:, axis]))[:, None] * (b - a)
    pairs = point.ravel()[np.argsort(triangle, kind="stable")].reshape(-1, 2)
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(points), len(points)))
    count, part = connected_components(links, directed=False)
    return [points[part == at] for at in range(count)]
