"""Parts of a cup that act on control points: a surface that holds back, cloth that pulls, a wire (ours).

Each is an energy of the displacements of the free points, shape (f, 3) [mm], with exact derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from core.geometry.mesh import Floats, Indices, Points, frozen
from core.mechanics.banded_matrix import Entries
from core.mechanics.springs import Springs, stretch_blocks

NEAR = 1.0
"""An iteration answers to a point as if it were no farther outside a cup than this [mm]."""


_ROUNDS = 4
"""So often are the planes of a smooth surface moved towards its nodes."""


class CupPart(Protocol):
    """What a solid asks of a part of a cup."""

    @property
    def entries(self) -> Entries:
        """Return the positions of the values of ``figures`` in the second derivative."""

    def energy(self, moved: Points) -> float:
        """Return the energy [N mm]."""

    def gradient(self, moved: Points) -> Points:
        """Return its derivative, shape (f, 3) [N]: minus the force on the points."""

    def limited_gradient(self, moved: Points) -> Points:
        """Return the derivative, shape (f, 3) [N], no larger than an iteration can answer to."""

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative [N/mm]; ``clip`` leaves out what may make it indefinite."""

    def contacts(self, moved: Points) -> Points:
        """Return the direction out at each point that may touch, 0 where it does not, (c, 3) [1]."""

    def bound(self, contacts: Points) -> Floats:
        """Return figures for an iteration, which depend on ``contacts`` (c, 3) alone."""


@dataclass(frozen=True, eq=False)
class SmoothSurface:
    """A smooth surface along ``nodes`` (m, 3) [mm], with outward ``normals`` (m, 3) there.

    Its distance function is a mean, with Gaussian weights of standard deviation ``reach`` [mm], of those to
    the planes at its nodes, moved so that a few steps bring it near all nodes wherever the surface bends.
    Source: Shen, O'Brien and Shewchuk 2004.
    """

    nodes: Points
    normals: Points
    reach: float

    @cached_property
    def offsets(self) -> Floats:
        """Return how far the plane of each node is moved outward, shape (m,) [mm]."""
        offsets = np.zeros(len(self.nodes))
        for _ in range(_ROUNDS):
            offsets = offsets + self._distance(self.nodes, offsets).out
        return frozen(offsets)

    def distance(self, places: Points) -> SurfaceDistance:
        """Return how far places (k, 3) [mm] lie outside."""
        return self._distance(places, self.offsets)

    def _distance(self, places: Points, offsets: Floats) -> SurfaceDistance:
        away = (places**2).sum(axis=1)[:, None] - 2.0 * places @ self.nodes.T + (self.nodes**2).sum(axis=1)
        weight = np.exp(-0.5 * (away - away.min(axis=1, keepdims=True)) / self.reach**2)
        share = weight / weight.sum(axis=1, keepdims=True)
        plane = places @ self.normals.T - np.einsum("ij,ij->i", self.normals, self.nodes) - offsets
        return SurfaceDistance(self, share, plane)


@dataclass(frozen=True, eq=False)
class SurfaceDistance:
    """How far places lie outside a surface, with derivatives.

    ``share`` (k, m) [1] is the weight of each node at each place, ``plane`` (k, m) [mm] the distance from its
    plane.
    """

    surface: SmoothSurface
    share: Floats
    plane: Floats

    @cached_property
    def out(self) -> Floats:
        """Return the distance, shape (k,) [mm]."""
        return np.asarray(np.einsum("ij,ij->i", self.share, self.plane))

    @cached_property
    def _side(self) -> Floats:
        """Return the slopes of the logarithms of the shares, shape (k, m, 3) [1/mm]."""
        nodes = self.surface.nodes
        return np.asarray((nodes - (self.share @ nodes)[:, None]) / self.surface.reach**2)

    @cached_property
    def _uneven(self) -> Floats:
        return self.share * (self.plane - self.out[:, None])

    @cached_property
    def slope(self) -> Points:
        """Return the first derivative, shape (k, 3) [1]."""
        return self.share @ self.surface.normals + (self._uneven[:, None] @ self._side)[:, 0]

    @cached_property
    def bend(self) -> Floats:
        """Return the second derivative, shape (k, 3, 3) [1/mm]."""
        turn = (self.share[:, None] * self.surface.normals.T) @ self._side
        spread = (self._uneven[:, :, None] * self._side).transpose(0, 2, 1) @ self._side
        return np.asarray(turn + turn.transpose(0, 2, 1) + spread)


