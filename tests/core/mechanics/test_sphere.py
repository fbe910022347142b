"""The sphere of the paper's Fig. 2: a closed control mesh with closed lines, solved by the same code."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from app.research.sphere import SphereModel, sphere_model
from core.geometry.mesh import Points
from core.mechanics.exact_solution import Equilibrium, solve_exact
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.options import CONTACTS, LAWS, LINE_HOLDS, ModelOptions

LINES = ("horizontal", "vertical")


@cache
def solved(line: str, ratio: float) -> tuple[SphereModel, Equilibrium]:
    model = sphere_model((line,))
    return model, solve_exact(model.model, asked(line, ratio))


def asked(line: str, ratio: float) -> tuple[float, ...]:
    return tuple(ratio if name == line else 1.0 for name in LINES)


def reached(ball: SphereModel, points: Points) -> dict[str, float]:
    return {line.name: line.length(points) / line.rest_length for line in ball.model.lines}


def test_the_counts_and_the_lines_of_the_control_mesh() -> None:
    ball = sphere_model()
    mesh = ball.control.mesh
    assert (len(mesh.vertices), len(mesh.faces), len(ball.body.faces)) == (86, 168, 20480)
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.faces) == 2  # closed, without a handle
    assert mesh.boundary_loops == ()
    assert len(ball.model.tensegric.free) == 86
    edges = {tuple(edge) for edge in mesh.edges.tolist()}
    for name, count in (("horizontal", 12), ("vertical", 16)):
        path = ball.control.paths[name]
        assert path[0] == path[-1]
        assert len(set(path)) == len(path) - 1 == count
        assert all(tuple(sorted(pair)) in edges for pair in pairwise(path))


def test_the_lines_are_great_circles() -> None:
    ball = sphere_model()
    for line, count in zip(ball.model.lines, (12, 16), strict=True):
        assert line.rest_length == pytest.approx(200.0 * count * np.sin(np.pi / count))


def test_at_rest_nothing_moves() -> None:
    ball = sphere_model(LINES)
    *_, (state, measured) = iterate(ball.model, lambda: LineTargets((1.0, 1.0)), turns=20)
    assert np.abs(state.moved).max() < 1e-10
    assert abs(measured.error) < 1e-12
    assert np.array_equal(ball.shape(np.zeros_like(state.moved)).vertices, ball.body.vertices)


@pytest.mark.parametrize("line", LINES)
def test_a_shorter_line_makes_a_waist_and_a_bulge(line: str) -> None:
    """Top row of Fig. 2: the line's plane shrinks, the way across it grows, the volume stays."""
    ball, balance = solved(line, 0.8)
    points = ball.centred(balance.state.moved)
    across = 2 if line == "horizontal" else 1
    size, body = np.ptp(points, axis=0), np.ptp(ball.shape(balance.state.moved).vertices, axis=0)
    other = next(name for name in LINES if name != line)
    for extent in (size, body):
        assert extent[across] > 220.0
        assert all(extent[axis] < 180.0 for axis in range(3) if axis != across)
    assert 0.8 < reached(ball, points)[line] < 0.85
    assert reached(ball, points)[other] > 1.05
    assert ball.model.volume.volume(points) == pytest.approx(ball.model.volume.rest_volume, rel=1e-9)
    assert balance.residual < 1e-9


@pytest.mark.parametrize("line", LINES)
def test_a_longer_line_does_the_reverse(line: str) -> None:
    """Bottom row of Fig. 2."""
    ball, balance = solved(line, 1.15)
    points = ball.centred(balance.state.moved)
    across = 2 if line == "horizontal" else 1
    assert np.ptp(points, axis=0)[across] < 182.0
    assert 1.1 < reached(ball, points)[line] < 1.15
    assert balance.residual < 1e-9


@pytest.mark.parametrize("line", LINES)
def test_the_body_keeps_its_volume_almost_as_the_control_mesh_does(line: str) -> None:
    """Section 4: the volumetric difference ratio is almost the same for both."""
    ball, balance = solved(line, 0.8)
    change = ball.shape(balance.state.moved).enclosed_volume() / ball.body.enclosed_volume() - 1.0
    assert abs(change) < 0.005


