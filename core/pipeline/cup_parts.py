"""Cups of a design on a body: where they lie, their shape, and their parts in the model (ours)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh
from core.control_mesh.halved import off_skin, through_middles
from core.document.cup import Cup
from core.errors import LineError
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.mechanics.cup_parts import CupCloth, CupContact, CupPart, SmoothSurface, Underwire
from core.mechanics.springs import incidence_of, members
from core.messages import Message

CUP_STIFFNESS = 1.0
"""How hard the shell of a moulded cup is at a point: far stiffer than tissue [N/mm]."""

WIRE_STIFFNESS = 3.0
"""How hard a wire holds a point of the root to its form [N/mm]."""

REACH = 1.2
"""Standard deviation of the means that make a cup smooth, over the distance between its points [1]."""

UPPER_EDGE = {"half": 0.0, "three-quarter": 1.0 / 3.0, "full": 2.0 / 3.0}
"""Where the upper edge of a cup lies, from the row of the bust points (0) to the last free row (1)."""

ROUNDNESS = 3.0
"""Exponent of the superellipse that a cup is drawn as: 2 is an ellipse, more is nearer to a rectangle."""

MOST_LACK = 0.12
"""Cups that hold so much less than the breasts are a press and no garment [1]: they are refused."""

SIDES = (1, -1)
"""The left and the right side of the person, as the sign of x."""


@dataclass(frozen=True, eq=False)
class CupLayout:
    """Where both cups of a design lie on a control mesh; ``fitted`` is the one that ``control`` has halved.

    ``depth`` (n,) [mm] is that of the tissue under each point, beyond that under skin that does not move.
    """

    cup: Cup
    fitted: ControlMesh
    control: ControlMesh
    depth: Floats

    @cached_property
    def _row(self) -> Floats:
        return _with_middles(self.fitted.row, self.fitted)

    @cached_property
    def _column(self) -> Floats:
        return _with_middles(self.fitted.column, self.fitted)

    def points(self, side: int) -> Indices:
        """Return the control points that the cup of a side covers and that can move, (c,), ascending."""
        free = ~self.control.fixed
        last = float(self._row[free].max())
        upper = self._bust_row + UPPER_EDGE[self.cup.coverage] * (last - self._bust_row)
        across = (side * self._column >= 0.5) & (side * self._column <= self._outer_root)
        covered = free & across & (self._row >= self._fold_row) & (self._row <= upper)
        return np.asarray(np.flatnonzero(covered))

    def inside(self, side: int) -> Floats:
        """Return how far inside the outline of a side's cup each control point is, (n,) [1], 0.5 at the edge.

        The outline is that of the covered points with round corners, where a cup hardly acts.
        """
        points, way = self.points(side), np.zeros(len(self.control.fixed))
        for place in (side * self._column, self._row):
            low, high = place[points].min() - 0.25, place[points].max() + 0.25
            way += np.abs((2.0 * place - low - high) / (high - low)) ** ROUNDNESS
        return np.asarray(np.clip(1.5 - way ** (1.0 / ROUNDNESS), 0.0, 1.0))

    @property
    def _outer_root(self) -> float:
        return float(self.fitted.column.max() - 1)

    @property
    def _bust_row(self) -> float:
        return float(self.fitted.row[self.fitted.bust_points[0]])

    @property
    def _fold_row(self) -> float:
        return float(self.fitted.row[self.fitted.paths["under-bust"][0]])

    @cached_property
    def target(self) -> Points:
        """Return where a moulded cup would have each control point, shape (n, 3) [mm].

        The apex goes all the way, other places as much less as their tissue is less deep.
        """
        rest, cup = self.control.mesh.vertices, self.cup
        target = rest.copy()
        for side, bust in zip(SIDES, self.control.bust_points, strict=True):
            share = np.clip(self.depth / self.depth[bust], 0.0, 1.0)
            way = np.array([-side * cup.gather, -cup.forward, cup.lift])
            here = side * self._column >= 0.5
            target[here] += share[here, None] * way
        return target

    def root(self, side: int) -> Indices:
        """Return the control points of the root from its inner to its outer end, free or not, (w,)."""
        fold, bust, outer = int(self._fold_row), int(self._bust_row), int(self._outer_root)
        number = {place: at for at, place in enumerate(zip(self.fitted.row, self.fitted.column, strict=True))}
        down = [(row, 1) for row in range(bust, fold, -1)]
        up = [(row, outer) for row in range(fold + 1, bust + 1)]
        places = [*down, *((fold, column) for column in range(1, outer + 1)), *up]
        path = tuple(number[row, side * column] for row, column in places)
        return np.array(through_middles(path, self.fitted.mesh))

    def root_length(self, side: int) -> float:
        """Return the length of the root from its inner to its outer end [mm]."""
        path = self.control.mesh.vertices[self.root(side)]
        return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())

    def root_width(self, side: int) -> float:
        """Return the distance between the ends of the root [mm]."""
        ends = self.control.mesh.vertices[self.root(side)[[0, -1]]]
        return float(np.linalg.norm(ends[1] - ends[0]))

    def cloth_lengths(self, side: int) -> tuple[float, float]:
        """Return the mean lengths of the skin under a sewn cup, across and upright [mm]."""
        pairs, across = self._strips(side)
        length = np.linalg.norm(self._spans(pairs) @ self.control.mesh.vertices, axis=1)
        rows, columns = (len(np.unique(place[pairs])) for place in (self._row, self._column))
        return float(length[across].sum()) / rows, float(length[~across].sum()) / columns

    def wire_shape(self, side: int) -> Points:
        """Return the form of the wire less that of the root, shape (w, 3) [mm]: wider in its own plane."""
        rest = self.control.mesh.vertices[self.root(side)]
        away = rest - rest.mean(axis=0)
        return np.asarray((self.cup.wire_width - 1.0) * away * np.array([1.0, 1.0, 0.0]))

    def parts(self) -> tuple[CupPart, ...]:
        """Return the parts of both cups, the left first. Raises LineError for cups that hold too little."""
        if self.cup.kind == "moulded" and (lack := self._lack) > MOST_LACK:
            raise LineError(
                Message("The cups hold {percent} % less than the breasts.", percent=f"{100.0 * lack:.0f}"),
                Message("Move the cups forward, gather them less, or choose sewn cups."),
            )
        made: list[CupPart] = []
        for side in SIDES:
            made.append(self._cloth(side) if self.cup.kind == "sewn" else self._contact(side))
            if self.cup.wire:
                made.append(self._wire(side))
        return tuple(made)

    @property
    def _lack(self) -> float:
        """Return how much less the smaller cup holds than its breast, over the volume of that [1]."""
        mesh = self.control.mesh
        middle = mesh.vertices[mesh.faces].mean(axis=1)
        deep = self.depth[mesh.faces].mean(axis=1)
        # What the skin sweeps on its way to the shape of the cup, to first and second order.
        way = (self.target - mesh.vertices)[mesh.faces].mean(axis=1)
        halfway = mesh.moved(0.5 * (self.target + mesh.vertices))
        swept = np.einsum("ij,ij->i", way, halfway.face_normals) * halfway.face_areas
        sides = [side * middle[:, 0] > side * self._middle for side in SIDES]
        return max(-float(swept[own].sum() / (deep * mesh.face_areas)[own].sum()) for own in sides)

    @property
    def _middle(self) -> float:
        return float(self.control.mesh.vertices[self._column == 0.0, 0].mean())

    @cached_property
    def _place(self) -> Indices:
        place = np.full(len(self.control.fixed), -1, dtype=np.int64)
        place[~self.control.fixed] = np.arange(int((~self.control.fixed).sum()))
        return place

    def _contact(self, side: int) -> CupContact:
        points = self.points(side)
        shape = self.control.mesh.moved(self.target)
        nodes = np.union1d(points, shape.edges[np.isin(shape.edges, points).any(axis=1)])
        nodes = nodes[side * self._column[nodes] >= 0.0]
        apart = np.asarray(cKDTree(self.target[points]).query(self.target[points], k=2)[0])
        surface = SmoothSurface(
            self.target[nodes], shape.vertex_normals[nodes], REACH * float(np.mean(apart[:, 1]))
        )
        rest = self.control.mesh.vertices[points]
        return CupContact(self._place[points], rest, self.target[points], surface, CUP_STIFFNESS)

    def _strips(self, side: int) -> tuple[Indices, Flags]:
        """Return the ends of the strips of a sewn cup, (s, 2), and which of them go across, (s,)."""
        points = self.points(side)
        edges = self.control.mesh.edges
        pairs = edges[np.isin(edges, points).all(axis=1)]
        rows, columns = (np.ptp(place[pairs], axis=1) for place in (self._row, self._column))
        pairs = pairs[(rows == 0.0) | (columns == 0.0)]
        return pairs, np.asarray(self._row[pairs[:, 0]] == self._row[pairs[:, 1]])

    def _cloth(self, side: int) -> CupCloth:
        pairs, across = self._strips(side)
        spans, rest = self._spans(pairs), self.control.mesh.vertices
        ratio = np.where(across, self.cup.across, self.cup.upright)
        natural = ratio * np.linalg.norm(spans @ rest, axis=1)
        stiffness = 1e-3 * self.cup.cloth * _strip_widths(self.control.mesh, pairs) / natural
        return CupCloth(members(rest, self._place, spans, stiffness), natural)

    def _spans(self, pairs: Indices) -> sparse.csr_array:
        """Return what makes strips between ``pairs`` (s, 2) of the points, (s, n).

        Where a point is off the skin, as over a crease, the cloth hangs amid those on it that it leads to.
        """
        count = len(self.control.fixed)
        off = off_skin(self.fitted, self.control)
        ways = np.concatenate([pairs, pairs[:, ::-1]])
        ways = ways[off[ways[:, 0]] & ~off[ways[:, 1]]]
        led = np.bincount(ways[:, 0], minlength=count)
        itself = np.flatnonzero(led == 0)
        row, column = np.concatenate([np.stack([itself, itself], axis=1), ways]).T
        amid = sparse.csr_array((1.0 / np.maximum(led, 1)[row], (row, column)), shape=(count, count))
        return sparse.csr_array(incidence_of(np.arange(count), pairs) @ amid)

    def _wire(self, side: int) -> Underwire:
        root = self.root(side)
        free = ~self.control.fixed[root]
        rest = self.control.mesh.vertices[root[free]]
        return Underwire(self._place[root[free]], rest, self.wire_shape(side)[free], WIRE_STIFFNESS)


def _with_middles(values: Indices, fitted: ControlMesh) -> Floats:
    """Return rows or columns (m,) of a control mesh with those of the middles of its edges, (n,)."""
    return np.asarray(np.concatenate([values, values[fitted.mesh.edges].mean(axis=1)]))


def _strip_widths(mesh: Mesh, pairs: Indices) -> Floats:
    """Return how wide a strip of cloth each of ``pairs`` (s, 2) of neighbours stands for, (s,) [mm]."""
    area: dict[tuple[int, int], float] = {}
    for face, size in zip(mesh.faces.tolist(), mesh.face_areas.tolist(), strict=True):
        for pair in pairwise([*face, face[0]]):
            key = (min(pair), max(pair))
            area[key] = area.get(key, 0.0) + size
    rest = mesh.vertices
    # A square of two triangles lies between two strips of each direction: each has half of it on each side.
    return np.array(
        [area[min(a, b), max(a, b)] / np.linalg.norm(rest[a] - rest[b]) for a, b in pairs.tolist()]
    )
