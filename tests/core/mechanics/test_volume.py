"""Volume: hand values, derivatives against finite differences, identities, and the laws of its control."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapes import central_difference, octahedron, tent, torso

from app.research.sphere import sphere
from core.geometry.mesh import Mesh
from core.mechanics.gain_limit import weighted_sum
from core.mechanics.tensegrity import tensegrity_model
from core.mechanics.volume import ITERATIVE_CONTROLS, KEEPS_VOLUME, Pressure, next_pressure, volume_measure


def measured(control):
    model = tensegrity_model(control.mesh, control.fixed)
    left = control.column[control.mesh.faces].sum(axis=1) > 0
    return model, volume_measure(control.mesh, model.free, np.where(left, 0, 1))


TORSO, TORSO_VOLUME = measured(torso(skew=0.3))
RNG = np.random.default_rng(5)
SOMEWHERE = 3.0 * RNG.normal(size=(len(TORSO.free), 3))


def curvature(volume, points, free, pressures=(1.0, 1.0)):
    """The second derivative of the pressures times both volumes, shape (3 f, 3 f)."""
    place = np.full(len(points), -1)
    place[free] = np.arange(len(free))
    entries, flat = volume.curvature(place), (points - volume.centre).ravel()
    figures = np.concatenate([pressure * flat for pressure in pressures])
    return weighted_sum([entries], [figures], 3 * len(free)).toarray()


def test_the_tent_by_hand():
    mesh, fixed = tent(height=3.0)
    volume = volume_measure(mesh, np.flatnonzero(~fixed))
    np.testing.assert_allclose(volume.centre, 0.0, atol=1e-15)
    assert volume.rest_volume == pytest.approx(64.0)
    lifted = np.concatenate([mesh.vertices[:4], [[0, 0, 4.5]]])
    assert volume.volume(lifted) == pytest.approx(96.0)
    np.testing.assert_allclose(volume.gradient(lifted), [[0, 0, 64 / 3]], atol=1e-14)
    np.testing.assert_allclose(
        curvature(volume, lifted, np.flatnonzero(~fixed)), np.zeros((3, 3)), atol=1e-15
    )


def test_a_tetrahedron_and_its_reversal():
    corner = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    for sign, wound in ((1.0, faces), (-1.0, faces[:, ::-1])):
        volume = volume_measure(Mesh(corner, wound), np.arange(4))
        assert volume.rest_volume == pytest.approx(sign / 6)
        assert volume.volume(corner) == pytest.approx(sign / 6)
        np.testing.assert_allclose(volume.gradient(corner)[3], [0, 0, sign / 6], atol=1e-16)


def test_the_measure_agrees_with_the_mesh_at_rest_and_moved():
    points = TORSO.expand(SOMEWHERE)
    mesh = torso(skew=0.3).mesh
    assert TORSO_VOLUME.volume(TORSO.rest) == pytest.approx(TORSO_VOLUME.rest_volume, rel=1e-14)
    moved = mesh.moved(points)
    assert TORSO_VOLUME.volume(points) == pytest.approx(moved.enclosed_volume(TORSO_VOLUME.centre), rel=1e-13)


@settings(deadline=None)
@given(st.tuples(*[st.floats(-500, 500)] * 3))
def test_a_difference_of_volume_does_not_depend_on_the_centre(apex):
    mesh = torso(skew=0.3).mesh
    points = TORSO.expand(SOMEWHERE)
    change = mesh.moved(points).enclosed_volume(apex) - mesh.enclosed_volume(apex)
    assert change == pytest.approx(TORSO_VOLUME.volume(points) - TORSO_VOLUME.rest_volume, abs=1e-4)


def test_both_sides_and_the_rest_make_the_whole():
    points = TORSO.expand(SOMEWHERE)
    whole = TORSO_VOLUME.zone_volumes(points).sum() + TORSO_VOLUME.still_volume
    assert whole == pytest.approx(TORSO_VOLUME.volume(points), rel=1e-14)
    np.testing.assert_allclose(
        TORSO_VOLUME.zone_gradients(points).sum(axis=0), TORSO_VOLUME.gradient(points), atol=1e-11
    )


def test_each_breast_changes_the_volume_of_its_own_side_alone():
    moved = np.zeros((len(TORSO.free), 3))
    is_left = TORSO.rest[TORSO.free, 0] > 30.0
    moved[is_left, 1] = -4.0
    change = TORSO_VOLUME.zone_volumes(TORSO.expand(moved)) - TORSO_VOLUME.zone_volumes(TORSO.rest)
    assert change[0] > 1e4
    assert change[1] == 0.0


def test_sides_default_to_the_side_of_the_centre():
    control = torso()
    by_place = volume_measure(control.mesh, np.flatnonzero(~control.fixed))
    _, by_column = measured(control)
    np.testing.assert_array_equal(by_place.zone, by_column.zone)


def test_gradient_agrees_with_finite_differences():
    # Volume is linear in every single coordinate: the difference is exact but for round-off.
    found = central_difference(lambda d: TORSO_VOLUME.volume(TORSO.expand(d)), SOMEWHERE, 1.0)
    gradient = TORSO_VOLUME.gradient(TORSO.expand(SOMEWHERE))
    np.testing.assert_allclose(gradient, found.reshape(-1, 3), atol=1e-8 * np.abs(gradient).max())


def test_gradient_is_of_second_order_along_a_skew_direction():
    way = RNG.normal(size=SOMEWHERE.shape)
    slope = np.sum(TORSO_VOLUME.gradient(TORSO.expand(SOMEWHERE)) * way)

    def error(step):
        return (
            central_difference(
                lambda t: TORSO_VOLUME.volume(TORSO.expand(SOMEWHERE + t[0] * way)), np.zeros(1), step
            )[0]
            - slope
        )

    # V is cubic along a straight way: the central difference errs by exactly its cubic part times h^2.
    assert error(8.0) / error(4.0) == pytest.approx(4.0, rel=1e-5)
    assert abs(error(0.01)) < 1e-5 * abs(slope)


def test_hessian_agrees_with_finite_differences():
    pressures = np.array([1.3, 0.7])
    found = central_difference(
        lambda d: np.tensordot(pressures, TORSO_VOLUME.zone_gradients(TORSO.expand(d)), axes=1).ravel(),
        SOMEWHERE,
        1.0,
    )
    hessian = curvature(TORSO_VOLUME, TORSO.expand(SOMEWHERE), TORSO.free, pressures)
    np.testing.assert_allclose(hessian, found, atol=1e-11 * np.abs(found).max())
    np.testing.assert_array_equal(hessian, hessian.T)


def test_a_closed_volume_is_homogeneous_and_feels_no_net_force():
    ball = sphere()
    volume = volume_measure(ball, np.arange(len(ball.vertices)))
    points = ball.vertices + RNG.normal(size=ball.vertices.shape)
    force = volume.gradient(points)
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.cross(points, force).sum(axis=0), 0.0, atol=1e-6)
    # Euler: a function of degree 3 satisfies x . grad V = 3 V, and its Hessian x . H x = 6 V.
    assert np.sum(points * force) == pytest.approx(3 * volume.volume(points), rel=1e-12)
    flat = (points - volume.centre).ravel()
    assert flat @ curvature(volume, points, np.arange(len(points))) @ flat == pytest.approx(
        6 * volume.volume(points), rel=1e-12
    )


def test_the_force_on_an_octahedron_points_outward():
    shape = octahedron(2.0)
    force = volume_measure(shape, np.arange(6)).gradient(shape.vertices)
    # A third of the area vectors around each tip: four faces whose z parts are 2 each.
    np.testing.assert_allclose(force, shape.vertices * (4 * 2 / 3) / 2, atol=1e-14)


def test_conventional_pressure_is_the_gain_times_the_last_error():
    after = next_pressure("conventional", Pressure(value=9.0), 0.02, gain=1.5)
    assert after.value == pytest.approx(0.03)
    assert after.error == 0.02


def test_no_control_never_builds_up_pressure():
    assert next_pressure("none", Pressure(), 0.5, gain=1.5).value == 0.0


def test_adaptive_pressure_by_hand():
    first = next_pressure("adaptive", Pressure(), 0.01, gain=99.0)
    assert first.value == pytest.approx(0.8 * (0.01 + 0.8 * 0.01))
    # Coming home fast: the push is taken back a little although volume is still missing.
    second = next_pressure("adaptive", first, 0.004, gain=99.0)
    assert second.value - first.value == pytest.approx(0.8 * (0.004 - 0.8 * 0.006))
    assert second.step == 0.8


def test_adaptive_step_halves_when_the_volume_flips_and_recovers_slowly():
    flipped = next_pressure("adaptive", Pressure(error=0.01), -0.008, gain=0.0)
    assert flipped.step == 0.4
    assert next_pressure("adaptive", flipped, -0.007, gain=0.0).step == pytest.approx(0.42)
    # A flip counts from three tenths of the error before it on, and above round-off.
    for error, before, step in (
        (0.0031, 0.01, 0.4),
        (0.0029, 0.01, 0.8),
        (1.1e-7, 3e-7, 0.4),
        (0.9e-7, 3e-7, 0.8),
    ):
        assert next_pressure("adaptive", Pressure(error=before), -error, gain=0.0).step == step


@settings(deadline=None)
@given(st.floats(0.5, 2.0), st.floats(0.5, 2.0))
def test_the_adaptive_push_is_the_error_less_what_is_already_coming_home(before, now):
    """The paper's wording: dP = step * e * (1 - damping * r), r = (V - V_before) / (V0 - V)."""
    pressure = Pressure(value=0.3, error=before)
    ratio = (before - now) / now
    push = next_pressure("adaptive", pressure, now, gain=0.0).value - 0.3
    assert push == pytest.approx(0.8 * now * (1.0 - 0.8 * ratio), abs=1e-12)


def test_an_adaptive_pressure_that_reached_its_aim_stays():
    steady = Pressure(value=0.7)
    assert next_pressure("adaptive", steady, 0.0, gain=0.0) == steady


@pytest.mark.parametrize("control", ITERATIVE_CONTROLS)
def test_a_control_that_keeps_the_volume_pushes_on_when_the_error_is_zero(control):
    pressure = next_pressure(control, Pressure(), 0.01, gain=1.5)
    for _ in range(20):
        pressure = next_pressure(control, pressure, 0.0, gain=1.5)
    assert (pressure.value > 0.0) == (control in KEEPS_VOLUME)


def test_a_control_without_a_law_is_refused():
    with pytest.raises(ValueError, match="integral"):
        next_pressure("integral", Pressure(), 0.01, gain=1.5)
