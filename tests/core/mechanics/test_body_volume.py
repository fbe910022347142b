"""The body itself keeps its volume: by the outer loop, each breast for itself, or the sum."""

import numpy as np
import pytest

from core.mechanics.exact_solution import PRECISION, solve_body_exact, solve_exact
from core.mechanics.model import constrained_model
from core.mechanics.options import ModelOptions

RATIOS = (1.0, 0.8, 1.0)


def body_change(stages):
    return lambda points: stages.moving.side_volume_changes(stages.shape(points)[0])


@pytest.mark.parametrize("sample", ["mannequin", "person"])
@pytest.mark.parametrize("volume_of", ["each", "both"])
def test_the_body_keeps_its_volume(built, sample, volume_of):
    stages = built(sample)
    model = constrained_model(stages.control, worn=["mid-bust"], mechanics=ModelOptions(volume_of=volume_of))
    change, rest = body_change(stages), model.volume.rest_volume
    plain = change(model.tensegric.expand(solve_exact(model, RATIOS).state.moved)) / rest
    balance = solve_body_exact(model, RATIOS, change)
    held = change(model.tensegric.expand(balance.state.moved)) / rest
    assert balance.is_converged
    assert abs(plain.sum()) > 1e-4  # what the control mesh holds, the body holds only nearly
    assert abs(held.sum()) < 2 * PRECISION
    if volume_of == "each":
        assert np.abs(held).max() < PRECISION
    else:
        assert np.abs(held).max() > 100 * PRECISION


def test_what_the_body_lacks_is_given_to_the_control_mesh(built):
    stages = built("person")
    model = constrained_model(stages.control, worn=["mid-bust"])
    balance = solve_body_exact(model, RATIOS, body_change(stages))
    points = model.tensegric.expand(balance.state.moved)
    given = model.volume.zone_volumes(points) - model.rest_zones
    plain = model.tensegric.expand(solve_exact(model, RATIOS).state.moved)
    lacked = -body_change(stages)(plain)
    assert (np.sign(given) == np.sign(lacked)).all()
    np.testing.assert_allclose(given, lacked, rtol=0.2)


def test_a_body_that_never_keeps_its_volume_is_said_so(built):
    stages = built("mannequin")
    model = constrained_model(stages.control, worn=["mid-bust"])
    assert not solve_body_exact(model, RATIOS, lambda points: np.array([1e4, 1e4])).is_converged
