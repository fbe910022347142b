"""Cups on solid tissue: what they do to a breast, at rest and worn, and in the paper's iteration."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.control_mesh.halved import off_skin
from core.document.cup import Cup
from core.errors import LineError, UserError
from core.garment.cup_fit import CupFit, WornCups
from core.garment.presets import built_in, with_preset
from core.garment.pressure_list import pressure_list
from core.mechanics.gain_limit import OscillationLimit
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.potential import Potential
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import exact_equilibrium

FULL_SUPPORT = Cup(coverage="half", lift=25.0, forward=5.0)
PUSH_UP = Cup(coverage="half", lift=20.0, forward=5.0, gather=15.0, wire=True)
SEWN = Cup(kind="sewn", coverage="full", across=0.95, upright=0.95)


def dressed(stages: Stages, cup: Cup | None, **settings: object) -> Stages:
    return build(replace(stages.design, cup=cup, lines=(), **settings), stages)  # type: ignore[arg-type]


def shift(stages: Stages) -> np.ndarray:
    """Return how the left and the right bust point move, (2, 3) [mm]."""
    balance = exact_equilibrium(stages)
    assert balance.is_converged
    points = stages.model.tensegric.expand(balance.state.moved)
    return (points - stages.control.mesh.vertices)[list(stages.control.bust_points)]


def fit_of(stages: Stages) -> CupFit:
    points = stages.model.tensegric.expand(exact_equilibrium(stages).state.moved)
    return WornCups(stages).fit(points)


def test_a_cup_of_the_breasts_own_shape_does_nothing_to_the_bit(person):
    for cup in (Cup(), Cup(wire=True), Cup(kind="sewn")):
        assert not shift(dressed(person, cup)).any()


def test_a_cup_that_lifts_bears_the_breast_and_presses_gently(person):
    stages = dressed(person, FULL_SUPPORT)
    up = shift(stages)[:, 2]
    assert ((up > 8.0) & (up < 25.0)).all()
    fit = fit_of(stages)
    for side in fit.sides:
        assert side.up_n > 1.0
        assert side.back_n > 0.0
        assert 0.2 < side.max_kpa < 3.0
        assert side.contact > 0.5
    assert fit.kpa.max() == pytest.approx(fit.highest.max_kpa)


def test_a_push_up_brings_both_breasts_to_the_middle(person):
    moved = shift(dressed(person, PUSH_UP))
    assert (moved[:, 2] > 8.0).all()
    assert moved[0, 0] < -5.0
    assert moved[1, 0] > 5.0


def test_softer_tissue_rises_as_far_in_a_cup_and_presses_less(person):
    firm, soft = (dressed(person, FULL_SUPPORT, sag=sag) for sag in (20.0, 30.0))
    assert shift(soft)[:, 2] == pytest.approx(shift(firm)[:, 2], rel=0.1)
    assert fit_of(soft).up_n == pytest.approx(fit_of(firm).up_n * 20.0 / 30.0, rel=0.1)


def test_each_breast_keeps_its_volume_in_a_cup(person):
    stages = dressed(person, PUSH_UP)
    points = stages.model.tensegric.expand(exact_equilibrium(stages).state.moved)
    change = stages.model.volume.zone_volumes(points) - stages.model.rest_zones
    assert np.abs(change).max() < 1e-6 * stages.model.rest_zones.min()


def test_a_wire_wider_than_the_root_spreads_it(person):
    stages = dressed(person, replace(SEWN, across=1.0, upright=1.0, wire=True, wire_width=1.1))
    layout = WornCups(stages).layout
    points = stages.model.tensegric.expand(exact_equilibrium(stages).state.moved)
    for side in (1, -1):
        ends = layout.root(side)[~stages.control.fixed[layout.root(side)]][[0, -1]]
        width = np.ptp(points[ends, 0]) / np.ptp(stages.control.mesh.vertices[ends, 0])
        assert width == pytest.approx(1.1, abs=0.03)


def test_cloth_over_a_crease_hangs_from_the_points_on_the_skin(person):
    stages = dressed(person, SEWN)
    off = off_skin(stages.fitted, stages.control)[~stages.control.fixed]
    assert off.any()
    (cloth, _), rng = stages.model.tensegric.cups, np.random.default_rng(5)
    pulled = rng.normal(0.0, 3.0, (len(off), 3))
    assert not cloth.gradient(pulled)[off].any()
    assert cloth.gradient(pulled)[~off].any()
    assert cloth.energy(np.where(off[:, None], 0.0, pulled)) == cloth.energy(pulled)
    # all of it goes along: nothing hangs from what does not move
    assert cloth.energy(np.ones((len(off), 3))) == pytest.approx(cloth.energy(0.0 * pulled), rel=1e-9)


def test_cups_need_solid_tissue_and_room_for_the_breasts(person):
    with pytest.raises(LineError, match="net as tissue"):
        build(replace(person.design, tissue="net", cup=FULL_SUPPORT))
    with pytest.raises(LineError, match="less than the breasts"):
        dressed(person, Cup(coverage="full", lift=8.0, forward=-18.0))
    with pytest.raises(UserError, match="cup lift 90 is out of range"):
        Cup(lift=90.0)


@pytest.mark.parametrize("cup", [FULL_SUPPORT, PUSH_UP, SEWN], ids=["support", "push-up", "sewn"])
def test_the_iteration_of_the_paper_ends_at_the_same_balance(person, cup):
    stages = dressed(person, cup, volume_of="both")
    ratios = line_targets(stages.design, stages).ratios
    *_, (state, record) = iterate(stages.model, lambda: LineTargets(ratios, "adaptive"), turns=500)
    assert abs(record.error) < 1e-6
    assert np.abs(state.moved - exact_equilibrium(stages).state.moved).max() < 0.1


def test_conventional_control_is_calm_below_its_limit_in_a_cup_and_not_above(person):
    stages = dressed(person, FULL_SUPPORT)
    ratios = line_targets(stages.design, stages).ratios
    limit = OscillationLimit(stages.model).limit(Potential(stages.model, ratios), exact_equilibrium(stages))

    def swing(control: str, gain: float) -> float:
        run = iterate(stages.model, lambda: LineTargets(ratios, control, gain), turns=300)
        return float(np.ptp([each.error for _, each in run][-20:]))

    assert swing("conventional", 0.9 * limit) < 1e-5
    assert swing("conventional", 1.2 * limit) > 1e-4
    assert swing("adaptive", 1.2 * limit) < 1e-5


BRAS = [each for each in built_in() if each.cup]


@pytest.mark.parametrize("preset", BRAS, ids=lambda each: each.title)
def test_each_bra_lifts_at_pressures_that_are_worn(person, preset):
    stages = build(with_preset(replace(person.design, own_lines=()), preset), person)
    up = shift(stages)[:, 2]
    assert ((up > 3.0) & (up < 25.0)).all()
    assert fit_of(stages).highest.max_kpa < 3.0


def test_a_soft_bra_lifts_by_a_centimetre_or_more_in_straps_of_few_newtons(built):
    """The person as scanned: straps go on over the shoulder, which coarse bodies do not show them."""
    stages = built("person")
    soft = next(each for each in BRAS if each.title == "Soft bra")
    worn = build(with_preset(replace(stages.design, lines=()), soft), stages)
    assert ((shift(worn)[:, 2] > 10.0) & (shift(worn)[:, 2] < 30.0)).all()
    points = worn.model.tensegric.expand(exact_equilibrium(worn).state.moved)
    lines = [row for row in pressure_list(worn, points).rows if not row.is_cup]
    assert lines
    for row in lines:
        assert row.tension_n is not None
        assert row.max_kpa is not None
        assert 1.0 < row.tension_n < 5.0
        assert row.max_kpa < 3.0
