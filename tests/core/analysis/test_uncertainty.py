"""How far figures may be off: both ways agree, values worked out by hand, and what is kept and told."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import resources
from math import hypot, tau

import numpy as np
import pytest
from coarse_bodies import coarse_body

from app.presenters.samples import sample_design
from core.analysis.uncertainty.estimate import SLIDING, WAIST, UncertaintyEstimator, cautions
from core.analysis.uncertainty.input_uncertainty import (
    NUMBERS,
    InputUncertainty,
    default_uncertainty,
    origins,
    with_overrides,
)
from core.analysis.uncertainty.linear_propagation import Propagation
from core.analysis.uncertainty.model_error import model_error_mm, model_errors
from core.analysis.uncertainty.monte_carlo import sample
from core.analysis.uncertainty.parameters import PLACING, perturb, uncertain_parameters
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.deformation.tffd import deform
from core.document.custom_measures import CustomMeasurement
from core.errors import UserError
from core.garment.elastic_library import find_elastic
from core.garment.tension import line_tensions
from core.geometry.planar_curves import Plane, Slicer
from core.measurements.uncertain_value import (
    LANDMARKS,
    LINE,
    MODEL,
    SCAN,
    SOURCES,
    TAPE,
    TISSUE,
    OutputUncertainties,
    Uncertainty,
    round_uncertainty,
    uncertainty_digits,
)
from core.pipeline.build import Stages, build
from core.pipeline.solve import exact_solution, solve
from core.progress import Cancelled

SURE = replace(default_uncertainty(), unsure_landmark_mm=0.0)
"""Of the mannequin only the folds are sure: fewer landmarks are quicker."""


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Stages:
    file, design = coarse_body("mannequin", tmp_path_factory.mktemp("coarse")), sample_design()
    return build(replace(design, scan=replace(design.scan, path=str(file))).with_line("mid-bust", 0.95))


@pytest.fixture(scope="module")
def trials(plain: Stages) -> PerturbedSolutions:
    return PerturbedSolutions(plain)


@pytest.fixture(scope="module")
def told(trials: PerturbedSolutions) -> list[OutputUncertainties]:
    finding = UncertaintyEstimator(trials, SURE)
    return [finding.estimate_partial(), finding.estimate()]


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_both_ways_agree_on_small_spreads(plain: Stages, contact: str) -> None:
    elastic = find_elastic("plush 12")
    design = plain.design.with_line("full-bust", 0.9).with_line("under-bust", 0.85)
    made = design.with_elastic("full-bust", elastic).with_elastic("under-bust", elastic)
    trials = PerturbedSolutions(build(replace(made, line_contact=contact), plain))
    small = default_uncertainty().scaled(0.02)
    turning = [knob for knob in uncertain_parameters(trials.base, small) if knob.source != LANDMARKS]
    turning += model_errors(trials, small)
    assert {knob.source for knob in turning} == {"tissue", "line", "tape", "elastic", "scan", "model"}
    if contact == "sliding":  # the rest is as glued
        kept = ("line", "elastic", "model")
        turning = [knob for knob in turning if knob.source in kept or knob.name == "mid-bust"]
    propagation = Propagation(trials)
    effects = [propagation.effect(knob).values for knob in turning]
    found, here = sample(trials, turning, 2), trials(perturb(trials.base, {})).values
    assert not found.failed
    assert len(here) > 90
    for key, value in here.items():
        drawn = found.values(key) - value
        by_slopes = found.draws @ np.array([effect.get(key, 0.0) for effect in effects])
        # Draw by draw, no statistics; bodies are bound in single precision.
        assert np.abs(by_slopes - drawn).max() < 0.08 * np.abs(drawn).max() + 5e-4, key


@pytest.mark.parametrize("volume", ["conventional", "none", "adaptive"])
def test_what_is_told_is_of_where_the_run_rests(plain: Stages, volume: str) -> None:
    """Value and ± are of one balance: that of the volume which the control keeps."""
    stages = build(replace(plain.design, volume=volume).with_line("mid-bust", 0.9), plain)
    trials, shown = PerturbedSolutions(stages), solve(stages)
    assert shown.verdict.motion == "settled"
    # Turns count as settled before the last hundredths of a millimetre.
    off = [
        np.abs(at - shown.control_points).max() for at in (trials.points, exact_solution(stages).place.points)
    ]
    assert off[0] < 0.06
    assert volume == "adaptive" or off[1] > 5.0 * off[0]
    propagation = Propagation(trials)
    for knob in uncertain_parameters(stages, default_uncertainty().scaled(0.02)):
        if knob.source in (LINE, TAPE):
            told = propagation.effect(knob).values
            low, high = (trials(perturb(stages, {knob: turn})).values for turn in (-1.0, 1.0))
            for key in ("lift", "out", "change:bust_girth", "tension:mid-bust"):
                assert told[key] == pytest.approx((high[key] - low[key]) / 2.0, rel=0.01, abs=2e-5), key


def test_a_bust_point_moves_the_distance_by_what_it_goes_aside() -> None:
    trials = PerturbedSolutions(
        build(sample_design().with_line("mid-bust", None))
    )  # a finer skin, on which points glide
    aside = next(
        each
        for each in uncertain_parameters(trials.base, default_uncertainty())
        if each.name == "bust_point_left" and abs(each.direction[0]) > 0.5
    )
    assert aside.sd == default_uncertainty().unsure_landmark_mm  # no nipple stands out on the mannequin
    effect = Propagation(trials).effect(aside)
    assert effect.values["before:bust_point_distance"] == pytest.approx(
        aside.sd * aside.direction[0], abs=0.1
    )
    assert effect.values["before:waist_girth"] == pytest.approx(0.0, abs=1e-9)


def test_the_scan_makes_a_girth_longer_all_round_and_no_change(told: list[OutputUncertainties]) -> None:
    waist = told[-1].by_output["before:waist_girth"]
    assert waist.sd == pytest.approx(tau * default_uncertainty().skin_mm, rel=0.02)
    assert told[-1].by_output["change:waist_girth"].sd < 1e-9
    assert told[-1].plus_minus("before:waist_girth") == pytest.approx(2.0 * waist.sd)
    assert told[-1].plus_minus("before:hip_girth") is None  # the mannequin shows no hip


def test_newtons_of_tissue_alone_go_with_its_stiffness(
    plain: Stages, told: list[OutputUncertainties]
) -> None:
    newtons = line_tensions(plain, PerturbedSolutions(plain).points)["mid-bust"].mean
    by_tissue = told[-1].by_output["tension:mid-bust"].by_source[TISSUE]
    assert by_tissue == pytest.approx(default_uncertainty().tissue_ln * newtons, rel=1e-6)
    assert TISSUE not in told[-1].by_output["lift"].by_source  # such lines are as stiff as they are set


def test_the_quick_part_comes_first_and_the_other_contact_last(told: list[OutputUncertainties]) -> None:
    first, last = told
    assert not first.whole
    assert last.whole
    assert LANDMARKS not in first.sources
    assert first.by_output["lift"].sd < last.by_output["lift"].sd
    assert last.contact == "sliding"
    without_model = {name: sd for name, sd in last.by_output["lift"].by_source.items() if name != MODEL}
    assert last.other["lift"] > 3.0 * last.sds * hypot(
        *without_model.values()
    )  # a choice, and no part of the ±
    assert (last.skin >= SURE.skin_mm).all()
    assert last.rest == SURE.skin_mm


def test_what_a_root_may_be_off_is_in_the_volumes_and_not_in_their_change(
    told: list[OutputUncertainties],
) -> None:
    assert told[-1].by_output["after:breast_volume_left"].by_source["root"] > 5.0
    assert "root" not in told[-1].by_output["change:breast_volume_left"].by_source


def test_another_length_of_the_line_takes_what_hangs_on_landmarks_along(
    plain: Stages, trials: PerturbedSolutions, told: list[OutputUncertainties]
) -> None:
    assert told[-1].whole
    after = PerturbedSolutions(build(plain.design.with_line("mid-bust", 0.96), plain), trials)
    knob = next(each for each in uncertain_parameters(after.base, SURE) if each.source == LANDMARKS)
    tried, fresh = (
        after(perturb(after.base, {knob: 1.0})),
        PerturbedSolutions(after.base)(perturb(after.base, {knob: 1.0})),
    )
    assert after._known is trials._known
    assert tried.values == fresh.values
    moved = build(plain.design.with_placed("bust_point_left", (100.0, -230.0, 350.0)), plain)
    assert PerturbedSolutions(moved, trials)._known is not trials._known


def test_it_is_let_go_of_at_once(trials: PerturbedSolutions) -> None:
    def stop(what: str, share: float) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        UncertaintyEstimator(trials, SURE).estimate(stop)


def test_values_are_carried_to_where_a_section_runs(plain: Stages) -> None:
    mesh = plain.body.mesh
    slicer = Slicer(mesh, Plane("x", 60.0))
    curves, heights = slicer.curves(mesh.vertices), slicer.interpolate(mesh.vertices, mesh.vertices[:, 2])
    assert len(curves) == len(heights) > 0
    for curve, height in zip(curves, heights, strict=True):
        assert np.abs(curve.places[:, 1] - height).max() < 1e-9


def test_shares_are_parts_of_the_variance() -> None:
    doubt = Uncertainty({"scan": 3.0, "tape": 4.0})
    assert doubt.sd == 5.0
    assert list(doubt.shares.items()) == [("tape", 0.64), ("scan", 0.36)]
    assert Uncertainty({}).sd == 0.0
    assert hypot(*(np.sqrt(share) for share in doubt.shares.values())) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("off", "shown"), [(0.004, 0.1), (0.26, 0.3), (9.94, 9.9), (9.96, 10.0), (31.4, 31.0)]
)
def test_one_rule_of_rounding(off: float, shown: float) -> None:
    assert round_uncertainty(off) == shown
    assert uncertainty_digits(off) == (0 if shown >= 10.0 else 1)


def test_all_that_is_assumed_is_data_with_its_origin() -> None:
    file = json.loads((resources.files("resources") / "spread.json").read_text(encoding="utf-8"))
    assert set(NUMBERS) <= file.keys()
    assert all(getattr(default_uncertainty(), name) > 0.0 for name in NUMBERS)
    assert tuple(origins()) == SOURCES
    assert all(words.en and words.ja for words in origins().values())
    assert with_overrides(["tape-mm=3"], default_uncertainty()).tape_mm == 3.0
    for text in ("tape=3", "tape_mm=wide", "tape_mm=-1", "tape_mm=nan"):
        with pytest.raises(UserError):
            with_overrides([text], default_uncertainty())


def test_a_source_that_is_none_turns_nothing(plain: Stages, trials: PerturbedSolutions) -> None:
    assert uncertain_parameters(plain, InputUncertainty()) == ()
    assert model_errors(trials, InputUncertainty()) == ()
    assert {
        knob.source for knob in uncertain_parameters(plain, replace(InputUncertainty(), skin_mm=1.0))
    } == {SCAN}


def test_what_goes_with_stiffness_is_off_by_a_factor_and_never_below_nothing(
    plain: Stages, trials: PerturbedSolutions, told: list[OutputUncertainties]
) -> None:
    tissue = next(each for each in uncertain_parameters(trials.base, SURE) if each.source == TISSUE)
    alone = Uncertainty({TISSUE: told[-1].by_output["tension:mid-bust"].by_source[TISSUE]})
    spread = replace(told[-1], by_output={"tension:mid-bust": alone, "lift": Uncertainty({SCAN: 9.0})})
    key, value = "tension:mid-bust", trials.values["tension:mid-bust"]
    ends = [trials(perturb(trials.base, {tissue: turn})).values[key] for turn in (-2.0, 2.0)]
    assert spread.between(key, value) == pytest.approx(ends, rel=1e-6)
    assert spread.plus_minus(key) is None
    assert spread.between("lift", 1.0) == (-17.0, 19.0)


def test_a_force_that_is_off_by_more_than_itself_is_told_from_nothing_on(
    told: list[OutputUncertainties],
) -> None:
    key = "tension:mid-bust"
    slack = replace(told[-1], by_output={key: Uncertainty({"tape": 1.0, LINE: 0.1})}, values={key: 0.5})
    assert slack.factor(key) is None
    assert slack.plus_minus(key) is None
    assert slack.between(key, 0.5) == pytest.approx((0.0, 0.5 + 2.0 * hypot(1.0, 0.1)))
    nearly = replace(slack, by_output={key: Uncertainty({LINE: 1.0})}, values={key: 0.01})
    assert nearly.factor(key) is None  # a hundred standard deviations of a logarithm say nothing
    sure = replace(slack, values={key: 4.0})
    assert sure.plus_minus(key) == pytest.approx(2.0 * hypot(1.0, 0.1))


@pytest.mark.parametrize(("value", "ends"), [(-1.0, (0.0, 0.0)), (0.5, (0.0, 1.3)), (2.0, (1.2, 2.8))])
def test_the_range_of_a_tension_ends_where_a_band_would_have_to_push(
    told: list[OutputUncertainties], value: float, ends: tuple[float, float]
) -> None:
    key = "tension:mid-bust"
    doubtful = replace(told[-1], by_output={key: Uncertainty({"tape": 0.4})}, values={key: value})
    assert doubtful.between(key, value) == pytest.approx(ends)


def test_what_hangs_on_landmarks_of_which_nobody_knows_how_sure_they_are_has_no_spread(plain: Stages) -> None:
    own = (
        CustomMeasurement("pits", "straight", ("armpit_left", "armpit_right")),
        CustomMeasurement("gap", "straight", ("bust_point_left", "bust_point_right")),
        CustomMeasurement("at a height", "girth", (), 300.0),
    )
    quick = UncertaintyEstimator(
        PerturbedSolutions(build(replace(plain.design, own_measures=own), plain)), SURE
    ).estimate_partial()
    for kind in ("before", "after"):
        for key in ("high_bust_girth", "high_bust_girth_skin", "own:pits"):
            assert quick.plus_minus(f"{kind}:{key}") is None
        for key in ("waist_girth", "own:gap", "own:at a height"):
            assert quick.plus_minus(f"{kind}:{key}") is not None


def test_what_placing_a_landmark_where_it_is_changes_is_in_the_spread(
    plain: Stages, trials: PerturbedSolutions, told: list[OutputUncertainties]
) -> None:
    there, key = trials(perturb(plain, {PLACING: 0.0})).values, "before:root_length_left"
    jump = there[key] - trials.original.before["root_length_left"].value
    assert abs(jump) > 0.1, "a fold that is placed leads the root another way"
    propagation = Propagation(trials)
    turns = [
        propagation.effect(knob).values[key]
        for knob in uncertain_parameters(plain, SURE)
        if knob.source == LANDMARKS
    ]
    of_landmarks = told[-1].by_output[key].by_source[LANDMARKS]
    assert of_landmarks == pytest.approx(hypot(jump, *turns), rel=1e-6)


@pytest.mark.parametrize("tissue", ["net", "solid"])
def test_the_model_error_has_its_size_where_the_body_is_reshaped(plain: Stages, tissue: str) -> None:
    trials = PerturbedSolutions(build(replace(plain.design, tissue=tissue), plain))
    moved = deform(trials.base.binding, trials.points) - trials.base.body.mesh.vertices
    sizes = default_uncertainty()
    share, least = sizes.of_model(tissue)
    assert (share, least) == ((0.25, 0.5) if tissue == "solid" else (0.6, 1.0))
    motion = np.linalg.norm(moved[trials.base.binding.moving], axis=1)
    rms = float(np.sqrt((motion**2).mean()))
    assert model_error_mm(trials, sizes) == pytest.approx([max(share * rms, least)] * 2, rel=0.1)
    assert model_error_mm(trials, InputUncertainty(net_error=10.0, solid_error=10.0)) == pytest.approx(
        [10.0 * rms] * 2, rel=0.1
    )
    alone = InputUncertainty(**dict(zip(_of_model(tissue), (share, least), strict=True)))
    spread = UncertaintyEstimator(trials, alone).estimate_partial()
    for knob in model_errors(trials, sizes):
        free = np.linalg.norm(knob.shift[trials.base.model.tensegric.free], axis=1)
        assert free.max() == pytest.approx(model_error_mm(trials, sizes).max(), rel=0.05)
    # A bust point yields nearly as much as any place, and girth by girth what hangs on it.
    lift, girth, volume = (
        spread.by_output[key].by_source[MODEL]
        for key in ("lift", "change:bust_girth", "change:breast_volume_left")
    )
    assert 0.8 * least < lift < 1.2 * max(share * rms, least)
    assert 0.5 * least < girth < 3.0 * least
    assert volume < 0.01 * trials.original.before["breast_volume_left"].value, "tissue keeps its volume"
    assert spread.by_output["after:bust_girth"].by_source[MODEL] == pytest.approx(girth)
    assert spread.by_output["change:waist_girth"].sd < 1e-9, "no line reaches the waist"
    assert all(
        doubt.by_source.get(MODEL, 0.0) < 1e-9
        for key, doubt in spread.by_output.items()
        if key.startswith("before:")
    )


def _of_model(tissue: str) -> tuple[str, str]:
    return f"{tissue}_error", f"{tissue}_error_mm"


def test_without_a_line_on_the_breasts_there_is_no_model_error(plain: Stages) -> None:
    bare = plain.design.with_line("mid-bust", None)
    on_ribs = bare.with_line("under-bust", 0.9)
    for design in (bare, on_ribs):
        trials = PerturbedSolutions(build(design, plain))
        assert model_errors(trials, default_uncertainty()) == ()


def test_a_bare_body_is_neither_fitted_nor_solved(plain: Stages, monkeypatch: pytest.MonkeyPatch) -> None:
    bare = build(plain.design.with_line("mid-bust", None), plain)
    known = PerturbedSolutions(bare)
    assert known.is_bare
    assert known.points is not None
    monkeypatch.setattr("core.analysis.uncertainty.perturbed_solutions.build", None)
    monkeypatch.setattr("core.analysis.uncertainty.perturbed_solutions.converged_solution", None)
    spread = UncertaintyEstimator(known, SURE).estimate()
    assert spread.whole
    assert spread.contact == ""
    assert not any(key.startswith(("change", "lift", "tension")) for key in spread.by_output)
    under, same = spread.by_output["before:underbust_girth"], spread.by_output["after:underbust_girth"]
    assert LANDMARKS in under.by_source
    assert under == same


def test_where_the_spread_says_too_little_it_says_so(plain: Stages, told: list[OutputUncertainties]) -> None:
    assert "before:waist_girth" in told[-1].by_output
    assert told[-1].cautions == (WAIST,), "the narrowest place is not the anatomical waist"
    sliding = replace(plain.design, line_contact="sliding", volume="conventional")
    assert list(cautions(sliding, {})) == [SLIDING]
    assert list(cautions(replace(sliding, lines=()), {})) == []
