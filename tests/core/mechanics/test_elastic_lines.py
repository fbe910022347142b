"""Lines made of elastics: force and length are a point of the elastic's own curve, whatever its shape."""

from dataclasses import replace

import numpy as np
import pytest
from models import pairs_of

from core.document.elastic import Elastic
from core.document.lines import ActiveLine, LineSettings
from core.errors import LineError
from core.mechanics.exact_solution import solve_body_exact, solve_exact
from core.mechanics.force_units import newtons_per_unit
from core.pipeline.build import build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import solve


def hooke(ea, reach=1.0):
    return Elastic("straight", 10.0, ((0.0, 0.0), (reach, ea * reach)))


def bent(power, strength, name="bent"):
    steps = np.linspace(0.02, 1.0, 50)
    return Elastic(name, 12.0, ((0.0, 0.0), *((float(e), float(strength * e**power)) for e in steps)))


KINKED = Elastic("kinked", 10.0, ((0.0, 0.0), (0.02, 0.3), (0.05, 3.0), (0.1, 60.0), (1.0, 900.0)))
CURVES = {"straight": hooke(6.0), "stiffer": bent(3.0, 60.0), "softer": bent(0.3, 5.0), "kinked": KINKED}
DRESS = (ActiveLine("full-bust", 0.85), ActiveLine("mid-bust", 0.7))


def made_of(stages, elastics, lines=DRESS, **choices):
    """The stages of the dressed body with lines made of elastics."""
    design = replace(stages.design, lines=lines, volume="exact", **choices)
    for name, elastic in elastics.items():
        design = design.with_elastic(name, elastic)
    return build(design, stages)


def worn_so(stages, name, points):
    """The elongation of a line's front and its mean tension [N], by hand from its springs."""
    model = stages.model
    at = [line.name for line in model.lines].index(name)
    here = model.owner == at
    natural = model.natural_lengths(line_targets(stages.design, stages).ratios)[here]
    first, second = np.array(pairs_of(model.segments.across))[here].T
    lengths = np.linalg.norm(points[first] - points[second], axis=1)
    newtons = newtons_per_unit(model, stages.design.tissue_stiffness)
    tensions = newtons * model.segments.stiffness[here] * (lengths - natural)
    return lengths.sum() / natural.sum() - 1.0, float((tensions * natural).sum() / natural.sum())


def exact_points(stages):
    ratios = line_targets(stages.design, stages).ratios
    balance = solve_exact(stages.model, ratios)
    assert balance.is_converged
    return stages.model.tensegric.expand(balance.state.moved)


@pytest.mark.parametrize("choices", [{}, {"line_contact": "sliding"}, {"member_law": "prestressed"}], ids=str)
@pytest.mark.parametrize("curve", CURVES)
def test_force_and_length_are_a_point_of_the_curve(built, curve, choices):
    stages = made_of(built("mannequin"), {"mid-bust": CURVES[curve], "full-bust": bent(1.5, 4.0)}, **choices)
    points = exact_points(stages)
    for name, elastic in stages.design.active_elastics().items():
        elongation, tension = worn_so(stages, name, points)
        assert 0.0 < elongation < elastic.max_elongation
        assert tension == pytest.approx(elastic.force(elongation), rel=1e-6)


def test_a_straight_elastic_is_the_line_of_its_stiffness_at_once(built):
    ea, ratio = 6.0, 0.7
    lines = (ActiveLine("mid-bust", ratio),)
    stages = made_of(built("mannequin"), {"mid-bust": hooke(ea)}, lines)
    model = stages.model
    line = next(line for line in model.lines if line.name == "mid-bust")
    newtons = newtons_per_unit(model, 530.0)
    unit = newtons * model.tensegric.mean_stiffness * line.rest_lengths.mean()
    traits = LineSettings("mid-bust", stiffness=ea / ratio / unit)
    plain = replace(stages.design, traits=(traits,), elastics=())
    np.testing.assert_allclose(exact_points(stages), exact_points(build(plain, stages)), atol=1e-9)


def test_a_stiff_elastic_comes_to_the_length_at_which_a_line_is_held(built):
    lines = (ActiveLine("mid-bust", 0.95),)
    gaps = []
    for ea in (1e2, 1e3, 1e4, 1e5):
        stages = made_of(built("mannequin"), {"mid-bust": hooke(ea, 0.1)}, lines)
        elongation, tension = worn_so(stages, "mid-bust", exact_points(stages))
        gaps.append(elongation)
    held = made_of(built("mannequin"), {"mid-bust": hooke(1e5, 0.1)}, lines, line_hold="held")
    ratios = line_targets(held.design, held).ratios
    balance = solve_exact(held.model, ratios)
    at = [line.name for line in held.model.lines].index("mid-bust")
    of_held = balance.tensions[at] * newtons_per_unit(held.model, 530.0)
    assert gaps == sorted(gaps, reverse=True)
    assert gaps[-1] < 2e-4
    # Each piece of an elastic is as long as it is, of a held line only the whole: so alike, not equal.
    assert tension == pytest.approx(of_held, rel=0.1)


def test_twice_the_tissue_and_twice_the_elastic_give_the_same_shape(built):
    one = made_of(built("mannequin"), {"mid-bust": bent(1.5, 4.0)})
    two = made_of(built("mannequin"), {"mid-bust": bent(1.5, 8.0)}, tissue_stiffness=1060.0)
    np.testing.assert_allclose(exact_points(one), exact_points(two), atol=1e-6)


def test_the_body_s_own_volume_is_held_too_where_that_is_wished(built):
    stages = made_of(built("mannequin"), {"mid-bust": bent(1.5, 4.0)}, dense_volume=True)
    ratios = line_targets(stages.design, stages).ratios
    balance = solve_body_exact(stages.model, ratios, stages.body_change)
    elongation, tension = worn_so(stages, "mid-bust", stages.model.tensegric.expand(balance.state.moved))
    assert tension == pytest.approx(bent(1.5, 4.0).force(elongation), rel=1e-6)


def test_turns_end_on_the_curve_as_well(built):
    stages = made_of(built("mannequin"), {"mid-bust": bent(1.5, 4.0)})
    turned = solve(build(replace(stages.design, volume="adaptive"), stages), turns=600)
    elongation, tension = worn_so(stages, "mid-bust", turned.control_points)
    assert tension == pytest.approx(bent(1.5, 4.0).force(elongation), rel=1e-3)


def test_what_is_stretched_beyond_its_curve_is_refused(built):
    with pytest.raises(LineError, match=r"straight requires 38 % elongation for mid-bust.*ends at 30 %"):
        made_of(built("mannequin"), {"mid-bust": hooke(6.0, 0.3)})


def test_a_line_that_no_elastic_is_chosen_for_keeps_its_own_stiffness(built):
    stages = made_of(built("mannequin"), {"mid-bust": hooke(6.0)})
    own = replace(stages.design.line_settings("full-bust"), stiffness=4.0)
    softer = build(stages.design.with_line_settings(own), stages)
    at = [line.name for line in stages.model.lines].index("full-bust")
    usual = stages.model.segments.stiffness[stages.model.owner == at]
    np.testing.assert_allclose(softer.model.segments.stiffness[softer.model.owner == at], usual / 4.0)
