"""The model on solid tissue: balance, signs that hold on any body, derivatives, and the paper's iteration."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from solid_bodies import BOTH, SLING, worn

from core.deformation.tffd import deform, deform_moving
from core.errors import LineError
from core.garment.tension import line_tensions
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Points
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.newton import Equilibrium
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Sensitivities
from core.pipeline import build as pipeline
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import exact_equilibrium


@pytest.fixture(scope="module")
def lifted(person: Stages) -> Stages:
    """The person in slings and a mid-bust line, all at 95 %."""
    return worn(person, 0.95, *BOTH)


def balance_of(stages: Stages) -> Equilibrium:
    balance = exact_equilibrium(stages)
    assert balance.is_converged
    return balance


def shift(stages: Stages) -> Points:
    """Return how the control points move, (n, 3) [mm]."""
    balance = balance_of(stages)
    return stages.model.tensegric.expand(balance.state.moved) - stages.control.mesh.vertices


def rise(stages: Stages) -> float:
    """Return how far the bust points rise on the mean [mm]."""
    return float(shift(stages)[list(stages.control.bust_points), 2].mean())


def tension(stages: Stages, line: str) -> float:
    points = stages.control.mesh.vertices + shift(stages)
    return line_tensions(stages, points)[line].mean


def test_a_person_in_nothing_stands_as_scanned_to_the_bit(person: Stages) -> None:
    assert not shift(person).any()
    state, record = next(iterate(person.model, lambda: line_targets(person.design, person), turns=1))
    assert not state.moved.any()
    assert record.error == pytest.approx(0.0, abs=1e-12)


def test_without_weight_the_bust_points_rise_by_the_sag(person: Stages) -> None:
    for sag in (10.0, 25.0):
        unloaded = worn(person, 1.0, posture="unloaded", sag=sag)
        assert rise(unloaded) == pytest.approx(sag, rel=0.15)  # the sag is that of the linear answer


def test_a_sling_lifts_and_one_that_is_too_long_does_nothing(person: Stages) -> None:
    assert rise(worn(person, 0.95, *SLING)) > 1.0
    assert not shift(worn(person, 1.05, *BOTH)).any()


def test_softer_tissue_takes_the_same_shape_at_forces_in_proportion(person: Stages) -> None:
    firm, soft = (worn(person, 0.95, *SLING, sag=sag, line_stiffness=500.0) for sag in (20.0, 40.0))
    away = shift(firm) - shift(soft)
    assert np.linalg.norm(away) < 0.1 * np.linalg.norm(shift(firm))
    assert tension(soft, SLING[0]) == pytest.approx(0.5 * tension(firm, SLING[0]), rel=0.1)


def test_each_breast_keeps_its_volume(lifted: Stages) -> None:
    points = lifted.control.mesh.vertices + shift(lifted)
    change = lifted.model.volume.zone_volumes(points) - lifted.model.rest_zones
    assert np.abs(change).max() < 1e-6 * lifted.model.rest_zones.min()


def test_gradient_and_curvature_are_those_of_the_energy(lifted: Stages) -> None:
    model, ratios = lifted.model, line_targets(lifted.design, lifted).ratios
    potential = Potential(model, ratios)
    there = balance_of(lifted).state.moved
    way = np.random.default_rng(3).normal(size=there.shape)
    place = potential.at(there + 0.1 * way)
    here, step = place.moved, 1e-4
    ahead, behind = (potential.at(here + sign * step * way) for sign in (1.0, -1.0))
    slope = (potential.energy(ahead) - potential.energy(behind)) / (2.0 * step)
    assert float(place.gradient @ way.ravel()) == pytest.approx(slope, rel=1e-6)
    bend = (ahead.gradient - behind.gradient) / (2.0 * step)
    none = np.zeros(len(potential.wanted))
    hessian = model.layout.band.full(potential.hessian(place, none, clip=False, curved=True))
    assert np.abs(hessian @ way.ravel() - bend).max() < 1e-6 * np.abs(bend).max()


def test_what_a_length_moves_is_known_without_trying(lifted: Stages, person: Stages) -> None:
    model, balance = lifted.model, balance_of(lifted)
    names = [line.name for line in model.lines]
    line = names.index("mid-bust")
    potential = Potential(model, line_targets(lifted.design, lifted).ratios)
    rates = Sensitivities(potential, balance).by_ratio(np.array([line])).moved[:, 0]
    step = 1e-5
    sides = []
    for sign in (1.0, -1.0):
        lines = tuple(
            replace(each, ratio=0.95 + sign * step) if each.name == "mid-bust" else each
            for each in lifted.design.lines
        )
        other = build(replace(lifted.design, lines=lines), lifted)
        sides.append(balance_of(other).state.moved.ravel())
    tried = (sides[0] - sides[1]) / (2.0 * step)
    assert np.abs(rates - tried).max() < 1e-5 * np.abs(tried).max()


def test_the_iteration_of_the_paper_ends_at_the_balance_of_both_volumes(person: Stages) -> None:
    both = worn(person, 0.97, *SLING, volume_of="both")
    ratios = line_targets(both.design, both).ratios
    *_, (state, record) = iterate(both.model, lambda: LineTargets(ratios, "adaptive"), turns=1500)
    assert abs(record.error) < 1e-6
    assert np.abs(state.moved - balance_of(both).state.moved).max() < 0.05


def test_conventional_control_oscillates_above_its_limit_and_adaptive_control_does_not(
    person: Stages,
) -> None:
    stages = worn(person, 0.97, *SLING)
    ratios = line_targets(stages.design, stages).ratios

    def swing(control: str, gain: float) -> float:
        targets = LineTargets(ratios, control, gain)
        errors = [each.error for _, each in iterate(stages.model, lambda: targets, turns=400)]
        return float(np.ptp(errors[-20:]))

    limit = stages.gain_limit
    assert swing("conventional", 0.9 * limit) < 1e-5
    assert swing("conventional", 1.2 * limit) > 1e-4
    assert swing("adaptive", 1.2 * limit) < 1e-5


def test_stresses_of_weight_never_take_the_stiffness_away(person: Stages) -> None:
    tissue = person.tissue
    assert tissue is not None
    assert 30.0 < tissue.rise / tissue.softest < 100.0
    for sag in (5.0, 20.0, 100.0):
        modulus, step = tissue.shear_modulus(sag), 1e-6
        stiffness, firmer = tissue.stiffness_at(modulus)
        assert np.linalg.eigvalsh(stiffness - 0.3 * modulus * tissue.stiffness)[0] > 0.0
        ahead, behind = (tissue.stiffness_at(modulus * np.exp(way))[0] for way in (step, -step))
        assert np.abs((ahead - behind) / (2.0 * step) - firmer).max() < 1e-6 * np.abs(firmer).max()


def test_stresses_of_weight_count_for_what_moves_the_breast(person: Stages) -> None:
    """Tissue that hangs is softer across its pull: leaning, the breast goes further than without them."""
    lying = worn(person, 1.0, posture="lying")
    solid = lying.model.tensegric
    plain = np.linalg.solve(solid.firmer, solid.load.ravel())
    away = plain - np.linalg.solve(solid.stiffness, solid.load.ravel())
    assert 0.05 < np.linalg.norm(away) / np.linalg.norm(plain) < 0.5


def test_the_body_follows_the_skin_of_the_solid(lifted: Stages, person: Stages) -> None:
    binding, points = lifted.binding, lifted.control.mesh.vertices + shift(lifted)
    assert np.array_equal(deform(binding, lifted.control.mesh.vertices), lifted.body.mesh.vertices)
    rng = np.random.default_rng(4)
    slopes, way = rng.normal(size=binding.rest_moving.shape), rng.normal(size=points.shape)
    way[lifted.control.fixed] = 0.0
    step = 1e-4
    ahead, behind = (binding.changes.of(points + sign * step * way) for sign in (1.0, -1.0))
    rate = (ahead - behind) / (2.0 * step)
    told = binding.changes.directional_derivative(points, way)
    assert np.abs(told - rate).max() < 1e-6 * np.abs(rate).max()
    by_columns = binding.operator.apply_transposed(slopes)
    expected = float(np.sum(by_columns * rate))
    assert float(np.sum(binding.gradient(points, slopes) * way)) == pytest.approx(expected, rel=1e-6)


def test_a_few_places_follow_as_among_all(lifted: Stages) -> None:
    binding, points = lifted.binding, lifted.control.mesh.vertices + shift(lifted)
    rows = np.array([9, 700, 30, 700])
    few = binding.few(rows)
    assert len(few.changes.of(points)) < len(binding.changes.of(points)) / 4
    # All rows together are blended in single precision.
    assert np.abs(few.places(points) - deform_moving(binding, points)[rows]).max() < 1e-4
    slopes = np.random.default_rng(3).normal(size=(4, 3))
    every = np.zeros_like(binding.rest_moving)
    np.add.at(every, rows, slopes)
    assert few.gradient(points, slopes) == pytest.approx(binding.gradient(points, every), abs=1e-9)


def test_nothing_leaps_where_the_solid_ends(person: Stages) -> None:
    lying = worn(person, 1.0, posture="lying")
    moved = deform(lying.binding, lying.control.mesh.vertices + shift(lying)) - lying.body.mesh.vertices
    length = np.linalg.norm(moved, axis=1)
    assert length.max() > 10.0
    ends = lying.body.mesh.edges
    apart, long = (
        np.linalg.norm(each[ends[:, 0]] - each[ends[:, 1]], axis=1)
        for each in (moved, lying.body.mesh.vertices)
    )
    stays = length[ends].min(axis=1) == 0.0
    assert (apart / long)[stays].max() < 0.7


def test_middles_lie_on_the_skin_but_for_creases(person: Stages) -> None:
    fitted, halved = person.fitted, person.control
    count, skin = len(fitted.mesh.vertices), person.body.smoothed
    middles = halved.mesh.vertices[count:]
    _, places = nearest_faces(skin, middles)
    on_skin = np.linalg.norm(places - middles, axis=1) < 1e-9
    assert on_skin.mean() > 0.9
    between = fitted.mesh.vertices[fitted.mesh.edges].mean(axis=1)
    assert np.array_equal(middles[~on_skin], between[~on_skin])


def test_sliding_lines_are_refused(person: Stages) -> None:
    with pytest.raises(LineError, match="Sliding lines"):
        build(replace(person.design, line_contact="sliding"), person)


def test_own_lines_are_named_by_the_points_of_the_template(person: Stages) -> None:
    fitted, halved = person.fitted.mesh.vertices, person.control.mesh.vertices
    assert len(fitted) < len(halved)
    assert np.array_equal(fitted, halved[: len(fitted)])


def test_a_scan_without_room_for_tissue_is_refused_in_a_sentence(
    person: Stages, monkeypatch: pytest.MonkeyPatch
) -> None:
    def crossed(*_: object) -> None:
        raise ValueError("the chest wall crosses the skin")

    monkeypatch.setattr(pipeline, "_condensed", pipeline._condensed.__wrapped__)
    monkeypatch.setattr(pipeline, "condense", crossed)
    with pytest.raises(LineError, match="Solid tissue cannot be computed"):
        build(person.design)
