"""Straps: how long they are over a shoulder, and how they pull with all of their length."""

from dataclasses import replace

import numpy as np
import pytest
from models import cable_force, settled, volume_slopes
from shapes import central_difference, torso

from core.control_mesh.straps import shoulder_above, strap_tail
from core.document.line_notation import with_custom_lines
from core.document.lines import CustomLine
from core.errors import LineError
from core.geometry.mesh import Mesh
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import LineTargets
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import LINE_HOLDS, ModelOptions
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Sensitivities

RADIUS, LOW, BEND = 50.0, -200.0, 24
STRAP = CustomLine("strap", tuple(13 * row + 9 for row in range(2, 7)), over_shoulder=True)
TAIL = 320.0


def sheet(profile: np.ndarray) -> Mesh:
    """A profile of (y, z) drawn out along x, from -60 to 60 mm, its outside on the left of its way."""
    x = np.linspace(-60.0, 60.0, 13)
    points = np.array([(at, y, z) for y, z in profile for at in x])
    a = np.array([i * len(x) + j for i in range(len(profile) - 1) for j in range(len(x) - 1)])
    b, c, d = a + 1, a + len(x), a + len(x) + 1
    return Mesh(points, np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)]))


def wall(y: float, low: float, high: float) -> np.ndarray:
    z = np.linspace(low, high, 21)
    return np.stack([np.full_like(z, y), z], axis=1)


def shoulder() -> Mesh:
    """Two walls, from front to back 100 mm apart, with half a cylinder over them."""
    turn = np.linspace(np.pi, 0.0, BEND + 1)[1:-1]
    over = RADIUS * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return sheet(np.concatenate([wall(-RADIUS, LOW, 0.0), over, wall(RADIUS, 0.0, LOW)]))


def band(z: float) -> np.ndarray:
    """The back of a band at a height, from left to right."""
    x = np.linspace(60.0, -60.0, 61)
    return np.stack([x, np.full_like(x, RADIUS), np.full_like(x, z)], axis=1)


def test_a_tail_runs_straight_over_the_shoulder_and_down_to_the_band():
    tail = strap_tail(shoulder(), np.array([10.0, -RADIUS, -40.0]), band(-120.0))
    quarter = BEND * RADIUS * np.sin(np.pi / (2 * BEND))  # of chords
    assert str(tail.problem) == ""
    assert tail.length == pytest.approx(40.0 + 2.0 * quarter + 120.0, abs=0.01)
    assert tail.top == pytest.approx(40.0 + quarter, abs=0.01)
    np.testing.assert_allclose(tail.path[0], [10.0, -RADIUS, -40.0], atol=1e-9)
    np.testing.assert_allclose(tail.path[-1], [10.0, RADIUS, -120.0], atol=1e-6)
    np.testing.assert_allclose(tail.path[:, 0], 10.0, atol=1e-3)
    assert tail.path[:, 2].max() == pytest.approx(RADIUS, abs=0.5)


@pytest.mark.parametrize("covered", [True, False])
def test_where_the_scan_ends_below_the_shoulder_there_is_none(covered):
    top = np.array([[y, 0.0] for y in np.linspace(-RADIUS, RADIUS, 21)[1:-1]])
    walls = [wall(-RADIUS, LOW, 0.0), *[top] * covered, wall(RADIUS, 0.0, LOW)]
    skin = sheet(np.concatenate(walls)) if covered else sheet(walls[0])
    end = np.array([10.0, -RADIUS, -90.0])
    with pytest.raises(LineError, match="ends below the shoulder"):
        shoulder_above(skin, end)
    tail = strap_tail(skin, end, band(-120.0))
    assert (tail.length, len(tail.path)) == (0.0, 0)
    assert "below the shoulder" in str(tail.problem)


def model_with(tail: float = TAIL, **choices) -> ConstrainedModel:
    control = with_custom_lines(torso(skew=0.3), (STRAP,))
    return constrained_model(
        control, worn=["strap"], tail_lengths={"strap": tail}, mechanics=ModelOptions(**choices)
    )


def ratios_of(model: ConstrainedModel, ratio: float) -> tuple[float, ...]:
    return tuple(ratio if line.name == "strap" else 1.0 for line in model.lines)


