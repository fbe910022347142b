"""What a cup does to control points, by its parts: a surface that holds back, cloth that pulls, a wire (ours).

Each is an energy of the displacements of the free points, shape (f, 3) [mm], with exact derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from core.geometry.mesh import Flags, Floats, Indices, Points, frozen
from core.mechanics.banded_matrix import Entries
from core.mechanics.springs import Springs, stretch_blocks


class CupPart(Protocol):
    """What a solid asks of a part of a cup."""

    @property
    def entries(self) -> Entries:
        """Return the positions of the values of ``figures`` in the second derivative."""

    def energy(self, moved: Points) -> float:
        """Return the energy [N mm]."""

    def gradient(self, moved: Points) -> Points:
        """Return its derivative, shape (f, 3) [N]: minus the force on the points."""

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative [N/mm]; ``clip`` leaves out what may make it indefinite."""

    def touching(self, moved: Points) -> Flags:
        """Return which points touch, where a part may come off; else nothing."""

    def bound(self, touching: Flags) -> Floats:
        """Return figures for an iteration, which depend on what touches alone."""


@dataclass(frozen=True, eq=False)
class SmoothSurface:
    """A smooth surface along ``nodes`` (m, 3) [mm], with outward ``normals`` (m, 3) there.

    Its distance function is a mean, with Gaussian weights of standard deviation ``reach`` [mm], of those to
    the planes at its nodes. Source: Shen, O'Brien and Shewchuk 2004.
    """

    nodes: Points
    normals: Points
    reach: float

    def distance(self, places: Points) -> tuple[Floats, Points, Floats]:
        """Return how far places (k, 3) lie outside, shape (k,) [mm], with first and second derivatives."""
        away = ((places[:, None, :] - self.nodes) ** 2).sum(axis=2)
        weight = np.exp(-0.5 * (away - away.min(axis=1, keepdims=True)) / self.reach**2)
        share = weight / weight.sum(axis=1, keepdims=True)
        plane = places @ self.normals.T - np.einsum("ij,ij->i", self.normals, self.nodes)
        out = np.einsum("ij,ij->i", share, plane)
        side = (self.nodes[None] - (share @ self.nodes)[:, None]) / self.reach**2
        weighed = share[:, :, None] * side
        uneven = plane - out[:, None]
        slope = share @ self.normals + np.einsum("km,kma->ka", uneven, weighed)
        turn = np.einsum("ma,kmb->kab", self.normals, weighed)
        bend = turn + turn.transpose(0, 2, 1) + np.einsum("km,kma,kmb->kab", uneven, weighed, side)
        return out, slope, bend


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

    @cached_property
    def entries(self) -> Entries:
        """Return the positions of a block of each point."""
        return _blocks_of(self.points)

    @cached_property
    def _level(self) -> Floats:
        return frozen(self.surface.distance(self.target)[0])

    def _gaps(self, moved: Points) -> tuple[Floats, Points, Floats]:
        """Return how far each point lies outside, shape (c,) [mm], with first and second derivatives."""
        out, slope, bend = self.surface.distance(self.rest + moved[self.points])
        return out - self._level, slope, bend

    def forces(self, moved: Points) -> Floats:
        """Return how hard the surface presses on each point, shape (c,) [N]."""
        return self.stiffness * np.maximum(self._gaps(moved)[0], 0.0)

    def energy(self, moved: Points) -> float:
        """Return the energy [N mm]."""
        return 0.5 * self.stiffness * float(np.sum(np.maximum(self._gaps(moved)[0], 0.0) ** 2))

    def gradient(self, moved: Points) -> Points:
        """Return its derivative, shape (f, 3) [N]."""
        out, slope, _ = self._gaps(moved)
        gradient = np.zeros_like(moved)
        gradient[self.points] = self.stiffness * np.maximum(out, 0.0)[:, None] * slope
        return gradient

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative as a block for each point, (9 c,) [N/mm]."""
        out, slope, bend = self._gaps(moved)
        blocks = (out > 0.0)[:, None, None] * (slope[:, :, None] * slope[:, None, :])
        if not clip:
            blocks = blocks + np.maximum(out, 0.0)[:, None, None] * bend
        return np.asarray(self.stiffness * blocks.ravel())

    def touching(self, moved: Points) -> Flags:
        """Return which points touch, shape (c,)."""
        return self._gaps(moved)[0] > 0.0

    def bound(self, touching: Flags) -> Floats:
        """Return the blocks of the points that touch, as the surface lies at their rest."""
        slope = self.surface.distance(self.rest)[1] * touching[:, None]
        return np.asarray(self.stiffness * (slope[:, :, None] * slope[:, None, :]).ravel())


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

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return the second derivative as a block for each strip, (9 s,) [N/mm]."""
        spans, lengths = self.strips.spans(moved)
        across = self.strips.stiffness * self._stretch(lengths) / lengths
        along = self.strips.stiffness * (lengths > self.natural)
        return stretch_blocks(spans / lengths[:, None], along, across).ravel()

    def touching(self, moved: Points) -> Flags:
        """Return nothing: what the cloth adds to an iteration does not depend on it."""
        return np.zeros(0, dtype=np.bool_)

    def bound(self, touching: Flags) -> Floats:
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

    def figures(self, moved: Points, clip: bool) -> Floats:
        """Return 1: the second derivative is constant."""
        return np.ones(1)

    def touching(self, moved: Points) -> Flags:
        """Return nothing: a wire never comes off."""
        return np.zeros(0, dtype=np.bool_)

    def bound(self, touching: Flags) -> Floats:
        """Return 1 as well."""
        return np.ones(1)


def _blocks_of(points: Indices) -> Entries:
    """Return the positions of a block (3, 3) for each of ``points`` (c,)."""
    a, b = (axis.ravel()[None, :] for axis in np.indices((3, 3)))
    row, column = 3 * points[:, None] + a, 3 * points[:, None] + b
    return Entries(
        row.ravel(), column.ravel(), np.arange(9 * len(points)), np.ones(9 * len(points)), 9 * len(points)
    )
