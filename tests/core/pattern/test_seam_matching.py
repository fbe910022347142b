"""Pieces laid flat together: their seams fit stretch by stretch, at the least work."""

from dataclasses import replace

import numpy as np
import pytest
from curved_patches import EVEN, LACE, PlainCloth, ball, circle, meridian, on_ball
from slopes import slope

from core.pattern.flattening import FlatProblem, strain_summary
from core.pattern.panel import PanelSeed, cut_panels
from core.pattern.seam_matching import _Stretches, match, seams_of
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve

STIFF = PlainCloth((20.0, 20.0, 7.0))


@pytest.fixture(scope="module")
def panels():
    """A cap in two unequal parts: the seam passes 18 mm above the pole, the larger part has a dart."""
    x = np.linspace(-1.0, 1.0, 120) * np.sqrt((70.0 * np.sin(np.radians(55.0))) ** 2 - 18.0**2)
    seam = np.stack([x, -np.sqrt(70.0**2 - x**2 - 18.0**2), np.full(120, 18.0)], axis=1)
    curves = (circle(55.0), SurfaceCurve("seam", seam), meridian("dart", 180.0, 55.0, 15.0, slit=True))
    seeds = (PanelSeed("upper", on_ball(0.0, 35.0)), PanelSeed("lower", on_ball(140.0, 30.0)))
    return cut_panels(cut_surface(ball(), curves), seeds, 5.0)


def places_of(panels):
    return [panel.places(ball().vertices) for panel in panels]


def test_seams_are_listed_once(panels):
    assert [(seam.name, seam.panels) for seam in seams_of(panels)] == [("seam", (0, 1)), ("dart", (1, 1))]
    for seam in seams_of(panels):
        places = [
            places_of(panels)[panel][points] for panel, points in zip(seam.panels, seam.points, strict=True)
        ]
        np.testing.assert_allclose(*places, atol=1e-12)


@pytest.mark.parametrize("cloths", [(EVEN, EVEN), (STIFF, EVEN), (LACE, PlainCloth(ease=(0.1, 0.0)))])
def test_matched_seams_fit_as_a_whole_and_in_each_stretch(panels, cloths):
    matched = match(panels, places_of(panels), cloths, seams_of(panels))
    for fit in matched.fits:
        assert fit.together[0] == pytest.approx(fit.together[1], abs=0.05)
        assert fit.off < 0.1
        assert len(fit.seam.stretch) >= 3 * fit.seam.stretch[-1]
    assert abs(matched.fits[0].misfit) > 0.003  # there was something to match
    assert not any(piece.is_folded or piece.overlaps for piece in matched.flats)


def test_the_stiffer_piece_gives_way_less(panels):
    seams = seams_of(panels)[:1]
    moved = []
    for cloths in ((EVEN, EVEN), (STIFF, EVEN), (EVEN, STIFF)):
        (fit,) = match(panels, places_of(panels), cloths, seams).fits
        moved.append([abs(a - b) for a, b in zip(fit.alone, fit.together, strict=True)])
    assert moved[1][0] < 0.5 * moved[0][0]
    assert moved[2][1] < 0.5 * moved[0][1]


def test_matching_costs_work_and_the_least_that_it_can(panels):
    places, cloths, seams = places_of(panels), (EVEN, LACE), seams_of(panels)
    matched = match(panels, places, cloths, seams)
    problem = FlatProblem.of(panels, places, cloths)
    flat = problem.joined([piece.worn for piece in matched.flats])
    alone = problem.joined([piece.worn for piece in matched.alone])
    assert problem.work(problem.state(flat)).sum() > problem.work(problem.state(alone)).sum()
    stretches = _Stretches.of(problem, seams)
    state = problem.state(flat)
    slopes = stretches.slopes(flat)
    pull = problem.slope(state, problem.turned_slopes(state)).ravel() + slopes @ matched.tensions
    # Along the grain's condition alone the pieces still pull.
    for panel, rows in enumerate(problem.points):
        own = pull.reshape(-1, 2)[rows]
        grain = panels[panel].grain
        own[:, 0] -= grain * (grain @ own[:, 0]) / (grain @ grain)
        assert np.abs(own).max() < 1e-3


def test_slopes_of_lengths_are_their_derivatives(panels):
    problem = FlatProblem.of(panels, places_of(panels), (EVEN, LACE))
    stretches = _Stretches.of(problem, seams_of(panels, {("upper", 0): 1.1, ("upper", 1): 1.1}))
    flat = problem.joined(None)
    way = np.random.default_rng(1).normal(size=flat.shape)
    expected = slope(lambda at: stretches.misfits(flat + at * way), 1e-3)
    np.testing.assert_allclose(stretches.slopes(flat).T @ way.ravel(), expected, rtol=1e-6, atol=1e-9)


def test_a_ratio_gathers_one_side(panels):
    (seam,) = seams_of(panels)[:1]
    matched = match(panels, places_of(panels), (EVEN, EVEN), [replace(seam, ratio=1.05)])
    (fit,) = matched.fits
    assert fit.together[0] == pytest.approx(1.05 * fit.together[1], abs=0.05)
    number = {(panel.name, side): 1.05 for panel in panels[1:] for side in range(len(panel.sides))}
    assert seams_of(panels, number)[0].ratio == pytest.approx(1.0 / 1.05)


def test_a_warm_start_finds_the_same_pieces(panels):
    cloths, seams, skin = (LACE, EVEN), seams_of(panels), ball().vertices
    former = match(panels, places_of(panels), cloths, seams)
    moved = [panel.places(skin + 3.0 * np.sin(skin[:, [2, 0, 1]] / 25.0)) for panel in panels]
    warm, cold = match(panels, moved, cloths, seams, former), match(panels, moved, cloths, seams)
    for one, two in zip(warm.flats, cold.flats, strict=True):
        np.testing.assert_allclose(one.points, two.points, atol=0.01)


def test_what_matching_costs_is_seen_in_the_strain(panels):
    matched = match(panels, places_of(panels), (STIFF, EVEN), seams_of(panels))
    alone, together = (strain_summary(pieces[1]) for pieces in (matched.alone, matched.flats))
    assert together.mean > alone.mean


def test_without_seams_pieces_lie_as_flattened_alone(panels):
    matched = match(panels, places_of(panels), (EVEN, LACE), ())
    assert matched.fits == ()
    for together, alone in zip(matched.flats, matched.alone, strict=True):
        np.testing.assert_allclose(together.points, alone.points, atol=1e-3)


def test_sides_that_differ_by_a_tenth_are_made_to_fit(panels):
    # So strongly strained a piece gives way along its own sides: only its seams hold it.
    seams = [replace(seam, ratio=ratio) for seam, ratio in zip(seams_of(panels), (0.88, 1.0), strict=True)]
    matched = match(panels, places_of(panels), (EVEN, EVEN), seams)
    assert max(fit.off for fit in matched.fits) < 0.01
    assert abs(matched.fits[0].misfit) > 0.1
    again = match(panels, places_of(panels), (EVEN, EVEN), seams, matched)
    for one, two in zip(matched.flats, again.flats, strict=True):
        np.testing.assert_allclose(one.points, two.points, atol=0.01)
