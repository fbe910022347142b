"""Panels laid flat together, so that sides that are sewn to each other are equally long all along."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from types import MappingProxyType

import numpy as np
from scipy import sparse
from scipy.linalg import lu_factor, lu_solve

from core.blas_threads import one_blas_thread
from core.geometry.mesh import Floats, Indices, Points
from core.mechanics.banded_matrix import Solve
from core.pattern.cloth_energy import ClothLike
from core.pattern.flattening import FlatPanel, FlatProblem, HeldSolver
from core.pattern.mirroring import MirrorPair
from core.pattern.panel import Panel

NO_RATIOS: Mapping[tuple[str, int], float] = MappingProxyType({})

STRETCH = 15.0
"""Sides agree over each stretch of about this length [mm]; shorter ones only bend the outline."""

_REST = 4e-4
"""What would be left to go when the pieces are at rest [mm]."""

_AT_REST_TO_THE_EYE = 2e-3
"""The same while something is dragged [mm]."""

_GAIN = 0.2
"""Matrices serve again while each step is less than this part of the one before [1]."""

_RAISED = (0.0, *(1e-3 * 4.0**k for k in range(12)))
"""By how much the diagonal is raised where the matrix has no least, in parts of its mean [1]: ours."""

_LONGEST_STEP = 8.0
"""No point goes further in one turn [mm]."""

_MOST_TURNS = 40


@dataclass(frozen=True, eq=False)
class Seam:
    """Two sides that are sewn together: panels by number, and their points in the same order, (k,).

    The first is to be ``ratio`` times as long as the second: over 1 it is eased in or gathered. They agree
    over each ``stretch``, whose number each step from point to point has, (k - 1,).
    """

    name: str
    panels: tuple[int, int]
    sides: tuple[int, int]
    points: tuple[Indices, Indices]
    stretch: Indices
    ratio: float = 1.0


def seams_of(
    panels: Sequence[Panel], ratios: Mapping[tuple[str, int], float] = NO_RATIOS
) -> tuple[Seam, ...]:
    """Return each seam between ``panels`` once.

    ``ratios`` are those of the length of a side, by name of panel and its number there, to its partner's.
    """
    number = {panel.name: at for at, panel in enumerate(panels)}
    seams = []
    for at, panel in enumerate(panels):
        for side, own in enumerate(panel.sides):
            if own.partner is None or own.partner[0] not in number:
                continue
            other, other_side = number[own.partner[0]], own.partner[1]
            if (at, side) < (other, other_side):
                back = ratios.get((panels[other].name, other_side), 1.0)
                ratio = ratios.get((panel.name, side), 1.0 / back)
                points = own.points, panels[other].sides[other_side].points[::-1]
                stretch = _stretches(panel.start[own.points])
                seams.append(Seam(own.name, (at, other), (side, other_side), points, stretch, ratio))
    return tuple(seams)


@dataclass(frozen=True, eq=False)
class _EqualSides:
    """Two ``sides`` of equal length that are not sewn together, as left and right of a mirrored piece.

    Panels by number, and the points of both sides.
    """

    panels: tuple[int, int]
    points: tuple[Indices, Indices]


def _equal_sides(
    panels: Sequence[Panel], seams: Sequence[Seam], mirrors: Sequence[MirrorPair]
) -> Iterator[_EqualSides]:
    """Yield the sides of panels that are ``mirrors`` of each other, unless seams make them equal already."""
    group = {(at, side): (at, side) for at, panel in enumerate(panels) for side in range(len(panel.sides))}

    def first(key: tuple[int, int]) -> tuple[int, int]:
        while group[key] != key:
            key = group[key]
        return key

    for seam in seams:
        one, other = zip(seam.panels, seam.sides, strict=True)
        group[first(one)] = first(other)
    number = {panel.name: at for at, panel in enumerate(panels)}
    for pair in mirrors:
        left, right = number[pair.left], number[pair.right]
        for side, other_side in enumerate(pair.sides):
            one, other = first((left, side)), first((right, other_side))
            if one != other:
                group[one] = other
                points = panels[left].sides[side].points, panels[right].sides[other_side].points
                yield _EqualSides((left, right), points)


def _stretches(curve: Floats) -> Indices:
    """Divide the steps along ``curve`` (k, 2) into stretches of equal numbers."""
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    count = int(np.clip(round(float(steps.sum()) / STRETCH), 1, len(steps)))
    return np.arange(len(steps)) * count // len(steps)


@dataclass(frozen=True)
class SeamFit:
    """A seam: the lengths of both sides, flattened alone and together, after ease [mm].

    ``off`` is the largest difference that is left over one of its stretches [mm], the ratio taken into
    account. ``tension`` is the largest force along the first side by which it is made to agree, in units of
    stiffness times mm: positive where it is shortened.
    """

    seam: Seam
    alone: tuple[float, float]
    together: tuple[float, float]
    off: float
    tension: float

    @property
    def misfit(self) -> float:
        """Return by how much the first side is longer when flattened alone, in parts of the second [1]."""
        return self.alone[0] / (self.seam.ratio * self.alone[1]) - 1.0


@dataclass(frozen=True, eq=False)
class Matched:
    """Pieces ``flats`` that can be sewn along ``seams``, the sides of ``mirrors`` being equally long.

    ``tensions`` (c,) of all stretches, then of those sides, hold them so.
    """

    flats: tuple[FlatPanel, ...]
    seams: tuple[Seam, ...]
    mirrors: tuple[MirrorPair, ...]
    tensions: Floats
    _problem: FlatProblem
    _misfits: Floats
    _system: _System | None

    @property
    def off(self) -> float:
        """Return the largest difference of length that is left over a stretch of any seam [mm]."""
        return float(np.abs(self._misfits[: _count(self.seams)]).max(initial=0.0))

    @cached_property
    def alone(self) -> tuple[FlatPanel, ...]:
        """Return the pieces each flattened by itself: what seams cost is the difference of strain."""
        with one_blas_thread():
            return self._problem.results(self._problem.minimum(self._problem.joined(_worn(self.flats))))

    @cached_property
    def fits(self) -> tuple[SeamFit, ...]:
        """Return how each seam fits."""
        if not self.seams:
            return ()
        ends = np.cumsum([_count([seam]) for seam in self.seams])
        off, tensions = (np.split(each, ends)[:-1] for each in (self._misfits, self.tensions))
        parts = zip(self.seams, off, tensions, strict=True)
        fits = []
        for seam, left_over, tension in parts:
            (a, b), (side, other) = seam.panels, seam.sides
            alone, together = (
                (pieces[a].side_length(side), pieces[b].side_length(other))
                for pieces in (self.alone, self.flats)
            )
            largest = float(tension[np.abs(tension).argmax()])
            fits.append(SeamFit(seam, alone, together, float(np.abs(left_over).max()), largest))
        return tuple(fits)


def _count(seams: Sequence[Seam]) -> int:
    """Return the number of stretches of ``seams``."""
    return sum(int(seam.stretch[-1]) + 1 for seam in seams)


def _worn(pieces: Sequence[FlatPanel]) -> list[Floats]:
    return [piece.worn for piece in pieces]


def match(
    panels: Sequence[Panel],
    places: Sequence[Points],
    cloths: Sequence[ClothLike],
    seams: Sequence[Seam],
    former: Matched | None = None,
    mirrors: Sequence[MirrorPair] = (),
) -> Matched:
    """Lay ``panels`` whose points are at ``places``, each (p, 3) [mm], flat so that their ``seams`` fit.

    The sum of their work is the least at which each stretch of each seam is as long on both sides, after
    ease, and the sides of ``mirrors`` are of equal lengths. A ``former`` answer for the same panels and seams
    saves turns, and for the same mirrors matrices: while something is dragged the places are then right to
    about 0.002 mm, good for the eye. What is written is made without.
    """
    problem = FlatProblem.of(panels, places, cloths)
    equal = tuple(_equal_sides(panels, seams, mirrors))
    tensions = np.zeros(_count(seams) + len(equal))
    system = None
    with one_blas_thread():
        if former is None or not len(tensions):
            flat = problem.minimum(problem.joined(None if former is None else _worn(former.flats)))
        else:
            flat = problem.joined(_worn(former.flats))
            known = slice(len(tensions) if former.mirrors == tuple(mirrors) else _count(seams))
            tensions[known] = former.tensions[known]
            system = former._system if former.mirrors == tuple(mirrors) else None
        off = tensions
        if len(tensions):
            stretches = _Stretches.of(problem, seams, equal)
            flat, tensions, system = _together(problem, stretches, flat, tensions, system)
            off = stretches.misfits(flat)
    return Matched(problem.results(flat), tuple(seams), tuple(mirrors), tensions, problem, off, system)


@dataclass(frozen=True, eq=False)
class _Stretches:
    """The steps of all sides that are sewn: from point ``start`` to ``end`` of all panels, (e,).

    Step k belongs to stretch ``row`` and counts ``sign`` times; ``shrink`` (e, 2) is what ease makes of worn
    places. ``panel`` (e,) is each one's; ``count`` the number of stretches.
    """

    start: Indices
    end: Indices
    row: Indices
    sign: Floats
    shrink: Floats
    panel: Indices
    count: int

    @classmethod
    def of(cls, problem: FlatProblem, seams: Sequence[Seam], equal: Sequence[_EqualSides] = ()) -> _Stretches:
        """List the steps of ``seams``, then those of ``equal`` sides, each of which is one stretch."""
        starts, ends, rows, signs, panels, count = [], [], [], [], [], 0
        whole = [(each.panels, each.points, np.zeros(0, dtype=np.int64), 1.0) for each in equal]
        sewn = [(seam.panels, seam.points, seam.stretch, seam.ratio) for seam in seams]
        for both, sides, stretch, ratio in (*sewn, *whole):
            for panel, points, sign in zip(both, sides, (1.0, -ratio), strict=True):
                own = points + problem.points[panel].start
                steps = len(own) - 1
                starts.append(own[:-1])
                ends.append(own[1:])
                rows.append(count + (stretch if len(stretch) else np.zeros(steps, dtype=np.int64)))
                signs.append(np.full(steps, sign))
                panels.append(np.full(steps, panel))
            count += int(stretch.max(initial=0)) + 1
        panel_of = np.concatenate(panels)
        shrink = 1.0 / (1.0 + np.array([cloth.ease for cloth in problem.cloths]))
        start, end, row = (np.concatenate(each) for each in (starts, ends, rows))
        return cls(start, end, row, np.concatenate(signs), shrink[panel_of], panel_of, count)

    def steps(self, flat: Floats) -> tuple[Floats, Floats]:
        """Return direction (e, 2) and length (e,) [mm] of each step at ``flat`` (N, 2), after ease."""
        way = (flat[self.end] - flat[self.start]) * self.shrink
        length = np.maximum(np.linalg.norm(way, axis=1), 1e-9)
        return way / length[:, None], length

    def misfits(self, flat: Floats) -> Floats:
        """Return by how much the first side of each stretch is too long, (count,) [mm]."""
        lengths = self.sign * self.steps(flat)[1]
        return np.bincount(self.row, lengths, self.count).astype(np.float64, copy=False)

    def slopes(self, flat: Floats) -> sparse.csc_array:
        """Return the slopes of ``misfits`` by the places, (2 N, count)."""
        pull = self.steps(flat)[0] * self.shrink * self.sign[:, None]
        at = np.stack([2 * self.end, 2 * self.end + 1, 2 * self.start, 2 * self.start + 1])
        value = np.concatenate([pull.T, -pull.T])
        entries = (value.ravel(), (at.ravel(), np.tile(self.row, 4)))
        return sparse.csc_array(sparse.coo_array(entries, (2 * len(flat), self.count)))

    def add(self, problem: FlatProblem, panel: int, lower: Floats, flat: Floats, tensions: Floats) -> None:
        """Add to the lower band of a panel what ``tensions`` (count,) add as its steps turn."""
        own = self.panel == panel
        way, length = (each[own] for each in self.steps(flat))
        ahead = way[:, :, None] * way[:, None]
        force = (tensions[self.row] * self.sign)[own] / length
        part = force[:, None, None] * (np.eye(2) - ahead)
        part *= self.shrink[own, :, None] * self.shrink[own, None]
        both = [np.concatenate([part, -part], axis=2), np.concatenate([-part, part], axis=2)]
        ends = np.stack([self.start[own], self.end[own]], axis=1) - problem.points[panel].start
        band = problem.panels[panel].band.band
        place = band.place[(2 * ends[:, :, None] + np.arange(2)).reshape(-1, 4)]
        row, column = np.broadcast_arrays(place[:, :, None], place[:, None, :])
        below = row >= column
        at = column[below] * (band.reach + 1) + row[below] - column[below]
        np.add.at(lower, at, np.concatenate(both, axis=1)[below])


def _together(
    problem: FlatProblem, stretches: _Stretches, flat: Floats, tensions: Floats, system: _System | None
) -> tuple[Floats, Floats, _System | None]:
    """Return places (N, 2) [mm] and tensions of the least work under equal lengths, by Newton steps.

    ``system`` is that of a former answer, if there is one; the last one is returned.
    """
    rest, before = _REST if system is None else _AT_REST_TO_THE_EYE, np.inf
    for _ in range(_MOST_TURNS):
        state = problem.state(flat)
        cloth = state, problem.turned_slopes(state)
        pull = problem.slope(*cloth) + (stretches.slopes(flat) @ tensions).reshape(-1, 2)
        new = system is None
        if system is None:
            system = _System.at(problem, stretches, problem.blocks(*cloth), flat, tensions)
        step, change = system.step(pull, flat, stretches.misfits(flat))
        size = float(np.abs(step).max())
        if not new and size > before:
            system = None  # too old even for this step
            continue
        share = min(1.0, _LONGEST_STEP / max(size, 1e-12))
        flat, tensions = flat + share * step, tensions + share * change
        # The next step is of about the square of a Newton step; others shrink by the same part again.
        part = size if new and system.is_exact else size / before if np.isfinite(before) else 1.0
        if size * part < rest:
            break
        if min(part, size / before) >= _GAIN:
            system = None
        before = size
    return flat, tensions, system


def _solver(panel: Panel, lower: Floats, share: float) -> HeldSolver | None:
    """Return a solver of a panel's matrix, its diagonal raised by a ``share`` of its mean."""
    raised, diagonal = lower.copy(), panel.band.diagonal
    raised[diagonal] += share * np.abs(lower[diagonal]).mean()
    return HeldSolver.of(panel.band, raised, panel.grain)


