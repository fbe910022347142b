"""The condition of small control meshes, worked out by hand, and of the sample bodies."""

import numpy as np
import pytest
from shapes import fitted, octahedron, tent, tent_model

from core.mechanics.exact_solution import solve_exact
from core.mechanics.mesh_quality import MeshQuality, mesh_quality, original_shape
from core.mechanics.model import constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.solver_comparison import shape_of

SIDE = np.sqrt(41.0)  # from a corner of the tent to its tip


def tent_with_tip(*tip):
    mesh, fixed = tent()
    points = mesh.vertices.copy()
    points[4] = tip
    return mesh_quality(mesh, points, fixed)


def flags(found):
    return found.folded, found.inverted, found.overstrained, found.strained


def test_at_rest_nothing_has_turned_or_strained():
    found = tent_with_tip(0.0, 0.0, 3.0)
    assert (found.least_cosine, found.shortest, found.longest) == pytest.approx((1.0, 1.0, 1.0))
    assert flags(found) == (False, False, False, False)


def test_a_tip_pushed_through_turns_the_sides_and_strains_nothing():
    found = tent_with_tip(0.0, 0.0, -3.0)
    assert found.least_cosine == pytest.approx((16.0 - 9.0) / 25.0)
    assert (found.shortest, found.longest) == pytest.approx((1.0, 1.0))
    assert flags(found) == (False, False, False, False)


def test_a_tip_beyond_its_edge_shows_a_side_from_the_back():
    found = tent_with_tip(0.0, 8.0, 3.0)
    assert found.least_cosine == pytest.approx((9.0 - 16.0) / 25.0)
    assert (found.shortest, found.longest) == pytest.approx((1.0, 13.0 / SIDE))
    assert flags(found) == (True, True, True, True)


def test_a_side_without_area_is_folded():
    found = tent_with_tip(0.0, 4.0, 0.0)
    assert found.least_cosine == 0.0
    assert found.folded
    assert found.inverted


def test_an_upright_side_is_folded_but_not_inverted():
    found = tent_with_tip(0.0, 4.0, 0.5)
    assert found.least_cosine == pytest.approx(0.6)  # the side faces +y, as 3 of 5 parts of it did
    found = tent_with_tip(0.0, 4.6, 1.0)
    assert found.least_cosine == pytest.approx((1.0 * 3.0 - 0.6 * 4.0) / 5.0 / np.hypot(1.0, 0.6))
    assert flags(found)[:2] == (True, False)


def test_edges_between_fixed_points_do_not_count():
    mesh, fixed = tent()
    assert len(original_shape(mesh, fixed).edges) == 4
    assert len(original_shape(mesh).edges) == 8


@pytest.mark.parametrize(
    ("scale", "strained", "overstrained"),
    [(0.69, True, True), (0.75, True, False), (1.0, False, False), (1.25, True, False), (1.31, True, True)],
)
def test_strain_is_amber_before_it_is_too_much(scale, strained, overstrained):
    ball = octahedron(100.0)
    found = mesh_quality(ball, scale * ball.vertices)
    assert (found.least_cosine, found.shortest, found.longest) == pytest.approx((1.0, scale, scale))
    assert (found.strained, found.overstrained) == (strained, overstrained)


def test_the_limits_themselves_are_within():
    assert flags(MeshQuality(0.21, 0.7, 1.3)) == (False, False, False, True)
    assert flags(MeshQuality(0.2, 0.8, 1.2)) == (True, False, False, False)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e200])
def test_a_shape_that_blew_up_is_folded_and_overstrained(bad):
    found = tent_with_tip(bad, 0.0, 3.0)
    assert found.folded
    assert found.overstrained


def test_a_mesh_with_nothing_free_keeps_its_shape():
    mesh, _ = tent()
    assert mesh_quality(mesh, mesh.vertices, np.ones(5, dtype=bool)) == MeshQuality(1.0, 1.0, 1.0)


def test_a_model_tells_the_same_as_its_mesh():
    mesh, fixed = tent()
    model = tent_model()
    points = mesh.vertices + np.array(4 * [[0.0, 0.0, 0.0]] + [[0.5, 0.2, -0.4]])
    of_model = shape_of(model)
    assert of_model.quality(points) == mesh_quality(mesh, points, fixed)


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_short_lines_strain_a_body_and_shorter_ones_fold_it(sample):
    control = fitted(sample)
    shape = original_shape(control.mesh, control.fixed)
    stiff = constrained_model(control, worn=["mid-bust"], mechanics=ModelOptions(line_stiffness=500.0))
    found = []
    for ratio in (0.97, 0.83, 0.65):
        moved = solve_exact(stiff, (1.0, ratio, 1.0)).state.moved
        found.append(shape.quality(stiff.tensegric.expand(moved)))
    assert [each.strained for each in found] == [False, True, True]
    assert [each.overstrained for each in found] == [False, True, True]
    assert [each.folded for each in found] == [False, False, True]
    assert found[0].least_cosine > found[1].least_cosine > found[2].least_cosine
