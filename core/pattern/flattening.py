"""Panels laid flat with the least elastic work, turned by their grain line, and the strain that is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from core.blas_threads import one_blas_thread
from core.geometry.mesh import Faces, Floats, Indices, Points
from core.mechanics.banded_matrix import Solve
from core.pattern.cloth_energy import ClothLike, ClothState, stiffness_matrix
from core.pattern.panel import Panel
from core.pattern.plane_maps import PlaneBand, TriangleSlopes, jacobians, triangle_slopes

TOLERANCE = 1e-3
"""The step after which a piece is at rest [mm]: with an old matrix the next is less than a fifth of it."""

_NEARLY = 0.02
"""The same with a new matrix [mm]: the next step is of about its square."""

_GAIN = 0.2
"""A matrix serves again while each step is less than this part of the one before [1]."""

_MOST_TURNS = 40


@dataclass(frozen=True, eq=False)
class FlatPanel:
    """A ``panel`` laid flat.

    ``worn`` (p, 2) [mm]: places before ease, the grain line up, x to the right of somebody who sees the
    panel from outside. ``areas`` (m,) [mm^2] and ``stretch`` (m, 3), xx, yy and xy [1]: flat by worn lengths
    of each triangle, in the axes of the cloth. ``ease`` across and down.
    """

    panel: Panel
    worn: Floats
    areas: Floats
    stretch: Floats
    ease: tuple[float, float]

    @cached_property
    def points(self) -> Floats:
        """Return the places to cut, after ease, (p, 2) [mm]."""
        return np.asarray(self.worn / (1.0 + np.array(self.ease)))

    @cached_property
    def strains(self) -> Floats:
        """Return how far the worn cloth is stretched, before ease, xx, yy and xy, (m, 3) [1]."""
        x, y, xy = self.stretch.T
        det = x * y - xy**2
        return np.stack([y / det - 1.0, x / det - 1.0, -xy / det], axis=1)

    @cached_property
    def largest(self) -> Floats:
        """Return the strain before ease that is furthest from 0 in any direction of a triangle, (m,) [1]."""
        x, y, xy = self.strains.T
        mean, radius = 0.5 * (x + y), np.hypot(0.5 * (x - y), xy)
        return np.asarray(np.where(mean >= 0.0, mean + radius, mean - radius))

    @cached_property
    def totals(self) -> Floats:
        """Return how far the cloth is stretched when worn, with its ease, across and down, (m, 2) [1]."""
        return np.asarray((1.0 + self.strains[:, :2]) * (1.0 + np.array(self.ease)) - 1.0)

    @property
    def is_folded(self) -> bool:
        """Return whether a triangle lies upside down."""
        x, y, xy = self.stretch.T
        return bool((x * y <= xy**2).any())

    @cached_property
    def outline(self) -> Indices:
        """Return the points round the piece, counter-clockwise, the first not repeated, (b,)."""
        return np.concatenate([side.points[:-1] for side in self.panel.sides])

    @property
    def overlaps(self) -> bool:
        """Return whether the outline crosses itself."""
        return crosses_itself(self.points[self.outline])

    def side_length(self, side: int) -> float:
        """Return the length of a side after ease [mm]."""
        steps = np.diff(self.points[self.panel.sides[side].points], axis=0)
        return float(np.linalg.norm(steps, axis=1).sum())


@dataclass(frozen=True)
class StrainSummary:
    """Strain of a piece before ease [1]: ``mean`` of its amount, ``within`` for 95 % of its area.

    ``compressed`` and ``stretched`` are the extremes, ``over`` the share of the area over a limit.
    """

    mean: float
    within: float
    compressed: float
    stretched: float
    over: float


def strain_summary(flat: FlatPanel, limit: float = np.inf) -> StrainSummary:
    """Return what is said of the strain of a piece whose cloth takes up ``limit`` [1] either way."""
    amount, share = np.abs(flat.largest), flat.areas / flat.areas.sum()
    order = np.argsort(amount)
    within = amount[order][np.searchsorted(np.cumsum(share[order]), 0.95 - 1e-12)]
    return StrainSummary(
        float(amount @ share),
        float(within),
        float(min(flat.largest.min(), 0.0)),
        float(max(flat.largest.max(), 0.0)),
        float(share[amount > limit].sum()),
    )


def flatten(panel: Panel, places: Points, cloth: ClothLike, start: Floats | None = None) -> FlatPanel:
    """Lay a ``panel`` whose points are at ``places`` (p, 3) [mm] flat; see ``flatten_all``."""
    return flatten_all([panel], [places], [cloth], None if start is None else [start])[0]


def flatten_all(
    panels: Sequence[Panel],
    places: Sequence[Points],
    cloths: Sequence[ClothLike],
    starts: Sequence[Floats] | None = None,
) -> tuple[FlatPanel, ...]:
    """Lay each of ``panels`` flat by itself, from ``starts``, each (p, 2) [mm], such as a former ``worn``."""
    problem = FlatProblem.of(panels, places, cloths)
    with one_blas_thread():
        return problem.results(problem.minimum(problem.joined(starts)))


@dataclass(frozen=True, eq=False)
class HeldSolver:
    """Solves a panel's matrix while its mean place and its grain line are held.

    The matrix alone lets the piece move and turn: it is solved with three coordinates pinned, which is then
    taken back exactly. ``rows`` (6, 2 p) are the conditions and the pins; each miss of them is taken back by
    ``found`` (2 p, 6). In ``negative`` directions the work falls while it is held.
    """

    solve: Solve
    rows: Floats
    found: Floats
    negative: int

    @classmethod
    def of(cls, band: PlaneBand, lower: Floats, grain: Floats) -> HeldSolver | None:
        """Prepare the matrix with this ``lower`` band, which is overwritten; ``grain`` (p,) is to point up.

        None if it is singular. Raises FloatingPointError if it is not finite.
        """
        top, bottom = int(grain.argmax()), int(grain.argmin())
        pins = [2 * top, 2 * top + 1, 2 * bottom]
        pin = float(np.abs(lower[band.diagonal]).mean())
        if not np.isfinite(pin):
            raise FloatingPointError("a matrix that is not finite")
        lower[band.diagonal[pins]] += pin
        solve, negative = band.band.cholesky(lower), 0
        if solve is None:
            factor = band.band.indefinite(lower)
            if factor is None:
                return None
            solve, negative = factor
        rows = np.zeros((6, 2 * len(grain)))
        rows[0, ::2] = rows[1, 1::2] = 1.0 / len(grain)
        rows[2, ::2] = grain / np.abs(grain).sum()
        rows[[3, 4, 5], pins] = 1.0
        found = solve(rows.T)
        small = rows @ found - np.diag(np.repeat([0.0, 1.0 / pin], 3))
        # By Sylvester's law of inertia: three are those of the conditions.
        negative += int((np.linalg.eigvalsh(0.5 * (small + small.T)) > 0.0).sum()) - 3
        return cls(solve, rows, found @ np.linalg.inv(small), negative)

    @classmethod
    def raised(cls, band: PlaneBand, lower: Floats, grain: Floats) -> HeldSolver:
        """Prepare the same with a diagonal that is raised until no direction is negative."""
        raised = 1e-4 * float(np.abs(lower[band.diagonal]).mean())
        while (solver := cls.of(band, lower.copy(), grain)) is None or solver.negative:
            lower[band.diagonal] += raised
            raised *= 4.0
        return solver

    def __call__(self, right: Floats, off: Floats | None = None) -> Floats:
        """Return what the matrix makes ``right`` (p, 2) or (2 p, k) of, with the conditions of ``off``.

        Without ``off`` (p, 2) they are 0. The result has the shape of ``right``.
        """
        columns = right.reshape(self.rows.shape[1], -1)
        solution = self.solve(columns)
        miss = self.rows @ solution
        if off is not None:
            miss[:3] -= self.rows[:3] @ off.reshape(-1, 1)
        return np.asarray((solution - self.found @ miss).reshape(right.shape))


@dataclass(frozen=True, eq=False)
class FlatProblem:
    """The work of several panels at once; points and triangles of all are one array each, N and M long.

    ``points`` and ``triangles`` are the rows of each panel; ``stiffness`` (M, 3, 3).
    """

    panels: tuple[Panel, ...]
    cloths: tuple[ClothLike, ...]
    faces: Faces
    surface: TriangleSlopes
    stiffness: Floats
    points: tuple[slice, ...]
    triangles: tuple[slice, ...]

    @classmethod
    def of(
        cls, panels: Sequence[Panel], places: Sequence[Points], cloths: Sequence[ClothLike]
    ) -> FlatProblem:
        """Prepare ``panels`` whose points are at ``places`` of the body."""
        points = _rows([len(panel.start) for panel in panels])
        triangles = _rows([len(panel.faces) for panel in panels])
        faces = np.concatenate([panel.faces + at.start for panel, at in zip(panels, points, strict=True)])
        surface = triangle_slopes(np.concatenate(places), faces)
        stiffness = np.repeat(
            [stiffness_matrix(cloth) for cloth in cloths], [len(panel.faces) for panel in panels], axis=0
        )
        return cls(tuple(panels), tuple(cloths), faces, surface, stiffness, points, triangles)

    def joined(self, starts: Sequence[Floats] | None) -> Floats:
        """Return the ``starts`` of all panels, or their first guesses, as one array (N, 2)."""
        return np.concatenate([panel.start for panel in self.panels] if starts is None else list(starts))

    def state(self, flat: Floats) -> ClothState:
        """Return the cloth at ``flat`` (N, 2) [mm]."""
        return ClothState.of(jacobians(flat, self.faces, self.surface), self.stiffness)

    def work(self, state: ClothState) -> Floats:
        """Return the work of each panel."""
        return np.add.reduceat(state.density * self.surface.areas, [at.start for at in self.triangles])

    def turned_slopes(self, state: ClothState) -> Floats:
        """Return the slopes of the hat functions turned as their triangles are, (M, 3, 2)."""
        c, s = state.cosine[:, None], state.sine[:, None]
        x, y = self.surface.slopes[..., 0], self.surface.slopes[..., 1]
        return np.stack([c * x - s * y, s * x + c * y], axis=2)

    def slope(self, state: ClothState, turned: Floats) -> Floats:
        """Return the slope of the work by the places, (N, 2)."""
        pull = turned @ (state.slope() * self.surface.areas[:, None, None]).transpose(0, 2, 1)
        count = self.points[-1].stop
        return np.stack(
            [np.bincount(self.faces.ravel(), pull[..., axis].ravel(), count) for axis in (0, 1)], axis=1
        )

    def blocks(self, state: ClothState, turned: Floats) -> Floats:
        """Return the second derivatives of the work of each triangle, (M, 6, 6)."""
        curvature = state.curvature(self.stiffness) * self.surface.areas[:, None, None]
        parts = np.zeros((len(self.faces), 3, 2, 2, 2))
        parts[:, :, 0, 0] = parts[:, :, 1, 1] = turned
        by_place = parts.reshape(-1, 6, 4)
        return np.asarray(by_place @ curvature @ by_place.transpose(0, 2, 1))

    def lowers(self, blocks: Floats) -> list[Floats]:
        """Return the lower band of each panel's matrix, made of ``blocks`` (M, 6, 6)."""
        return [
            panel.band.lower(blocks[rows]) for panel, rows in zip(self.panels, self.triangles, strict=True)
        ]

    def minimum(self, flat: Floats) -> Floats:
        """Return the places of the least work near ``flat`` (N, 2) [mm], by Newton steps."""
        state, solvers, before = self.state(flat), None, np.inf
        work = self.work(state)
        for _ in range(_MOST_TURNS):
            turned = self.turned_slopes(state)
            new = solvers is None
            if solvers is None:
                lowers = self.lowers(self.blocks(state, turned))
                solvers = [
                    HeldSolver.raised(panel.band, lower, panel.grain)
                    for panel, lower in zip(self.panels, lowers, strict=True)
                ]
            slope = self.slope(state, turned)
            step = -np.concatenate(
                [solver(slope[rows], flat[rows]) for solver, rows in zip(solvers, self.points, strict=True)]
            )
            flat, state, work = self._accepted(flat, step, work)
            size = float(np.abs(step).max())
            if size < (_NEARLY if new else TOLERANCE):
                break
            solvers, before = (solvers, size) if size < _GAIN * before else (None, size)
        return flat

    def _accepted(self, flat: Floats, step: Floats, work: Floats) -> tuple[Floats, ClothState, Floats]:
        """Take ``step``, halved for each panel until its ``work`` does not rise."""
        length = np.ones(len(self.panels))
        counts = [at.stop - at.start for at in self.points]
        for _ in range(10):
            taken = flat + np.repeat(length, counts)[:, None] * step
            state = self.state(taken)
            after = self.work(state)
            worse = after > work * (1.0 + 1e-9) + 1e-9 * self.scale
            if not worse.any():
                break
            length[worse] *= 0.5
        return taken, state, after

    @cached_property
    def scale(self) -> Floats:
        """Return the work of each panel at a strain of 0.1 %: less does not matter."""
        return np.add.reduceat(
            self.surface.areas * self.stiffness[:, 0, 0] * 1e-6, [at.start for at in self.triangles]
        )

    def results(self, flat: Floats) -> tuple[FlatPanel, ...]:
        """Return the pieces at ``flat`` (N, 2)."""
        stretch = self.state(flat).stretch
        return tuple(
            FlatPanel(panel, flat[rows], self.surface.areas[own], stretch[own], cloth.ease)
            for panel, cloth, rows, own in zip(
                self.panels, self.cloths, self.points, self.triangles, strict=True
            )
        )


def _rows(counts: list[int]) -> tuple[slice, ...]:
    ends = np.cumsum([0, *counts]).tolist()
    return tuple(slice(start, end) for start, end in pairwise(ends))


def crosses_itself(outline: Floats) -> bool:
    """Return whether the closed polygon ``outline`` (b, 2) crosses itself."""
    a, b = outline, np.roll(outline, -1, axis=0)

    def side(start: Floats, end: Floats, place: Floats) -> Floats:
        way, to = (end - start)[:, None], place[None] - start[:, None]
        return np.asarray(way[..., 0] * to[..., 1] - way[..., 1] * to[..., 0])

    first, second = side(a, b, a), side(a, b, b)
    splits = first * second < 0.0
    return bool((splits & splits.T).any())