@pytest.mark.parametrize(("line", "axis", "degrees"), [("horizontal", 2, 30), ("horizontal", 0, 180)])
@pytest.mark.parametrize("ratio", [0.8, 1.15])
def test_the_answer_has_the_symmetry_of_mesh_and_line(
    line: str, axis: int, degrees: float, ratio: float
) -> None:
    ball, balance = solved(line, ratio)
    assert moved_by_turning(ball, balance, axis, degrees) < 1e-6


@pytest.mark.parametrize("axis", [0, 2])
def test_the_vertical_answer_too(axis: int) -> None:
    ball, balance = solved("vertical", 0.8)
    assert moved_by_turning(ball, balance, axis, 180.0) < 1e-6


def moved_by_turning(ball: SphereModel, balance: Equilibrium, axis: int, degrees: float) -> float:
    """How far the answer is from itself, turned about an axis that maps mesh and line on themselves [mm]."""
    turn = Rotation.from_euler("xyz"[axis], degrees, degrees=True).as_matrix().T
    away, image = cKDTree(ball.control.mesh.vertices).query(ball.control.mesh.vertices @ turn)
    assert away.max() < 1e-9
    points = ball.centred(balance.state.moved)
    return float(np.abs(points @ turn - points[image]).max())


def test_horizontal_and_vertical_are_the_same_on_a_sphere_but_for_the_mesh() -> None:
    """Both lines are great circles: waist and bulge agree within what 168 triangles can tell."""
    (ball, flat), (_, upright) = solved("horizontal", 0.8), solved("vertical", 0.8)
    first = np.sort(np.ptp(ball.centred(flat.state.moved), axis=0))
    second = np.sort(np.ptp(ball.centred(upright.state.moved), axis=0))
    assert first == pytest.approx(second, rel=0.05)


def test_turns_end_at_the_exact_answer() -> None:
    ball, balance = solved("horizontal", 0.8)
    *_, (state, measured) = iterate(ball.model, lambda: LineTargets(asked("horizontal", 0.8)), turns=1200)
    assert abs(measured.error) < 1e-9
    assert ball.centred(state.moved) == pytest.approx(ball.centred(balance.state.moved), abs=1e-3)


@pytest.mark.parametrize("hold", LINE_HOLDS)
@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("law", LAWS)
def test_every_law_narrows_the_sphere_at_constant_volume(law: str, contact: str, hold: str) -> None:
    mechanics = ModelOptions(member_law=law, line_contact=contact, line_hold=hold)
    ball = sphere_model(("horizontal",), mechanics)
    balance = solve_exact(ball.model, asked("horizontal", 0.9))
    points = ball.centred(balance.state.moved)
    size = np.ptp(points, axis=0)
    assert balance.is_converged
    assert size[0] == pytest.approx(size[1], abs=1e-6)
    assert size[0] < 185.0
    assert size[2] > 210.0
    assert ball.model.volume.volume(points) == pytest.approx(ball.model.volume.rest_volume, rel=1e-9)
    if hold == "held":
        assert reached(ball, points)["horizontal"] == pytest.approx(0.9, abs=1e-9)
    else:
        assert 0.9 < reached(ball, points)["horizontal"] < 0.92


def test_two_closed_lines_at_once() -> None:
    """They cross at two points; both shorten, and the body bulges in the four fields between them."""
    ball = sphere_model(LINES)
    balance = solve_exact(ball.model, (0.85, 0.85))
    points = ball.centred(balance.state.moved)
    assert balance.is_converged
    assert all(0.85 < share < 0.9 for share in reached(ball, points).values())
    apart = np.linalg.norm(points, axis=1)
    between = np.abs(ball.control.mesh.vertices[:, 1:]).min(axis=1) > 40.0
    assert apart[between].min() > 103.0


@pytest.mark.parametrize("hold", ["spring", "held"])
@pytest.mark.parametrize("ratio", [1.15, 1.2, 1.3])
def test_a_line_that_buckles_the_sphere_is_found_in_few_steps(hold, ratio):
    """A ring that is longer than its rest pushes: there the true stiffness is seldom positive definite."""
    model = sphere_model(("vertical",), mechanics=ModelOptions(line_hold=hold)).model
    balance = solve_exact(model, tuple(ratio if line.name == "vertical" else 1.0 for line in model.lines))
    assert balance.is_converged
    assert balance.steps <= 30