@dataclass(frozen=True, eq=False)
class CupContact:
    """A surface, fixed in space, that holds points back which come to lie outside it, without friction.

    ``points`` (c,) are free points by their row and ``rest`` (c, 3) [mm] their places; each may lie as far
    out as ``target`` (c, 3) [mm], its place in the cup. ``stiffness`` [N/mm] is that of the cup at a point.
    """

    points: Indices
    rest: Points
    target: Points
    surface: SmoothSurface
    stiffness: float
    _last: list[Any] = field(default_factory=list, init=False, repr=False)

    @cached_property
    def entries(self) -> Entries:
        """Return the positions of a block of each point."""
        return _blocks_of(self.points)

    @cached_property
    def _level(self) -> Floats:
        return frozen(self.surface.distance(self.target).out)

    def _at(self, moved: Points) -> tuple[Floats, SurfaceDistance]:
        """Return how far each point lies outside, shape (c,) [mm]: not less than 0."""
        if self._last[:1] != [id(moved)]:
            there = self.surface.distance(self.rest + moved[self.points])
            # Energy, slope and second derivative are asked for one after the other, with the same array.
            self._last[:] = id(moved), moved, np.maximum(there.out - self._level, 0.0), there
        return self._last[2], self._last[3]

    def forces(self, moved: Points) -> Floats:
        """Return how hard the surface presses on each point, shape (c,) [N]."""
        return self.stiffness * self._at(moved)[0]

    def energy(self, moved: Points) -> float:
        """Return the energy [N mm]."""
        return 0.5 * self.stiffness * float(np.sum(self._at(moved)[0] ** 2))

    def gradient(self, moved: Points) -> Points:
        """Return its derivative, shape (f, 3) [N]."""
        out, there = self._at(moved)
        gradient = np.zeros_like(moved)
        gradient[self.points] = self.stiffness * out[:, None] * there.slope
        return gradient

    def limited_gradient(self, moved: Points) -> Points:
        """Return the derivative, shape (f, 3) [N], as of a point no farther out than ``NEAR``."""
        out, there = self._at(moved)
        steep = np.sqrt(np.einsum("ij,ij->i", there.slope, there.slope))
        gradient = np.zeros_like(moved)
        held = np.where(out > NEAR, NEAR / steep, out)
        gradient[self.points] = self.stiffness * held[:, None] * there.slope
        return gradient

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative as a block for each point, (9 c,) [N/mm]."""
        out, there = self._at(moved)
        blocks = (out > 0.0)[:, None, None] * (there.slope[:, :, None] * there.slope[:, None, :])
        if not clip:
            blocks = blocks + out[:, None, None] * there.bend
        return np.asarray(self.stiffness * blocks.ravel())

    def contacts(self, moved: Points) -> Points:
        """Return the direction out at each point, 0 where it does not touch, shape (c, 3) [1]."""
        out, there = self._at(moved)
        return np.asarray((out > 0.0)[:, None] * there.slope)

    def bound(self, contacts: Points) -> Floats:
        """Return the blocks of the points that touch."""
        return np.asarray(self.stiffness * (contacts[:, :, None] * contacts[:, None, :]).ravel())


@dataclass(frozen=True, eq=False)
class CupCloth:
    """Cloth of a cup as strips both ways, which pull when longer than ``natural`` (s,) [mm]; none pushes."""

    strips: Springs
    natural: Floats

    @cached_property
    def entries(self) -> Entries:
        """Return the positions of a block of each strip."""
        return self.strips.entries

    def _stretch(self, lengths: Floats) -> Floats:
        return np.maximum(lengths - self.natural, 0.0)

    def tensions(self, moved: Points) -> Floats:
        """Return the tension of each strip, shape (s,) [N]."""
        return np.asarray(self.strips.stiffness * self._stretch(self.strips.spans(moved)[1]))

    def energy(self, moved: Points) -> float:
        """Return the energy [N mm]."""
        longer = self._stretch(self.strips.spans(moved)[1])
        return 0.5 * float(self.strips.stiffness @ (longer * longer))

    def gradient(self, moved: Points) -> Points:
        """Return its derivative, shape (f, 3) [N]."""
        spans, lengths = self.strips.spans(moved)
        return self.strips.sum((self.strips.stiffness * self._stretch(lengths) / lengths)[:, None] * spans)

    def limited_gradient(self, moved: Points) -> Points:
        """Return the derivative, shape (f, 3) [N]."""
        return self.gradient(moved)

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative as a block for each strip, (9 s,) [N/mm]."""
        spans, lengths = self.strips.spans(moved)
        across = self.strips.stiffness * self._stretch(lengths) / lengths
        along = self.strips.stiffness * (lengths > self.natural)
        return stretch_blocks(spans / lengths[:, None], along, across).ravel()

    def contacts(self, moved: Points) -> Points:
        """Return nothing: what the cloth adds to an iteration does not depend on it."""
        return np.empty((0, 3))

    def bound(self, contacts: Points) -> Floats:
        """Return the blocks of strips that all pull, the upper bound."""
        stiff = self.strips.stiffness
        return stretch_blocks(
            self.strips.rest_spans / self.strips.rest_lengths[:, None], stiff, stiff
        ).ravel()


