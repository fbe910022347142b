"""Small shapes whose answers are known by hand or by symmetry."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.document.design import Design, ScanSource
from core.geometry.mesh import Mesh, frozen
from core.mechanics.constraint_lines import line_on
from core.mechanics.iteration import LineTargets, Record, SolverState, iterate
from core.mechanics.model import ConstrainedModel, assemble
from core.mechanics.options import ModelOptions
from core.mechanics.tensegrity import TensegrityModel, tensegrity_model
from core.mechanics.volume import volume_measure
from core.pipeline import build as pipeline

SAMPLES = Path(__file__).parents[2] / "resources" / "samples"
TORSO_LINES = ("under-bust", "mid-bust", "full-bust")


def torso(skew: float = 0.0) -> ControlMesh:
    """A patch of 13 x 8 points on an elliptic trunk with two bumps; 4 rows of 9 points are free.

    ``skew`` makes the left bump that much larger than the right one, in parts.
    """
    heights = np.array([-150.0, -92.0, -30.0, 0.0, 38.0, 70.0, 105.0, 145.0])
    angles = np.radians([0.0, 20.0, 33.0, 45.0, 62.0, 80.0, 97.0])
    row, column = (at.ravel() for at in np.meshgrid(np.arange(8), np.arange(-6, 7), indexing="ij"))
    angle = np.sign(column) * angles[np.abs(column)]
    x, y, z = 130.0 * np.sin(angle), -90.0 * np.cos(angle), heights[row]
    for side, size in ((-1.0, 60.0), (1.0, 60.0 * (1.0 + skew))):
        bump = size * np.exp(-(((x - side * 75.0) / 60.0) ** 2) - ((z + 15.0) / 65.0) ** 2)
        y = y - bump * (np.cos(angle) > 0.0)
    points = np.stack([x, y, z], axis=1)
    faces = np.array([face for r in range(7) for c in range(-6, 6) for face in _cell(r, c)])
    mesh = Mesh(points, faces)
    fixed = ~((row >= 2) & (row <= 5) & (np.abs(column) <= 4))
    paths = {name: tuple(_index(r, c) for c in range(-5, 6)) for r, name in enumerate(TORSO_LINES, start=1)}
    bust_points = (_index(3, 3), _index(3, -3))
    return ControlMesh(mesh, fixed, row, column, paths, bust_points, mesh.boundary_loops[:1], ())


def _index(row: int, column: int) -> int:
    return row * 13 + column + 6


def _cell(row: int, column: int) -> list[tuple[int, int, int]]:
    """Two triangles, wound outward; the diagonals of the two sides are mirror images."""
    a, b = _index(row, column), _index(row, column + 1)
    d, e = _index(row + 1, column), _index(row + 1, column + 1)
    rising = (column >= 0) == (row >= 3)
    return [(a, b, e), (a, e, d)] if rising else [(a, b, d), (b, e, d)]


def mirrored(control: ControlMesh) -> tuple[ControlMesh, np.ndarray]:
    """The body in a mirror, numbered from right to left again; and which point each one was before."""
    was = np.arange(len(control.row)).reshape(8, 13)[:, ::-1].ravel()
    points = control.mesh.vertices[was] * [-1.0, 1.0, 1.0]
    faces = was[control.mesh.faces][:, ::-1]
    mesh = Mesh(points, faces)
    left, right = control.bust_points
    twin = ControlMesh(
        mesh,
        control.fixed[was],
        control.row,
        control.column,
        control.paths,
        (int(was[right]), int(was[left])),
        mesh.boundary_loops[:1],
        (),
    )
    return twin, was


@cache
def fitted(sample: str, template: str = "168") -> ControlMesh:
    """The template on a sample body, fitted once for all tests, by the stages of a build."""
    _, body = pipeline.read_body(ScanSource(str(SAMPLES / f"{sample}.ply")))
    landmarks = pipeline.detect_landmarks(body, ())
    return pipeline.fit_control_mesh(pipeline.read_template(template), body, landmarks, Design.line_height)


def tent(height: float = 3.0) -> tuple[Mesh, np.ndarray]:
    """A free tip over the middle of a fixed square of side 8, open below; and which points are fixed."""
    points = np.array([[4, 4, 0], [-4, 4, 0], [-4, -4, 0], [4, -4, 0], [0, 0, height]], dtype=float)
    faces = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    return Mesh(points, faces), np.array([True, True, True, True, False])


def tent_model(stiffness: float = 16.0) -> ConstrainedModel:
    """The tent with a line over its ridge, from corner to corner."""
    mesh, fixed = tent()
    tensegric = tensegrity_model(mesh, fixed, ModelOptions(line_stiffness=stiffness))
    line = line_on("ridge", (2, 4, 0), mesh.vertices, tensegric.free)
    volume = volume_measure(mesh, tensegric.free)
    return assemble(tensegric, (line,), volume, ("ridge",))


def string() -> TensegrityModel:
    """Two free points on a string of three cables between two walls, 1, 2 and 4 mm long."""
    rest = frozen([[0, 0, 0], [1, 0, 0], [3, 0, 0], [7, 0, 0]])
    return TensegrityModel(
        rest, np.array([1, 2]), np.array([[0, 1], [1, 2], [2, 3]]), frozen([1.0, 0.5, 0.25])
    )


def octahedron(radius: float = 1.0) -> Mesh:
    """Six points on the axes, closed, wound outward; its volume is 4/3 radius^3."""
    points = radius * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    around = [(0, 1), (1, 2), (2, 3), (3, 0)]
    return Mesh(points, np.array([(a, b, 4) for a, b in around] + [(b, a, 5) for a, b in around]))


def central_difference(function: Callable[[np.ndarray], object], at: np.ndarray, step: float) -> np.ndarray:
    """The derivative of ``function`` at the array ``at``, one last axis entry per entry of ``at``."""
    columns = []
    for index in np.ndindex(*at.shape):
        nudge = np.zeros_like(at)
        nudge[index] = step
        columns.append((np.asarray(function(at + nudge)) - np.asarray(function(at - nudge))) / (2.0 * step))
    return np.stack(columns, axis=-1)


def mid_bust(model: ConstrainedModel, ratio: float) -> tuple[float, ...]:
    """Ratios that ask for the mid-bust line alone."""
    return tuple(ratio if line.name == "mid-bust" else 1.0 for line in model.lines)


def run(
    model: ConstrainedModel, targets: LineTargets, turns: int, state: SolverState | None = None
) -> tuple[SolverState, tuple[Record, ...]]:
    """The last state and all records of a run."""
    states, records = zip(*iterate(model, lambda: targets, state, turns=turns), strict=True)
    return states[-1], records


def errors_of(
    model: ConstrainedModel, targets: LineTargets, turns: int, state: SolverState | None = None
) -> np.ndarray:
    """The volume error after each turn of a run."""
    return np.array([measured.error for measured in run(model, targets, turns, state)[1]])
