"""Panels: even points that ride on the skin, shared with the neighbours; what is no panel is refused."""

import numpy as np
import pytest
from curved_patches import ball, circle, meridian, on_ball

from core.errors import PatternError
from core.geometry.mesh import area_vectors, boundary_loops
from core.pattern.panel import PanelSeed, cut_panels, spacing_of
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve

HALVES = (circle(60.0), meridian("seam", 30.0, -60.0, 60.0))
SEEDS = (PanelSeed("right", on_ball(120.0, 30.0), "cup"), PanelSeed("left", on_ball(300.0, 30.0)))
DART = meridian("dart", 120.0, 60.0, 20.0, slit=True)


def panels_of(curves=HALVES, seeds=SEEDS, spacing=5.0):
    return cut_panels(cut_surface(ball(), tuple(curves)), tuple(seeds), spacing)


def area(panel):
    return float(np.linalg.norm(area_vectors(panel.places(ball().vertices), panel.faces), axis=1).sum())


@pytest.mark.parametrize("curves", [HALVES, (*HALVES, DART)])
def test_a_panel_is_one_closed_outline_of_its_sides(curves):
    for panel in panels_of(curves):
        (loop,) = boundary_loops(panel.faces)
        outline = np.concatenate([side.points[:-1] for side in panel.sides])
        assert len(outline) == len(loop)
        start = int(np.flatnonzero(loop == outline[0])[0])
        np.testing.assert_array_equal(np.roll(loop, -start), outline)


@pytest.mark.parametrize("curves", [HALVES, (*HALVES, DART)])
def test_points_are_shares_of_the_skin_and_lie_on_it(curves):
    for panel in panels_of(curves):
        np.testing.assert_allclose(panel.mix.sum(axis=1), 1.0, atol=1e-12)
        assert panel.mix.data.min() >= 0.0
        away = np.linalg.norm(panel.places(ball().vertices), axis=1)
        assert away.max() < 70.0 + 1e-9
        assert 70.0 - away.min() < 0.1  # the sagitta of the skin's triangles


def test_the_area_of_panels_is_that_of_the_skin_within_their_outline():
    panels = panels_of(spacing=3.0)
    whole = 2.0 * np.pi * 70.0**2 * (1.0 - np.cos(np.radians(60.0)))
    assert sum(panel.covers for panel in panels) == pytest.approx(whole, rel=1e-3)
    for panel in panels:
        assert area(panel) == pytest.approx(panel.covers, rel=1e-3)


def test_neighbours_have_the_same_points_on_their_seam():
    right, left = panels_of()
    for side in right.sides:
        if side.partner:
            name, number = side.partner
            assert name == "left"
            other = left.sides[number]
            assert other.partner == ("right", right.sides.index(side))
            places = left.places(ball().vertices)[other.points[::-1]]
            np.testing.assert_allclose(right.places(ball().vertices)[side.points], places, atol=1e-12)
    assert [side.name for side in right.sides if side.partner] == ["seam"]


def test_an_edge_has_no_partner():
    edge = meridian("seam", 30.0, -60.0, 60.0, is_edge=True)
    assert not any(side.partner for panel in panels_of((HALVES[0], edge)) for side in panel.sides)


def test_points_are_even():
    panel = panels_of()[0]
    places = panel.places(ball().vertices)[panel.faces]
    sides = np.linalg.norm(places - np.roll(places, -1, axis=1), axis=2)
    assert 0.9 * 5.0 < np.median(sides) < 1.1 * 5.0
    assert np.quantile(sides, 0.99) < 9.0
    for side in panel.sides:
        steps = np.linalg.norm(np.diff(panel.places(ball().vertices)[side.points], axis=0), axis=1)
        assert np.ptp(steps) < 0.05 * steps.mean()


def test_a_dart_opens_its_panel_and_its_legs_are_sewn_to_each_other():
    right, left = panels_of((*HALVES, DART))
    legs = [number for number, side in enumerate(right.sides) if side.name == "dart"]
    assert [right.sides[number].partner for number in legs] == [("right", legs[1]), ("right", legs[0])]
    places = right.places(ball().vertices)
    one, two = (right.sides[number].points for number in legs)
    np.testing.assert_allclose(places[one], places[two[::-1]], atol=1e-12)
    assert len(set(one.tolist()) & set(two.tolist())) == 1  # its tip
    assert not any(side.name == "dart" for side in left.sides)


def test_a_ring_of_skin_is_a_panel_once_a_seam_opens_it():
    curves = [circle(60.0), circle(30.0, "inner")]
    seed = PanelSeed("ring", on_ball(0.0, 45.0))
    with pytest.raises(PatternError):
        panels_of(curves, [seed])
    (panel,) = panels_of([*curves, meridian("back seam", 180.0, 30.0, 60.0)], [seed])
    assert sorted(side.name for side in panel.sides) == ["back seam", "back seam", "edge", "inner"]
    numbers = [number for number, side in enumerate(panel.sides) if side.name == "back seam"]
    assert panel.sides[numbers[0]].partner == ("ring", numbers[1])


def test_points_follow_the_body():
    panel = panels_of()[0]
    stretched = ball().vertices * [1.0, 1.2, 0.9]
    expected = panel.places(ball().vertices) * [1.0, 1.2, 0.9]
    np.testing.assert_allclose(panel.places(stretched), expected, atol=1e-9)


def test_large_panels_have_wider_spacing():
    assert [spacing_of(area) for area in (2000.0, 12500.0, 24500.0, 90000.0)] == [5.0, 5.0, 7.0, 9.0]


def refusal(curves, seeds=SEEDS):
    with pytest.raises(PatternError) as refused:
        panels_of(curves, seeds)
    return refused.value


def test_a_gap_between_panels_is_refused_with_their_names():
    problem = refusal((HALVES[0], meridian("seam", 30.0, -60.0, 40.0)))
    assert problem.message.parameters == {"first": "right", "second": "left"}


def test_a_panel_that_leaks_is_refused_with_the_free_ends():
    open_rim = SurfaceCurve("edge", HALVES[0].points[:-30])
    problem = refusal((open_rim,), [PanelSeed("cup", on_ball(0.0, 10.0))])
    assert problem.message.parameters["name"] == "cup"
    assert "edge" in str(problem.hint) or "edge" in problem.message.parameters.values()


def test_a_seam_that_ends_within_a_panel_is_refused():
    problem = refusal((*HALVES, meridian("stray", 120.0, 60.0, 20.0)))
    assert problem.message.parameters == {"seam": "stray", "name": "right"}
