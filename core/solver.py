"""Turns: one sweep to local balance, then the volume and the lengths are measured and the forces refreshed.

Paper section 5 tells the turn in words; the equations are ours. A sweep visits the free points in ascending
order and puts each where its members and the volume force balance, with the neighbours where they are now
(Gauss-Seidel). All member stiffnesses are constant during a run, so a whole sweep is one product with a lower
triangular inverse.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.linalg import solve_triangular

from core.control_mesh import ControlMesh
from core.lines import Line, line_on
from core.mesh import Floats, Indices, Points
from core.tensegric import TensegricModel, incidence_of, laplacian, tensegric_model
from core.volume import Pressure, VolumeMeasure, next_pressure, volume_measure

DEFAULT_LINE_STIFFNESS = 16.0
"""Stiffness of a line segment in units of the cables' mean stiffness at a point [1]; ours."""


@dataclass(frozen=True, eq=False)
class ConstrainedModel:
    """A tensegric model with its constraining lines and its volume: all that stays fixed during a run.

    ``lines`` are all lines, worn or only measured. ``pairs`` (s, 2) are the segments of the worn ones,
    ``owner`` (s,) the line of each, ``rest_spans`` (s, 3) [mm] their vectors at rest, ``line_stiffness`` (s,)
    [1] their Hooke stiffness (the same tape along a line), ``signs`` (s, f) their signed incidence on the
    free points.
    """

    tensegric: TensegricModel
    lines: tuple[Line, ...]
    volume: VolumeMeasure
    pairs: Indices
    owner: Indices
    rest_spans: Points
    line_stiffness: Floats
    signs: Floats

    @cached_property
    def stiffness(self) -> Floats:
        """Stiffness of cables and implicit line segments between free points, shape (f, f) [1]."""
        return self.tensegric.stiffness + self.line_laplacian

    @cached_property
    def line_laplacian(self) -> Floats:
        """The line segments' share of the stiffness, shape (f, f) [1]."""
        return laplacian(self.tensegric.place, self.pairs, self.line_stiffness)

    @cached_property
    def cable_hessian(self) -> Floats:
        """Second derivative of the cables' energy over the free coordinates, shape (3 f, 3 f) [1]."""
        return np.asarray(np.kron(self.tensegric.stiffness, np.eye(3)))

    @cached_property
    def line_scatter(self) -> sparse.csr_array:
        """The linear map from the segments' 3 x 3 blocks to a matrix over the free coordinates.

        Both lie there as rows: shapes (9 s,) and (9 f^2,).
        """
        segment, i, j = (at.ravel() for at in np.indices((len(self.pairs), *2 * (self.signs.shape[1],))))
        value = self.signs[segment, i] * self.signs[segment, j]
        segment, i, j, value = (array[value != 0.0] for array in (segment, i, j, value))
        a, b = (at.ravel()[None, :] for at in np.indices((3, 3)))
        size = 3 * self.signs.shape[1]
        rows = (3 * i[:, None] + a) * size + 3 * j[:, None] + b
        columns = 9 * segment[:, None] + 3 * a + b
        entries = (np.repeat(value, 9), (rows.ravel(), columns.ravel()))
        return sparse.csr_array(entries, shape=(size * size, 9 * len(self.pairs)))

    @cached_property
    def sweep(self) -> tuple[Floats, Floats]:
        """The sweep as two matrices (f, f): displacements are ``first @ old + second @ forces``."""
        lower = np.tril(self.stiffness)
        second = solve_triangular(lower, np.eye(len(lower)), lower=True)
        return second @ -np.triu(self.stiffness, 1), second

    @cached_property
    def rest_segments(self) -> Floats:
        """Lengths of the worn lines' segments at rest, shape (s,) [mm]."""
        return np.asarray(np.linalg.norm(self.rest_spans, axis=1))

    @cached_property
    def probe(self) -> float:
        """Volume change of one sweep per unit of pressure, dV/dP [mm^5], measured on a zero field (ours)."""
        a = self.volume.gradient(self.tensegric.rest)
        return float(np.sum(a * (self.sweep[1] @ a)))

    @property
    def pressure_unit(self) -> float:
        """The pressure that would change the whole volume by 100 % in one turn, linearised."""
        return self.volume.rest_volume / self.probe

    def natural_lengths(self, ratios: tuple[float, ...]) -> Floats:
        """Return the natural lengths of the worn segments for a ratio per line, shape (s,) [mm].

        Source: paper section 3.
        """
        return np.asarray(np.asarray(ratios)[self.owner] * self.rest_segments)

    def pull(self, points: Points, natural: Floats) -> Points:
        """Return the target shift of the line members summed at the free points, shape (f, 3).

        ``natural`` (s,) [mm] are the natural lengths; a segment aims at that length in its present direction.
        """
        spans = points[self.pairs[:, 0]] - points[self.pairs[:, 1]]
        length = np.sqrt(np.einsum("ij,ij->i", spans, spans))
        aim = spans * (natural / length)[:, None] - self.rest_spans
        return np.asarray(self.signs.T @ (self.line_stiffness[:, None] * aim))


def constrained_model(
    control: ControlMesh,
    *,
    worn: Collection[str] | None = None,
    back_lengths: Mapping[str, float] | None = None,
    line_stiffness: float = DEFAULT_LINE_STIFFNESS,
) -> ConstrainedModel:
    """Build the model of a control mesh with a line on each of its paths.

    ``worn`` names the lines that act (all of them if None), the others are only measured; ``back_lengths``
    [mm] see ``Line``.
    """
    tensegric = tensegric_model(control.mesh, control.fixed)
    backs = back_lengths or {}
    lines = tuple(
        line_on(name, path, control.mesh.vertices, tensegric.free, backs.get(name, 0.0))
        for name, path in control.paths.items()
    )
    columns = control.column[control.mesh.faces].sum(axis=1)
    volume = volume_measure(control.mesh, tensegric.free, columns > 0)
    return assemble(tensegric, lines, volume, control.paths if worn is None else worn, line_stiffness)


