"""A body cut by a plane along its axes, as curves in that plane, and how far two such curves are apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.geometry.mesh import Floats, Indices, Mesh, Points, unit
from core.geometry.plane_sections import cut, ordered_rows

AXES = ("x", "y", "z")
"""What a plane stands across: the body from side to side, from front to back, or upright."""

_FLAT = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}
_REACH = 40.0  # no vertex of a body under a garment moves so far [mm]
_SHARPNESS = 1.0  # [mm]


@dataclass(frozen=True)
class Plane:
    """The plane of all places whose coordinate on ``axis`` is ``at`` [mm].

    Flat coordinates (across, up) [mm] are those of somebody who looks at it: from the subject's right with
    the front to the right (x), from in front (y), from above with the front below (z).
    """

    axis: str
    at: float

    @property
    def number(self) -> int:
        """Return the index of the axis: 0, 1 or 2."""
        return AXES.index(self.axis)

    @property
    def normal(self) -> Floats:
        """Return the direction of the axis, shape (3,)."""
        return np.asarray(np.eye(3)[self.number])

    def flat(self, ways: Points) -> Floats:
        """Return the flat coordinates of places or directions, shapes (k, 3) and (k, 2)."""
        flat = ways[..., list(_FLAT[self.axis])]
        return np.asarray(flat * [-1.0, 1.0] if self.axis == "x" else flat)

    def in_space(self, flat: Floats) -> Points:
        """Return the places in space of flat coordinates, shapes (k, 3) and (k, 2) [mm]."""
        result = np.full((*flat.shape[:-1], 3), self.at)
        result[..., list(_FLAT[self.axis])] = flat * [-1.0, 1.0] if self.axis == "x" else flat
        return result


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve of a cut: flat ``places`` [mm] and unit ``normals`` [1], outward at rest, both (k, 2).

    A closed one ends with the place that it begins with.
    """

    places: Floats
    normals: Floats


class Slicer:
    """Cuts a body with one plane, again and again while it moves: only faces near by are looked at."""

    def __init__(self, rest: Mesh, plane: Plane) -> None:
        self.plane = plane
        side = rest.vertices[:, plane.number] - plane.at
        zone = np.digitize(side, [-_REACH, _REACH]).astype(np.int8)[rest.faces.T]  # beyond, near or beyond
        faces = rest.faces[(zone[0] != zone[1]) | (zone[1] != zone[2]) | (zone[0] == 1)]
        used = np.zeros(len(side), dtype=bool)
        used[faces] = True
        self._vertices = np.flatnonzero(used)
        self._faces = (np.cumsum(used) - 1)[faces]
        self._normals = rest.vertex_normals[self._vertices]

    def curves(self, places: Points) -> tuple[Curve, ...]:
        """Return the curves of the body with its vertices at ``places``, shape (n, 3) [mm]; longest first."""
        section = cut(
            Mesh(places[self._vertices], self._faces), self.plane.normal * self.plane.at, self.plane.normal
        )
        edges = section.edge_ids.ravel()
        return tuple(self._curve(section.points[rows], edges[rows]) for rows in ordered_rows(section))

    def interpolate(self, places: Points, values: Floats) -> list[Floats]:
        """Return ``values`` (n,) of the vertices at the places of each of the ``curves``, each (k,)."""
        moved, known = places[self._vertices], values[self._vertices]
        section = cut(Mesh(moved, self._faces), self.plane.normal * self.plane.at, self.plane.normal)
        first, second = np.divmod(section.edge_ids.ravel(), len(self._vertices))
        low, high = (moved[ends, self.plane.number] for ends in (first, second))
        steep = np.where(high == low, 1.0, high - low)
        part = np.clip((self.plane.at - low) / steep, 0.0, 1.0)
        carried = (1.0 - part) * known[first] + part * known[second]
        return [carried[rows] for rows in ordered_rows(section)]

    def _curve(self, points: Points, edges: Indices) -> Curve:
        first, second = np.divmod(edges, len(self._vertices))
        # Those at rest: they tell inside from outside all the time.
        outward = self.plane.flat(self._normals[first] + self._normals[second])
        return Curve(self.plane.flat(points), unit(outward))


@dataclass(frozen=True, eq=False)
class CurvePoint:
    """A place on a curve: flat ``place`` [mm] and outward ``normal`` [1], both (2,)."""

    place: Floats
    normal: Floats


def nearest(curves: Sequence[Curve], place: Floats) -> CurvePoint | None:
    """Return the place on ``curves`` nearest to a flat place, shape (2,) [mm]; None without curves."""
    best, least = None, np.inf
    for curve in curves:
        start, way = curve.places[:-1], np.diff(curve.places, axis=0)
        along = np.einsum("ij,ij->i", place - start, way) / np.maximum((way**2).sum(axis=1), 1e-12)
        along = np.clip(along, 0.0, 1.0)[:, None]
        feet = start + along * way
        away = np.linalg.norm(feet - place, axis=1)
        k = int(away.argmin())
        if away[k] < least:
            normal = (1.0 - along[k]) * curve.normals[k] + along[k] * curve.normals[k + 1]
            best, least = CurvePoint(feet[k], normal), float(away[k])
    return best


def protrusion(foot: CurvePoint, before: Sequence[Curve]) -> tuple[Floats, float] | None:
    """Return where ``before`` is nearest to a foot, (2,), and how far the foot stands out from there [mm]."""
    other = nearest(before, foot.place)
    if other is None:
        return None
    way = foot.place - other.place
    return other.place, float(np.copysign(np.linalg.norm(way), way @ other.normal))


def apexes(plane: Plane, curves: Sequence[Curve], low: Points, high: Points, middle: float) -> list[Floats]:
    """Return the foremost flat places, (2,) [mm], of a cut within a box from ``low`` to ``high``, (3,) [mm].

    One in a side view, one each side of x = ``middle`` in a level cut, none in a cut from side to side. It is
    a mean that favours what lies foremost: a single place would jump about.
    """
    if plane.axis == "y" or not curves:
        return []
    places = plane.in_space(np.concatenate([curve.places for curve in curves]))
    inside = ((places >= low) & (places <= high))[:, [0, 2]].all(axis=1)
    places = places[inside & (places[:, 1] < 0.5 * (low[1] + high[1]))]
    sides = [places] if plane.axis == "x" else [places[places[:, 0] > middle], places[places[:, 0] < middle]]
    found = []
    for side in sides:
        if len(side):
            weight = np.exp((side[:, 1].min() - side[:, 1]) / _SHARPNESS)
            found.append(plane.flat(weight @ side / weight.sum()))
    return found


def mirrored(plane: Plane, curves: Sequence[Curve], middle: float) -> tuple[Curve, ...]:
    """Return curves mirrored at x = ``middle`` [mm]; of a cut across x the picture stays as it is."""
    if plane.axis == "x":
        return tuple(curves)
    swap = np.array([-1.0, 1.0])
    return tuple(
        replace(curve, places=curve.places * swap + [2.0 * middle, 0.0], normals=curve.normals * swap)
        for curve in curves
    )