@dataclass(frozen=True, eq=False)
class _System:
    """The matrices of all panels, held, and what their stretches make of them.

    ``slopes`` are each panel's of the stretches ``columns`` that it has, ``yields`` how its places give way
    to their tensions; ``tighten`` makes tensions of differences of length. It ``is_least`` where no direction
    that keeps all lengths is negative, and ``is_exact`` where nothing was raised for that.
    """

    points: tuple[slice, ...]
    solvers: list[HeldSolver]
    columns: list[Indices]
    slopes: list[Floats]
    yields: list[Floats]
    tighten: Solve
    is_least: bool
    is_exact: bool

    @classmethod
    def at(
        cls, problem: FlatProblem, stretches: _Stretches, blocks: Floats, flat: Floats, tensions: Floats
    ) -> _System:
        """Return the system at ``flat`` (N, 2) under ``tensions`` (c,); ``blocks`` are those of the cloth.

        Panels may have negative directions, as lengths that are held keep a piece from giving way. Where
        these do not suffice, the diagonal of such panels is raised.
        """
        slopes = sparse.csr_array(stretches.slopes(flat))
        lowers = problem.lowers(blocks)
        for panel, lower in enumerate(lowers):
            stretches.add(problem, panel, lower, flat, tensions)
        solvers: list[HeldSolver | None] = [None] * len(lowers)
        for share in _RAISED:
            solvers = [
                _solver(panel, lower, share) if known is None or known.negative else known
                for panel, lower, known in zip(problem.panels, lowers, solvers, strict=True)
            ]
            ready = [solver for solver in solvers if solver is not None]
            if (
                len(ready) == len(solvers)
                and (system := cls._of(problem, slopes, ready, share == 0.0)).is_least
            ):
                return system
        raise FloatingPointError("a matrix that cannot be raised")

    @classmethod
    def _of(
        cls, problem: FlatProblem, slopes: sparse.csr_array, solvers: list[HeldSolver], is_exact: bool
    ) -> _System:
        matrix = np.zeros((slopes.shape[1],) * 2)
        columns, parts, yields = [], [], []
        for points, solver in zip(problem.points, solvers, strict=True):
            own = slopes[2 * points.start : 2 * points.stop]
            which = np.unique(own.indices).astype(np.int64)
            part = own[:, which].toarray()
            given = solver(part)
            matrix[np.ix_(which, which)] += part.T @ given
            columns.append(which)
            parts.append(part)
            yields.append(given)
        negative = sum(solver.negative for solver in solvers)
        # By Sylvester's law of inertia, lengths that are held must take away each negative direction.
        is_least = negative == 0 or int((np.linalg.eigvalsh(matrix) < 0.0).sum()) == negative
        tighten = partial(lu_solve, lu_factor(matrix))
        return cls(problem.points, solvers, columns, parts, yields, tighten, is_least, is_exact)

    def step(self, pull: Floats, flat: Floats, off: Floats) -> tuple[Floats, Floats]:
        """Return the step (N, 2) and the change of tensions (c,) that end ``pull`` and ``off`` (c,)."""
        free = [
            solver(pull[rows], flat[rows]) for solver, rows in zip(self.solvers, self.points, strict=True)
        ]
        wanted = off.copy()
        for which, part, given in zip(self.columns, self.slopes, free, strict=True):
            wanted[which] -= part.T @ given.ravel()
        change = np.asarray(self.tighten(wanted))
        step = [
            -given - (yields @ change[which]).reshape(-1, 2)
            for given, yields, which in zip(free, self.yields, self.columns, strict=True)
        ]
        return np.concatenate(step), change