def test_a_strap_ends_where_the_body_is_fixed_whichever_way_it_was_drawn():
    control = torso(skew=0.3)
    up, down = (
        with_custom_lines(control, (replace(STRAP, points=points),)).paths["strap"]
        for points in (STRAP.points, STRAP.points[::-1])
    )
    assert up == down == STRAP.points
    assert control.fixed[up[-1]]
    assert not control.fixed[up[-2]]
    longer = replace(STRAP, points=(*STRAP.points, 13 * 7 + 9))
    assert with_custom_lines(control, (longer,)).paths["strap"] == up
    free = CustomLine("strap", places=((6.9, 2.6), (2.3, 3.2)), over_shoulder=True)
    laid = with_custom_lines(control, (free,)).embedded["strap"]
    assert laid.places[0].tolist() == [2.3, 3.2]
    held = laid.weights @ control.fixed
    assert held[-1] == pytest.approx(1.0)
    assert (held[:-1] < 1.0 - 1e-9).all()


@pytest.mark.parametrize("ratio", [0.93, 1.04])
def test_its_last_segment_pulls_with_the_tape_over_the_shoulder(ratio):
    model = model_with()
    answer = solve_exact(model, ratios_of(model, ratio))
    assert answer.is_converged
    points = model.tensegric.expand(answer.state.moved)
    force, line = np.zeros_like(points), model.lines[-1]
    ea = model.options.line_stiffness * model.tensegric.mean_stiffness * line.spacing
    for (i, j), more in zip(zip(STRAP.points, STRAP.points[1:], strict=False), (0, 0, 0, TAIL), strict=True):
        span = points[i] - points[j]
        length = np.linalg.norm(span)
        rest = np.linalg.norm(model.tensegric.rest[i] - model.tensegric.rest[j]) + more
        pull = ea * (length + more - ratio * rest) / rest
        force[i] -= pull * span / length
        force[j] += pull * span / length
    force += cable_force(model, points)
    force += np.tensordot(answer.pressures, volume_slopes(model, points), axes=1)
    np.testing.assert_allclose(force[model.tensegric.free], 0.0, atol=1e-8)
    assert line.length(points) == pytest.approx(line.rest_length, rel=0.05)
    assert line.rest_length > TAIL


def test_a_longer_strap_is_softer():
    moved = []
    for tail in (0.0, 100.0, 400.0):
        model = model_with(tail)
        natural = 5.0  # mm shorter in all
        ratio = 1.0 - natural / model.lines[-1].rest_length
        moved.append(float(np.abs(solve_exact(model, ratios_of(model, ratio)).state.moved).max()))
    assert moved[0] > moved[1] > moved[2] > 0.0


@pytest.mark.parametrize("hold", LINE_HOLDS)
@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_turns_rest_where_the_exact_answer_is(hold, contact):
    model = model_with(line_hold=hold, line_contact=contact, line_stiffness=4.0, volume_of="both")
    ratios = ratios_of(model, 0.99)
    exact = solve_exact(model, ratios)
    assert exact.is_converged
    state = settled(model, LineTargets(ratios, "accumulating"), turns=6000)
    np.testing.assert_allclose(state.moved, exact.state.moved, atol=1e-6)
    if hold == "held":
        reached = model.lines[-1].length(model.tensegric.expand(exact.state.moved))
        assert reached == pytest.approx(0.99 * model.lines[-1].rest_length, rel=1e-9)


@pytest.mark.parametrize("hold", LINE_HOLDS)
def test_rates_by_its_length_are_those_of_answers(hold):
    model, at = model_with(line_hold=hold), 0.99
    index = np.array([len(model.lines) - 1])
    answer = Sensitivities(Potential(model, ratios_of(model, at)), solve_exact(model, ratios_of(model, at)))

    def moved(ratio):
        return solve_exact(model, ratios_of(model, float(ratio[0]))).state.moved

    expected = central_difference(moved, np.array([at]), 1e-5).ravel()
    np.testing.assert_allclose(answer.by_ratio(index).moved[:, 0], expected, atol=1e-4)