def assemble(
    tensegric: TensegricModel,
    lines: tuple[Line, ...],
    volume: VolumeMeasure,
    worn: Collection[str],
    line_stiffness: float = DEFAULT_LINE_STIFFNESS,
) -> ConstrainedModel:
    """Join the parts of a model.

    A line that is not worn, or lies on fixed points alone, is measured but does not pull.
    """
    unit = line_stiffness * tensegric.mean_stiffness
    pulling = [(index, line) for index, line in enumerate(lines) if line.constrains and line.name in worn]
    pairs = np.concatenate([np.empty((0, 2), dtype=np.int64), *(line.pairs for _, line in pulling)])
    return ConstrainedModel(
        tensegric,
        lines,
        volume,
        pairs,
        owner=np.repeat([i for i, _ in pulling], [len(line.pairs) for _, line in pulling]).astype(np.int64),
        rest_spans=tensegric.rest[pairs[:, 0]] - tensegric.rest[pairs[:, 1]],
        line_stiffness=np.concatenate(
            [np.empty(0), *(unit * line.rest_lengths.mean() / line.rest_lengths for _, line in pulling)]
        ),
        signs=incidence_of(tensegric.place, pairs),
    )


@dataclass(frozen=True)
class Targets:
    """All that can change while a run goes on: a ratio per line [1], volume control, gain [probe units]."""

    ratios: tuple[float, ...]
    control: str = "adaptive"
    gain: float = 1.5


@dataclass(frozen=True)
class Marks:
    """What is watched on the body: heights of the bust points, height and protrusion of the apex [mm]."""

    nipple_left_z: float
    nipple_right_z: float
    apex_z: float
    apex_protrusion: float


Watch = Callable[[Points], Marks]


@dataclass(frozen=True)
class Record:
    """The scalars of one turn: what plot, CSV and tests read.

    ``error`` is (V - V0) / V0 [1], negative when volume is missing; ``error_ml`` [ml]; ``step`` [mm] the
    largest move of a control point in this turn; ``lengths`` [mm] of the lines' front parts.
    """

    turn: int
    error: float
    error_ml: float
    step: float
    lengths: tuple[float, ...]
    marks: Marks | None = None


@dataclass(frozen=True, eq=False)
class State:
    """Where a run stands: displacements of the free points, shape (f, 3) [mm], and the turns made.

    ``pressure`` is that of the coming turn.
    """

    moved: Points
    pressure: Pressure = field(default_factory=Pressure)
    turn: int = 0


def at_rest(model: ConstrainedModel) -> State:
    """Return the state in which nothing has moved."""
    return State(np.zeros((len(model.tensegric.free), 3)))


def record(model: ConstrainedModel, state: State, step: float, watch: Watch | None = None) -> Record:
    """Measure a state."""
    points = model.tensegric.expand(state.moved)
    change = model.volume.volume(points) - model.volume.rest_volume
    return Record(
        state.turn,
        change / model.volume.rest_volume,
        change / 1000.0,
        step,
        tuple(line.length(points) for line in model.lines),
        watch(points) if watch else None,
    )


def turn(
    model: ConstrainedModel, targets: Targets, state: State, watch: Watch | None = None
) -> tuple[State, Record]:
    """Make one turn: every point to its local balance, then measure, then refresh the forces.

    Source: paper section 5.
    """
    first, second = model.sweep
    points = model.tensegric.expand(state.moved)
    forces = model.pull(points, model.natural_lengths(targets.ratios))
    if targets.control != "none":
        forces += (state.pressure.value * model.pressure_unit) * model.volume.gradient(points)
    moved = first @ state.moved + second @ forces
    step = float(
        np.sqrt(np.max(np.einsum("ij,ij->i", moved - state.moved, moved - state.moved), initial=0.0))
    )
    after = State(moved, state.pressure, state.turn + 1)
    measured = record(model, after, step, watch)
    pressure = next_pressure(targets.control, state.pressure, -measured.error, targets.gain)
    return State(moved, pressure, after.turn), measured


def iterate(
    model: ConstrainedModel,
    targets: Callable[[], Targets],
    state: State | None = None,
    *,
    turns: int,
    watch: Watch | None = None,
) -> Iterator[tuple[State, Record]]:
    """Yield up to ``turns`` turns; not asking for the next one is how to stop."""
    state = at_rest(model) if state is None else state
    for _ in range(turns):
        state, measured = turn(model, targets(), state, watch)
        yield state, measured
        if not np.isfinite(measured.error) or abs(measured.error) > 10.0:
            return


def gain_limit(model: ConstrainedModel) -> float:
    """Return the conventional gain above which small volume errors flip and grow (ours; probe units [1]).

    A turn is linear for small moves. On the brink the displacement d flips from turn to turn, so that old is
    -d and new is d, and its volume calls forth the very force that made it.
    """
    a = model.volume.gradient(model.tensegric.rest)
    u = model.rest_spans / model.rest_segments[:, None]
    # A line member resists only along itself; across, its target turns with it.
    across = np.eye(3) - u[:, :, None] * u[:, None, :]
    turning = model.line_scatter @ (model.line_stiffness[:, None, None] * across).ravel()
    flipped = np.kron(np.tril(model.stiffness) - np.triu(model.stiffness, 1), np.eye(3))
    d = np.linalg.solve(flipped + turning.reshape(flipped.shape), a.ravel())
    return model.probe / abs(float(a.ravel() @ d))