@dataclass(frozen=True, eq=False)
class Underwire:
    """A rigid curve that ``points`` (w,) follow, free to move and turn as a whole (small turns).

    ``shape`` (w, 3) [mm] is where its own form has the points, less where they rest at ``rest`` (w, 3) [mm];
    ``stiffness`` [N/mm] holds each to it.
    """

    points: Indices
    rest: Points
    shape: Points
    stiffness: float

    @cached_property
    def _matrix(self) -> Floats:
        """Return the second derivative over the points' coordinates, (3 w, 3 w): no rigid motion in it."""
        arm = self.rest - self.rest.mean(axis=0)
        turns = [np.cross(axis, arm).ravel() for axis in np.eye(3)]
        rigid = np.stack([*(np.tile(axis, len(arm)) for axis in np.eye(3)), *turns], axis=1)
        basis, _ = np.linalg.qr(rigid)
        return frozen(self.stiffness * (np.eye(len(basis)) - basis @ basis.T))

    @cached_property
    def entries(self) -> Entries:
        """Return the positions of the second derivative, one figure that is 1."""
        at = (3 * self.points[:, None] + np.arange(3)).ravel()
        row, column = np.repeat(at, len(at)), np.tile(at, len(at))
        return Entries(row, column, np.zeros(len(row), dtype=np.int64), self._matrix.ravel(), 1)

    def _off(self, moved: Points) -> Floats:
        return (moved[self.points] - self.shape).ravel()

    def forces(self, moved: Points) -> Points:
        """Return what the wire does to each of its points, shape (w, 3) [N]."""
        return -(self._matrix @ self._off(moved)).reshape(-1, 3)

    def energy(self, moved: Points) -> float:
        """Return the energy [N mm]."""
        off = self._off(moved)
        return 0.5 * float(off @ (self._matrix @ off))

    def gradient(self, moved: Points) -> Points:
        """Return its derivative, shape (f, 3) [N]."""
        gradient = np.zeros_like(moved)
        gradient[self.points] = -self.forces(moved)
        return gradient

    def limited_gradient(self, moved: Points) -> Points:
        """Return the derivative, shape (f, 3) [N]."""
        return self.gradient(moved)

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return 1: the second derivative is constant."""
        return np.ones(1)

    def contacts(self, moved: Points) -> Points:
        """Return nothing: a wire never comes off."""
        return np.empty((0, 3))

    def bound(self, contacts: Points) -> Floats:
        """Return 1 as well."""
        return np.ones(1)


def _blocks_of(points: Indices) -> Entries:
    """Return the positions of a block (3, 3) for each of ``points`` (c,)."""
    a, b = (axis.ravel()[None, :] for axis in np.indices((3, 3)))
    row, column = 3 * points[:, None] + a, 3 * points[:, None] + b
    return Entries(
        row.ravel(), column.ravel(), np.arange(9 * len(points)), np.ones(9 * len(points)), 9 * len(points)
    )
