"""Slopes of what is read off the body, pulled back to the control points: against directional differences."""

from __future__ import annotations

import numpy as np
import pytest
from slopes import slope

from core.deformation.incremental_normals import moving_faces
from core.deformation.tffd import bind, deform_moving
from tests.core.deformation.test_tffd import BODY, BOTH, CONTROL, FULL, RING, shaken


@BOTH
@pytest.mark.parametrize("scaled", [False, True])
def test_slopes_by_control_points_are_those_of_differences(weights: str, scaled: bool) -> None:
    binding = bind(BODY, CONTROL, FULL, weights, scaled_normals=scaled, fixed=RING)
    rng = np.random.default_rng(8)
    here, way = shaken(CONTROL), rng.normal(size=CONTROL.vertices.shape)
    by_places = rng.normal(size=binding.rest_moving.shape)
    by_points = binding.gradient(here, by_places)
    expected = slope(
        lambda t: float(np.sum(by_places * deform_moving(binding, here + t * way * ~RING[:, None])))
    )
    assert np.sum(by_points * way * ~RING[:, None]) == pytest.approx(float(expected), rel=1e-9)


def test_slopes_of_the_volumes_are_those_of_differences() -> None:
    moving = moving_faces(BODY, np.flatnonzero((np.abs(BODY.vertices[:, :2]) < 70.0).all(axis=1)))
    rng = np.random.default_rng(9)
    here = moving.rest + rng.normal(size=moving.rest.shape)
    way = rng.normal(size=here.shape)
    expected = slope(lambda t: moving.side_volume_changes(here + t * way), 0.1)
    assert np.sum(moving.side_volume_slopes(here) * way, axis=(1, 2)) == pytest.approx(expected, rel=1e-9)
